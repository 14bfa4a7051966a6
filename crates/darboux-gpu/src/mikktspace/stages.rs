//! Derivatives, and from groups to frames: twins of the core's stages of these names, on topology that a test brings.

use wgpu::{Buffer, BufferUsages, CommandEncoder, Device};

use crate::GpuError;
use crate::device::kernel::{buffer, filled};
use crate::device::mesh_buffers::Description;
use crate::device::precision::Arithmetic;
use crate::mikktspace::passes::{OF_DERIVATIVES, OF_FRAMES};
use crate::mikktspace::program::{Buffers, Program, Recording};

/// What evaluation needs, compiled once.
#[derive(Clone, Debug)]
pub struct EvaluationKernels {
    derivatives: Program,
    frames: Program,
}

impl EvaluationKernels {
    /// Compiles the shaders.
    pub fn new(device: &Device, arithmetic: Arithmetic) -> Self {
        let [derivatives, frames] =
            [OF_DERIVATIVES, OF_FRAMES].map(|passes| Program::new(device, arithmetic, passes));
        Self { derivatives, frames }
    }
}

/// A mesh whose topology is on the device.
#[derive(Clone, Copy, Debug)]
pub struct Grouped<'a> {
    /// Positions, normals and UVs.
    pub vertices: &'a Buffer,
    /// The welded vertex of every corner; none (all ones) at degenerate triangles.
    pub welded_corners: &'a Buffer,
    /// Where the triangles of each welded vertex end in the next.
    pub ends: &'a Buffer,
    /// The triangles at each welded vertex, ascending.
    pub triangle_of_entry: &'a Buffer,
    /// Per triangle what [`Evaluation::record_derivatives`] writes: 1 where it keeps its orientation, 2 where it is UV-degenerate.
    /// For the frames besides: 8 where the triangle before is the other half of its quad.
    pub marks: &'a Buffer,
    /// A corner that every corner of the same group names, and no other; all ones for corners of no group.
    pub seed_of_corner: &'a Buffer,
}

/// The kernels on one mesh.
#[derive(Clone, Debug)]
pub struct Evaluation {
    /// Eight words per triangle: dP/du, dP/dv, their lengths.
    pub derivatives: Buffer,
    /// Eight words per corner: tangent, bitangent, magnitudes. Corners of no group keep what they have.
    pub frames: Buffer,
    /// Triangles, triangles and corners that were done in whole numbers: by derivatives, wedges and evaluation.
    pub counts: Buffer,
    of_derivatives: Recording,
    of_frames: Recording,
}

impl Evaluation {
    /// Of positions, normals and UVs in this order without gaps. Errors: the device binds no buffer of that size.
    pub fn of_packed(
        device: &Device,
        kernels: &EvaluationKernels,
        sizes: [u32; 2],
        threshold_cosine: f32,
        mesh: &Grouped<'_>,
    ) -> Result<Self, GpuError> {
        let [vertices, triangles] = sizes;
        let mut buffers = Buffers::given([
            ("mesh", &Description::packed(vertices, triangles).uniform(device)),
            ("evaluation", &evaluation(device, 3 * triangles, threshold_cosine)),
            ("vertices", mesh.vertices),
            ("vertex_of_corner", mesh.welded_corners),
            ("ends", mesh.ends),
            ("triangle_of_entry", mesh.triangle_of_entry),
            ("marks", mesh.marks),
            ("seed_of_corner", mesh.seed_of_corner),
        ]);
        let of_derivatives = kernels.derivatives.on(device, sizes, &mut buffers)?;
        let of_frames = kernels.frames.on(device, sizes, &mut buffers)?;
        let [derivatives, frames] = ["derivatives", "frames"].map(|name| buffers.of(name).clone());
        Ok(Self { derivatives, frames, counts: buffer(device, "counts", 3), of_derivatives, of_frames })
    }

    /// Records the derivatives and their marks.
    pub fn record_derivatives(&self, encoder: &mut CommandEncoder) {
        self.record(&self.of_derivatives, 0, encoder);
    }

    /// Records the frames, once there are groups.
    pub fn record_frames(&self, encoder: &mut CommandEncoder) {
        self.record(&self.of_frames, 4, encoder);
    }

    /// `offset`: of the first count.
    fn record(&self, recording: &Recording, offset: u64, encoder: &mut CommandEncoder) {
        recording.record(encoder);
        for (step, offset) in recording.reals().zip((offset..).step_by(4)) {
            step.record_count(encoder, &self.counts, offset);
        }
    }
}

/// The shaders' `Evaluation`.
pub(crate) fn evaluation(device: &Device, corners: u32, threshold_cosine: f32) -> Buffer {
    let words = [corners, threshold_cosine.to_bits(), 0, 0];
    filled(device, "evaluation", bytemuck::cast_slice(&words), BufferUsages::UNIFORM)
}
