//! Topology once, tangents every frame: the core's `Plan` for vertices that move on the device.

mod check;
mod normals;

use bytemuck::Zeroable;
use darboux::internal::gpu_plan::{PlanArrays, VERTEX_MASK};
use darboux::{Mesh, TangentOptions};
use wgpu::{Buffer, BufferUsages, CommandEncoder, ComputePipeline, Device};

use crate::device::kernel::{MAX_TURNS, Step, buffer, filled, module, pipeline};
use crate::device::mesh_buffers::{check_elements, check_places, check_size};
use crate::device::precision::{Arithmetic, LIST, List, RealKernel, RealStep, files};
use crate::{GpuError, Precision};
pub use check::PlanCheck;
use normals::Fans;
pub use normals::PlanNormals;

const PLAN: &str = include_str!("../shaders/plan/uniforms.wgsl");
const TRIANGLE: &str = include_str!("../shaders/plan/triangle.wgsl");
const SUMS: &str = include_str!("../shaders/plan/sums.wgsl");
/// The kernels' own files.
pub(crate) const TERMS: &[&str] = &[
    PLAN,
    TRIANGLE,
    include_str!("../shaders/mikktspace/corner_angle.wgsl"),
    include_str!("../shaders/plan/terms.wgsl"),
];
pub(crate) const GATHER: &[&str] = &[PLAN, SUMS, include_str!("../shaders/plan/gather.wgsl")];
pub(crate) const REPAIR: &[&str] = &[PLAN, TRIANGLE, SUMS, include_str!("../shaders/plan/repair.wgsl")];
pub(crate) const CHECK_TRIANGLES: &[&str] = &[
    PLAN,
    TRIANGLE,
    include_str!("../shaders/plan/changes.wgsl"),
    include_str!("../shaders/plan/check_triangles.wgsl"),
];
pub(crate) const CHECK_VERTICES: &[&str] = &[
    PLAN,
    include_str!("../shaders/plan/changes.wgsl"),
    include_str!("../shaders/plan/check_vertices.wgsl"),
];
pub(crate) const NORMALS: &[&str] = &[PLAN, TRIANGLE, include_str!("../shaders/plan/normals.wgsl")];
pub(crate) const WRITE_NORMALS: &[&str] = &[PLAN, include_str!("../shaders/plan/write_normals.wgsl")];
pub(crate) const WRITE: &[&str] = &[PLAN, include_str!("../shaders/plan/write_tangents.wgsl")];

/// What plans need, compiled once for a device.
///
/// ```no_run
/// use darboux::{Mesh, TangentOptions};
/// use darboux_gpu::{Attribute, GpuError, MovingMesh, Per, Planner, Precision};
///
/// # fn plan(
/// #     device: &wgpu::Device, mesh: &Mesh<'_>, vertices: &wgpu::Buffer, encoder: &mut wgpu::CommandEncoder,
/// # ) -> Result<(), GpuError> {
/// let plan = Planner::new(device, Precision::Exact).plan(mesh, &TangentOptions::default())?;
/// // A vertex of 12 floats: position, normal, UV, tangent.
/// let part = |offset| Attribute { buffer: vertices, stride: 48, offset };
/// let moving = MovingMesh {
///     vertex_count: mesh.vertex_count() as u32,
///     positions: part(0),
///     normals: part(12),
///     tangents: part(32),
///     per: Per::Vertex,
/// };
/// let every_frame = plan.of_buffers(&moving)?;
///
/// // After the pass that moves the vertices:
/// every_frame.record(encoder);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Planner {
    device: Device,
    terms: RealKernel,
    gather: RealKernel,
    repair: ComputePipeline,
    write: ComputePipeline,
    check_triangles: RealKernel,
    check_vertices: RealKernel,
    normals: RealKernel,
    write_normals: ComputePipeline,
}

/// The groups of one mesh, on the device: kept to evaluate its tangents again wherever its vertices are.
#[derive(Clone, Debug)]
pub struct Plan {
    planner: Planner,
    words: Words,
    has_quads: bool,
    triangles: Buffer,
    representatives: Buffer,
    sums: Buffer,
    /// By what tangents are of.
    sum_of_output: [Result<(Buffer, u32), GpuError>; 2],
    terms: Buffer,
    tangents: Buffer,
    /// What checks read besides: sums of corners, differences of u, UVs.
    of_check: [Buffer; 3],
    fans: Fans,
}

/// Three floats per vertex in a buffer of the caller's, which has `BufferUsages::STORAGE`.
#[derive(Clone, Copy, Debug)]
pub struct Attribute<'a> {
    /// The buffer.
    pub buffer: &'a Buffer,
    /// Bytes from one vertex to the next, a multiple of 4.
    pub stride: u32,
    /// Bytes before the first, a multiple of 4.
    pub offset: u32,
}

/// What has a tangent of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Per {
    /// Every vertex; one that nothing uses keeps what it has.
    Vertex,
    /// Every corner of the index list.
    Corner,
}

/// The moving vertices of a plan's mesh, and where their tangents go: four floats each, a unit vector and the sign.
///
/// All may be parts of one buffer.
#[derive(Clone, Copy, Debug)]
pub struct MovingMesh<'a> {
    /// The number of vertices.
    pub vertex_count: u32,
    /// Positions.
    pub positions: Attribute<'a>,
    /// Normals.
    pub normals: Attribute<'a>,
    /// Tangents, four floats each.
    pub tangents: Attribute<'a>,
    /// What they are of.
    pub per: Per,
}

/// A [`Plan`] on a caller's buffers: recorded every frame, without allocation.
#[derive(Clone, Debug)]
pub struct PlanOfBuffers {
    terms: RealStep,
    gather: RealStep,
    unusable: List,
    repair: Option<Step>,
    write: Step,
    counts: Buffer,
    repaired: Buffer,
}

/// The shaders' `Plan`, in words.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
struct Words {
    vertex_count: u32,
    triangle_count: u32,
    degenerate_count: u32,
    sum_count: u32,
    output_count: u32,
    position: u32,
    position_stride: u32,
    normal: u32,
    normal_stride: u32,
    tangent: u32,
    tangent_stride: u32,
    repairs: u32,
    half_threshold: u32,
    zero: u32,
}

impl Planner {
    /// Compiles the shaders.
    pub fn new(device: &Device, precision: Precision) -> Self {
        Self::with_arithmetic(device, precision.into())
    }

    /// As [`Planner::new`], for tests.
    #[doc(hidden)]
    pub fn with_arithmetic(device: &Device, arithmetic: Arithmetic) -> Self {
        let compile = |files: &[&str], name| pipeline(device, &module(device, files), name);
        Self {
            device: device.clone(),
            terms: RealKernel::new(device, arithmetic, TERMS),
            gather: RealKernel::new(device, arithmetic, GATHER),
            repair: compile(&files(Arithmetic::Fast, true, REPAIR), "every_item"),
            write: compile(WRITE, "write"),
            check_triangles: RealKernel::new(device, Arithmetic::Fast, CHECK_TRIANGLES),
            check_vertices: RealKernel::new(device, Arithmetic::Fast, CHECK_VERTICES),
            normals: RealKernel::new(device, Arithmetic::Fast, NORMALS),
            write_normals: compile(WRITE_NORMALS, "write"),
        }
    }

    /// Groups the triangles of `mesh` on the CPU and uploads what does not depend on where vertices are.
    ///
    /// Quads are cut into triangles as they are on the mesh given. Errors: quads with corners that have the average of two tangents, or one
    /// degenerate half; methods other than MikkTSpace; vertices of too many triangles; a buffer past a limit of the device.
    pub fn plan(&self, mesh: &Mesh<'_>, options: &TangentOptions) -> Result<Plan, GpuError> {
        let topology = PlanArrays::new(mesh, options, MAX_TURNS as usize)?;
        let of_corners = self.upload("sums of corners", &topology.sum_of_corner)?;
        let of_vertices = (topology.sum_of_vertex(mesh))
            .map_err(|vertices| GpuError::Unsplit { vertices })
            .and_then(|sums| self.upload("sums of vertices", &sums));
        let count = |count: usize| count as u32;
        let terms = 9 * topology.triangle_count;
        check_size(&self.device, "terms", 4 * u64::from(terms))?;
        Ok(Plan {
            words: Words {
                vertex_count: count(mesh.vertex_count()),
                triangle_count: topology.triangle_count,
                degenerate_count: topology.degenerate_count,
                sum_count: topology.sum_count,
                repairs: u32::from(topology.repairs),
                half_threshold: ((1.0 + topology.threshold_cosine) / 2.0).sqrt().to_bits(),
                ..Words::zeroed()
            },
            has_quads: topology.has_quads,
            triangles: self.upload("triangles", &topology.triangles)?,
            representatives: self.upload("representatives", &topology.representatives)?,
            sums: self.upload("sums", &topology.sums)?,
            sum_of_output: [
                of_vertices.map(|buffer| (buffer, count(mesh.vertex_count()))),
                Ok((of_corners, count(mesh.corner_count()))),
            ],
            terms: buffer(&self.device, "terms", terms.max(1)),
            tangents: buffer(&self.device, "tangents", (4 * topology.sum_count).max(1)),
            of_check: [
                self.upload("sums of places", &topology.sum_of_place)?,
                self.upload("differences", &topology.du)?,
                self.upload("UVs", &topology.uvs)?,
            ],
            fans: Fans::new(self, mesh, &topology.triangles, VERTEX_MASK)?,
            planner: self.clone(),
        })
    }

    fn upload(&self, what: &'static str, words: &[u32]) -> Result<Buffer, GpuError> {
        check_size(&self.device, what, 4 * words.len() as u64)?;
        let contents = if words.is_empty() { &[0] } else { words };
        Ok(filled(&self.device, what, bytemuck::cast_slice(contents), BufferUsages::STORAGE))
    }
}

impl Plan {
    /// Checks the buffers and makes what recording needs. One plan serves any number of buffers, one after the other: they share its
    /// room for terms.
    ///
    /// Errors: another number of vertices; places that are not whole words or not in their buffer, or that overlap; a buffer without
    /// `BufferUsages::STORAGE` or past a limit of the device; tangents per vertex where corners of one vertex had several.
    pub fn of_buffers(&self, mesh: &MovingMesh<'_>) -> Result<PlanOfBuffers, GpuError> {
        let (sum_of_output, outputs) = self.sum_of_output[mesh.per as usize].clone()?;
        self.check(mesh, outputs)?;
        let device = &self.planner.device;
        let (words, plan) = (&self.words, &self.uniform(mesh, outputs));
        let (positions, normals) = (mesh.positions.buffer, mesh.normals.buffer);
        let unusable = List::new(device, "unusable", words.sum_count);
        let repaired = buffer(device, "repaired", 1);
        let of_triangles =
            [(0, plan), (1, positions), (2, normals), (3, &self.triangles), (4, &self.representatives)];
        let to_terms = [&of_triangles[..], &[(5, &self.terms)]].concat();
        let to_sums = [
            (0, plan),
            (2, normals),
            (3, &self.terms),
            (5, &self.sums),
            (6, &self.tangents),
            (7, &unusable.items),
        ];
        let to_repair = [
            &of_triangles[..],
            &[(5, &self.sums), (6, &self.tangents), (8, &repaired), (LIST, &unusable.items)],
        ]
        .concat();
        let to_write = [(0, plan), (1, &sum_of_output), (2, &self.tangents), (3, mesh.tangents.buffer)];
        let Planner { terms, gather, repair, write, .. } = &self.planner;
        let repair =
            (words.repairs == 1).then(|| Step::indirect(device, repair, &to_repair, &unusable.items));
        Ok(PlanOfBuffers {
            terms: RealStep::new(device, terms, &to_terms, words.triangle_count),
            gather: RealStep::new(device, gather, &to_sums, words.sum_count),
            repair,
            write: Step::new(device, write, &to_write, outputs),
            counts: buffer(device, "counts", 3),
            unusable,
            repaired,
        })
    }

    fn uniform(&self, mesh: &MovingMesh<'_>, output_count: u32) -> Buffer {
        let words = Words {
            output_count,
            position: mesh.positions.offset / 4,
            position_stride: mesh.positions.stride / 4,
            normal: mesh.normals.offset / 4,
            normal_stride: mesh.normals.stride / 4,
            tangent: mesh.tangents.offset / 4,
            tangent_stride: mesh.tangents.stride / 4,
            ..self.words
        };
        filled(&self.planner.device, "plan", bytemuck::bytes_of(&words), BufferUsages::UNIFORM)
    }

    fn check(&self, mesh: &MovingMesh<'_>, outputs: u32) -> Result<(), GpuError> {
        let (expected, found) = (self.words.vertex_count, mesh.vertex_count);
        if expected != found {
            return Err(GpuError::OtherMesh { expected, found });
        }
        let device = &self.planner.device;
        let elements = |what, attribute: &Attribute<'_>, count, size| {
            check_elements(
                device,
                (what, attribute.buffer),
                attribute.stride,
                count,
                [(what, attribute.offset, size)],
            )
        };
        elements("positions", &mesh.positions, found, 12)?;
        elements("normals", &mesh.normals, found, 12)?;
        elements("tangents", &mesh.tangents, outputs, 16)?;
        // Of one buffer and stride, they may lie between each other.
        let Attribute { buffer, stride, offset } = mesh.tangents;
        let others = [("positions", mesh.positions), ("normals", mesh.normals)];
        let others = others.into_iter().filter(|(_, other)| other.buffer == buffer && other.stride == stride);
        let others: Vec<_> = others.map(|(what, other)| (what, other.offset, 12)).collect();
        check_places(stride, [("tangents", offset, 16)].into_iter(), &others)
    }
}

impl PlanOfBuffers {
    /// Records the tangents of where the vertices are when the device comes to it.
    pub fn record(&self, encoder: &mut CommandEncoder) {
        self.unusable.record_clear(encoder);
        encoder.clear_buffer(&self.repaired, 0, None);
        self.terms.record(encoder);
        self.gather.record(encoder);
        if let Some(repair) = &self.repair {
            repair.record(encoder);
        }
        self.write.record(encoder);
        self.terms.record_count(encoder, &self.counts, 0);
        self.gather.record_count(encoder, &self.counts, 4);
        encoder.copy_buffer_to_buffer(&self.repaired, 0, &self.counts, 8, 4);
    }

    /// Three words to copy from: triangles and tangents done in whole numbers; unusable tangents that were replaced, nearly as the core
    /// replaces them.
    pub fn counts(&self) -> &Buffer {
        &self.counts
    }
}
