//! Computes the MikkTSpace tangents of a mesh in CPU memory, with the bits of `darboux::generate_tangents`.
//!
//! ```text
//! GPU:   weld vertices, find neighbours, derivatives, groups and frames; write a tangent per corner
//! GPU:   defer every vertex whose result depends on the order of triangles, has several tangents, or lies in several tiles
//! CPU:   compute the deferred vertices (darboux::internal::gpu_resume), and the report
//! ```
//!
//! What is common runs on the GPU; what is rare, and hard to parallelise with the same bits, runs on the CPU.

use darboux::internal::cancel_checks::check;
use darboux::internal::gpu_resume;
use darboux::{
    Context, CornerTangents, Faces, Indices, Mesh, Method, MikkTSpaceOptions, TangentOptions, Tangents,
    generate_tangents_with,
};
use wgpu::{CommandEncoder, Device, Queue};

use crate::device::adapters::{AdapterSummary, Gpu};
use crate::device::buffers::{corner_indices, largest_buffer};
use crate::device::precision::Arithmetic;
use crate::device::readback::{submit, with_error_scopes};
use crate::error::GpuError;
use crate::mikktspace::tiles::{
    BYTES_PER_TRIANGLE, Programs, Submesh, Tile, UploadedVertices, shared_between_tiles, weld_on_cpu,
};

/// MikkTSpace, compiled for a device.
#[derive(Clone, Debug)]
pub struct MikkTSpace {
    device: Device,
    queue: Queue,
    programs: Programs,
    /// The most triangles per tile, whatever the device can bind.
    tile_size: u32,
}

/// No mesh has more triangles. The stress build uses small tiles, so that most meshes have several.
const MAX_TILE_SIZE: u32 = if cfg!(small_limits) { 200 } else { (1 << 30) / 3 };

/// The result of [`MikkTSpace::generate_tangents`].
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct GpuTangents {
    /// The tangents and the report of `darboux::generate_tangents`.
    pub tangents: Tangents,
    /// The number of corners that the CPU computed.
    pub cpu_corners: usize,
    /// The reason why the CPU computed the whole mesh, if it did.
    pub cpu_fallback: Option<CpuFallback>,
}

/// Why the CPU computed a whole mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CpuFallback {
    /// The method is not MikkTSpace.
    Method,
    /// The mesh has faces that are not triangles.
    Faces,
    /// The mesh has values that are not finite or larger than 1e38, or equal vertices whose zeros have
    /// different signs. The reference welds those in an order that only the CPU reproduces.
    Values,
}

impl std::fmt::Display for CpuFallback {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Method => "only MikkTSpace runs on the GPU",
            Self::Faces => "only meshes of triangles run on the GPU",
            Self::Values => {
                "the vertices have NaN, infinite or huge values, or equal positions whose zeros have \
                 different signs"
            }
        })
    }
}

impl MikkTSpace {
    /// Compiles the shaders. Errors: the device rejects them.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Self::with_arithmetic(gpu, Arithmetic::Exact)
    }

    /// The most triangles per tile on an adapter, which follows from its largest binding. Larger meshes run
    /// in several tiles.
    pub fn triangle_limit(adapter: &AdapterSummary) -> u64 {
        adapter.largest_binding / BYTES_PER_TRIANGLE
    }

    /// The same with at most `triangles` triangles per tile, for tests.
    #[doc(hidden)]
    pub fn with_tile_size(self, triangles: u32) -> Self {
        Self { tile_size: triangles, ..self }
    }

    /// As [`MikkTSpace::new`], with another arithmetic, for tests.
    #[doc(hidden)]
    pub fn with_arithmetic(gpu: &Gpu, arithmetic: Arithmetic) -> Result<Self, GpuError> {
        let Gpu { device, queue, .. } = gpu;
        with_error_scopes(device, || {
            Ok(Self {
                device: device.clone(),
                queue: queue.clone(),
                programs: Programs::new(device, arithmetic),
                tile_size: MAX_TILE_SIZE,
            })
        })
    }

    /// Computes the tangent of every corner, with the bits of `darboux::generate_tangents`.
    ///
    /// The CPU computes vertices whose result depends on the order of triangles, vertices with several
    /// tangents or an unusable one, and vertices on the border between tiles. Blocks until the device has
    /// finished.
    ///
    /// Errors: the device is out of memory or lost, or its largest buffer is smaller than a triangle.
    pub fn generate_tangents(
        &self,
        mesh: &Mesh<'_>,
        options: &TangentOptions,
    ) -> Result<GpuTangents, GpuError> {
        self.generate_tangents_with(mesh, options, &mut Context::new())
    }

    /// As [`MikkTSpace::generate_tangents`], with a context, whose limit of threads holds for the part of the
    /// CPU. Further error: the context's token was cancelled. It is checked before each submission, at
    /// least every 10 ms while the device works, and on the CPU; the device still finishes the commands
    /// that it has.
    pub fn generate_tangents_with(
        &self,
        mesh: &Mesh<'_>,
        options: &TangentOptions,
        context: &mut Context,
    ) -> Result<GpuTangents, GpuError> {
        let Method::MikkTSpace(mikkt) = &options.method else {
            return GpuTangents::from_cpu(mesh, options, context, CpuFallback::Method);
        };
        if !matches!(mesh.faces(), Faces::Triangles) {
            return GpuTangents::from_cpu(mesh, options, context, CpuFallback::Faces);
        }
        if mesh.face_count() == 0 {
            let tangents = generate_tangents_with(mesh, options, context)?;
            return Ok(GpuTangents { tangents, cpu_corners: 0, cpu_fallback: None });
        }
        let indices = corner_indices(mesh);
        let partial = with_error_scopes(&self.device, || self.run(mesh, &indices, mikkt, context))?;
        let Some(PartialTangents { welded_vertex, mut tangents }) = partial else {
            return GpuTangents::from_cpu(mesh, options, context, CpuFallback::Values);
        };
        let indexed = Mesh::triangles(mesh.positions(), mesh.normals(), mesh.uvs(), Indices::U32(&indices));
        let indexed = indexed.expect("the same triangles");
        let (report, cpu_corners) =
            gpu_resume::complete(&indexed, mikkt, welded_vertex, context, &mut tangents)?;
        let tangents = Tangents { corners: CornerTangents::from_per_corner(tangents), report };
        Ok(GpuTangents { tangents, cpu_corners, cpu_fallback: None })
    }

    /// The arrays between the stages for a mesh of one tile, for tests. Errors as for
    /// [`MikkTSpace::generate_tangents`].
    #[doc(hidden)]
    pub fn stage_arrays(
        &self,
        mesh: &Mesh<'_>,
        options: &MikkTSpaceOptions,
    ) -> Result<StageArrays, GpuError> {
        let (device, queue, context) = (&self.device, &self.queue, &Context::new());
        with_error_scopes(device, || {
            let StageRecording { vertices, tile } = self.single_tile(mesh, options)?;
            let record = |encoder: &mut CommandEncoder| {
                vertices.record(encoder);
                tile.record(encoder);
            };
            let [failures, welded] =
                ["failure_count", "welded_vertex"].map(|name| vertices.buffers.get(name));
            let [corners, neighbours, flags, seeds] =
                ["vertex_of_corner", "neighbours", "triangle_flags", "seed_of_corner"]
                    .map(|name| tile.buffers.get(name));
            let sources = [failures, welded, corners, neighbours, flags, seeds];
            let [failures, welded, corners, neighbours, flags, seeds] =
                submit(device, queue, record, sources, context)?
                    .map(|copy| copy.read::<u32>(device, context));
            Ok(StageArrays {
                failure_count: failures?[0],
                welded_vertex: welded?,
                vertex_of_corner: corners?,
                neighbours: neighbours?,
                triangle_flags: flags?,
                seed_of_corner: seeds?,
            })
        })
    }

    /// The commands for a mesh of one tile, for benchmarks. Errors as for [`MikkTSpace::generate_tangents`].
    #[doc(hidden)]
    pub fn recording(
        &self,
        mesh: &Mesh<'_>,
        options: &MikkTSpaceOptions,
    ) -> Result<StageRecording, GpuError> {
        with_error_scopes(&self.device, || self.single_tile(mesh, options))
    }

    fn single_tile(&self, mesh: &Mesh<'_>, options: &MikkTSpaceOptions) -> Result<StageRecording, GpuError> {
        let (device, programs) = (&self.device, &self.programs);
        let vertices = UploadedVertices::new(device, programs, mesh)?;
        let threshold_cosine = gpu_resume::threshold_cosine(options);
        let tile = Tile::new(device, programs, &vertices, &corner_indices(mesh), &[], threshold_cosine)?;
        Ok(StageRecording { vertices, tile })
    }

    /// Runs everything on the GPU. Returns none for values that only the CPU can weld.
    fn run(
        &self,
        mesh: &Mesh<'_>,
        indices: &[u32],
        options: &MikkTSpaceOptions,
        context: &Context,
    ) -> Result<Option<PartialTangents>, GpuError> {
        let tile_corners = 3 * self.triangles_per_tile()?;
        let threshold_cosine = gpu_resume::threshold_cosine(options);
        let limit = largest_buffer(&self.device.limits());
        if UploadedVertices::byte_length(mesh.vertex_count()) > limit {
            self.run_submeshes(mesh, indices, tile_corners, threshold_cosine, context)
        } else {
            self.run_tiles(mesh, indices, tile_corners, threshold_cosine, context)
        }
    }

    /// Errors: not even one triangle fits.
    fn triangles_per_tile(&self) -> Result<usize, GpuError> {
        let limit = largest_buffer(&self.device.limits());
        match (limit / BYTES_PER_TRIANGLE).min(self.tile_size.into()) {
            0 => Err(GpuError::BufferTooLarge { what: "a triangle", bytes: BYTES_PER_TRIANGLE, limit }),
            triangles => Ok(triangles as usize),
        }
    }

    /// Uploads all vertices at once, and then the triangles tile by tile.
    fn run_tiles(
        &self,
        mesh: &Mesh<'_>,
        indices: &[u32],
        tile_corners: usize,
        threshold_cosine: f32,
        context: &Context,
    ) -> Result<Option<PartialTangents>, GpuError> {
        let (device, queue) = (&self.device, &self.queue);
        let vertices = UploadedVertices::new(device, &self.programs, mesh)?;
        let sources = ["failure_count", "welded_vertex"].map(|name| vertices.buffers.get(name));
        let record = |encoder: &mut CommandEncoder| vertices.record(encoder);
        let [failures, welded] = submit(device, queue, record, sources, context)?;
        if failures.read::<u32>(device, context)? != [0] {
            return Ok(None);
        }
        let welded_vertex = welded.read(device, context)?;
        let is_shared = shared_vertices(indices, &welded_vertex, tile_corners);
        let mut tangents = Vec::with_capacity(indices.len());
        for indices in indices.chunks(tile_corners) {
            let tile = Tile::new(device, &self.programs, &vertices, indices, &is_shared, threshold_cosine)?;
            let sources = [tile.buffers.get("tangent_of_corner")];
            let record = |encoder: &mut CommandEncoder| tile.record(encoder);
            let [of_tile] = submit(device, queue, record, sources, context)?;
            tangents.extend(of_tile.read::<[f32; 4]>(device, context)?);
        }
        Ok(Some(PartialTangents { welded_vertex, tangents }))
    }

    /// As [`MikkTSpace::run_tiles`] for meshes whose vertices are too large for a buffer: each tile uploads
    /// the vertices that it uses.
    fn run_submeshes(
        &self,
        mesh: &Mesh<'_>,
        indices: &[u32],
        tile_corners: usize,
        threshold_cosine: f32,
        context: &Context,
    ) -> Result<Option<PartialTangents>, GpuError> {
        let (device, queue) = (&self.device, &self.queue);
        check(context)?;
        let Some(welded_vertex) = weld_on_cpu(mesh) else { return Ok(None) };
        check(context)?;
        let is_shared = shared_vertices(indices, &welded_vertex, tile_corners);
        let mut tangents = Vec::with_capacity(indices.len());
        for indices in indices.chunks(tile_corners) {
            let submesh = Submesh::new(indices);
            let vertices = UploadedVertices::of_submesh(device, &self.programs, mesh, &submesh)?;
            let is_shared = |&vertex: &u32| is_shared.get(welded_vertex[vertex as usize] as usize).copied();
            let is_shared: Vec<u32> = submesh.vertices.iter().filter_map(is_shared).collect();
            let tile =
                Tile::new(device, &self.programs, &vertices, &submesh.indices, &is_shared, threshold_cosine)?;
            let record = |encoder: &mut CommandEncoder| {
                vertices.record(encoder);
                tile.record(encoder);
            };
            let sources = [vertices.buffers.get("failure_count"), tile.buffers.get("tangent_of_corner")];
            let [failures, of_tile] = submit(device, queue, record, sources, context)?;
            if failures.read::<u32>(device, context)? != [0] {
                return Ok(None);
            }
            tangents.extend(of_tile.read::<[f32; 4]>(device, context)?);
        }
        Ok(Some(PartialTangents { welded_vertex, tangents }))
    }
}

/// For each vertex, 1 if it lies in several tiles. Empty if there is only one tile.
fn shared_vertices(indices: &[u32], welded_vertex: &[u32], tile_corners: usize) -> Vec<u32> {
    if indices.len() > tile_corners {
        shared_between_tiles(indices, welded_vertex, tile_corners)
    } else {
        Vec::new()
    }
}

impl GpuTangents {
    fn from_cpu(
        mesh: &Mesh<'_>,
        options: &TangentOptions,
        context: &mut Context,
        fallback: CpuFallback,
    ) -> Result<Self, GpuError> {
        let tangents = generate_tangents_with(mesh, options, context)?;
        Ok(Self { tangents, cpu_corners: mesh.corner_count(), cpu_fallback: Some(fallback) })
    }
}

/// The commands of all stages for a mesh of one tile.
#[doc(hidden)]
pub struct StageRecording {
    vertices: UploadedVertices,
    tile: Tile,
}

impl StageRecording {
    /// Records all stages.
    pub fn record(&self, encoder: &mut CommandEncoder) {
        self.vertices.record(encoder);
        self.tile.record(encoder);
    }
}

/// The arrays between the stages. `u32::MAX` stands for none.
#[doc(hidden)]
#[derive(Clone, Debug)]
pub struct StageArrays {
    /// The number of vertices that cannot be welded on the GPU. If it is not 0, the other arrays are
    /// unspecified.
    pub failure_count: u32,
    /// For each vertex, the first vertex that equals it.
    pub welded_vertex: Vec<u32>,
    /// For each corner, its welded vertex; none at degenerate triangles.
    pub vertex_of_corner: Vec<u32>,
    /// For each triangle, its neighbours across the edges 0-1, 1-2 and 2-0.
    pub neighbours: Vec<u32>,
    /// For each triangle: 1 if the UV map keeps its orientation, 2 if it is UV-degenerate.
    pub triangle_flags: Vec<u32>,
    /// For each corner, the first corner of its group.
    pub seed_of_corner: Vec<u32>,
}

/// The results of the GPU.
struct PartialTangents {
    welded_vertex: Vec<u32>,
    /// For each corner. The sign is zero if the GPU has deferred the corner to the CPU.
    tangents: Vec<[f32; 4]>,
}
