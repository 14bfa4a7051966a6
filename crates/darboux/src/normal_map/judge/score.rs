//! Combines the correlations of all tiles and all levels of a normal map into one score and its confidence.

use super::judgement::{DECIDED, EXCHANGED, MapVerdict};
use super::level::{Level, Votes};

/// Tiles that a level needs to have a z score.
const TILES: usize = 16;

/// Tiles that a verdict against every gradient needs.
const MANY_TILES: usize = 256;

/// The smallest mean square of differences that is neither rounding nor compression: six codes of 8 bits.
const SIGNAL: f64 = (12.0 / 255.0) * (12.0 / 255.0);

/// What the levels say together.
#[derive(Clone, Copy, Debug, Default)]
pub struct Evidence {
    /// The mean correlation of the clearest level whose sign is that of `z_score`.
    pub correlation: f64,
    /// The largest of the levels' z scores, or all of them combined.
    pub z_score: f64,
    /// The channel order of the level of `correlation`.
    pub channel_order: f64,
    /// Whether there would be enough tiles with enough signal to see a gradient.
    is_rich: bool,
}

/// Combines the levels: the z score is the largest of theirs or, where it is larger, their sum over the square root of their number
/// (Stouffer's method).
///
/// The levels are halvings of one map and depend on each other, so the combined score is not that of a standard normal variable, as it
/// would be for independent levels.
pub fn weigh(levels: &[Level]) -> Evidence {
    let votes: Vec<&Votes> =
        levels.iter().map(|level| &level.votes).filter(|votes| votes.tiles >= TILES).collect();
    let largest_by =
        |key: &dyn Fn(f64) -> f64| votes.iter().max_by(|a, b| key(a.z_score()).total_cmp(&key(b.z_score())));
    let Some(largest) = largest_by(&f64::abs) else { return Evidence::default() };
    let together = votes.iter().map(|votes| votes.z_score()).sum::<f64>() / (votes.len() as f64).sqrt();
    let z_score = if together.abs() > largest.z_score().abs() { together } else { largest.z_score() };
    let clearest = largest_by(&|score| score * z_score).unwrap_or(largest);
    let is_rich = |votes: &&Votes| votes.tiles >= MANY_TILES && votes.energy > SIGNAL * votes.texels * 4.0;
    Evidence {
        correlation: clearest.mean(clearest.correlations),
        z_score,
        channel_order: clearest.mean(clearest.orders),
        is_rich: votes.iter().any(is_rich),
    }
}

impl Votes {
    fn mean(&self, sum: f64) -> f64 {
        sum / self.tiles as f64
    }

    /// The mean correlation over its standard error. A floor of the variance keeps few equal tiles from certainty.
    fn z_score(&self) -> f64 {
        let mean = self.mean(self.correlations);
        let variance = (self.mean(self.squared_correlations) - mean * mean).max(0.01);
        mean / (variance / (self.tiles - 1) as f64).sqrt()
    }
}

impl Evidence {
    pub fn verdict(&self) -> MapVerdict {
        match () {
            () if self.z_score.abs() >= DECIDED.into() && self.channel_order <= EXCHANGED.into() => {
                MapVerdict::NoGradient
            }
            () if self.z_score >= DECIDED.into() => MapVerdict::OpenGl,
            () if self.z_score <= -f64::from(DECIDED) => MapVerdict::DirectX,
            () if self.is_rich => MapVerdict::NoGradient,
            () => MapVerdict::CannotTell,
        }
    }

    /// An estimate of the probability that the sign of the z score is right.
    ///
    /// The curve is provisional: a logistic function whose steepness was chosen on the generated maps of `cargo xtask maps`, made nearly flat
    /// (SLOPE 0.03) so that some signs are wrong. It was not fitted to real maps. It stays below 1 because compression can have a direction
    /// of its own.
    pub fn confidence(&self) -> f64 {
        (1.0 / (1.0 + (-0.9 * self.z_score.abs()).exp())).min(0.999)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A level of 101 tiles whose mean correlation has this z score: the variance is at its floor.
    fn level(z_score: f64) -> Level {
        let mut level = Level::new(16);
        level.votes.tiles = 101;
        level.votes.correlations = 101.0 * 0.01 * z_score;
        level.votes.squared_correlations = level.votes.correlations.powi(2) / 101.0;
        level
    }

    /// One level outvoted by four others, and one that is not.
    #[test]
    fn correlation_and_z_score_have_one_sign() {
        for sign in [1.0, -1.0] {
            let outvoted = weigh(&[5.0, -4.0, -4.9, -4.8, -4.7].map(|z_score| level(sign * z_score)));
            assert!((outvoted.z_score * sign + 13.4 / 5.0f64.sqrt()).abs() < 1e-9, "{outvoted:?}");
            assert!((outvoted.correlation * sign + 0.049).abs() < 1e-9, "{outvoted:?}");
            let clear = weigh(&[5.0, -4.0, 1.0].map(|z_score| level(sign * z_score)));
            assert!((clear.z_score * sign - 5.0).abs() < 1e-9, "{clear:?}");
            assert!((clear.correlation * sign - 0.05).abs() < 1e-9, "{clear:?}");
        }
    }
}
