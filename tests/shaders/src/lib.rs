//! The shader library, compiled and executed: what its tests share.

mod gpu;
mod kernel;
mod language;
pub mod picture;
pub mod samples;
pub mod vector;

pub use gpu::{Gpu, gpus};
pub use kernel::{Case, Expected, check, check_in_quads};
pub use language::{Language, Stage, glslang, glslang_is_there, library};
