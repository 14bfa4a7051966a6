//! The connected parts of a surface that are wound against their normals.
//!
//! Two triangles are connected if they share a vertex: the same position and the same normal. So a part ends at hard edges, and where a
//! mirrored half with reversed normals meets the other half.

use crate::surface::{Surface, cross, dot, length, sub};

/// The parts that are wound against their normals.
#[derive(Debug, PartialEq, Eq)]
pub struct ReversedParts {
    /// Their number.
    pub parts: usize,
    /// The number of all parts.
    pub all_parts: usize,
    /// The numbers of their triangles, ascending.
    pub triangles: Vec<usize>,
}

/// The mean cosine between a part's normals and the fronts of its faces, weighted by area, below which it is reversed. Normals that were bent
/// on purpose, as on foliage, may lean past the plane of a face here and there.
const REVERSED: f64 = -0.5;

/// Triangles whose height is a smaller part of their longest edge have no direction beyond rounding.
const THIN: f64 = 1e-4;

/// Finds the reversed parts; none where the surface has no normals.
pub fn reversed_parts(surface: &Surface) -> ReversedParts {
    let mut found = ReversedParts { parts: 0, all_parts: 0, triangles: Vec::new() };
    let Some(normals) = &surface.normals else { return found };
    // Adding 0.0 makes both zeros one.
    let bits = |vector: [f32; 3]| vector.map(|x| (x + 0.0).to_bits());
    let part_of_vertex = surface.parts(|vertex| [surface.positions[vertex], normals[vertex]].map(bits));
    // Per part: the sum of the areas, and of the areas times the cosine, both doubled.
    let mut sums = vec![[0.0; 2]; surface.positions.len()];
    for triangle in surface.triangles() {
        let [a, b, c] = triangle.map(|vertex| surface.positions[vertex]);
        let edges = [sub(b, a), sub(c, a), sub(c, b)];
        let (front, longest) = (cross(edges[0], edges[1]), edges.map(length).into_iter().fold(0.0, f64::max));
        let area = length(front);
        let cosines = triangle.map(|vertex| dot(front, normals[vertex]) / length(normals[vertex]));
        let signed = cosines.iter().sum::<f64>() / 3.0;
        if area > THIN * longest * longest && signed.is_finite() {
            let sum = &mut sums[part_of_vertex[triangle[0]]];
            *sum = [sum[0] + area, sum[1] + signed];
        }
    }
    let is_reversed = |part: usize| sums[part][1] < REVERSED * sums[part][0];
    found.all_parts = sums.iter().filter(|sum| sum[0] > 0.0).count();
    found.parts = (0..sums.len()).filter(|&part| is_reversed(part)).count();
    found.triangles = surface.triangles_where(|triangle| is_reversed(part_of_vertex[triangle[0]]));
    found
}
