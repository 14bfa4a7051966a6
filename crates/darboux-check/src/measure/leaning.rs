//! Tangents that lean towards their normals.

use darboux::CornerDifference;

use crate::facts::SurfaceFacts;
use crate::measure::expected::rounding;
use crate::measure::values::{has_length, is_unit};
use crate::surface::{dot, length, xyz};

/// Degrees from the plane of the normal that rounding explains.
const MAX_DEGREES_FROM_PLANE: f64 = 2.0;

/// The vertices whose tangents lean towards their normals by a mistake of their own, ascending, each with the
/// degrees from the plane of the normal.
pub fn leaning(facts: &SurfaceFacts<'_>) -> Vec<(usize, f64)> {
    if facts.other_axes.is_some() {
        return Vec::new();
    }
    let (Some(tangents), Some(normals)) = (&facts.surface.tangents, &facts.surface.normals) else {
        return Vec::new();
    };
    let angle = |vertex: usize| {
        let (tangent, normal) = (xyz(tangents[vertex]), normals[vertex]);
        let sine = dot(tangent, normal) / (length(tangent) * length(normal));
        if has_length(tangents[vertex]) && sine.is_finite() && !facts.has_own_tangent[vertex] {
            sine.abs().min(1.0).asin().to_degrees()
        } else {
            0.0
        }
    };
    let leans = |&vertex: &usize| angle(vertex) > MAX_DEGREES_FROM_PLANE;
    let found = facts.surface.used((0..tangents.len()).filter(leans).collect());
    let found =
        if facts.has_repairable_tangents() { without_damaged_normals(facts, normals, found) } else { found };
    let found = without_those_of_mikktspace(facts, tangents, found);
    found.into_iter().map(|vertex| (vertex, angle(vertex))).collect()
}

/// A direction laid into the plane of a normal, with length 1; none where little of it lies there.
pub fn in_plane(direction: [f32; 3], normal: [f32; 3]) -> Option<[f32; 3]> {
    let along = dot(direction, normal) / dot(normal, normal);
    let laid = [0, 1, 2].map(|i| f64::from(direction[i]) - along * f64::from(normal[i]));
    let rest = laid.iter().map(|x| x * x).sum::<f64>().sqrt();
    (rest > 0.1 * length(direction)).then(|| laid.map(|x| (x / rest) as f32))
}

/// Drops vertices whose own normal is reported, unless most normals are, as after all were scaled or negated:
/// then their axes are right.
fn without_damaged_normals(
    facts: &SurfaceFacts<'_>,
    normals: &[[f32; 3]],
    vertices: Vec<usize>,
) -> Vec<usize> {
    if vertices.is_empty() {
        return vertices;
    }
    let surface = facts.surface;
    let is_most = |damaged: &[usize]| 2 * damaged.len() > surface.used_count();
    let reversed = facts.reversed.as_ref().map(|reversed| &reversed.vertices[..]).unwrap_or_default();
    let reversed = if is_most(reversed) { &[] } else { reversed };
    let not_unit = surface.used((0..normals.len()).filter(|&vertex| !is_unit(normals[vertex])).collect());
    let are_scaled = is_most(&not_unit);
    let is_sound =
        |vertex: &usize| (are_scaled || is_unit(normals[*vertex])) && reversed.binary_search(vertex).is_err();
    vertices.into_iter().filter(is_sound).collect()
}

/// Drops vertices with the tangent that MikkTSpace gives them, up to rounding: what leans there comes from
/// the UVs or the normals, and computing it again does not help.
fn without_those_of_mikktspace(
    facts: &SurfaceFacts<'_>,
    tangents: &[[f32; 4]],
    mut vertices: Vec<usize>,
) -> Vec<usize> {
    let Some(expected) = facts.expected.as_ref().filter(|_| !vertices.is_empty()) else { return vertices };
    let tolerance = rounding(facts.surface);
    let mut is_expected = vec![false; tangents.len()];
    for (&vertex, expected) in facts.surface.vertex_of_corner.iter().zip(expected) {
        let difference = CornerDifference::between(*expected, tangents[vertex as usize]);
        is_expected[vertex as usize] |= difference.angle.is_some_and(|angle| angle <= tolerance);
    }
    vertices.retain(|&vertex| !is_expected[vertex]);
    vertices
}
