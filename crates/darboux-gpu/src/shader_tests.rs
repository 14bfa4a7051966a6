//! Tests of shader texts, without a device.

mod lists;
mod operation_counts;
