//! The statistics of a comparison: angles between tangents, flipped signs, and the worst corners.

use std::collections::HashSet;

use darboux::internal::triangle_area;
use darboux::{CornerDifference, TangentDifference, measure_tangents};
use darboux_io::gltf::{Pair, PairedCorners, PrimitiveName};
use serde::Serialize;

/// Angles up to this, in degrees, may come from rounding or compression.
pub const ROUNDING: f64 = 0.01;

/// How two sets of tangents differ. Angles are in degrees.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Statistics {
    pub corners: usize,
    pub identical: usize,
    pub sign_flips: usize,
    pub without_angle: usize,
    /// Corners without an angle that are not identical: their difference is unknown.
    pub unknown: usize,
    /// Corners whose angle exceeds [`ROUNDING`], whose signs are opposite, or whose difference is unknown.
    pub different: usize,
    pub min: f64,
    pub median: f64,
    pub p95: f64,
    pub max: f64,
    pub mean: f64,
    /// The mean angle; the weight of a corner is a third of its triangle's area.
    pub area_weighted_mean: f64,
    pub histogram: Vec<Bin>,
}

/// The number of corners whose angle is at most `up_to` and above that of the previous bin.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Bin {
    pub up_to: f64,
    pub corners: usize,
}

impl Statistics {
    /// The statistics of several primitives together.
    pub fn of<'a>(primitives: impl Iterator<Item = &'a PairedCorners>) -> Self {
        let (mut tangents, mut others) = (Vec::new(), Vec::new());
        let (mut sum, mut area, mut unknown, mut different) = (0.0, 0.0, 0, 0);
        for corners in primitives {
            tangents.extend_from_slice(&corners.tangents[0]);
            others.extend_from_slice(&corners.tangents[1]);
            let (part, part_area) = area_weighted(corners);
            (sum, area) = (sum + part, area + part_area);
            unknown += differences(corners).filter(CornerDifference::is_unknown).count();
            different += differences(corners).filter(is_more_than_rounding).count();
        }
        let found = measure_tangents(&tangents, &others).unwrap_or_default();
        let bins = TangentDifference::HISTOGRAM_BIN_ENDS.into_iter().zip(found.histogram);
        Self {
            corners: found.corners,
            identical: found.identical,
            sign_flips: found.sign_flips,
            without_angle: found.without_angle,
            unknown,
            different,
            min: found.min,
            median: found.median,
            p95: found.p95,
            max: found.max,
            mean: found.mean,
            area_weighted_mean: if area > 0.0 { sum / area } else { 0.0 },
            histogram: bins.map(|(up_to, corners)| Bin { up_to, corners }).collect(),
        }
    }

    /// Whether no angle is larger, no sign is opposite and no difference is unknown.
    pub fn is_within(&self, degrees: f64) -> bool {
        self.max <= degrees && self.sign_flips == 0 && self.unknown == 0
    }
}

/// The difference at each corner.
pub fn differences(corners: &PairedCorners) -> impl Iterator<Item = CornerDifference> {
    let [tangents, others] = &corners.tangents;
    tangents.iter().zip(others).map(|(a, b)| CornerDifference::between(*a, *b))
}

fn is_more_than_rounding(difference: &CornerDifference) -> bool {
    difference.flips_sign || difference.is_unknown() || difference.angle > Some(ROUNDING)
}

/// Returns the sum of angle times weight and the sum of the weights; the weight of a corner is a third of its triangle's area.
fn area_weighted(corners: &PairedCorners) -> (f64, f64) {
    let thirds = corners.positions.as_chunks::<3>().0.iter().flat_map(|&triangle| {
        let third = triangle_area(triangle) / 3.0;
        [third; 3]
    });
    let (mut sum, mut total) = (0.0, 0.0);
    for (area, difference) in thirds.zip(differences(corners)).filter(|(area, _)| area.is_finite()) {
        if let Some(angle) = difference.angle {
            sum += angle * area;
            total += area;
        }
    }
    (sum, total)
}

/// The comparison of one primitive.
#[derive(Serialize)]
pub struct ComparedPrimitive {
    #[serde(flatten)]
    pub name: PrimitiveName,
    /// Why the primitive was not compared.
    pub reason: Option<String>,
    #[serde(flatten)]
    pub statistics: Option<Statistics>,
}

impl ComparedPrimitive {
    pub fn new(pair: &Pair) -> Self {
        let statistics = pair.corners.as_ref().ok().map(|corners| Statistics::of([corners].into_iter()));
        let reason = pair.corners.as_ref().err().map(|unpaired| unpaired.reason.clone());
        Self { name: pair.name.clone(), reason, statistics }
    }
}

/// One of the corners that differ most.
#[derive(Clone, Debug, Serialize)]
pub struct WorstCorner {
    #[serde(flatten)]
    pub name: PrimitiveName,
    /// The index of the triangle in its primitive.
    pub triangle: usize,
    /// The corner of the triangle: 0, 1 or 2.
    pub corner: usize,
    pub position: Option<[f32; 3]>,
    /// `None` if a tangent is zero or not finite.
    pub angle: Option<f64>,
    pub sign_flip: bool,
}

/// Finds the corners that differ most, one per position: opposite signs first, then corners without an angle, then the largest angles.
pub fn worst(pairs: &[Pair], count: usize) -> Vec<WorstCorner> {
    let mut all = Vec::new();
    for (number, pair) in pairs.iter().enumerate() {
        let Ok(corners) = &pair.corners else { continue };
        for (corner, difference) in differences(corners).enumerate() {
            if difference.flips_sign || difference.is_unknown() || difference.angle > Some(0.0) {
                all.push((difference, number, corner));
            }
        }
    }
    let rank = |difference: &CornerDifference| difference.angle.unwrap_or(f64::INFINITY);
    all.sort_unstable_by(|(a, a_number, a_corner), (b, b_number, b_corner)| {
        let by_difference = b.flips_sign.cmp(&a.flips_sign).then(rank(b).total_cmp(&rank(a)));
        by_difference.then((a_number, a_corner).cmp(&(b_number, b_corner)))
    });
    let mut seen = HashSet::new();
    let places = all.into_iter().map(|(CornerDifference { angle, flips_sign, .. }, number, corner)| {
        let pair = &pairs[number];
        let position = pair.corners.as_ref().ok().and_then(|corners| corners.positions.get(corner)).copied();
        let (triangle, corner) = (corner / 3, corner % 3);
        WorstCorner { name: pair.name.clone(), triangle, corner, position, angle, sign_flip: flips_sign }
    });
    let is_new = |place: &WorstCorner| {
        let position = place.position.map(|position| position.map(f32::to_bits));
        seen.insert((place.name.mesh, position))
    };
    places.filter(is_new).take(count).collect()
}
