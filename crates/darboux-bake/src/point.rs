//! [`SurfacePoint`]: what a renderer interpolates at a point.

use crate::vector::Vector;

/// A point on a low surface. The interpolated vectors are not normalised, as in a renderer's fragment shader.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    pub position: Vector,
    pub normal: Vector,
    pub tangent: Vector,
    /// The interpolated sign w.
    pub sign: f64,
    /// The interpolated bitangents of the corners.
    pub bitangent: Vector,
    /// The point of the cage, if there is one.
    pub cage: Option<Vector>,
    /// The unit normal of the triangle's plane, counter-clockwise; zero where the triangle has no area.
    pub face_normal: Vector,
    /// How far the ray turns to the normal of the triangle's plane, from 0 to 1.
    pub skew: f64,
}
