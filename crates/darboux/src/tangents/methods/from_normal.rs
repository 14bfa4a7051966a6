//! The method for surfaces without UVs: the tangent is a perpendicular of the normal, a function of the
//! normal alone.
//!
//! Source: T. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017, listing 3. No
//! continuous function exists (hairy ball theorem); this one is discontinuous where z changes sign.

use crate::Frame;
use crate::Mesh;
use crate::math::V3;

use crate::exec::limits::RunLimits;
use crate::exec::threads;
use crate::tangents::Report;
use crate::tangents::methods::mesh_slices::MeshSlices;
use crate::tangents::methods::report_counts::count_irregular;
use crate::tangents::methods::uv_derivatives::is_degenerate;
use crate::tangents::output::{Output, fill};
use crate::tangents::repair::{across, direction, perpendicular};

/// Writes the frame of every vertex to its corners.
pub(crate) fn run<O: Output>(mesh: &Mesh<'_>, limits: RunLimits<'_>, corners: &mut [O]) -> Report {
    let slices = MeshSlices::new(mesh);
    let mut report = count_irregular(mesh, &slices, limits);
    let frame = |&normal: &V3| {
        let tangent = direction(normal).map_or([1.0, 0.0, 0.0], perpendicular).map(|x| x as f32);
        let bitangent = if O::IS_FULL { across(normal, tangent, 1.0) } else { [0.0; 3] };
        O::from_frame(&Frame { tangent, bitangent, magnitude: [1.0; 2], sign: 1.0 })
    };
    let of_vertex: Vec<O> = threads::map(limits, slices.normals.len(), |v| frame(&slices.normals[v]));
    if limits.is_cancelled() {
        return Report::default();
    }
    let has_normal: Vec<bool> = slices.normals.iter().map(|&normal| direction(normal).is_some()).collect();
    report.repaired_corners = slices.vertex_of_corner.iter().filter(|&&v| !has_normal[v as usize]).count();
    report.degenerate_triangles =
        (0..slices.triangles().len()).filter(|&t| is_degenerate(slices.values(t).0)).count();
    if limits.is_cancelled() {
        return Report::default();
    }
    fill(corners, slices.vertex_of_corner.iter().map(|&v| of_vertex[v as usize]));
    report
}
