//! The method of faces: one frame per face, from dP/du and dP/dv on the face.
//!
//! Both derivatives lie in the plane of the triangle, so the frame belongs to the triangle's normal, not to
//! those of the vertices. A quad has the mean derivatives over its UV area, which do not depend on the
//! diagonal.

use crate::Frame;
use crate::Mesh;
use crate::math::{V3, add, not_zero};
use crate::math_f64::unit;

use crate::exec::limits::RunLimits;
use crate::tangents::Report;
use crate::tangents::methods::mesh_slices::MeshSlices;
use crate::tangents::methods::report_counts::{count_irregular, count_mirrored_edges, vertices_of_both};
use crate::tangents::methods::uv_derivatives::{Orientation, ScaledDerivatives, is_degenerate};
use crate::tangents::output::{Output, fill};
use crate::tangents::repair::{across, direction, in_plane, perpendicular};
use crate::tangents::report::{are_finite, count_split_vertices};

/// The sums over the triangles of one face.
#[derive(Clone, Copy, Default)]
struct Face {
    /// dP/du and dP/dv, each times `area`.
    s: V3,
    t: V3,
    /// Twice the signed UV area.
    area: f32,
    /// Twice the area vector.
    normal: V3,
}

/// Writes the frame of every face to its corners.
pub(crate) fn run<O: Output>(mesh: &Mesh<'_>, limits: RunLimits<'_>, corners: &mut [O]) -> Report {
    let slices = MeshSlices::new(mesh);
    let mut report = count_irregular(mesh, &slices, limits);
    let faces = add_up(&slices, limits, &mut report);
    let mut orientations = Vec::with_capacity(faces.len());
    for number in limits.parts(0..faces.len()).flatten() {
        let face = &faces[number];
        let frame = face.frame();
        orientations.push(frame.map_or(Orientation::None, |frame| Orientation::of(frame.sign)));
        let range = slices.corners(number);
        let vertices = &slices.vertex_of_corner[range.clone()];
        report.repaired_corners += if frame.is_some() { 0 } else { vertices.len() };
        let replacement = |&v: &u32| O::from_frame(&face.replacement(slices.normals[v as usize]));
        let (own, corners) = (frame.map(|frame| O::from_frame(&frame)), &mut corners[range]);
        match own {
            Some(own) => corners.fill(own),
            None => fill(corners, vertices.iter().map(replacement)),
        }
    }
    if limits.is_cancelled() {
        return Report::default();
    }
    if let Some(of_both) = vertices_of_both(&slices, &orientations) {
        report.mirrored_edges = count_mirrored_edges(&slices, &orientations, &of_both);
    }
    report.split_vertices = count_split_vertices(mesh, corners, limits);
    report
}

fn add_up(slices: &MeshSlices<'_>, limits: RunLimits<'_>, report: &mut Report) -> Vec<Face> {
    let mut faces = vec![Face::default(); slices.face_count()];
    let inputs = slices.triangle_inputs();
    for t in limits.parts(0..inputs.triangles.len()).flatten() {
        let (positions, uvs) = inputs.values_of(inputs.triangles[t]);
        let derivatives = ScaledDerivatives::new(positions, uvs);
        if is_degenerate(slices.values(t).0) {
            report.degenerate_triangles += 1;
        } else if !derivatives.has_direction()
            && are_finite(positions.map(|position| *position), uvs.map(|uv| *uv))
        {
            report.uv_degenerate_triangles += 1;
        }
        let face = &mut faces[slices.face(t)];
        face.s = add(face.s, derivatives.s);
        face.t = add(face.t, derivatives.t);
        face.area += derivatives.area;
        face.normal = add(face.normal, derivatives.doubled_area_vector());
    }
    faces
}

impl Face {
    /// The directions and lengths of the derivatives. `None` without a UV area or without a direction.
    #[inline(always)]
    fn frame(&self) -> Option<Frame> {
        let area = f64::from(self.area);
        let derivatives = [self.s, self.t].map(|v| v.map(|x| f64::from(x) / area));
        let [tangent, bitangent] = derivatives.map(unit);
        let (tangent, bitangent) = (tangent?.map(|x| x as f32), bitangent?.map(|x| x as f32));
        let magnitude = derivatives.map(|v| v.iter().map(|x| x * x).sum::<f64>().sqrt() as f32);
        not_zero(self.area).then_some(Frame { tangent, bitangent, magnitude, sign: 1f32.copysign(self.area) })
    }

    /// The frame of faces without derivatives. The tangent is the first of these that exists: the direction
    /// in which u changes; a perpendicular of the face's normal; a perpendicular of the vertex's normal;
    /// (1, 0, 0).
    fn replacement(&self, normal_of_vertex: V3) -> Frame {
        let normal = if direction(self.normal).is_some() { self.normal } else { normal_of_vertex };
        let own = direction(normal).and_then(|normal| in_plane(self.s.map(f64::from), normal));
        let tangent = own.or_else(|| direction(normal).map(perpendicular)).unwrap_or([1.0, 0.0, 0.0]);
        let tangent = tangent.map(|x| x as f32);
        Frame { tangent, bitangent: across(normal, tangent, 1.0), magnitude: [1.0; 2], sign: 1.0 }
    }
}
