//! Tangents of vertices that hold glam's vectors, without a copy: bytemuck views the structs as floats.

use bytemuck::{Pod, Zeroable, cast_slice, cast_slice_mut};
use darboux::{Context, Error, Mesh, Strided, TangentOptions};
use darboux::{generate_tangents, split_vertices, write_tangents};
use glam::{Vec2, Vec3, Vec4};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct Vertex {
    position: Vec3,
    normal: Vec3,
    uv: Vec2,
    tangent: Vec4,
}

/// The floats of a vertex, and the first of each attribute.
const STRIDE: usize = size_of::<Vertex>() / size_of::<f32>();
const POSITION: usize = std::mem::offset_of!(Vertex, position) / size_of::<f32>();
const NORMAL: usize = std::mem::offset_of!(Vertex, normal) / size_of::<f32>();
const UV: usize = std::mem::offset_of!(Vertex, uv) / size_of::<f32>();

pub(crate) fn main() -> Result<(), Error> {
    // Four triangles whose texture is mirrored at x = 0.
    let vertex = |x: f32, y: f32| Vertex {
        position: Vec3::new(x, y, 0.0),
        normal: Vec3::Z,
        uv: Vec2::new(x.abs(), y),
        tangent: Vec4::ZERO,
    };
    let mut vertices: Vec<Vertex> =
        [(-1.0, 0.0), (0.0, 0.0), (1.0, 0.0), (-1.0, 1.0), (0.0, 1.0), (1.0, 1.0)]
            .map(|(x, y)| vertex(x, y))
            .into();
    let indices = [0u32, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4];

    let floats: &[f32] = cast_slice(&vertices);
    let mesh = Mesh::triangles(
        Strided::<3>::from_floats(floats, STRIDE, POSITION)?,
        Strided::<3>::from_floats(floats, STRIDE, NORMAL)?,
        Strided::<2>::from_floats(floats, STRIDE, UV)?,
        &indices,
    )?;
    let corners = generate_tangents(&mesh, &TangentOptions::default()).corners;
    let split = split_vertices(&mesh, &corners)?;
    vertices = split.source_of_vertex.iter().map(|&source| vertices[source as usize]).collect();
    for (vertex, &tangent) in vertices.iter_mut().zip(&split.tangent_of_vertex) {
        vertex.tangent = tangent.into();
    }
    assert_eq!((vertices.len(), vertices[2].tangent), (8, Vec4::new(1.0, 0.0, 0.0, 1.0)));
    assert_eq!(vertices[0].tangent, Vec4::new(-1.0, 0.0, 0.0, -1.0));

    // Separate arrays of vectors are arrays of floats, too.
    let positions: Vec<Vec3> = vertices.iter().map(|vertex| vertex.position).collect();
    let normals = vec![Vec3::Z; positions.len()];
    let uvs: Vec<Vec2> = vertices.iter().map(|vertex| vertex.uv).collect();
    let mesh = Mesh::triangles(
        cast_slice::<_, [f32; 3]>(&positions),
        cast_slice::<_, [f32; 3]>(&normals),
        cast_slice::<_, [f32; 2]>(&uvs),
        &split.indices,
    )?;
    let mut tangents = vec![Vec4::ZERO; mesh.corner_count()];
    let (options, context) = (TangentOptions::default(), &mut Context::new());
    write_tangents(&mesh, &options, context, cast_slice_mut::<_, [f32; 4]>(&mut tangents))?;
    assert!(
        tangents
            .iter()
            .zip(&split.indices)
            .all(|(&tangent, &index)| tangent == vertices[index as usize].tangent)
    );
    println!("{} vertices", vertices.len());
    Ok(())
}
