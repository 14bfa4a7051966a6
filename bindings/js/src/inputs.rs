//! The inputs of calls. Each function resizes one array of the arena and returns the address where JavaScript
//! writes its elements.
//!
//! Memory may move whenever an array grows, so JavaScript asks for all addresses of a call before it writes
//! the first element.

use crate::allocator::end_without_memory;
use crate::arena::with_arena;

/// Seeds the hash keys with 64 random bits, in two halves. JavaScript calls this once per instance, before
/// anything else, because WebAssembly itself has no randomness.
#[cfg(target_family = "wasm")]
#[unsafe(no_mangle)]
pub extern "C" fn seed_random(low: u32, high: u32) {
    darboux::internal::seed_random(u64::from(low) | u64::from(high) << 32);
}

/// Starts a mesh of triangles without indices. The functions below add what the caller's mesh has.
#[unsafe(no_mangle)]
pub extern "C" fn begin() {
    with_arena(|arena| {
        arena.surface.is_indexed = false;
        arena.surface.face_sizes.clear();
    });
}

/// Three floats per vertex.
#[unsafe(no_mangle)]
pub extern "C" fn positions(vertices: usize) -> *mut f32 {
    with_arena(|arena| resized(&mut arena.vertices.positions, 3 * vertices))
}

/// Three floats per vertex.
#[unsafe(no_mangle)]
pub extern "C" fn normals(vertices: usize) -> *mut f32 {
    with_arena(|arena| resized(&mut arena.vertices.normals, 3 * vertices))
}

/// Two floats per vertex.
#[unsafe(no_mangle)]
pub extern "C" fn uvs(vertices: usize) -> *mut f32 {
    with_arena(|arena| resized(&mut arena.surface.uvs, 2 * vertices))
}

/// The vertex of each corner.
#[unsafe(no_mangle)]
pub extern "C" fn indices(corners: usize) -> *mut u32 {
    with_arena(|arena| {
        arena.surface.is_indexed = true;
        resized(&mut arena.surface.indices, corners)
    })
}

/// The number of corners of each face.
#[unsafe(no_mangle)]
pub extern "C" fn face_sizes(faces: usize) -> *mut u32 {
    with_arena(|arena| resized(&mut arena.surface.face_sizes, faces))
}

/// Tangents to split, compare, encode, complete, convert or transform: four floats each.
#[cfg(feature = "full")]
#[unsafe(no_mangle)]
pub extern "C" fn given_tangents(tangents: usize) -> *mut f32 {
    with_arena(|arena| resized(&mut arena.extras.given_tangents, 4 * tangents))
}

/// The tangents that the given ones are compared with: four floats each.
#[cfg(feature = "full")]
#[unsafe(no_mangle)]
pub extern "C" fn other_tangents(tangents: usize) -> *mut f32 {
    with_arena(|arena| resized(&mut arena.extras.other_tangents, 4 * tangents))
}

/// The bytes of encoded tangents or of texels.
#[cfg(feature = "full")]
#[unsafe(no_mangle)]
pub extern "C" fn encoded_bytes(bytes: usize) -> *mut u8 {
    with_arena(|arena| resized(&mut arena.extras.encoded_bytes, bytes))
}

/// For each vertex, the first vertex with an equal position, normal and UV, as the GPU found it.
#[cfg(feature = "full")]
#[unsafe(no_mangle)]
pub extern "C" fn welded_vertices(vertices: usize) -> *mut u32 {
    with_arena(|arena| resized(&mut arena.extras.welded_vertices, vertices))
}

/// Gives an array exactly this length without allocating more than that, and returns its address.
pub(crate) fn resized<T: Clone + Default>(array: &mut Vec<T>, len: usize) -> *mut T {
    if array.try_reserve_exact(len.saturating_sub(array.len())).is_err() {
        end_without_memory();
    }
    array.resize(len, T::default());
    array.as_mut_ptr()
}
