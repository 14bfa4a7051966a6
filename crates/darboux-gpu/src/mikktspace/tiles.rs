//! A mesh on the device: its vertices at once, its triangles in pieces that fit.

use std::collections::HashMap;

use bytemuck::cast_slice;
use darboux::Mesh;
use wgpu::{Buffer, BufferUsages, CommandEncoder, Device};

use crate::GpuError;
use crate::device::kernel::{buffer, filled};
use crate::device::mesh_buffers::{Description, check_size};
use crate::device::precision::Arithmetic;
use crate::mikktspace::passes::{OF_VERTICES, of_triangles};
use crate::mikktspace::program::{Buffers, Program, Recording};
use crate::mikktspace::stages::evaluation;

/// All passes, compiled.
#[derive(Clone, Debug)]
pub(crate) struct Kernels {
    of_vertices: Program,
    of_triangles: Program,
}

impl Kernels {
    pub fn new(device: &Device, arithmetic: Arithmetic) -> Self {
        Self {
            of_vertices: Program::new(device, arithmetic, OF_VERTICES),
            of_triangles: Program::new(device, arithmetic, &of_triangles()),
        }
    }
}

/// The bytes of a triangle in the largest buffers: those of frames, and of vertices where it shares none.
pub(crate) const BYTES_OF_TRIANGLE: u64 = 3 * 32;

const WORDS_OF_VERTEX: usize = 8;

/// A mesh's vertices, and what welds them.
pub(crate) struct Vertices {
    count: u32,
    /// Those of [`OF_VERTICES`].
    pub buffers: Buffers,
    recording: Recording,
}

impl Vertices {
    /// Uploads all of a mesh. Errors: the device binds no buffer of that size.
    pub fn new(device: &Device, kernels: &Kernels, mesh: &Mesh<'_>) -> Result<Self, GpuError> {
        check_size(device, "vertices", Self::bytes(mesh.vertex_count()))?;
        Self::of(device, kernels, (0..mesh.vertex_count()).map(|vertex| packed(mesh, vertex)))
    }

    /// The bytes of so many.
    pub fn bytes(count: usize) -> u64 {
        4 * (WORDS_OF_VERTEX * count) as u64
    }

    /// Uploads the vertices of a piece. Errors: as [`Vertices::new`].
    pub fn of_cut(device: &Device, kernels: &Kernels, mesh: &Mesh<'_>, cut: &Cut) -> Result<Self, GpuError> {
        Self::of(device, kernels, cut.vertices.iter().map(|&vertex| packed(mesh, vertex as usize)))
    }

    fn of(
        device: &Device,
        kernels: &Kernels,
        vertices: impl Iterator<Item = [f32; WORDS_OF_VERTEX]>,
    ) -> Result<Self, GpuError> {
        let vertices: Vec<_> = vertices.collect();
        let count = vertices.len() as u32;
        let mut buffers = Buffers::given([
            ("mesh", &Description::packed(count, 0).uniform(device)),
            ("vertices", &upload(device, "vertices", cast_slice(&vertices))),
        ]);
        let recording = kernels.of_vertices.on(device, [count, 0], &mut buffers)?;
        Ok(Self { count, buffers, recording })
    }

    pub fn record(&self, encoder: &mut CommandEncoder) {
        self.recording.record(encoder);
    }
}

/// Some triangles of a mesh, and what makes their tangents.
pub(crate) struct Piece {
    /// Those of [`of_triangles`].
    pub buffers: Buffers,
    recording: Recording,
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
        let sizes = [vertices.count, corners / 3];
        let is_left = match is_left {
            [] => buffer(device, "is_left", vertices.count),
            flags => upload(device, "is_left", cast_slice(flags)),
        };
        let mut buffers = Buffers::given([
            ("mesh", &Description::packed(vertices.count, corners / 3).uniform(device)),
            ("evaluation", &evaluation(device, corners, threshold_cosine)),
            ("vertices", vertices.buffers.of("vertices")),
            ("indices", &upload(device, "indices", cast_slice(indices))),
            ("welded", vertices.buffers.of("welded")),
            ("is_left", &is_left),
        ]);
        let recording = kernels.of_triangles.on(device, sizes, &mut buffers)?;
        Ok(Self { buffers, recording })
    }

    /// Records everything, once vertices are welded.
    pub fn record(&self, encoder: &mut CommandEncoder) {
        self.recording.record(encoder);
    }
}

/// Some triangles with the vertices that they use alone, for meshes whose vertices no buffer holds.
pub(crate) struct Cut {
    /// The mesh's.
    pub vertices: Vec<u32>,
    /// Three per triangle, into these.
    pub indices: Vec<u32>,
}

impl Cut {
    pub fn new(indices: &[u32]) -> Self {
        let mut place_of_vertex = HashMap::new();
        let mut vertices = Vec::new();
        let place = |&vertex: &u32| {
            *place_of_vertex.entry(vertex).or_insert_with(|| {
                vertices.push(vertex);
                vertices.len() as u32 - 1
            })
        };
        let indices = indices.iter().map(place).collect();
        Self { vertices, indices }
    }
}

/// From half of the largest float on the reference does not weld positions.
const LARGEST: f32 = 1e38;

/// The first vertex that equals each vertex; none where only the reference's order decides. The twin of shaders/mikktspace/weld.wgsl for meshes whose
/// vertices no buffer holds.
pub(crate) fn weld(mesh: &Mesh<'_>) -> Option<Vec<u32>> {
    let mut first_of_words = HashMap::new();
    let welded = |vertex: usize| {
        let own = packed(mesh, vertex);
        own.iter().all(|x| x.abs() <= LARGEST).then_some(())?;
        // Adding zero turns -0 into +0.
        let words = own.map(|x| (x + 0.0).to_bits());
        let first = *first_of_words.entry(words).or_insert(vertex as u32);
        (packed(mesh, first as usize).map(f32::to_bits) == own.map(f32::to_bits)).then_some(first)
    };
    (0..mesh.vertex_count()).map(welded).collect()
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

/// A vertex as [`Description::packed`] describes it.
fn packed(mesh: &Mesh<'_>, vertex: usize) -> [f32; WORDS_OF_VERTEX] {
    let ([x, y, z], [a, b, c]) = (mesh.positions().get(vertex), mesh.normals().get(vertex));
    let [u, v] = mesh.uvs().get(vertex);
    [x, y, z, a, b, c, u, v]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::average::tests::validate;
    use crate::mikktspace::passes::Pass;
    use crate::split::SPLIT;

    #[test]
    fn shaders_are_valid_without_a_device() {
        for pass in [OF_VERTICES, &of_triangles()].concat() {
            match pass {
                Pass::Run(run) | Pass::Real(_, run) => validate(run.kernel.files),
                Pass::Clear(_) | Pass::Scan(..) => {}
            }
        }
        validate(SPLIT);
    }

    #[test]
    fn a_cut_has_the_vertices_that_it_uses() {
        let cut = Cut::new(&[7, 9, 7, 2, 9, 30]);
        assert_eq!((&cut.vertices[..], &cut.indices[..]), (&[7, 9, 2, 30][..], &[0, 1, 0, 2, 1, 3][..]));
    }

    #[test]
    fn the_twin_of_the_shader_welds_and_refuses() {
        let welded = |xs: &[f32]| {
            let positions: Vec<[f32; 3]> = xs.iter().map(|&x| [x, 1.0, 2.0]).collect();
            let (normals, uvs) = (vec![[0.0; 3]; xs.len()], vec![[0.5; 2]; xs.len()]);
            weld(&Mesh::triangles(&positions, &normals, &uvs, &[0u32, 1, 2]).expect("a mesh"))
        };
        assert_eq!(welded(&[3.0, 4.0, 3.0, 4.0, -0.0]), Some(vec![0, 1, 0, 1, 4]));
        for refused in [[0.0, 1.0, -0.0], [0.0, 1.0, f32::NAN], [0.0, f32::INFINITY, 1.0], [0.0, 2.0, 2e38]] {
            assert_eq!(welded(&refused), None);
        }
    }

    #[test]
    fn vertices_of_several_pieces_are_found() {
        let welded = [0, 1, 2, 3, 1, 5];
        assert_eq!(in_several(&[0, 1, 2, 2, 3, 0, 4, 5, 5], &welded, 3), [1, 1, 1, 0, 0, 0]);
        assert_eq!(in_several(&[0, 1, 2, 2, 3, 0], &welded, 6), [0; 6]);
    }
}
