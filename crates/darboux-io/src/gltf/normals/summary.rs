//! The report of [`add_normals`](super::add_normals): per primitive, in the order of the file.

use serde::Serialize;

use crate::gltf::PrimitiveName;

/// The result of [`add_normals`](super::add_normals).
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct NormalsSummary {
    /// Every primitive of the document, in its order.
    pub primitives: Vec<PrimitiveNormals>,
    /// Warnings, one sentence each.
    pub warnings: Vec<String>,
    /// The number of primitives that got normals.
    pub written: usize,
}

impl NormalsSummary {
    pub(super) fn push(&mut self, name: PrimitiveName, outcome: NormalsOutcome) {
        self.written += usize::from(matches!(outcome, NormalsOutcome::Written(_)));
        self.primitives.push(PrimitiveNormals { name, outcome });
    }
}

/// The result for one primitive.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct PrimitiveNormals {
    /// The primitive.
    #[serde(flatten)]
    pub name: PrimitiveName,
    /// The outcome.
    #[serde(flatten)]
    pub outcome: NormalsOutcome,
}

/// Whether a primitive got normals, and the reason if not.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "outcome", rename_all = "snake_case")]
#[non_exhaustive]
pub enum NormalsOutcome {
    /// The primitive got normals.
    Written(WrittenNormals),
    /// The primitive had normals, which are kept.
    Kept {
        /// The reason, as a sentence.
        reason: String,
    },
    /// The primitive got no normals.
    Skipped {
        /// The reason, as a sentence.
        reason: String,
    },
}

/// The normals of one primitive.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct WrittenNormals {
    /// Whether existing normals were replaced.
    pub replaced: bool,
    /// Whether tangents were removed, since they belonged to other normals.
    pub tangents_removed: bool,
    /// The number of vertices before. Primitives may share them.
    pub vertices_before: usize,
    /// The number of vertices after splitting.
    pub vertices_after: usize,
    /// The number of morph targets that got normal offsets.
    pub morph_targets: usize,
    /// Corners of morphed meshes whose normal differs from that of their shared vertex, summed over targets.
    pub conflicting_corners: usize,
    /// The number of triangles.
    pub triangles: usize,
    /// Triangles of the whole mesh without an area, or with values that are not finite.
    pub degenerate_triangles: usize,
    /// Corners of the whole mesh whose face normals cancel or are missing.
    pub repaired_corners: usize,
    /// Edges of the whole mesh at which smooth shading is interrupted because of their angle.
    pub creased_edges: usize,
}
