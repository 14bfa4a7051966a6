//! The triangles at each vertex, found by counting, a prefix sum and scattering.

use wgpu::{Buffer, CommandEncoder, Device};

use crate::GpuError;
use crate::device::mesh_buffers::{Description, check_size};
use crate::device::precision::Arithmetic;
use crate::mikktspace::passes::OF_ADJACENCY;
use crate::mikktspace::program::{Buffers, Program, Recording};

/// What [`Adjacency::new`] needs, compiled once.
#[derive(Clone, Debug)]
pub(crate) struct AdjacencyKernels(Program);

/// The adjacency of one mesh, and what makes it.
#[derive(Clone, Debug)]
pub(crate) struct Adjacency {
    /// Where the part of each vertex ends.
    pub ends: Buffer,
    /// The triangles, part after part, ascending in each.
    pub triangle_of_entry: Buffer,
    recording: Recording,
}

impl AdjacencyKernels {
    pub fn new(device: &Device) -> Self {
        // It has no floats.
        Self(Program::new(device, Arithmetic::Fast, OF_ADJACENCY))
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
        let sizes = [mesh.vertex_count, mesh.triangle_count];
        check_size(device, "the triangles of vertices", 12 * u64::from(mesh.triangle_count))?;
        check_size(device, "the ends of vertices", 4 * u64::from(mesh.vertex_count))?;
        let mut buffers = Buffers::given([("mesh", description), ("vertex_of_corner", indices)]);
        let recording = kernels.0.on(device, sizes, &mut buffers)?;
        let [ends, triangle_of_entry] = ["ends", "triangle_of_entry"].map(|name| buffers.of(name).clone());
        Ok(Self { ends, triangle_of_entry, recording })
    }

    pub fn record(&self, encoder: &mut CommandEncoder) {
        self.recording.record(encoder);
    }
}
