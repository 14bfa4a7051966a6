//! The vertices whose normals point to the back of all faces around them, as on a part of the surface that
//! was flipped or mirrored.
//!
//! A smooth normal is a sum of the normals of faces with positive weights, so it points to the front of one
//! of them at least, on thin sheets and at sharp points, too. The faces around a vertex are those of all
//! vertices with the same position and the same normal: a UV seam may leave a vertex with the faces of one
//! side, and two sheets that are drawn back to back may share their normals.

use std::collections::HashMap;

use crate::surface::{Surface, cross, dot, length, sub};

/// What is reversed.
#[derive(Debug, PartialEq, Eq)]
pub struct Reversed {
    /// The vertices, ascending.
    pub vertices: Vec<usize>,
    /// The numbers of the triangles that have such corners, and no corner whose normal points to the front,
    /// ascending.
    pub triangles: Vec<usize>,
    /// The numbers of the triangles that have such corners and others whose normals point to the front,
    /// ascending.
    pub mixed: Vec<usize>,
    /// The number of connected parts that have such triangles. Parts are connected by vertices with the same
    /// position and normal.
    pub parts: usize,
    /// The number of all connected parts that have an area.
    pub all_parts: usize,
}

/// The cosine between a normal and the fronts of all its faces below which it is reversed. Normals that were
/// bent on purpose, as on foliage, may lean past the plane of a face here and there.
const REVERSED: f64 = -0.3;

/// Triangles whose height is a smaller part of their longest edge have no direction beyond rounding.
const THIN: f64 = 1e-4;

/// Finds what is reversed; none where nothing is, or the surface has no normals.
pub fn reversed(surface: &Surface) -> Option<Reversed> {
    let normals = surface.normals.as_ref()?;
    let cosines = largest_cosines(surface, normals);
    // Most surfaces have no such vertex, even if each is compared with its own faces alone.
    cosines.iter().find(|cosine| is_reversed(**cosine))?;
    // Adding 0.0 makes both zeros one.
    let bits = |vector: [f32; 3]| vector.map(|x| (x + 0.0).to_bits());
    let key = |vertex: usize| [surface.positions[vertex], normals[vertex]].map(bits);
    let mut of_place = HashMap::new();
    for (vertex, &cosine) in cosines.iter().enumerate() {
        let largest: &mut f64 = of_place.entry(key(vertex)).or_insert(cosine);
        *largest = largest.max(cosine);
    }
    let is_reversed: Vec<bool> =
        (0..cosines.len()).map(|vertex| is_reversed(of_place[&key(vertex)])).collect();
    let points_to_front = |triangle: [usize; 3]| {
        let front = front(at(surface, triangle));
        front.is_some_and(|front| triangle.iter().any(|&vertex| dot(front, normals[vertex]) > 0.0))
    };
    let found = surface.triangles_where(|triangle| {
        front(at(surface, triangle)).is_some() && triangle.iter().any(|&vertex| is_reversed[vertex])
    });
    let all: Vec<[usize; 3]> = surface.triangles().collect();
    let (mixed, triangles): (Vec<usize>, Vec<usize>) =
        found.iter().partition(|&&number| points_to_front(all[number]));
    let part_of_vertex = surface.parts(key);
    let count_parts = |mut parts: Vec<u32>| {
        parts.sort_unstable();
        parts.dedup();
        parts.len()
    };
    let part = |triangle: [usize; 3]| part_of_vertex[triangle[0]];
    let with_area = all.iter().filter(|triangle| front(at(surface, **triangle)).is_some());
    let all_parts = count_parts(with_area.map(|triangle| part(*triangle)).collect());
    let parts = count_parts(found.iter().map(|&number| part(all[number])).collect());
    let vertices: Vec<usize> = (0..is_reversed.len()).filter(|&vertex| is_reversed[vertex]).collect();
    (!found.is_empty()).then(|| Reversed {
        vertices: surface.used(vertices),
        triangles,
        mixed,
        parts,
        all_parts,
    })
}

/// Vertices without a face are not.
fn is_reversed(largest_cosine: f64) -> bool {
    largest_cosine.is_finite() && largest_cosine < REVERSED
}

/// Per vertex the largest cosine between its normal and the fronts of the triangles around it; negative
/// infinity without any.
fn largest_cosines(surface: &Surface, normals: &[[f32; 3]]) -> Vec<f64> {
    let mut largest = vec![f64::NEG_INFINITY; normals.len()];
    for triangle in surface.triangles() {
        let Some(front) = front(at(surface, triangle)) else { continue };
        for vertex in triangle {
            let cosine = dot(front, normals[vertex]) / (length(front) * length(normals[vertex]));
            // NaN, of normals without a direction, is not larger.
            largest[vertex] = largest[vertex].max(cosine);
        }
    }
    largest
}

/// The positions of a triangle's corners.
fn at(surface: &Surface, triangle: [usize; 3]) -> [[f32; 3]; 3] {
    triangle.map(|vertex| surface.positions[vertex])
}

/// The direction of a triangle's front, as long as twice its area; none for thin triangles.
pub fn front([a, b, c]: [[f32; 3]; 3]) -> Option<[f32; 3]> {
    let edges = [sub(b, a), sub(c, a), sub(c, b)];
    let longest = edges.map(length).into_iter().fold(0.0, f64::max);
    let front = cross(edges[0], edges[1]);
    (length(front) > THIN * longest * longest).then_some(front)
}
