//! What a caller chooses: the method, the mode, the angular threshold.

/// How tangents are computed. Normal maps need the method that they were baked with, nearly always the default.
///
/// All but [`Method::MikkTSpace`] leave out triangles whose values are not finite, give every face one sign, and take
/// [`Mode::Corrected`](crate::Mode) for [`Mode::Repaired`](crate::Mode). Derivations are in docs/algorithms/methods.md.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Method {
    /// The standard of bakers and renderers: sums of unit tangents weighted by corner angles, over welded vertices.
    #[default]
    MikkTSpace,
    /// MikkTSpace's groups with weights of corner angle times area: nearest to the UVs where the mesh was cut unevenly, so the choice
    /// where no baked map asks for another.
    AngleArea,
    /// Per vertex the sum of dP/du, as long as they are: large where UVs are dense. One sum per UV orientation (Lengyel 2001).
    Lengyel,
    /// As `Lengyel` with one sum per vertex, as three.js and many tutorials have it: mirrored seams break, and are counted in
    /// [`Report::merged_vertices`]. One tangent per vertex, so nothing splits; signs can differ within a face.
    LengyelPerVertex,
    /// Per vertex and UV orientation the mean of the unit tangents, every triangle counting the same.
    Average,
    /// Per vertex and UV orientation the mean of the unit tangents, weighted by area. Where a normal is absent (zero) the tangent is
    /// perpendicular to the mean of the triangles' normals instead.
    Area,
    /// Per face dP/du itself, in the plane of the face: exact on each, not smooth.
    Face,
    /// A perpendicular of the normal, without any UVs (Duff et al. 2017).
    FromNormal,
}

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
