//! Combines the correlations of all tiles and all levels of a normal map into one score and its confidence.

use super::judgement::{MIN_Z_SCORE, MapVerdict};
use super::level::{Level, TileSums};

/// The fewest tiles of a level that has a z score.
const MIN_TILES: usize = 16;

/// The fewest tiles of a level that shows that there is no gradient.
const MIN_TILES_FOR_NO_GRADIENT: usize = 256;

/// The smallest mean square of differences that is neither rounding nor compression: eight codes of 8 bits.
const MIN_SIGNAL: f64 = (16.0 / 255.0) * (16.0 / 255.0);

/// The smallest absolute mean correlation that decides. The z score knows chance only, while details finer than a texel (aliasing) and
/// compression shift the mean by some hundredths.
const MIN_CORRELATION: f64 = 0.07;

/// From this absolute z score on, smaller correlations decide, too: they come from large maps with much noise.
const CLEAR_Z_SCORE: f64 = 6.5;

/// The largest z score of a level of the other sign, as a part of the z score. Where levels contradict each other, details are finer than a texel.
const MAX_CONTRADICTION: f64 = 2.0 / 3.0;

/// The largest log energy ratio of exchanged channels, and its largest z score. That of a gradient is not negative, so the sign of the correlation
/// needs less certainty than otherwise: this absolute z score.
const MAX_EXCHANGED_RATIO: f64 = -0.02;
const MAX_EXCHANGED_RATIO_Z_SCORE: f64 = -3.0;
const MIN_EXCHANGED_Z_SCORE: f64 = 2.0;

/// The largest log energy ratio of a map without a sign that is called no gradient: it is 0 for noise, whose derivatives are independent, and for
/// pictures, whose red and green change together. Slopes of threads or grooves along u and v have little mixed energy and much more unmixed energy.
const MAX_RATIO_OF_NOISE: f64 = 0.3;

/// The steepness of the confidence over the z score, less that of the level that contradicts it most.
const STEEPNESS: f64 = 1.1;

/// The steepness of the confidence that red and green are not exchanged, over the z score of the log energy ratio.
const EXCHANGE_STEEPNESS: f64 = 2.0;

/// The natural logarithm of the odds, before the texels are seen, that red and green are not exchanged: 30 to 1.
const EXCHANGE_ODDS: f64 = 3.4;

/// The largest confidence of a verdict, and of the likelier sign without one.
pub const MAX_CONFIDENCES: [f64; 2] = [0.998, 0.93];

/// The evidence of all levels.
#[derive(Clone, Copy, Debug, Default)]
pub struct Evidence {
    /// The mean correlation of the clearest level whose sign is that of `z_score`.
    pub correlation: f64,
    /// The index of that level.
    pub level: usize,
    /// The largest of the levels' z scores, or all of them combined.
    pub z_score: f64,
    /// The largest absolute z score of a level whose sign is not that of `z_score`.
    contradiction: f64,
    /// The log energy ratio of the level of `correlation`, and its mean over its standard error.
    pub log_energy_ratio: f64,
    ratio_z_score: f64,
    /// Whether a gradient would be visible: enough tiles, with differences that are more than rounding and compression.
    has_enough_signal: bool,
}

/// Combines the levels: the z score is the largest of theirs or, where it is larger, their sum over the square root of their number
/// (Stouffer's method).
///
/// The levels are halvings of one map and depend on each other, so the combined score is not that of a standard normal variable, as it
/// would be for independent levels.
pub fn combine_levels(levels: &[Level]) -> Evidence {
    let sums: Vec<(usize, &TileSums)> = levels
        .iter()
        .map(|level| &level.tile_sums)
        .enumerate()
        .filter(|(_, sums)| sums.tiles >= MIN_TILES)
        .collect();
    let largest_by = |key: &dyn Fn(f64) -> f64| {
        sums.iter().copied().max_by(|(_, a), (_, b)| key(a.z_score()).total_cmp(&key(b.z_score())))
    };
    let Some((index, largest)) = largest_by(&f64::abs) else { return Evidence::default() };
    let combined = sums.iter().map(|(_, sums)| sums.z_score()).sum::<f64>() / (sums.len() as f64).sqrt();
    let z_score = if combined.abs() > largest.z_score().abs() { combined } else { largest.z_score() };
    let (level, clearest) = largest_by(&|score| score * z_score).unwrap_or((index, largest));
    let has_enough_signal = |(_, sums): &(usize, &TileSums)| {
        sums.tiles >= MIN_TILES_FOR_NO_GRADIENT && sums.energy > MIN_SIGNAL * sums.texels * 4.0
    };
    let against = sums.iter().map(|(_, sums)| -sums.z_score() * z_score.signum());
    Evidence {
        correlation: clearest.mean(clearest.correlations),
        level,
        z_score,
        contradiction: against.fold(0.0, f64::max),
        log_energy_ratio: clearest.mean(clearest.log_energy_ratios),
        ratio_z_score: clearest.z_score_of(clearest.log_energy_ratios, clearest.squared_log_energy_ratios),
        has_enough_signal: sums.iter().any(has_enough_signal),
    }
}

impl TileSums {
    fn mean(&self, sum: f64) -> f64 {
        sum / self.tiles as f64
    }

    /// The mean correlation over its standard error.
    fn z_score(&self) -> f64 {
        self.z_score_of(self.correlations, self.squared_correlations)
    }

    /// The mean over its standard error of values with these sums. A floor of the variance keeps few equal tiles from certainty.
    fn z_score_of(&self, sum: f64, squares: f64) -> f64 {
        let mean = self.mean(sum);
        let variance = (self.mean(squares) - mean * mean).max(0.01);
        mean / (variance / (self.tiles - 1) as f64).sqrt()
    }
}

impl Evidence {
    /// Whether there is a gradient so clear that texels that are no normals belong to a background that compression has blurred.
    pub fn is_clear_gradient(&self) -> bool {
        self.z_score.abs() >= 4.0 * f64::from(MIN_Z_SCORE)
            && self.correlation.abs() >= 0.3
            && self.log_energy_ratio >= 0.1
    }

    pub fn verdict(&self) -> MapVerdict {
        let has_sign = self.z_score.abs() >= MIN_Z_SCORE.into();
        match () {
            () if self.is_exchanged() => MapVerdict::NoGradient,
            () if self.is_decided() && self.z_score > 0.0 => MapVerdict::OpenGl,
            () if self.is_decided() => MapVerdict::DirectX,
            () if !has_sign && self.has_enough_signal && self.log_energy_ratio <= MAX_RATIO_OF_NOISE => {
                MapVerdict::NoGradient
            }
            () => MapVerdict::CannotTell,
        }
    }

    /// Whether red and green seem to be exchanged.
    pub fn is_exchanged(&self) -> bool {
        self.log_energy_ratio <= MAX_EXCHANGED_RATIO
            && self.ratio_z_score <= MAX_EXCHANGED_RATIO_Z_SCORE
            && self.z_score.abs() >= MIN_EXCHANGED_Z_SCORE
    }

    fn is_decided(&self) -> bool {
        let z_score = self.z_score.abs();
        let is_strong = self.correlation.abs() >= MIN_CORRELATION || z_score >= CLEAR_Z_SCORE;
        z_score >= MIN_Z_SCORE.into() && is_strong && self.contradiction <= MAX_CONTRADICTION * z_score
    }

    /// An estimate of the probability that the verdict is right; without one, that the sign of the z score is right. `NoGradient` without
    /// exchanged channels has the largest confidence of maps without a verdict.
    ///
    /// Logistic functions. The first steepness was fitted to generated maps with even numbers and tested on those with odd ones, many of them
    /// so flat that some signs are wrong; the second one to the energy ratios of such maps (`cargo xtask maps`). The estimate stays below 1 because compression and details finer than a texel can have a direction of
    /// their own.
    pub fn confidence(&self) -> f64 {
        let logistic = |x: f64| 1.0 / (1.0 + (-x).exp());
        let of_sign = logistic(STEEPNESS * (self.z_score.abs() - self.contradiction));
        let of_order = logistic(EXCHANGE_ODDS + EXCHANGE_STEEPNESS * self.ratio_z_score);
        let [largest, largest_without_verdict] = MAX_CONFIDENCES;
        match self.verdict() {
            MapVerdict::NoGradient if self.is_exchanged() => (1.0 - of_order).min(largest),
            MapVerdict::NoGradient => largest_without_verdict,
            MapVerdict::OpenGl | MapVerdict::DirectX => of_sign.min(largest) * of_order,
            MapVerdict::Flat | MapVerdict::CannotTell => of_sign.min(largest_without_verdict),
        }
        .max(0.5)
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

    /// Maps with a signal and no sign are noise where their energies are equal, and undecided where the unmixed one is much larger.
    #[test]
    fn threads_along_the_axes_are_not_called_noise() {
        for (ratio, verdict) in [(0.0, MapVerdict::NoGradient), (1.5, MapVerdict::CannotTell)] {
            let mut noise = level(1.0);
            noise.tile_sums.tiles = MIN_TILES_FOR_NO_GRADIENT;
            (noise.tile_sums.energy, noise.tile_sums.texels) = (1.0, 1.0);
            noise.tile_sums.log_energy_ratios = ratio * MIN_TILES_FOR_NO_GRADIENT as f64;
            assert_eq!(combine_levels(&[noise]).verdict(), verdict, "{ratio}");
        }
    }

    /// Contradicting levels and small correlations decide nothing.
    #[test]
    fn aliased_maps_get_no_verdict() {
        let verdict = |z_scores: &[f64]| {
            let levels: Vec<Level> = z_scores.iter().map(|&z_score| level(z_score)).collect();
            combine_levels(&levels).verdict()
        };
        assert_eq!(verdict(&[20.0, 3.0]), MapVerdict::OpenGl);
        assert_eq!(verdict(&[-20.0, 10.0]), MapVerdict::DirectX);
        assert_eq!(verdict(&[-20.0, 15.0]), MapVerdict::CannotTell);
        // Mean correlations of 0.06 and 0.07.
        assert_eq!(verdict(&[6.0]), MapVerdict::CannotTell);
        assert_eq!(verdict(&[7.0]), MapVerdict::OpenGl);
    }
}
