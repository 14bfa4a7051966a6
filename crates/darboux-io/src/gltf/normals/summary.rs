//! What was done: per primitive, in the order of the file.

use serde::Serialize;

use crate::gltf::PrimitiveName;

/// What [`add_normals`](super::add_normals) did to a document.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct NormalsSummary {
    /// Every primitive of the document, in its order.
    pub primitives: Vec<PrimitiveNormals>,
    /// What a user should look at, one sentence each.
    pub warnings: Vec<String>,
    /// How many primitives got normals.
    pub written: usize,
}

impl NormalsSummary {
    pub(super) fn push(&mut self, name: PrimitiveName, outcome: NormalsOutcome) {
        self.written += usize::from(matches!(outcome, NormalsOutcome::Written(_)));
        self.primitives.push(PrimitiveNormals { name, outcome });
    }
}

/// What happened to one primitive.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct PrimitiveNormals {
    /// Which one.
    #[serde(flatten)]
    pub name: PrimitiveName,
    /// What was done.
    #[serde(flatten)]
    pub outcome: NormalsOutcome,
}

/// What was done to a primitive, and why.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "outcome", rename_all = "snake_case")]
#[non_exhaustive]
pub enum NormalsOutcome {
    /// It has new normals.
    Written(WrittenNormals),
    /// It had normals, which stay.
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

/// The normals of one primitive.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct WrittenNormals {
    /// Whether normals that were there before were replaced.
    pub replaced: bool,
    /// Whether tangents were taken out, which belonged to other normals.
    pub tangents_removed: bool,
    /// The length of its vertex attributes before. Primitives may share them.
    pub vertices_before: usize,
    /// The length of its vertex attributes now.
    pub vertices_after: usize,
    /// Morph targets that got normal offsets.
    pub morph_targets: usize,
    /// Corners of morphed meshes whose normal differs from that of the vertex that they share; summed over targets.
    pub conflicting_corners: usize,
    /// Triangles.
    pub triangles: usize,
    /// Triangles without an area, or with values that are not finite; those of the whole mesh.
    pub degenerate_triangles: usize,
    /// Corners whose faces' normals cancel or are missing; those of the whole mesh.
    pub repaired_corners: usize,
    /// Edges at which smooth shading stops for their angle; those of the whole mesh.
    pub creased_edges: usize,
}
