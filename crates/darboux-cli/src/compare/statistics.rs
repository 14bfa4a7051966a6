//! The numbers of a comparison.

use std::collections::HashSet;

use darboux::{HISTOGRAM_ENDS, measure_tangents, tangent_angle};
use darboux_io::gltf::{Pair, PairedCorners, PrimitiveName};
use serde::Serialize;

/// How two sets of tangents differ; angles in degrees.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Statistics {
    pub corners: usize,
    pub identical: usize,
    pub sign_flips: usize,
    pub without_angle: usize,
    pub min: f64,
    pub median: f64,
    pub p95: f64,
    pub max: f64,
    pub mean: f64,
    /// Every corner counts a third of its triangle.
    pub area_weighted_mean: f64,
    pub histogram: Vec<Bin>,
}

/// The corners whose angle is at most `up_to`, and above that of the bin before.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Bin {
    pub up_to: f64,
    pub corners: usize,
}

impl Statistics {
    /// Of several primitives together.
    pub fn of<'a>(primitives: impl Iterator<Item = &'a PairedCorners>) -> Self {
        let (mut tangents, mut others) = (Vec::new(), Vec::new());
        let (mut sum, mut area) = (0.0, 0.0);
        for corners in primitives {
            tangents.extend_from_slice(&corners.tangents[0]);
            others.extend_from_slice(&corners.tangents[1]);
            let (part, part_area) = area_weighted(corners);
            (sum, area) = (sum + part, area + part_area);
        }
        let found = measure_tangents(&tangents, &others).unwrap_or_default();
        let bins = HISTOGRAM_ENDS.into_iter().zip(found.histogram);
        Self {
            corners: found.corners,
            identical: found.identical,
            sign_flips: found.sign_flips,
            without_angle: found.without_angle,
            min: found.min,
            median: found.median,
            p95: found.p95,
            max: found.max,
            mean: found.mean,
            area_weighted_mean: if area > 0.0 { sum / area } else { 0.0 },
            histogram: bins.map(|(up_to, corners)| Bin { up_to, corners }).collect(),
        }
    }

    /// Whether no angle is greater, no sign flipped, and none unknown where tangents are not the same bits.
    pub fn is_within(&self, degrees: f64) -> bool {
        self.max <= degrees && self.sign_flips == 0 && self.without_angle == 0
    }
}

/// The sum of the corners' angles times a third of their triangles' areas, and the sum of these areas.
fn area_weighted(corners: &PairedCorners) -> (f64, f64) {
    let [tangents, others] = &corners.tangents;
    let triangles = corners.positions.as_chunks::<3>().0.iter().map(area);
    let pairs = tangents.as_chunks::<3>().0.iter().zip(others.as_chunks::<3>().0);
    let (mut sum, mut total) = (0.0, 0.0);
    for (area, (tangents, others)) in triangles.zip(pairs).filter(|(area, _)| area.is_finite()) {
        for angle in tangents.iter().zip(others).filter_map(|(a, b)| tangent_angle(*a, *b)) {
            sum += angle * area / 3.0;
            total += area / 3.0;
        }
    }
    (sum, total)
}

fn area(triangle: &[[f32; 3]; 3]) -> f64 {
    let [p, q, r] = triangle.map(|point| point.map(f64::from));
    let [e, f] = [q, r].map(|point| [point[0] - p[0], point[1] - p[1], point[2] - p[2]]);
    let cross = [e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]];
    0.5 * cross.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// One primitive of the report.
#[derive(Serialize)]
pub struct ComparedPrimitive {
    #[serde(flatten)]
    pub name: PrimitiveName,
    /// Why there is nothing to compare.
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

/// A corner that is far off.
#[derive(Clone, Debug, Serialize)]
pub struct Place {
    #[serde(flatten)]
    pub name: PrimitiveName,
    /// The triangle in its primitive.
    pub triangle: usize,
    /// Its corner: 0, 1 or 2.
    pub corner: usize,
    pub position: Option<[f32; 3]>,
    pub angle: f64,
    pub sign_flip: bool,
}

/// The worst places, one corner for each position: flipped signs first, then by the angle.
pub fn worst(pairs: &[Pair], count: usize) -> Vec<Place> {
    let mut all = Vec::new();
    for (number, pair) in pairs.iter().enumerate() {
        let Ok(corners) = &pair.corners else { continue };
        let [tangents, others] = &corners.tangents;
        for (corner, (a, b)) in tangents.iter().zip(others).enumerate() {
            let (flip, angle) = (a[3] != b[3], tangent_angle(*a, *b).unwrap_or(0.0));
            if flip || angle > 0.0 {
                all.push((flip, angle, number, corner));
            }
        }
    }
    all.sort_unstable_by(|a, b| b.0.cmp(&a.0).then(b.1.total_cmp(&a.1)).then((a.2, a.3).cmp(&(b.2, b.3))));
    let mut seen = HashSet::new();
    let places = all.into_iter().map(|(sign_flip, angle, number, corner)| {
        let pair = &pairs[number];
        let position = pair.corners.as_ref().ok().and_then(|corners| corners.positions.get(corner)).copied();
        let (triangle, corner) = (corner / 3, corner % 3);
        Place { name: pair.name.clone(), triangle, corner, position, angle, sign_flip }
    });
    let is_new = |place: &Place| {
        let position = place.position.map(|position| position.map(f32::to_bits));
        seen.insert((place.name.mesh, position))
    };
    places.filter(is_new).take(count).collect()
}
