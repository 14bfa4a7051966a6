//! Pictures of a normal-mapped plate, one for each encoding, drawn by the CPU and by a GPU.
//!
//! The plate is two quads that face the camera, with one texel per pixel. The UVs of the right quad are
//! mirrored. The normals lean outwards, as if the plate were convex, so interpolated vectors are shorter than
//! 1.

mod draw_on_cpu;
mod draw_on_gpu;
mod encoding;
mod plate;

pub use draw_on_cpu::draw as draw_on_cpu;
pub use draw_on_gpu::draw as draw_on_gpu;
pub use encoding::{Encoding, Plate, SIDE};
