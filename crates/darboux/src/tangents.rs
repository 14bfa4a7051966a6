//! Options to method: the entry points of tangent generation.

mod area;
mod average;
mod degenerate;
mod derivatives;
mod evaluate;
mod face;
mod flat;
mod from_normal;
mod groups;
mod lengyel;
mod method;
pub(crate) mod mikktspace;
pub mod naive;
mod repair;
mod report;
mod seams;
mod shape;
mod sides;
mod signs;
mod subgroups;
mod sums;

use crate::{CornerFrames, CornerTangents, Mesh};

pub use method::Method;
pub use report::Report;

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
    /// The method; MikkTSpace unless told otherwise.
    pub method: Method,
    /// How faithfully defects of the reference are kept.
    pub mode: Mode,
    /// Angular threshold in degrees: faces around a vertex share a tangent while their tangents and their bitangents differ by less.
    /// Default 180, which is what bakers use. [`Method::MikkTSpace`] alone has it. Any value is accepted; its cosine counts.
    pub threshold: f32,
}

impl Default for TangentOptions {
    fn default() -> Self {
        Self { method: Method::default(), mode: Mode::default(), threshold: 180.0 }
    }
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

/// Computes the tangent of every corner.
pub fn generate_tangents(mesh: &Mesh<'_>, options: &TangentOptions) -> Tangents {
    let (corners, report) = method::run(mesh, options);
    Tangents { corners: CornerTangents(corners), report }
}

/// Computes the whole frame of every corner: tangent, bitangent, magnitudes, sign.
pub fn generate_frames(mesh: &Mesh<'_>, options: &TangentOptions) -> Frames {
    let (corners, report) = method::run(mesh, options);
    Frames { corners: CornerFrames(corners), report }
}
