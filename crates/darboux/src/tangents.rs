//! Options to method: the entry points of tangent generation.

use crate::{CornerFrames, CornerTangents, Mesh};

/// How faithfully defects of the MikkTSpace reference are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Every bit of the reference, its defects included: zero-length tangents, tangents along the normal, NaN.
    Reference,
    /// Every bit of the reference where its result is usable, a unit tangent perpendicular to the normal elsewhere.
    #[default]
    Repaired,
    /// As `Repaired`, with complete edge matching (the reference's issue 5) and one sign per face.
    Corrected,
}

/// What [`generate_tangents`] and [`generate_frames`] do. The default is right for normal maps from today's bakers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TangentOptions {
    /// How faithfully defects of the reference are kept.
    pub mode: Mode,
    /// Angular threshold in degrees: faces around a vertex share a tangent while their tangents and their bitangents differ by less.
    /// Default 180, which is what bakers use. Any value is accepted; its cosine counts.
    pub threshold: f32,
}

impl Default for TangentOptions {
    fn default() -> Self {
        Self { mode: Mode::default(), threshold: 180.0 }
    }
}

/// What a user must know of a run. Quads count as the two triangles that they are split into.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Report {
    /// Triangles, quad halves included.
    pub triangles: usize,
    /// Faces of other than 3 or 4 corners. MikkTSpace gives them no tangents; they get ones from their normals alone.
    pub unsupported_faces: usize,
    /// Triangles with two equal positions.
    pub degenerate_triangles: usize,
    /// Triangles, not degenerate, whose UVs span no area (or too little for a direction).
    pub uv_degenerate_triangles: usize,
    /// Corners with a NaN or an infinity in position, normal or UV.
    pub non_finite_corners: usize,
    /// Corners whose reference tangent is unusable and, but for [`Mode::Reference`], was replaced.
    pub repaired_corners: usize,
    /// Faces whose corners carry both signs.
    pub mixed_sign_faces: usize,
    /// Edges between two triangles of opposite UV orientation.
    pub mirrored_edges: usize,
    /// Vertices of the mesh that need more than one tangent: what [`crate::split_vertices`] will split.
    pub split_vertices: usize,
}

/// Tangents of corners and the report of the run.
#[derive(Clone, Debug, Default)]
pub struct Tangents {
    /// One tangent per corner.
    pub corners: CornerTangents,
    /// What was met on the way.
    pub report: Report,
}

/// Frames of corners and the report of the run.
#[derive(Clone, Debug, Default)]
pub struct Frames {
    /// One frame per corner.
    pub corners: CornerFrames,
    /// What was met on the way.
    pub report: Report,
}

/// Computes the MikkTSpace tangent of every corner.
pub fn generate_tangents(mesh: &Mesh<'_>, options: &TangentOptions) -> Tangents {
    let Frames { corners, report } = generate_frames(mesh, options);
    Tangents { corners: corners.tangents(), report }
}

/// Computes the whole MikkTSpace frame of every corner: tangent, bitangent, magnitudes, sign.
pub fn generate_frames(_mesh: &Mesh<'_>, _options: &TangentOptions) -> Frames {
    todo!("the core lands within the hour")
}
