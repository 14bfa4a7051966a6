//! How well tangents follow the derivatives of the UV map.

use super::angle::{angle_of, xyz};
use crate::Context;
use crate::Error;
use crate::Mesh;
use crate::math::V3;
use crate::math_f64::{D3, cross, length};

/// The angle between interpolated tangents and dP/du, over the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct UvFidelity {
    /// The mean angle over the surface, weighted by area, in degrees.
    pub mean: f64,
    /// The root of the mean square of the angle, in degrees. Large angles dominate it.
    pub root_mean_square: f64,
    /// The area of the triangles that were measured.
    pub area: f64,
    /// The number of triangles that were not measured, because they have no area or no dP/du.
    pub unmeasured_triangles: usize,
}

/// Measures tangents against the derivatives of the UV map.
///
/// Each triangle is sampled at the centres of 16 equal parts. At each sample, the tangents of the three
/// corners are interpolated linearly, and the angle to the triangle's dP/du is measured. Smooth normals alone
/// cause a part of the angle: tangents are perpendicular to them, while dP/du lies in the face. Quads are cut
/// from corner 0 to 2. `tangents`: one per corner. Errors: another number of tangents than corners.
pub fn measure_uv_fidelity(mesh: &Mesh<'_>, tangents: &[[f32; 4]]) -> Result<UvFidelity, Error> {
    measure_uv_fidelity_with(mesh, tangents, &mut Context::new())
}

/// As [`measure_uv_fidelity`], with a context. Further error: the context's token was cancelled.
pub fn measure_uv_fidelity_with(
    mesh: &Mesh<'_>,
    tangents: &[[f32; 4]],
    context: &mut Context,
) -> Result<UvFidelity, Error> {
    Error::check_input("tangents", mesh.corner_count(), tangents.len())?;
    let (mut out, limits) = (UvFidelity::default(), context.limits());
    let (mut sum, mut squares) = (0.0, 0.0);
    for (number, triangle) in triangles(mesh).enumerate() {
        limits.check_at(number)?;
        let Some((u_direction, area)) = u_direction_and_area(mesh, triangle) else {
            out.unmeasured_triangles += 1;
            continue;
        };
        let corners = triangle.map(|corner| xyz(tangents[corner]).map(f64::from));
        for weights in CENTRES {
            let tangent = [0, 1, 2].map(|i| (0..3).map(|k| weights[k] * corners[k][i]).sum::<f64>());
            // Where tangents cancel, the direction is unspecified: count 90 degrees.
            let angle = angle_of(tangent, u_direction).unwrap_or(90.0);
            sum += angle * area / CENTRES.len() as f64;
            squares += angle * angle * area / CENTRES.len() as f64;
        }
        out.area += area;
    }
    if out.area > 0.0 {
        (out.mean, out.root_mean_square) = (sum / out.area, (squares / out.area).sqrt());
    }
    Ok(out)
}

/// The corners of every triangle. Quads are cut from corner 0 to 2, other faces have no triangles.
fn triangles(mesh: &Mesh<'_>) -> impl Iterator<Item = [usize; 3]> {
    mesh.face_ranges().flat_map(|face| {
        let halves: &[[usize; 3]] = match face.len() {
            3 => &[[0, 1, 2]],
            4 => &[[0, 1, 2], [0, 2, 3]],
            _ => &[],
        };
        halves.iter().map(move |half| half.map(|corner| face.start + corner))
    })
}

/// dP/du and the area of a triangle. `None` where one of them is zero or not finite.
fn u_direction_and_area(mesh: &Mesh<'_>, triangle: [usize; 3]) -> Option<(D3, f64)> {
    let vertices = triangle.map(|corner| mesh.vertex_of_corner(corner));
    let positions = vertices.map(|vertex| mesh.positions().get(vertex));
    let [t0, t1, t2] = vertices.map(|vertex| mesh.uvs().get(vertex).map(f64::from));
    let [e1, e2] = edges(positions);
    let [dv1, dv2] = [t1[1] - t0[1], t2[1] - t0[1]];
    let uv_area = (t1[0] - t0[0]) * dv2 - dv1 * (t2[0] - t0[0]);
    let direction = [0, 1, 2].map(|i| (dv2 * e1[i] - dv1 * e2[i]) / uv_area);
    let area = triangle_area(positions);
    let has_both = area > 0.0 && area.is_finite() && length(direction) > 0.0 && length(direction).is_finite();
    has_both.then_some((direction, area))
}

/// The barycentric coordinates of the centres of the 16 equal parts of a triangle.
const CENTRES: [[f64; 3]; 16] = {
    let mut centres = [[0.0; 3]; 16];
    let (mut at, mut i) = (0, 0);
    while i < 4 {
        let mut j = 0;
        while i + j < 4 {
            // The part with the triangle's orientation, and the rotated part beside it.
            let [a, b] = [3.0 * i as f64 + 1.0, 3.0 * j as f64 + 1.0];
            centres[at] = [a / 12.0, b / 12.0, (12.0 - a - b) / 12.0];
            at += 1;
            if i + j < 3 {
                centres[at] = [(a + 1.0) / 12.0, (b + 1.0) / 12.0, (10.0 - a - b) / 12.0];
                at += 1;
            }
            j += 1;
        }
        i += 1;
    }
    centres
};

/// The area of a triangle. `corners`: three positions. The area is not finite where a position is not finite.
pub fn triangle_area(corners: [[f32; 3]; 3]) -> f64 {
    let [e1, e2] = edges(corners);
    0.5 * length(cross(e1, e2))
}

/// The edges from corner 0 to 1 and from corner 0 to 2.
fn edges(corners: [V3; 3]) -> [D3; 2] {
    let [p0, p1, p2] = corners.map(|p| p.map(f64::from));
    [p1, p2].map(|p| [p[0] - p0[0], p[1] - p0[1], p[2] - p0[2]])
}
