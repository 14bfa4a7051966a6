//! Rays and hits.

use super::compare::greater;

/// A segment of a ray: from `origin` to `origin + length * direction`.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    pub origin: [f32; 3],
    /// Unit length.
    pub direction: [f32; 3],
    pub length: f32,
}

/// The sides of triangles that a ray can hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    Front,
    Both,
}

/// A hit of a ray on a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The distance from the origin of the ray.
    pub distance: f32,
    pub triangle: u32,
    /// The weights of the triangle's corners at the hit; their sum is 1.
    pub weights: [f32; 3],
    /// Whether the ray came from the side from which the corners are counter-clockwise.
    pub is_front: bool,
}

/// A ray, prepared for the tests of boxes and triangles.
#[derive(Clone, Copy, Debug)]
pub struct PreparedRay {
    pub origin: [f32; 3],
    pub length: f32,
    /// The origin as the near and the far sides of boxes see it: moved by the margin, away from them.
    pub origins: [[f32; 3]; 2],
    /// 1 / direction, per axis.
    pub inverse: [f32; 3],
    /// Whether the direction is negative, per axis.
    pub is_negative: [bool; 3],
    /// The axes in the order of the sheared space, whose last axis is the largest component of the direction
    /// (Woop et al., section 3).
    pub axes: [usize; 3],
    /// The shear along the first two axes, and the scale along the last.
    pub shear: [f32; 3],
}

/// The share of the largest distance of a corner by which boxes are widened. The sheared corners of
/// [`Leaf`](super::leaf::Leaf) have rounding errors of at most 4 * 2^-24 of it, so that no box is missed
/// whose triangle is hit (Woop et al., section 4).
const MARGIN: f32 = 5e-7;

impl PreparedRay {
    /// Whether the ray has places and a direction.
    #[inline(always)]
    pub fn is_finite(&self) -> bool {
        let is_finite = |v: &[f32; 3]| v.iter().all(|x| x.is_finite());
        self.origins.iter().all(is_finite) && is_finite(&self.shear)
    }

    /// `bounds`: the box of all triangles.
    pub fn new(ray: &Ray, bounds: &[[f32; 3]; 2]) -> Self {
        let direction = ray.direction;
        let size = direction.map(f32::abs);
        let last = if size[0] > size[1] && size[0] > size[2] {
            0
        } else if size[1] > size[2] {
            1
        } else {
            2
        };
        let (mut first, mut second) = ((last + 1) % 3, (last + 2) % 3);
        // Keeps the winding of triangles.
        if direction[last] < 0.0 {
            std::mem::swap(&mut first, &mut second);
        }
        let scale = 1.0 / direction[last];
        let farthest = |i: usize| {
            bounds.iter().map(|end| (end[i] - ray.origin[i]).abs()).fold(0.0, |most, x| greater(x, most))
        };
        let margin = MARGIN * greater(greater(farthest(0), farthest(1)), farthest(2));
        let moved =
            |i: usize, by: f32| ray.origin[i] + if direction[i].is_sign_negative() { -by } else { by };
        Self {
            origin: ray.origin,
            length: ray.length,
            origins: [[0, 1, 2].map(|i| moved(i, margin)), [0, 1, 2].map(|i| moved(i, -margin))],
            inverse: direction.map(|x| 1.0 / x),
            is_negative: direction.map(|x| x.is_sign_negative()),
            axes: [first, second, last],
            shear: [direction[first] * scale, direction[second] * scale, scale],
        }
    }
}
