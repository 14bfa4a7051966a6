//! The mesh as a list of triangles of welded vertices, read window by window.
//!
//! The *entries* of the list are the corners of its triangles, three per triangle. Where all faces are
//! triangles, entries are the corners of the mesh. Where quads were split, entry and corner have different
//! numbers, and a corner on a diagonal has two entries.

use std::ops::Range;

use crate::Indices;
use crate::Mesh;

use crate::exec::windows::WINDOW;
use crate::tangents::fast::proof::marks;
use crate::tangents::fast::quads::{FaceSplit, split_vertices};
use crate::tangents::fast::vertex_record::{
    SliceBuffer, VertexRecord, VertexSlices, VertexValues, position_of, record_of,
};

/// A mesh, how its vertices are welded, and how its faces are split.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TriangleList<'a> {
    pub mesh: &'a Mesh<'a>,
    pub weld: WeldMap<'a>,
    pub split: &'a FaceSplit,
}

/// Which welded vertex each vertex or corner of the mesh is.
#[derive(Clone, Copy, Debug)]
pub(crate) enum WeldMap<'a> {
    /// No two vertices of the mesh are equal.
    Unwelded,
    /// The welded vertex of each vertex of the mesh, and that of each corner.
    OfVertex(&'a [u32], &'a [u32]),
    /// The welded vertex of each corner, and the records of the welded vertices.
    OfCorner(&'a [u32], &'a [VertexRecord]),
}

/// Copies of triangles that are not contiguous in the mesh.
#[derive(Debug, Default)]
pub(crate) struct TriangleBuffer {
    vertices: Vec<u32>,
    triangles: Vec<[u32; 3]>,
}

impl<'a> TriangleList<'a> {
    /// The number of triangles.
    pub fn count(&self) -> usize {
        if self.is_split() { self.split.triangles.len() } else { self.mesh.face_count() }
    }

    pub fn window_count(&self) -> usize {
        self.count().div_ceil(WINDOW)
    }

    /// The triangles of every window.
    pub fn windows(self) -> impl Iterator<Item = Range<usize>> {
        (0..self.window_count()).map(move |at| self.window(at))
    }

    /// The triangles of one window. Both halves of a quad are in one window.
    pub fn window(&self, at: usize) -> Range<usize> {
        self.triangles_of(at..at + 1)
    }

    /// The triangles of consecutive windows.
    pub fn triangles_of(&self, windows: Range<usize>) -> Range<usize> {
        let start = |at: usize| self.face_of((at * WINDOW).min(self.count()) as u32).start as usize;
        start(windows.start)..start(windows.end)
    }

    /// The corners of the faces of consecutive windows.
    pub fn corners_of(&self, windows: Range<usize>) -> Range<usize> {
        self.corners_between(self.triangles_of(windows))
    }

    /// The corners of consecutive faces. `triangles`: all triangles of these faces.
    fn corners_between(&self, triangles: Range<usize>) -> Range<usize> {
        let corner = |triangle: usize| match self.split.triangles.get(triangle) {
            Some(triangle) => triangle.first_corner() as usize,
            None if self.is_split() => self.mesh.corner_count(),
            None => 3 * triangle,
        };
        corner(triangles.start)..corner(triangles.end)
    }

    /// True where the mesh has faces that were split into triangles.
    pub fn is_split(&self) -> bool {
        !self.split.triangles.is_empty()
    }

    /// The corners of a triangle.
    #[inline]
    pub fn corners(&self, triangle: u32) -> [u32; 3] {
        match self.split.triangles.get(triangle as usize) {
            Some(triangle) => triangle.corners(),
            None => [0, 1, 2].map(|k| 3 * triangle + k),
        }
    }

    /// The corners of the face that contains a triangle.
    pub fn corners_of_face(&self, triangle: u32) -> Range<u32> {
        let Range { start, end } = self.face_of(triangle);
        let Range { start, end } = self.corners_between(start as usize..end as usize);
        start as u32..end as u32
    }

    /// The corner at an entry.
    #[inline]
    pub fn corner(&self, entry: u32) -> u32 {
        if self.is_split() { self.corners(entry / 3)[entry as usize % 3] } else { entry }
    }

    /// The triangles of the face that has a corner.
    pub fn triangles_at(&self, corner: u32) -> Range<u32> {
        if !self.is_split() {
            return corner / 3..corner / 3 + 1;
        }
        let end = self.split.triangles.partition_point(|triangle| triangle.first_corner() <= corner) as u32;
        self.face_of(end - 1)
    }

    /// The triangles of the face that contains a triangle.
    #[inline]
    pub fn face_of(&self, triangle: u32) -> Range<u32> {
        let triangles = &self.split.triangles;
        let is_second = |at: u32| triangles.get(at as usize).is_some_and(|triangle| triangle.is_second());
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
    #[inline]
    pub fn vertex(&self, corner: u32) -> u32 {
        match self.weld {
            WeldMap::OfCorner(of, _) | WeldMap::OfVertex(_, of) => of[corner as usize],
            WeldMap::Unwelded => self.mesh.vertex_of_corner(corner as usize) as u32,
        }
    }

    /// The welded vertices of a triangle.
    #[inline]
    pub fn triangle(&self, triangle: u32) -> [u32; 3] {
        self.corners(triangle).map(|corner| self.vertex(corner))
    }

    /// The position of a welded vertex.
    #[inline]
    pub fn position(&self, vertex: u32) -> [f32; 3] {
        match self.weld {
            WeldMap::OfCorner(_, records) => position_of(records[vertex as usize]),
            WeldMap::Unwelded | WeldMap::OfVertex(..) => self.mesh.positions().get(vertex as usize),
        }
    }

    /// The values of a welded vertex.
    #[inline(always)]
    pub fn record(&self, vertex: u32) -> VertexRecord {
        match self.weld {
            WeldMap::OfCorner(_, records) => records[vertex as usize],
            WeldMap::Unwelded | WeldMap::OfVertex(..) => record_of(self.mesh, vertex as usize),
        }
    }

    /// The values of the welded vertices of `range`.
    pub fn values<'b>(&self, range: Range<usize>, buffer: &'b mut SliceBuffer) -> VertexValues<'b>
    where
        'a: 'b,
    {
        match self.weld {
            WeldMap::OfCorner(_, records) => VertexValues::Records(&records[range]),
            WeldMap::Unwelded | WeldMap::OfVertex(..) => {
                VertexValues::Slices(VertexSlices::of_vertices(self.mesh, range, buffer))
            }
        }
    }

    /// The welded vertices of the triangles of `range`, which are those of whole faces.
    pub fn triangles<'b>(&self, range: Range<usize>, buffer: &'b mut TriangleBuffer) -> &'b [[u32; 3]]
    where
        'a: 'b,
    {
        let TriangleBuffer { vertices, triangles } = buffer;
        if !self.is_split() {
            return self.vertices(3 * range.start..3 * range.end, vertices).as_chunks().0;
        }
        let vertices = self.vertices(self.corners_between(range.clone()), vertices);
        split_vertices(&self.split.triangles[range], vertices, triangles);
        triangles
    }

    /// The welded vertices at the corners of `range`.
    pub fn vertices<'b>(&self, range: Range<usize>, buffer: &'b mut Vec<u32>) -> &'b [u32]
    where
        'a: 'b,
    {
        match (self.weld, self.mesh.indices()) {
            (WeldMap::OfCorner(of, _) | WeldMap::OfVertex(_, of), _) => &of[range],
            (WeldMap::Unwelded, Indices::U32(indices)) => &indices[range],
            (WeldMap::Unwelded, Indices::Unindexed) => &[],
            (WeldMap::Unwelded, Indices::U16(indices)) => {
                buffer.clear();
                buffer.extend(indices[range].iter().map(|&vertex| u32::from(vertex)));
                buffer
            }
        }
    }

    /// Calls `visit` with the welded vertex at each corner of `range`.
    #[inline(always)]
    pub fn visit_vertices(&self, range: Range<usize>, visit: impl FnMut(u32)) {
        match (self.weld, self.mesh.indices()) {
            (WeldMap::OfCorner(of, _) | WeldMap::OfVertex(_, of), _) => {
                of[range].iter().copied().for_each(visit);
            }
            (WeldMap::Unwelded, Indices::Unindexed) => {}
            (WeldMap::Unwelded, Indices::U32(indices)) => indices[range].iter().copied().for_each(visit),
            (WeldMap::Unwelded, Indices::U16(indices)) => {
                indices[range].iter().copied().map(u32::from).for_each(visit);
            }
        }
    }

    /// Sets [`marks::NEEDS_GENERAL_PATH`] at the vertices of doubtful quads (see `quads.rs`) among
    /// `triangles`.
    ///
    /// `first`: the vertex to which the first of `marks` belongs.
    pub fn mark_doubtful_quads(&self, triangles: Range<usize>, first: u32, marks: &mut [u32]) {
        for &half in self.split.doubtful_among(triangles) {
            for vertex in [half, half + 1].into_iter().flat_map(|half| self.triangle(half)) {
                if let Some(marks) = marks.get_mut(vertex.wrapping_sub(first) as usize) {
                    *marks |= marks::NEEDS_GENERAL_PATH;
                }
            }
        }
    }
}
