//! The memory of the fast path, reused from mesh to mesh, and what later stages ask of the last run.

use std::ops::Range;

use crate::Mesh;
use crate::topology::edge_sort::TriangleEdge;
use crate::topology::weld::Bounds;
use crate::util::hash_map::InsertionMap;

use crate::exec::windows::Window;
use crate::tangents::fast::angle_bounds::AngleBounds;
use crate::tangents::fast::edge_tail::{EdgeTail, TailBuffers, TailCells};
use crate::tangents::fast::exceptions::Exceptions;
use crate::tangents::fast::full_frames::FullFrames;
use crate::tangents::fast::planned_groups::PlannedSums;
use crate::tangents::fast::quads::FaceSplit;
use crate::tangents::fast::resolve::Resolution;
use crate::tangents::fast::schedule::Schedule;
use crate::tangents::fast::triangle_list::TriangleList;
use crate::tangents::fast::vertex_names::VertexNames;
use crate::tangents::fast::vertex_record::VertexRecord;
use crate::tangents::fast::weld_vertices::HashWeld;
use crate::tangents::fast::worker::Worker;

/// The memory of the fast path. After a run it describes the mesh of that run.
#[derive(Debug, Default)]
pub(crate) struct FastPath {
    pub weld: HashWeld,
    pub split: FaceSplit,
    pub windows: Vec<Window>,
    pub schedule: Schedule,
    /// One worker per thread.
    pub workers: Vec<Worker>,
    /// The faces with undecided vertices, and the corners in the cells of the triangle tail.
    pub exceptions: Exceptions,
    /// The number of triangles without UV area.
    pub flat_triangles: usize,
    /// The vertices that were decided because their triangles all have no UV area.
    pub flat_vertices: Vec<u32>,
    pub tail_buffers: TailBuffers,
    pub names: VertexNames,
    /// Runs of the last edges whose order changes the result: the entries where the edges start.
    pub tail_runs: Vec<Vec<u32>>,
    pub full_frames: FullFrames,
    pub resolution: Resolution,
    pub angle_bounds: AngleBounds,
    pub planned_sums: PlannedSums,
    /// The record of each welded vertex, where a plan welds corners.
    pub records: Vec<VertexRecord>,
}

/// The triangles of a mesh, from fields that are borrowed apart from the others.
pub(crate) fn triangle_list<'a>(
    mesh: &'a Mesh<'a>,
    weld: &'a HashWeld,
    split: &'a FaceSplit,
) -> TriangleList<'a> {
    TriangleList { mesh, weld: weld.map(), split }
}

impl FastPath {
    /// The triangles of the mesh of the last run.
    pub fn list<'a>(&'a self, mesh: &'a Mesh<'a>) -> TriangleList<'a> {
        triangle_list(mesh, &self.weld, &self.split)
    }

    /// The corners of the faces with undecided vertices, ascending.
    pub fn undecided<'a>(&'a self, mesh: &'a Mesh<'a>) -> impl Iterator<Item = Range<u32>> + Clone {
        let list = self.list(mesh);
        self.exceptions.undecided.iter().map(move |&triangle| list.corners_of_face(triangle))
    }

    /// Runs of the last edges whose order changes the result. The edges of one run are matched with each
    /// other only.
    pub fn tail_runs(&self, mesh: &Mesh<'_>) -> Vec<Vec<TriangleEdge>> {
        let list = self.list(mesh);
        let edge = |&entry: &u32| (list.corners(entry / 3), entry % 3);
        self.tail_runs.iter().map(|run| run.iter().map(edge).collect()).collect()
    }

    /// The welded vertex at each of `corners`, named by the index of its first corner in `corners`.
    pub fn names(&self, mesh: &Mesh<'_>, corners: &[u32]) -> Vec<u32> {
        let list = self.list(mesh);
        let mut first = InsertionMap::new();
        let name = |(&corner, at): (&u32, u32)| *first.get_or_insert_with(&[list.vertex(corner)], || at);
        corners.iter().zip(0..).map(name).collect()
    }

    /// Makes the vertices of the reference's last edges undecided, where the order of these edges changes the
    /// result.
    ///
    /// `bounds`: of the positions of all used vertices. `first`: the first tail to examine. `is_listed`:
    /// `exceptions.in_tail` has the entries of all vertices in its cells.
    pub fn undecide_last_edges(
        &mut self,
        mesh: &Mesh<'_>,
        bounds: &Bounds,
        first: &TailCells,
        is_listed: bool,
        out: &mut [[f32; 4]],
    ) {
        let Self { weld, split, exceptions, tail_buffers, names, tail_runs, .. } = self;
        let list = triangle_list(mesh, weld, split);
        let tail = EdgeTail { list, vertex_count: weld.count, bounds };
        let points = if is_listed { Some(&exceptions.in_tail[..]) } else { None };
        if let Some(last) = tail.find(first, points, tail_buffers) {
            *tail_runs = names.tail_runs(&tail, &last, weld.count, &exceptions.undecided);
            exceptions.undecide(&list, names.entries_of(&last.vertices), out);
        }
    }
}
