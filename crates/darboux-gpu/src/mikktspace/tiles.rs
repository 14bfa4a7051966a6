//! Uploads a mesh to the device: its vertices at once, its triangles in tiles that fit the largest buffer.
//!
//! A mesh whose vertices do not fit either is cut into submeshes, one per tile, and welded on the CPU.

use std::collections::HashMap;

use bytemuck::cast_slice;
use darboux::Mesh;
use wgpu::{Buffer, BufferUsages, CommandEncoder, Device};

use crate::device::buffers::{buffer_with_contents, check_size, storage_buffer, upload};
use crate::device::mesh_buffers::MeshUniform;
use crate::device::precision::Arithmetic;
use crate::error::GpuError;
use crate::mikktspace::passes::{VERTEX_PASSES, triangle_passes};
use crate::mikktspace::program::{BoundProgram, NamedBuffers, Program};

/// The compiled passes.
#[derive(Clone, Debug)]
pub(crate) struct Programs {
    vertices: Program,
    triangles: Program,
}

impl Programs {
    pub fn new(device: &Device, arithmetic: Arithmetic) -> Self {
        Self {
            vertices: Program::new(device, arithmetic, VERTEX_PASSES),
            triangles: Program::new(device, arithmetic, &triangle_passes()),
        }
    }
}

/// The bytes per triangle in the largest buffers, which are the frames and, for unindexed meshes, the
/// vertices.
pub(crate) const BYTES_PER_TRIANGLE: u64 = 3 * 32;

const WORDS_PER_VERTEX: usize = 8;

/// Vertices on the device, with the passes that weld them.
pub(crate) struct UploadedVertices {
    count: u32,
    /// The buffers of [`VERTEX_PASSES`].
    pub buffers: NamedBuffers,
    program: BoundProgram,
}

impl UploadedVertices {
    /// All vertices of a mesh. Errors: a buffer is larger than the device can bind.
    pub fn new(device: &Device, programs: &Programs, mesh: &Mesh<'_>) -> Result<Self, GpuError> {
        check_size(device, "vertices", Self::byte_length(mesh.vertex_count()))?;
        Self::from_packed(device, programs, (0..mesh.vertex_count()).map(|vertex| packed(mesh, vertex)))
    }

    /// The byte length of a buffer of `count` vertices.
    pub fn byte_length(count: usize) -> u64 {
        4 * (WORDS_PER_VERTEX * count) as u64
    }

    /// The vertices of a submesh of `mesh`. Errors: as for [`UploadedVertices::new`].
    pub fn of_submesh(
        device: &Device,
        programs: &Programs,
        mesh: &Mesh<'_>,
        submesh: &Submesh,
    ) -> Result<Self, GpuError> {
        let vertices = submesh.vertices.iter().map(|&vertex| packed(mesh, vertex as usize));
        Self::from_packed(device, programs, vertices)
    }

    fn from_packed(
        device: &Device,
        programs: &Programs,
        vertices: impl Iterator<Item = [f32; WORDS_PER_VERTEX]>,
    ) -> Result<Self, GpuError> {
        let vertices: Vec<_> = vertices.collect();
        let count = vertices.len() as u32;
        let mut buffers = NamedBuffers::new([
            ("mesh", &MeshUniform::packed(count, 0).upload(device)),
            ("vertices", &upload(device, "vertices", cast_slice(&vertices))),
        ]);
        let program = programs.vertices.bind(device, [count, 0], &mut buffers)?;
        Ok(Self { count, buffers, program })
    }

    /// Records the welding.
    pub fn record(&self, encoder: &mut CommandEncoder) {
        self.program.record(encoder);
    }
}

/// Some triangles of a mesh on the device, with the passes that compute their tangents.
pub(crate) struct Tile {
    /// The buffers of [`triangle_passes`].
    pub buffers: NamedBuffers,
    program: BoundProgram,
}

impl Tile {
    /// `indices`: three per triangle. `is_shared`: 1 for vertices that other tiles use too; empty if there is
    /// only one tile.
    ///
    /// Errors: a buffer is larger than the device can bind.
    pub fn new(
        device: &Device,
        programs: &Programs,
        vertices: &UploadedVertices,
        indices: &[u32],
        is_shared: &[u32],
        threshold_cosine: f32,
    ) -> Result<Self, GpuError> {
        let corners = indices.len() as u32;
        let sizes = [vertices.count, corners / 3];
        // The CPU computes shared vertices, because a tile sees only some of their triangles.
        let is_deferred = match is_shared {
            [] => storage_buffer(device, "is_deferred", vertices.count),
            flags => upload(device, "is_deferred", cast_slice(flags)),
        };
        let mut buffers = NamedBuffers::new([
            ("mesh", &MeshUniform::packed(vertices.count, corners / 3).upload(device)),
            ("evaluation", &evaluation_uniform(device, corners, threshold_cosine)),
            ("vertices", vertices.buffers.get("vertices")),
            ("indices", &upload(device, "indices", cast_slice(indices))),
            ("welded_vertex", vertices.buffers.get("welded_vertex")),
            ("is_deferred", &is_deferred),
        ]);
        let program = programs.triangles.bind(device, sizes, &mut buffers)?;
        Ok(Self { buffers, program })
    }

    /// Records all passes. The vertices must have been welded before.
    pub fn record(&self, encoder: &mut CommandEncoder) {
        self.program.record(encoder);
    }
}

/// The uniform `Evaluation` of `shaders/mikktspace/evaluate.wgsl`.
pub(crate) fn evaluation_uniform(device: &Device, corners: u32, threshold_cosine: f32) -> Buffer {
    let words = [corners, threshold_cosine.to_bits(), 0, 0];
    buffer_with_contents(device, "evaluation", cast_slice(&words), BufferUsages::UNIFORM)
}

/// The triangles of a tile, with only the vertices that they use.
pub(crate) struct Submesh {
    /// The vertices of the mesh that the triangles use.
    pub vertices: Vec<u32>,
    /// Three indices into `vertices` per triangle.
    pub indices: Vec<u32>,
}

impl Submesh {
    pub fn new(indices: &[u32]) -> Self {
        let mut local_index = HashMap::new();
        let mut vertices = Vec::new();
        let local = |&vertex: &u32| {
            *local_index.entry(vertex).or_insert_with(|| {
                vertices.push(vertex);
                vertices.len() as u32 - 1
            })
        };
        let indices = indices.iter().map(local).collect();
        Self { vertices, indices }
    }
}

/// The reference does not weld positions above half of the largest float. The core uses this bound too.
const LARGEST: f32 = 1e38;

/// For each vertex, the first vertex that equals it; none if there are values that only the core's serial
/// order can weld.
///
/// The same as `shaders/mikktspace/weld.wgsl`, for meshes whose vertices are too large for a buffer.
pub(crate) fn weld_on_cpu(mesh: &Mesh<'_>) -> Option<Vec<u32>> {
    let mut first_vertex = HashMap::new();
    let welded = |vertex: usize| {
        let own = packed(mesh, vertex);
        own.iter().all(|x| x.abs() <= LARGEST).then_some(())?;
        // Adding zero turns -0 into +0.
        let words = own.map(|x| (x + 0.0).to_bits());
        let first = *first_vertex.entry(words).or_insert(vertex as u32);
        (packed(mesh, first as usize).map(f32::to_bits) == own.map(f32::to_bits)).then_some(first)
    };
    (0..mesh.vertex_count()).map(welded).collect()
}

/// For each vertex, 1 if triangles of several tiles use it. `tile_corners`: corners per tile.
pub(crate) fn shared_between_tiles(indices: &[u32], welded_vertex: &[u32], tile_corners: usize) -> Vec<u32> {
    const NO_TILE: usize = usize::MAX;
    let mut last_tile = vec![NO_TILE; welded_vertex.len()];
    let mut flags = vec![0; welded_vertex.len()];
    for (tile, indices) in indices.chunks(tile_corners).enumerate() {
        for vertex in indices.iter().map(|&index| welded_vertex[index as usize] as usize) {
            let last = std::mem::replace(&mut last_tile[vertex], tile);
            if last != NO_TILE && last != tile {
                flags[vertex] = 1;
            }
        }
    }
    flags
}

/// A vertex in the layout of [`MeshUniform::packed`].
fn packed(mesh: &Mesh<'_>, vertex: usize) -> [f32; WORDS_PER_VERTEX] {
    let ([x, y, z], [a, b, c]) = (mesh.positions().get(vertex), mesh.normals().get(vertex));
    let [u, v] = mesh.uvs().get(vertex);
    [x, y, z, a, b, c, u, v]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_submesh_has_only_the_vertices_that_it_uses() {
        let submesh = Submesh::new(&[7, 9, 7, 2, 9, 30]);
        assert_eq!(
            (&submesh.vertices[..], &submesh.indices[..]),
            (&[7, 9, 2, 30][..], &[0, 1, 0, 2, 1, 3][..])
        );
    }

    #[test]
    fn welding_on_the_cpu_accepts_and_rejects_what_the_shader_does() {
        let welded = |xs: &[f32]| {
            let positions: Vec<[f32; 3]> = xs.iter().map(|&x| [x, 1.0, 2.0]).collect();
            let (normals, uvs) = (vec![[0.0; 3]; xs.len()], vec![[0.5; 2]; xs.len()]);
            weld_on_cpu(&Mesh::triangles(&positions, &normals, &uvs, &[0u32, 1, 2]).expect("a mesh"))
        };
        assert_eq!(welded(&[3.0, 4.0, 3.0, 4.0, -0.0]), Some(vec![0, 1, 0, 1, 4]));
        for rejected in [[0.0, 1.0, -0.0], [0.0, 1.0, f32::NAN], [0.0, f32::INFINITY, 1.0], [0.0, 2.0, 2e38]]
        {
            assert_eq!(welded(&rejected), None);
        }
    }

    #[test]
    fn vertices_of_several_tiles_are_found() {
        let welded = [0, 1, 2, 3, 1, 5];
        assert_eq!(shared_between_tiles(&[0, 1, 2, 2, 3, 0, 4, 5, 5], &welded, 3), [1, 1, 1, 0, 0, 0]);
        assert_eq!(shared_between_tiles(&[0, 1, 2, 2, 3, 0], &welded, 6), [0; 6]);
    }
}
