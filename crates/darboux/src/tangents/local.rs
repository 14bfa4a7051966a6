//! The general path for part of a mesh: the vertices that whole fans leave undecided, with all triangles around them.

use crate::{Cancel, Frame, Mesh};

use super::evaluate::DEFAULT_FRAME;
use super::fans::{Fans, UNDECIDED};
use super::mikktspace::{Part, Topology};
use super::{Report, TangentOptions};

/// The triangles with an undecided vertex, in their order, as a mesh of their own.
///
/// What decides about a vertex is there: a UV-degenerate triangle, whose group another vertex can decide, leaves all its vertices
/// undecided.
#[derive(Debug)]
pub(crate) struct UndecidedPart {
    /// The corner of the whole mesh at each of the part's, and its vertex.
    corners: Vec<u32>,
    indices: Vec<u32>,
    /// Of each corner: its vertex is undecided.
    counts: Vec<bool>,
    topology: Topology,
}

impl UndecidedPart {
    /// Of the mesh that `fans` has just run on, with the tangents that it wrote; none where all vertices are decided.
    pub fn new(
        mesh: &Mesh<'_>,
        options: &TangentOptions,
        fans: &Fans,
        tangents: &[[f32; 4]],
    ) -> Option<Self> {
        let triangles = fans.undecided();
        if triangles.is_empty() {
            return None;
        }
        let corners: Vec<u32> = triangles.iter().flat_map(|&t| 3 * t..3 * t + 3).collect();
        let vertex = |&corner: &u32| mesh.vertex_of_corner(corner as usize) as u32;
        let indices: Vec<u32> = corners.iter().map(vertex).collect();
        let is_undecided = |&corner: &u32| tangents[corner as usize][3] == UNDECIDED;
        let counts: Vec<bool> = corners.iter().map(is_undecided).collect();
        let names = fans.names(mesh, triangles);
        let last_stretches = stretches_within(triangles, fans.last_stretches());
        let part = Part { names: &names, counts: &counts, last_stretches: &last_stretches };
        let topology = Topology::of_part(&mesh.with_triangles(&indices), &part, options);
        Some(Self { corners, indices, counts, topology })
    }

    /// Writes the tangents of the undecided vertices; `out` has those of all others. Returns the report of the part.
    pub fn decide(&self, mesh: &Mesh<'_>, cancel: &Cancel, out: &mut [[f32; 4]]) -> Report {
        let part = mesh.with_triangles(&self.indices);
        let (frames, report) = self.topology.frames_of_part(&part, self.known(out), cancel);
        self.write(&frames, |corner, frame| out[corner] = frame.tangent_and_sign());
        report
    }

    /// As [`UndecidedPart::decide`], whole frames with their corners, ascending. `tangents`: those of all others.
    fn decide_frames(
        &self,
        mesh: &Mesh<'_>,
        cancel: &Cancel,
        tangents: &[[f32; 4]],
        out: &mut Vec<(u32, Frame)>,
    ) -> Report {
        let part = mesh.with_triangles(&self.indices);
        let (frames, report) = self.topology.frames_of_part(&part, self.known(tangents), cancel);
        self.write(&frames, |corner, frame| out.push((corner as u32, frame)));
        report
    }

    /// As [`UndecidedPart::decide`] for a mesh whose vertices have moved since, with the signs of `base`.
    pub fn decide_moved(&self, mesh: &Mesh<'_>, base: &[[f32; 4]], cancel: &Cancel, out: &mut [[f32; 4]]) {
        let part = mesh.with_triangles(&self.indices);
        let (frames, _) = self.topology.frames_of_moved(&part, self.known(out), cancel);
        self.write(&frames, |corner, frame| out[corner] = frame.tangent_and_sign());
        for corner in self.corners.iter().map(|&corner| corner as usize) {
            out[corner][3] = base[corner][3];
        }
    }

    /// What is known of the part's corners, of which nothing reads the bitangent and the magnitudes; what no group reaches has the
    /// default.
    fn known(&self, out: &[[f32; 4]]) -> Vec<Frame> {
        let known = |(&corner, &counts): (&u32, &bool)| {
            let [x, y, z, sign] = out[corner as usize];
            if counts { DEFAULT_FRAME } else { Frame { tangent: [x, y, z], sign, ..DEFAULT_FRAME } }
        };
        self.corners.iter().zip(&self.counts).map(known).collect()
    }

    /// Calls `write` with the corners of undecided vertices.
    fn write(&self, frames: &[Frame], mut write: impl FnMut(usize, Frame)) {
        let all = self.corners.iter().zip(frames).zip(&self.counts);
        all.filter(|(_, counts)| **counts).for_each(|((&corner, frame), _)| write(corner as usize, *frame));
    }
}

/// Decides the undecided vertices in `out`, which has the tangents of all others, and makes the report of the whole mesh.
pub(super) fn decide(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    fans: &Fans,
    cancel: &Cancel,
    out: &mut [[f32; 4]],
) -> Report {
    let part = UndecidedPart::new(mesh, options, fans, out);
    let report = part.map(|part| part.decide(mesh, cancel, out)).unwrap_or_default();
    Report { triangles: mesh.face_count(), ..report }
}

/// As [`decide`], whole frames: those of the corners that are undecided in `tangents`, which `fans` wrote, ascending.
pub(super) fn decide_frames(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    fans: &Fans,
    cancel: &Cancel,
    tangents: &[[f32; 4]],
    out: &mut Vec<(u32, Frame)>,
) -> Report {
    let part = UndecidedPart::new(mesh, options, fans, tangents);
    let report = part.map(|part| part.decide_frames(mesh, cancel, tangents, out)).unwrap_or_default();
    Report { triangles: mesh.face_count(), ..report }
}

/// Corners of the mesh as corners of the part that some of its triangles are.
fn stretches_within(triangles: &[u32], stretches: &[Vec<u32>]) -> Vec<Vec<u32>> {
    let within =
        |corner: &u32| 3 * triangles.partition_point(|&triangle| triangle < corner / 3) as u32 + corner % 3;
    stretches.iter().map(|stretch| stretch.iter().map(within).collect()).collect()
}
