//! The C interface of Darboux. `include/darboux.h` is generated from this crate, and its comments are the
//! contract of every pointer.
//!
//! A call reads its structs and pointers into checked views ([`pointers`]), runs the core, and writes the
//! results. [`status::call`] turns a panic into a status. A panic outside of it, for example while an object
//! is freed, aborts the program; so does running out of memory.

#![allow(unsafe_code, reason = "C passes pointers")]
#![allow(non_camel_case_types, reason = "types are called as C calls them")]
#![allow(
    clippy::missing_safety_doc,
    reason = "the contract of each pointer stands where the header says what it points to"
)]
#![deny(clippy::undocumented_unsafe_blocks)]

mod codes;
mod pointers;

// The modules are in the order of the header.
mod status;

mod mesh;

mod context;

mod tangents;

mod split;

mod plan;

mod normals;

mod measure;

mod recognise;

mod encode;

mod convention;

mod transform;

mod allocator;

pub use allocator::*;
pub use codes::*;
pub use context::{
    darboux_context, darboux_context_cancel, darboux_context_create, darboux_context_free,
    darboux_context_resume,
};
pub use convention::*;
pub use encode::*;
pub use measure::*;
pub use mesh::darboux_mesh;
pub use normals::*;
pub use plan::*;
pub use recognise::*;
pub use split::*;
pub use status::{darboux_last_error, darboux_status, darboux_version};
pub use tangents::*;
pub use transform::*;
