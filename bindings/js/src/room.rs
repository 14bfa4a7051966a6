//! The arrays of one call.

use std::cell::RefCell;

use darboux::{Faces, Indices, Mesh, Strided, Tangents};

/// What a call reads and what it writes.
#[derive(Default)]
pub struct Room {
    positions: Vec<f32>,
    normals: Vec<f32>,
    uvs: Vec<f32>,
    indices: Vec<u32>,
    face_sizes: Vec<u32>,
    is_indexed: bool,
    pub tangents: Tangents,
}

thread_local! {
    static ROOM: RefCell<Room> = RefCell::default();
}

impl Room {
    /// The mesh, if its structure is right.
    pub fn mesh(&self) -> Option<Mesh<'_>> {
        let indices = if self.is_indexed { Indices::U32(&self.indices) } else { Indices::Unindexed };
        let faces =
            if self.face_sizes.is_empty() { Faces::Triangles } else { Faces::Mixed(&self.face_sizes) };
        let (positions, normals) = (Strided::from(rows(&self.positions)), rows(&self.normals));
        Mesh::with_faces(positions, normals, rows(&self.uvs), indices, faces).ok()
    }
}

fn rows<const N: usize>(floats: &[f32]) -> &[[f32; N]] {
    floats.as_chunks().0
}

/// Does something with the room.
pub fn with<R>(use_it: impl FnOnce(&mut Room) -> R) -> R {
    ROOM.with_borrow_mut(use_it)
}

/// Makes room for an array of the mesh: where it goes.
#[unsafe(no_mangle)]
pub extern "C" fn positions(vertices: usize) -> *mut f32 {
    with(|room| sized(&mut room.positions, 3 * vertices))
}

#[unsafe(no_mangle)]
pub extern "C" fn normals(vertices: usize) -> *mut f32 {
    with(|room| sized(&mut room.normals, 3 * vertices))
}

#[unsafe(no_mangle)]
pub extern "C" fn uvs(vertices: usize) -> *mut f32 {
    with(|room| sized(&mut room.uvs, 2 * vertices))
}

#[unsafe(no_mangle)]
pub extern "C" fn indices(corners: usize) -> *mut u32 {
    with(|room| {
        room.is_indexed = true;
        sized(&mut room.indices, corners)
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn face_sizes(faces: usize) -> *mut u32 {
    with(|room| sized(&mut room.face_sizes, faces))
}

/// Frees all arrays.
#[unsafe(no_mangle)]
pub extern "C" fn clear() {
    with(|room| *room = Room::default());
}

fn sized<T: Clone + Default>(array: &mut Vec<T>, len: usize) -> *mut T {
    *array = vec![T::default(); len];
    array.as_mut_ptr()
}
