//! Tangents as shaders without stored tangents derive them: from the screen-space derivatives of positions
//! and UVs, which span the same plane as the edges of the triangle.
//!
//! Source: C. Schueler, "Normal Mapping without Precomputed Tangents", 2013. The tangent is the gradient of u
//! in the plane of the interpolated normal.

use crate::algebra::{V3, cross, dot};

/// The tangents of a triangle's corners, with the signs of glTF; (0, 0, 0, 1) if the UVs are degenerate.
pub fn tangents(positions: [V3; 3], normals: [V3; 3], uvs: [[f32; 2]; 3]) -> [[f32; 4]; 3] {
    let [p1, p2] = [1, 2].map(|i| [0, 1, 2].map(|k| positions[i][k] - positions[0][k]));
    let [uv1, uv2] = [1, 2].map(|i| [0, 1].map(|k| uvs[i][k] - uvs[0][k]));
    normals.map(|normal| {
        let (a, b) = (cross(p2, normal), cross(normal, p1));
        let [along_u, along_v] = [0, 1].map(|i| [0, 1, 2].map(|k| a[k] * uv1[i] + b[k] * uv2[i]));
        // Normals that oppose the winding reverse both gradients.
        let side = if dot(cross(p1, p2), normal) < 0.0 { -1.0 } else { 1.0 };
        let size = dot(along_u, along_u).sqrt();
        let [x, y, z] =
            if size > 0.0 && size.is_finite() { along_u.map(|x| side * x / size) } else { [0.0; 3] };
        // In glTF v points down in the image, and bitangents point up.
        let is_against_v = side * dot(cross(normal, [x, y, z]), along_v) <= 0.0;
        [x, y, z, if is_against_v { 1.0 } else { -1.0 }]
    })
}
