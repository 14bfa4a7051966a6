//! Frames under transforms: node matrices, mirrored and unevenly scaled ones included, and skins.
//!
//! A tangent is a direction on the surface and goes with the surface: by the matrix M. A normal is what is perpendicular to the
//! surface: it goes by the inverse transpose of M, so that it stays perpendicular and stays on its side. That is M's cofactors
//! divided by its determinant, of which only the sign matters, since a normal is made unit. cross(normal, tangent) is negated by a
//! mirror while the surface's own bitangent goes with the surface, so there w changes its sign.

use crate::math::{V3, cross, dot, length, scale, unit_in_plane};

/// The linear part of a transform, made ready for frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    columns: [V3; 3],
    cofactors: [V3; 3],
    orientation: f32,
}

impl Transform {
    /// `columns`: where the transform takes the x, y and z directions; the first three numbers of the first three columns of a 4x4
    /// matrix. Any scale; translation does not matter to frames.
    pub fn new(columns: [[f32; 3]; 3]) -> Self {
        let columns = rescaled(columns);
        let [x, y, z] = columns;
        let cofactors = [cross(y, z), cross(z, x), cross(x, y)];
        let orientation = if dot(x, cofactors[0]) < 0.0 { -1.0 } else { 1.0 };
        Self { columns, cofactors, orientation }
    }

    /// The transform of a vertex that several bones move (linear blend skinning): the mean of their matrices.
    ///
    /// `bones`: the columns of each bone's matrix, as in [`Transform::new`], and its weight. That weights vary over the surface is
    /// left out, as everywhere: normals of strongly bent skins are approximate (B. Merry et al., "Normal Transformations for
    /// Articulated Models", SIGGRAPH Sketches 2006).
    pub fn blended(bones: impl IntoIterator<Item = ([[f32; 3]; 3], f32)>) -> Self {
        let mut sum = [[0.0; 3]; 3];
        for (columns, weight) in bones {
            for (total, component) in sum.iter_mut().flatten().zip(columns.into_iter().flatten()) {
                *total += weight * component;
            }
        }
        Self::new(sum)
    }

    /// -1 where the transform mirrors, which turns the winding of faces as well; else +1.
    pub fn orientation(&self) -> f32 {
        self.orientation
    }

    /// The unit normal of the transformed surface, on the same side of it. One that the transform leaves no direction stays as it is.
    pub fn normal(&self, normal: [f32; 3]) -> [f32; 3] {
        let turned = scale(self.orientation, product(self.cofactors, normal));
        let size = length(turned);
        if size > 0.0 && size.is_finite() { scale(1.0 / size, turned) } else { normal }
    }

    /// The unit normal and the unit tangent, perpendicular to it, of the transformed surface.
    ///
    /// `tangent`: unit xyz and the sign w. What leaves the plane of the new normal is taken away: nothing, where tangent and normal
    /// were perpendicular. A tangent that keeps no direction becomes a perpendicular of the normal.
    pub fn frame(&self, normal: [f32; 3], [x, y, z, w]: [f32; 4]) -> ([f32; 3], [f32; 4]) {
        let normal = self.normal(normal);
        let [x, y, z] = unit_in_plane(normal, product(self.columns, [x, y, z]));
        (normal, [x, y, z, self.orientation * w])
    }
}

/// The columns with 1 as their largest component, so that their products neither overflow nor vanish.
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
