//! Tangents of mint's vectors, which many libraries convert to and from. A mint vector is an array of floats
//! by `into`, so that this copies.

use darboux::{Error, Mesh, TangentOptions, generate_tangents};

pub(crate) fn main() -> Result<(), Error> {
    let positions: [mint::Point3<f32>; 3] =
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(mint::Point3::from);
    let normals = [mint::Vector3 { x: 0.0, y: 0.0, z: 1.0 }; 3];
    let uvs = positions.map(|point| mint::Vector2 { x: point.x, y: point.y });

    let (positions, normals) = (positions.map(<[f32; 3]>::from), normals.map(<[f32; 3]>::from));
    let uvs = uvs.map(<[f32; 2]>::from);
    let mesh = Mesh::triangles(&positions, &normals, &uvs, &[0u32, 1, 2])?;
    let corners = generate_tangents(&mesh, &TangentOptions::default()).corners;
    let tangents: Vec<mint::Vector4<f32>> =
        corners.per_corner().iter().map(|&tangent| tangent.into()).collect();
    assert_eq!(tangents[0], mint::Vector4 { x: 1.0, y: 0.0, z: 0.0, w: 1.0 });
    println!("{} corners", tangents.len());
    Ok(())
}
