//! Completes a run of the fast path: runs the exact stages of MikkTSpace on the faces with undecided corners.
//!
//! The fast path ([`crate::tangents::fast`]) writes the tangents of vertices that it can decide, and the sign
//! [`UNDECIDED`] at all other corners. The faces with an undecided corner are a submesh, which holds
//! everything that decides about its undecided corners:
//! - an undecided vertex has all its faces there;
//! - a UV-degenerate triangle, whose orientation depends on the groups of all its vertices, leaves all of
//!   them undecided that have groups;
//! - where a corner of a degenerate triangle copies a decided corner, a face with that corner is there.

use crate::Faces;
use crate::Frame;
use crate::Indices;
use crate::Mesh;
use crate::exec::limits::RunLimits;
use crate::topology::edge_sort::TriangleEdge;
use crate::util::radix_sort::sort_by_key;

use crate::tangents::MikkTSpaceOptions;
use crate::tangents::Report;
use crate::tangents::fast::{FastPath, UNDECIDED, triangle_count};
use crate::tangents::mikktspace::raw_frames::DEFAULT_FRAME;
use crate::tangents::mikktspace::{GroupedMesh, SubmeshWeld};

/// The faces with an undecided corner, in their order, as a mesh of their own.
#[derive(Debug)]
pub(crate) struct UndecidedFaces {
    /// The corner of the mesh of each corner of the submesh.
    corners: Vec<u32>,
    /// The vertex of each corner of the submesh.
    indices: Vec<u32>,
    /// The number of corners of each face.
    sizes: Vec<u32>,
    /// For each corner of the submesh: true when the fast path left it undecided.
    is_undecided: Vec<bool>,
    grouped: GroupedMesh,
}

impl UndecidedFaces {
    /// Collects and groups the undecided faces. `None` where all corners are decided, and after cancellation.
    ///
    /// `fast`: the state of the fast path after its run on `mesh`. `tangents`: the output of that run.
    pub fn new(
        mesh: &Mesh<'_>,
        options: &MikkTSpaceOptions,
        fast: &FastPath,
        limits: RunLimits<'_>,
        tangents: &[[f32; 4]],
    ) -> Option<Self> {
        let faces = fast.undecided(mesh);
        let sizes: Vec<u32> = faces.clone().map(|corners| corners.len() as u32).collect();
        if sizes.is_empty() {
            return None;
        }
        let corners: Vec<u32> = faces.flatten().collect();
        let vertex = |&corner: &u32| mesh.vertex_of_corner(corner as usize) as u32;
        let indices: Vec<u32> = corners.iter().map(vertex).collect();
        let is_undecided = |&corner: &u32| tangents[corner as usize][3] == UNDECIDED;
        let is_undecided: Vec<bool> = corners.iter().map(is_undecided).collect();
        let vertex_of_corner = fast.names(mesh, &corners);
        let is_complete = are_all_undecided(&vertex_of_corner, &is_undecided);
        let tail_runs = runs_within(&corners, &fast.tail_runs(mesh));
        let weld = SubmeshWeld {
            vertex_of_corner: &vertex_of_corner,
            is_complete: &is_complete,
            tail_runs: &tail_runs,
        };
        let submesh = mesh.with_other_faces(Indices::U32(&indices), Faces::Mixed(&sizes));
        let grouped = GroupedMesh::of_submesh(&submesh, &weld, options, limits)?;
        Some(Self { corners, indices, sizes, is_undecided, grouped })
    }

    /// The undecided faces over the vertices of a mesh.
    fn submesh<'a>(&'a self, mesh: &Mesh<'a>) -> Mesh<'a> {
        mesh.with_other_faces(Indices::U32(&self.indices), Faces::Mixed(&self.sizes))
    }

    /// Writes the tangents of the undecided corners. Returns the report of the submesh.
    ///
    /// `out`: one tangent per corner of the mesh; decided corners are read.
    pub fn decide(&self, mesh: &Mesh<'_>, limits: RunLimits<'_>, out: &mut [[f32; 4]]) -> Report {
        let submesh = self.submesh(mesh);
        let (frames, report) = self.grouped.frames_from(&submesh, self.initial_frames(out), limits);
        self.write(&frames, |corner, frame| out[corner] = frame.tangent_and_sign());
        report
    }

    /// As [`UndecidedFaces::decide`], but appends the corners and their full frames to `out`, ascending.
    ///
    /// `tangents`: one tangent per corner of the mesh; decided corners are read.
    fn decide_frames(
        &self,
        mesh: &Mesh<'_>,
        limits: RunLimits<'_>,
        tangents: &[[f32; 4]],
        out: &mut Vec<(u32, Frame)>,
    ) -> Report {
        let submesh = self.submesh(mesh);
        let (frames, report) = self.grouped.frames_from(&submesh, self.initial_frames(tangents), limits);
        self.write(&frames, |corner, frame| out.push((corner as u32, frame)));
        report
    }

    /// As [`UndecidedFaces::decide`] for the mesh after its vertices moved. `base`: the tangents before; the
    /// signs are theirs.
    pub fn decide_moved(
        &self,
        mesh: &Mesh<'_>,
        base: &[[f32; 4]],
        limits: RunLimits<'_>,
        out: &mut [[f32; 4]],
    ) {
        let submesh = self.submesh(mesh);
        let (frames, _) = self.grouped.frames_of_moved(&submesh, self.initial_frames(out), limits);
        self.write(&frames, |corner, frame| out[corner] = frame.tangent_and_sign());
        for corner in self.corners.iter().map(|&corner| corner as usize) {
            out[corner][3] = base[corner][3];
        }
    }

    /// The frames of decided corners, and the default frame for undecided ones. Bitangents and magnitudes are
    /// not read.
    fn initial_frames(&self, tangents: &[[f32; 4]]) -> Vec<Frame> {
        let frame = |(&corner, &is_undecided): (&u32, &bool)| {
            let [x, y, z, sign] = tangents[corner as usize];
            if is_undecided { DEFAULT_FRAME } else { Frame { tangent: [x, y, z], sign, ..DEFAULT_FRAME } }
        };
        self.corners.iter().zip(&self.is_undecided).map(frame).collect()
    }

    /// Calls `write` with each undecided corner and its frame.
    fn write(&self, frames: &[Frame], mut write: impl FnMut(usize, Frame)) {
        let all = self.corners.iter().zip(frames).zip(&self.is_undecided);
        let undecided = all.filter(|(_, is_undecided)| **is_undecided);
        undecided.for_each(|((&corner, frame), _)| write(corner as usize, *frame));
    }
}

/// Writes the tangents of the undecided corners of `out`: first those that the groups around their vertices
/// decide. Returns the report of the whole mesh.
pub(crate) fn complete(
    mesh: &Mesh<'_>,
    options: &MikkTSpaceOptions,
    fast: &mut FastPath,
    limits: RunLimits<'_>,
    out: &mut [[f32; 4]],
) -> Report {
    complete_for_plan(mesh, options, fast, limits, out).0
}

/// As [`complete`], and returns the faces that the groups around their vertices leave undecided. For meshes
/// with undecided faces in which vertices without UV area are undecided, too.
pub(crate) fn complete_for_plan(
    mesh: &Mesh<'_>,
    options: &MikkTSpaceOptions,
    fast: &mut FastPath,
    limits: RunLimits<'_>,
    out: &mut [[f32; 4]],
) -> (Report, Option<UndecidedFaces>) {
    let resolved = fast.resolve(mesh, options, limits, out, None);
    let faces = UndecidedFaces::new(mesh, options, fast, limits, out);
    let left = faces.as_ref().map(|faces| faces.decide(mesh, limits, out)).unwrap_or_default();
    let left = Report { triangles: triangle_count(mesh), ..left };
    (whole_report(mesh, fast, out, resolved, left), faces)
}

/// As [`complete`], but lists the undecided corners and their full frames in `out`, ascending, and leaves
/// them undecided in `tangents`.
pub(crate) fn complete_frames(
    mesh: &Mesh<'_>,
    options: &MikkTSpaceOptions,
    fast: &mut FastPath,
    limits: RunLimits<'_>,
    tangents: &mut [[f32; 4]],
    out: &mut Vec<(u32, Frame)>,
) -> Report {
    let resolved = fast.resolve(mesh, options, limits, tangents, Some(out));
    let faces = UndecidedFaces::new(mesh, options, fast, limits, tangents);
    let left = faces.map(|faces| faces.decide_frames(mesh, limits, tangents, out)).unwrap_or_default();
    for (corner, frame) in &*out {
        tangents[*corner as usize] = frame.tangent_and_sign();
    }
    let report = whole_report(mesh, fast, tangents, resolved, left);
    out.iter().for_each(|(corner, _)| tangents[*corner as usize][3] = UNDECIDED);
    sort_by_key(out, |(corner, _)| u64::from(*corner), &mut Vec::new());
    Report { triangles: triangle_count(mesh), ..report }
}

/// The report of a whole mesh. `tangents`: the final ones. `resolved`: the counts of what was resolved.
/// `left`: those of the faces that were left.
fn whole_report(
    mesh: &Mesh<'_>,
    fast: &FastPath,
    tangents: &[[f32; 4]],
    resolved: Option<Report>,
    left: Report,
) -> Report {
    let uv_degenerate_triangles = fast.flat_triangles;
    let Some(resolved) = resolved else { return Report { uv_degenerate_triangles, ..left } };
    Report {
        uv_degenerate_triangles,
        triangles: left.triangles,
        repaired_corners: resolved.repaired_corners + left.repaired_corners,
        mixed_sign_faces: resolved.mixed_sign_faces + left.mixed_sign_faces,
        split_vertices: fast.count_split_vertices(mesh, tangents),
        ..resolved
    }
}

/// Writes the tangents of the undecided corners of `out`. Returns the report of the whole mesh.
pub(crate) fn decide(
    mesh: &Mesh<'_>,
    options: &MikkTSpaceOptions,
    fast: &FastPath,
    limits: RunLimits<'_>,
    out: &mut [[f32; 4]],
) -> Report {
    let faces = UndecidedFaces::new(mesh, options, fast, limits, out);
    let report = faces.map(|faces| faces.decide(mesh, limits, out)).unwrap_or_default();
    Report { triangles: triangle_count(mesh), ..report }
}

/// For each corner: true when all corners of its vertex are undecided.
fn are_all_undecided(vertex_of_corner: &[u32], is_undecided: &[bool]) -> Vec<bool> {
    let mut of_vertex = vec![true; vertex_of_corner.len()];
    for (&vertex, is_undecided) in vertex_of_corner.iter().zip(is_undecided) {
        of_vertex[vertex as usize] &= is_undecided;
    }
    vertex_of_corner.iter().map(|&vertex| of_vertex[vertex as usize]).collect()
}

/// Renumbers the corners of half-edges from the mesh to the submesh, and drops those outside. `corners`: the
/// corners of the submesh, ascending.
fn runs_within(corners: &[u32], runs: &[Vec<TriangleEdge>]) -> Vec<Vec<TriangleEdge>> {
    let within = |corner: u32| corners.partition_point(|&other| other < corner) as u32;
    let is_inside = |(triangle, _): &&TriangleEdge| corners.binary_search(&triangle[0]).is_ok();
    let edge = |&(triangle, start): &TriangleEdge| (triangle.map(within), start);
    runs.iter().map(|run| run.iter().filter(is_inside).map(edge).collect()).collect()
}
