//! Frames and tangents of corners.

use crate::Convention;

/// Tangents of corners, one per corner: unit xyz and the sign w, bitangent = w * cross(normal, xyz).
///
/// These are not vertex tangents. Corners of one vertex may disagree (at mirrored seams they do), so there is
/// no way to use them with the old index list: [`crate::split_vertices`] gives vertices and new indices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CornerTangents(pub(crate) Vec<[f32; 4]>);

impl CornerTangents {
    /// Tangents of another program, or of a file without indices, one per corner, in corner order.
    pub fn from_per_corner(tangents: Vec<[f32; 4]>) -> Self {
        Self(tangents)
    }

    /// The number of corners.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// True when there are no corners.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// One tangent per corner, in corner order: for unindexed vertex buffers and for comparing. Not in vertex
    /// order.
    pub fn per_corner(&self) -> &[[f32; 4]] {
        &self.0
    }

    /// As [`CornerTangents::per_corner`], giving up the allocation.
    pub fn into_per_corner(self) -> Vec<[f32; 4]> {
        self.0
    }

    /// Each tangent after `change`: rounding to what an encoding holds comes before vertices are split.
    pub fn map(mut self, mut change: impl FnMut([f32; 4]) -> [f32; 4]) -> Self {
        for tangent in &mut self.0 {
            *tangent = change(*tangent);
        }
        self
    }

    /// The same frames written in another convention. Fresh tangents are in [`Convention::generated`].
    pub fn converted(self, from: Convention, to: Convention) -> Self {
        let conversion = from.to(to);
        self.map(|tangent| conversion.tangent(tangent))
    }
}

/// Borrowed tangents of corners: [`CornerTangents`], or an array of another program.
#[derive(Clone, Copy, Debug)]
pub struct CornerTangentsRef<'a>(pub(crate) &'a [[f32; 4]]);

impl<'a> CornerTangentsRef<'a> {
    /// One tangent per corner, in corner order: unit xyz and sign w.
    pub fn from_per_corner(tangents: &'a [[f32; 4]]) -> Self {
        Self(tangents)
    }
}

impl<'a> From<&'a CornerTangents> for CornerTangentsRef<'a> {
    fn from(tangents: &'a CornerTangents) -> Self {
        Self(&tangents.0)
    }
}

/// Normals of corners, one unit normal per corner.
///
/// These are not vertex normals. Corners of one vertex may disagree (at creases they do), so they have a type
/// of their own: [`crate::split_normals`] gives vertices and new indices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CornerNormals(pub(crate) Vec<[f32; 3]>);

impl CornerNormals {
    /// Normals of another program, one per corner, in corner order.
    pub fn from_per_corner(normals: Vec<[f32; 3]>) -> Self {
        Self(normals)
    }

    /// The number of corners.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// True when there are no corners.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// One normal per corner, in corner order. Not in vertex order.
    pub fn per_corner(&self) -> &[[f32; 3]] {
        &self.0
    }

    /// As [`CornerNormals::per_corner`], giving up the allocation.
    pub fn into_per_corner(self) -> Vec<[f32; 3]> {
        self.0
    }
}

/// Borrowed normals of corners: [`CornerNormals`], or an array of another program.
#[derive(Clone, Copy, Debug)]
pub struct CornerNormalsRef<'a>(pub(crate) &'a [[f32; 3]]);

impl<'a> CornerNormalsRef<'a> {
    /// One normal per corner, in corner order.
    pub fn from_per_corner(normals: &'a [[f32; 3]]) -> Self {
        Self(normals)
    }
}

impl<'a> From<&'a CornerNormals> for CornerNormalsRef<'a> {
    fn from(normals: &'a CornerNormals) -> Self {
        Self(&normals.0)
    }
}

/// The frame of one corner. The default is all zeros, for output arrays.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Frame {
    /// The direction of increasing u, unit length; perpendicular to the normal but for
    /// [`Method::Face`](crate::Method::Face), whose frame is the triangle's.
    pub tangent: [f32; 3],
    /// The direction of increasing v, unit length; as the tangent to the normal, but not always
    /// perpendicular to the tangent.
    pub bitangent: [f32; 3],
    /// World units per unit of u and per unit of v.
    pub magnitude: [f32; 2],
    /// +1 where the UV map keeps its orientation, -1 where it mirrors.
    pub sign: f32,
}

/// Frames of corners, one per corner, in corner order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CornerFrames(pub(crate) Vec<Frame>);

impl CornerFrames {
    /// Frames of another program, one per corner, in corner order.
    pub fn from_per_corner(frames: Vec<Frame>) -> Self {
        Self(frames)
    }

    /// The number of corners.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// True when there are no corners.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// One frame per corner, in corner order. Not in vertex order.
    pub fn per_corner(&self) -> &[Frame] {
        &self.0
    }

    /// As [`CornerFrames::per_corner`], giving up the allocation.
    pub fn into_per_corner(self) -> Vec<Frame> {
        self.0
    }

    /// The tangents and signs alone.
    pub fn tangents(&self) -> CornerTangents {
        CornerTangents(self.0.iter().map(Frame::tangent_and_sign).collect())
    }
}

impl Frame {
    /// Tangent xyz and sign w.
    pub fn tangent_and_sign(&self) -> [f32; 4] {
        let [x, y, z] = self.tangent;
        [x, y, z, self.sign]
    }
}
