//! Runs the stages `derivatives` and `frames` alone, from welded vertices and groups that a test provides.

use wgpu::{Buffer, CommandEncoder, Device};

use crate::device::buffers::storage_buffer;
use crate::device::mesh_buffers::MeshUniform;
use crate::device::precision::Arithmetic;
use crate::error::GpuError;
use crate::mikktspace::passes::{DERIVATIVE_PASSES, FRAME_PASSES};
use crate::mikktspace::program::{BoundProgram, NamedBuffers, Program};
use crate::mikktspace::tiles::evaluation_uniform;

/// The compiled kernels of [`Evaluation`].
#[derive(Clone, Debug)]
pub struct EvaluationKernels {
    derivatives: Program,
    frames: Program,
}

impl EvaluationKernels {
    /// Compiles the shaders.
    pub fn new(device: &Device, arithmetic: Arithmetic) -> Self {
        let [derivatives, frames] =
            [DERIVATIVE_PASSES, FRAME_PASSES].map(|passes| Program::new(device, arithmetic, passes));
        Self { derivatives, frames }
    }
}

/// The input buffers. `u32::MAX` stands for none.
#[derive(Clone, Copy, Debug)]
pub struct GroupedMesh<'a> {
    /// Tightly packed vertices of position, normal and UV.
    pub vertices: &'a Buffer,
    /// For each corner, its welded vertex; none at degenerate triangles.
    pub vertex_of_corner: &'a Buffer,
    /// For each welded vertex, the end of its range in `adjacent_triangles`.
    pub adjacency_ends: &'a Buffer,
    /// The triangles at each welded vertex, ascending.
    pub adjacent_triangles: &'a Buffer,
    /// For each triangle, the flags that [`Evaluation::record_derivatives`] writes: 1 if the UV map keeps
    /// its orientation, 2 if it is UV-degenerate. For the frames, the test adds 8 if the triangle before
    /// is the other half of the same quad.
    pub triangle_flags: &'a Buffer,
    /// For each corner, a corner that stands for its group; none for corners without a group.
    pub seed_of_corner: &'a Buffer,
}

/// The two stages on one mesh.
#[derive(Clone, Debug)]
pub struct Evaluation {
    /// Eight words per triangle: dP/du, dP/dv and their lengths.
    pub derivatives: Buffer,
    /// Eight words per corner: tangent, bitangent and magnitudes. Corners without a group are not written.
    pub frames: Buffer,
    /// The number of items that integer arithmetic computed: triangles of derivatives, triangles of corner
    /// terms, corners.
    pub counts: Buffer,
    derivative_program: BoundProgram,
    frame_program: BoundProgram,
}

impl Evaluation {
    /// `sizes`: the number of vertices and of triangles. Errors: a buffer is larger than the device can bind.
    pub fn new(
        device: &Device,
        kernels: &EvaluationKernels,
        sizes: [u32; 2],
        threshold_cosine: f32,
        mesh: &GroupedMesh<'_>,
    ) -> Result<Self, GpuError> {
        let [vertices, triangles] = sizes;
        let mut buffers = NamedBuffers::new([
            ("mesh", &MeshUniform::packed(vertices, triangles).upload(device)),
            ("evaluation", &evaluation_uniform(device, 3 * triangles, threshold_cosine)),
            ("vertices", mesh.vertices),
            ("vertex_of_corner", mesh.vertex_of_corner),
            ("adjacency_ends", mesh.adjacency_ends),
            ("adjacent_triangles", mesh.adjacent_triangles),
            ("triangle_flags", mesh.triangle_flags),
            ("seed_of_corner", mesh.seed_of_corner),
        ]);
        let derivative_program = kernels.derivatives.bind(device, sizes, &mut buffers)?;
        let frame_program = kernels.frames.bind(device, sizes, &mut buffers)?;
        let [derivatives, frames] = ["derivatives", "frames"].map(|name| buffers.get(name).clone());
        let counts = storage_buffer(device, "counts", 3);
        Ok(Self { derivatives, frames, counts, derivative_program, frame_program })
    }

    /// Records the stage that writes the derivatives and the flags of triangles.
    pub fn record_derivatives(&self, encoder: &mut CommandEncoder) {
        self.record(&self.derivative_program, 0, encoder);
    }

    /// Records the stage that writes the frames of corners.
    pub fn record_frames(&self, encoder: &mut CommandEncoder) {
        self.record(&self.frame_program, 4, encoder);
    }

    /// `offset`: the byte offset of the program's first count.
    fn record(&self, program: &BoundProgram, offset: u64, encoder: &mut CommandEncoder) {
        program.record(encoder);
        for (dispatch, offset) in program.precision_dispatches().zip((offset..).step_by(4)) {
            dispatch.record_count(encoder, &self.counts, offset);
        }
    }
}
