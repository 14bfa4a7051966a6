//! The values of vertices as the fast path reads them: one record per vertex, or slices of the mesh's own
//! arrays.
//!
//! Arrays that are packed in the mesh are borrowed; others are copied into a buffer first.

use std::ops::Range;

use crate::Indices;
use crate::Mesh;
use crate::Strided;

/// The position, the normal and the UV of one vertex.
pub(crate) type VertexRecord = [f32; 8];

/// Reads the record of one vertex of the mesh.
pub(crate) fn record_of(mesh: &Mesh<'_>, vertex: usize) -> VertexRecord {
    let ([x, y, z], [a, b, c]) = (mesh.positions().get(vertex), mesh.normals().get(vertex));
    let [u, v] = mesh.uvs().get(vertex);
    [x, y, z, a, b, c, u, v]
}

/// The position in a record.
#[inline(always)]
pub(crate) fn position_of([x, y, z, ..]: VertexRecord) -> [f32; 3] {
    [x, y, z]
}

/// True when two records have equal bits: -0 differs from +0, and a NaN equals itself.
#[inline(always)]
pub(crate) fn same_bits(a: &VertexRecord, b: &VertexRecord) -> bool {
    let mut difference = 0;
    for i in 0..8 {
        difference |= a[i].to_bits() ^ b[i].to_bits();
    }
    difference == 0
}

/// Consecutive welded vertices.
#[derive(Clone, Copy, Debug)]
pub(crate) enum VertexValues<'a> {
    /// Slices of the mesh's arrays, or of copies.
    Slices(VertexSlices<'a>),
    /// Records of vertices that were welded from corners.
    Records(&'a [VertexRecord]),
}

/// Consecutive vertices: three slices of equal length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct VertexSlices<'a> {
    pub positions: &'a [[f32; 3]],
    pub normals: &'a [[f32; 3]],
    pub uvs: &'a [[f32; 2]],
}

/// Copies of vertices that are not packed in the mesh's arrays.
#[derive(Debug, Default)]
pub(crate) struct SliceBuffer {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
}

impl<'a> VertexSlices<'a> {
    /// The vertices at the corners of `range`.
    pub fn of_corners(mesh: &Mesh<'a>, range: Range<usize>, buffer: &'a mut SliceBuffer) -> Self {
        if matches!(mesh.indices(), Indices::Unindexed) {
            return Self::of_vertices(mesh, range, buffer);
        }
        let SliceBuffer { positions, normals, uvs } = buffer;
        positions.clear();
        normals.clear();
        uvs.clear();
        for vertex in range.map(|corner| mesh.vertex_of_corner(corner)) {
            positions.push(mesh.positions().get(vertex));
            normals.push(mesh.normals().get(vertex));
            uvs.push(mesh.uvs().get(vertex));
        }
        Self { positions, normals, uvs }
    }

    /// The vertices of `range`.
    pub fn of_vertices(mesh: &Mesh<'a>, range: Range<usize>, buffer: &'a mut SliceBuffer) -> Self {
        Self {
            positions: slice(mesh.positions(), range.clone(), &mut buffer.positions),
            normals: slice(mesh.normals(), range.clone(), &mut buffer.normals),
            uvs: slice(mesh.uvs(), range, &mut buffer.uvs),
        }
    }
}

fn slice<'a, const N: usize>(
    elements: Strided<'a, N>,
    range: Range<usize>,
    buffer: &'a mut Vec<[f32; N]>,
) -> &'a [[f32; N]] {
    match elements.packed() {
        Some(packed) => &packed[range],
        None => {
            buffer.clear();
            buffer.extend(range.map(|index| elements.get(index)));
            buffer
        }
    }
}
