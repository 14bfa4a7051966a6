//! A frame from the normal alone, for surfaces without UVs: any perpendicular, the same for the same normal.
//!
//! Source: T. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017, listing 3. No continuous choice exists
//! (the sphere cannot be combed): this one jumps where z changes its sign.

use crate::Frame;
use crate::Mesh;
use crate::Mode;
use crate::math::V3;

use crate::exec::limits::RunLimits;
use crate::tangents::Report;
use crate::tangents::mesh_slices::MeshSlices;
use crate::tangents::mirrored_edges::survey;
use crate::tangents::output::{Output, fill};
use crate::tangents::repair::across;
use crate::tangents::repair::{direction, perpendicular};
use crate::tangents::uv_derivatives::is_degenerate;

/// The frame of every vertex, at each of its corners.
pub(crate) fn run<O: Output>(
    mesh: &Mesh<'_>,
    mode: Mode,
    limits: RunLimits<'_>,
    corners: &mut [O],
) -> Report {
    let flat = MeshSlices::new(mesh);
    let mut report = survey(mesh, &flat, limits);
    let frame = |&normal: &V3| match (direction(normal), mode) {
        (None, Mode::Reference) => O::EMPTY,
        (unit, _) => {
            let tangent = unit.map_or([1.0, 0.0, 0.0], perpendicular).map(|x| x as f32);
            let bitangent = if O::IS_FULL { across(normal, tangent, 1.0) } else { [0.0; 3] };
            O::from_frame(&Frame { tangent, bitangent, magnitude: [1.0; 2], sign: 1.0 })
        }
    };
    let of_vertex: Vec<O> = flat.normals.iter().map(frame).collect();
    let has_normal: Vec<bool> = flat.normals.iter().map(|&normal| direction(normal).is_some()).collect();
    report.repaired_corners = flat.vertex_of_corner.iter().filter(|&&v| !has_normal[v as usize]).count();
    report.degenerate_triangles =
        (0..flat.triangles().len()).filter(|&t| is_degenerate(flat.values(t).0)).count();
    fill(corners, flat.vertex_of_corner.iter().map(|&v| of_vertex[v as usize]));
    report
}
