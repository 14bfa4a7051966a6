//! One frame per face, from the inverse of the UV edge matrix: dP/du and dP/dv as they are on the face.
//!
//! Both lie in the plane of a triangle, so its own normal is theirs, not that of its vertices. A quad has the mean derivatives over its
//! UV area, which do not depend on the diagonal.

use crate::Frame;
use crate::Mesh;
use crate::Mode;
use crate::math::{V3, add, not_zero};

use crate::exec::limits::RunLimits;
use crate::tangents::Report;
use crate::tangents::mesh_slices::MeshSlices;
use crate::tangents::mirrored_edges::{count_mirrored_edges, survey, vertices_of_both};
use crate::tangents::output::{Output, fill};
use crate::tangents::repair::across;
use crate::tangents::repair::{direction, in_plane, perpendicular, unit};
use crate::tangents::report::{are_finite, count_split_vertices};
use crate::tangents::uv_derivatives::{Orientation, ScaledDerivatives, is_degenerate};

/// What the triangles of one face add up to.
#[derive(Clone, Copy, Default)]
struct Face {
    s: V3,
    t: V3,
    /// Twice the signed UV area.
    area: f32,
    /// Twice the area vector.
    normal: V3,
}

/// The frame of every face, at each of its corners.
pub(crate) fn run<O: Output>(
    mesh: &Mesh<'_>,
    mode: Mode,
    limits: RunLimits<'_>,
    corners: &mut [O],
) -> Report {
    let flat = MeshSlices::new(mesh);
    let mut report = survey(mesh, &flat, limits);
    let faces = add_up(&flat, &mut report);
    let mut orientations = Vec::with_capacity(faces.len());
    for (number, face) in faces.iter().enumerate() {
        let frame = face.frame();
        orientations.push(frame.map_or(Orientation::None, |frame| Orientation::of(frame.sign)));
        let range = flat.corners(number);
        let vertices = &flat.vertex_of_corner[range.clone()];
        report.repaired_corners += if frame.is_some() { 0 } else { vertices.len() };
        let replacement = |&v: &u32| O::from_frame(&face.replacement(flat.normals[v as usize]));
        let (own, corners) = (frame.map(|frame| O::from_frame(&frame)), &mut corners[range]);
        match (own, mode) {
            (Some(own), _) => corners.fill(own),
            (None, Mode::Reference) => corners.fill(O::EMPTY),
            (None, _) => fill(corners, vertices.iter().map(replacement)),
        }
    }
    if let Some(of_both) = vertices_of_both(&flat, &orientations) {
        report.mirrored_edges = count_mirrored_edges(&flat, &orientations, &of_both);
    }
    report.split_vertices = count_split_vertices(mesh, corners);
    report
}

fn add_up(flat: &MeshSlices<'_>, report: &mut Report) -> Vec<Face> {
    let mut faces = vec![Face::default(); flat.face_count()];
    let slices = flat.slices();
    for (t, &triangle) in slices.triangles.iter().enumerate() {
        let (positions, uvs) = slices.refer(triangle);
        let derivatives = ScaledDerivatives::new(positions, uvs);
        if is_degenerate(flat.values(t).0) {
            report.degenerate_triangles += 1;
        } else if !derivatives.has_direction()
            && are_finite(positions.map(|position| *position), uvs.map(|uv| *uv))
        {
            report.uv_degenerate_triangles += 1;
        }
        let face = &mut faces[flat.face(t)];
        face.s = add(face.s, derivatives.s);
        face.t = add(face.t, derivatives.t);
        face.area += derivatives.area;
        face.normal = add(face.normal, derivatives.doubled_area_vector());
    }
    faces
}

impl Face {
    /// The derivatives' directions and lengths; none without UV area, or without a direction.
    #[inline(always)]
    fn frame(&self) -> Option<Frame> {
        let area = f64::from(self.area);
        let derivatives = [self.s, self.t].map(|v| v.map(|x| f64::from(x) / area));
        let [tangent, bitangent] = derivatives.map(unit);
        let (tangent, bitangent) = (tangent?.map(|x| x as f32), bitangent?.map(|x| x as f32));
        let magnitude = derivatives.map(|v| v.iter().map(|x| x * x).sum::<f64>().sqrt() as f32);
        not_zero(self.area).then_some(Frame { tangent, bitangent, magnitude, sign: 1f32.copysign(self.area) })
    }

    /// The direction in which u changes, if it changes at all; a perpendicular of the face's normal, or the vertex's; (1, 0, 0).
    fn replacement(&self, normal_of_vertex: V3) -> Frame {
        let normal = if direction(self.normal).is_some() { self.normal } else { normal_of_vertex };
        let own = direction(normal).and_then(|normal| in_plane(self.s.map(f64::from), normal));
        let tangent = own.or_else(|| direction(normal).map(perpendicular)).unwrap_or([1.0, 0.0, 0.0]);
        let tangent = tangent.map(|x| x as f32);
        Frame { tangent, bitangent: across(normal, tangent, 1.0), magnitude: [1.0; 2], sign: 1.0 }
    }
}
