//! Transforms of frames by node matrices, also mirrored and non-uniform ones, and by skins.
//!
//! A tangent lies on the surface, so it transforms by the matrix M. A normal is perpendicular to the surface,
//! so it transforms by the inverse transpose of M, which is the cofactor matrix divided by the determinant.
//! Normals are normalised, so only the sign of the determinant matters. A mirroring M negates cross(normal,
//! tangent) but not the bitangent of the surface, so w changes its sign.

use crate::math::{V3, cross, dot, length, scale, unit_in_plane};

/// The linear part of a transform, with its cofactors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    columns: [V3; 3],
    cofactors: [V3; 3],
    orientation: f32,
}

impl Transform {
    /// `columns`: the images of the x, y and z directions, which are the first three numbers of the first
    /// three columns of a 4x4 matrix. Any scale. Translation does not affect frames.
    pub fn new(columns: [[f32; 3]; 3]) -> Self {
        let columns = rescaled(columns);
        let [x, y, z] = columns;
        let cofactors = [cross(y, z), cross(z, x), cross(x, y)];
        let orientation = if dot(x, cofactors[0]) < 0.0 { -1.0 } else { 1.0 };
        Self { columns, cofactors, orientation }
    }

    /// The transform of a vertex under linear blend skinning: the weighted sum of the bones' matrices.
    ///
    /// `bones`: the columns of each bone's matrix, as in [`Transform::new`], and its weight. The variation of
    /// weights over the surface is ignored, as is usual, so normals of strongly bent skins are
    /// approximate (B. Merry et al., "Normal Transformations for Articulated Models", SIGGRAPH Sketches
    /// 2006).
    pub fn blended(bones: impl IntoIterator<Item = ([[f32; 3]; 3], f32)>) -> Self {
        let mut sum = [[0.0; 3]; 3];
        for (columns, weight) in bones {
            for (total, component) in sum.iter_mut().flatten().zip(columns.into_iter().flatten()) {
                *total += weight * component;
            }
        }
        Self::new(sum)
    }

    /// -1 if the transform mirrors, which also reverses the winding of faces; else +1.
    pub fn orientation(&self) -> f32 {
        self.orientation
    }

    /// Transforms a normal. The result is normalised. A normal that the transform maps to zero is returned
    /// unchanged.
    pub fn normal(&self, normal: [f32; 3]) -> [f32; 3] {
        let turned = scale(self.orientation, product(self.cofactors, normal));
        let size = length(turned);
        if size > 0.0 && size.is_finite() { scale(1.0 / size, turned) } else { normal }
    }

    /// Transforms a normal and a tangent. Returns the unit normal, and the unit tangent perpendicular to it
    /// with its sign.
    ///
    /// `tangent`: unit xyz and sign w. The component of the tangent along the new normal is removed; it is
    /// zero if tangent and normal were perpendicular. A tangent that becomes zero is replaced by a
    /// perpendicular of the normal.
    pub fn frame(&self, normal: [f32; 3], [x, y, z, w]: [f32; 4]) -> ([f32; 3], [f32; 4]) {
        let normal = self.normal(normal);
        let [x, y, z] = unit_in_plane(normal, product(self.columns, [x, y, z]));
        (normal, [x, y, z, self.orientation * w])
    }
}

/// Scales the columns to a largest component of 1, so that products neither overflow nor underflow.
fn rescaled(columns: [V3; 3]) -> [V3; 3] {
    let largest = columns.iter().flatten().fold(0f32, |largest, component| largest.max(component.abs()));
    if largest > 0.0 && largest.is_finite() {
        columns.map(|column| column.map(|component| component / largest))
    } else {
        columns
    }
}

fn product([x, y, z]: [V3; 3], v: V3) -> V3 {
    [0, 1, 2].map(|i| x[i] * v[0] + y[i] * v[1] + z[i] * v[2])
}
