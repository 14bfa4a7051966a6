//! The reference's last edges: whether their order changes the result.
//!
//! The reference finds neighbours by sorting edges by the names of their two vertices. Those edges whose lower name is the largest of
//! all, the *last edges*, stay in the order of an unstable sort. That order changes the result when the last edges are more than two
//! and two of them join the same vertices; then the sort itself is repeated (see `vertex_names.rs` and `crate::topology::edge_sort`).
//!
//! Which edges are the last ones depends on names, and a vertex is named after one of its corners (see `crate::topology::weld`). Large
//! names belong to vertices that the last triangles of the list use, the *triangle tail*. The reference finds names cell by cell,
//! where a cell is one of 2048 slabs of the bounding box; so only cells in which the triangle tail has vertices have to be examined:
//!
//! ```text
//! tail = the last few triangles that have edges
//! repeat
//!     cells = the cells in which triangles of the tail have vertices
//!     points = all entries of the triangle list whose vertex lies in one of the cells
//!     name the vertices of the points, cell by cell, as the reference does
//!     edges = for each triangle with two or three vertices named after corners of the tail:
//!             the edge between the two with the largest names
//!     if there are edges or the tail is the whole list: the last edges are those with the largest lower name
//!     tail = a tail four times as long
//! ```
//!
//! Proof: an edge whose lower name is a corner of the tail belongs to a triangle in which two vertices are named after corners of the
//! tail, and the edge that is listed for this triangle has no smaller lower name.
//!
//! The first points are found in passing: the pass over the triangles sets the flag `IN_TAIL` (`accumulator.rs`) of vertices in the cells
//! when it finishes them, and lists their corners when it writes these (`exceptions.rs`).

use crate::exec::threads;
use crate::topology::neighbours::tail_order_matters;
use crate::topology::weld::{Bounds, CELL_COUNT, CellBuckets, Cells, Point, for_each_final_range};
use crate::util::radix_sort::{first, pair, second, sort};

use crate::tangents::fast::triangle_list::{TriangleBuffer, TriangleList};

/// The number of triangles of the first tail, where triangles that share vertices are near each other in the list.
const FIRST_TAIL: usize = if cfg!(small_limits) { 1 } else { 4 };
/// The number of triangles of the first tail of a shuffled list, in which fewer triangles have vertices that are named after the end.
const FIRST_TAIL_SHUFFLED: usize = 4 * FIRST_TAIL;
/// The same of a short list, in which any tail has vertices in most cells, so that a second one would cost as much as a run.
const FIRST_TAIL_SHORT: usize = 8 * FIRST_TAIL;
/// Lists of fewer triangles are short.
const SHORT: usize = if cfg!(small_limits) { 4 } else { 1024 };
/// Cells with fewer points are divided on one thread.
const POINTS_FOR_THREADS: usize = if cfg!(small_limits) { 4 } else { 4096 };

/// The cells in which a triangle tail has vertices.
#[derive(Debug)]
pub(crate) struct TailCells {
    /// The first triangle of the tail. It begins a face, so the corners of the tail are those from its first corner on.
    start: usize,
    cells: Cells,
    /// True for each cell that contains a vertex of the tail.
    is_wanted: [bool; CELL_COUNT],
    /// The lowest and highest coordinate along the cells' axis at which a wanted cell can lie.
    low: f32,
    high: f32,
}

impl TailCells {
    /// The cells of the tail that begins with the face of `triangle`. `bounds`: of the positions of all used vertices.
    fn new(list: &TriangleList<'_>, bounds: &Bounds, triangle: usize) -> Self {
        let start = list.face_of(triangle as u32).start as usize;
        let cells = Cells::of(bounds);
        let mut tail = Self {
            start,
            cells,
            is_wanted: [false; CELL_COUNT],
            low: f32::INFINITY,
            high: f32::NEG_INFINITY,
        };
        for vertex in (start..list.count()).flat_map(|triangle| list.triangle(triangle as u32)) {
            let position = list.position(vertex);
            tail.is_wanted[cells.at(position)] = true;
            let along = position[cells.axis];
            (tail.low, tail.high) = (tail.low.min(along), tail.high.max(along));
        }
        // One more cell on either side, and rounding.
        let margin = 1.01 / CELL_COUNT as f32 * cells.extent + 1e-6 * (tail.low.abs() + tail.high.abs());
        (tail.low, tail.high) = (tail.low - margin, tail.high + margin);
        tail
    }

    /// The cells of the first tail to examine: a few triangles that have edges, and the degenerate triangles between and after them.
    pub fn first(list: &TriangleList<'_>, bounds: &Bounds, is_shuffled: bool) -> Self {
        let tail = match is_shuffled {
            true if list.count() < SHORT => FIRST_TAIL_SHORT,
            true => FIRST_TAIL_SHUFFLED,
            false => FIRST_TAIL,
        };
        let mut with_edges = (0..list.count()).rev().filter(|&triangle| {
            let positions = list.triangle(triangle as u32).map(|vertex| list.position(vertex));
            !are_degenerate(positions)
        });
        Self::new(list, bounds, with_edges.nth(tail - 1).unwrap_or(0))
    }

    /// True for positions in these cells.
    #[inline(always)]
    pub fn contain(&self, position: [f32; 3]) -> bool {
        let [x, y, z] = position;
        let along = match self.cells.axis {
            0 => x,
            1 => y,
            _ => z,
        };
        (along >= self.low) & (along <= self.high) && self.is_in_wanted_cell(position)
    }

    #[inline(never)]
    fn is_in_wanted_cell(&self, position: [f32; 3]) -> bool {
        self.is_wanted[self.cells.at(position)]
    }
}

/// The names of an edge's vertices, the lower first, and the vertices themselves.
#[derive(Clone, Copy, Debug)]
struct Edge {
    names: [u32; 2],
    vertices: [u32; 2],
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

impl LastEdges {
    /// The edges with the largest lower name among the listed ones. None where their order does not matter.
    fn of(buffers: &mut TailBuffers) -> Option<Self> {
        let TailBuffers { edges, upper_names, .. } = buffers;
        let name = edges.iter().map(|edge| edge.names[0]).max()?;
        edges.retain(|edge| edge.names[0] == name);
        upper_names.clear();
        upper_names.extend(edges.iter().map(|edge| edge.names[1]));
        sort(upper_names);
        if !tail_order_matters(upper_names.iter()) {
            return None;
        }
        let mut vertices: Vec<u32> = edges.iter().flat_map(|edge| edge.vertices).collect();
        sort(&mut vertices);
        vertices.dedup();
        Some(Self { name, count: edges.len(), vertices })
    }
}

fn sorted<T: PartialOrd>(a: T, b: T) -> (T, T) {
    if b < a { (b, a) } else { (a, b) }
}

/// The lists of a search. The memory is reused from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct TailBuffers {
    points: Vec<Point>,
    buckets: CellBuckets,
    /// Those of each thread.
    naming: Vec<NamingBuffers>,
    edges: Vec<Edge>,
    /// The names of the last edges' upper vertices, ascending.
    upper_names: Vec<u32>,
}

/// The lists of one thread that names vertices.
#[derive(Debug, Default)]
struct NamingBuffers {
    /// Pairs of an entry and a name: the entries of vertices that are named after a corner of the tail.
    named: Vec<u64>,
    /// Pairs of a vertex and the index of its point in one range.
    of_range: Vec<u64>,
}

impl TailBuffers {
    /// Prepares a search on up to `threads` threads, at least one.
    pub fn set_threads(&mut self, threads: usize) {
        self.naming.resize_with(threads.max(1), NamingBuffers::default);
    }
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
    /// `cells`: those of the first tail. `points`: the entries of all vertices in these cells, ascending; none if they have to be searched.
    pub fn find(
        &self,
        mut cells: TailCells,
        points: Option<&[Point]>,
        buffers: &mut TailBuffers,
    ) -> Option<LastEdges> {
        match points {
            Some(points) => self.list_edges_among(&cells, points, buffers),
            None => self.list_edges(&cells, buffers),
        }
        while buffers.edges.is_empty() && cells.start > 0 {
            let tail = 4 * (self.list.count() - cells.start);
            cells = TailCells::new(&self.list, self.bounds, self.list.count().saturating_sub(tail));
            self.list_edges(&cells, buffers);
        }
        LastEdges::of(buffers)
    }

    /// Lists one edge of every triangle that has two or three vertices named after corners of the tail.
    fn list_edges(&self, cells: &TailCells, buffers: &mut TailBuffers) {
        let mut points = std::mem::take(&mut buffers.points);
        self.list_points(cells, &mut points);
        self.list_edges_among(cells, &points, buffers);
        buffers.points = points;
    }

    /// As [`Self::list_edges`]. `points`: the entries of all vertices in the cells, ascending.
    fn list_edges_among(&self, cells: &TailCells, points: &[Point], buffers: &mut TailBuffers) {
        let TailBuffers { buckets, naming, edges, .. } = buffers;
        buckets.sort(&cells.cells, points);
        self.list_named(cells, buckets, naming);
        edges.clear();
        let triangles = naming[0].named.chunk_by(|&a, &b| first(a) / 3 == first(b) / 3);
        edges.extend(triangles.filter_map(|entries| self.highest_edge(entries)));
    }

    /// The welded vertex at an entry.
    fn vertex(&self, entry: u32) -> u32 {
        self.list.vertex(self.list.corner(entry))
    }

    /// Lists the entries of all vertices in the cells, ascending. Positions are tested once per vertex: a test per corner would wait for
    /// memory at each of them.
    fn list_points(&self, cells: &TailCells, points: &mut Vec<Point>) {
        let position = |vertex| self.list.position(vertex);
        let is_inside: Vec<bool> =
            (0..self.vertex_count as u32).map(|vertex| cells.contain(position(vertex))).collect();
        let mut triangle_buffer = TriangleBuffer::default();
        points.clear();
        for range in self.list.windows() {
            let first = 3 * range.start as u32;
            let triangles = self.list.triangles(range, &mut triangle_buffer);
            let inside =
                (first..).zip(triangles.as_flattened()).filter(|(_, vertex)| is_inside[**vertex as usize]);
            points.extend(inside.map(|(entry, &vertex)| Point { position: position(vertex), entry }));
        }
    }

    /// Lists the entries of all vertices that are named after a corner of the tail, ascending, in the first of `naming`.
    fn list_named(&self, cells: &TailCells, buckets: &mut CellBuckets, naming: &mut [NamingBuffers]) {
        naming.iter_mut().for_each(|buffers| buffers.named.clear());
        let threads = if buckets.point_count() < POINTS_FOR_THREADS { 1 } else { naming.len() };
        threads::for_each_with(&mut naming[..threads], buckets.iter_mut(), |buffers, points| {
            self.list_named_of_cell(cells, points, buffers);
        });
        let (all, others) = naming.split_first_mut().expect("the buffers of a thread");
        others.iter_mut().for_each(|other| all.named.append(&mut other.named));
        sort(&mut all.named);
    }

    fn list_named_of_cell(&self, cells: &TailCells, points: &mut [Point], buffers: &mut NamingBuffers) {
        let NamingBuffers { named, of_range } = buffers;
        let in_tail = |entry: u32| entry as usize >= 3 * cells.start;
        let is_wanted = |points: &[Point]| points.iter().any(|point| in_tail(point.entry));
        for_each_final_range(points, &is_wanted, &mut |points| {
            let place = |(at, point): (u32, &Point)| pair(self.vertex(point.entry), at);
            of_range.clear();
            of_range.extend((0..).zip(points).map(place));
            // By vertex, in the order of the range: the corner at the first entry of each vertex is its name.
            sort(of_range);
            let entry = |place: u64| points[second(place) as usize].entry;
            for same in of_range.chunk_by(|&a, &b| first(a) == first(b)) {
                if in_tail(entry(same[0])) {
                    let name = self.list.corner(entry(same[0]));
                    named.extend(same.iter().map(|&place| pair(entry(place), name)));
                }
            }
        });
    }

    /// The edge between the two vertices of a triangle with the largest names, if at least two are named. `entries`: those of the triangle.
    fn highest_edge(&self, entries: &[u64]) -> Option<Edge> {
        let named = |&entry: &u64| (second(entry), self.vertex(first(entry)));
        let (lower, upper) = match entries {
            [a, b] => sorted(named(a), named(b)),
            [a, b, c] => {
                let (low, high) = sorted(named(a), named(b));
                let c = named(c);
                if c < low { (low, high) } else { sorted(c, high) }
            }
            _ => return None,
        };
        let triangle = self.list.triangle(first(entries[0]) / 3);
        let edge = Edge { names: [lower.0, upper.0], vertices: [lower.1, upper.1] };
        (!self.is_degenerate(triangle)).then_some(edge)
    }

    /// True for triangles with two equal positions. The reference ignores their edges.
    pub fn is_degenerate(&self, triangle: [u32; 3]) -> bool {
        are_degenerate(triangle.map(|vertex| self.list.position(vertex)))
    }
}

/// True where two positions of a triangle are equal.
pub(crate) fn are_degenerate([a, b, c]: [[f32; 3]; 3]) -> bool {
    a == b || b == c || c == a
}
