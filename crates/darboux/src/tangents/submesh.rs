//! The general path for part of a mesh: what whole fans leave undecided, which are vertices, with all triangles around them, or corners of
//! degenerate triangles, with one triangle at each that they copy.

use crate::Frame;
use crate::Mesh;
use crate::exec::limits::RunLimits;

use crate::tangents::Report;
use crate::tangents::TangentOptions;
use crate::tangents::fast::{Fans, UNDECIDED, triangle_count};
use crate::tangents::mikktspace::raw_frames::DEFAULT_FRAME;
use crate::tangents::mikktspace::{GroupedMesh, SubmeshWeld};
use crate::topology::edge_sort::TriangleEdge;

/// The faces with an undecided corner, in their order, as a mesh of their own.
///
/// What decides about a corner is there: a UV-degenerate triangle, whose group another vertex can decide, leaves all its vertices
/// undecided; where a degenerate triangle's corner copies a decided one, so does a face that has that.
#[derive(Debug)]
pub(crate) struct UndecidedFaces {
    /// The corner of the whole mesh at each of the part's, and its vertex.
    corners: Vec<u32>,
    indices: Vec<u32>,
    /// The number of corners of each face.
    sizes: Vec<u32>,
    /// Of each corner.
    is_undecided: Vec<bool>,
    topology: GroupedMesh,
}

impl UndecidedFaces {
    /// Of the mesh that `fans` has just run on, with the tangents that it wrote; none where all vertices are decided.
    pub fn new(
        mesh: &Mesh<'_>,
        options: &TangentOptions,
        fans: &Fans,
        limits: RunLimits<'_>,
        tangents: &[[f32; 4]],
    ) -> Option<Self> {
        let faces = fans.undecided(mesh);
        let sizes: Vec<u32> = faces.clone().map(|corners| corners.len() as u32).collect();
        if sizes.is_empty() {
            return None;
        }
        let corners: Vec<u32> = faces.flatten().collect();
        let vertex = |&corner: &u32| mesh.vertex_of_corner(corner as usize) as u32;
        let indices: Vec<u32> = corners.iter().map(vertex).collect();
        let is_undecided = |&corner: &u32| tangents[corner as usize][3] == UNDECIDED;
        let is_undecided: Vec<bool> = corners.iter().map(is_undecided).collect();
        let names = fans.names(mesh, &corners);
        let counts = all_undecided(&names, &is_undecided);
        let tail_runs = stretches_within(&corners, &fans.tail_runs(mesh));
        let part = SubmeshWeld { names: &names, counts: &counts, tail_runs: &tail_runs };
        let topology = GroupedMesh::of_part(&mesh.with_other_faces(&indices, &sizes), &part, options, limits);
        Some(Self { corners, indices, sizes, is_undecided, topology })
    }

    /// Writes the tangents of the undecided corners; `out` has those of all others. Returns the report of the part.
    pub fn decide(&self, mesh: &Mesh<'_>, limits: RunLimits<'_>, out: &mut [[f32; 4]]) -> Report {
        let part = mesh.with_other_faces(&self.indices, &self.sizes);
        let (frames, report) = self.topology.frames_of_part(&part, self.known(out), limits);
        self.write(&frames, |corner, frame| out[corner] = frame.tangent_and_sign());
        report
    }

    /// As [`UndecidedFaces::decide`], whole frames with their corners, ascending. `tangents`: those of all others.
    fn decide_frames(
        &self,
        mesh: &Mesh<'_>,
        limits: RunLimits<'_>,
        tangents: &[[f32; 4]],
        out: &mut Vec<(u32, Frame)>,
    ) -> Report {
        let part = mesh.with_other_faces(&self.indices, &self.sizes);
        let (frames, report) = self.topology.frames_of_part(&part, self.known(tangents), limits);
        self.write(&frames, |corner, frame| out.push((corner as u32, frame)));
        report
    }

    /// As [`UndecidedFaces::decide`] for a mesh whose vertices have moved since, with the signs of `base`.
    pub fn decide_moved(
        &self,
        mesh: &Mesh<'_>,
        base: &[[f32; 4]],
        limits: RunLimits<'_>,
        out: &mut [[f32; 4]],
    ) {
        let part = mesh.with_other_faces(&self.indices, &self.sizes);
        let (frames, _) = self.topology.frames_of_moved(&part, self.known(out), limits);
        self.write(&frames, |corner, frame| out[corner] = frame.tangent_and_sign());
        for corner in self.corners.iter().map(|&corner| corner as usize) {
            out[corner][3] = base[corner][3];
        }
    }

    /// What is known of the part's corners, of which nothing reads the bitangent and the magnitudes; what no group reaches has the
    /// default.
    fn known(&self, out: &[[f32; 4]]) -> Vec<Frame> {
        let known = |(&corner, &is_undecided): (&u32, &bool)| {
            let [x, y, z, sign] = out[corner as usize];
            if is_undecided { DEFAULT_FRAME } else { Frame { tangent: [x, y, z], sign, ..DEFAULT_FRAME } }
        };
        self.corners.iter().zip(&self.is_undecided).map(known).collect()
    }

    /// Calls `write` with the undecided corners.
    fn write(&self, frames: &[Frame], mut write: impl FnMut(usize, Frame)) {
        let all = self.corners.iter().zip(frames).zip(&self.is_undecided);
        let undecided = all.filter(|(_, is_undecided)| **is_undecided);
        undecided.for_each(|((&corner, frame), _)| write(corner as usize, *frame));
    }
}

/// Decides the undecided corners in `out`, which has the tangents of all others, and makes the report of the whole mesh.
pub(crate) fn decide(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    fans: &Fans,
    limits: RunLimits<'_>,
    out: &mut [[f32; 4]],
) -> Report {
    let part = UndecidedFaces::new(mesh, options, fans, limits, out);
    let report = part.map(|part| part.decide(mesh, limits, out)).unwrap_or_default();
    Report { triangles: triangle_count(mesh), ..report }
}

/// As [`decide`], whole frames: those of the corners that are undecided in `tangents`, which `fans` wrote, ascending.
pub(crate) fn decide_frames(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    fans: &Fans,
    limits: RunLimits<'_>,
    tangents: &[[f32; 4]],
    out: &mut Vec<(u32, Frame)>,
) -> Report {
    let part = UndecidedFaces::new(mesh, options, fans, limits, tangents);
    let report = part.map(|part| part.decide_frames(mesh, limits, tangents, out)).unwrap_or_default();
    Report { triangles: triangle_count(mesh), ..report }
}

/// Of each corner, whose vertex has a name: whether all of the vertex's are undecided.
fn all_undecided(names: &[u32], is_undecided: &[bool]) -> Vec<bool> {
    let mut of_name = vec![true; names.len()];
    for (&name, is_undecided) in names.iter().zip(is_undecided) {
        of_name[name as usize] &= is_undecided;
    }
    names.iter().map(|&name| of_name[name as usize]).collect()
}

/// Edges of the mesh as edges of the part that has these of its corners.
fn stretches_within(corners: &[u32], stretches: &[Vec<TriangleEdge>]) -> Vec<Vec<TriangleEdge>> {
    let within = |corner: u32| corners.partition_point(|&other| other < corner) as u32;
    let edge = |&(triangle, start): &TriangleEdge| (triangle.map(within), start);
    stretches.iter().map(|stretch| stretch.iter().map(edge).collect()).collect()
}
