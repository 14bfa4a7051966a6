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
    /// The vertices from number `first` on. The first `read` of them hold values. A streamed pass drops
    /// vertices that no later window needs, so that the others stay in the cache.
    pub vertices: Vec<VertexAccumulator>,
    /// The marks of each vertex.
    pub marks: Vec<u32>,
    pub first: usize,
    pub read: usize,
    /// The end of the vertices that the pass reads.
    last_end: usize,
    /// Finished vertices that pending windows need: those from number `first_kept` on.
    kept: Vec<VertexAccumulator>,
    first_kept: usize,
    /// Windows with vertices that other threads finish.
    pub pending: Vec<usize>,
    /// The end of their vertices.
    pending_end: usize,
    pub exceptions: Exceptions,
    pub findings: Findings,
    /// The range of the values that the thread has hashed.
    pub value_range: ValueRange,
    /// The hashes of the thread's vertices. The first worker's are merged with those of all.
    pub seen_hashes: SeenHashes,
    /// Not zero where a corner differs from the record that it was welded to.
    pub corners_differ: u32,
}

impl Worker {
    /// Prepares a pass whose thread reads `vertices`, and finishes those from number `first_own` on.
    pub fn begin(&mut self, vertices: Range<usize>, first_own: usize) {
        (self.first, self.read, self.last_end) = (vertices.start, 0, vertices.end);
        self.first_kept = first_own;
        self.findings.clear();
        self.kept.clear();
        self.pending.clear();
        self.pending_end = 0;
        self.exceptions.clear();
        self.block.flat_triangles = 0;
    }

    /// The end of the vertices that have been read.
    pub fn end(&self) -> usize {
        self.first + self.read
    }

    /// Lists a window that other threads have to finish vertices for. `end`: the end of the window's
    /// vertices.
    pub fn list_pending(&mut self, window: usize, end: usize) {
        self.pending.push(window);
        self.pending_end = self.pending_end.max(end);
    }

    /// Makes room for the vertices up to number `end`. Where there is none, those below number `needed` are
    /// dropped; all windows that are pending because of lower vertices have been listed by then.
    pub fn make_room(&mut self, needed: usize, end: usize) {
        if end - self.first <= self.vertices.len() {
            return;
        }
        let needed = needed.clamp(self.first, self.end());
        let (kept, dropped) = (self.first_kept + self.kept.len(), needed.min(self.pending_end));
        if kept < dropped {
            self.kept.extend_from_slice(&self.vertices[kept - self.first..dropped - self.first]);
        }
        let moved = needed - self.first..self.read;
        (self.first, self.read) = (needed, moved.len());
        self.vertices.copy_within(moved.clone(), 0);
        self.marks.copy_within(moved, 0);
        // At least half of the room is free afterwards, so that few vertices are moved often.
        let room = (2 * (end - self.first)).max(MIN_ROOM).min(self.last_end - self.first);
        if room > self.vertices.len() {
            self.vertices.resize(room, VertexAccumulator::default());
            self.marks.resize(room, 0);
        }
    }

    /// A vertex that a pending window needs.
    pub fn pending_vertex(&self, number: u32) -> &VertexAccumulator {
        let number = number as usize;
        self.kept.get(number - self.first_kept).unwrap_or_else(|| &self.vertices[number - self.first])
    }
}

/// The least room for vertices of a streamed pass: a quarter of the second-level cache.
const MIN_ROOM: usize = if cfg!(small_limits) { 4 } else { 4096 };

/// What a thread finds when it finishes vertices.
#[derive(Debug)]
pub(crate) struct Findings {
    /// The number of vertices that no window uses, and which were never read.
    pub unread: usize,
    /// The number of vertices that were read and that no triangle uses.
    pub unused: usize,
    /// The bounds of the latter.
    unused_bounds: Option<Bounds>,
    /// True while all tangents with a planned sign need no repair.
    pub all_usable: bool,
    /// The vertices that were decided because their triangles all have no UV area.
    pub flat_vertices: Vec<u32>,
}

impl Default for Findings {
    fn default() -> Self {
        Self { unread: 0, unused: 0, unused_bounds: None, all_usable: true, flat_vertices: Vec::new() }
    }
}

impl Findings {
    /// Forgets all but the memory.
    fn clear(&mut self) {
        let mut flat_vertices = std::mem::take(&mut self.flat_vertices);
        flat_vertices.clear();
        *self = Self { flat_vertices, ..Self::default() };
    }

    #[cold]
    pub fn note_unused(&mut self, position: [f32; 3]) {
        let bounds = self.unused_bounds.unwrap_or(Bounds { min: position, max: position });
        self.unused_bounds = Some(Bounds::of(bounds.min, [bounds.max, position].into_iter()));
        self.unused += 1;
    }

    /// True when all unused vertices that were read lie inside the bounds of all vertices, which then are the
    /// bounds of the used ones.
    pub fn unused_are_inside(&self, all: &Bounds) -> bool {
        let inside =
            |bounds: Bounds| (0..3).all(|i| bounds.min[i] > all.min[i] && bounds.max[i] < all.max[i]);
        self.unused_bounds.is_none_or(inside)
    }
}
