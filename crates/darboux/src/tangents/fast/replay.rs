//! A plan's run of the fast path: vertices are welded and decided before, so that only sums of weighted
//! tangents are computed.

use crate::Mesh;

use crate::exec::limits::RunLimits;
use crate::exec::simd::{Task, Width};
use crate::exec::threads::{self, split_range};
use crate::exec::windows::{WINDOW, Window};
use crate::tangents::fast::passes::{PassInput, Replay};
use crate::tangents::fast::planned_groups::PlannedGroups;
use crate::tangents::fast::proof::UNDECIDED;
use crate::tangents::fast::quads::{FaceSplit, MIN_AREA, triangle_count};
use crate::tangents::fast::state::{FastPath, triangle_list};
use crate::tangents::fast::triangle_list::{TriangleList, WeldMap};
use crate::tangents::fast::vertex_record::{VertexRecord, VertexSlices, position_of, record_of};
use crate::tangents::fast::worker::Worker;
use crate::tangents::options::Mode;

/// What a plan keeps of a run.
#[derive(Debug)]
pub(crate) struct FastPlan {
    weld: PlannedWeld,
    split: FaceSplit,
    /// The plan does not apply to meshes with larger coordinates.
    largest_coordinate: f32,
    windows: Vec<Window>,
    /// The sign of each welded vertex; [`UNDECIDED`] where other stages compute the tangent.
    signs: Vec<f32>,
    /// The groups around undecided vertices; `None` where there are none.
    pub groups: Option<PlannedGroups>,
}

/// A [`WeldMap`] without the vertices' values.
#[derive(Debug)]
enum PlannedWeld {
    Unwelded,
    /// The welded vertex of each vertex, and that of each corner.
    OfVertex(Vec<u32>, Vec<u32>),
    OfCorner {
        welded: Vec<u32>,
        /// The first corner of each welded vertex.
        first_corner: Vec<u32>,
    },
}

impl PlannedWeld {
    fn new(weld: WeldMap<'_>) -> Self {
        match weld {
            WeldMap::Unwelded => Self::Unwelded,
            WeldMap::OfVertex(welded, of_corner) => Self::OfVertex(welded.to_vec(), of_corner.to_vec()),
            WeldMap::OfCorner(welded, records) => {
                let mut first_corner = Vec::with_capacity(records.len());
                for (corner, &vertex) in (0..).zip(welded) {
                    // Vertices are numbered in the order of their first corners.
                    if vertex as usize == first_corner.len() {
                        first_corner.push(corner);
                    }
                }
                debug_assert_eq!(first_corner.len(), records.len());
                Self::OfCorner { welded: welded.to_vec(), first_corner }
            }
        }
    }

    /// True when vertices that were welded are still equal.
    fn vertices_are_equal(&self, mesh: &Mesh<'_>, limits: RunLimits<'_>) -> bool {
        let Self::OfVertex(welded, _) = self else { return true };
        threads::all(limits, welded.len(), |vertex| {
            let first = welded[vertex] as usize;
            first == vertex || record_of(mesh, vertex) == record_of(mesh, first)
        })
    }

    fn map<'a>(&'a self, records: &'a [VertexRecord]) -> WeldMap<'a> {
        match self {
            Self::Unwelded => WeldMap::Unwelded,
            Self::OfVertex(welded, of_corner) => WeldMap::OfVertex(welded, of_corner),
            Self::OfCorner { welded, .. } => WeldMap::OfCorner(welded, records),
        }
    }
}

impl FastPlan {
    /// Keeps the results of the last run of `fast`, whose mesh is `mesh`. `signs`: those of that run, by
    /// [`FastPath::signs`]. `groups`: those that were found after it.
    pub fn new(mesh: &Mesh<'_>, fast: FastPath, signs: Vec<f32>, groups: Option<PlannedGroups>) -> Self {
        let FastPath { weld, windows, split, .. } = fast;
        let list = triangle_list(mesh, &weld, &split);
        let (weld, largest_coordinate) = (PlannedWeld::new(list.weld), largest_coordinate(&list));
        Self { weld, split, largest_coordinate, windows, signs, groups }
    }

    /// The triangles of a mesh whose vertices have moved. `records`: those of the welded vertices, where
    /// corners are welded.
    pub fn list<'a>(&'a self, mesh: &'a Mesh<'a>, records: &'a [VertexRecord]) -> TriangleList<'a> {
        TriangleList { mesh, weld: self.weld.map(records), split: &self.split }
    }
}

/// No derivative of a quad's half, divided by its UV area, is infinite in a mesh without larger coordinates.
/// So the frames of both halves at a decided vertex are equal, and so is their average (see `quads.rs`).
/// Infinite where there are no quads.
///
/// With coordinates up to P and U, components of derivatives are up to 8 P U, their squares add up to less
/// than the largest float, and lengths over areas to less than 14 P U / 1e-18.
fn largest_coordinate(list: &TriangleList<'_>) -> f32 {
    if !list.is_split() {
        return f32::INFINITY;
    }
    let uvs = (0..list.mesh.corner_count())
        .flat_map(|corner| list.mesh.uvs().get(list.mesh.vertex_of_corner(corner)));
    1e36 * MIN_AREA / uvs.fold(0.0, |largest: f32, x| largest.max(x.abs()))
}

impl FastPath {
    /// The sign of each welded vertex of the last run, [`UNDECIDED`] where it decided none. `tangents`: those
    /// of that run.
    pub fn signs(&self, mesh: &Mesh<'_>, tangents: &[[f32; 4]]) -> Vec<f32> {
        let list = self.list(mesh);
        let mut signs = vec![UNDECIDED; self.weld.count];
        for (corner, tangent) in (0..).zip(tangents) {
            signs[list.vertex(corner) as usize] = tangent[3];
        }
        signs
    }

    /// Writes the tangents of the vertices that a plan has decided, for a mesh whose vertices have moved.
    /// Returns false where the plan does not apply: welded vertices have moved apart, tangents need
    /// repair, coordinates are too large.
    pub fn run_planned(
        &mut self,
        plan: &FastPlan,
        mesh: &Mesh<'_>,
        limits: RunLimits<'_>,
        out: &mut [[f32; 4]],
    ) -> bool {
        let threads = limits.thread_count(triangle_count(mesh));
        self.workers.resize_with(threads, Worker::default);
        let applies = self.applies(plan, mesh, limits);
        if applies {
            let list = plan.list(mesh, &self.records);
            let pass = Replay { signs: &plan.signs, has_quads: list.is_split() };
            let input = PassInput { list, windows: &plan.windows, pass, limits };
            self.schedule.run(&input, &mut self.workers, &mut vec![(); plan.signs.len()], out);
        }
        applies && self.workers.iter().all(|worker| worker.findings.all_usable)
    }

    /// The groups of the last resolution, whose mode was `mode`, for a plan.
    pub fn planned_groups(&self, mode: Mode) -> PlannedGroups {
        PlannedGroups::new(&self.resolution, mode)
    }

    /// Writes the tangents of a plan's groups after [`FastPath::run_planned`], with the signs of `base`.
    /// Returns false where the groups do not suffice: tangents need repair, derivatives are too small.
    pub fn run_planned_groups(
        &mut self,
        plan: &FastPlan,
        mesh: &Mesh<'_>,
        base: &[[f32; 4]],
        limits: RunLimits<'_>,
        out: &mut [[f32; 4]],
    ) -> bool {
        let Some(groups) = &plan.groups else { return true };
        let Self { planned_sums: sums, workers, records, .. } = self;
        groups.write(&plan.list(mesh, records), (limits.width, &mut workers[0].block), base, sums, out)
    }

    /// True when welded vertices are still equal, and no coordinate is too large. Reads the records of
    /// vertices welded from corners.
    fn applies(&mut self, plan: &FastPlan, mesh: &Mesh<'_>, limits: RunLimits<'_>) -> bool {
        let largest = plan.largest_coordinate;
        let is_within = |position: [f32; 3]| position.iter().all(|x| x.abs() <= largest);
        let is_unlimited = largest == f32::INFINITY;
        if let PlannedWeld::OfCorner { welded, first_corner } = &plan.weld {
            self.records.resize(first_corner.len(), VertexRecord::default());
            let of_corner = |corner: u32| record_of(mesh, mesh.vertex_of_corner(corner as usize));
            threads::fill(limits, &mut self.records, |vertex| of_corner(first_corner[vertex]));
            let is_within = |vertex: usize| is_within(position_of(self.records[vertex]));
            return (is_unlimited || threads::all(limits, first_corner.len(), is_within))
                && self.corners_are_equal(welded, mesh, limits.width);
        }
        let is_within = |vertex| is_within(mesh.positions().get(vertex));
        (is_unlimited || threads::all(limits, mesh.vertex_count(), is_within))
            && plan.weld.vertices_are_equal(mesh, limits)
    }

    /// True when all corners of each welded vertex are still equal.
    fn corners_are_equal(&mut self, welded: &[u32], mesh: &Mesh<'_>, width: Width) -> bool {
        let records = &self.records[..];
        let ranges = split_range(0..welded.len(), self.workers.len(), 1);
        threads::run(&mut self.workers, ranges, |worker, range| {
            let Worker { slices: buffer, corners_differ, .. } = worker;
            *corners_differ = 0;
            for start in range.clone().step_by(WINDOW) {
                let corners = start..(start + WINDOW).min(range.end);
                let slices = VertexSlices::of_corners(mesh, corners.clone(), buffer);
                width.run(CompareCorners { slices, welded: &welded[corners], records, corners_differ });
            }
        });
        self.workers.iter().all(|worker| worker.corners_differ == 0)
    }
}

/// Finds whether corners differ from the records of their welded vertices.
struct CompareCorners<'a> {
    slices: VertexSlices<'a>,
    welded: &'a [u32],
    records: &'a [VertexRecord],
    corners_differ: &'a mut u32,
}

impl Task for CompareCorners<'_> {
    #[inline(always)]
    fn run(self) {
        let VertexSlices { positions, normals, uvs } = self.slices;
        let values = positions.iter().zip(normals).zip(uvs);
        for (((&[x, y, z], &[a, b, c]), &[u, v]), &vertex) in values.zip(self.welded) {
            let (record, corner) = (&self.records[vertex as usize], [x, y, z, a, b, c, u, v]);
            for k in 0..8 {
                *self.corners_differ |= u32::from(record[k] != corner[k]);
            }
        }
    }
}
