//! Analyses the topology of a mesh once, on the CPU, and uploads what does not depend on the positions of its
//! vertices.

use bytemuck::Zeroable;
use darboux::internal::gpu_plan::{PlanArrays, VERTEX_MASK};
use darboux::{Context, Mesh, TangentOptions};
use wgpu::{Buffer, BufferUsages, ComputePipeline, Device};

use crate::device::buffers::{buffer_with_contents, check_size, storage_buffer};
use crate::device::kernel::{MAX_ITERATIONS, compute_pipeline, shader_module};
use crate::device::precision::{Arithmetic, PassOrder, Precision, PrecisionKernel, kernel_files};
use crate::error::GpuError;
use crate::plan::moving_mesh::{MovingMesh, PlanUniform};
use crate::plan::normal_groups::NormalGroups;
use crate::plan::shaders::{
    CHECK_TRIANGLES, CHECK_VERTICES, GATHER, NORMALS, REPAIR, TERMS, WRITE_NORMALS, WRITE_TANGENTS,
};

/// The kernels of plans, compiled for a device.
///
/// ```no_run
/// use darboux::{Mesh, TangentOptions};
/// use darboux_gpu::{Attribute, GpuError, MovingMesh, Planner, Precision, TangentsPer};
///
/// # fn plan(
/// #     device: &wgpu::Device, mesh: &Mesh<'_>, vertices: &wgpu::Buffer, encoder: &mut wgpu::CommandEncoder,
/// # ) -> Result<(), GpuError> {
/// let plan = Planner::new(device, Precision::Exact).plan(mesh, &TangentOptions::default())?;
/// // A vertex of 12 floats: position, normal, UV, tangent.
/// let attribute = |offset| Attribute { buffer: vertices, stride: 48, offset };
/// let moving = MovingMesh {
///     vertex_count: mesh.vertex_count() as u32,
///     positions: attribute(0),
///     normals: attribute(12),
///     tangents: attribute(32),
///     per: TangentsPer::Vertex,
/// };
/// let tangents = plan.bind(&moving)?;
///
/// // Every frame, after the pass that moves the vertices:
/// tangents.record(encoder);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Planner {
    pub(super) device: Device,
    pub(super) terms: PrecisionKernel,
    pub(super) gather: PrecisionKernel,
    pub(super) repair: ComputePipeline,
    pub(super) write_tangents: ComputePipeline,
    pub(super) check_triangles: PrecisionKernel,
    pub(super) check_vertices: PrecisionKernel,
    pub(super) normals: PrecisionKernel,
    pub(super) write_normals: ComputePipeline,
}

/// The topology of one mesh on the device, from which its tangents can be computed wherever its vertices are.
#[derive(Clone, Debug)]
pub struct Plan {
    pub(super) planner: Planner,
    /// Without the layout of a moving mesh.
    pub(super) uniform: PlanUniform,
    pub(super) has_quads: bool,
    pub(super) triangles: Buffer,
    pub(super) representatives: Buffer,
    pub(super) sums: Buffer,
    /// The sum of every vertex or corner, and their number, by
    /// [`TangentsPer`](crate::plan::moving_mesh::TangentsPer).
    outputs: [Result<(Buffer, u32), GpuError>; 2],
    pub(super) terms: Buffer,
    pub(super) tangents: Buffer,
    pub(super) check: CheckBuffers,
    pub(super) normals: NormalBuffers,
}

/// The buffers that only checks read.
#[derive(Clone, Debug)]
pub(super) struct CheckBuffers {
    pub sum_of_corner: Buffer,
    /// Two words per triangle: the differences of u along its edges.
    pub u_differences: Buffer,
    pub uvs: Buffer,
}

/// The buffers that only normals read.
#[derive(Clone, Debug)]
pub(super) struct NormalBuffers {
    pub group_count: u32,
    pub groups: Buffer,
    pub group_of_vertex: Buffer,
}

impl Planner {
    /// Compiles the shaders.
    pub fn new(device: &Device, precision: Precision) -> Self {
        Self::with_arithmetic(device, precision.into())
    }

    /// As [`Planner::new`], with another arithmetic, for tests.
    #[doc(hidden)]
    pub fn with_arithmetic(device: &Device, arithmetic: Arithmetic) -> Self {
        let compile = |files: &[&str], name| compute_pipeline(device, &shader_module(device, files), name);
        Self {
            device: device.clone(),
            terms: PrecisionKernel::new(device, arithmetic, TERMS),
            gather: PrecisionKernel::new(device, arithmetic, GATHER),
            repair: compile(&kernel_files(Arithmetic::Fast, PassOrder::Second, REPAIR), "every_item"),
            write_tangents: compile(WRITE_TANGENTS, "write"),
            check_triangles: PrecisionKernel::new(device, Arithmetic::Fast, CHECK_TRIANGLES),
            check_vertices: PrecisionKernel::new(device, Arithmetic::Fast, CHECK_VERTICES),
            normals: PrecisionKernel::new(device, Arithmetic::Fast, NORMALS),
            write_normals: compile(WRITE_NORMALS, "write"),
        }
    }

    /// Groups the corners of `mesh` on the CPU, and uploads what does not depend on the positions of
    /// vertices.
    ///
    /// Quads keep the diagonals that they have in `mesh`.
    ///
    /// Errors: the method is not MikkTSpace; a corner of a quad averages the tangents of two triangles, or
    /// one triangle of a quad is degenerate; a vertex has too many triangles; a buffer is past a limit of
    /// the device.
    pub fn plan(&self, mesh: &Mesh<'_>, options: &TangentOptions) -> Result<Plan, GpuError> {
        self.plan_with(mesh, options, &mut Context::new())
    }

    /// As [`Planner::plan`], with a context. Further error: the context's token was cancelled.
    pub fn plan_with(
        &self,
        mesh: &Mesh<'_>,
        options: &TangentOptions,
        context: &mut Context,
    ) -> Result<Plan, GpuError> {
        let topology =
            PlanArrays::new(mesh, options, context, MAX_ITERATIONS as usize).map_err(GpuError::of_refusal)?;
        let of_corners = self.upload("sums of corners", &topology.sum_of_corner)?;
        let of_vertices = (topology.sum_of_vertex(mesh))
            .map_err(|vertices| GpuError::UnsplitVertices { vertices })
            .and_then(|sums| self.upload("sums of vertices", &sums));
        let [vertex_count, corner_count] = [mesh.vertex_count(), mesh.corner_count()].map(|n| n as u32);
        let term_words = 9 * topology.triangle_count;
        check_size(&self.device, "terms", 4 * u64::from(term_words))?;
        let normals = NormalGroups::new(mesh, &topology.triangles, VERTEX_MASK)?;
        Ok(Plan {
            uniform: PlanUniform {
                vertex_count,
                triangle_count: topology.triangle_count,
                degenerate_count: topology.degenerate_count,
                sum_count: topology.sum_count,
                repairs: u32::from(topology.repairs),
                half_threshold: ((1.0 + topology.threshold_cosine) / 2.0).sqrt().to_bits(),
                ..PlanUniform::zeroed()
            },
            has_quads: topology.has_quads,
            triangles: self.upload("triangles", &topology.triangles)?,
            representatives: self.upload("representatives", &topology.representatives)?,
            sums: self.upload("sums", &topology.sums)?,
            outputs: [of_vertices.map(|buffer| (buffer, vertex_count)), Ok((of_corners, corner_count))],
            terms: storage_buffer(&self.device, "terms", term_words.max(1)),
            tangents: storage_buffer(&self.device, "tangents", (4 * topology.sum_count).max(1)),
            check: CheckBuffers {
                sum_of_corner: self.upload("sums of places", &topology.sum_of_place)?,
                u_differences: self.upload("differences of u", &topology.du)?,
                uvs: self.upload("UVs", &topology.uvs)?,
            },
            normals: NormalBuffers {
                group_count: normals.count,
                groups: self.upload("normal groups", &normals.words)?,
                group_of_vertex: self.upload("normal groups of vertices", &normals.group_of_vertex)?,
            },
            planner: self.clone(),
        })
    }

    fn upload(&self, what: &'static str, words: &[u32]) -> Result<Buffer, GpuError> {
        check_size(&self.device, what, 4 * words.len() as u64)?;
        // Empty buffers cannot be bound.
        let contents = if words.is_empty() { &[0] } else { words };
        Ok(buffer_with_contents(&self.device, what, bytemuck::cast_slice(contents), BufferUsages::STORAGE))
    }
}

/// A moving mesh that was checked against a plan.
pub(super) struct Layout {
    pub uniform: Buffer,
    pub sum_of_output: Buffer,
    pub output_count: u32,
}

impl Plan {
    /// Checks the buffers of `mesh`. Errors: those of [`Plan::bind`].
    pub(super) fn layout(&self, mesh: &MovingMesh<'_>) -> Result<Layout, GpuError> {
        let (sum_of_output, output_count) = self.outputs[mesh.per as usize].clone()?;
        let device = &self.planner.device;
        mesh.check(device, self.uniform.vertex_count, output_count)?;
        let uniform = self.uniform.with_layout(mesh, output_count).upload(device);
        Ok(Layout { uniform, sum_of_output, output_count })
    }
}
