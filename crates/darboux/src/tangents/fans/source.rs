//! Reading a mesh in stretches: records of vertices, vertices of triangles. Where the mesh's own arrays will do, they are lent.

use std::ops::Range;

use crate::{Indices, Mesh, Strided};

use super::block::Record;

/// Consecutive welded vertices.
#[derive(Clone, Copy, Debug)]
pub(super) enum Welded<'a> {
    Rows(Rows<'a>),
    Records(&'a [Record]),
}

/// The welded vertices of `range`.
pub(super) fn rows<'a>(
    mesh: &Mesh<'a>,
    identity: Identity<'a>,
    range: Range<usize>,
    buffer: &'a mut RowBuffer,
) -> Welded<'a> {
    match identity {
        Identity::OfCorner(_, records) => Welded::Records(&records[range]),
        Identity::Own | Identity::OfVertex(_) => Welded::Rows(Rows::new(mesh, range, buffer)),
    }
}

/// Consecutive vertices.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rows<'a> {
    pub positions: &'a [[f32; 3]],
    pub normals: &'a [[f32; 3]],
    pub uvs: &'a [[f32; 2]],
}

/// Room for vertices that do not lie one after the other in the mesh.
#[derive(Debug, Default)]
pub(super) struct RowBuffer {
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
pub(super) fn record(mesh: &Mesh<'_>, vertex: usize) -> Record {
    let ([x, y, z], [a, b, c]) = (mesh.positions().get(vertex), mesh.normals().get(vertex));
    let [u, v] = mesh.uvs().get(vertex);
    [x, y, z, a, b, c, u, v]
}

/// Which welded vertex each vertex or corner of the mesh is.
#[derive(Clone, Copy, Debug)]
pub(super) enum Identity<'a> {
    /// Every vertex is its own.
    Own,
    /// By vertex.
    OfVertex(&'a [u32]),
    /// By corner; and the records of the welded vertices.
    OfCorner(&'a [u32], &'a [Record]),
}

impl Identity<'_> {
    /// The welded vertex at a corner.
    pub fn vertex(&self, mesh: &Mesh<'_>, corner: u32) -> u32 {
        match self {
            Self::OfCorner(list, _) => list[corner as usize],
            Self::Own => mesh.vertex_of_corner(corner as usize) as u32,
            Self::OfVertex(of) => of[mesh.vertex_of_corner(corner as usize)],
        }
    }

    /// Calls `visit` with the welded vertex at each of some corners.
    #[inline(always)]
    pub fn visit(&self, mesh: &Mesh<'_>, corners: Range<usize>, visit: impl FnMut(u32)) {
        match (self, mesh.indices()) {
            (Self::OfCorner(list, _), _) => list[corners].iter().copied().for_each(visit),
            (_, Indices::Unindexed) => {}
            (Self::Own, Indices::U32(list)) => list[corners].iter().copied().for_each(visit),
            (Self::Own, Indices::U16(list)) => list[corners].iter().copied().map(u32::from).for_each(visit),
            (Self::OfVertex(of), Indices::U32(list)) => {
                list[corners].iter().map(|&vertex| of[vertex as usize]).for_each(visit);
            }
            (Self::OfVertex(of), Indices::U16(list)) => {
                list[corners].iter().map(|&vertex| of[usize::from(vertex)]).for_each(visit);
            }
        }
    }

    /// The position of a welded vertex.
    pub fn position(&self, mesh: &Mesh<'_>, vertex: u32) -> [f32; 3] {
        match self {
            Self::OfCorner(_, records) => {
                let [x, y, z, ..] = records[vertex as usize];
                [x, y, z]
            }
            Self::Own | Self::OfVertex(_) => mesh.positions().get(vertex as usize),
        }
    }
}

/// The welded vertices of some triangles.
pub(super) fn triangles<'a>(
    mesh: &Mesh<'a>,
    identity: Identity<'a>,
    range: Range<usize>,
    buffer: &'a mut Vec<[u32; 3]>,
) -> &'a [[u32; 3]] {
    match (identity, mesh.indices()) {
        (Identity::OfCorner(list, _), _) => &list.as_chunks().0[range],
        (Identity::Own, Indices::U32(list)) => &list.as_chunks().0[range],
        (_, Indices::Unindexed) => &[],
        (Identity::Own, Indices::U16(list)) => copied(list, range, buffer, |vertex| vertex),
        (Identity::OfVertex(of), Indices::U16(list)) => {
            copied(list, range, buffer, |vertex| of[vertex as usize])
        }
        (Identity::OfVertex(of), Indices::U32(list)) => {
            copied(list, range, buffer, |vertex| of[vertex as usize])
        }
    }
}

fn copied<'a, I: Copy + Into<u32>>(
    list: &[I],
    range: Range<usize>,
    buffer: &'a mut Vec<[u32; 3]>,
    of: impl Fn(u32) -> u32,
) -> &'a [[u32; 3]] {
    buffer.clear();
    buffer.extend(
        list.as_chunks().0[range].iter().map(|triangle: &[I; 3]| triangle.map(|index| of(index.into()))),
    );
    buffer
}
