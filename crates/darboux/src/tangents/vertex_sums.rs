//! Tangents from sums over the triangles around each vertex: the methods `lengyel`, `average` and `area`.

pub(crate) mod area;
pub(crate) mod average;
pub(crate) mod finish;
mod frame_kernel;
mod gather;
pub(crate) mod lengyel;
pub(crate) mod scatter;
mod term_kernel;
pub(crate) mod weighting;
