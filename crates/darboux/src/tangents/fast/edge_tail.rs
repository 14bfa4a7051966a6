//! The reference's last edges: whether their order changes the result.
//!
//! The reference finds neighbours by sorting edges by the names of their two vertices. Those edges whose
//! lower name is the largest of all, the *last edges*, stay in the order of an unstable sort. That order
//! changes the result when the last edges are more than two and two of them join the same vertices; then the
//! sort itself is repeated (see `vertex_names.rs` and `crate::topology::edge_sort`).
//!
//! Which edges are the last ones depends on names, and a vertex is named after one of its corners (see
//! `crate::topology::weld`). Large names belong to vertices that the last triangles of the list use, the
//! *triangle tail*. The reference finds names cell by cell, where a cell is one of 2048 slabs of the bounding
//! box; so only cells in which the triangle tail has vertices have to be examined, and of these only the ones
//! with a vertex whose first and last corner do not say enough (`tail_names.rs`):
//!
//! ```text
//! tail = the last few triangles that have edges
//! repeat
//!     bounds = the first and the last corner of each vertex of the tail
//!     best = the highest lower name that an edge certainly has, by the bounds; at least the first corner of the tail
//!     for the triangles with an edge that can have a higher lower name, in the order of this possibility, while it exceeds best:
//!         find the names of those of its vertices whose bounds do not decide
//!         best = max(best, the lower name of the edge between its two vertices with the largest names)
//!     if an edge was found or the tail is the whole list: the last edges are those with the lower name best
//!     tail = a tail four times as long
//! ```
//!
//! Proof: an edge whose lower name is a corner of the tail joins two vertices with corners in the tail, and
//! the two largest names of its triangle are no smaller than its own.
//!
//! Bounds and names need the entries of the vertices in the tail's cells only. Those of the first tail are
//! found in passing, unless the list is short: the pass over the triangles sets the flag `IN_TAIL`
//! (`accumulator.rs`) of vertices in the cells when it finishes them, and lists their corners when it writes
//! these (`exceptions.rs`).

use crate::topology::neighbours::tail_order_matters;
use crate::topology::weld::{Bounds, CellSet, Cells, Point};
use crate::util::radix_sort::{sort, sort_by_key};

use crate::tangents::fast::tail_names::{TailEntries, TailNames};
use crate::tangents::fast::triangle_list::{TriangleBuffer, TriangleList};
use crate::tangents::fast::vertex_record::{VertexRecord, position_of};

/// The number of triangles of the first tail, where triangles that share vertices are near each other in the
/// list.
const FIRST_TAIL: usize = if cfg!(small_limits) { 1 } else { 4 };
/// The number of triangles of the first tail of a shuffled list, in which fewer triangles have vertices that
/// are named after the end.
const FIRST_TAIL_SHUFFLED: usize = 4 * FIRST_TAIL;
/// The same of a short list, where a longer one costs nothing.
const FIRST_TAIL_SHORT: usize = 8 * FIRST_TAIL;
/// Lists of fewer triangles are short.
const SHORT: usize = if cfg!(small_limits) { 4 } else { 1024 };

/// Some of the cells of a mesh.
#[derive(Debug)]
struct SomeCells {
    cells: Cells,
    wanted: CellSet,
    /// The lowest and highest coordinate along the cells' axis at which a wanted cell can lie.
    low: f32,
    high: f32,
}

impl SomeCells {
    /// The cells of some positions. `bounds`: of the positions of all used vertices.
    fn of(bounds: &Bounds, positions: impl Iterator<Item = [f32; 3]>) -> Self {
        let (cells, wanted) = (Cells::of(bounds), CellSet::default());
        let mut some = Self { cells, wanted, low: f32::INFINITY, high: f32::NEG_INFINITY };
        for position in positions {
            some.wanted.insert(cells.at(position));
            let along = position[cells.axis];
            (some.low, some.high) = (some.low.min(along), some.high.max(along));
        }
        // One more cell on either side, and rounding.
        let margin = 1.01 * cells.thickness() + 1e-6 * (some.low.abs() + some.high.abs());
        (some.low, some.high) = (some.low - margin, some.high + margin);
        some
    }

    /// The cell of a position, if it is one of these.
    #[inline(always)]
    fn at(&self, position: [f32; 3]) -> Option<u16> {
        let along = position[self.cells.axis];
        let is_near = (along >= self.low) & (along <= self.high);
        if is_near { self.wanted_cell(position) } else { None }
    }

    #[inline(never)]
    fn wanted_cell(&self, position: [f32; 3]) -> Option<u16> {
        let cell = self.cells.at(position);
        self.wanted.contains(cell).then_some(cell as u16)
    }
}

/// The first triangle tail, and the cells in which it has vertices.
#[derive(Debug)]
pub(crate) struct TailCells {
    /// The first triangle of the tail. It begins a face, so the corners of the tail are those from its first
    /// corner on.
    start: usize,
    /// None where the list is short.
    cells: Option<SomeCells>,
    /// The axis, and the lowest and highest coordinate along it, of the cells; no coordinate where the list
    /// is short.
    axis: usize,
    low: f32,
    high: f32,
}

impl TailCells {
    /// The first tail to examine: a few triangles that have edges, and the degenerate triangles between and
    /// after them.
    ///
    /// `bounds`: of the positions of all used vertices.
    pub fn first(list: &TriangleList<'_>, bounds: &Bounds, is_shuffled: bool) -> Self {
        let is_short = is_shuffled && list.count() < SHORT;
        let tail = match is_shuffled {
            true if is_short => FIRST_TAIL_SHORT,
            true => FIRST_TAIL_SHUFFLED,
            false => FIRST_TAIL,
        };
        let mut with_edges = (0..list.count()).rev().filter(|&triangle| {
            let positions = list.triangle(triangle as u32).map(|vertex| list.position(vertex));
            !are_degenerate(positions)
        });
        let start = start_of_face(list, with_edges.nth(tail - 1).unwrap_or(0));
        let cells = (!is_short).then(|| cells_of_tail(list, bounds, start));
        let (axis, low, high) = match &cells {
            Some(SomeCells { cells, low, high, .. }) => (cells.axis, *low, *high),
            None => (0, f32::INFINITY, f32::NEG_INFINITY),
        };
        Self { start, cells, axis, low, high }
    }

    /// True for vertices in these cells, if the entries of the vertices in them are listed by the pass over
    /// the triangles.
    #[inline(always)]
    pub fn contain(&self, record: &VertexRecord) -> bool {
        let along = record[self.axis % record.len()];
        (along >= self.low) & (along <= self.high) && self.contain_near(record)
    }

    #[inline(never)]
    fn contain_near(&self, record: &VertexRecord) -> bool {
        self.cells.as_ref().is_some_and(|cells| cells.wanted_cell(position_of(*record)).is_some())
    }
}

/// The cells in which the triangles from `start` on have vertices.
fn cells_of_tail(list: &TriangleList<'_>, bounds: &Bounds, start: usize) -> SomeCells {
    let vertices = (start..list.count()).flat_map(|triangle| list.triangle(triangle as u32));
    SomeCells::of(bounds, vertices.map(|vertex| list.position(vertex)))
}

/// The first triangle of the face that contains a triangle.
fn start_of_face(list: &TriangleList<'_>, triangle: usize) -> usize {
    list.face_of(triangle as u32).start as usize
}

/// The last edges.
#[derive(Debug)]
pub(crate) struct LastEdges {
    /// The name of their lower vertex.
    pub name: u32,
    pub count: usize,
    /// Both vertices of all of them, ascending.
    pub vertices: Vec<u32>,
}

/// A triangle with an edge that can be one of the last ones.
#[derive(Clone, Copy, Debug)]
struct Contender {
    vertices: [u32; 3],
    /// The highest lower name that an edge of it can have.
    highest: u32,
}

/// The lists of a search. The memory is reused from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct TailBuffers {
    points: Vec<Point>,
    cell_of_point: Vec<u16>,
    cell_of_vertex: Vec<u16>,
    names: TailNames,
    contenders: Vec<Contender>,
    sort_buffer: Vec<Contender>,
    /// The upper vertices of the last edges.
    uppers: Vec<u32>,
}

/// The mesh in which the last edges are searched.
#[derive(Clone, Copy)]
pub(crate) struct EdgeTail<'a> {
    pub list: TriangleList<'a>,
    /// The number of welded vertices.
    pub vertex_count: usize,
    /// The bounds of the positions of all used vertices.
    pub bounds: &'a Bounds,
}

impl EdgeTail<'_> {
    /// The last edges. None where their order does not matter.
    ///
    /// `points`: the entries of all vertices in the cells of the first tail, ascending; none if they were not
    /// listed.
    pub fn find(
        &self,
        first: &TailCells,
        points: Option<&[Point]>,
        buffers: &mut TailBuffers,
    ) -> Option<LastEdges> {
        let is_short = first.cells.is_none();
        let mut start = first.start;
        let mut name = match (points, &first.cells) {
            (Some(points), Some(cells)) => self.find_name_among(points, None, &cells.cells, start, buffers),
            _ if is_short => self.find_name(start, buffers),
            _ => self.find_name_in_cells(start, buffers),
        };
        while name.is_none() && start > 0 {
            let tail = 4 * (self.list.count() - start);
            start = start_of_face(&self.list, self.list.count().saturating_sub(tail));
            name = if is_short {
                self.find_name(start, buffers)
            } else {
                self.find_name_in_cells(start, buffers)
            };
        }
        last_edges(name?, buffers)
    }

    /// The largest lower name of an edge, if it is a corner of the tail that begins with the triangle
    /// `start`. The edges that have it are then those of the contenders whose second largest name it is.
    fn find_name(&self, start: usize, buffers: &mut TailBuffers) -> Option<u32> {
        let TailBuffers { points, cell_of_point, cell_of_vertex, names, contenders, sort_buffer, .. } =
            buffers;
        names.start(&self.list, self.vertex_count, start);
        contenders.clear();
        let mut buffer = TriangleBuffer::default();
        for range in self.list.windows() {
            let triangles = self.list.triangles(range.clone(), &mut buffer);
            for (&vertices, triangle) in triangles.iter().zip(range.start as u32..) {
                if names.has_bounded(vertices) {
                    self.add_contender(vertices, self.list.corners(triangle), names, contenders);
                }
            }
        }
        let least = sort_contenders(self.list.corner(3 * start as u32), names, contenders, sort_buffer);
        let cells = self.unclear_cells(least, names, contenders);
        self.list_points(&cells, points, cell_of_point, cell_of_vertex);
        let entries =
            TailEntries { list: self.list, cells: &cells.cells, points, cell_of_point: Some(cell_of_point) };
        largest_lower_name(least, &entries, names, contenders)
    }

    /// As [`Self::find_name`], for a long list: reads the triangles once, and only the entries in the cells
    /// of the tail again.
    fn find_name_in_cells(&self, start: usize, buffers: &mut TailBuffers) -> Option<u32> {
        let cells = cells_of_tail(&self.list, self.bounds, start);
        let mut points = std::mem::take(&mut buffers.points);
        let mut cell_of_point = std::mem::take(&mut buffers.cell_of_point);
        self.list_points(&cells, &mut points, &mut cell_of_point, &mut buffers.cell_of_vertex);
        let name = self.find_name_among(&points, Some(&cell_of_point), &cells.cells, start, buffers);
        (buffers.points, buffers.cell_of_point) = (points, cell_of_point);
        name
    }

    /// As [`Self::find_name`]. `points`: the entries of all vertices in the cells of the tail, ascending.
    /// `cell_of_point`: their cells, if they are known.
    fn find_name_among(
        &self,
        points: &[Point],
        cell_of_point: Option<&[u16]>,
        cells: &Cells,
        start: usize,
        buffers: &mut TailBuffers,
    ) -> Option<u32> {
        let TailBuffers { names, contenders, sort_buffer, .. } = buffers;
        names.start(&self.list, self.vertex_count, start);
        contenders.clear();
        for entries in points.chunk_by(|a, b| a.entry / 3 == b.entry / 3) {
            let triangle = entries[0].entry / 3;
            self.add_contender(self.list.triangle(triangle), self.list.corners(triangle), names, contenders);
        }
        let least = sort_contenders(self.list.corner(3 * start as u32), names, contenders, sort_buffer);
        let entries = TailEntries { list: self.list, cells, points, cell_of_point };
        largest_lower_name(least, &entries, names, contenders)
    }

    /// The cells of the vertices of contenders whose names are not known and may be `least` or more.
    fn unclear_cells(&self, least: u32, names: &TailNames, contenders: &[Contender]) -> SomeCells {
        let vertices = contenders.iter().flat_map(|contender| contender.vertices);
        let unclear = vertices.filter(|&vertex| names.is_unclear(vertex, least));
        SomeCells::of(self.bounds, unclear.map(|vertex| self.list.position(vertex)))
    }

    /// Adds the corners of a triangle to the bounds of its vertices, and lists it if two or more have bounds.
    #[inline(never)]
    fn add_contender(
        &self,
        vertices: [u32; 3],
        corners: [u32; 3],
        names: &mut TailNames,
        contenders: &mut Vec<Contender>,
    ) {
        if names.add_to_bounded(vertices, corners) > 1 && !self.is_degenerate(vertices) {
            contenders.push(Contender { vertices, highest: 0 });
        }
    }

    /// Lists the entries of all vertices in some cells, ascending, and their cells. Positions are tested once
    /// per vertex: a test per corner would wait for memory at each of them.
    fn list_points(
        &self,
        cells: &SomeCells,
        points: &mut Vec<Point>,
        cell_of_point: &mut Vec<u16>,
        cell_of_vertex: &mut Vec<u16>,
    ) {
        const NONE: u16 = u16::MAX;
        let position = |vertex| self.list.position(vertex);
        cell_of_vertex.clear();
        cell_of_vertex
            .extend((0..self.vertex_count as u32).map(|vertex| cells.at(position(vertex)).unwrap_or(NONE)));
        points.clear();
        cell_of_point.clear();
        let mut buffer = TriangleBuffer::default();
        for range in self.list.windows() {
            let first = 3 * range.start as u32;
            for (vertices, entry) in self.list.triangles(range, &mut buffer).iter().zip((first..).step_by(3))
            {
                let cells = vertices.map(|vertex| cell_of_vertex[vertex as usize]);
                // All bits are set where there is none.
                if cells[0] & cells[1] & cells[2] == NONE {
                    continue;
                }
                for ((&vertex, cell), entry) in vertices.iter().zip(cells).zip(entry..) {
                    if cell != NONE {
                        points.push(Point { position: position(vertex), entry });
                        cell_of_point.push(cell);
                    }
                }
            }
        }
    }

    /// True for triangles with two equal positions. The reference ignores their edges.
    pub fn is_degenerate(&self, triangle: [u32; 3]) -> bool {
        are_degenerate(triangle.map(|vertex| self.list.position(vertex)))
    }
}

/// Removes the contenders whose edges cannot have the largest lower name, and sorts the others, the highest
/// first. Returns a lower bound of the largest lower name, `least` or more.
fn sort_contenders(
    mut least: u32,
    names: &TailNames,
    contenders: &mut Vec<Contender>,
    sort_buffer: &mut Vec<Contender>,
) -> u32 {
    for contender in &mut *contenders {
        contender.highest = names.largest(contender.vertices)[0].0;
        least = least.max(names.least_lower(contender.vertices));
    }
    contenders.retain(|contender| contender.highest >= least);
    sort_by_key(contenders, |contender| (!contender.highest).into(), sort_buffer);
    least
}

/// The largest lower name of an edge of the contenders, if it is `best` or more.
fn largest_lower_name(
    mut best: u32,
    entries: &TailEntries<'_>,
    names: &mut TailNames,
    contenders: &[Contender],
) -> Option<u32> {
    let mut found = None;
    for &Contender { vertices, highest } in contenders {
        if highest < best {
            break;
        }
        names.resolve(entries, vertices, best);
        let [(lower, _), _] = names.largest(vertices);
        if lower >= best {
            best = lower;
            found = Some(lower);
        }
    }
    found
}

/// The edges whose lower name is `name`, the largest of all. None where their order does not matter.
fn last_edges(name: u32, buffers: &mut TailBuffers) -> Option<LastEdges> {
    let TailBuffers { names, contenders, uppers, .. } = buffers;
    let mut lower = None;
    uppers.clear();
    for [(of_lower, vertex), (_, upper)] in
        contenders.iter().map(|contender| names.largest(contender.vertices))
    {
        if of_lower == name {
            lower = Some(vertex);
            uppers.push(upper);
        }
    }
    sort(uppers);
    if !tail_order_matters(uppers.iter()) {
        return None;
    }
    let count = uppers.len();
    uppers.dedup();
    let mut vertices: Vec<u32> = uppers.iter().copied().chain(lower).collect();
    sort(&mut vertices);
    Some(LastEdges { name, count, vertices })
}

/// True where two positions of a triangle are equal.
pub(crate) fn are_degenerate([a, b, c]: [[f32; 3]; 3]) -> bool {
    a == b || b == c || c == a
}
