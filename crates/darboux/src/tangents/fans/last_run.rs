//! Whether the order of the reference's last edges could show.
//!
//! The reference leaves the edges with the largest lower vertex in the order of an unstable sort. What that sort does shows when
//! those edges are more than two and some of them are one edge. Which edges they are depends on the vertices' names, the
//! corners that represent them (see `crate::weld`). Names near the end of the triangle list decide, and those are names of
//! vertices that the last triangles use: only the cells of these are put into the reference's order.

use std::collections::HashMap;

use crate::Mesh;
use crate::weld::{Bounds, CELLS, Cells, Point, for_each_final_range};

use super::source::{Identity, read_triangles};
use super::vertices::Vertex;
use super::{WINDOW, windows};

/// How many triangles from the end are looked at first.
const FIRST_TAIL: usize = if cfg!(small_limits) { 1 } else { 32 };

/// Where a tail as long as this has not decided, the order counts as showing.
const LONGEST_TAIL: usize = 1 << 12;

/// Welded vertices after all have been read.
pub(super) struct LastRun<'a> {
    pub mesh: &'a Mesh<'a>,
    pub identity: Identity<'a>,
    pub vertices: &'a [Vertex],
    /// Of the vertices that triangles use.
    pub bounds: Bounds,
}

impl LastRun<'_> {
    /// True when the order could show.
    pub fn could_show(&self) -> bool {
        let mut tail = FIRST_TAIL;
        loop {
            let start = self.mesh.face_count().saturating_sub(tail);
            if let Some(shows) = self.shows_in_tail(start) {
                return shows;
            }
            if start == 0 || tail >= LONGEST_TAIL {
                return start > 0;
            }
            tail *= 8;
        }
    }

    /// Whether the order shows, if the last run's lower vertex is named after a corner of the triangles from `start` on.
    fn shows_in_tail(&self, start: usize) -> Option<bool> {
        let points = self.points_near(start);
        let names = self.names(points.clone(), start);
        // All triangles whose two higher vertices are named after corners of the tail.
        let mut triangles: Vec<u32> = points.iter().map(|point| point.entry / 3).collect();
        triangles.sort_unstable();
        triangles.dedup();
        let edges: Vec<(u32, u32)> =
            triangles.into_iter().filter_map(|triangle| self.highest_edge(triangle, &names)).collect();
        let lower = edges.iter().map(|&(lower, _)| lower).max()?;
        let mut uppers: Vec<u32> =
            edges.iter().filter(|edge| edge.0 == lower).map(|&(_, upper)| upper).collect();
        let count = uppers.len();
        uppers.sort_unstable();
        uppers.dedup();
        Some(count > 2 && uppers.len() < count)
    }

    fn triangle(&self, triangle: usize) -> [u32; 3] {
        let mut vertices = [[0; 3]];
        read_triangles(self.mesh, self.identity, triangle, &mut vertices);
        vertices[0]
    }

    fn position(&self, vertex: u32) -> [f32; 3] {
        let [x, y, z, ..] = self.vertices[vertex as usize].record;
        [x, y, z]
    }

    /// The corners of all cells with a vertex of the triangles from `start` on, in list order.
    fn points_near(&self, start: usize) -> Vec<Point> {
        let cells = Cells::of(&self.bounds);
        let mut wanted = [false; CELLS];
        for triangle in start..self.mesh.face_count() {
            for vertex in self.triangle(triangle) {
                wanted[cells.at(self.position(vertex))] = true;
            }
        }
        let is_near: Vec<bool> =
            (0..self.vertices.len() as u32).map(|vertex| wanted[cells.at(self.position(vertex))]).collect();
        let mut points = Vec::new();
        let mut triangles = vec![[0; 3]; WINDOW];
        for range in windows(self.mesh) {
            let triangles = &mut triangles[..range.len()];
            read_triangles(self.mesh, self.identity, range.start, triangles);
            for (entry, &vertex) in (3 * range.start as u32..).zip(triangles.as_flattened()) {
                if is_near[vertex as usize] {
                    points.push(Point { position: self.position(vertex), entry });
                }
            }
        }
        points
    }

    /// The names of vertices, where they are corners of the triangles from `start` on.
    fn names(&self, points: Vec<Point>, start: usize) -> HashMap<u32, u32> {
        let cells = Cells::of(&self.bounds);
        let mut by_cell: HashMap<usize, Vec<Point>> = HashMap::new();
        for point in points {
            by_cell.entry(cells.at(point.position)).or_default().push(point);
        }
        let mut names = HashMap::new();
        for points in by_cell.values_mut() {
            for_each_final_range(points, &mut |points| {
                for point in points {
                    let vertex = self.triangle(point.entry as usize / 3)[point.entry as usize % 3];
                    names.entry(vertex).or_insert(point.entry);
                }
            });
        }
        names.retain(|_, name| *name as usize >= 3 * start);
        names
    }

    /// The names of the two higher vertices of a triangle, the lower one first; none for degenerate triangles.
    fn highest_edge(&self, triangle: u32, names: &HashMap<u32, u32>) -> Option<(u32, u32)> {
        let vertices = self.triangle(triangle as usize);
        let [a, b, c] = vertices.map(|vertex| self.position(vertex));
        let mut found: Vec<u32> = vertices.iter().filter_map(|vertex| names.get(vertex).copied()).collect();
        found.sort_unstable();
        match found[..] {
            [.., lower, upper] if a != b && b != c && c != a => Some((lower, upper)),
            _ => None,
        }
    }
}

/// The bounds of the vertices that triangles use.
pub(super) fn bounds(mesh: &Mesh<'_>, identity: Identity<'_>, vertices: &[Vertex]) -> Bounds {
    let mut used = vec![false; vertices.len()];
    let mut triangles = vec![[0; 3]; WINDOW];
    for range in windows(mesh) {
        let triangles = &mut triangles[..range.len()];
        read_triangles(mesh, identity, range.start, triangles);
        triangles.as_flattened().iter().for_each(|&vertex| used[vertex as usize] = true);
    }
    let mut found = vertices.iter().zip(&used).filter(|(_, used)| **used).map(|(vertex, _)| {
        let [x, y, z, ..] = vertex.record;
        [x, y, z]
    });
    let first = found.next().unwrap_or_default();
    Bounds::of(first, found)
}
