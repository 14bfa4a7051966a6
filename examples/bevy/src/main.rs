//! Gives a mesh of Bevy the tangents of Darboux, with vertices split where mirrored UVs need it.
//! `Mesh::generate_tangents` writes through the index list, so that such vertices keep only one of their
//! tangents.
//!
//! `cargo run --manifest-path examples/bevy/Cargo.toml`

use std::error::Error;

use bevy_asset::RenderAssetUsages;
use bevy_mesh::{Indices, Mesh, PrimitiveTopology, VertexAttributeValues};
use darboux::{Context, Convention, Splitter, TangentOptions, generate_tangents};

/// Adds the attribute `ATTRIBUTE_TANGENT`. Errors: not a list of triangles; positions, normals or UVs are
/// missing or not floats.
fn add_tangents(mesh: &mut Mesh) -> Result<(), Box<dyn Error>> {
    if mesh.primitive_topology() != PrimitiveTopology::TriangleList {
        return Err("the mesh is not a list of triangles".into());
    }
    let vectors = |attribute| match mesh.attribute(attribute) {
        Some(VertexAttributeValues::Float32x3(values)) => Ok(values),
        _ => Err("positions or normals are missing"),
    };
    let Some(VertexAttributeValues::Float32x2(uvs)) = mesh.attribute(Mesh::ATTRIBUTE_UV_0) else {
        return Err("UVs are missing".into());
    };
    let view = darboux::Mesh::triangles(
        vectors(Mesh::ATTRIBUTE_POSITION)?,
        vectors(Mesh::ATTRIBUTE_NORMAL)?,
        uvs,
        match mesh.indices() {
            None => darboux::Indices::Unindexed,
            Some(Indices::U16(indices)) => indices.into(),
            Some(Indices::U32(indices)) => indices.into(),
        },
    )?;
    let corners = generate_tangents(&view, &TangentOptions::default()).corners;
    let mut splitter = Splitter::new_with(view.vertex_count(), &mut Context::new());
    let indices = splitter.add(&view, &corners)?;
    // Bevy's UVs and shaders are those of glTF.
    let split = splitter.finish_in(Convention::GLTF.generated(), Convention::GLTF);

    // Bevy copies all attributes of the vertices of an index list: here the old vertex of each new one.
    mesh.insert_indices(Indices::U32(split.source_of_vertex));
    mesh.duplicate_vertices();
    mesh.insert_attribute(Mesh::ATTRIBUTE_TANGENT, split.tangent_of_vertex);
    mesh.insert_indices(Indices::U32(indices));
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    // Four triangles whose texture is mirrored at x = 0. v runs down, as in glTF.
    let places = [[-1.0, 0.0], [0.0, 0.0], [1.0, 0.0], [-1.0, 1.0], [0.0, 1.0], [1.0, 1.0f32]];
    let mut mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, places.map(|[x, y]| [x, y, 0.0]).to_vec())
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0, 0.0, 1.0]; 6])
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, places.map(|[x, y]| [x.abs(), 1.0 - y]).to_vec())
        .with_inserted_indices(Indices::U16(vec![0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4]));
    add_tangents(&mut mesh)?;
    let Some(VertexAttributeValues::Float32x4(tangents)) = mesh.attribute(Mesh::ATTRIBUTE_TANGENT) else {
        return Err("no tangents".into());
    };
    assert_eq!(mesh.count_vertices(), 8);
    assert_eq!((tangents[0], tangents[2]), ([-1.0, 0.0, 0.0, -1.0], [1.0, 0.0, 0.0, 1.0]));
    println!("6 vertices became {}", mesh.count_vertices());
    Ok(())
}
