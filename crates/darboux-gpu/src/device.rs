//! Adapters, buffers, kernels and what runs them.

pub mod adapters;
pub mod kernel;
pub mod mesh_buffers;
pub mod precision;
pub mod prefix_sum;
pub mod readback;
