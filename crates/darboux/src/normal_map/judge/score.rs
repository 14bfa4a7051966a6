//! Combines the correlations of all tiles and all levels of a normal map into one score and its confidence.

use super::judgement::{MIN_Z_SCORE, MapJudgement, MapVerdict};
use super::level::{Level, TileSums};
use super::octaves::octaves;
use super::spectrum::Octave;

/// The fewest tiles of a level that has a z score.
const MIN_TILES: usize = 16;

/// The fewest tiles of a level that shows that there is no gradient.
const MIN_TILES_FOR_NO_GRADIENT: usize = 256;

/// The smallest mean square of differences that is neither rounding nor compression: eight codes of 8 bits.
const MIN_SIGNAL: f64 = (16.0 / 255.0) * (16.0 / 255.0);

/// The weights of the evidence in the logarithm of the odds of a sign: of the votes' z score, limited to
/// [`LARGEST_VOTES`]; of the inverse hyperbolic sine of the shift score; of the relief's correlation. Fitted
/// by logistic regression to blocks of 16 to 256 texels of real maps whose convention is known, a
/// tenth smaller than the likeliest ones (docs/notes/real-normal-maps.md).
const VOTES_WEIGHT: f64 = 0.23;
const SHIFT_WEIGHT: f64 = 1.35;
const RELIEF_WEIGHT: f64 = 4.0;

/// The limit of the votes' z score: whatever their number, they count tiles of noise like tiles of relief,
/// and tiles that repeat like independent ones.
const LARGEST_VOTES: f64 = 5.0;

/// What the logarithm of the odds is corrected by, at most: weak evidence says less than the sum of its
/// weights, and clear evidence more, because real maps hold either little relief or much. Fitted to the share
/// of right signs of the same blocks.
const CALIBRATION: f64 = 0.6;

/// The smallest probability of a sign that is a verdict.
const MIN_PROBABILITY: f64 = 0.97;

/// The relief's correlation and the shift score from which on the two contradict each other, where their
/// signs differ.
const MIN_RELIEF: f64 = 0.1;
const MIN_SHIFT_SCORE: f64 = 1.0;

/// The relief's correlation from which on a verdict outweighs texels that are no normals.
const MIN_RELIEF_OF_GRADIENT: f64 = 0.25;

/// The largest probability of a sign that one of these two contradicts.
const CONTRADICTED_PROBABILITY: f64 = 0.6;

/// The absolute z score from which votes contradict the relief.
const OPPOSED_Z_SCORE: f64 = 6.5;

/// The probability of the relief's sign from which votes can contradict it.
const OPPOSED_PROBABILITY: f64 = 0.8;

/// The largest log energy ratio of exchanged channels, and its largest z score. That of a gradient is not
/// negative, so the sign of the correlation needs less certainty than otherwise: this absolute z score.
const MAX_EXCHANGED_RATIO: f64 = -0.02;
const MAX_EXCHANGED_RATIO_Z_SCORE: f64 = -4.0;
const MIN_EXCHANGED_Z_SCORE: f64 = 2.0;

/// The smallest sum of both residuals of exchanged channels: where the log energy ratio is clear, and where
/// it is not. Exchanging red and green makes each residual the rest to one of the other convention's, so that
/// the channels fit a height field better as they are where the sum is below one, less what noise adds. Of
/// 60 generated maps with exchanged channels, the least have 0.95 and 1.14. Noise of one code in most tiles
/// outvotes a relief in few, but has no energy: real maps in their order had 0.68, and 1.10 after reduction.
const MIN_EXCHANGED_RESIDUALS: [f64; 2] = [0.9, 1.12];
const CLEAR_EXCHANGED_RATIO: f64 = -0.3;

/// The largest log energy ratio of a map without a sign that is called no gradient: it is 0 for noise, whose
/// derivatives are independent, and for pictures, whose red and green change together. Slopes of threads or
/// grooves along u and v have little mixed energy and much more unmixed energy.
const MAX_RATIO_OF_NOISE: f64 = 0.3;

/// The steepness of the confidence that red and green are not exchanged, over the z score of the log energy
/// ratio.
const EXCHANGE_STEEPNESS: f64 = 2.0;

/// The natural logarithm of the odds, before the texels are seen, that red and green are not exchanged: 90 to
/// 1. One of 496 real maps has exchanged channels.
const EXCHANGE_ODDS: f64 = 4.5;

/// The confidence of verdicts that the counts of texels give: grey maps, maps in object space, and texels
/// that are no normals.
pub const CONFIDENCE_OF_COUNTS: f64 = 0.998;

/// The confidence that a map without a sign is no gradient.
const CONFIDENCE_WITHOUT_SIGN: f64 = 0.93;

/// The evidence of all levels.
#[derive(Clone, Copy, Debug, Default)]
pub struct Evidence {
    /// The mean correlation of the clearest level whose sign is that of `z_score`.
    correlation: f64,
    /// The index of that level.
    pub level: usize,
    /// The largest of the levels' z scores, or all of them combined.
    z_score: f64,
    /// The mean of the correlations of all levels, weighted by energy.
    relief: f64,
    /// The second witness: all wavelengths together.
    spectrum: Octave,
    /// The largest absolute z score of a level whose sign is not that of `z_score`.
    contradiction: f64,
    /// The log energy ratio of the level of `correlation`, and its mean over its standard error.
    log_energy_ratio: f64,
    ratio_z_score: f64,
    /// Whether a gradient would be visible: enough tiles, with differences that are more than rounding and
    /// compression.
    has_enough_signal: bool,
}

/// Combines the levels: the z score is the largest of theirs or, where it is larger, their sum over the
/// square root of their number (Stouffer's method).
///
/// The levels are halvings of one map and depend on each other, so the combined score is not that of a
/// standard normal variable, as it would be for independent levels.
pub fn combine_levels(levels: &[Level]) -> Evidence {
    let weighed = Evidence { relief: relief(levels), spectrum: spectrum_of(levels), ..Evidence::default() };
    let sums: Vec<(usize, &TileSums)> = levels
        .iter()
        .map(|level| &level.tile_sums)
        .enumerate()
        .filter(|(_, sums)| sums.tiles >= MIN_TILES)
        .collect();
    let largest_by = |key: &dyn Fn(f64) -> f64| {
        sums.iter().copied().max_by(|(_, a), (_, b)| key(a.z_score()).total_cmp(&key(b.z_score())))
    };
    let Some((index, largest)) = largest_by(&f64::abs) else { return weighed };
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
        ..weighed
    }
}

/// The correlation of all tiles of all levels, weighted by energy.
fn relief(levels: &[Level]) -> f64 {
    let sum = |of: fn(&TileSums) -> f64| levels.iter().map(|level| of(&level.tile_sums)).sum::<f64>();
    let weights = sum(|sums| sums.weights);
    if weights > 0.0 { sum(|sums| sums.weighted_correlations) / weights } else { 0.0 }
}

/// The second witness over all wavelengths.
fn spectrum_of(levels: &[Level]) -> Octave {
    octaves(levels).iter().fold(Octave::default(), |mut sum, octave| {
        sum.add(octave);
        sum
    })
}

impl TileSums {
    fn mean(&self, sum: f64) -> f64 {
        sum / self.tiles as f64
    }

    /// The mean correlation over its standard error.
    fn z_score(&self) -> f64 {
        self.z_score_of(self.correlations, self.squared_correlations)
    }

    /// The mean over its standard error of values with these sums. A floor of the variance keeps few equal
    /// tiles from certainty.
    fn z_score_of(&self, sum: f64, squares: f64) -> f64 {
        let mean = self.mean(sum);
        let variance = (self.mean(squares) - mean * mean).max(0.01);
        mean / (variance / (self.tiles - 1) as f64).sqrt()
    }
}

impl Evidence {
    /// Whether there is a gradient so clear that texels that are no normals belong to a background that
    /// compression has blurred, or to slopes that were stored without being normalised. The energies of
    /// pictures, whose channels change together, are equal.
    pub fn is_clear_gradient(&self) -> bool {
        let are_clear_votes =
            self.z_score.abs() >= 4.0 * f64::from(MIN_Z_SCORE) && self.correlation.abs() >= 0.3;
        let is_clear_relief = self.is_decided() && self.relief.abs() >= MIN_RELIEF_OF_GRADIENT;
        self.log_energy_ratio >= 0.1 && (are_clear_votes || is_clear_relief)
    }

    pub fn verdict(&self) -> MapVerdict {
        let has_sign = self.z_score.abs() >= MIN_Z_SCORE.into();
        if self.is_exchanged() {
            MapVerdict::NoGradient
        } else if self.is_decided() && self.sign_score() > 0.0 {
            MapVerdict::OpenGl
        } else if self.is_decided() {
            MapVerdict::DirectX
        } else if !has_sign && self.has_enough_signal && self.log_energy_ratio <= MAX_RATIO_OF_NOISE {
            MapVerdict::NoGradient
        } else {
            MapVerdict::CannotTell
        }
    }

    /// Whether red and green seem to be exchanged.
    pub fn is_exchanged(&self) -> bool {
        self.log_energy_ratio <= MAX_EXCHANGED_RATIO
            && self.ratio_z_score <= MAX_EXCHANGED_RATIO_Z_SCORE
            && self.z_score.abs() >= MIN_EXCHANGED_Z_SCORE
            && !self.fits_in_order()
    }

    /// Whether a height field explains more of the slopes with the channels in their order than with red and
    /// green exchanged.
    fn fits_in_order(&self) -> bool {
        let [clear, unclear] = MIN_EXCHANGED_RESIDUALS;
        let least = if self.log_energy_ratio <= CLEAR_EXCHANGED_RATIO { clear } else { unclear };
        self.spectrum.residuals().iter().sum::<f64>() < least
    }

    /// The logarithm of the odds that green points up.
    fn sign_score(&self) -> f64 {
        let votes = (self.z_score.abs() - self.contradiction).max(0.0).copysign(self.z_score);
        let votes = votes / (1.0 + votes.abs() / LARGEST_VOTES);
        let shift = self.spectrum.shift_score().asinh();
        VOTES_WEIGHT * votes + SHIFT_WEIGHT * shift + RELIEF_WEIGHT * self.relief
    }

    /// The probability of the likelier sign.
    fn sign_probability(&self) -> f64 {
        let score = self.sign_score().abs();
        let calibrated = score + CALIBRATION * (score - 1.0) / (1.0 + (score - 1.0).abs());
        let probability = logistic(calibrated.max(0.0));
        if self.is_contradicted() { probability.min(CONTRADICTED_PROBABILITY) } else { probability }
    }

    /// Whether the relief and the second witness contradict each other. The spectrum overlooks what lies at
    /// the ends of its blocks, and the relief counts slopes that no height field explains: neither is
    /// right more often than the other.
    fn is_contradicted(&self) -> bool {
        let shift_score = self.spectrum.shift_score();
        self.relief * shift_score < 0.0
            && self.relief.abs() >= MIN_RELIEF
            && shift_score.abs() >= MIN_SHIFT_SCORE
    }

    fn is_decided(&self) -> bool {
        self.sign_probability() >= MIN_PROBABILITY
    }

    /// Whether the plain votes contradict the relief.
    fn has_opposed_detail(&self) -> bool {
        let is_opposed = self.z_score * self.sign_score() < 0.0 && self.z_score.abs() >= OPPOSED_Z_SCORE;
        is_opposed && self.sign_probability() >= OPPOSED_PROBABILITY
    }

    /// The correlation and the z score that are reported: those of the votes, or, where these contradict the
    /// verdict or there are none, those of the relief and of the shifts; if the shifts contradict it,
    /// too, the logarithm of the odds.
    fn reported(&self) -> [f64; 2] {
        let sign = self.sign_score();
        if self.z_score * sign > 0.0 {
            return [self.correlation, self.z_score];
        }
        let shift_score = self.spectrum.shift_score();
        let with_sign = |value: f64, otherwise: f64| if value * sign > 0.0 { value } else { otherwise };
        [with_sign(self.relief, 0.0), with_sign(shift_score, sign)]
    }

    /// Writes the numbers, without a verdict.
    pub fn write(&self, judgement: &mut MapJudgement) {
        let [correlation, z_score] = self.reported();
        judgement.correlation = correlation as f32;
        judgement.z_score = z_score as f32;
        judgement.relief_correlation = self.relief as f32;
        judgement.shift_score = self.spectrum.shift_score() as f32;
        judgement.residuals = self.spectrum.residuals().map(|residual| residual as f32);
        judgement.has_opposed_detail = self.has_opposed_detail();
        judgement.log_energy_ratio = self.log_energy_ratio as f32;
        judgement.is_exchanged = self.is_exchanged();
    }

    /// An estimate of the probability that the verdict is right; without one, that the likelier sign is
    /// right. `NoGradient` without exchanged channels has the largest confidence of maps without a
    /// verdict.
    ///
    /// Logistic functions: of the sign score, and of the energy ratio for the order of the channels, fitted
    /// to generated maps (`cargo xtask maps`).
    pub fn confidence(&self) -> f64 {
        let of_sign = self.sign_probability();
        let ratio_z_score =
            if self.fits_in_order() { self.ratio_z_score.max(0.0) } else { self.ratio_z_score };
        let of_order = logistic(EXCHANGE_ODDS + EXCHANGE_STEEPNESS * ratio_z_score);
        match self.verdict() {
            MapVerdict::NoGradient if self.is_exchanged() => 1.0 - of_order,
            MapVerdict::NoGradient => CONFIDENCE_WITHOUT_SIGN,
            MapVerdict::OpenGl | MapVerdict::DirectX => of_sign * of_order,
            MapVerdict::Flat | MapVerdict::CannotTell => of_sign,
        }
        .max(0.5)
    }
}

fn logistic(x: f64) -> f64 {
    1.0 / (1.0 + (-x).exp())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A level of 101 tiles whose mean correlation has this z score: the variance is at its floor.
    fn level(z_score: f64) -> Level {
        let mut level = Level::new(0, 16, None);
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

    /// Maps with a signal and no sign are noise where their energies are equal, and undecided where the
    /// unmixed one is much larger.
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

    /// Votes alone decide nothing, and the relief outvotes them: then they are opposed detail.
    #[test]
    fn relief_outvotes_tiles_of_noise() {
        let judged = |z_score: f64, relief: f64| {
            let mut level = level(z_score);
            (level.tile_sums.weights, level.tile_sums.weighted_correlations) = (1.0, relief);
            let evidence = combine_levels(&[level]);
            (evidence.verdict(), evidence.has_opposed_detail(), evidence.reported()[1] < 0.0)
        };
        assert_eq!(judged(100.0, 0.0).0, MapVerdict::CannotTell);
        assert_eq!(judged(7.0, 0.8), (MapVerdict::OpenGl, false, false));
        assert_eq!(judged(7.0, -0.05), (MapVerdict::CannotTell, false, false));
        let (verdict, has_opposed_detail, _) = judged(40.0, -0.99);
        assert_eq!((verdict, has_opposed_detail), (MapVerdict::CannotTell, true));
    }
}
