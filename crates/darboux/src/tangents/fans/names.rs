//! The reference's names of welded vertices, found where they are asked for.
//!
//! A vertex is named after one of its corners: the first when the reference has cut the points of its cell down to one range. So
//! a name lies between the vertex's first and last corner, which nearly always suffices. Elsewhere the cell is cut again.

use crate::last_edges::{HalfEdge, Names};
use crate::weld::{Cells, Point, for_each_final_range};

use super::last_run::LastRun;
use super::source::triangles;
use super::windows_of;

/// Names of the vertices of a welded mesh.
pub(super) struct LazyNames<'a> {
    run: LastRun<'a>,
    /// The welded vertex of each corner.
    vertices: Vec<u32>,
    bounds: Vec<[u32; 2]>,
    is_wanted: Vec<bool>,
    cells: Cells,
    /// All corners, by cell, and where each cell ends.
    points: Vec<Point>,
    ends: Vec<usize>,
}

impl<'a> LazyNames<'a> {
    /// Of a mesh with `count` welded vertices.
    pub fn new(run: LastRun<'a>, count: usize) -> Self {
        let mut vertices = Vec::with_capacity(run.mesh.corner_count());
        for range in windows_of(run.mesh.face_count()) {
            vertices
                .extend_from_slice(triangles(run.mesh, run.identity, range, &mut Vec::new()).as_flattened());
        }
        let mut bounds = vec![[u32::MAX, 0]; count];
        for (&vertex, corner) in vertices.iter().zip(0..) {
            let [low, high] = &mut bounds[vertex as usize];
            (*low, *high) = (corner.min(*low), corner.max(*high));
        }
        let point = |(&vertex, entry)| Point { position: run.position(vertex), entry };
        let points: Vec<Point> = vertices.iter().zip(0..).map(point).collect();
        let cells = Cells::of(run.bounds);
        let (points, ends) = cells.sort(&points);
        Self { run, vertices, bounds, is_wanted: vec![false; count], cells, points, ends }
    }

    /// The half-edges of all triangles with three distinct positions.
    pub fn half_edges(&self) -> Vec<HalfEdge> {
        let triangles = self.vertices.as_chunks().0.iter().zip((0..).step_by(3));
        let good = triangles.filter(|(triangle, _)| !self.run.is_degenerate(**triangle));
        let edges = good.flat_map(|(&[a, b, c], corner)| [[a, b], [b, c], [c, a]].into_iter().zip(corner..));
        edges.map(|(ends, corner)| HalfEdge { ends, corner }).collect()
    }

    /// The corners of some vertices, ascending.
    pub fn corners_of(&self, vertices: &[u32]) -> impl Iterator<Item = u32> {
        let mut is_asked_for = vec![false; self.bounds.len()];
        vertices.iter().for_each(|&vertex| is_asked_for[vertex as usize] = true);
        let corners = (0..).zip(&self.vertices);
        corners.filter(move |(_, vertex)| is_asked_for[**vertex as usize]).map(|(corner, _)| corner)
    }

    /// Names all vertices in the ranges of a cell's points that hold a wanted vertex.
    fn name_cell(&mut self, cell: usize) {
        let start = if cell == 0 { 0 } else { self.ends[cell - 1] };
        let mut points = self.points[start..self.ends[cell]].to_vec();
        let (vertices, bounds) = (&self.vertices, &mut self.bounds);
        let is_wanted = |point: &Point| self.is_wanted[vertices[point.entry as usize] as usize];
        for_each_final_range(&mut points, &|points| points.iter().any(is_wanted), &mut |points| {
            // From the last to the first: the first corner of each vertex remains its name.
            for point in points.iter().rev() {
                bounds[vertices[point.entry as usize] as usize] = [point.entry; 2];
            }
        });
    }
}

impl Names for LazyNames<'_> {
    fn bounds(&self, vertex: u32) -> [u32; 2] {
        self.bounds[vertex as usize]
    }

    fn find(&mut self, vertices: &[u32]) {
        let is_unknown = |&&vertex: &&u32| {
            let [low, high] = self.bounds[vertex as usize];
            low < high
        };
        let unknown: Vec<u32> = vertices.iter().filter(is_unknown).copied().collect();
        unknown.iter().for_each(|&vertex| self.is_wanted[vertex as usize] = true);
        let cell = |&vertex: &u32| self.cells.at(self.run.position(vertex));
        let mut cells: Vec<usize> = unknown.iter().map(cell).collect();
        cells.sort_unstable();
        cells.dedup();
        cells.into_iter().for_each(|cell| self.name_cell(cell));
        unknown.into_iter().for_each(|vertex| self.is_wanted[vertex as usize] = false);
    }
}
