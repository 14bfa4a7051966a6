//! MikkTSpace on the GPU, bit for bit: what is plain there, what is rare on the CPU.

use std::borrow::Cow;

use darboux::internal::gpu_resume;
use darboux::{CornerTangents, Faces, Indices, Mesh, Method, TangentOptions, Tangents, generate_tangents};
use wgpu::{CommandEncoder, Device, Queue};

use crate::device::mesh_buffers::largest_buffer;
use crate::device::precision::Arithmetic;
use crate::device::readback::{guarded, submit};
use crate::mikktspace::tiles::{BYTES_OF_TRIANGLE, Cut, Kernels, Piece, Vertices, in_several, weld};
use crate::{AdapterSummary, Gpu, GpuError};

/// MikkTSpace, compiled for a device.
#[derive(Clone, Debug)]
pub struct MikkTSpace {
    device: Device,
    queue: Queue,
    kernels: Kernels,
    /// Triangles of a piece at most, whatever the device holds.
    piece: u32,
}

/// No mesh has more triangles; the stress build cuts most.
const PIECE: u32 = if cfg!(small_limits) { 200 } else { (1 << 30) / 3 };

/// What [`MikkTSpace::generate_tangents`] gives.
#[derive(Clone, Debug)]
pub struct Generated {
    /// The tangents of `darboux::generate_tangents`, and its report.
    pub tangents: Tangents,
    /// How many corners the CPU did.
    pub corners_of_cpu: usize,
    /// Why the CPU did them all, if it did.
    pub left_to_cpu: Option<Left>,
}

/// Why a whole mesh is left to the CPU.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Left {
    /// A method other than MikkTSpace.
    Method,
    /// Faces that are not triangles.
    Faces,
    /// Values that are not finite or larger than 1e38, or equal vertices whose zeros differ in sign: only the CPU welds them in the order
    /// of the reference.
    Values,
}

impl std::fmt::Display for Left {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Method => "the method runs on the CPU only",
            Self::Faces => "faces that are not triangles are done on the CPU",
            Self::Values => {
                "its vertices hold NaN, infinity, huge numbers, or equal positions whose zeros differ in sign"
            }
        })
    }
}

impl MikkTSpace {
    /// Compiles the shaders. Errors: the device refuses them.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Self::with_arithmetic(gpu, Arithmetic::Exact)
    }

    /// The most triangles that an adapter does at once, by its largest binding; larger meshes are cut into pieces.
    pub fn triangle_limit(adapter: &AdapterSummary) -> u64 {
        adapter.largest_binding / BYTES_OF_TRIANGLE
    }

    /// The same in pieces of so many triangles at most, for tests.
    #[doc(hidden)]
    pub fn in_pieces_of(self, triangles: u32) -> Self {
        Self { piece: triangles, ..self }
    }

    /// As [`MikkTSpace::new`], in another arithmetic.
    #[doc(hidden)]
    pub fn with_arithmetic(gpu: &Gpu, arithmetic: Arithmetic) -> Result<Self, GpuError> {
        let Gpu { device, queue, .. } = gpu;
        guarded(device, || {
            Ok(Self {
                device: device.clone(),
                queue: queue.clone(),
                kernels: Kernels::new(device, arithmetic),
                piece: PIECE,
            })
        })
    }

    /// Computes the tangent of every corner: the bits of `darboux::generate_tangents`.
    ///
    /// Vertices that the order of triangles decides, that have several tangents or an unusable one, or lie in several pieces of a mesh that is
    /// too large for the device, are left to the CPU. Waits for the device. Errors: the mesh is past the device's memory; the device is
    /// lost, or binds no buffer that a triangle fits in.
    pub fn generate_tangents(
        &self,
        mesh: &Mesh<'_>,
        options: &TangentOptions,
    ) -> Result<Generated, GpuError> {
        if options.method != Method::MikkTSpace {
            return Ok(Generated::left(mesh, options, Left::Method));
        }
        if !matches!(mesh.faces(), Faces::Triangles) {
            return Ok(Generated::left(mesh, options, Left::Faces));
        }
        if mesh.face_count() == 0 {
            let tangents = generate_tangents(mesh, options);
            return Ok(Generated { tangents, corners_of_cpu: 0, left_to_cpu: None });
        }
        let indices = indices(mesh);
        let begun = guarded(&self.device, || self.run(mesh, &indices, options))?;
        let Some(Begun { welded, mut tangents }) = begun else {
            return Ok(Generated::left(mesh, options, Left::Values));
        };
        let indexed = Mesh::triangles(mesh.positions(), mesh.normals(), mesh.uvs(), Indices::U32(&indices));
        let indexed = indexed.expect("the same triangles");
        let (report, corners_of_cpu) = gpu_resume::complete(&indexed, options, welded, &mut tangents);
        let tangents = Tangents { corners: CornerTangents::from_per_corner(tangents), report };
        Ok(Generated { tangents, corners_of_cpu, left_to_cpu: None })
    }

    /// The arrays between the stages of a mesh of triangles, for tests. Errors as for [`MikkTSpace::generate_tangents`].
    #[doc(hidden)]
    pub fn arrays(&self, mesh: &Mesh<'_>, options: &TangentOptions) -> Result<Arrays, GpuError> {
        let (device, queue) = (&self.device, &self.queue);
        guarded(device, || {
            let vertices = Vertices::new(device, &self.kernels, mesh)?;
            let threshold_cosine = gpu_resume::threshold_cosine(options);
            let piece = Piece::new(device, &self.kernels, &vertices, &indices(mesh), &[], threshold_cosine)?;
            let record = |encoder: &mut CommandEncoder| {
                vertices.record(encoder);
                piece.record(encoder);
            };
            let [refused, welded] = ["refused", "welded"].map(|name| vertices.buffers.of(name));
            let [corners, neighbours, marks, seeds] =
                ["vertex_of_corner", "neighbours", "marks", "seed_of_corner"]
                    .map(|name| piece.buffers.of(name));
            let wanted = [refused, welded, corners, neighbours, marks, seeds];
            let [refused, welded, corners, neighbours, marks, seeds] =
                submit(device, queue, record, wanted).map(|copy| copy.read::<u32>(device));
            Ok(Arrays {
                refused: refused?[0],
                welded: welded?,
                welded_corners: corners?,
                neighbours: neighbours?,
                marks: marks?,
                seed_of_corner: seeds?,
            })
        })
    }

    /// What the device does for a mesh of one piece, to be measured. Errors as for [`MikkTSpace::generate_tangents`].
    #[doc(hidden)]
    pub fn recorded(&self, mesh: &Mesh<'_>, options: &TangentOptions) -> Result<Recorded, GpuError> {
        let device = &self.device;
        guarded(device, || {
            let vertices = Vertices::new(device, &self.kernels, mesh)?;
            let threshold_cosine = gpu_resume::threshold_cosine(options);
            let piece = Piece::new(device, &self.kernels, &vertices, &indices(mesh), &[], threshold_cosine)?;
            Ok(Recorded { vertices, piece })
        })
    }

    /// Everything up to what the CPU does; none where only the CPU can weld.
    fn run(
        &self,
        mesh: &Mesh<'_>,
        indices: &[u32],
        options: &TangentOptions,
    ) -> Result<Option<Begun>, GpuError> {
        let corners = 3 * self.triangles_at_once()?;
        let threshold_cosine = gpu_resume::threshold_cosine(options);
        let limit = largest_buffer(&self.device.limits());
        if Vertices::bytes(mesh.vertex_count()) > limit {
            self.run_cut(mesh, indices, corners, threshold_cosine)
        } else {
            self.run_together(mesh, indices, corners, threshold_cosine)
        }
    }

    /// The triangles of a piece. Errors: not even one fits.
    fn triangles_at_once(&self) -> Result<usize, GpuError> {
        let limit = largest_buffer(&self.device.limits());
        match (limit / BYTES_OF_TRIANGLE).min(self.piece.into()) {
            0 => Err(GpuError::PastLimit { what: "a triangle", bytes: BYTES_OF_TRIANGLE, limit }),
            triangles => Ok(triangles as usize),
        }
    }

    /// All vertices on the device, the triangles in pieces of so many corners.
    fn run_together(
        &self,
        mesh: &Mesh<'_>,
        indices: &[u32],
        corners: usize,
        threshold_cosine: f32,
    ) -> Result<Option<Begun>, GpuError> {
        let (device, queue) = (&self.device, &self.queue);
        let vertices = Vertices::new(device, &self.kernels, mesh)?;
        let wanted = ["refused", "welded"].map(|name| vertices.buffers.of(name));
        let [refused, welded] = submit(device, queue, |encoder| vertices.record(encoder), wanted);
        if refused.read::<u32>(device)? != [0] {
            return Ok(None);
        }
        let welded = welded.read(device)?;
        let is_left = left(indices, &welded, corners);
        let mut tangents = Vec::with_capacity(indices.len());
        for indices in indices.chunks(corners) {
            let piece = Piece::new(device, &self.kernels, &vertices, indices, &is_left, threshold_cosine)?;
            let wanted = [piece.buffers.of("tangent_of_corner")];
            let [of_piece] = submit(device, queue, |encoder| piece.record(encoder), wanted);
            tangents.extend(of_piece.read::<[f32; 4]>(device)?);
        }
        Ok(Some(Begun { welded, tangents }))
    }

    /// As [`MikkTSpace::run_together`], each piece with its own vertices.
    fn run_cut(
        &self,
        mesh: &Mesh<'_>,
        indices: &[u32],
        corners: usize,
        threshold_cosine: f32,
    ) -> Result<Option<Begun>, GpuError> {
        let (device, queue) = (&self.device, &self.queue);
        let Some(welded) = weld(mesh) else { return Ok(None) };
        let is_left = left(indices, &welded, corners);
        let mut tangents = Vec::with_capacity(indices.len());
        for indices in indices.chunks(corners) {
            let cut = Cut::new(indices);
            let vertices = Vertices::of_cut(device, &self.kernels, mesh, &cut)?;
            let is_left = |&vertex: &u32| is_left.get(welded[vertex as usize] as usize).copied();
            let is_left: Vec<u32> = cut.vertices.iter().filter_map(is_left).collect();
            let piece =
                Piece::new(device, &self.kernels, &vertices, &cut.indices, &is_left, threshold_cosine)?;
            let record = |encoder: &mut CommandEncoder| {
                vertices.record(encoder);
                piece.record(encoder);
            };
            let wanted = [vertices.buffers.of("refused"), piece.buffers.of("tangent_of_corner")];
            let [refused, of_piece] = submit(device, queue, record, wanted);
            if refused.read::<u32>(device)? != [0] {
                return Ok(None);
            }
            tangents.extend(of_piece.read::<[f32; 4]>(device)?);
        }
        Ok(Some(Begun { welded, tangents }))
    }
}

/// Of every vertex: 1 where several pieces of so many corners have it; nothing where there is one piece.
fn left(indices: &[u32], welded: &[u32], corners: usize) -> Vec<u32> {
    if indices.len() > corners { in_several(indices, welded, corners) } else { Vec::new() }
}

impl Generated {
    fn left(mesh: &Mesh<'_>, options: &TangentOptions, why: Left) -> Self {
        Self {
            tangents: generate_tangents(mesh, options),
            corners_of_cpu: mesh.corner_count(),
            left_to_cpu: Some(why),
        }
    }
}

/// The stages of one mesh.
#[doc(hidden)]
pub struct Recorded {
    vertices: Vertices,
    piece: Piece,
}

impl Recorded {
    /// Records all stages.
    pub fn record(&self, encoder: &mut CommandEncoder) {
        self.vertices.record(encoder);
        self.piece.record(encoder);
    }
}

/// What stages leave behind.
#[doc(hidden)]
#[derive(Clone, Debug)]
pub struct Arrays {
    /// Vertices that cannot be welded there; with any, the rest says nothing.
    pub refused: u32,
    /// Of every vertex.
    pub welded: Vec<u32>,
    /// Of every corner; all ones at degenerate triangles, in all that follows too.
    pub welded_corners: Vec<u32>,
    /// Of every triangle across its edges 0-1, 1-2, 2-0; all ones without one.
    pub neighbours: Vec<u32>,
    /// Of every triangle: 1 where it keeps its orientation, 2 where it is UV-degenerate.
    pub marks: Vec<u32>,
    /// The first corner of each corner's group; all ones without one.
    pub seed_of_corner: Vec<u32>,
}

/// What comes back from the device.
struct Begun {
    welded: Vec<u32>,
    /// Signs are zero where the CPU has to decide.
    tangents: Vec<[f32; 4]>,
}

/// The vertex of every corner.
pub(crate) fn indices<'a>(mesh: &Mesh<'a>) -> Cow<'a, [u32]> {
    match mesh.indices() {
        Indices::Unindexed => (0..mesh.corner_count() as u32).collect(),
        Indices::U16(list) => list.iter().map(|&index| index.into()).collect(),
        Indices::U32(list) => list.into(),
    }
}
