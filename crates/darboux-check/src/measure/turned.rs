//! Finds single vertices whose tangents point against u or along v, where the tangents of other vertices are
//! right.
//!
//! All methods sum the u directions of the triangles around a vertex with positive weights. So a tangent that
//! points against all of them is wrong, whatever the method. Where these directions spread over more than a
//! right angle, only the method decides: if the other tangents are MikkTSpace's, a tangent that points
//! against MikkTSpace's is wrong, too, and so is a tangent that is rotated by a right angle.
//!
//! Rounding the UVs, as compression does, can flip the u direction of a triangle that is thin in UV space.
//! With such triangles around it, a vertex is judged only where the other triangles outweigh them in
//! MikkTSpace's sum, which weights by the angles at the vertex, or where the tangents of nearly all thin
//! triangles are MikkTSpace's, so that nothing was rounded since.

use crate::measure::expected::{are_those_of_the_file, is_measured};
use crate::measure::u_directions::{Thin, u_direction};
use crate::surface::{Surface, cross, dot, indices_where, length, sub, xyz};

/// The vertices whose tangents are turned, ascending.
#[derive(Default)]
pub struct Turned {
    /// The vertices whose tangents point against u.
    pub negated: Vec<usize>,
    /// The vertices whose tangents point along v.
    pub rotated: Vec<usize>,
}

/// The cosine to the u direction below which a tangent points against it. Sums of unit u directions with
/// positive weights have a positive cosine to one of them at least; the rest is rounding.
const AGAINST: f64 = -0.1;

/// The cosines between a tangent and MikkTSpace's: from which on they are the same or opposite, up to which
/// they are at a right angle, and from which on the tangents of a surface are called MikkTSpace's.
const OPPOSITE: f64 = 0.98;
const ACROSS: f64 = 0.1;
const EQUAL: f64 = 0.9998;

/// The least share of corners with MikkTSpace's tangent or its opposite on a surface whose other tangents are
/// MikkTSpace's: where a tangent is the opposite, and where it is turned by a right angle, which a tangent of
/// another method may be by chance.
const MIN_SHARE: f64 = 0.9;
const MIN_SHARE_FOR_ACROSS: f64 = 0.95;

/// The least share of the corners of thin triangles with MikkTSpace's tangent, of UVs that were not rounded
/// since.
const MIN_SHARE_OF_THIN: f64 = 0.9;

/// The shortest sum of u directions, as a part of the sum of their weights, that is sure of its direction.
const MIN_SUM: f64 = 0.3;

/// The sum of u directions times the angles at a vertex, and the sum of these angles.
#[derive(Clone, Copy)]
struct WeightedSum {
    directions: [f64; 3],
    weight: f64,
}

impl WeightedSum {
    const ZERO: Self = Self { directions: [0.0; 3], weight: 0.0 };

    fn add(&mut self, direction: [f32; 3], weight: f64) {
        let scale = weight / length(direction);
        (0..3).for_each(|i| self.directions[i] += scale * f64::from(direction[i]));
        self.weight += weight;
    }
}

/// What lies around a vertex.
#[derive(Clone, Copy)]
struct Around {
    /// The largest cosine between the tangent and the u direction of a triangle that is not thin.
    largest_cosine: f64,
    /// The u directions of such triangles, and of thin ones.
    thick: WeightedSum,
    thin: WeightedSum,
    /// Whether all corners have the opposite of MikkTSpace's tangent, and whether all have it turned by a
    /// right angle.
    is_opposite: bool,
    is_across: bool,
}

impl Around {
    const EMPTY: Self = Self {
        largest_cosine: f64::NEG_INFINITY,
        thick: WeightedSum::ZERO,
        thin: WeightedSum::ZERO,
        is_opposite: true,
        is_across: true,
    };

    /// Whether the tangent points against all u directions; none of them is in doubt.
    fn is_against_all(&self) -> bool {
        self.thin.weight == 0.0 && self.largest_cosine.is_finite() && self.largest_cosine < AGAINST
    }

    /// Whether MikkTSpace's tangent is sure of its direction. `trusts_thin`: whether thin triangles are as
    /// good as others.
    fn is_determined(&self, trusts_thin: bool) -> bool {
        let Self { thick, thin, .. } = self;
        let sum = |of: &dyn Fn(usize) -> f64| (0..3).map(|i| of(i).powi(2)).sum::<f64>().sqrt();
        let [sum, doubtful, weight] = match trusts_thin {
            true => [sum(&|i| thick.directions[i] + thin.directions[i]), 0.0, thick.weight + thin.weight],
            false => [sum(&|i| thick.directions[i]), thin.weight, thick.weight],
        };
        weight > 0.0 && sum > doubtful + MIN_SUM * weight
    }
}

/// Counts of corners, and of those whose tangent is MikkTSpace's.
#[derive(Clone, Copy, Default)]
struct Corners {
    all: usize,
    equal: usize,
}

impl Corners {
    fn add(&mut self, is_equal: bool) {
        self.all += 1;
        self.equal += usize::from(is_equal);
    }

    fn are_equal(self, least: f64) -> bool {
        self.equal as f64 >= least * self.all as f64
    }
}

/// Finds them. `expected`: MikkTSpace's tangents of all corners.
pub fn turned(surface: &Surface, expected: &[[f32; 4]]) -> Turned {
    let (Some(tangents), Some(normals), Some(uvs)) =
        (&surface.tangents, &surface.normals, surface.uv_sets.get(&surface.uv_set))
    else {
        return Turned::default();
    };
    if are_those_of_the_file(surface, expected) {
        return Turned::default();
    }
    let thin = Thin::among(uvs);
    let mut around = vec![Around::EMPTY; tangents.len()];
    let (mut corners, mut thin_corners) = (Corners::default(), Corners::default());
    for (triangle, expected) in surface.triangles().zip(expected.as_chunks::<3>().0) {
        let along_u = u_direction(surface, uvs, triangle).filter(|_| is_measured(surface, uvs, triangle));
        let Some(along_u) = along_u else { continue };
        let is_thin = thin.contains(triangle);
        for (corner, vertex) in triangle.into_iter().enumerate() {
            let at = &mut around[vertex];
            let (tangent, ours) = (xyz(tangents[vertex]), xyz(expected[corner]));
            let sum = if is_thin { &mut at.thin } else { &mut at.thick };
            sum.add(along_u, angle(surface, triangle, corner));
            if !is_thin {
                let cosine = cosine(along_u, tangent);
                // A tangent without a direction has a finding of its own, and NaN makes it no other one.
                at.largest_cosine = if cosine.is_nan() { 1.0 } else { at.largest_cosine.max(cosine) };
            }
            let along = cosine(ours, tangent);
            corners.add(along.abs() >= EQUAL);
            if is_thin {
                thin_corners.add(along >= EQUAL);
            }
            at.is_opposite &= along <= -OPPOSITE;
            at.is_across &=
                along.abs() <= ACROSS && cosine(cross(normals[vertex], ours), tangent).abs() >= OPPOSITE;
        }
    }
    let trusts_thin = thin_corners.are_equal(MIN_SHARE_OF_THIN);
    let is_sure = |at: &Around, least: f64| corners.are_equal(least) && at.is_determined(trusts_thin);
    let is_negated = |at: &Around| at.is_opposite && is_sure(at, MIN_SHARE);
    Turned {
        negated: indices_where(&around, |at| at.is_against_all() || is_negated(at)),
        rotated: indices_where(&around, |at| at.is_across && is_sure(at, MIN_SHARE_FOR_ACROSS)),
    }
}

fn cosine(a: [f32; 3], b: [f32; 3]) -> f64 {
    dot(a, b) / (length(a) * length(b))
}

/// The angle of a triangle at one of its corners; 0 where it has none.
fn angle(surface: &Surface, triangle: [usize; 3], corner: usize) -> f64 {
    let [a, b, c] = [0, 1, 2].map(|i| surface.positions[triangle[(corner + i) % 3]]);
    let cosine = cosine(sub(b, a), sub(c, a));
    if cosine.is_finite() { cosine.clamp(-1.0, 1.0).acos() } else { 0.0 }
}
