//! MikkTSpace on the GPU, bit for bit: what is plain there, what is rare on the CPU.

use std::borrow::Cow;

use bytemuck::{cast_slice, pod_collect_to_vec};
use darboux::{
    CornerTangents, Faces, Indices, Mesh, Method, TangentOptions, Tangents, elsewhere, generate_tangents,
};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{Buffer, BufferUsages, CommandEncoder, ComputePipeline, Device, Queue};

use crate::buffers::{Description, check_size};
use crate::device::{Copy, guarded};
use crate::evaluation::{Evaluation, EvaluationKernels, Grouped};
use crate::kernel::{Step, buffer, module, pipeline};
use crate::reals::Arithmetic;
use crate::topology::{Topology, TopologyKernels, WeldedMesh};
use crate::weld::{Weld, WeldKernels};
use crate::{AdapterSummary, Gpu, GpuError};

const FINISH: &[&str] = &[
    include_str!("../shaders/mesh.wgsl"),
    include_str!("../shaders/common.wgsl"),
    include_str!("../shaders/around.wgsl"),
    include_str!("../shaders/finish.wgsl"),
];

/// MikkTSpace, compiled for a device.
#[derive(Clone, Debug)]
pub struct MikkTSpace {
    device: Device,
    queue: Queue,
    weld: WeldKernels,
    topology: TopologyKernels,
    evaluation: EvaluationKernels,
    check_frames: ComputePipeline,
    store_tangents: ComputePipeline,
}

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

    /// The most triangles of a mesh that an adapter can do at once, by its largest binding.
    pub fn triangle_limit(adapter: &AdapterSummary) -> u64 {
        adapter.largest_binding / (3 * BYTES_OF_FRAME)
    }

    fn with_arithmetic(gpu: &Gpu, arithmetic: Arithmetic) -> Result<Self, GpuError> {
        let Gpu { device, queue, .. } = gpu;
        guarded(device, || {
            let finish = module(device, FINISH);
            Ok(Self {
                weld: WeldKernels::new(device),
                topology: TopologyKernels::new(device),
                evaluation: EvaluationKernels::new(device, arithmetic),
                check_frames: pipeline(device, &finish, "check_frames"),
                store_tangents: pipeline(device, &finish, "store_tangents"),
                device: device.clone(),
                queue: queue.clone(),
            })
        })
    }

    /// Computes the tangent of every corner: the bits of `darboux::generate_tangents`.
    ///
    /// Vertices that the order of triangles decides, that have several tangents or an unusable one, are left to the CPU. Waits for the device.
    /// Errors: the mesh is past a limit of the device or its memory; the device is lost.
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
        let Answer { refused, welded, mut tangents } =
            guarded(&self.device, || self.run(mesh, &indices, options))?;
        if refused > 0 {
            return Ok(Generated::left(mesh, options, Left::Values));
        }
        let indexed = Mesh::triangles(mesh.positions(), mesh.normals(), mesh.uvs(), Indices::U32(&indices));
        let indexed = indexed.expect("the same triangles");
        let (report, corners_of_cpu) = elsewhere::complete(&indexed, options, welded, &mut tangents);
        let tangents = Tangents { corners: CornerTangents::from_per_corner(tangents), report };
        Ok(Generated { tangents, corners_of_cpu, left_to_cpu: None })
    }

    /// The arrays between the stages of a mesh of triangles, for tests. Errors as for [`MikkTSpace::generate_tangents`].
    #[doc(hidden)]
    pub fn arrays(&self, mesh: &Mesh<'_>, options: &TangentOptions) -> Result<Arrays, GpuError> {
        guarded(&self.device, || {
            let device = &self.device;
            let work = Work::new(self, mesh, &indices(mesh), elsewhere::threshold_cosine(options))?;
            let mut encoder = device.create_command_encoder(&Default::default());
            work.record(&mut encoder);
            let Topology { welded_corners, neighbours, marks, seed_of_corner, .. } = &work.topology;
            let copies = [&work.counts, &work.weld.welded, welded_corners, neighbours, marks, seed_of_corner]
                .map(|buffer| Copy::record(device, &mut encoder, buffer));
            self.queue.submit([encoder.finish()]);
            let mut words = Vec::new();
            for copy in copies {
                words.push(copy.read(device, pod_collect_to_vec)?);
            }
            let [counts, welded, welded_corners, neighbours, marks, seed_of_corner] =
                words.try_into().expect("six");
            Ok(Arrays { refused: counts[0], welded, welded_corners, neighbours, marks, seed_of_corner })
        })
    }

    /// Everything up to what the CPU does.
    fn run(&self, mesh: &Mesh<'_>, indices: &[u32], options: &TangentOptions) -> Result<Answer, GpuError> {
        let device = &self.device;
        let work = Work::new(self, mesh, indices, elsewhere::threshold_cosine(options))?;
        let mut encoder = device.create_command_encoder(&Default::default());
        work.record(&mut encoder);
        let copies = [&work.counts, &work.weld.welded, &work.tangent_of_corner]
            .map(|buffer| Copy::record(device, &mut encoder, buffer));
        self.queue.submit([encoder.finish()]);
        let [counts, welded, tangents] = copies;
        Ok(Answer {
            refused: counts.read(device, |bytes| pod_collect_to_vec::<u8, u32>(bytes)[0])?,
            welded: welded.read(device, pod_collect_to_vec)?,
            tangents: tangents.read(device, pod_collect_to_vec)?,
        })
    }
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
struct Answer {
    /// Vertices that cannot be welded there; with any, the rest says nothing.
    refused: u32,
    welded: Vec<u32>,
    tangents: Vec<[f32; 4]>,
}

/// One mesh on the device.
struct Work {
    counts: Buffer,
    weld: Weld,
    topology: Topology,
    evaluation: Evaluation,
    finish: [Step; 2],
    /// Tangents and signs; signs of zero where the CPU has to decide.
    tangent_of_corner: Buffer,
}

impl Work {
    /// Uploads the mesh. Errors: a buffer is past a limit of the device.
    fn new(
        kernels: &MikkTSpace,
        mesh: &Mesh<'_>,
        indices: &[u32],
        threshold_cosine: f32,
    ) -> Result<Self, GpuError> {
        let device = &kernels.device;
        let (vertex_count, triangle_count) = (mesh.vertex_count() as u32, mesh.face_count() as u32);
        let description = Description::packed(vertex_count, triangle_count);
        check_size(device, "vertices", 4 * u64::from(WORDS_OF_VERTEX) * u64::from(vertex_count))?;
        check_size(device, "the tangents", 4 * u64::from(WORDS_OF_TANGENT) * 3 * u64::from(triangle_count))?;
        let vertices = upload(device, "vertices", cast_slice(&packed(mesh)));
        let indices = upload(device, "indices", cast_slice(indices));
        let counts = buffer(device, "counts", 1);
        let words = description.uniform(device);
        let weld = Weld::new(device, &kernels.weld, &description, &words, &vertices, &counts)?;
        let mesh = WeldedMesh {
            description,
            words: &words,
            vertices: &vertices,
            indices: &indices,
            welded: &weld.welded,
        };
        let topology = Topology::new(device, &kernels.topology, &mesh)?;
        let grouped = Grouped {
            vertices: &vertices,
            welded_corners: &topology.welded_corners,
            ends: &topology.adjacency.ends,
            triangle_of_entry: &topology.adjacency.triangle_of_entry,
            marks: &topology.marks,
            seed_of_corner: &topology.seed_of_corner,
        };
        let evaluation =
            Evaluation::new(device, &kernels.evaluation, &description, threshold_cosine, &grouped)?;
        let tangent_of_corner = buffer(device, "tangent_of_corner", WORDS_OF_TANGENT * 3 * triangle_count);
        let welded_words = description.of_welded_corners().uniform(device);
        let both = [(0, &welded_words), (1, grouped.welded_corners), (3, &evaluation.frames)];
        let checking =
            [(2, grouped.ends), (4, &vertices), (5, grouped.triangle_of_entry), (7, &topology.is_left)];
        let storing = [(6, grouped.marks), (7, &topology.is_left), (8, &tangent_of_corner)];
        let step = |pipeline, buffers: &[(u32, &Buffer)]| {
            Step::new(device, pipeline, &[&both[..], buffers].concat(), 3 * triangle_count)
        };
        let finish = [step(&kernels.check_frames, &checking), step(&kernels.store_tangents, &storing)];
        Ok(Self { counts, weld, topology, evaluation, finish, tangent_of_corner })
    }

    fn record(&self, encoder: &mut CommandEncoder) {
        encoder.clear_buffer(&self.counts, 0, None);
        self.weld.record(encoder);
        self.topology.record(encoder);
        self.evaluation.record_derivatives(encoder);
        self.topology.record_groups(encoder);
        self.evaluation.record_frames(encoder);
        self.finish.iter().for_each(|step| step.record(encoder));
    }
}

/// Of one corner, in the largest buffer of all.
const BYTES_OF_FRAME: u64 = 32;
const WORDS_OF_VERTEX: u32 = 8;
const WORDS_OF_TANGENT: u32 = 4;

fn upload(device: &Device, label: &str, contents: &[u8]) -> Buffer {
    let usage = BufferUsages::STORAGE;
    device.create_buffer_init(&BufferInitDescriptor { label: Some(label), contents, usage })
}

/// The vertices, as [`Description::packed`] describes them.
fn packed(mesh: &Mesh<'_>) -> Vec<[f32; WORDS_OF_VERTEX as usize]> {
    let vertex = |vertex| {
        let ([x, y, z], [a, b, c]) = (mesh.positions().get(vertex), mesh.normals().get(vertex));
        let [u, v] = mesh.uvs().get(vertex);
        [x, y, z, a, b, c, u, v]
    };
    (0..mesh.vertex_count()).map(vertex).collect()
}

fn indices<'a>(mesh: &Mesh<'a>) -> Cow<'a, [u32]> {
    match mesh.indices() {
        Indices::Unindexed => (0..mesh.corner_count() as u32).collect(),
        Indices::U16(list) => list.iter().map(|&index| index.into()).collect(),
        Indices::U32(list) => list.into(),
    }
}
