//! glTF 2.0 and GLB: a document that is read, edited in place and written back with everything else untouched.

mod accessor;
mod document;
pub mod schema;

pub use accessor::{Elements, NewAccessor, Target};
pub use document::{Document, LoadOptions, SaveOptions};
pub use schema::{ComponentType, ElementType};
