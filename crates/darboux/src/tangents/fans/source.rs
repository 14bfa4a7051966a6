//! Reading a mesh in stretches: records of vertices, vertices of triangles.

use std::ops::Range;

use crate::{Indices, Mesh};

use super::block::Record;

/// Calls `take` with every vertex of `range` and its record.
#[inline]
pub(super) fn for_each_record(mesh: &Mesh<'_>, range: Range<usize>, mut take: impl FnMut(usize, Record)) {
    let (positions, normals, uvs) = (mesh.positions(), mesh.normals(), mesh.uvs());
    let record = |[x, y, z]: [f32; 3], [a, b, c]: [f32; 3], [u, v]: [f32; 2]| [x, y, z, a, b, c, u, v];
    if let (Some(positions), Some(normals), Some(uvs)) = (positions.packed(), normals.packed(), uvs.packed())
    {
        let rows = positions[range.clone()].iter().zip(&normals[range.clone()]).zip(&uvs[range.clone()]);
        for (vertex, ((&position, &normal), &uv)) in range.zip(rows) {
            take(vertex, record(position, normal, uv));
        }
    } else {
        for vertex in range {
            take(vertex, record(positions.get(vertex), normals.get(vertex), uvs.get(vertex)));
        }
    }
}

/// The record of one vertex.
pub(super) fn record(mesh: &Mesh<'_>, vertex: usize) -> Record {
    let mut found = [0.0; 8];
    for_each_record(mesh, vertex..vertex + 1, |_, record| found = record);
    found
}

/// Which welded vertex each vertex or corner of the mesh is.
#[derive(Clone, Copy, Debug)]
pub(super) enum Identity<'a> {
    /// Every vertex is its own.
    Own,
    /// By vertex.
    OfVertex(&'a [u32]),
    /// By corner.
    OfCorner(&'a [u32]),
}

/// Writes the welded vertices of the triangles from `first` on.
pub(super) fn read_triangles(mesh: &Mesh<'_>, identity: Identity<'_>, first: usize, out: &mut [[u32; 3]]) {
    match (identity, mesh.indices()) {
        (Identity::OfCorner(of_corner), _) => copy(of_corner, first, out, |vertex| vertex),
        (Identity::Own, Indices::Unindexed) => {
            for (triangle, out) in (first as u32..).zip(out) {
                *out = [3 * triangle, 3 * triangle + 1, 3 * triangle + 2];
            }
        }
        (Identity::Own, Indices::U16(list)) => copy(list, first, out, |vertex| vertex),
        (Identity::Own, Indices::U32(list)) => copy(list, first, out, |vertex| vertex),
        (Identity::OfVertex(of), Indices::U16(list)) => copy(list, first, out, |vertex| of[vertex as usize]),
        (Identity::OfVertex(of), Indices::U32(list)) => copy(list, first, out, |vertex| of[vertex as usize]),
        (Identity::OfVertex(of), Indices::Unindexed) => copy(of, first, out, |vertex| vertex),
    }
}

#[inline]
fn copy<I: Copy + Into<u32>>(list: &[I], first: usize, out: &mut [[u32; 3]], of: impl Fn(u32) -> u32) {
    let triangles = &list.as_chunks::<3>().0[first..first + out.len()];
    for (triangle, out) in triangles.iter().zip(out) {
        *out = triangle.map(|index| of(index.into()));
    }
}
