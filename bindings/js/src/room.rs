//! The arrays of one call.

use std::cell::RefCell;

use darboux::{Faces, Indices, Mesh, Scratch, Strided, Tangents};

/// What a call reads and what it writes. Memory is kept from call to call.
#[derive(Default)]
pub struct Room {
    pub vertices: Vertices,
    pub surface: Surface,
    pub tangents: Tangents,
    pub scratch: Scratch,
    #[cfg(feature = "full")]
    pub values: crate::values::Values,
}

/// Places and normals of a mesh's vertices.
#[derive(Default)]
pub struct Vertices {
    positions: Vec<f32>,
    normals: Vec<f32>,
}

/// What a mesh has beside places and normals of its vertices.
#[derive(Default)]
pub struct Surface {
    uvs: Vec<f32>,
    indices: Vec<u32>,
    face_sizes: Vec<u32>,
    is_indexed: bool,
}

thread_local! {
    /// Made by the first call.
    static ROOM: RefCell<Option<Room>> = const { RefCell::new(None) };
}

#[cfg(feature = "full")]
impl Room {
    /// The mesh, if its structure is right.
    pub fn mesh(&self) -> Option<Mesh<'_>> {
        self.vertices.mesh(&self.surface)
    }
}

impl Vertices {
    /// The mesh of a surface, if its structure is right.
    pub fn mesh<'a>(&'a self, surface: &'a Surface) -> Option<Mesh<'a>> {
        let (positions, normals, uvs) = (self.positions(), rows(&self.normals), rows(&surface.uvs));
        Mesh::with_faces(positions, normals, uvs, surface.indices(), surface.faces()).ok()
    }

    pub fn positions(&self) -> Strided<'_, 3> {
        Strided::from(rows(&self.positions))
    }

    #[cfg(feature = "full")]
    pub fn normals(&self) -> &[f32] {
        &self.normals
    }
}

impl Surface {
    pub fn indices(&self) -> Indices<'_> {
        if self.is_indexed { Indices::U32(&self.indices) } else { Indices::Unindexed }
    }

    pub fn faces(&self) -> Faces<'_> {
        if self.face_sizes.is_empty() { Faces::Triangles } else { Faces::Mixed(&self.face_sizes) }
    }
}

/// Floats as rows of `N`.
pub fn rows<const N: usize>(floats: &[f32]) -> &[[f32; N]] {
    floats.as_chunks().0
}

/// Does something with the room.
pub fn with<R>(use_it: impl FnOnce(&mut Room) -> R) -> R {
    ROOM.with_borrow_mut(|room| use_it(room.get_or_insert_default()))
}

/// Begins a mesh, without indices, of triangles.
#[unsafe(no_mangle)]
pub extern "C" fn begin() {
    with(|room| {
        room.surface.is_indexed = false;
        room.surface.face_sizes.clear();
    });
}

#[unsafe(no_mangle)]
pub extern "C" fn positions(vertices: usize) -> *mut f32 {
    with(|room| sized(&mut room.vertices.positions, 3 * vertices))
}

#[unsafe(no_mangle)]
pub extern "C" fn normals(vertices: usize) -> *mut f32 {
    with(|room| sized(&mut room.vertices.normals, 3 * vertices))
}

#[unsafe(no_mangle)]
pub extern "C" fn uvs(vertices: usize) -> *mut f32 {
    with(|room| sized(&mut room.surface.uvs, 2 * vertices))
}

#[unsafe(no_mangle)]
pub extern "C" fn indices(corners: usize) -> *mut u32 {
    with(|room| {
        room.surface.is_indexed = true;
        sized(&mut room.surface.indices, corners)
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn face_sizes(faces: usize) -> *mut u32 {
    with(|room| sized(&mut room.surface.face_sizes, faces))
}

/// Makes an array just as long, keeping its memory: where it is.
pub fn sized<T: Clone + Default>(array: &mut Vec<T>, len: usize) -> *mut T {
    array.reserve_exact(len.saturating_sub(array.len()));
    array.resize(len, T::default());
    array.as_mut_ptr()
}
