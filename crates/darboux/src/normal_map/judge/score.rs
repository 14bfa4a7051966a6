//! Weighs the votes of all levels.

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
    pub correlation: f64,
    pub z_score: f64,
    pub channel_order: f64,
    /// Whether there would be enough tiles with enough signal to see a gradient.
    is_rich: bool,
}

/// The largest of the levels' z scores and their sum in units of its deviation (Stouffer's method).
pub fn weigh(levels: &[Level]) -> Evidence {
    let votes: Vec<&Votes> =
        levels.iter().map(|level| &level.votes).filter(|votes| votes.tiles >= TILES).collect();
    let Some(clearest) = votes.iter().max_by(|a, b| a.z_score().abs().total_cmp(&b.z_score().abs())) else {
        return Evidence::default();
    };
    let together = votes.iter().map(|votes| votes.z_score()).sum::<f64>() / (votes.len() as f64).sqrt();
    let z_score = if together.abs() > clearest.z_score().abs() { together } else { clearest.z_score() };
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
