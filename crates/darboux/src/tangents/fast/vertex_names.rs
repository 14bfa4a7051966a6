//! The reference's names of welded vertices, found on demand.
//!
//! The reference names a welded vertex after one of its corners: the first one after it has divided the
//! points of the vertex's cell into ranges. So a name lies between the vertex's first and last corner, and
//! these bounds nearly always suffice for a comparison. Where they do not, the cell is divided again.

use crate::topology::edge_sort::{Edges, tail_runs};
use crate::topology::weld::{CELL_COUNT, Cells, Point, for_each_final_range};
use crate::util::radix_sort::sort;

use crate::tangents::fast::edge_tail::{EdgeTail, LastEdges};
use crate::tangents::fast::triangle_list::TriangleBuffer;

/// The names of a mesh's vertices, as far as they are known. The memory is reused from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct VertexNames {
    /// The welded vertex of each entry of the triangle list.
    vertices: Vec<u32>,
    /// The lowest and the highest name that each welded vertex can have. They are equal where the name is
    /// known.
    bounds: Vec<[u32; 2]>,
    /// True for welded vertices whose names are being searched.
    is_wanted: Vec<bool>,
    /// The cell of each welded vertex.
    cell_of_vertex: Vec<u16>,
    /// All entries, sorted by cell.
    entries: Vec<u32>,
    /// The end of each cell in `entries`.
    cell_ends: Vec<u32>,
    /// The entries where the edges start that the reference sorts.
    edges: Vec<u32>,
    /// True for cells that have been divided.
    was_divided: Vec<bool>,
}

impl VertexNames {
    /// The last edges in runs, within which the reference matches them (see `crate::topology::edge_sort`). An
    /// edge is the entry where it starts.
    ///
    /// `vertex_count`: the number of welded vertices. `candidates`: the first triangles of all faces that can
    /// be degenerate, ascending.
    pub fn tail_runs(
        &mut self,
        tail: &EdgeTail<'_>,
        last: &LastEdges,
        vertex_count: usize,
        candidates: &[u32],
    ) -> Vec<Vec<u32>> {
        self.find_bounds(tail, vertex_count);
        self.sort_into_cells(tail);
        self.list_edges(tail, candidates);
        let mut edges = std::mem::take(&mut self.edges);
        let runs = tail_runs(&mut edges, last.name, last.count, &mut NamedEdges { tail, names: self });
        self.edges = edges;
        runs
    }

    /// The entries of `vertices`, ascending.
    pub fn entries_of(&self, vertices: &[u32]) -> impl Iterator<Item = u32> {
        let mut is_wanted = vec![false; self.bounds.len()];
        vertices.iter().for_each(|&vertex| is_wanted[vertex as usize] = true);
        let entries = (0..).zip(&self.vertices);
        entries.filter(move |(_, vertex)| is_wanted[**vertex as usize]).map(|(entry, _)| entry)
    }

    fn find_bounds(&mut self, tail: &EdgeTail<'_>, vertex_count: usize) {
        self.vertices.clear();
        let mut buffer = TriangleBuffer::default();
        for range in tail.list.windows() {
            let triangles = tail.list.triangles(range, &mut buffer);
            self.vertices.extend_from_slice(triangles.as_flattened());
        }
        self.bounds.clear();
        self.bounds.resize(vertex_count, [u32::MAX, 0]);
        for (&vertex, entry) in self.vertices.iter().zip(0..) {
            let corner = tail.list.corner(entry);
            let [low, high] = &mut self.bounds[vertex as usize];
            (*low, *high) = (corner.min(*low), corner.max(*high));
        }
    }

    fn sort_into_cells(&mut self, tail: &EdgeTail<'_>) {
        let cells = Cells::of(tail.bounds);
        let count = self.bounds.len() as u32;
        self.is_wanted.clear();
        self.is_wanted.resize(self.bounds.len(), false);
        self.cell_of_vertex.clear();
        self.cell_of_vertex.extend((0..count).map(|vertex| cells.at(tail.list.position(vertex)) as u16));
        self.was_divided.clear();
        self.was_divided.resize(CELL_COUNT, false);
        self.cell_ends.clear();
        self.cell_ends.resize(CELL_COUNT + 1, 0);
        for &vertex in &self.vertices {
            self.cell_ends[usize::from(self.cell_of_vertex[vertex as usize]) + 1] += 1;
        }
        for cell in 0..CELL_COUNT {
            self.cell_ends[cell + 1] += self.cell_ends[cell];
        }
        self.entries.resize(self.vertices.len(), 0);
        for (&vertex, entry) in self.vertices.iter().zip(0..) {
            let next = &mut self.cell_ends[usize::from(self.cell_of_vertex[vertex as usize])];
            self.entries[*next as usize] = entry;
            *next += 1;
        }
    }

    /// Lists the edges of all triangles with three distinct positions.
    fn list_edges(&mut self, tail: &EdgeTail<'_>, candidates: &[u32]) {
        self.edges.clear();
        let mut next = 0;
        for candidate in candidates.iter().flat_map(|&candidate| tail.list.face_of(candidate)) {
            let first = 3 * candidate;
            if tail.is_degenerate(self.vertices.as_chunks().0[candidate as usize]) {
                self.edges.extend(next..first);
                next = first + 3;
            }
        }
        self.edges.extend(next..self.vertices.len() as u32);
    }

    /// Finds the names of all vertices in those ranges of a cell's points that contain a wanted vertex; at
    /// the second search in a cell, the names of all its vertices.
    fn name_cell(&mut self, tail: &EdgeTail<'_>, cell: u32) {
        let cell = cell as usize;
        let start = if cell == 0 { 0 } else { self.cell_ends[cell - 1] };
        let (vertices, bounds) = (&self.vertices, &mut self.bounds);
        let vertex = |point: &Point| vertices[point.entry as usize];
        let point = |&entry: &u32| Point { position: tail.list.position(vertices[entry as usize]), entry };
        let mut points: Vec<Point> =
            self.entries[start as usize..self.cell_ends[cell] as usize].iter().map(point).collect();
        let all = std::mem::replace(&mut self.was_divided[cell], true);
        let is_wanted = |point: &Point| all || self.is_wanted[vertex(point) as usize];
        for_each_final_range(&mut points, &|points| points.iter().any(is_wanted), &mut |points| {
            // From the last point to the first, so that the corner at the first entry of each vertex remains
            // its name.
            for point in points.iter().rev() {
                bounds[vertex(point) as usize] = [tail.list.corner(point.entry); 2];
            }
        });
    }
}

/// The edges of a mesh, with the names of their vertices.
struct NamedEdges<'a> {
    tail: &'a EdgeTail<'a>,
    names: &'a mut VertexNames,
}

impl Edges for NamedEdges<'_> {
    #[inline(always)]
    fn ends(&self, edge: u32) -> [u32; 2] {
        let next = if edge % 3 == 2 { edge - 2 } else { edge + 1 };
        [edge, next].map(|entry| self.names.vertices[entry as usize])
    }

    #[inline(always)]
    fn bounds(&self, vertex: u32) -> [u32; 2] {
        self.names.bounds[vertex as usize]
    }

    fn resolve_names(&mut self, vertices: &[u32]) {
        let Self { tail, names } = self;
        let mut cells = Vec::new();
        for &vertex in vertices {
            let [low, high] = names.bounds[vertex as usize];
            if low < high {
                names.is_wanted[vertex as usize] = true;
                cells.push(u32::from(names.cell_of_vertex[vertex as usize]));
            }
        }
        sort(&mut cells);
        cells.dedup();
        cells.into_iter().for_each(|cell| names.name_cell(tail, cell));
        vertices.iter().for_each(|&vertex| names.is_wanted[vertex as usize] = false);
    }
}
