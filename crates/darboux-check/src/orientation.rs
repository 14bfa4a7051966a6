//! Decides whether faces or normals are reversed, where they disagree.
//!
//! A closed surface has a positive volume if its faces are wound outwards. On an open one the tangents decide: they were made for right normals,
//! so the bitangent w cross(n, t) points along the rising v if the normals still are those. If it points the other way, either the normals or
//! the faces and the signs w are reversed, as in a mirrored space; turning the normals over keeps the visible side of the surface visible.

use std::collections::HashMap;

use crate::surface::{Surface, cross, dot, length, sub, uv_area, xyz};

/// What is reversed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reversed {
    /// The order of the faces' corners.
    Faces,
    /// The normals.
    Normals,
    /// The surface is open and has no tangents, or only a part of it is reversed.
    Unknown,
}

/// The share of triangles or corners that decides.
const NEARLY_ALL: f64 = 0.98;

/// What is reversed on a surface that is wound against its normals.
pub fn reversed(surface: &Surface) -> Reversed {
    if !is_uniform(surface) {
        return Reversed::Unknown;
    }
    by_volume(surface).or_else(|| by_tangents(surface)).unwrap_or(Reversed::Unknown)
}

/// Whether nearly all triangles with an area are reversed.
fn is_uniform(surface: &Surface) -> bool {
    let against = surface.triangles_against_normals().len();
    let with_area = surface.triangles_where(|triangle| {
        let [a, b, c] = triangle.map(|vertex| surface.positions[vertex]);
        length(cross(sub(b, a), sub(c, a))) > 0.0
    });
    against as f64 >= NEARLY_ALL * with_area.len() as f64
}

/// By the sign of the volume; none for open surfaces.
fn by_volume(surface: &Surface) -> Option<Reversed> {
    let bits = |vertex: usize| surface.positions[vertex].map(|x| (x + 0.0).to_bits());
    let mut edges: HashMap<_, i64> = HashMap::new();
    let mut volume = 0.0;
    for triangle in surface.triangles() {
        let [a, b, c] = triangle;
        for (from, to) in [(a, b), (b, c), (c, a)].map(|(from, to)| (bits(from), bits(to))) {
            // Each edge of a closed surface is used once in each direction.
            *edges.entry((from.min(to), from.max(to))).or_default() +=
                i64::from(from < to) - i64::from(to < from);
        }
        let [a, b, c] = triangle.map(|vertex| surface.positions[vertex]);
        volume += dot(a, cross(b, c));
    }
    let is_closed = edges.values().all(|&sum| sum == 0) && edges.len() > 3;
    let size = surface.positions.iter().map(|position| length(*position)).fold(0.0, f64::max);
    // Volumes within rounding belong to flat shapes that are closed by having two sides.
    let is_solid = is_closed && volume.abs() > 1e-6 * size.powi(3);
    is_solid.then_some(if volume > 0.0 { Reversed::Normals } else { Reversed::Faces })
}

/// By the tangents; none where there are none, or where they contradict each other.
fn by_tangents(surface: &Surface) -> Option<Reversed> {
    let (normals, tangents) = (surface.normals.as_ref()?, surface.tangents.as_ref()?);
    let uvs = surface.uv_sets.get(&surface.uv_set)?;
    let (mut right, mut wrong) = (0usize, 0usize);
    for triangle in surface.triangles() {
        let [a, b, c] = triangle.map(|vertex| surface.positions[vertex]);
        let area = uv_area(uvs, triangle);
        let [u, v, w] = triangle.map(|vertex| uvs[vertex]);
        let (along_b, along_c) = (f64::from(v[0]) - f64::from(u[0]), f64::from(w[0]) - f64::from(u[0]));
        let [b, c] = [sub(b, a), sub(c, a)];
        // dP/dv times the UV area; glTF's v points down.
        let rising = |i: usize| (along_c * f64::from(b[i]) - along_b * f64::from(c[i])) * area.signum();
        for vertex in triangle {
            let (normal, tangent) = (normals[vertex], tangents[vertex]);
            let bitangent = cross(normal, xyz(tangent));
            let agreement: f64 = (0..3).map(|i| f64::from(bitangent[i]) * rising(i)).sum();
            match agreement * f64::from(tangent[3]) {
                x if x > 0.0 => right += 1,
                x if x < 0.0 => wrong += 1,
                _ => {}
            }
        }
    }
    let all = (right + wrong) as f64;
    match () {
        () if all == 0.0 => None,
        () if right as f64 >= NEARLY_ALL * all => Some(Reversed::Faces),
        () if wrong as f64 >= NEARLY_ALL * all => Some(Reversed::Normals),
        () => None,
    }
}
