//! MikkTSpace: Morten S. Mikkelsen, "Simulation of Wrinkled Surfaces Revisited" (2008), as mikktspace.c computes it, bit for bit.
//!
//! Every operation on floats is rounded to `f32` in the reference's order; see docs/algorithms/mikktspace.md for what "exact" means.

pub(crate) mod antipodes;
pub(crate) mod degenerate;
pub(crate) mod derivatives;
pub(crate) mod evaluate;
pub(crate) mod groups;
pub(crate) mod prefix_sums;
pub(crate) mod raw_frames;
pub(crate) mod repair_corners;
pub(crate) mod signs;
pub(crate) mod subgroups;
pub(crate) mod welded_mesh;

use crate::Frame;
use crate::Mesh;
use crate::exec::limits::RunLimits;
use crate::math::cosine_of_degrees;
use crate::topology::edge_sort::TriangleEdge;
use crate::topology::neighbours::{EdgeOrder, match_again, neighbours};
use crate::topology::triangles::{Triangles, Triangulation};
use crate::topology::triangulate::{triangulate, triangulate_welded};
use crate::util::radix_sort::sort;

use crate::tangents::Mode;
use crate::tangents::Report;
use crate::tangents::TangentOptions;
use crate::tangents::mikktspace::degenerate::fill_degenerate;
use crate::tangents::mikktspace::derivatives::{
    Derivative, agreed_derivatives, count_mirrored_edges, count_uv_degenerate, derivatives,
};
use crate::tangents::mikktspace::evaluate::{EvaluateOptions, GroupInputs, evaluate};
use crate::tangents::mikktspace::groups::{Groups, group};
use crate::tangents::mikktspace::raw_frames::{DEFAULT_FRAME, RawFrames};
use crate::tangents::mikktspace::repair_corners::repair;
use crate::tangents::mikktspace::signs::{mixed_faces, unify_signs};
use crate::tangents::mikktspace::welded_mesh::WeldedMesh;
use crate::tangents::repair::is_usable;
use crate::tangents::report;

/// What does not depend on where vertices are, once they are welded and grouped.
#[derive(Debug)]
pub(crate) struct GroupedMesh {
    pub triangulation: Triangulation,
    pub groups: Groups,
    /// The derivatives and normals of the mesh that was grouped.
    pub base: GroupInputs,
    uv_degenerate: usize,
    mirrored_edges: usize,
    threshold_cosine: f32,
    mode: Mode,
}

/// SubmeshWeld of a mesh: some faces, as a mesh of their own, of which some vertices count.
pub(crate) struct SubmeshWeld<'a> {
    /// The welded vertex of each corner, named by its first corner here.
    pub names: &'a [u32],
    /// Of each corner: its vertex counts, and all faces around it are here. Other corners stay as they were.
    pub counts: &'a [bool],
    /// Stretches of edges that are matched with each other only.
    pub tail_runs: &'a [Vec<TriangleEdge>],
}

impl GroupedMesh {
    /// Welds, finds neighbours and groups. `None` after cancellation.
    pub fn new(mesh: &Mesh<'_>, options: &TangentOptions, limits: RunLimits<'_>) -> Option<Self> {
        let triangulation = triangulate(mesh);
        limits.check().ok()?;
        let neighbours = neighbours(&triangulation.good, edge_order(options));
        limits.check().ok()?;
        let derivatives = agreed_derivatives(&triangulation.good, &WeldedMesh::welded(mesh), limits);
        Some(Self::of(mesh, triangulation, (&neighbours, derivatives), |_| true, options))
    }

    /// Of the vertices of `part` that count, where the order of vertices shows nowhere but in the last edges.
    pub fn of_part(
        mesh: &Mesh<'_>,
        part: &SubmeshWeld<'_>,
        options: &TangentOptions,
        limits: RunLimits<'_>,
    ) -> Self {
        let triangulation = triangulate_welded(mesh, part.names);
        let good = &triangulation.good;
        let mut neighbours = neighbours(good, EdgeOrder::Complete);
        match_again(good, &numbered(good, part.tail_runs), &mut neighbours);
        let derivatives = agreed_derivatives(good, &WeldedMesh::welded(mesh), limits);
        let counts = |vertex| part.counts[vertex as usize];
        Self::of(mesh, triangulation, (&neighbours, derivatives), counts, options)
    }

    /// Groups triangles whose neighbours are found, and derivatives, quads agreed. `counts`: of the vertices that have groups.
    pub fn of(
        mesh: &Mesh<'_>,
        triangulation: Triangulation,
        (neighbours, mut derivatives): (&[[u32; 3]], Vec<Derivative>),
        counts: impl Fn(u32) -> bool,
        options: &TangentOptions,
    ) -> Self {
        let shape = WeldedMesh::welded(mesh);
        let good = &triangulation.good;
        let uv_degenerate = count_uv_degenerate(good, &shape, &derivatives);
        let mirrored_edges = count_mirrored_edges(neighbours, &derivatives);
        let groups = group(good, neighbours, counts, &mut derivatives);
        let base = GroupInputs::new(good, &groups, derivatives, &shape);
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

    /// The frames of the mesh that was welded and grouped.
    pub fn frames(&self, mesh: &Mesh<'_>, limits: RunLimits<'_>) -> (Vec<Frame>, Report) {
        self.frames_of_part(mesh, unknown(mesh), limits)
    }

    /// As [`GroupedMesh::frames`], where corners of no group keep what they have in `known`.
    pub fn frames_of_part(
        &self,
        mesh: &Mesh<'_>,
        known: Vec<Frame>,
        limits: RunLimits<'_>,
    ) -> (Vec<Frame>, Report) {
        self.finish(mesh, &self.base, &WeldedMesh::welded(mesh), known, limits)
    }

    /// As [`GroupedMesh::frames_of_part`] for a mesh whose vertices have moved since.
    pub fn frames_of_moved(
        &self,
        mesh: &Mesh<'_>,
        known: Vec<Frame>,
        limits: RunLimits<'_>,
    ) -> (Vec<Frame>, Report) {
        let shape = WeldedMesh::moved(mesh);
        let good = &self.triangulation.good;
        let mut moved = derivatives(good, &shape, limits);
        for (moved, base) in moved.iter_mut().zip(&self.base.derivatives) {
            (moved.preserves, moved.any) = (base.preserves, base.any);
        }
        self.finish(mesh, &GroupInputs::new(good, &self.groups, moved, &shape), &shape, known, limits)
    }

    fn finish(
        &self,
        mesh: &Mesh<'_>,
        values: &GroupInputs,
        shape: &WeldedMesh<'_>,
        known: Vec<Frame>,
        limits: RunLimits<'_>,
    ) -> (Vec<Frame>, Report) {
        let good = &self.triangulation.good;
        let how = EvaluateOptions { threshold_cosine: self.threshold_cosine, limits };
        let mut raw = evaluate(good, &self.groups, &how, (&self.base, values), shape, known);
        if limits.is_cancelled() {
            return (raw.of_corner, Report::default());
        }
        let copied = fill_degenerate(&self.triangulation, shape, &mut raw);
        let mut report = self.report(mesh);
        let mixed = mixed_faces(mesh, &raw.of_corner);
        report.mixed_sign_faces = mixed.len();
        let mut needs = Vec::new();
        if self.mode == Mode::Corrected {
            needs = unify_signs(mesh, &self.triangulation, &values.derivatives, &copied, &mixed, &mut raw);
        }
        needs.extend(self.unusable_corners(mesh, &raw));
        sort(&mut needs);
        needs.dedup();
        report.repaired_corners = needs.len();
        if self.mode != Mode::Reference {
            repair(mesh, &self.triangulation, &mut raw, &needs);
        }
        report.split_vertices = report::count_split_vertices(mesh, &raw.of_corner);
        (raw.of_corner, report)
    }

    /// Corners without a usable tangent, and those of unsupported faces, which have none.
    fn unusable_corners(&self, mesh: &Mesh<'_>, raw: &RawFrames) -> Vec<u32> {
        let normal = |corner| mesh.normals().get(mesh.vertex_of_corner(corner));
        let unusable = |&corner: &usize| !is_usable(raw.of_corner[corner].tangent, normal(corner));
        let corners = (0..mesh.corner_count()).filter(unusable).map(|corner| corner as u32);
        corners.chain(self.triangulation.unsupported_corners.iter().copied()).collect()
    }

    /// What is known before evaluation.
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

/// EvaluateOptions far `options` has edges put in order.
pub(crate) fn edge_order(options: &TangentOptions) -> EdgeOrder {
    if options.mode == Mode::Corrected { EdgeOrder::Complete } else { EdgeOrder::Reference }
}

/// What corners have before anything is known.
pub(crate) fn unknown(mesh: &Mesh<'_>) -> Vec<Frame> {
    vec![DEFAULT_FRAME; mesh.corner_count()]
}

/// Numbers half-edges of triangles that are not degenerate. Their corners ascend.
fn numbered(good: &Triangles, stretches: &[Vec<TriangleEdge>]) -> Vec<Vec<u32>> {
    let number = |(corners, start): &TriangleEdge| {
        3 * good.corners.partition_point(|other| other < corners) as u32 + start
    };
    stretches.iter().map(|stretch| stretch.iter().map(number).collect()).collect()
}
