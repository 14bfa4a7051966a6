//! Tangents of nalgebra's points and vectors, without a copy: bytemuck views them as floats.

use bytemuck::cast_slice;
use darboux::{Error, Mesh, TangentOptions, generate_tangents};
use nalgebra::{Point2, Point3, Unit, Vector3, Vector4};

pub(crate) fn main() -> Result<(), Error> {
    let positions = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Point3::new(x, y, x * y));
    let normals = positions.map(|point| *Unit::new_normalize(Vector3::new(-point.y, -point.x, 1.0)));
    let uvs = positions.map(|point| Point2::new(point.x, point.y));
    let indices = [0u32, 1, 2, 0, 2, 3];

    let mesh = Mesh::triangles(
        cast_slice::<_, [f32; 3]>(&positions),
        cast_slice::<_, [f32; 3]>(&normals),
        cast_slice::<_, [f32; 2]>(&uvs),
        &indices,
    )?;
    let corners = generate_tangents(&mesh, &TangentOptions::default()).corners;
    let tangents: Vec<Vector4<f32>> = corners.per_corner().iter().map(|&tangent| tangent.into()).collect();
    for (tangent, &index) in tangents.iter().zip(&indices) {
        let normal = normals[index as usize];
        // The whole frame, of which nalgebra makes a matrix from tangent space to the mesh's.
        let bitangent = normal.cross(&tangent.xyz()) * tangent.w;
        let frame = nalgebra::Matrix3::from_columns(&[tangent.xyz(), bitangent, normal]);
        assert!((frame.transpose() * frame - nalgebra::Matrix3::identity()).norm() < 1e-6);
    }
    println!("{} corners", tangents.len());
    Ok(())
}
