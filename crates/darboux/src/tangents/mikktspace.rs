//! MikkTSpace in its exact stages: bit for bit what mikktspace.c computes.
//!
//! [`GroupedMesh`] is the table of contents: [`GroupedMesh::new`] runs the stages that depend on topology,
//! [`GroupedMesh::frames`] those that follow. Every floating-point operation is rounded to `f32` in the
//! reference's order. These stages are slower than [`crate::tangents::fast`] and define its results; they
//! also complete what it leaves undecided ([`crate::tangents::submesh`]). docs/algorithms/mikktspace.md says
//! what "exact" covers.
//!
//! Source: Morten S. Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", 2008, and mikktspace.c.

pub(crate) mod antipodes;
pub(crate) mod degenerate;
pub(crate) mod derivatives;
pub(crate) mod evaluate;
pub(crate) mod groups;
pub(crate) mod raw_frames;
pub(crate) mod repair_corners;
pub(crate) mod signs;
pub(crate) mod sorted_sums;
pub(crate) mod subgroups;
pub(crate) mod sums_without;
pub(crate) mod term_chunks;
pub(crate) mod welded_mesh;

use crate::Frame;
use crate::Mesh;
use crate::exec::limits::RunLimits;
use crate::math::cosine_of_degrees;
use crate::topology::edge_sort::TriangleEdge;
use crate::topology::neighbours::{EdgeOrder, neighbours, rematch};
use crate::topology::triangles::{Triangles, Triangulation};
use crate::topology::triangulate::{triangulate, triangulate_welded};
use crate::util::radix_sort::sort;

use crate::tangents::MikkTSpaceOptions;
use crate::tangents::Mode;
use crate::tangents::Report;
use crate::tangents::mikktspace::degenerate::fill_degenerate;
use crate::tangents::mikktspace::derivatives::{
    Derivative, count_mirrored_edges, count_uv_degenerate, derivatives, quad_derivatives,
};
use crate::tangents::mikktspace::evaluate::{EvaluateOptions, GroupInputs, evaluate};
use crate::tangents::mikktspace::groups::{Groups, build_groups};
use crate::tangents::mikktspace::raw_frames::{DEFAULT_FRAME, RawFrames};
use crate::tangents::mikktspace::repair_corners::repair_corners;
use crate::tangents::mikktspace::signs::{mixed_sign_faces, unify_signs};
use crate::tangents::mikktspace::welded_mesh::WeldedMesh;
use crate::tangents::output::{Output, fill};
use crate::tangents::repair::is_usable;
use crate::tangents::report;

/// A mesh that is triangulated, welded and grouped. It can be evaluated again after its vertices moved.
#[derive(Debug)]
pub(crate) struct GroupedMesh {
    pub triangulation: Triangulation,
    pub groups: Groups,
    /// The derivatives and normals of the mesh that was grouped. They decide which members of a group join.
    pub base: GroupInputs,
    uv_degenerate: usize,
    mirrored_edges: usize,
    threshold_cosine: f32,
    mode: Mode,
}

/// The weld of a submesh, whose vertices were welded with the rest of their mesh.
pub(crate) struct SubmeshWeld<'a> {
    /// The welded vertex of each corner, named by the first corner of the submesh that has it.
    pub vertex_of_corner: &'a [u32],
    /// For each corner: true when the submesh has all faces around the corner's vertex. Only these vertices
    /// get groups.
    pub is_complete: &'a [bool],
    /// The runs of the mesh's edge tail. Half-edges of a run match with each other only.
    pub tail_runs: &'a [Vec<TriangleEdge>],
}

impl GroupedMesh {
    /// Triangulates, welds and groups. `None` after cancellation.
    pub fn new(mesh: &Mesh<'_>, options: &MikkTSpaceOptions, limits: RunLimits<'_>) -> Option<Self> {
        let triangulation = triangulate(mesh, limits);
        limits.check().ok()?;
        let neighbours = neighbours(&triangulation.good, edge_order(options), limits);
        limits.check().ok()?;
        let derivatives = quad_derivatives(&triangulation.good, &WeldedMesh::new(mesh), limits);
        limits.check().ok()?;
        let grouped =
            Self::from_stages(mesh, triangulation, (&neighbours, derivatives), |_| true, (options, limits));
        limits.check().ok().map(|()| grouped)
    }

    /// As [`GroupedMesh::new`] for a submesh that is welded already. `None` after cancellation.
    pub fn of_submesh(
        mesh: &Mesh<'_>,
        weld: &SubmeshWeld<'_>,
        options: &MikkTSpaceOptions,
        limits: RunLimits<'_>,
    ) -> Option<Self> {
        let triangulation = triangulate_welded(mesh, weld.vertex_of_corner, limits);
        limits.check().ok()?;
        let good = &triangulation.good;
        let mut neighbours = neighbours(good, EdgeOrder::Complete, limits);
        rematch(good, &half_edges(good, weld.tail_runs), &mut neighbours);
        let derivatives = quad_derivatives(good, &WeldedMesh::new(mesh), limits);
        limits.check().ok()?;
        let is_wanted = |vertex| weld.is_complete[vertex as usize];
        let grouped =
            Self::from_stages(mesh, triangulation, (&neighbours, derivatives), is_wanted, (options, limits));
        limits.check().ok().map(|()| grouped)
    }

    /// Builds the groups. `is_wanted`: vertices for which it returns false get no group. Groups are absent
    /// after cancellation.
    pub fn from_stages(
        mesh: &Mesh<'_>,
        triangulation: Triangulation,
        (neighbours, mut derivatives): (&[[u32; 3]], Vec<Derivative>),
        is_wanted: impl Fn(u32) -> bool,
        (options, limits): (&MikkTSpaceOptions, RunLimits<'_>),
    ) -> Self {
        let welded = WeldedMesh::new(mesh);
        let good = &triangulation.good;
        let uv_degenerate = count_uv_degenerate(good, &welded, &derivatives);
        let mirrored_edges = count_mirrored_edges(neighbours, &derivatives);
        let groups = build_groups(good, neighbours, is_wanted, limits, &mut derivatives);
        let base = GroupInputs::new(good, &groups, derivatives, &welded);
        let threshold_cosine = cosine_of_degrees(options.threshold);
        Self {
            triangulation,
            groups,
            base,
            uv_degenerate,
            mirrored_edges,
            threshold_cosine,
            mode: options.mode,
        }
    }

    /// Computes the frames of the mesh that was grouped.
    pub fn frames(&self, mesh: &Mesh<'_>, limits: RunLimits<'_>) -> (Vec<Frame>, Report) {
        self.frames_from(mesh, default_frames(mesh), limits)
    }

    /// As [`GroupedMesh::frames`]. `initial`: the frames of corners without a group.
    pub fn frames_from(
        &self,
        mesh: &Mesh<'_>,
        initial: Vec<Frame>,
        limits: RunLimits<'_>,
    ) -> (Vec<Frame>, Report) {
        self.finish(mesh, &self.base, &WeldedMesh::new(mesh), initial, limits)
    }

    /// As [`GroupedMesh::frames_from`] for the mesh after its vertices moved. Orientations and groups stay
    /// the base's.
    pub fn frames_of_moved(
        &self,
        mesh: &Mesh<'_>,
        initial: Vec<Frame>,
        limits: RunLimits<'_>,
    ) -> (Vec<Frame>, Report) {
        let welded = WeldedMesh::moved(mesh);
        let good = &self.triangulation.good;
        let mut moved = derivatives(good, &welded, limits);
        if limits.is_cancelled() {
            return (initial, Report::default());
        }
        for (moved, base) in moved.iter_mut().zip(&self.base.derivatives) {
            (moved.preserves, moved.joins_any) = (base.preserves, base.joins_any);
        }
        let values = GroupInputs::new(good, &self.groups, moved, &welded);
        self.finish(mesh, &values, &welded, initial, limits)
    }

    fn finish(
        &self,
        mesh: &Mesh<'_>,
        values: &GroupInputs,
        welded: &WeldedMesh<'_>,
        initial: Vec<Frame>,
        limits: RunLimits<'_>,
    ) -> (Vec<Frame>, Report) {
        let good = &self.triangulation.good;
        let options = EvaluateOptions { threshold_cosine: self.threshold_cosine, limits };
        let mut raw = evaluate(good, &self.groups, &options, (&self.base, values), welded, initial);
        if limits.is_cancelled() {
            return (raw.of_corner, Report::default());
        }
        let copied = fill_degenerate(&self.triangulation, welded, &mut raw);
        let mut report = self.report(mesh);
        let mixed = mixed_sign_faces(mesh, &raw.of_corner);
        report.mixed_sign_faces = mixed.len();
        let mut unusable = Vec::new();
        if self.mode == Mode::Corrected {
            unusable = unify_signs(mesh, &self.triangulation, &values.derivatives, &copied, &mixed, &mut raw);
        }
        unusable.extend(self.unusable_corners(mesh, &raw));
        if limits.is_cancelled() {
            return (raw.of_corner, Report::default());
        }
        sort(&mut unusable);
        unusable.dedup();
        report.repaired_corners = unusable.len();
        if self.mode != Mode::Reference {
            repair_corners(mesh, &self.triangulation, &mut raw, &unusable);
        }
        report.split_vertices = report::count_split_vertices(mesh, &raw.of_corner, limits);
        (raw.of_corner, report)
    }

    /// The corners without a usable tangent, and those of unsupported faces.
    fn unusable_corners(&self, mesh: &Mesh<'_>, raw: &RawFrames) -> Vec<u32> {
        let normal = |corner| mesh.normals().get(mesh.vertex_of_corner(corner));
        let unusable = |&corner: &usize| !is_usable(raw.of_corner[corner].tangent, normal(corner));
        let corners = (0..mesh.corner_count()).filter(unusable).map(|corner| corner as u32);
        corners.chain(self.triangulation.unsupported_corners.iter().copied()).collect()
    }

    /// The counts that do not depend on evaluation.
    fn report(&self, mesh: &Mesh<'_>) -> Report {
        let Triangulation { good, degenerate, unsupported_faces, .. } = &self.triangulation;
        Report {
            triangles: good.len() + degenerate.len(),
            unsupported_faces: *unsupported_faces,
            degenerate_triangles: degenerate.len(),
            uv_degenerate_triangles: self.uv_degenerate,
            non_finite_corners: report::count_non_finite_corners(mesh),
            mirrored_edges: self.mirrored_edges,
            ..Report::default()
        }
    }
}

/// Computes the frames of all corners and writes what `out` holds of them. Returns an empty report after
/// cancellation.
pub(crate) fn run<O: Output>(
    mesh: &Mesh<'_>,
    options: &MikkTSpaceOptions,
    limits: RunLimits<'_>,
    out: &mut [O],
) -> Report {
    let Some(grouped) = GroupedMesh::new(mesh, options, limits) else { return Report::default() };
    let (frames, report) = grouped.frames(mesh, limits);
    fill(out, frames.iter().map(O::from_frame));
    report
}

/// The edge order that the mode asks for.
pub(crate) fn edge_order(options: &MikkTSpaceOptions) -> EdgeOrder {
    if options.mode == Mode::Corrected { EdgeOrder::Complete } else { EdgeOrder::Reference }
}

/// The initial frames of all corners.
pub(crate) fn default_frames(mesh: &Mesh<'_>) -> Vec<Frame> {
    vec![DEFAULT_FRAME; mesh.corner_count()]
}

/// The half-edges `3 t + k` of edges given by the corners of their triangles. `good.corners` ascends.
fn half_edges(good: &Triangles, runs: &[Vec<TriangleEdge>]) -> Vec<Vec<u32>> {
    let number = |(corners, start): &TriangleEdge| {
        3 * good.corners.partition_point(|other| other < corners) as u32 + start
    };
    runs.iter().map(|run| run.iter().map(number).collect()).collect()
}
