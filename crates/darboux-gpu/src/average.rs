//! `Method::Average` and `Method::Lengyel` of the core on the GPU: each vertex gets the sum of the tangents
//! and bitangents of its triangles, made unit before they are added or not. One thread computes one vertex.

use wgpu::{Buffer, CommandEncoder, ComputePipeline, Device};

use crate::device::buffers::{check_size, storage_buffer};
use crate::device::kernel::{Dispatch, MAX_ITERATIONS, compute_pipeline, shader_module};
use crate::device::mesh_buffers::{Destination, MeshBuffers, MeshUniform};
use crate::error::GpuError;
use crate::mikktspace::adjacency::{Adjacency, AdjacencyKernels};

/// How a vertex finds its triangles. Both ways give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Search {
    /// Each vertex tests all triangles. The time is proportional to vertices times triangles, the memory is
    /// 64 bytes per vertex.
    ///
    /// Programs want the adjacency table, which is faster from about 70 vertices on. This way is the oracle
    /// that its order is tested against bit for bit, which the core is not (its floats may differ from the
    /// device's), and the slow way that lesson 10 of docs/learn measures.
    BruteForce,
    /// Each vertex reads its range of an adjacency table, which the GPU builds. The memory is 4 bytes per
    /// vertex and 24 per triangle.
    Adjacency,
}

/// `Method::Average` or `Method::Lengyel` of the core per vertex, compiled for a device: the direction of the
/// sum of what the triangles around a vertex add, in the plane of its normal.
///
/// The core splits a vertex with triangles of both UV orientations. Here such a vertex gets the frame of the
/// orientation with more triangles, or of the unmirrored one if both have as many, and is counted; split the
/// vertices first to avoid this (`darboux::split_vertices`). A vertex without a direction, such as an unused
/// one, gets a direction perpendicular to its normal, or (1, 0, 0), and is counted too.
#[derive(Clone, Debug)]
pub struct Average {
    device: Device,
    write_in_place: ComputePipeline,
    write_to_buffer: ComputePipeline,
    search: SearchKernels,
}

/// The kernels of the two ways to search.
#[derive(Clone, Debug)]
enum SearchKernels {
    /// Adds the triangles of a range to the sums of every vertex.
    BruteForce(ComputePipeline),
    Adjacency(Box<AdjacencyKernels>),
}

/// [`Average`] with the buffers of one mesh. It can be recorded any number of times, without allocation.
#[derive(Clone, Debug)]
pub struct AverageOfMesh {
    /// None for brute force and for empty meshes.
    adjacency: Option<Adjacency>,
    /// The sums of every vertex, for brute force. They are cleared before each run.
    sums: Option<Buffer>,
    dispatches: Vec<Dispatch>,
    counts: Buffer,
}

impl Average {
    /// Compiles `Method::Average`: every triangle adds the unit vectors along dP/du and dP/dv.
    pub fn new(device: &Device, search: Search) -> Self {
        Self::compile(device, UNIT_TERMS, search)
    }

    /// Compiles `Method::Lengyel`: every triangle adds dP/du and dP/dv, not normalised, so that triangles
    /// with little UV area for their size count more.
    ///
    /// Source: E. Lengyel, "Computing Tangent Space Basis Vectors for an Arbitrary Mesh", 2001.
    pub fn lengyel(device: &Device, search: Search) -> Self {
        Self::compile(device, LENGYEL_TERMS, search)
    }

    /// `terms`: [`UNIT_TERMS`] or [`LENGYEL_TERMS`].
    fn compile(device: &Device, terms: &'static str, search: Search) -> Self {
        let compile = |storage, name| {
            compute_pipeline(device, &shader_module(device, &shader_files(terms, search, storage)), name)
        };
        let (last, kernels) = match search {
            Search::BruteForce => {
                ("store_frames", SearchKernels::BruteForce(compile(WRITE_IN_PLACE, "brute_force")))
            }
            Search::Adjacency => {
                ("gather", SearchKernels::Adjacency(Box::new(AdjacencyKernels::new(device))))
            }
        };
        Self {
            device: device.clone(),
            write_in_place: compile(WRITE_IN_PLACE, last),
            write_to_buffer: compile(WRITE_TO_BUFFER, last),
            search: kernels,
        }
    }

    /// Checks the buffers and creates everything that recording needs.
    ///
    /// Errors: an offset or stride that is not a multiple of 4; parts of a vertex that overlap or do not lie
    /// in their buffer; a buffer without `BufferUsages::STORAGE`, that would be read and written at once,
    /// or that is past a limit of the device; a number of indices that is not a multiple of 3, or above
    /// 2^30 - 1.
    pub fn of_mesh(
        &self,
        mesh: &MeshBuffers<'_>,
        destination: &Destination<'_>,
    ) -> Result<AverageOfMesh, GpuError> {
        let device = &self.device;
        let description = MeshUniform::checked(device, mesh, destination)?;
        let counts = storage_buffer(device, "counts", 3);
        let mut average = AverageOfMesh { adjacency: None, sums: None, dispatches: Vec::new(), counts };
        if description.vertex_count == 0 || description.triangle_count == 0 {
            return Ok(average);
        }
        let uniform = description.upload(device);
        let mut buffers = vec![(0, &uniform), (2, mesh.vertices), (4, &average.counts)];
        let last = match *destination {
            Destination::Vertices(_) => &self.write_in_place,
            Destination::Buffer { buffer, .. } => {
                buffers.push((3, buffer));
                &self.write_to_buffer
            }
        };
        match &self.search {
            SearchKernels::BruteForce(pipeline) => {
                let bytes = 4 * u64::from(WORDS_PER_SUMS) * u64::from(mesh.vertex_count);
                check_size(device, "sums", bytes)?;
                let sums = storage_buffer(device, "sums", WORDS_PER_SUMS * mesh.vertex_count);
                let sums = average.sums.insert(sums);
                average.dispatches = self.add_triangle_ranges(pipeline, &description, mesh, sums);
                buffers.push((5, sums));
            }
            SearchKernels::Adjacency(kernels) => {
                let adjacency = Adjacency::new(device, kernels, &description, &uniform, mesh.indices)?;
                let adjacency = average.adjacency.insert(adjacency);
                buffers.extend([(1, mesh.indices), (5, &adjacency.ends), (6, &adjacency.triangles)]);
            }
        }
        average.dispatches.push(Dispatch::new(device, last, &buffers, mesh.vertex_count));
        Ok(average)
    }

    /// One dispatch per range of [`MAX_ITERATIONS`] triangles.
    fn add_triangle_ranges(
        &self,
        pipeline: &ComputePipeline,
        description: &MeshUniform,
        mesh: &MeshBuffers<'_>,
        sums: &Buffer,
    ) -> Vec<Dispatch> {
        let range = |first: u32| {
            let uniform = description.triangle_range(first, MAX_ITERATIONS).upload(&self.device);
            let buffers = [(0, &uniform), (1, mesh.indices), (2, mesh.vertices), (5, sums)];
            Dispatch::new(&self.device, pipeline, &buffers, description.vertex_count)
        };
        (0..description.triangle_count).step_by(MAX_ITERATIONS as usize).map(range).collect()
    }
}

impl AverageOfMesh {
    /// Records everything: the adjacency table, if there is one, and the frames. Call this at least once, and
    /// after the indices changed.
    pub fn record(&self, encoder: &mut CommandEncoder) {
        if let Some(adjacency) = &self.adjacency {
            adjacency.record(encoder);
        }
        self.record_frames(encoder);
    }

    /// Records only the frames, for vertices that have moved.
    pub fn record_frames(&self, encoder: &mut CommandEncoder) {
        encoder.clear_buffer(&self.counts, 0, None);
        if let Some(sums) = &self.sums {
            encoder.clear_buffer(sums, 0, None);
        }
        self.dispatches.iter().for_each(|dispatch| dispatch.record(encoder));
    }

    /// A buffer of three counts, with `BufferUsages::COPY_SRC`: vertices without a direction; vertices with
    /// triangles of both UV orientations; vertices with more than 32,768 triangles, which the adjacency
    /// search leaves without a direction.
    pub fn counts(&self) -> &Buffer {
        &self.counts
    }
}

/// The size of the shader's `Sums`.
const WORDS_PER_SUMS: u32 = 16;

const WRITE_IN_PLACE: &str = include_str!("../shaders/average/write_in_place.wgsl");
pub(crate) const WRITE_TO_BUFFER: &str = include_str!("../shaders/average/write_to_buffer.wgsl");

pub(crate) const UNIT_TERMS: &str = include_str!("../shaders/average/unit_terms.wgsl");
pub(crate) const LENGYEL_TERMS: &str = include_str!("../shaders/average/lengyel_terms.wgsl");

/// The files of the shader. `terms`: [`UNIT_TERMS`] or [`LENGYEL_TERMS`]. `storage`: [`WRITE_IN_PLACE`] or
/// [`WRITE_TO_BUFFER`].
pub(crate) fn shader_files(terms: &'static str, search: Search, storage: &'static str) -> [&'static str; 8] {
    [
        include_str!("../shaders/device/mesh.wgsl"),
        include_str!("../shaders/precision/device_floats.wgsl"),
        include_str!("../shaders/precision/correct_rounding.wgsl"),
        storage,
        terms,
        include_str!("../shaders/average/sums.wgsl"),
        include_str!("../shaders/average/frame.wgsl"),
        match search {
            Search::BruteForce => include_str!("../shaders/average/brute_force.wgsl"),
            Search::Adjacency => include_str!("../shaders/average/gather.wgsl"),
        },
    ]
}

/// The files of both methods and of both ways to write, for tests without a device.
#[cfg(test)]
pub(crate) fn all_shader_files(search: Search) -> [[&'static str; 8]; 4] {
    [
        shader_files(UNIT_TERMS, search, WRITE_IN_PLACE),
        shader_files(UNIT_TERMS, search, WRITE_TO_BUFFER),
        shader_files(LENGYEL_TERMS, search, WRITE_IN_PLACE),
        shader_files(LENGYEL_TERMS, search, WRITE_TO_BUFFER),
    ]
}
