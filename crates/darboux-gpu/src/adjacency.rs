//! The triangles at each vertex, found by counting, a prefix sum and scattering.

use wgpu::{Buffer, CommandEncoder, ComputePipeline, Device};

use crate::GpuError;
use crate::buffers::{Description, check_size};
use crate::kernel::{Step, buffer, module, pipeline};
use crate::scan::ScanKernels;

/// What [`Adjacency::new`] needs, compiled once.
#[derive(Clone, Debug)]
pub(crate) struct AdjacencyKernels {
    count: ComputePipeline,
    scan: ScanKernels,
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

/// The files of the shader.
pub(crate) const ADJACENCY: &[&str] =
    &[include_str!("../shaders/mesh.wgsl"), include_str!("../shaders/adjacency.wgsl")];

impl AdjacencyKernels {
    pub fn new(device: &Device) -> Self {
        let adjacency = module(device, ADJACENCY);
        Self {
            count: pipeline(device, &adjacency, "count"),
            scan: ScanKernels::new(device),
            scatter: pipeline(device, &adjacency, "scatter"),
            rank: pipeline(device, &adjacency, "rank"),
        }
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
        steps.extend(kernels.scan.steps(device, &ends, mesh.vertex_count));
        steps.push(Step::new(device, &kernels.scatter, &filling, corners));
        steps.push(Step::new(device, &kernels.rank, &ranking, corners));
        Ok(Self { ends, triangle_of_entry, steps })
    }

    pub fn record(&self, encoder: &mut CommandEncoder) {
        encoder.clear_buffer(&self.ends, 0, None);
        self.steps.iter().for_each(|step| step.record(encoder));
    }
}
