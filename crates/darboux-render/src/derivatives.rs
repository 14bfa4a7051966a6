//! What shaders do that have no tangents: they take the derivatives of position and UVs by the place on the screen, which are those along
//! the triangle's edges in another basis.
//!
//! Source: C. Schueler, "Normal Mapping without Precomputed Tangents", 2013: the gradient of u in the plane of the interpolated normal.

use crate::algebra::cross;

type V3 = [f32; 3];

/// The tangents of a triangle's corners, with glTF's signs; (0, 0, 0, 1) where the UVs have no extent.
pub fn tangents(positions: [V3; 3], normals: [V3; 3], uvs: [[f32; 2]; 3]) -> [[f32; 4]; 3] {
    let [p1, p2] = [1, 2].map(|i| [0, 1, 2].map(|k| positions[i][k] - positions[0][k]));
    let [uv1, uv2] = [1, 2].map(|i| [0, 1].map(|k| uvs[i][k] - uvs[0][k]));
    normals.map(|normal| {
        let (a, b) = (cross(p2, normal), cross(normal, p1));
        let [along_u, along_v] = [0, 1].map(|i| [0, 1, 2].map(|k| a[k] * uv1[i] + b[k] * uv2[i]));
        // Normals against the face's winding turn both gradients over.
        let side = if dot(cross(p1, p2), normal) < 0.0 { -1.0 } else { 1.0 };
        let size = dot(along_u, along_u).sqrt();
        let [x, y, z] =
            if size > 0.0 && size.is_finite() { along_u.map(|part| side * part / size) } else { [0.0; 3] };
        // v goes down the image, bitangents up.
        let is_against_v = side * dot(cross(normal, [x, y, z]), along_v) <= 0.0;
        [x, y, z, if is_against_v { 1.0 } else { -1.0 }]
    })
}

fn dot(a: V3, b: V3) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
