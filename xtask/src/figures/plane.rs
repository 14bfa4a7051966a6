//! Points and directions of the drawing plane, and affine maps between planes.

use std::ops::{Add, Mul, Neg, Sub};

/// A point or a direction: x to the right, y as its user counts it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vec2 {
    pub x: f64,
    pub y: f64,
}

pub const fn vec2(x: f64, y: f64) -> Vec2 {
    Vec2 { x, y }
}

/// The unit direction at an angle in degrees, counter-clockwise from x.
pub fn direction(degrees: f64) -> Vec2 {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    vec2(cosine, sine)
}

impl Vec2 {
    pub fn dot(self, other: Self) -> f64 {
        self.x * other.x + self.y * other.y
    }

    /// Twice the signed area of the triangle that both directions span; positive if `other` is counter-clockwise of `self`.
    pub fn cross(self, other: Self) -> f64 {
        self.x * other.y - self.y * other.x
    }

    pub fn length(self) -> f64 {
        self.dot(self).sqrt()
    }

    /// The unit vector of the same direction. `self` must not be zero.
    pub fn unit(self) -> Self {
        self * self.length().recip()
    }

    /// `self`, turned by 90 degrees counter-clockwise.
    pub fn turned(self) -> Self {
        vec2(-self.y, self.x)
    }

    /// The point at `share` of the way from `self` to `end`.
    pub fn towards(self, end: Self, share: f64) -> Self {
        self + (end - self) * share
    }
}

impl Add for Vec2 {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        vec2(self.x + other.x, self.y + other.y)
    }
}

impl Sub for Vec2 {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        vec2(self.x - other.x, self.y - other.y)
    }
}

impl Neg for Vec2 {
    type Output = Self;
    fn neg(self) -> Self {
        vec2(-self.x, -self.y)
    }
}

impl Mul<f64> for Vec2 {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        vec2(self.x * factor, self.y * factor)
    }
}

/// Where a plane with y upwards lies on the figure.
#[derive(Clone, Copy)]
pub struct View {
    /// The pixel of the plane's origin.
    pub origin: Vec2,
    /// Pixels per unit.
    pub scale: f64,
}

impl View {
    pub const fn new(x: f64, y: f64, scale: f64) -> Self {
        Self { origin: vec2(x, y), scale }
    }

    /// The pixel of a point.
    pub fn at(self, point: Vec2) -> Vec2 {
        self.origin + vec2(point.x, -point.y) * self.scale
    }
}

/// dP/du and dP/dv of a triangle: the columns of [e1 e2] times the inverse of [(du1, dv1) (du2, dv2)].
pub fn derivatives(positions: [Vec2; 3], uvs: [Vec2; 3]) -> [Vec2; 2] {
    let [e1, e2] = [positions[1] - positions[0], positions[2] - positions[0]];
    let [d1, d2] = [uvs[1] - uvs[0], uvs[2] - uvs[0]];
    let determinant = d1.cross(d2);
    [(e1 * d2.y - e2 * d1.y) * determinant.recip(), (e2 * d1.x - e1 * d2.x) * determinant.recip()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_map_uv_edges_to_edges() {
        let positions = [vec2(1.0, 2.0), vec2(4.0, 1.0), vec2(2.0, 5.0)];
        let uvs = [vec2(0.1, 0.2), vec2(0.9, 0.4), vec2(0.3, 0.8)];
        let [u, v] = derivatives(positions, uvs);
        for corner in 1..3 {
            let step = uvs[corner] - uvs[0];
            let mapped = u * step.x + v * step.y;
            assert!((mapped - (positions[corner] - positions[0])).length() < 1e-12);
        }
    }
}
