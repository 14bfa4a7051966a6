//! A mesh read as triangles of welded vertices, in windows. Where the mesh's own arrays will do, they are lent.

use std::ops::Range;

use crate::Indices;
use crate::Mesh;

use crate::exec::windows::WINDOW;
use crate::tangents::fast::kernel::Record;
use crate::tangents::fast::quads::{Cut, cut_vertices};
use crate::tangents::fast::rows::{RowBuffer, Rows, Welded};

/// A mesh as a list of triangles of welded vertices.
///
/// Its *entries* are the corners of these triangles, three after three: the corners of the mesh where its faces are triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Source<'a> {
    pub mesh: &'a Mesh<'a>,
    pub identity: Identity<'a>,
    pub cut: &'a Cut,
}

/// Which welded vertex each vertex or corner of the mesh is.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Identity<'a> {
    /// Every vertex is its own.
    Own,
    /// By vertex.
    OfVertex(&'a [u32]),
    /// By corner; and the records of the welded vertices.
    OfCorner(&'a [u32], &'a [Record]),
}

/// Room for triangles that do not lie one after the other in the mesh.
#[derive(Debug, Default)]
pub(crate) struct TriangleBuffer {
    vertices: Vec<u32>,
    triangles: Vec<[u32; 3]>,
}

impl<'a> Source<'a> {
    /// The number of triangles.
    pub fn count(&self) -> usize {
        if self.is_cut() { self.cut.pieces.len() } else { self.mesh.face_count() }
    }

    pub fn window_count(&self) -> usize {
        self.count().div_ceil(WINDOW)
    }

    /// All windows' triangles.
    pub fn windows(self) -> impl Iterator<Item = Range<usize>> {
        (0..self.window_count()).map(move |at| self.window(at))
    }

    /// The triangles of one window. No face is in two.
    pub fn window(&self, at: usize) -> Range<usize> {
        self.triangles_of(at..at + 1)
    }

    /// The triangles of consecutive windows.
    pub fn triangles_of(&self, windows: Range<usize>) -> Range<usize> {
        let start = |at: usize| self.face_of((at * WINDOW).min(self.count()) as u32).start as usize;
        start(windows.start)..start(windows.end)
    }

    /// The corners of consecutive windows' faces.
    pub fn corners_of(&self, windows: Range<usize>) -> Range<usize> {
        self.corners_between(self.triangles_of(windows))
    }

    /// The corners of consecutive faces, given by their triangles.
    fn corners_between(&self, triangles: Range<usize>) -> Range<usize> {
        let corner = |triangle: usize| match self.cut.pieces.get(triangle) {
            Some(piece) => piece.first_corner() as usize,
            None if self.is_cut() => self.mesh.corner_count(),
            None => 3 * triangle,
        };
        corner(triangles.start)..corner(triangles.end)
    }

    /// Whether faces had to be cut into triangles.
    pub fn is_cut(&self) -> bool {
        !self.cut.pieces.is_empty()
    }

    /// The corners of a triangle.
    pub fn corners(&self, triangle: u32) -> [u32; 3] {
        match self.cut.pieces.get(triangle as usize) {
            Some(piece) => piece.corners(),
            None => [0, 1, 2].map(|k| 3 * triangle + k),
        }
    }

    /// The corners of the face that a triangle is a piece of.
    pub fn corners_of_face(&self, triangle: u32) -> Range<u32> {
        let Range { start, end } = self.face_of(triangle);
        let Range { start, end } = self.corners_between(start as usize..end as usize);
        start as u32..end as u32
    }

    /// The corner at an entry.
    pub fn corner(&self, entry: u32) -> u32 {
        self.corners(entry / 3)[entry as usize % 3]
    }

    /// The triangles of the face that has a corner.
    pub fn triangles_at(&self, corner: u32) -> Range<u32> {
        if !self.is_cut() {
            return corner / 3..corner / 3 + 1;
        }
        let end = self.cut.pieces.partition_point(|piece| piece.first_corner() <= corner) as u32;
        self.face_of(end - 1)
    }

    /// The triangles of the face that a triangle is a piece of.
    pub fn face_of(&self, triangle: u32) -> Range<u32> {
        let is_second = |at: u32| self.cut.pieces.get(at as usize).is_some_and(|piece| piece.is_second());
        let start = if is_second(triangle) { triangle - 1 } else { triangle };
        start..if is_second(start + 1) { start + 2 } else { start + 1 }
    }

    /// The entries of a corner.
    pub fn entries(&self, corner: u32) -> impl Iterator<Item = u32> {
        let entries =
            self.triangles_at(corner).flat_map(|triangle| (3 * triangle..).zip(self.corners(triangle)));
        entries.filter(move |&(_, other)| other == corner).map(|(entry, _)| entry)
    }

    /// The welded vertex at a corner.
    pub fn vertex(&self, corner: u32) -> u32 {
        match self.identity {
            Identity::OfCorner(list, _) => list[corner as usize],
            Identity::Own => self.mesh.vertex_of_corner(corner as usize) as u32,
            Identity::OfVertex(of) => of[self.mesh.vertex_of_corner(corner as usize)],
        }
    }

    /// The welded vertices of a triangle.
    pub fn triangle(&self, triangle: u32) -> [u32; 3] {
        self.corners(triangle).map(|corner| self.vertex(corner))
    }

    /// The position of a welded vertex.
    pub fn position(&self, vertex: u32) -> [f32; 3] {
        match self.identity {
            Identity::OfCorner(_, records) => {
                let [x, y, z, ..] = records[vertex as usize];
                [x, y, z]
            }
            Identity::Own | Identity::OfVertex(_) => self.mesh.positions().get(vertex as usize),
        }
    }

    /// The welded vertices of `range`.
    pub fn rows<'b>(&self, range: Range<usize>, buffer: &'b mut RowBuffer) -> Welded<'b>
    where
        'a: 'b,
    {
        match self.identity {
            Identity::OfCorner(_, records) => Welded::Records(&records[range]),
            Identity::Own | Identity::OfVertex(_) => Welded::Rows(Rows::new(self.mesh, range, buffer)),
        }
    }

    /// The welded vertices of triangles, which are whole faces.
    pub fn triangles<'b>(&self, range: Range<usize>, buffer: &'b mut TriangleBuffer) -> &'b [[u32; 3]]
    where
        'a: 'b,
    {
        let TriangleBuffer { vertices, triangles } = buffer;
        if !self.is_cut() {
            return self.vertices(3 * range.start..3 * range.end, vertices).as_chunks().0;
        }
        let vertices = self.vertices(self.corners_between(range.clone()), vertices);
        cut_vertices(&self.cut.pieces[range], vertices, triangles);
        triangles
    }

    /// The welded vertices at corners.
    pub fn vertices<'b>(&self, range: Range<usize>, buffer: &'b mut Vec<u32>) -> &'b [u32]
    where
        'a: 'b,
    {
        match (self.identity, self.mesh.indices()) {
            (Identity::OfCorner(list, _), _) => &list[range],
            (Identity::Own, Indices::U32(list)) => &list[range],
            (_, Indices::Unindexed) => &[],
            (Identity::Own, Indices::U16(list)) => copied(&list[range], buffer, |vertex| vertex),
            (Identity::OfVertex(of), Indices::U16(list)) => {
                copied(&list[range], buffer, |vertex| of[vertex as usize])
            }
            (Identity::OfVertex(of), Indices::U32(list)) => {
                copied(&list[range], buffer, |vertex| of[vertex as usize])
            }
        }
    }

    /// Calls `visit` with the welded vertex at each of some corners.
    #[inline(always)]
    pub fn visit(&self, corners: Range<usize>, visit: impl FnMut(u32)) {
        match (self.identity, self.mesh.indices()) {
            (Identity::OfCorner(list, _), _) => list[corners].iter().copied().for_each(visit),
            (_, Indices::Unindexed) => {}
            (Identity::Own, Indices::U32(list)) => list[corners].iter().copied().for_each(visit),
            (Identity::Own, Indices::U16(list)) => {
                list[corners].iter().copied().map(u32::from).for_each(visit);
            }
            (Identity::OfVertex(of), Indices::U32(list)) => {
                list[corners].iter().map(|&vertex| of[vertex as usize]).for_each(visit);
            }
            (Identity::OfVertex(of), Indices::U16(list)) => {
                list[corners].iter().map(|&vertex| of[usize::from(vertex)]).for_each(visit);
            }
        }
    }
}

fn copied<'a, I: Copy + Into<u32>>(
    list: &[I],
    buffer: &'a mut Vec<u32>,
    of: impl Fn(u32) -> u32,
) -> &'a [u32] {
    buffer.clear();
    buffer.extend(list.iter().map(|&vertex| of(vertex.into())));
    buffer
}
