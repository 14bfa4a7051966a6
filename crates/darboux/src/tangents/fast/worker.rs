//! The memory of one thread, reused from mesh to mesh, and what the thread has found.

use std::ops::Range;

use crate::topology::weld::Bounds;

use crate::tangents::fast::accumulator::VertexAccumulator;
use crate::tangents::fast::exceptions::Exceptions;
use crate::tangents::fast::hash_table::SeenHashes;
use crate::tangents::fast::kernel::TriangleBlock;
use crate::tangents::fast::triangle_list::TriangleBuffer;
use crate::tangents::fast::vertex_hash::ValueRange;
use crate::tangents::fast::vertex_record::SliceBuffer;

/// The memory of one thread.
#[derive(Debug, Default)]
pub(crate) struct Worker {
    pub block: Box<TriangleBlock>,
    pub slices: SliceBuffer,
    pub triangles: TriangleBuffer,
    /// The vertices of corners, where they are not contiguous in the mesh.
    pub corner_vertices: Vec<u32>,
    /// The vertices from number `first` on. The first `read` of them hold values.
    pub vertices: Vec<VertexAccumulator>,
    /// The marks of each vertex.
    pub marks: Vec<u32>,
    pub first: usize,
    pub read: usize,
    /// Windows with vertices that other threads finish.
    pub pending: Vec<usize>,
    pub exceptions: Exceptions,
    pub findings: Findings,
    /// The range of the values that the thread has hashed.
    pub value_range: ValueRange,
    /// The hashes of the thread's vertices. The first worker's are merged with those of all.
    pub seen_hashes: SeenHashes,
    /// The bits in which corners differ from the record that they were welded to.
    pub differing_bits: u32,
}

impl Worker {
    /// Prepares a pass over `vertices`.
    pub fn begin(&mut self, vertices: Range<usize>) {
        self.vertices.resize(vertices.len(), VertexAccumulator::default());
        self.marks.resize(vertices.len(), 0);
        (self.first, self.read) = (vertices.start, 0);
        self.findings = Findings::default();
        self.pending.clear();
        self.exceptions.clear();
    }

    /// The end of the vertices that have been read.
    pub fn end(&self) -> usize {
        self.first + self.read
    }

    /// The vertex of a number.
    pub fn vertex(&self, number: u32) -> &VertexAccumulator {
        &self.vertices[number as usize - self.first]
    }
}

/// What a thread finds when it finishes vertices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Findings {
    /// The number of vertices that no window uses, and which were never read.
    pub unread: usize,
    /// The number of vertices that were read and that no triangle uses.
    pub unused: usize,
    /// The bounds of the latter.
    unused_bounds: Option<Bounds>,
    /// True while all tangents with a planned sign need no repair.
    pub all_usable: bool,
}

impl Default for Findings {
    fn default() -> Self {
        Self { unread: 0, unused: 0, unused_bounds: None, all_usable: true }
    }
}

impl Findings {
    #[cold]
    pub fn note_unused(&mut self, position: [f32; 3]) {
        let bounds = self.unused_bounds.unwrap_or(Bounds { min: position, max: position });
        self.unused_bounds = Some(Bounds::of(bounds.min, [bounds.max, position].into_iter()));
        self.unused += 1;
    }

    /// True when all unused vertices that were read lie inside the bounds of all vertices, which then are the bounds of the used ones.
    pub fn unused_are_inside(&self, all: &Bounds) -> bool {
        let inside =
            |bounds: Bounds| (0..3).all(|i| bounds.min[i] > all.min[i] && bounds.max[i] < all.max[i]);
        self.unused_bounds.is_none_or(inside)
    }
}
