//! Corner tangents to vertices.

use darboux::{CornerTangents, Faces, Mesh, Strided, split_vertices as split};

use crate::room::{rows, with};

/// Splits the vertices of the indices for the given tangents: how many vertices there are then, or -1 where an index is out of range.
#[unsafe(no_mangle)]
pub extern "C" fn split_vertices(vertices: usize) -> i32 {
    with(|room| {
        let corners = CornerTangents::from_per_corner(rows(&room.values.given).to_vec());
        // Splitting asks for numbers alone: of vertices, and of corners in one large face.
        let (nothing, uvs) = (Strided::repeated(&[0.0; 3], vertices), Strided::repeated(&[0.0; 2], vertices));
        let size = [corners.len() as u32];
        let mesh = Mesh::with_faces(nothing, nothing, uvs, room.surface.indices(), Faces::Mixed(&size));
        let Some(split) = mesh.ok().and_then(|mesh| split(&mesh, &corners).ok()) else { return -1 };
        room.values.split = split;
        room.values.split.source_of_vertex.len() as i32
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn split_tangents() -> *const f32 {
    with(|room| room.values.split.tangent_of_vertex.as_ptr().cast())
}

#[unsafe(no_mangle)]
pub extern "C" fn split_indices() -> *const u32 {
    with(|room| room.values.split.indices.as_ptr())
}

#[unsafe(no_mangle)]
pub extern "C" fn split_sources() -> *const u32 {
    with(|room| room.values.split.source_of_vertex.as_ptr())
}
