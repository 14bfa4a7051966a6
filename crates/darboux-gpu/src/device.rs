//! What every algorithm of this crate needs of a device: adapters, buffers, compute kernels, exact
//! arithmetic, prefix sums and reading back.

pub mod adapters;
pub mod buffers;
pub mod kernel;
pub mod mesh_buffers;
pub mod precision;
pub mod prefix_sum;
pub mod readback;
