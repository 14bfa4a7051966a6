//! Values of vertices in stretches. Where the mesh's own arrays will do, they are lent.

use std::ops::Range;

use crate::Indices;
use crate::Mesh;
use crate::Strided;

use crate::tangents::fast::kernel::Record;

/// Consecutive welded vertices.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Welded<'a> {
    Rows(Rows<'a>),
    Records(&'a [Record]),
}

/// Consecutive vertices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rows<'a> {
    pub positions: &'a [[f32; 3]],
    pub normals: &'a [[f32; 3]],
    pub uvs: &'a [[f32; 2]],
}

/// Room for vertices that do not lie one after the other in the mesh.
#[derive(Debug, Default)]
pub(crate) struct RowBuffer {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
}

impl<'a> Rows<'a> {
    /// The vertices of corners.
    pub fn of_corners(mesh: &Mesh<'a>, range: Range<usize>, buffer: &'a mut RowBuffer) -> Self {
        if matches!(mesh.indices(), Indices::Unindexed) {
            return Self::new(mesh, range, buffer);
        }
        let RowBuffer { positions, normals, uvs } = buffer;
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
    pub fn new(mesh: &Mesh<'a>, range: Range<usize>, buffer: &'a mut RowBuffer) -> Self {
        Self {
            positions: stretch(mesh.positions(), range.clone(), &mut buffer.positions),
            normals: stretch(mesh.normals(), range.clone(), &mut buffer.normals),
            uvs: stretch(mesh.uvs(), range, &mut buffer.uvs),
        }
    }
}

fn stretch<'a, const N: usize>(
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

/// The record of one vertex.
pub(crate) fn record(mesh: &Mesh<'_>, vertex: usize) -> Record {
    let ([x, y, z], [a, b, c]) = (mesh.positions().get(vertex), mesh.normals().get(vertex));
    let [u, v] = mesh.uvs().get(vertex);
    [x, y, z, a, b, c, u, v]
}
