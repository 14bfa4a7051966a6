//! The options of tangent generation: a method, and for MikkTSpace a mode and an angular threshold.

use crate::choice;

/// Options of [`generate_tangents`](crate::generate_tangents) and
/// [`generate_frames`](crate::generate_frames). The default, MikkTSpace with its default options, is right
/// for normal maps from today's bakers.
///
/// ```
/// use darboux::{Method, MikkTSpaceOptions, Mode, TangentOptions};
///
/// let standard = TangentOptions::default();
/// let every_bit = TangentOptions::from(MikkTSpaceOptions::new().with_mode(Mode::Reference));
/// let without_bake = TangentOptions::from(Method::AngleArea);
/// # assert!(standard != every_bit && every_bit != without_bake);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct TangentOptions {
    /// The method. Default: MikkTSpace.
    pub method: Method,
}

impl From<Method> for TangentOptions {
    fn from(method: Method) -> Self {
        Self { method }
    }
}

impl From<MikkTSpaceOptions> for TangentOptions {
    fn from(options: MikkTSpaceOptions) -> Self {
        Self { method: Method::MikkTSpace(options) }
    }
}

/// How tangents are computed. A normal map needs the method that it was baked with, nearly always the
/// default.
///
/// All methods but [`Method::MikkTSpace`] leave out triangles whose values are not finite, give every face
/// one sign, and replace tangents without a direction. Derivations are in docs/algorithms/methods.md.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Method {
    /// The standard of bakers and renderers: sums of unit tangents weighted by corner angles, over welded
    /// vertices.
    MikkTSpace(MikkTSpaceOptions),
    /// MikkTSpace's groups with weights of corner angle times area: closest to the UVs where the mesh is cut
    /// unevenly, so the choice where no baked map requires another method.
    AngleArea,
    /// MikkTSpace's groups with weights of corner angle times the lengths of the corner's edges: the default
    /// of meshoptimizer, so that of gltfpack and of Godot from 4.6 on.
    AngleEdge,
    /// The sum of dP/du per vertex and UV orientation, not normalised: triangles with dense UVs weigh more
    /// (Lengyel 2001).
    Lengyel,
    /// As `Lengyel` with one sum per vertex, as three.js and many tutorials have it: mirrored seams break,
    /// and are counted in [`Report::merged_vertices`](crate::Report::merged_vertices). One tangent per
    /// vertex, so that nothing splits; signs can differ within a face.
    LengyelPerVertex,
    /// The mean of the unit tangents per vertex and UV orientation; all triangles weigh the same.
    Average,
    /// The mean of the unit tangents per vertex and UV orientation, weighted by area. Where a normal is
    /// absent (zero) the tangent is perpendicular to the mean of the triangles' normals instead.
    Area,
    /// dP/du of each face, in the plane of the face: exact on each face, not smooth.
    Face,
    /// A perpendicular of the normal, without any UVs (Duff et al. 2017).
    FromNormal,
}

choice! {
    Method, "method",
    Self::MikkTSpace(_) = Self::MikkTSpace(MikkTSpaceOptions::new()) =>
        "mikktspace", "The standard of bakers and engines (Blender, Substance, Marmoset, xNormal, Unity, \
             Unreal, glTF)";
    Self::AngleArea = Self::AngleArea =>
        "angle-area", "Weighted by angle and area: follows the UVs most closely, for surfaces without a \
             baked normal map";
    Self::Lengyel = Self::Lengyel =>
        "lengyel", "The sum of dP/du, not normalised, separate for each UV orientation";
    Self::LengyelPerVertex = Self::LengyelPerVertex =>
        "lengyel-per-vertex", "The sum of dP/du per vertex, as in three.js and many tutorials: wrong at \
             mirrored seams";
    Self::Average = Self::Average =>
        "average", "The mean of the triangles' tangents, for engines that compute it on the GPU";
    Self::Area = Self::Area =>
        "area", "The mean of the triangles' tangents, weighted by area: large faces dominate";
    Self::Face = Self::Face =>
        "face", "One tangent per face, not smoothed: for flat shading and measurements";
    Self::FromNormal = Self::FromNormal =>
        "from-normal", "Any direction perpendicular to the normal, independent of UVs: for sampling, not for \
             normal maps";
    Self::AngleEdge = Self::AngleEdge =>
        "angle-edge", "Weighted by angle and edge lengths: the default of meshoptimizer, gltfpack -gt and \
             Godot from 4.6 on";
}

impl Default for Method {
    fn default() -> Self {
        Self::MikkTSpace(MikkTSpaceOptions::new())
    }
}

impl From<MikkTSpaceOptions> for Method {
    fn from(options: MikkTSpaceOptions) -> Self {
        Self::MikkTSpace(options)
    }
}

/// Options of [`Method::MikkTSpace`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MikkTSpaceOptions {
    /// How faithfully defects of the reference are kept. Default: [`Mode::Repaired`].
    pub mode: Mode,
    /// Angular threshold in degrees: faces around a vertex share a tangent while their tangents and their
    /// bitangents differ by less. Default: 180, which is what bakers use. Any value is accepted; its
    /// cosine is compared.
    ///
    /// Below 180 the faces around a vertex are compared in pairs, unless all are near their mean: a vertex
    /// with 20,000 faces takes about 2 s, one with 100,000 about a minute.
    pub threshold: f32,
}

impl Default for MikkTSpaceOptions {
    fn default() -> Self {
        Self::new()
    }
}

impl MikkTSpaceOptions {
    /// The defaults.
    pub const fn new() -> Self {
        Self { mode: Mode::Repaired, threshold: 180.0 }
    }

    /// These options with another mode.
    #[must_use]
    pub const fn with_mode(self, mode: Mode) -> Self {
        Self { mode, ..self }
    }

    /// These options with another threshold, in degrees.
    #[must_use]
    pub const fn with_threshold(self, degrees: f32) -> Self {
        Self { threshold: degrees, ..self }
    }
}

/// How faithfully defects of the MikkTSpace reference are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Mode {
    /// Every bit of the reference, its defects included: zero-length tangents, tangents along the normal,
    /// NaN.
    Reference,
    /// Every bit of the reference where its result is usable, a unit tangent perpendicular to the normal
    /// elsewhere.
    #[default]
    Repaired,
    /// As `Repaired`, with complete edge matching (the reference's issue 5) and one sign per face.
    Corrected,
}

choice! {
    Mode, "mode",
    Repaired =>
        "repaired", "The bits of the reference where its tangent is usable, a unit tangent elsewhere";
    Reference =>
        "reference", "The bits of the reference, including zero-length and non-finite tangents";
    Corrected =>
        "corrected", "Like repaired, with all edges matched and one sign per triangle";
}
