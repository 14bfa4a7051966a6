//! A mesh on the device: its vertices at once, its triangles in pieces that fit.

use bytemuck::cast_slice;
use darboux::Mesh;
use wgpu::{Buffer, BufferUsages, CommandEncoder, ComputePipeline, Device, Limits};

use crate::GpuError;
use crate::buffers::{Description, check_size};
use crate::evaluation::{Evaluation, EvaluationKernels, Grouped};
use crate::kernel::{Step, buffer, filled, module, pipeline};
use crate::reals::Arithmetic;
use crate::topology::{Topology, TopologyKernels, WeldedMesh};
use crate::weld::{Weld, WeldKernels};

/// The files of the last shader.
pub(crate) const FINISH: &[&str] = &[
    include_str!("../shaders/mesh.wgsl"),
    include_str!("../shaders/common.wgsl"),
    include_str!("../shaders/around.wgsl"),
    include_str!("../shaders/finish.wgsl"),
];

/// All stages, compiled.
#[derive(Clone, Debug)]
pub(crate) struct Kernels {
    weld: WeldKernels,
    topology: TopologyKernels,
    evaluation: EvaluationKernels,
    check_frames: ComputePipeline,
    store_tangents: ComputePipeline,
}

impl Kernels {
    pub fn new(device: &Device, arithmetic: Arithmetic) -> Self {
        let finish = module(device, FINISH);
        Self {
            weld: WeldKernels::new(device),
            topology: TopologyKernels::new(device),
            evaluation: EvaluationKernels::new(device, arithmetic),
            check_frames: pipeline(device, &finish, "check_frames"),
            store_tangents: pipeline(device, &finish, "store_tangents"),
        }
    }
}

/// The bytes that shaders can reach of one buffer.
pub(crate) fn largest_binding(limits: &Limits) -> u64 {
    limits.max_storage_buffer_binding_size.min(limits.max_buffer_size)
}

/// The triangles whose largest buffer, that of frames, is no larger.
pub(crate) fn triangle_limit(largest_binding: u64) -> u64 {
    const BYTES_OF_FRAME: u64 = 32;
    largest_binding / (3 * BYTES_OF_FRAME)
}

const WORDS_OF_VERTEX: u32 = 8;
const WORDS_OF_TANGENT: u32 = 4;

/// A mesh's vertices, and what welds them.
pub(crate) struct Vertices {
    buffer: Buffer,
    count: u32,
    /// One word: vertices that only the CPU can weld.
    pub refused: Buffer,
    pub weld: Weld,
}

impl Vertices {
    /// Uploads them. Errors: the device binds no buffer of that size.
    pub fn new(device: &Device, kernels: &Kernels, mesh: &Mesh<'_>) -> Result<Self, GpuError> {
        let count = mesh.vertex_count() as u32;
        check_size(device, "vertices", 4 * u64::from(WORDS_OF_VERTEX) * u64::from(count))?;
        let vertices = upload(device, "vertices", cast_slice(&packed(mesh)));
        let refused = buffer(device, "refused", 1);
        let description = Description::packed(count, 0);
        let words = description.uniform(device);
        let weld = Weld::new(device, &kernels.weld, &description, &words, &vertices, &refused)?;
        Ok(Self { buffer: vertices, count, refused, weld })
    }

    pub fn record(&self, encoder: &mut CommandEncoder) {
        encoder.clear_buffer(&self.refused, 0, None);
        self.weld.record(encoder);
    }
}

/// Some triangles of a mesh, and what makes their tangents.
pub(crate) struct Piece {
    pub topology: Topology,
    evaluation: Evaluation,
    finish: [Step; 2],
    /// Tangents and signs; signs of zero where the CPU has to decide.
    pub tangent_of_corner: Buffer,
}

impl Piece {
    /// `indices`: three per triangle. `is_left`: 1 for vertices that other pieces have, too; empty without other pieces. Errors: the device
    /// binds no buffer of that size.
    pub fn new(
        device: &Device,
        kernels: &Kernels,
        vertices: &Vertices,
        indices: &[u32],
        is_left: &[u32],
        threshold_cosine: f32,
    ) -> Result<Self, GpuError> {
        let corners = indices.len() as u32;
        let description = Description::packed(vertices.count, corners / 3);
        let words = description.uniform(device);
        check_size(device, "the tangents", 4 * u64::from(WORDS_OF_TANGENT) * u64::from(corners))?;
        let is_left = match is_left {
            [] => buffer(device, "is_left", vertices.count),
            flags => upload(device, "is_left", cast_slice(flags)),
        };
        let mesh = WeldedMesh {
            description,
            words: &words,
            vertices: &vertices.buffer,
            indices: &upload(device, "indices", cast_slice(indices)),
            welded: &vertices.weld.welded,
            is_left: &is_left,
        };
        let topology = Topology::new(device, &kernels.topology, &mesh)?;
        let grouped = Grouped {
            vertices: &vertices.buffer,
            welded_corners: &topology.welded_corners,
            ends: &topology.adjacency.ends,
            triangle_of_entry: &topology.adjacency.triangle_of_entry,
            marks: &topology.marks,
            seed_of_corner: &topology.seed_of_corner,
        };
        let evaluation =
            Evaluation::new(device, &kernels.evaluation, &description, threshold_cosine, &grouped)?;
        let tangent_of_corner = buffer(device, "tangent_of_corner", WORDS_OF_TANGENT * corners);
        let words = description.of_welded_corners().uniform(device);
        let both = [(0, &words), (1, grouped.welded_corners), (3, &evaluation.frames), (7, &is_left)];
        let checking = [(2, grouped.ends), (4, &vertices.buffer), (5, grouped.triangle_of_entry)];
        let storing = [(6, grouped.marks), (8, &tangent_of_corner)];
        let step = |pipeline, buffers: &[(u32, &Buffer)]| {
            Step::new(device, pipeline, &[&both[..], buffers].concat(), corners)
        };
        let finish = [step(&kernels.check_frames, &checking), step(&kernels.store_tangents, &storing)];
        Ok(Self { topology, evaluation, finish, tangent_of_corner })
    }

    /// Records everything, once vertices are welded.
    pub fn record(&self, encoder: &mut CommandEncoder) {
        self.topology.record(encoder);
        self.evaluation.record_derivatives(encoder);
        self.topology.record_groups(encoder);
        self.evaluation.record_frames(encoder);
        self.finish.iter().for_each(|step| step.record(encoder));
    }
}

/// Of every vertex: 1 where triangles of several pieces, of so many corners each, have it.
pub(crate) fn in_several(indices: &[u32], welded: &[u32], corners: usize) -> Vec<u32> {
    const NO_PIECE: usize = usize::MAX;
    let mut piece_of_vertex = vec![NO_PIECE; welded.len()];
    let mut flags = vec![0; welded.len()];
    for (piece, indices) in indices.chunks(corners).enumerate() {
        for vertex in indices.iter().map(|&index| welded[index as usize] as usize) {
            let known = std::mem::replace(&mut piece_of_vertex[vertex], piece);
            if known != NO_PIECE && known != piece {
                flags[vertex] = 1;
            }
        }
    }
    flags
}

/// A buffer that shaders read.
pub(crate) fn upload(device: &Device, label: &str, contents: &[u8]) -> Buffer {
    let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
    filled(device, label, contents, usage)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::average::tests::validate;
    use crate::split::SPLIT;
    use crate::topology::{GROUPS, NEIGHBOURS, TRIANGULATE};
    use crate::weld::WELD;

    #[test]
    fn shaders_are_valid_without_a_device() {
        [WELD, TRIANGULATE, NEIGHBOURS, GROUPS, FINISH, SPLIT].into_iter().for_each(validate);
    }

    #[test]
    fn vertices_of_several_pieces_are_found() {
        let welded = [0, 1, 2, 3, 1, 5];
        assert_eq!(in_several(&[0, 1, 2, 2, 3, 0, 4, 5, 5], &welded, 3), [1, 1, 1, 0, 0, 0]);
        assert_eq!(in_several(&[0, 1, 2, 2, 3, 0], &welded, 6), [0; 6]);
    }
}
