//! The mean of the adjacent triangles' unit tangents and bitangents: one thread per vertex.

use wgpu::{Buffer, CommandEncoder, ComputePipeline, Device};

use crate::device::kernel::{MAX_TURNS, Step, buffer, module, pipeline};
use crate::device::mesh_buffers::{Description, check_size, describe};
use crate::mikktspace::adjacency::{Adjacency, AdjacencyKernels};
use crate::{Destination, GpuError, MeshBuffers};

/// How a vertex finds its triangles. Both give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Search {
    /// It looks at all of them: a time that grows with the product of vertices and triangles, and 64 bytes per vertex.
    BruteForce,
    /// It looks them up in a table, which is made on the GPU: 4 bytes per vertex and 24 per triangle.
    Adjacency,
}

/// `Method::Average` of the core, per vertex, compiled for a device.
///
/// Where both UV orientations meet the core splits a vertex; here it has the frame of the orientation with more triangles, the unmirrored
/// one of as many, and is counted: split such vertices first (`darboux::split_vertices`). A vertex without a direction, unused ones
/// among them, has a perpendicular of its normal, or (1, 0, 0), and is counted.
#[derive(Clone, Debug)]
pub struct Average {
    device: Device,
    in_place: ComputePipeline,
    to_second_buffer: ComputePipeline,
    way: Way,
}

/// What is different between the two ways to search.
#[derive(Clone, Debug)]
enum Way {
    /// What adds up.
    BruteForce(ComputePipeline),
    Adjacency(Box<AdjacencyKernels>),
}

/// [`Average`] of one mesh: recorded as often as its vertices change, without any allocation.
#[derive(Clone, Debug)]
pub struct AverageOfMesh {
    /// None for brute force, and where there is nothing to do.
    adjacency: Option<Adjacency>,
    /// Sums that begin at zero.
    sums: Option<Buffer>,
    steps: Vec<Step>,
    counts: Buffer,
}

impl Average {
    /// Compiles the shaders.
    pub fn new(device: &Device, search: Search) -> Self {
        let compile = |storage, name| pipeline(device, &module(device, &files(search, storage)), name);
        let (last, way) = match search {
            Search::BruteForce => ("store_frames", Way::BruteForce(compile(IN_PLACE, "brute_force"))),
            Search::Adjacency => ("gather", Way::Adjacency(Box::new(AdjacencyKernels::new(device)))),
        };
        Self {
            device: device.clone(),
            in_place: compile(IN_PLACE, last),
            to_second_buffer: compile(SECOND_BUFFER, last),
            way,
        }
    }

    /// Checks the buffers and makes what recording needs.
    ///
    /// Errors: places that are not whole words, overlap or do not lie in their buffer; a buffer that shaders may not use, that would be
    /// read and written at once, or that is past a limit of the device; indices that are not whole triangles, or more than 2^30 - 1.
    pub fn of_mesh(
        &self,
        mesh: &MeshBuffers<'_>,
        destination: &Destination<'_>,
    ) -> Result<AverageOfMesh, GpuError> {
        let description = describe(&self.device, mesh, destination)?;
        let counts = buffer(&self.device, "counts", 3);
        let mut made = AverageOfMesh { adjacency: None, sums: None, steps: Vec::new(), counts };
        if description.vertex_count == 0 || description.triangle_count == 0 {
            return Ok(made);
        }
        let words = description.uniform(&self.device);
        let mut buffers = vec![(0, &words), (2, mesh.vertices), (4, &made.counts)];
        let last = match *destination {
            Destination::Vertices(_) => &self.in_place,
            Destination::Buffer { buffer, .. } => {
                buffers.push((3, buffer));
                &self.to_second_buffer
            }
        };
        match &self.way {
            Way::BruteForce(pieces) => {
                check_size(
                    &self.device,
                    "sums",
                    4 * u64::from(WORDS_OF_SUMS) * u64::from(mesh.vertex_count),
                )?;
                let sums = made.sums.insert(buffer(&self.device, "sums", WORDS_OF_SUMS * mesh.vertex_count));
                made.steps = self.pieces(pieces, &description, mesh, sums);
                buffers.push((5, sums));
            }
            Way::Adjacency(kernels) => {
                let adjacency = Adjacency::new(&self.device, kernels, &description, &words, mesh.indices)?;
                let adjacency = made.adjacency.insert(adjacency);
                buffers.extend([(1, mesh.indices), (5, &adjacency.ends), (6, &adjacency.triangle_of_entry)]);
            }
        }
        made.steps.push(Step::new(&self.device, last, &buffers, mesh.vertex_count));
        Ok(made)
    }

    /// One step per piece of the triangles.
    fn pieces(
        &self,
        pipeline: &ComputePipeline,
        whole: &Description,
        mesh: &MeshBuffers<'_>,
        sums: &Buffer,
    ) -> Vec<Step> {
        let piece = |first: u32| {
            let words = whole.piece(first, MAX_TURNS).uniform(&self.device);
            let buffers = [(0, &words), (1, mesh.indices), (2, mesh.vertices), (5, sums)];
            Step::new(&self.device, pipeline, &buffers, whole.vertex_count)
        };
        (0..whole.triangle_count).step_by(MAX_TURNS as usize).map(piece).collect()
    }
}

impl AverageOfMesh {
    /// Records everything: the table of triangles, if there is one, and the frames. Once at least, and after a change of indices.
    pub fn record(&self, encoder: &mut CommandEncoder) {
        if let Some(adjacency) = &self.adjacency {
            adjacency.record(encoder);
        }
        self.record_frames(encoder);
    }

    /// Records the frames alone, for vertices that moved.
    pub fn record_frames(&self, encoder: &mut CommandEncoder) {
        encoder.clear_buffer(&self.counts, 0, None);
        if let Some(sums) = &self.sums {
            encoder.clear_buffer(sums, 0, None);
        }
        self.steps.iter().for_each(|step| step.record(encoder));
    }

    /// Three words to copy from: vertices without a direction; vertices of both UV orientations; vertices of more than 32,768 triangles,
    /// which a table cannot serve: they have no direction.
    pub fn counts(&self) -> &Buffer {
        &self.counts
    }
}

/// The shader's `Sums`.
const WORDS_OF_SUMS: u32 = 16;

const IN_PLACE: &str = include_str!("../shaders/average/write_in_place.wgsl");
pub(crate) const SECOND_BUFFER: &str = include_str!("../shaders/average/write_to_buffer.wgsl");

/// The files of a shader, by search and where frames go.
pub(crate) fn files(search: Search, storage: &'static str) -> [&'static str; 7] {
    [
        include_str!("../shaders/device/mesh.wgsl"),
        include_str!("../shaders/precision/device_floats.wgsl"),
        include_str!("../shaders/precision/correct_rounding.wgsl"),
        storage,
        include_str!("../shaders/average/sums.wgsl"),
        include_str!("../shaders/average/frame.wgsl"),
        match search {
            Search::BruteForce => include_str!("../shaders/average/brute_force.wgsl"),
            Search::Adjacency => include_str!("../shaders/average/gather.wgsl"),
        },
    ]
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::device::kernel::text;
    use crate::device::prefix_sum::SCAN;

    #[test]
    fn shaders_are_valid_without_a_device() {
        for search in [Search::BruteForce, Search::Adjacency] {
            validate(&files(search, IN_PLACE));
            validate(&files(search, SECOND_BUFFER));
        }
        validate(SCAN);
        validate(&[
            "fn zero() -> u32 { return 0u; }",
            include_str!("../shaders/precision/device_floats.wgsl"),
            include_str!("../shaders/precision/correct_rounding.wgsl"),
            include_str!("../shaders/precision/uint64.wgsl"),
            include_str!("../shaders/precision/soft_float.wgsl"),
            include_str!("../shaders/precision/arccosine.wgsl"),
        ]);
    }

    pub(crate) fn validate(files: &[&str]) {
        let text = text(files);
        let module = naga::front::wgsl::parse_str(&text)
            .unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)));
        let mut validator =
            naga::valid::Validator::new(Default::default(), naga::valid::Capabilities::empty());
        validator.validate(&module).unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)));
    }
}
