//! [`SkewCorrection`]: turns rays from the smooth direction towards the normal of the triangle.
//!
//! On a flat face of a low surface with smooth normals, the rays lean outwards, so that details of the high
//! surface are displaced and distorted in the map; rays along the face's normal leave them straight. At hard
//! edges such rays leave gaps, so that the correction is best painted.

use crate::vector::{Vector, dot, scale, unit};
use crate::{BakeError, ColorTexture};

/// How far the rays of a low surface turn from the smooth direction (0) to the normal of the triangle (1).
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum SkewCorrection<'a> {
    /// The same everywhere.
    Everywhere(f32),
    /// One amount per triangle.
    PerTriangle(&'a [f32]),
    /// The red of a map over the UVs of the baked image, filtered: black is 0 and white 1. Its image has to
    /// be linear.
    Map(&'a ColorTexture),
}

impl SkewCorrection<'_> {
    /// Errors: an amount per triangle for another number of triangles; one that does not lie from 0 to 1.
    pub(crate) fn check(&self, triangles: usize) -> Result<(), BakeError> {
        let amounts = match self {
            Self::Everywhere(amount) => std::slice::from_ref(amount),
            Self::PerTriangle(amounts) => amounts,
            Self::Map(_) => &[],
        };
        if let Self::PerTriangle(amounts) = self
            && amounts.len() != triangles
        {
            let (what, found) = ("skew corrections", amounts.len());
            return Err(darboux::Error::InputLength { what, expected: triangles, found }.into());
        }
        let is_share = |amount: &f32| (0.0..=1.0).contains(amount);
        match amounts.iter().find(|amount| !is_share(amount)) {
            Some(&found) => {
                Err(BakeError::Option { what: "a skew correction", expected: "from 0 to 1", found })
            }
            None => Ok(()),
        }
    }

    /// The amount at a place of the image. `at`: from 0 to 1 along its width and height.
    pub(crate) fn at(&self, triangle: usize, at: [f64; 2]) -> f64 {
        match self {
            Self::Everywhere(amount) => f64::from(*amount),
            Self::PerTriangle(amounts) => f64::from(amounts[triangle]),
            Self::Map(map) => map.mean(at, [[0.0; 2]; 2]).map_or(0.0, |color| color[0]),
        }
    }
}

/// The unit direction `smooth`, turned towards a triangle's unit normal by an amount. The direction decides
/// the side of the normal.
pub fn turned(smooth: Vector, face_normal: Vector, amount: f64) -> Vector {
    let side = if dot(smooth, face_normal) < 0.0 { -1.0 } else { 1.0 };
    let straight = scale(side, face_normal);
    let mixed = [0, 1, 2].map(|i| (1.0 - amount) * smooth[i] + amount * straight[i]);
    unit(mixed).unwrap_or(smooth)
}
