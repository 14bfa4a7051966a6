//! The report of [`add_tangents`](super::add_tangents): per primitive, in the order of the file, and in
//! total.

use darboux::Report;
use serde::Serialize;

use crate::gltf::PrimitiveName;

/// The result of [`add_tangents`](super::add_tangents).
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct TangentsSummary {
    /// Every primitive of the document, in its order.
    pub primitives: Vec<PrimitiveTangents>,
    /// Warnings, one sentence each.
    pub warnings: Vec<String>,
    /// Sums over all primitives.
    pub totals: TangentsTotals,
}

impl TangentsSummary {
    /// Appends a primitive and counts it.
    pub(super) fn push(&mut self, primitive: PrimitiveTangents) {
        *match primitive.outcome {
            TangentsOutcome::Written(_) => &mut self.totals.written,
            TangentsOutcome::Kept { .. } => &mut self.totals.kept,
            TangentsOutcome::Skipped { .. } => &mut self.totals.skipped,
        } += 1;
        self.primitives.push(primitive);
    }
}

/// The result for one primitive.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct PrimitiveTangents {
    /// The primitive.
    #[serde(flatten)]
    pub name: PrimitiveName,
    /// The outcome.
    #[serde(flatten)]
    pub outcome: TangentsOutcome,
}

/// Whether a primitive got tangents, and the reason if not.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "outcome", rename_all = "snake_case")]
#[non_exhaustive]
pub enum TangentsOutcome {
    /// The primitive got tangents.
    Written(WrittenTangents),
    /// The primitive had tangents, which are kept.
    Kept {
        /// The reason, as a sentence.
        reason: String,
    },
    /// The primitive got no tangents.
    Skipped {
        /// The reason, as a sentence.
        reason: String,
    },
}

/// The tangents of one primitive.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct WrittenTangents {
    /// The UV set n of `TEXCOORD_n`; none if there are no UVs and the method needs none.
    pub uv_set: Option<usize>,
    /// The reason for this set: the texture that uses it, or that no texture does.
    pub uv_reason: String,
    /// Whether existing tangents were replaced.
    pub replaced: bool,
    /// The number of primitives over the same vertices, this one included. They are split together.
    pub sharing_primitives: usize,
    /// The number of vertices before.
    pub vertices_before: usize,
    /// The number of vertices after splitting.
    pub vertices_after: usize,
    /// The number of morph targets that got tangent offsets.
    pub morph_targets: usize,
    /// Corners of morphed meshes to which a computation without the groups of the base would give other
    /// tangents, summed over targets.
    pub regrouped_corners: usize,
    /// Corners of morphed meshes whose tangent differs from that of their shared vertex, summed over
    /// targets.
    pub conflicting_corners: usize,
    /// Counts of triangles and of degenerate data.
    #[serde(flatten)]
    pub counts: ReportCounts,
}

/// The counts of a [`darboux::Report`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct ReportCounts {
    /// The number of triangles.
    pub triangles: usize,
    /// Triangles with two equal positions.
    pub degenerate_triangles: usize,
    /// Triangles, not degenerate, whose UVs span no area.
    pub uv_degenerate_triangles: usize,
    /// Corners with a NaN or an infinity in position, normal or UV.
    pub non_finite_corners: usize,
    /// Corners whose tangent by the reference algorithm is unusable. It was replaced, except with
    /// [`darboux::Mode::Reference`].
    pub repaired_corners: usize,
    /// Triangles whose corners carry both signs.
    pub mixed_sign_triangles: usize,
    /// Edges between two triangles of opposite UV orientation.
    pub mirrored_edges: usize,
    /// Vertices that need more than one tangent.
    pub split_vertices: usize,
    /// Vertices on mirrored seams with one tangent for both sides, which is wrong for one of them
    /// ([`darboux::Method::LengyelPerVertex`]).
    pub merged_vertices: usize,
}

impl From<Report> for ReportCounts {
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

/// Sums over a document. Data that primitives share is counted once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct TangentsTotals {
    /// Primitives that got tangents.
    pub written: usize,
    /// Primitives that kept their tangents.
    pub kept: usize,
    /// Primitives that got no tangents.
    pub skipped: usize,
    /// Skipped primitives that have positions but no normals.
    pub without_normals: usize,
    /// Triangles whose tangents were computed.
    pub triangles: usize,
    /// Vertices, before splitting, in vertex buffers that got tangents.
    pub vertices_before: usize,
    /// Vertices of the same buffers after splitting.
    pub vertices_after: usize,
}
