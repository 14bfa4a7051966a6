//! The reference's names of welded vertices, found where they are asked for.
//!
//! A vertex is named after one of its corners: the first when the reference has cut the points of its cell down to one range. So
//! a name lies between the vertex's first and last corner, which nearly always suffices. Elsewhere the cell is cut again.

use crate::topology::edge_sort::{Edges, tail_runs};
use crate::topology::weld::{CELLS, Cells, Point, for_each_final_range};
use crate::util::radix_sort::sort;

use crate::tangents::fast::edge_tail::{LastEdges, LastRun};
use crate::tangents::fast::input::TriangleBuffer;

/// The names of a mesh's vertices; the memory is kept from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct Names {
    /// The welded vertex of each entry.
    vertices: Vec<u32>,
    bounds: Vec<[u32; 2]>,
    is_wanted: Vec<bool>,
    /// The cell of each welded vertex.
    cell_of: Vec<u16>,
    /// All entries, by cell, and where each cell ends.
    entries: Vec<u32>,
    ends: Vec<u32>,
    edges: Vec<u32>,
    /// Of each cell.
    was_asked_for: Vec<bool>,
}

impl Names {
    /// The last edges in the reference's stretches (see `crate::topology::edge_sort`), as the entries where they start. `count` is that of
    /// welded vertices; `suspects` holds the first triangles of all faces that could be degenerate, ascending.
    pub fn tail_runs(
        &mut self,
        run: &LastRun<'_>,
        last: &LastEdges,
        count: usize,
        suspects: &[u32],
    ) -> Vec<Vec<u32>> {
        self.find_bounds(run, count);
        self.sort_into_cells(run);
        self.list_edges(run, suspects);
        let mut edges = std::mem::take(&mut self.edges);
        let stretches = tail_runs(&mut edges, last.name, last.count, &mut NamesIn { run, names: self });
        self.edges = edges;
        stretches
    }

    /// The entries of some vertices, ascending.
    pub fn entries_of(&self, vertices: &[u32]) -> impl Iterator<Item = u32> {
        let mut is_asked_for = vec![false; self.bounds.len()];
        vertices.iter().for_each(|&vertex| is_asked_for[vertex as usize] = true);
        let entries = (0..).zip(&self.vertices);
        entries.filter(move |(_, vertex)| is_asked_for[**vertex as usize]).map(|(entry, _)| entry)
    }

    fn find_bounds(&mut self, run: &LastRun<'_>, count: usize) {
        self.vertices.clear();
        let mut buffer = TriangleBuffer::default();
        for range in run.source.windows() {
            let triangles = run.source.triangles(range, &mut buffer);
            self.vertices.extend_from_slice(triangles.as_flattened());
        }
        self.bounds.clear();
        self.bounds.resize(count, [u32::MAX, 0]);
        for (&vertex, entry) in self.vertices.iter().zip(0..) {
            let corner = run.source.corner(entry);
            let [low, high] = &mut self.bounds[vertex as usize];
            (*low, *high) = (corner.min(*low), corner.max(*high));
        }
    }

    fn sort_into_cells(&mut self, run: &LastRun<'_>) {
        let cells = Cells::of(run.bounds);
        let count = self.bounds.len() as u32;
        self.is_wanted.clear();
        self.is_wanted.resize(self.bounds.len(), false);
        self.cell_of.clear();
        self.cell_of.extend((0..count).map(|vertex| cells.at(run.source.position(vertex)) as u16));
        self.was_asked_for.clear();
        self.was_asked_for.resize(CELLS, false);
        self.ends.clear();
        self.ends.resize(CELLS + 1, 0);
        for &vertex in &self.vertices {
            self.ends[usize::from(self.cell_of[vertex as usize]) + 1] += 1;
        }
        for cell in 0..CELLS {
            self.ends[cell + 1] += self.ends[cell];
        }
        self.entries.resize(self.vertices.len(), 0);
        for (&vertex, entry) in self.vertices.iter().zip(0..) {
            let next = &mut self.ends[usize::from(self.cell_of[vertex as usize])];
            self.entries[*next as usize] = entry;
            *next += 1;
        }
    }

    /// Lists the edges of all triangles with three distinct positions.
    fn list_edges(&mut self, run: &LastRun<'_>, suspects: &[u32]) {
        self.edges.clear();
        let mut next = 0;
        for suspect in suspects.iter().flat_map(|&suspect| run.source.face_of(suspect)) {
            let first = 3 * suspect;
            if run.is_degenerate(self.vertices.as_chunks().0[suspect as usize]) {
                self.edges.extend(next..first);
                next = first + 3;
            }
        }
        self.edges.extend(next..self.vertices.len() as u32);
    }

    /// Names all vertices in the ranges of a cell's points that hold a wanted vertex; when it is asked for again, all of the cell.
    fn name_cell(&mut self, run: &LastRun<'_>, cell: u32) {
        let cell = cell as usize;
        let start = if cell == 0 { 0 } else { self.ends[cell - 1] };
        let (vertices, bounds) = (&self.vertices, &mut self.bounds);
        let vertex = |point: &Point| vertices[point.entry as usize];
        let point = |&entry: &u32| Point { position: run.source.position(vertices[entry as usize]), entry };
        let mut points: Vec<Point> =
            self.entries[start as usize..self.ends[cell] as usize].iter().map(point).collect();
        let is_known = std::mem::replace(&mut self.was_asked_for[cell], true);
        let is_wanted = |point: &Point| is_known || self.is_wanted[vertex(point) as usize];
        for_each_final_range(&mut points, &|points| points.iter().any(is_wanted), &mut |points| {
            // From the last to the first: the corner at the first entry of each vertex remains its name.
            for point in points.iter().rev() {
                bounds[vertex(point) as usize] = [run.source.corner(point.entry); 2];
            }
        });
    }
}

/// The edges of a mesh, which names the vertices asked for.
struct NamesIn<'a> {
    run: &'a LastRun<'a>,
    names: &'a mut Names,
}

impl Edges for NamesIn<'_> {
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
        let Self { run, names } = self;
        let mut cells = Vec::new();
        for &vertex in vertices {
            let [low, high] = names.bounds[vertex as usize];
            if low < high {
                names.is_wanted[vertex as usize] = true;
                cells.push(u32::from(names.cell_of[vertex as usize]));
            }
        }
        sort(&mut cells);
        cells.dedup();
        cells.into_iter().for_each(|cell| names.name_cell(run, cell));
        vertices.iter().for_each(|&vertex| names.is_wanted[vertex as usize] = false);
    }
}
