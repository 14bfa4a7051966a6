//! Tangents from sums over the triangles around each vertex: the methods `lengyel`, `average` and `area`.

pub(crate) mod accumulate;
pub(crate) mod area;
pub(crate) mod average;
mod blocks;
pub(crate) mod finish;
mod frame_kernel;
mod frame_math;
mod gather;
pub(crate) mod lengyel;
mod scatter;
pub(crate) mod side_sums;
mod term_kernel;
pub(crate) mod weighting;
