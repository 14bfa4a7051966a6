//! The triangles at each vertex, found by counting, a prefix sum and scattering.

use wgpu::{Buffer, CommandEncoder, ComputePipeline, Device};

use crate::GpuError;
use crate::buffers::{Description, check_size};
use crate::kernel::{BLOCK, Step, VALUES_PER_THREAD, buffer, module, pipeline};

/// What [`Adjacency::new`] needs, compiled once.
#[derive(Clone, Debug)]
pub(crate) struct AdjacencyKernels {
    count: ComputePipeline,
    scan: ComputePipeline,
    add_sums: ComputePipeline,
    scatter: ComputePipeline,
    rank: ComputePipeline,
}

/// The adjacency of one mesh, and the steps that make it.
#[derive(Clone, Debug)]
pub(crate) struct Adjacency {
    /// Where the part of each vertex ends.
    pub ends: Buffer,
    /// The triangles, part after part, ascending in each.
    pub triangle_of_entry: Buffer,
    steps: Vec<Step>,
}

/// The files of the two shaders.
pub(crate) const ADJACENCY: &[&str] =
    &[include_str!("../shaders/mesh.wgsl"), include_str!("../shaders/adjacency.wgsl")];
pub(crate) const SCAN: &[&str] = &[include_str!("../shaders/scan.wgsl")];

impl AdjacencyKernels {
    pub fn new(device: &Device) -> Self {
        let (adjacency, scan) = (module(device, ADJACENCY), module(device, SCAN));
        Self {
            count: pipeline(device, &adjacency, "count"),
            scan: pipeline(device, &scan, "scan"),
            add_sums: pipeline(device, &scan, "add_sums"),
            scatter: pipeline(device, &adjacency, "scatter"),
            rank: pipeline(device, &adjacency, "rank"),
        }
    }

    /// Steps that make every value of `values`, of which there are `count`, the sum of those before it.
    fn prefix_sum(&self, device: &Device, values: &Buffer, count: u32) -> Vec<Step> {
        let blocks = count.div_ceil(BLOCK);
        let sum_of_block = buffer(device, "sum_of_block", blocks);
        let buffers = [(0, values), (1, &sum_of_block)];
        let threads = count.div_ceil(VALUES_PER_THREAD);
        let mut steps = vec![Step::new(device, &self.scan, &buffers, threads)];
        if blocks > 1 {
            steps.extend(self.prefix_sum(device, &sum_of_block, blocks));
            steps.push(Step::new(device, &self.add_sums, &buffers, threads));
        }
        steps
    }
}

impl Adjacency {
    /// `description` and `indices`: the mesh, as the shaders read it. Errors: the device binds no buffer of that size.
    pub fn new(
        device: &Device,
        kernels: &AdjacencyKernels,
        mesh: &Description,
        description: &Buffer,
        indices: &Buffer,
    ) -> Result<Self, GpuError> {
        let corners = 3 * mesh.triangle_count;
        check_size(device, "the triangles of vertices", 4 * u64::from(corners))?;
        check_size(device, "the ends of vertices", 4 * u64::from(mesh.vertex_count))?;
        let ends = buffer(device, "ends", mesh.vertex_count);
        let corner_of_entry = buffer(device, "corner_of_entry", corners);
        let triangle_of_entry = buffer(device, "triangle_of_entry", corners);
        let counting = [(0, description), (1, indices), (2, &ends)];
        let filling = [(0, description), (1, indices), (2, &ends), (3, &corner_of_entry)];
        let ranking = [&filling[..], &[(4, &triangle_of_entry)]].concat();
        let mut steps = vec![Step::new(device, &kernels.count, &counting, corners)];
        steps.extend(kernels.prefix_sum(device, &ends, mesh.vertex_count));
        steps.push(Step::new(device, &kernels.scatter, &filling, corners));
        steps.push(Step::new(device, &kernels.rank, &ranking, corners));
        Ok(Self { ends, triangle_of_entry, steps })
    }

    pub fn record(&self, encoder: &mut CommandEncoder) {
        encoder.clear_buffer(&self.ends, 0, None);
        self.steps.iter().for_each(|step| step.record(encoder));
    }
}
