//! The statistics of a comparison: angles between tangents, flipped signs, and the worst corners.

use std::cmp::Ordering;
use std::collections::HashSet;
use std::ops::Range;

use darboux::internal::{DifferenceSums, jobs, triangle_area};
use darboux::{Context, CornerDifference, TangentDifference};
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

/// The number of corners whose angle is at most `up_to` and above the limit of the previous bin.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Bin {
    pub up_to: f64,
    pub corners: usize,
}

impl Statistics {
    /// `angles`: the angles above zero of the same corners; their order changes.
    fn new(sums: &Sums, angles: &mut [f64]) -> Self {
        let found = sums.differences.difference(angles);
        let bins = TangentDifference::HISTOGRAM_BIN_ENDS.into_iter().zip(found.histogram);
        Self {
            corners: found.corners,
            identical: found.identical,
            sign_flips: found.sign_flips,
            without_angle: found.without_angle,
            unknown: sums.unknown,
            different: sums.different,
            min: found.min,
            median: found.median,
            p95: found.p95,
            max: found.max,
            mean: found.mean,
            area_weighted_mean: if sums.area > 0.0 { sums.weighted / sums.area } else { 0.0 },
            histogram: bins.map(|(up_to, corners)| Bin { up_to, corners }).collect(),
        }
    }

    /// Whether no angle is larger, no sign is opposite and no difference is unknown.
    pub fn is_within(&self, degrees: f64) -> bool {
        self.max <= degrees && self.sign_flips == 0 && self.unknown == 0
    }
}

/// The difference at a corner.
pub fn difference(corners: &PairedCorners<'_>, corner: usize) -> CornerDifference {
    let [a, b] = corners.tangents(corner);
    CornerDifference::between(a, b)
}

fn is_more_than_rounding(difference: &CornerDifference) -> bool {
    difference.flips_sign || difference.is_unknown() || difference.angle > Some(ROUNDING)
}

/// What [`Statistics`] are computed from, besides the angles above zero.
#[derive(Default)]
struct Sums {
    differences: DifferenceSums,
    unknown: usize,
    different: usize,
    /// The sum of angle times weight. The weight of a corner is a third of its triangle's area.
    weighted: f64,
    /// The sum of the weights.
    area: f64,
}

impl Sums {
    fn add(&mut self, difference: &CornerDifference, weight: Option<f64>, angles: &mut Vec<f64>) {
        self.differences.add(difference, angles);
        self.unknown += usize::from(difference.is_unknown());
        self.different += usize::from(is_more_than_rounding(difference));
        if let (Some(angle), Some(weight)) = (difference.angle, weight.filter(|weight| weight.is_finite())) {
            self.weighted += angle * weight;
            self.area += weight;
        }
    }

    fn append(&mut self, later: &Self) {
        self.differences.append(&later.differences);
        self.unknown += later.unknown;
        self.different += later.different;
        self.weighted += later.weighted;
        self.area += later.area;
    }
}

/// The comparison of all primitives.
pub struct Comparison {
    /// All primitives together.
    pub totals: Statistics,
    pub primitives: Vec<ComparedPrimitive>,
    /// The corners that differ most.
    pub worst: Vec<WorstCorner>,
}

/// Triangles per block. The blocks are part of the result: a mean is a sum of their sums.
const BLOCK: usize = 1 << 14;

impl Comparison {
    /// Compares blocks of triangles on all threads. `worst`: the maximum number of worst corners.
    pub fn new(pairs: &[Pair<'_>], worst: usize) -> Result<Self, darboux::Error> {
        let (mut totals, mut angles, mut worst) = (Sums::default(), Vec::new(), Worst::new(worst));
        let mut primitives = Vec::new();
        for (number, pair) in pairs.iter().enumerate() {
            let (corners, first) = (pair.corners.as_ref(), angles.len());
            let statistics = match corners {
                Ok(corners) => {
                    let sums = compare(corners, (pair.name.mesh, number), &mut angles, &mut worst)?;
                    totals.append(&sums);
                    Some(Statistics::new(&sums, &mut angles[first..]))
                }
                Err(_) => None,
            };
            let reason = corners.err().map(|unpaired| unpaired.reason.clone());
            primitives.push(ComparedPrimitive { name: pair.name.clone(), reason, statistics });
        }
        let totals = match &primitives[..] {
            [ComparedPrimitive { statistics: Some(statistics), .. }] => statistics.clone(),
            _ => Statistics::new(&totals, &mut angles),
        };
        let worst = worst.sorted().into_iter().map(|place| place.describe(pairs)).collect();
        Ok(Self { totals, primitives, worst })
    }
}

/// Compares the corners of a primitive. `[mesh, number]`: the index of its mesh, and its index among the
/// pairs. Appends its angles above zero.
fn compare(
    corners: &PairedCorners<'_>,
    (mesh, number): (usize, usize),
    angles: &mut Vec<f64>,
    worst: &mut Worst,
) -> Result<Sums, darboux::Error> {
    let of_block = |triangles: Range<usize>| {
        let (mut sums, mut angles, mut worst) = (Sums::default(), Vec::new(), Worst::new(worst.count));
        for triangle in triangles {
            let places = [0, 1, 2].map(|i| 3 * triangle + i);
            let positions = places.map(|corner| corners.position(corner));
            let weight = match positions {
                [Some(a), Some(b), Some(c)] => Some(triangle_area([a, b, c]) / 3.0),
                _ => None,
            };
            for (corner, position) in places.into_iter().zip(positions) {
                let difference = difference(corners, corner);
                sums.add(&difference, weight, &mut angles);
                worst.add(Place { difference, mesh, number, corner, position });
            }
        }
        (sums, angles, worst)
    };
    let mut blocks = Sums::default();
    let mut worst_of_blocks = Worst::new(worst.count);
    jobs::fold_blocks(&Context::new(), corners.len() / 3, BLOCK, of_block, |(sums, more, worst)| {
        blocks.append(&sums);
        angles.extend_from_slice(&more);
        worst.places.into_iter().for_each(|place| worst_of_blocks.add(place));
    })?;
    worst_of_blocks.places.into_iter().for_each(|place| worst.add(place));
    Ok(blocks)
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

/// A corner that may be one of the worst.
#[derive(Clone, Copy)]
struct Place {
    difference: CornerDifference,
    mesh: usize,
    /// The index of the primitive among the pairs.
    number: usize,
    corner: usize,
    position: Option<[f32; 3]>,
}

impl Place {
    /// Opposite signs first, then corners without an angle, then the largest angles, then the order of the
    /// file.
    fn order(&self, other: &Self) -> Ordering {
        let rank = |place: &Self| place.difference.angle.unwrap_or(f64::INFINITY);
        let by_sign = other.difference.flips_sign.cmp(&self.difference.flips_sign);
        let by_difference = by_sign.then(rank(other).total_cmp(&rank(self)));
        by_difference.then((self.number, self.corner).cmp(&(other.number, other.corner)))
    }

    fn describe(self, pairs: &[Pair<'_>]) -> WorstCorner {
        let CornerDifference { angle, flips_sign, .. } = self.difference;
        let (triangle, corner) = (self.corner / 3, self.corner % 3);
        let name = pairs[self.number].name.clone();
        WorstCorner { name, triangle, corner, position: self.position, angle, sign_flip: flips_sign }
    }
}

/// The corners that differ most, one per position of a mesh. Others are removed from time to time.
struct Worst {
    count: usize,
    places: Vec<Place>,
    /// True once the first `count` places are sorted and have different positions: later ones must come
    /// before the last of them.
    is_full: bool,
}

impl Worst {
    fn new(count: usize) -> Self {
        Self { count, places: Vec::new(), is_full: count == 0 }
    }

    fn add(&mut self, place: Place) {
        let difference = &place.difference;
        if !(difference.flips_sign || difference.is_unknown() || difference.angle > Some(0.0)) {
            return;
        }
        let last = self.count.checked_sub(1).and_then(|last| self.places.get(last));
        if self.is_full && last.is_none_or(|last| place.order(last).is_ge()) {
            return;
        }
        self.places.push(place);
        if self.places.len() > self.count.saturating_mul(2).saturating_add(1 << 10) {
            self.prune();
        }
    }

    /// Keeps the worst corner of each position, and of these the worst.
    fn prune(&mut self) {
        self.places.sort_unstable_by(Place::order);
        let mut seen = HashSet::new();
        self.places.retain(|place| {
            let position = place.position.map(|position| position.map(f32::to_bits));
            seen.len() < self.count && seen.insert((place.mesh, position))
        });
        self.is_full = self.places.len() == self.count;
    }

    fn sorted(mut self) -> Vec<Place> {
        self.prune();
        self.places
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pruning between additions removes nothing that a sort of all corners keeps.
    #[test]
    fn the_worst_corners_are_those_of_a_sort_of_all() {
        let places = (0..40_000_usize).map(|corner| {
            let [mixed, place] = [corner.wrapping_mul(7_919) % 1_013, corner.wrapping_mul(104_729) % 211];
            let angle = (mixed % 17 > 0).then_some((mixed % 401) as f64);
            let difference = CornerDifference { angle, flips_sign: mixed % 29 == 0, is_identical: false };
            let position = Some([place as f32, 0.0, 0.0]);
            Place { difference, mesh: corner % 2, number: corner % 2, corner, position }
        });
        let is_listed = |place: &Place| {
            let difference = &place.difference;
            difference.flips_sign || difference.is_unknown() || difference.angle > Some(0.0)
        };
        for count in [0, 1, 10, 300, 400, 500] {
            let mut all: Vec<Place> = places.clone().filter(is_listed).collect();
            all.sort_unstable_by(Place::order);
            let mut seen = HashSet::new();
            all.retain(|place| seen.insert((place.mesh, place.position.map(|x| x.map(f32::to_bits)))));
            all.truncate(count);
            let mut worst = Worst::new(count);
            places.clone().for_each(|place| worst.add(place));
            let corners =
                |places: Vec<Place>| -> Vec<usize> { places.iter().map(|place| place.corner).collect() };
            assert_eq!(corners(worst.sorted()), corners(all), "{count}");
        }
    }
}
