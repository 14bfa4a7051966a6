//! `splitVertices`: turns tangents of corners into tangents of vertices.

use darboux::{CornerTangents, Faces, Mesh, Strided, split_vertices as split};

use crate::arena::with_arena;
use crate::mesh_arrays::rows;

/// Splits vertices so that each has one of the given tangents. Returns the new number of vertices, or -1
/// where an index is out of range.
#[unsafe(no_mangle)]
pub extern "C" fn split_vertices(vertices: usize) -> i32 {
    with_arena(|arena| {
        let corners = CornerTangents::from_per_corner(rows(&arena.extras.given_tangents).to_vec());
        // Splitting reads the number of vertices and the indices, so all vertices are zero and all corners
        // are in one face.
        let (zeros, uvs) = (Strided::repeated(&[0.0; 3], vertices), Strided::repeated(&[0.0; 2], vertices));
        let face = [corners.len() as u32];
        let mesh = Mesh::with_faces(zeros, zeros, uvs, arena.surface.indices(), Faces::Mixed(&face));
        let Some(split) = mesh.ok().and_then(|mesh| split(&mesh, &corners).ok()) else { return -1 };
        arena.extras.split = split;
        arena.extras.split.source_of_vertex.len() as i32
    })
}

/// Four floats per new vertex.
#[unsafe(no_mangle)]
pub extern "C" fn split_tangents() -> *const f32 {
    with_arena(|arena| arena.extras.split.tangent_of_vertex.as_ptr().cast())
}

/// The new vertex of each corner.
#[unsafe(no_mangle)]
pub extern "C" fn split_indices() -> *const u32 {
    with_arena(|arena| arena.extras.split.indices.as_ptr())
}

/// The old vertex that each new vertex copies.
#[unsafe(no_mangle)]
pub extern "C" fn split_sources() -> *const u32 {
    with_arena(|arena| arena.extras.split.source_of_vertex.as_ptr())
}
