//! One thread's memory.

use std::ops::Range;

use crate::tangents::fast::accumulator::{Unused, Vertex};
use crate::tangents::fast::input::TriangleBuffer;
use crate::tangents::fast::kernel::Block;
use crate::tangents::fast::passes::Special;
use crate::tangents::fast::rows::RowBuffer;
use crate::tangents::fast::vertex_hash::Span;

/// What a thread uses again from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct Worker {
    pub block: Box<Block>,
    pub rows: RowBuffer,
    pub triangles: TriangleBuffer,
    /// Vertices of corners, where they do not lie one after the other in the mesh.
    pub corners: Vec<u32>,
    /// The vertices from `first` on, of which `read` have been read.
    pub vertices: Vec<Vertex>,
    /// What the corners of each vertex say of it.
    pub marks: Vec<u32>,
    pub first: usize,
    pub read: usize,
    /// Windows with vertices that other threads finish.
    pub pending: Vec<usize>,
    pub special: Special,
    /// The quads that it has cut of which `Cut` wants to know.
    pub doubtful: Vec<u32>,
    /// Of its vertices' values.
    pub span: Span,
    /// Its hashes that were met before.
    pub collisions: usize,
    /// The bits in which its corners are not what they were welded to.
    pub difference: u32,
    /// Its decided vertices have usable tangents.
    pub all_usable: bool,
    /// Its vertices that no triangle uses.
    pub unused: Unused,
}

impl Worker {
    /// Makes room for vertices.
    pub fn begin(&mut self, vertices: Range<usize>) {
        self.vertices.resize(vertices.len(), Vertex::default());
        self.marks.resize(vertices.len(), 0);
        (self.first, self.read, self.unused) = (vertices.start, 0, Unused::default());
        self.all_usable = true;
        self.pending.clear();
        self.special.clear();
    }

    /// The end of the vertices that have been read.
    pub fn end(&self) -> usize {
        self.first + self.read
    }

    /// A vertex by its number.
    pub fn vertex(&self, number: u32) -> &Vertex {
        &self.vertices[number as usize - self.first]
    }
}
