//! Combines the correlations of all tiles and all levels of a normal map into one score and its confidence.

use super::judgement::{MAX_EXCHANGED_RATIO, MIN_Z_SCORE, MapVerdict};
use super::level::{Level, TileSums};

/// The fewest tiles of a level that has a z score.
const MIN_TILES: usize = 16;

/// The fewest tiles of a level that shows that there is no gradient.
const MIN_TILES_FOR_NO_GRADIENT: usize = 256;

/// The smallest mean square of differences that is neither rounding nor compression: six codes of 8 bits.
const MIN_SIGNAL: f64 = (12.0 / 255.0) * (12.0 / 255.0);

/// The evidence of all levels.
#[derive(Clone, Copy, Debug, Default)]
pub struct Evidence {
    /// The mean correlation of the clearest level whose sign is that of `z_score`.
    pub correlation: f64,
    /// The largest of the levels' z scores, or all of them combined.
    pub z_score: f64,
    /// The log energy ratio of the level of `correlation`.
    pub log_energy_ratio: f64,
    /// Whether a gradient would be visible: enough tiles, with differences that are more than rounding and compression.
    has_enough_signal: bool,
}

/// Combines the levels: the z score is the largest of theirs or, where it is larger, their sum over the square root of their number
/// (Stouffer's method).
///
/// The levels are halvings of one map and depend on each other, so the combined score is not that of a standard normal variable, as it
/// would be for independent levels.
pub fn combine_levels(levels: &[Level]) -> Evidence {
    let sums: Vec<&TileSums> =
        levels.iter().map(|level| &level.tile_sums).filter(|sums| sums.tiles >= MIN_TILES).collect();
    let largest_by =
        |key: &dyn Fn(f64) -> f64| sums.iter().max_by(|a, b| key(a.z_score()).total_cmp(&key(b.z_score())));
    let Some(largest) = largest_by(&f64::abs) else { return Evidence::default() };
    let combined = sums.iter().map(|sums| sums.z_score()).sum::<f64>() / (sums.len() as f64).sqrt();
    let z_score = if combined.abs() > largest.z_score().abs() { combined } else { largest.z_score() };
    let clearest = largest_by(&|score| score * z_score).unwrap_or(largest);
    let has_enough_signal = |sums: &&TileSums| {
        sums.tiles >= MIN_TILES_FOR_NO_GRADIENT && sums.energy > MIN_SIGNAL * sums.texels * 4.0
    };
    Evidence {
        correlation: clearest.mean(clearest.correlations),
        z_score,
        log_energy_ratio: clearest.mean(clearest.log_energy_ratios),
        has_enough_signal: sums.iter().any(has_enough_signal),
    }
}

impl TileSums {
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
            () if self.z_score.abs() >= MIN_Z_SCORE.into()
                && self.log_energy_ratio <= MAX_EXCHANGED_RATIO.into() =>
            {
                MapVerdict::NoGradient
            }
            () if self.z_score >= MIN_Z_SCORE.into() => MapVerdict::OpenGl,
            () if self.z_score <= -f64::from(MIN_Z_SCORE) => MapVerdict::DirectX,
            () if self.has_enough_signal => MapVerdict::NoGradient,
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
        level.tile_sums.tiles = 101;
        level.tile_sums.correlations = 101.0 * 0.01 * z_score;
        level.tile_sums.squared_correlations = level.tile_sums.correlations.powi(2) / 101.0;
        level
    }

    /// One level against four others, and one that is not.
    #[test]
    fn correlation_and_z_score_have_one_sign() {
        for sign in [1.0, -1.0] {
            let reversed =
                combine_levels(&[5.0, -4.0, -4.9, -4.8, -4.7].map(|z_score| level(sign * z_score)));
            assert!((reversed.z_score * sign + 13.4 / 5.0f64.sqrt()).abs() < 1e-9, "{reversed:?}");
            assert!((reversed.correlation * sign + 0.049).abs() < 1e-9, "{reversed:?}");
            let clear = combine_levels(&[5.0, -4.0, 1.0].map(|z_score| level(sign * z_score)));
            assert!((clear.z_score * sign - 5.0).abs() < 1e-9, "{clear:?}");
            assert!((clear.correlation * sign - 0.05).abs() < 1e-9, "{clear:?}");
        }
    }
}
