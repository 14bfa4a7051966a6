//! Normals that are in other axes than the positions, as after an export that turned to another up axis or
//! mirrored only the positions.
//!
//! Of all ways to exchange and to negate x, y and z, one makes such normals fit the faces. Normals that were
//! bent on purpose, as on foliage, fit in no way, or are so equal that all ways fit alike.

use crate::surface::{Surface, cross, length, sub};

/// How the normals have to be read to fit the faces: component i is `signs[i]` times the stored component
/// `sources[i]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OtherAxes {
    pub sources: [usize; 3],
    pub signs: [f64; 3],
    /// The mean cosine between normals and faces: as stored, and as they have to be read.
    pub mean_cosines: [f64; 2],
    /// Whether no other way is nearly as good.
    pub is_clear: bool,
}

/// The largest mean cosine of normals in other axes.
const MAX_AS_STORED: f64 = 0.6;

/// The smallest mean cosine of normals as they have to be read: the smooth normals of a cube have 0.577.
const MIN_AS_READ: f64 = 0.5;

/// The smallest mean cosine of a clear way, and by how much it is better than all others. Of five published
/// parts with such normals, the smallest are 0.89 and 0.22.
const MIN_OF_CLEAR: f64 = 0.85;
const MIN_LEAD: f64 = 0.1;

/// The smallest difference of both. Two exchanged axes, or a negated one, take two thirds of the cosine of a
/// sphere.
const MIN_GAIN: f64 = 0.25;

/// The smallest correlation of the deviations from the mean normal with those from the mean face.
const MIN_CORRELATION: f64 = 0.7;

/// The smallest variance of normals that distinguish the ways: normals that lean by 3 degrees have it.
const MIN_VARIANCE: f64 = 0.003;

/// The ways to take the components from others.
const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [2, 1, 0], [1, 2, 0], [2, 0, 1]];

/// Sums over the triangles: of unit fronts and unit normals, and of the products of their components. Every
/// triangle counts once: weighted by area, the few triangles of one lost vertex could outweigh all others.
#[derive(Default)]
struct Sums {
    count: f64,
    fronts: [f64; 3],
    normals: [f64; 3],
    squared_normals: f64,
    products: [[f64; 3]; 3],
}

impl OtherAxes {
    /// None where the normals fit the faces as they are or negated, or in no way, or where there are no
    /// normals.
    pub fn of(surface: &Surface) -> Option<Self> {
        let sums = Sums::of(surface)?;
        let as_stored = sums.mean_cosine([0, 1, 2], [1.0; 3]);
        let are_negated = sums.mean_cosine([0, 1, 2], [-1.0; 3]) >= MIN_AS_READ;
        if as_stored > MAX_AS_STORED || are_negated || sums.normal_variance() < MIN_VARIANCE {
            return None;
        }
        let signs = |bits: u8| [1, 2, 4].map(|bit| if bits & bit == 0 { 1.0 } else { -1.0 });
        let all = || ORDERS.into_iter().flat_map(|sources| (0..8).map(move |bits| (sources, signs(bits))));
        let fit = |&(sources, signs): &([usize; 3], [f64; 3])| sums.mean_cosine(sources, signs);
        // The first one of several that fit equally, as on surfaces without normals along one axis, changes
        // least.
        let best = all().reduce(|best, other| if fit(&other) > fit(&best) + 1e-6 { other } else { best })?;
        let (sources, signs) = best;
        let is_clear = fit(&best) >= MIN_OF_CLEAR
            && all().filter(|other| *other != best).all(|other| fit(&other) <= fit(&best) - MIN_LEAD);
        let gain = fit(&best) - as_stored;
        let is_found = fit(&best) >= MIN_AS_READ
            && gain >= MIN_GAIN
            && sums.correlation(sources, signs) >= MIN_CORRELATION;
        let found = Self { sources, signs, mean_cosines: [as_stored, fit(&best)], is_clear };
        is_found.then_some(found)
    }

    /// A normal as it has to be read.
    pub fn read(&self, normal: [f32; 3]) -> [f32; 3] {
        [0, 1, 2]
            .map(|i| if self.signs[i] < 0.0 { -normal[self.sources[i]] } else { normal[self.sources[i]] })
    }

    /// Whether axes are exchanged; otherwise some are negated only.
    pub fn are_exchanged(&self) -> bool {
        self.sources != [0, 1, 2]
    }
}

impl Sums {
    /// None without normals or without an area.
    fn of(surface: &Surface) -> Option<Self> {
        let normals = surface.normals.as_ref()?;
        let mut sums = Self::default();
        for triangle in surface.triangles() {
            let [a, b, c] = triangle.map(|vertex| surface.positions[vertex]);
            let front = cross(sub(b, a), sub(c, a)).map(f64::from);
            let area = front.iter().map(|x| x * x).sum::<f64>().sqrt();
            let unit = triangle.map(|vertex| normals[vertex].map(|x| f64::from(x) / length(normals[vertex])));
            let normal = [0, 1, 2].map(|i| unit.iter().map(|normal| normal[i]).sum::<f64>() / 3.0);
            if area > 0.0 && area.is_finite() && normal.iter().all(|x| x.is_finite()) {
                sums.add(front.map(|x| x / area), normal);
            }
        }
        (sums.count > 0.0).then_some(sums)
    }

    fn add(&mut self, front: [f64; 3], normal: [f64; 3]) {
        self.count += 1.0;
        for i in 0..3 {
            self.fronts[i] += front[i];
            self.normals[i] += normal[i];
            self.squared_normals += normal[i] * normal[i];
            (0..3).for_each(|j| self.products[i][j] += front[i] * normal[j]);
        }
    }

    fn mean_cosine(&self, sources: [usize; 3], signs: [f64; 3]) -> f64 {
        (0..3).map(|i| signs[i] * self.products[i][sources[i]]).sum::<f64>() / self.count
    }

    fn normal_variance(&self) -> f64 {
        self.squared_normals / self.count - squared(self.normals) / (self.count * self.count)
    }

    fn correlation(&self, sources: [usize; 3], signs: [f64; 3]) -> f64 {
        let of_means = (0..3).map(|i| signs[i] * self.fronts[i] * self.normals[sources[i]]).sum::<f64>();
        let covariance = self.mean_cosine(sources, signs) - of_means / (self.count * self.count);
        let front_variance = 1.0 - squared(self.fronts) / (self.count * self.count);
        covariance / (front_variance * self.normal_variance()).max(0.0).sqrt()
    }
}

fn squared(vector: [f64; 3]) -> f64 {
    vector.iter().map(|x| x * x).sum()
}
