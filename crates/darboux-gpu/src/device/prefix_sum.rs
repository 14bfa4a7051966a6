//! Prefix sums.

use wgpu::{Buffer, ComputePipeline, Device};

use crate::device::kernel::{BLOCK, Step, VALUES_PER_THREAD, buffer, module, pipeline};

/// The files of the shader.
pub(crate) const SCAN: &[&str] = &[include_str!("../../shaders/device/prefix_sum.wgsl")];

/// What prefix sums need, compiled once.
#[derive(Clone, Debug)]
pub(crate) struct ScanKernels {
    scan: ComputePipeline,
    add_sums: ComputePipeline,
}

impl ScanKernels {
    pub fn new(device: &Device) -> Self {
        let module = module(device, SCAN);
        Self { scan: pipeline(device, &module, "scan"), add_sums: pipeline(device, &module, "add_sums") }
    }

    /// Steps that make every value of `values`, of which there are `count`, the sum of those before it.
    pub fn steps(&self, device: &Device, values: &Buffer, count: u32) -> Vec<Step> {
        let blocks = count.div_ceil(BLOCK);
        let sum_of_block = buffer(device, "sum_of_block", blocks);
        let buffers = [(0, values), (1, &sum_of_block)];
        let threads = count.div_ceil(VALUES_PER_THREAD);
        let mut steps = vec![Step::new(device, &self.scan, &buffers, threads)];
        if blocks > 1 {
            steps.extend(self.steps(device, &sum_of_block, blocks));
            steps.push(Step::new(device, &self.add_sums, &buffers, threads));
        }
        steps
    }
}
