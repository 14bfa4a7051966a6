//! Tests of the WGSL sources that need no device: every kernel is valid, the lists for the npm package are
//! current, and kernels take as many operations as the documentation says.

mod lists;
mod operation_counts;
mod validity;
