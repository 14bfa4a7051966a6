//! Whether the order of the reference's last edges could show.
//!
//! The reference leaves the edges with the largest lower vertex in the order of an unstable sort. What that sort does shows when
//! those edges are more than two and some of them are one edge; then it is done (see `crate::topology::edge_sort`). Which edges they are
//! depends on the vertices' names, the corners that represent them (see `crate::topology::weld`). Names near the end of the triangle list
//! decide, and those are names of vertices that the last triangles use: only the cells of these are put into the reference's order.

use crate::topology::neighbours::tail_order_matters;
use crate::topology::weld::{Bounds, CELLS, CellBuckets, Cells, Point, for_each_final_range};
use crate::util::radix_sort::{first, pair, second, sort};

use crate::tangents::fast::input::{Source, TriangleBuffer};

/// How many triangles from the end are looked at first, where triangles that share vertices are near each other in the list, and
/// where they are not: there fewer of them have vertices that are named at the end.
const FIRST_TAIL: usize = if cfg!(small_limits) { 1 } else { 4 };
const FIRST_TAIL_SHUFFLED: usize = 8 * FIRST_TAIL;

/// The cells in which a tail of the triangle list has vertices.
#[derive(Debug)]
pub(crate) struct TailCells {
    /// Its first triangle, which begins a face: entries from there on are of corners whose numbers are not below its first corner's.
    start: usize,
    cells: Cells,
    wanted: [bool; CELLS],
    low: f32,
    high: f32,
}

impl TailCells {
    /// Of the triangles from `start` on; `bounds` are those of all vertices in use.
    fn new(source: &Source<'_>, bounds: &Bounds, triangle: usize) -> Self {
        let start = source.face_of(triangle as u32).start as usize;
        let cells = Cells::of(bounds);
        let mut tail =
            Self { start, cells, wanted: [false; CELLS], low: f32::INFINITY, high: f32::NEG_INFINITY };
        for vertex in (start..source.count()).flat_map(|triangle| source.triangle(triangle as u32)) {
            let position = source.position(vertex);
            tail.wanted[cells.at(position)] = true;
            let along = position[cells.axis];
            (tail.low, tail.high) = (tail.low.min(along), tail.high.max(along));
        }
        // A cell more on either side, and rounding.
        let margin = 1.01 / CELLS as f32 * cells.extent + 1e-6 * (tail.low.abs() + tail.high.abs());
        (tail.low, tail.high) = (tail.low - margin, tail.high + margin);
        tail
    }

    /// Of no triangles.
    pub fn none() -> Self {
        let cells = Cells::of(&Bounds::default());
        Self { start: 0, cells, wanted: [false; CELLS], low: f32::INFINITY, high: f32::NEG_INFINITY }
    }

    /// Of the first tail to look at: so many triangles that have edges, and whatever lies among and behind them.
    pub fn first(source: &Source<'_>, bounds: &Bounds, is_shuffled: bool) -> Self {
        let tail = if is_shuffled { FIRST_TAIL_SHUFFLED } else { FIRST_TAIL };
        let mut good = (0..source.count()).rev().filter(|&triangle| {
            let positions = source.triangle(triangle as u32).map(|vertex| source.position(vertex));
            !are_degenerate(positions)
        });
        Self::new(source, bounds, good.nth(tail - 1).unwrap_or(0))
    }

    /// True for vertices in these cells.
    #[inline(always)]
    pub fn hold(&self, position: [f32; 3]) -> bool {
        let along = position[self.cells.axis];
        (along >= self.low) & (along <= self.high) && self.hold_cell(position)
    }

    #[inline(never)]
    fn hold_cell(&self, position: [f32; 3]) -> bool {
        self.wanted[self.cells.at(position)]
    }
}

/// An edge's vertices and their names, the lower first.
#[derive(Clone, Copy, Debug)]
struct Edge {
    names: [u32; 2],
    ends: [u32; 2],
}

/// The last edges.
#[derive(Debug)]
pub(crate) struct LastEdges {
    /// The name of their lower vertex.
    pub name: u32,
    pub count: usize,
    /// All vertices at their ends, ascending.
    pub vertices: Vec<u32>,
}

impl LastEdges {
    /// Of listed edges, those with the largest lower name among them.
    fn of(lists: &mut Lists) -> Option<Self> {
        let Lists { edges, uppers, .. } = lists;
        let name = edges.iter().map(|edge| edge.names[0]).max()?;
        edges.retain(|edge| edge.names[0] == name);
        uppers.clear();
        uppers.extend(edges.iter().map(|edge| edge.names[1]));
        sort(uppers);
        if !tail_order_matters(uppers.iter()) {
            return None;
        }
        let mut vertices: Vec<u32> = edges.iter().flat_map(|edge| edge.ends).collect();
        sort(&mut vertices);
        vertices.dedup();
        Some(Self { name, count: edges.len(), vertices })
    }
}

fn sorted<T: PartialOrd>(a: T, b: T) -> (T, T) {
    if b < a { (b, a) } else { (a, b) }
}

/// What is listed on the way; the memory is kept from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct Lists {
    points: Vec<Point>,
    by_cell: CellBuckets,
    /// Entries of vertices that are named after a corner of the tail, each with that name.
    named: Vec<u64>,
    /// The vertices of one range's entries, and where these are in it.
    of_range: Vec<u64>,
    edges: Vec<Edge>,
    /// The names of the last edges' upper vertices, ascending.
    uppers: Vec<u32>,
}

/// A welded mesh.
#[derive(Clone, Copy)]
pub(crate) struct LastRun<'a> {
    pub source: Source<'a>,
    pub bounds: &'a Bounds,
}

impl LastRun<'_> {
    /// The last edges, where their order shows. `points` are the entries of `cells`' vertices, ascending, or none if they have to be
    /// looked for.
    pub fn find(
        &self,
        mut cells: TailCells,
        points: Option<&[Point]>,
        lists: &mut Lists,
    ) -> Option<LastEdges> {
        match points {
            Some(points) => lists.by_cell.sort(&cells.cells, points),
            None => self.sort_points(&cells, lists),
        }
        self.list_edges(&cells, lists);
        while lists.edges.is_empty() && cells.start > 0 {
            let tail = 4 * (self.source.count() - cells.start);
            cells = TailCells::new(&self.source, self.bounds, self.source.count().saturating_sub(tail));
            self.sort_points(&cells, lists);
            self.list_edges(&cells, lists);
        }
        LastEdges::of(lists)
    }

    /// Lists edges, among them those with the largest lower vertex, if it is named after a corner of the tail.
    fn list_edges(&self, cells: &TailCells, lists: &mut Lists) {
        self.list_named(cells, lists);
        lists.edges.clear();
        let triangles = lists.named.chunk_by(|&a, &b| first(a) / 3 == first(b) / 3);
        lists.edges.extend(triangles.filter_map(|entries| self.highest_edge(entries)));
    }

    /// The welded vertex at an entry.
    fn vertex(&self, entry: u32) -> u32 {
        self.source.vertex(self.source.corner(entry))
    }

    /// Sorts the entries of all vertices in the cells.
    fn sort_points(&self, cells: &TailCells, lists: &mut Lists) {
        let mut buffer = TriangleBuffer::default();
        lists.points.clear();
        for range in self.source.windows() {
            let first = 3 * range.start as u32;
            let triangles = self.source.triangles(range, &mut buffer);
            for (entry, &vertex) in (first..).zip(triangles.as_flattened()) {
                let position = self.source.position(vertex);
                if cells.hold(position) {
                    lists.points.push(Point { position, entry });
                }
            }
        }
        lists.by_cell.sort(&cells.cells, &lists.points);
    }

    /// Lists the entries of all vertices that are named after a corner of the tail, ascending.
    fn list_named(&self, cells: &TailCells, lists: &mut Lists) {
        let Lists { by_cell, named, of_range, .. } = lists;
        let in_tail = |entry: u32| entry as usize >= 3 * cells.start;
        let is_wanted = |points: &[Point]| points.iter().any(|point| in_tail(point.entry));
        named.clear();
        for points in by_cell.iter_mut() {
            for_each_final_range(points, &is_wanted, &mut |points| {
                let place = |(at, point): (u32, &Point)| pair(self.vertex(point.entry), at);
                of_range.clear();
                of_range.extend((0..).zip(points).map(place));
                // By vertex, in the range's order: the corner at the first entry of each vertex is its name.
                sort(of_range);
                let entry = |place: u64| points[second(place) as usize].entry;
                for same in of_range.chunk_by(|&a, &b| first(a) == first(b)) {
                    if in_tail(entry(same[0])) {
                        let name = self.source.corner(entry(same[0]));
                        named.extend(same.iter().map(|&place| pair(entry(place), name)));
                    }
                }
            });
        }
        sort(named);
    }

    /// The edge between the two higher vertices of a triangle, if two of its corners are named.
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
        let triangle = self.source.triangle(first(entries[0]) / 3);
        let edge = Edge { names: [lower.0, upper.0], ends: [lower.1, upper.1] };
        (!self.is_degenerate(triangle)).then_some(edge)
    }

    /// True for triangles of which the reference makes no edges.
    pub fn is_degenerate(&self, triangle: [u32; 3]) -> bool {
        are_degenerate(triangle.map(|vertex| self.source.position(vertex)))
    }
}

/// True for triangles with two equal positions.
pub(crate) fn are_degenerate([a, b, c]: [[f32; 3]; 3]) -> bool {
    a == b || b == c || c == a
}
