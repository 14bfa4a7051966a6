//! The general path for part of a mesh: the vertices that whole fans leave undecided, with all triangles around them.

use crate::{Frame, Mesh};

use super::evaluate::DEFAULT_FRAME;
use super::fans::{Fans, UNDECIDED};
use super::mikktspace::{Part, Topology};
use super::{Report, TangentOptions, Tangents};

/// Decides the undecided vertices in `out`, which has the tangents of all others, and returns the report of the whole mesh.
///
/// The triangles with an undecided vertex, in their order, make a mesh of their own. What decides about a vertex is there: a
/// UV-degenerate triangle, whose group another vertex can decide, leaves all its vertices undecided.
pub(super) fn decide(mesh: &Mesh<'_>, options: &TangentOptions, fans: &Fans, out: &mut Tangents) {
    let triangles = fans.undecided();
    out.report = Report::default();
    if !triangles.is_empty() {
        let corners: Vec<usize> =
            triangles.iter().flat_map(|&t| (0..3).map(move |k| 3 * t as usize + k)).collect();
        let indices: Vec<u32> = corners.iter().map(|&corner| mesh.vertex_of_corner(corner) as u32).collect();
        let part = mesh.with_triangles(&indices);
        let names = fans.names(mesh, triangles);
        let last_stretches = stretches_within(triangles, fans.last_stretches());
        let counts: Vec<bool> = corners.iter().map(|&corner| out.corners.0[corner][3] == UNDECIDED).collect();
        let known = corners.iter().map(|&corner| known_frame(out.corners.0[corner])).collect();
        let topology = Topology::of_part(
            &part,
            &Part { names: &names, counts: &counts, last_stretches: &last_stretches },
            options,
        );
        let (frames, report) = topology.frames_of_part(&part, known);
        for ((corner, frame), _) in corners.into_iter().zip(frames).zip(counts).filter(|(_, counts)| *counts)
        {
            out.corners.0[corner] = frame.tangent_and_sign();
        }
        out.report = report;
    }
    out.report.triangles = mesh.face_count();
}

/// Corners of the mesh as corners of the part that some of its triangles are.
fn stretches_within(triangles: &[u32], stretches: &[Vec<u32>]) -> Vec<Vec<u32>> {
    let within =
        |corner: &u32| 3 * triangles.partition_point(|&triangle| triangle < corner / 3) as u32 + corner % 3;
    stretches.iter().map(|stretch| stretch.iter().map(within).collect()).collect()
}

/// A decided corner as a frame, of which nothing reads the bitangent and the magnitudes; what no group reaches has the default.
fn known_frame([x, y, z, sign]: [f32; 4]) -> Frame {
    if sign == UNDECIDED { DEFAULT_FRAME } else { Frame { tangent: [x, y, z], sign, ..DEFAULT_FRAME } }
}
