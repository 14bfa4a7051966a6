//! Compiles the functions of `shaders/` in WGSL, GLSL and HLSL, and runs them on the Vulkan adapters of this
//! machine. The tests compare the results with the core or with double precision.

mod adapters;
mod kernel;
mod language;
pub mod picture;
pub mod samples;
pub mod vector;

pub use adapters::{Gpu, gpus};
pub use kernel::{Case, Expected, check, check_in_quads};
pub use language::{Language, Stage, glslang, glslang_is_there, library};
