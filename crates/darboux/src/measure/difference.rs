//! The comparison of two sets of tangents.
//!
//! Blocks of corners are compared on all threads, and what they sum is added in the order of the corners. Of
//! each corner that differs, only the angle is kept, from which the median and the 95th percentile are
//! selected: 8 bytes per corner at most.

use std::ops::Range;

use super::angle::{angle_of, xyz};
use crate::Context;
use crate::Error;
use crate::exec::blocks::fold_blocks;
use crate::math_f64::unit;

/// The maximum length of [`TangentDifference::worst`].
const MAX_WORST_CORNERS: usize = 16;

/// The difference of two sets of tangents of one mesh. Angles are in degrees, between the xyz of one corner
/// in both sets.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct TangentDifference {
    /// The number of corners.
    pub corners: usize,
    /// Corners that [are identical](CornerDifference::is_identical).
    pub identical: usize,
    /// Corners that [flip the sign](CornerDifference::flips_sign).
    pub sign_flips: usize,
    /// Corners without an angle, because a tangent is zero or not finite. The fields below ignore them.
    pub without_angle: usize,
    /// The mean angle. It does not depend on the number of threads.
    pub mean: f64,
    /// The smallest angle.
    pub min: f64,
    /// The median angle.
    pub median: f64,
    /// The 95th percentile of the angles.
    pub p95: f64,
    /// The largest angle.
    pub max: f64,
    /// The number of corners per bin of [`TangentDifference::HISTOGRAM_BIN_ENDS`].
    pub histogram: [usize; 10],
    /// Up to 16 corners with the largest angles above zero, and the angles: descending by angle, then
    /// ascending by corner.
    pub worst: Vec<(usize, f64)>,
}

impl TangentDifference {
    /// The upper end of each bin of the histogram, in degrees. A bin excludes the end of the previous bin.
    pub const HISTOGRAM_BIN_ENDS: [f64; 10] = [0.0, 0.001, 0.01, 0.1, 1.0, 5.0, 15.0, 45.0, 90.0, 180.0];
}

/// The difference of two tangents of one corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CornerDifference {
    /// The angle between the xyz in degrees. `None` where one of them is zero or not finite.
    pub angle: Option<f64>,
    /// True when exactly one w is below zero. Values other than 1 and -1 (0.99, NaN) count by that rule.
    pub flips_sign: bool,
    /// True when all four floats have equal bits or are NaN in both.
    pub is_identical: bool,
}

impl CornerDifference {
    /// Compares two tangents, each unit xyz and sign w.
    pub fn between(a: [f32; 4], b: [f32; 4]) -> Self {
        let is_same = |(a, b): (&f32, &f32)| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
        let is_identical = a.iter().zip(&b).all(is_same);
        let [first, second] = [a, b].map(|tangent| xyz(tangent).map(f64::from));
        // The products of equal vectors are equal, so the arctangent of identical ones is zero.
        let angle = if is_identical { unit(first).map(|_| 0.0) } else { angle_of(first, second) };
        Self { angle, flips_sign: (a[3] < 0.0) != (b[3] < 0.0), is_identical }
    }

    /// True when the tangents are not identical and have no angle.
    pub fn is_unknown(&self) -> bool {
        self.angle.is_none() && !self.is_identical
    }
}

/// Corners per block. The blocks are part of the result: the mean is a sum of their sums.
const BLOCK: usize = if cfg!(small_limits) { 2 } else { 1 << 16 };

/// Compares two sets of tangents, corner by corner.
///
/// `a`, `b`: one tangent per corner ([`CornerTangents::per_corner`](crate::CornerTangents::per_corner)) of
/// the same mesh, in the same convention. Errors: different lengths.
pub fn measure_tangents(a: &[[f32; 4]], b: &[[f32; 4]]) -> Result<TangentDifference, Error> {
    measure_tangents_with(a, b, &mut Context::new())
}

/// As [`measure_tangents`], with a context. Further error: the context's token was cancelled.
pub fn measure_tangents_with(
    a: &[[f32; 4]],
    b: &[[f32; 4]],
    context: &mut Context,
) -> Result<TangentDifference, Error> {
    Error::check_input("tangents", a.len(), b.len())?;
    let limits = context.limits();
    let (mut sums, mut angles, mut worst) = (DifferenceSums::default(), Vec::new(), Vec::new());
    let compare = |block: Range<usize>| {
        let (mut sums, mut angles, mut worst) = (DifferenceSums::default(), Vec::new(), Vec::new());
        for corner in limits.parts(block).flatten() {
            let difference = CornerDifference::between(a[corner], b[corner]);
            sums.add(&difference, &mut angles);
            insert_worst(&mut worst, corner, difference.angle);
        }
        (sums, angles, worst)
    };
    fold_blocks(limits, a.len(), BLOCK, compare, |(of_block, more, worst_of_block)| {
        sums.append(&of_block);
        angles.extend_from_slice(&more);
        worst_of_block.into_iter().for_each(|(corner, angle)| insert_worst(&mut worst, corner, Some(angle)));
    })?;
    Ok(TangentDifference { worst, ..sums.difference(&mut angles) })
}

/// Inserts a corner into the list of [`TangentDifference::worst`]. Corners come in ascending order, so a
/// later one follows those of its angle.
fn insert_worst(worst: &mut Vec<(usize, f64)>, corner: usize, angle: Option<f64>) {
    let Some(angle) = angle.filter(|angle| *angle > 0.0) else { return };
    if worst.len() == MAX_WORST_CORNERS && worst.last().is_some_and(|(_, least)| angle <= *least) {
        return;
    }
    worst.insert(worst.partition_point(|(_, other)| *other >= angle), (corner, angle));
    worst.truncate(MAX_WORST_CORNERS);
}

/// The counts and sums of a [`TangentDifference`], which corners and later sums are added to. The angles
/// above zero are in a list beside it.
#[derive(Clone, Debug, Default)]
pub struct DifferenceSums {
    corners: usize,
    identical: usize,
    sign_flips: usize,
    without_angle: usize,
    sum: f64,
    max: f64,
    histogram: [usize; 10],
}

impl DifferenceSums {
    /// Adds a corner. Its angle is appended to `angles` if it is above zero.
    pub fn add(&mut self, difference: &CornerDifference, angles: &mut Vec<f64>) {
        self.corners += 1;
        self.identical += usize::from(difference.is_identical);
        self.sign_flips += usize::from(difference.flips_sign);
        let Some(angle) = difference.angle else {
            self.without_angle += 1;
            return;
        };
        let bin = TangentDifference::HISTOGRAM_BIN_ENDS.partition_point(|end| *end < angle);
        self.histogram[bin.min(self.histogram.len() - 1)] += 1;
        if angle > 0.0 {
            self.sum += angle;
            self.max = self.max.max(angle);
            angles.push(angle);
        }
    }

    /// Adds the sums of later corners.
    pub fn append(&mut self, later: &Self) {
        self.corners += later.corners;
        self.identical += later.identical;
        self.sign_flips += later.sign_flips;
        self.without_angle += later.without_angle;
        self.sum += later.sum;
        self.max = self.max.max(later.max);
        self.histogram.iter_mut().zip(later.histogram).for_each(|(bin, more)| *bin += more);
    }

    /// The difference, without a list of the worst corners. `angles`: the angles above zero of these corners;
    /// their order changes.
    pub fn difference(&self, angles: &mut [f64]) -> TangentDifference {
        let count = self.corners - self.without_angle;
        let zeros = count - angles.len();
        let least = angles.iter().copied().reduce(f64::min);
        let [median, p95] = [0.5, 0.95].map(|part| quantile(zeros, angles, part));
        TangentDifference {
            corners: self.corners,
            identical: self.identical,
            sign_flips: self.sign_flips,
            without_angle: self.without_angle,
            mean: self.sum / (count.max(1) as f64),
            min: least.filter(|_| zeros == 0).unwrap_or(0.0),
            median,
            p95,
            max: self.max,
            histogram: self.histogram,
            worst: Vec::new(),
        }
    }
}

/// The smallest angle that the fraction `part` of the corners does not exceed, 0 if there are none. `zeros`:
/// the number of angles that are zero; `angles`: the others, whose order changes.
fn quantile(zeros: usize, angles: &mut [f64], part: f64) -> f64 {
    let count = zeros + angles.len();
    let within = (part * count as f64).ceil() as usize;
    let rank = within.clamp(1, count.max(1)) - 1;
    match rank.checked_sub(zeros) {
        Some(above) if above < angles.len() => *angles.select_nth_unstable_by(above, f64::total_cmp).1,
        _ => 0.0,
    }
}
