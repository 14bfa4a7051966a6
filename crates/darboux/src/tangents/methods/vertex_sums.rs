//! Methods that sum over the triangles around each vertex: Lengyel, average and area.
//!
//! ```text
//! accumulate: for each triangle, add its term (Weighting::term) to its three vertices, apart for the two UV orientations
//!     scatter: triangle by triangle, on several threads where the triangles around a vertex are near each other in the list
//! finish: frame of each vertex and orientation from its sum; repair frames without a direction; write the corners
//! ```
//!
//! A new method of this kind is one file with an implementation of [`weighting::Weighting`], and a line in
//! `methods.rs`.

pub(crate) mod accumulate;
pub(crate) mod area;
pub(crate) mod average;
mod blocks;
pub(crate) mod finish;
mod frame_kernel;
mod frame_math;
pub(crate) mod lengyel;
mod scatter;
pub(crate) mod side_sums;
mod term_kernel;
pub(crate) mod weighting;
