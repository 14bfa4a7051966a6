//! Whether the order of the reference's last edges could show.
//!
//! The reference leaves the edges with the largest lower vertex in the order of an unstable sort. What that sort does shows when
//! those edges are more than two and some of them are one edge; then it is done (see `crate::last_edges`). Which edges they are depends on the vertices' names, the
//! corners that represent them (see `crate::weld`). Names near the end of the triangle list decide, and those are names of
//! vertices that the last triangles use: only the cells of these are put into the reference's order.

use crate::Mesh;
use crate::topology::order_shows;
use crate::weld::{Bounds, CELLS, Cells, Point, for_each_final_range};

use super::source::{Identity, triangles};
use super::windows_of;

/// How many triangles from the end are looked at first, where triangles that share vertices are near each other in the list, and
/// where they are not: there fewer of them have vertices that are named at the end.
const FIRST_TAIL: usize = if cfg!(small_limits) { 1 } else { 4 };
const FIRST_TAIL_SHUFFLED: usize = 8 * FIRST_TAIL;

/// The cells in which a tail of the triangle list has vertices.
#[derive(Debug)]
pub(super) struct TailCells {
    start: usize,
    cells: Cells,
    wanted: Box<[bool; CELLS]>,
    low: f32,
    high: f32,
}

impl TailCells {
    /// Of the triangles from `start` on; `bounds` are those of all vertices in use.
    fn new(mesh: &Mesh<'_>, bounds: &Bounds, start: usize) -> Self {
        let cells = Cells::of(bounds);
        let mut tail = Self {
            start,
            cells,
            wanted: Box::new([false; CELLS]),
            low: f32::INFINITY,
            high: f32::NEG_INFINITY,
        };
        for corner in 3 * start..mesh.corner_count() {
            let position = mesh.positions().get(mesh.vertex_of_corner(corner));
            tail.wanted[cells.at(position)] = true;
            let along = position[cells.axis];
            (tail.low, tail.high) = (tail.low.min(along), tail.high.max(along));
        }
        // A cell more on either side, and rounding.
        let margin = 1.01 / CELLS as f32 * cells.extent + 1e-6 * (tail.low.abs() + tail.high.abs());
        (tail.low, tail.high) = (tail.low - margin, tail.high + margin);
        tail
    }

    /// Of the first tail to look at: so many triangles that have edges, and whatever lies among and behind them.
    pub fn first(mesh: &Mesh<'_>, bounds: &Bounds, is_shuffled: bool) -> Self {
        let tail = if is_shuffled { FIRST_TAIL_SHUFFLED } else { FIRST_TAIL };
        let mut good = (0..mesh.face_count()).rev().filter(|&triangle| {
            let [a, b, c] = [0, 1, 2].map(|k| mesh.positions().get(mesh.vertex_of_corner(3 * triangle + k)));
            !are_degenerate([a, b, c])
        });
        Self::new(mesh, bounds, good.nth(tail - 1).unwrap_or(0))
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
struct Edge {
    names: [u32; 2],
    ends: [u32; 2],
}

/// The last edges.
#[derive(Debug)]
pub(super) struct LastEdges {
    /// The name of their lower vertex.
    pub name: u32,
    pub count: usize,
    /// All vertices at their ends, ascending.
    pub vertices: Vec<u32>,
}

/// A welded mesh.
#[derive(Clone, Copy)]
pub(super) struct LastRun<'a> {
    pub mesh: &'a Mesh<'a>,
    pub identity: Identity<'a>,
    pub bounds: &'a Bounds,
}

impl LastRun<'_> {
    /// The name of the last edges' lower vertex, where their order could show, and the vertices at their ends. `points` are the
    /// corners of `cells`' vertices, ascending.
    pub fn find(&self, mut cells: TailCells, points: &[Point]) -> Option<LastEdges> {
        let mut edges = self.edges_in_tail(&cells, points);
        while edges.is_empty() && cells.start > 0 {
            let tail = 4 * (self.mesh.face_count() - cells.start);
            cells = TailCells::new(self.mesh, self.bounds, self.mesh.face_count().saturating_sub(tail));
            edges = self.edges_in_tail(&cells, &self.points(&cells));
        }
        let name = edges.iter().map(|edge| edge.names[0]).max()?;
        edges.retain(|edge| edge.names[0] == name);
        if !order_shows(edges.iter().map(|edge| edge.names[1])) {
            return None;
        }
        let mut vertices: Vec<u32> = edges.iter().flat_map(|edge| edge.ends).collect();
        vertices.sort_unstable();
        vertices.dedup();
        Some(LastEdges { name, count: edges.len(), vertices })
    }

    /// The edges with the largest lower vertex are among these, if it is named after a corner of the tail.
    fn edges_in_tail(&self, cells: &TailCells, points: &[Point]) -> Vec<Edge> {
        self.highest_edges(&self.corners_of_named(cells, points))
    }

    fn triangle(&self, triangle: usize) -> [u32; 3] {
        triangles(self.mesh, self.identity, triangle..triangle + 1, &mut Vec::new())[0]
    }

    fn vertex(&self, entry: u32) -> u32 {
        self.triangle(entry as usize / 3)[entry as usize % 3]
    }

    /// The position of a welded vertex.
    pub fn position(&self, vertex: u32) -> [f32; 3] {
        self.identity.position(self.mesh, vertex)
    }

    /// The corners of all vertices in the cells, ascending.
    pub fn points(&self, cells: &TailCells) -> Vec<Point> {
        let (mut points, mut buffer) = (Vec::new(), Vec::new());
        for range in windows_of(self.mesh.face_count()) {
            let first = 3 * range.start as u32;
            let triangles = triangles(self.mesh, self.identity, range, &mut buffer);
            for (entry, &vertex) in (first..).zip(triangles.as_flattened()) {
                let position = self.position(vertex);
                if cells.hold(position) {
                    points.push(Point { position, entry });
                }
            }
        }
        points
    }

    /// The corners of all vertices that are named after a corner of the tail, each with that name, ascending.
    fn corners_of_named(&self, cells: &TailCells, points: &[Point]) -> Vec<(u32, u32)> {
        let (mut points, ends) = cells.cells.sort(points);
        let in_tail = |entry: u32| entry as usize >= 3 * cells.start;
        let is_wanted = |points: &[Point]| points.iter().any(|point| in_tail(point.entry));
        let mut found = Vec::new();
        let mut start = 0;
        for end in ends {
            for_each_final_range(&mut points[start..end], &is_wanted, &mut |points| {
                let mut corners: Vec<(u32, u32)> =
                    points.iter().map(|point| (self.vertex(point.entry), point.entry)).collect();
                // Stable: the first corner of each vertex remains its name.
                corners.sort_by_key(|corner| corner.0);
                for same in corners.chunk_by(|a, b| a.0 == b.0).filter(|same| in_tail(same[0].1)) {
                    found.extend(same.iter().map(|&(_, corner)| (corner, same[0].1)));
                }
            });
            start = end;
        }
        found.sort_unstable();
        found
    }

    /// The edge between the two higher vertices of all triangles where `corners` has both.
    fn highest_edges(&self, corners: &[(u32, u32)]) -> Vec<Edge> {
        let triangles = corners.chunk_by(|a, b| a.0 / 3 == b.0 / 3);
        let edge = |corners: &[(u32, u32)]| {
            let mut named: Vec<(u32, u32)> =
                corners.iter().map(|&(corner, name)| (name, self.vertex(corner))).collect();
            named.sort_unstable();
            match named[..] {
                [.., lower, upper] if !self.is_degenerate(self.triangle(corners[0].0 as usize / 3)) => {
                    Some(Edge { names: [lower.0, upper.0], ends: [lower.1, upper.1] })
                }
                _ => None,
            }
        };
        triangles.filter_map(edge).collect()
    }

    /// True for triangles of which the reference makes no edges.
    pub fn is_degenerate(&self, triangle: [u32; 3]) -> bool {
        are_degenerate(triangle.map(|vertex| self.position(vertex)))
    }
}

fn are_degenerate([a, b, c]: [[f32; 3]; 3]) -> bool {
    a == b || b == c || c == a
}
