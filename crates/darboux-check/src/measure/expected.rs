//! What MikkTSpace's tangents of all corners tell of the vertices of a surface.

use darboux::CornerDifference;

use crate::surface::{Surface, uv_area};

/// Degrees between tangents that are equal up to rounding: of floats, after sums in another order; of 8 bits.
const ROUNDING: f64 = 0.1;
const ROUNDING_OF_8_BITS: f64 = 1.0;

/// The degrees between a tangent of the file and the same one before it was rounded.
pub fn rounding(surface: &Surface) -> f64 {
    if surface.tangent_size == 4 { ROUNDING_OF_8_BITS } else { ROUNDING }
}

/// Whether the tangents of the file are MikkTSpace's at all corners, bit for bit.
pub fn are_those_of_the_file(surface: &Surface, expected: &[[f32; 4]]) -> bool {
    let Some(tangents) = &surface.tangents else { return false };
    let is_same = |(vertex, expected): (&u32, &[f32; 4])| {
        tangents[*vertex as usize].map(f32::to_bits) == expected.map(f32::to_bits)
    };
    surface.vertex_of_corner.iter().zip(expected).all(is_same)
}

/// Per vertex whether MikkTSpace gives its tangent, up to rounding, to one of its corners that lie in faces
/// without an area in space or in UV space. There MikkTSpace takes the tangent of another vertex at the same
/// place or the x axis, which may lean or have another sign than its neighbours. Computing it again does not
/// help, and the UVs have a finding of their own.
pub fn vertices_with_own_tangents(surface: &Surface, expected: &[[f32; 4]]) -> Vec<bool> {
    let mut is_own = vec![false; surface.positions.len()];
    let Some(tangents) = &surface.tangents else { return is_own };
    let Some(uvs) = surface.uv_sets.get(&surface.uv_set) else { return is_own };
    let tolerance = rounding(surface);
    for (triangle, expected) in surface.triangles().zip(expected.as_chunks::<3>().0) {
        if surface.has_area(triangle) && uv_area(uvs, triangle) != 0.0 {
            continue;
        }
        for (vertex, expected) in triangle.into_iter().zip(expected) {
            let difference = CornerDifference::between(*expected, tangents[vertex]);
            let is_close = difference.angle.is_some_and(|angle| angle <= tolerance);
            is_own[vertex] |= is_close && !difference.flips_sign;
        }
    }
    is_own
}

/// Whether a triangle has an area in the UV set. A UV-degenerate triangle shows no bumps, and takes its
/// tangents and sign from any neighbour; with NaN or infinity they are arbitrary.
pub fn is_measured(surface: &Surface, uvs: &[[f32; 2]], triangle: [usize; 3]) -> bool {
    let area = uv_area(uvs, triangle);
    let is_placed = |vertex: usize| surface.positions[vertex].iter().all(|x| x.is_finite());
    area != 0.0 && area.is_finite() && triangle.into_iter().all(is_placed)
}

/// Per vertex whether the corners of measured triangles have both signs.
pub fn on_mirrored_seams(surface: &Surface, uv_set: usize, expected: &[[f32; 4]]) -> Vec<bool> {
    let mut seen = vec![[false; 2]; surface.positions.len()];
    let Some(uvs) = surface.uv_sets.get(&uv_set) else { return vec![false; seen.len()] };
    for (triangle, tangents) in surface.triangles().zip(expected.as_chunks::<3>().0) {
        if !is_measured(surface, uvs, triangle) {
            continue;
        }
        for (vertex, tangent) in triangle.into_iter().zip(tangents) {
            seen[vertex][usize::from(tangent[3] < 0.0)] = true;
        }
    }
    seen.into_iter().map(|[positive, negative]| positive && negative).collect()
}
