//! The derivatives of position by UV on one triangle, and the orientation of its UV map.

use crate::math::{V3, cross, length, not_zero, scale, sub};

/// The edges of a triangle, and the derivatives of position by UV before the division by `area`.
///
/// With E = [e1 e2] and the UV edges as columns of U, the derivatives are the columns of E U^-1 (E. Lengyel,
/// "Foundations of Game Engine Development", vol. 2, 7.5; M. Mikkelsen 2008, equations 18 and 19).
#[derive(Clone, Copy)]
pub(crate) struct ScaledDerivatives {
    /// From corner 0 to 1, from 0 to 2, and from 1 to 2.
    pub edges: [V3; 3],
    /// dP/du times `area`.
    pub s: V3,
    /// dP/dv times `area`.
    pub t: V3,
    /// Twice the signed area in UV space: the determinant of U.
    pub area: f32,
}

impl ScaledDerivatives {
    #[inline(always)]
    pub fn new([a, b, c]: [&V3; 3], uvs: [&[f32; 2]; 3]) -> Self {
        let [e1, e2, e3] = [sub(*b, *a), sub(*c, *a), sub(*c, *b)];
        let [du1, dv1] = [uvs[1][0] - uvs[0][0], uvs[1][1] - uvs[0][1]];
        let [du2, dv2] = [uvs[2][0] - uvs[0][0], uvs[2][1] - uvs[0][1]];
        Self {
            edges: [e1, e2, e3],
            s: sub(scale(dv2, e1), scale(dv1, e2)),
            t: sub(scale(du1, e2), scale(du2, e1)),
            area: du1 * dv2 - dv1 * du2,
        }
    }

    /// True where neither derivative is zero and the triangle is not degenerate. No branches.
    #[inline(always)]
    pub fn has_direction(&self) -> bool {
        let [a, b, c] = self.edges;
        let has_corners = (size(a) > 0.0) & (size(b) > 0.0) & (size(c) > 0.0);
        not_zero(self.area) & (size(self.s) > 0.0) & (size(self.t) > 0.0) & has_corners
    }

    /// The unit directions of dP/du and dP/dv, and their lengths.
    #[inline(always)]
    pub fn directions(&self) -> ([V3; 2], [f32; 2]) {
        let (s_length, t_length) = (length(self.s), length(self.t));
        let (sign, area) = (1f32.copysign(self.area), self.area.abs());
        let directions = [scale(sign / s_length, self.s), scale(sign / t_length, self.t)];
        (directions, [s_length / area, t_length / area])
    }

    /// Twice the triangle's area times its unit normal.
    #[inline(always)]
    pub fn doubled_area_vector(&self) -> V3 {
        let [a, b, _] = self.edges;
        cross(a, b)
    }
}

/// The sum of the absolute coordinates.
#[inline(always)]
pub(crate) fn size([x, y, z]: V3) -> f32 {
    x.abs() + y.abs() + z.abs()
}

/// True for two equal positions.
#[inline(always)]
pub(crate) fn is_degenerate([a, b, c]: [V3; 3]) -> bool {
    a == b || b == c || a == c
}

/// The orientation of a face's UV map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Orientation {
    /// The UV map preserves the orientation.
    Preserves = 0,
    /// The UV map mirrors the face.
    Mirrors = 1,
    /// Undefined: no UV area, no area, values that are not finite, or a face of other than 3 or 4 corners.
    #[default]
    None = 2,
}

impl Orientation {
    /// The orientation of a UV area, which is not zero.
    pub fn of(area: f32) -> Self {
        if area > 0.0 { Self::Preserves } else { Self::Mirrors }
    }
}
