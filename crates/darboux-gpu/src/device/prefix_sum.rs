//! Exclusive prefix sums (scans) of a buffer, in place. The kernel is `shaders/device/prefix_sum.wgsl`.

use wgpu::{Buffer, ComputePipeline, Device};

use crate::device::buffers::storage_buffer;
use crate::device::kernel::{BLOCK, Dispatch, VALUES_PER_THREAD, compute_pipeline, shader_module};

/// The files of the shader.
pub(crate) const PREFIX_SUM_FILES: &[&str] = &[include_str!("../../shaders/device/prefix_sum.wgsl")];

/// The compiled entry points.
#[derive(Clone, Debug)]
pub(crate) struct PrefixSumKernels {
    scan: ComputePipeline,
    add_sums: ComputePipeline,
}

impl PrefixSumKernels {
    pub fn new(device: &Device) -> Self {
        let module = shader_module(device, PREFIX_SUM_FILES);
        Self {
            scan: compute_pipeline(device, &module, "scan"),
            add_sums: compute_pipeline(device, &module, "add_sums"),
        }
    }

    /// Dispatches that replace each of the `count` values by the sum of the values before it.
    pub fn dispatches(&self, device: &Device, values: &Buffer, count: u32) -> Vec<Dispatch> {
        let blocks = count.div_ceil(BLOCK);
        let sum_of_block = storage_buffer(device, "sum_of_block", blocks);
        let buffers = [(0, values), (1, &sum_of_block)];
        let threads = count.div_ceil(VALUES_PER_THREAD);
        let mut dispatches = vec![Dispatch::new(device, &self.scan, &buffers, threads)];
        if blocks > 1 {
            dispatches.extend(self.dispatches(device, &sum_of_block, blocks));
            dispatches.push(Dispatch::new(device, &self.add_sums, &buffers, threads));
        }
        dispatches
    }
}
