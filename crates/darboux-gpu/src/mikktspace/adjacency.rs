//! Lists the triangles at each vertex with a counting sort: count the corners of each vertex, take prefix
//! sums, scatter the triangles.

use wgpu::{Buffer, CommandEncoder, Device};

use crate::device::buffers::check_size;
use crate::device::mesh_buffers::MeshUniform;
use crate::device::precision::Arithmetic;
use crate::error::GpuError;
use crate::mikktspace::passes::ADJACENCY_PASSES;
use crate::mikktspace::program::{BoundProgram, NamedBuffers, Program};

/// The compiled kernels of [`Adjacency`].
#[derive(Clone, Debug)]
pub(crate) struct AdjacencyKernels(Program);

/// The adjacency of one mesh, with the commands that compute it.
#[derive(Clone, Debug)]
pub(crate) struct Adjacency {
    /// For each vertex, the end of its range in `triangles`. The range begins where that of the vertex
    /// before ends.
    pub ends: Buffer,
    /// The triangles at each vertex, ascending.
    pub triangles: Buffer,
    program: BoundProgram,
}

impl AdjacencyKernels {
    pub fn new(device: &Device) -> Self {
        // These kernels compute no floats, so any arithmetic will do.
        Self(Program::new(device, Arithmetic::Fast, ADJACENCY_PASSES))
    }
}

impl Adjacency {
    /// `uniform`: `mesh`, uploaded. Errors: a buffer is larger than the device can bind.
    pub fn new(
        device: &Device,
        kernels: &AdjacencyKernels,
        mesh: &MeshUniform,
        uniform: &Buffer,
        indices: &Buffer,
    ) -> Result<Self, GpuError> {
        let sizes = [mesh.vertex_count, mesh.triangle_count];
        check_size(device, "the triangles at each vertex", 12 * u64::from(mesh.triangle_count))?;
        check_size(device, "the ranges of triangles at each vertex", 4 * u64::from(mesh.vertex_count))?;
        let mut buffers = NamedBuffers::new([("mesh", uniform), ("vertex_of_corner", indices)]);
        let program = kernels.0.bind(device, sizes, &mut buffers)?;
        let [ends, triangles] =
            ["adjacency_ends", "adjacent_triangles"].map(|name| buffers.get(name).clone());
        Ok(Self { ends, triangles, program })
    }

    pub fn record(&self, encoder: &mut CommandEncoder) {
        self.program.record(encoder);
    }
}
