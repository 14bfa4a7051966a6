//! The arrays that JavaScript and WebAssembly share: one arena per instance of the module, reused from call
//! to call.
//!
//! A call goes like this:
//!
//! ```text
//! begin(); p = positions(n); i = indices(c); ...   JavaScript asks for the address of every input array
//! memory[p ..] = ...                               and copies its own arrays there,
//! r = generate_tangents(mode, threshold, method)   the function reads the arena, writes the arena, and returns an address
//! tangents = memory[r .. r + 16 * c]               from which JavaScript copies the result
//! ```

use std::cell::RefCell;

use darboux::{Context, Report};

use crate::mesh_arrays::{Surface, Vertices};

/// The inputs and outputs of calls. Every array keeps its capacity.
#[derive(Default)]
pub struct Arena {
    pub vertices: Vertices,
    pub surface: Surface,
    pub tangents: Vec<[f32; 4]>,
    pub report: Report,
    pub context: Context,
    #[cfg(feature = "full")]
    pub extras: crate::extras::Extras,
    #[cfg(feature = "bake")]
    pub bake: crate::bake_arrays::BakeArrays,
    #[cfg(feature = "check")]
    pub check: crate::check_arrays::CheckArrays,
}

thread_local! {
    /// `None` until the first call.
    static ARENA: RefCell<Option<Arena>> = const { RefCell::new(None) };
}

#[cfg(feature = "full")]
impl Arena {
    /// The mesh in the arena. `None` where an index is out of range.
    pub fn mesh(&self) -> Option<darboux::Mesh<'_>> {
        self.vertices.mesh(&self.surface)
    }
}

/// Calls a function with the arena of this instance.
pub fn with_arena<R>(call: impl FnOnce(&mut Arena) -> R) -> R {
    ARENA.with_borrow_mut(|arena| call(arena.get_or_insert_default()))
}
