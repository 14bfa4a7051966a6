//! What was done: per primitive, in the order of the file, and in total.

use darboux::Report;
use serde::Serialize;

use crate::gltf::PrimitiveName;

/// Why a primitive without normals is left alone.
pub(super) const NO_NORMAL: &str = "it has no NORMAL, which tangents need";

/// What [`add_tangents`](super::add_tangents) did to a document.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Summary {
    /// Every primitive of the document, in its order.
    pub primitives: Vec<PrimitiveSummary>,
    /// What a user should look at, one sentence each.
    pub warnings: Vec<String>,
    /// The sums.
    pub totals: Totals,
}

impl Summary {
    /// Appends a primitive and counts it.
    pub(super) fn push(&mut self, primitive: PrimitiveSummary) {
        let lacks_normals = matches!(&primitive.outcome, Outcome::Skipped { reason } if reason == NO_NORMAL);
        self.totals.without_normals += usize::from(lacks_normals);
        *match primitive.outcome {
            Outcome::Written(_) => &mut self.totals.written,
            Outcome::Kept { .. } => &mut self.totals.kept,
            Outcome::Skipped { .. } => &mut self.totals.skipped,
        } += 1;
        self.primitives.push(primitive);
    }
}

/// What happened to one primitive.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct PrimitiveSummary {
    /// Which one.
    #[serde(flatten)]
    pub name: PrimitiveName,
    /// What was done.
    #[serde(flatten)]
    pub outcome: Outcome,
}

/// What was done to a primitive, and why.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "outcome", rename_all = "snake_case")]
#[non_exhaustive]
pub enum Outcome {
    /// It has tangents now.
    Written(Written),
    /// It had tangents, which stay.
    Kept {
        /// Why, as a sentence.
        reason: String,
    },
    /// It was left alone.
    Skipped {
        /// Why, as a sentence.
        reason: String,
    },
}

/// The tangents of one primitive.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Written {
    /// The UV set: n of `TEXCOORD_n`; none where there are no UVs and the method needs none.
    pub uv_set: Option<usize>,
    /// Why this one: the texture that names it, or that none does.
    pub uv_reason: String,
    /// Whether tangents that were there before were replaced.
    pub replaced: bool,
    /// The length of its vertex attributes before. Primitives may share them.
    pub vertices_before: usize,
    /// The length of its vertex attributes now.
    pub vertices_after: usize,
    /// Morph targets that got tangent offsets.
    pub morph_targets: usize,
    /// Corners of morphed meshes that a fresh run would give other tangents than the base's groups do; summed over targets.
    pub regrouped_corners: usize,
    /// Corners of morphed meshes whose tangent differs from that of the vertex which they share; summed over targets.
    pub conflicting_corners: usize,
    /// What was met on the way.
    #[serde(flatten)]
    pub counts: Counts,
}

/// The counts of a [`darboux::Report`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Counts {
    /// Triangles.
    pub triangles: usize,
    /// Triangles with two equal positions.
    pub degenerate_triangles: usize,
    /// Triangles, not degenerate, whose UVs span no area.
    pub uv_degenerate_triangles: usize,
    /// Corners with a NaN or an infinity in position, normal or UV.
    pub non_finite_corners: usize,
    /// Corners whose reference tangent is unusable and, but for [`darboux::Mode::Reference`], was replaced.
    pub repaired_corners: usize,
    /// Triangles whose corners carry both signs.
    pub mixed_sign_triangles: usize,
    /// Edges between two triangles of opposite UV orientation.
    pub mirrored_edges: usize,
    /// Vertices that need more than one tangent.
    pub split_vertices: usize,
    /// Vertices on mirrored seams that have one tangent for both sides: [`darboux::Method::LengyelPerVertex`] breaks them.
    pub merged_vertices: usize,
}

impl From<Report> for Counts {
    fn from(report: Report) -> Self {
        Self {
            triangles: report.triangles,
            degenerate_triangles: report.degenerate_triangles,
            uv_degenerate_triangles: report.uv_degenerate_triangles,
            non_finite_corners: report.non_finite_corners,
            repaired_corners: report.repaired_corners,
            mixed_sign_triangles: report.mixed_sign_faces,
            mirrored_edges: report.mirrored_edges,
            split_vertices: report.split_vertices,
            merged_vertices: report.merged_vertices,
        }
    }
}

/// Sums over a document. What primitives share is counted once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Totals {
    /// Primitives that have tangents now.
    pub written: usize,
    /// Primitives that keep tangents they had.
    pub kept: usize,
    /// Primitives left alone.
    pub skipped: usize,
    /// Of these, primitives that have positions but no normals.
    pub without_normals: usize,
    /// Triangles computed.
    pub triangles: usize,
    /// Vertices before, of the vertex buffers that got tangents.
    pub vertices_before: usize,
    /// Vertices now, of the same.
    pub vertices_after: usize,
}
