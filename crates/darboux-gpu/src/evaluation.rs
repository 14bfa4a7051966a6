//! Derivatives, and from groups to frames: twins of the core's stages of these names.

use wgpu::{Buffer, BufferUsages, CommandEncoder, Device};

use crate::GpuError;
use crate::buffers::{Description, check_size};
use crate::kernel::{buffer, filled};
use crate::reals::{Arithmetic, RealKernel, RealStep};

const MESH: &str = include_str!("../shaders/mesh.wgsl");
const WELDED: &str = include_str!("../shaders/welded.wgsl");
/// The kernels' own files.
pub(crate) const DERIVATIVES: &[&str] =
    &[MESH, WELDED, include_str!("../shaders/derivative.wgsl"), include_str!("../shaders/derivatives.wgsl")];
pub(crate) const WEDGES: &[&str] =
    &[MESH, WELDED, include_str!("../shaders/wedge.wgsl"), include_str!("../shaders/wedges.wgsl")];
pub(crate) const EVALUATE: &[&str] = &[include_str!("../shaders/evaluate.wgsl")];

/// Words of a triangle's derivatives, of a corner's wedge and of its frame.
const WORDS: u32 = 8;

/// What evaluation needs, compiled once.
#[derive(Clone, Debug)]
pub struct EvaluationKernels {
    derivatives: RealKernel,
    wedges: RealKernel,
    evaluate: RealKernel,
}

impl EvaluationKernels {
    /// Compiles the shaders.
    pub fn new(device: &Device, arithmetic: Arithmetic) -> Self {
        let kernel = |own| RealKernel::new(device, arithmetic, own);
        Self { derivatives: kernel(DERIVATIVES), wedges: kernel(WEDGES), evaluate: kernel(EVALUATE) }
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
    record: [RealStep; 3],
}

impl Evaluation {
    /// `description`: of the vertices, and the number of triangles. Errors: the device binds no buffer of that size.
    pub(crate) fn new(
        device: &Device,
        kernels: &EvaluationKernels,
        description: &Description,
        threshold_cosine: f32,
        mesh: &Grouped<'_>,
    ) -> Result<Self, GpuError> {
        let triangles = description.triangle_count;
        let corners = 3 * triangles;
        check_size(device, "frames", 4 * u64::from(WORDS) * u64::from(corners))?;
        let derivatives = buffer(device, "derivatives", WORDS * triangles);
        let wedges = buffer(device, "wedges", WORDS * corners);
        let frames = buffer(device, "frames", WORDS * corners);
        let words = &description.of_welded_corners().uniform(device);
        let evaluation = filled(
            device,
            "evaluation",
            bytemuck::cast_slice(&[corners, threshold_cosine.to_bits(), 0, 0]),
            BufferUsages::UNIFORM,
        );
        let of_mesh =
            [(0, words), (1, mesh.welded_corners), (2, mesh.vertices), (3, &derivatives), (4, mesh.marks)];
        let of_wedges = [&of_mesh[..], &[(5, &wedges)]].concat();
        let of_corners = [
            (0, &evaluation),
            (1, mesh.triangle_of_entry),
            (2, mesh.ends),
            (3, mesh.welded_corners),
            (4, mesh.seed_of_corner),
            (5, &derivatives),
            (6, &wedges),
            (7, &frames),
        ];
        let record = [
            RealStep::new(device, &kernels.derivatives, &of_mesh, triangles),
            RealStep::new(device, &kernels.wedges, &of_wedges, triangles),
            RealStep::new(device, &kernels.evaluate, &of_corners, corners),
        ];
        Ok(Self { derivatives, frames, counts: buffer(device, "counts", 3), record })
    }

    /// As [`Evaluation::new`], of positions, normals and UVs in this order without gaps.
    pub fn of_packed(
        device: &Device,
        kernels: &EvaluationKernels,
        [vertices, triangles]: [u32; 2],
        threshold_cosine: f32,
        mesh: &Grouped<'_>,
    ) -> Result<Self, GpuError> {
        Self::new(device, kernels, &Description::packed(vertices, triangles), threshold_cosine, mesh)
    }

    /// Records the derivatives and their marks.
    pub fn record_derivatives(&self, encoder: &mut CommandEncoder) {
        self.record[0].record(encoder);
        self.record[0].record_count(encoder, &self.counts, 0);
    }

    /// Records the frames, once there are groups.
    pub fn record_frames(&self, encoder: &mut CommandEncoder) {
        for (offset, step) in [(4, &self.record[1]), (8, &self.record[2])] {
            step.record(encoder);
            step.record_count(encoder, &self.counts, offset);
        }
    }
}
