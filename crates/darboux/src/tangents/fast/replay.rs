//! A run whose vertices are welded and decided beforehand: sums alone are left.

use crate::Mesh;

use crate::exec::limits::RunLimits;
use crate::exec::simd::{Task, Width};
use crate::exec::threads::{self, parts, split};
use crate::exec::windows::{WINDOW, Window, overlap, shares};
use crate::tangents::fast::Fans;
use crate::tangents::fast::UNDECIDED;
use crate::tangents::fast::edge_tail::TailCells;
use crate::tangents::fast::input::{Identity, Source};
use crate::tangents::fast::kernel::Record;
use crate::tangents::fast::quads::{Cut, LEAST_AREA, triangle_count};
use crate::tangents::fast::rows::{Rows, record};
use crate::tangents::fast::scattered;
use crate::tangents::fast::source;
use crate::tangents::fast::streamed::Stream;
use crate::tangents::fast::weld_corners::same;
use crate::tangents::fast::worker::Worker;
use crate::tangents::fast::write_pending;

/// What a run has found out about a mesh.
#[derive(Debug)]
pub(crate) struct PlannedFans {
    welded: Welded,
    cut: Cut,
    /// How large a coordinate may become.
    most: f32,
    windows: Vec<Window>,
    /// Of each welded vertex; [`UNDECIDED`] where other stages decide.
    signs: Vec<f32>,
}

/// As [`Identity`], without values.
#[derive(Debug)]
enum Welded {
    Own,
    OfVertex(Vec<u32>),
    OfCorner {
        of: Vec<u32>,
        /// The first corner of each welded vertex.
        first: Vec<u32>,
    },
}

impl Welded {
    fn new(identity: Identity<'_>) -> Self {
        match identity {
            Identity::Own => Self::Own,
            Identity::OfVertex(of) => Self::OfVertex(of.to_vec()),
            Identity::OfCorner(of, records) => {
                let mut first = Vec::with_capacity(records.len());
                for (corner, &vertex) in (0..).zip(of) {
                    // They are numbered as they are first met.
                    if vertex as usize == first.len() {
                        first.push(corner);
                    }
                }
                debug_assert_eq!(first.len(), records.len());
                Self::OfCorner { of: of.to_vec(), first }
            }
        }
    }

    /// True when vertices that were welded are still one.
    fn holds(&self, mesh: &Mesh<'_>, limits: RunLimits<'_>) -> bool {
        let Self::OfVertex(of) = self else { return true };
        threads::all(limits, of.len(), |vertex| {
            let first = of[vertex] as usize;
            first == vertex || same(&record(mesh, vertex), &record(mesh, first))
        })
    }

    fn identity<'a>(&'a self, records: &'a [Record]) -> Identity<'a> {
        match self {
            Self::Own => Identity::Own,
            Self::OfVertex(of) => Identity::OfVertex(of),
            Self::OfCorner { of, .. } => Identity::OfCorner(of, records),
        }
    }
}

impl PlannedFans {
    /// Of the mesh that `fans` has just run on, with the tangents that it wrote.
    pub fn new(mesh: &Mesh<'_>, fans: Fans, tangents: &[[f32; 4]]) -> Self {
        let Fans { weld, windows, cut, .. } = fans;
        let source = source(mesh, &weld, &cut);
        let mut signs = vec![UNDECIDED; weld.count];
        for (corner, tangent) in (0..).zip(tangents) {
            signs[source.vertex(corner) as usize] = tangent[3];
        }
        let (welded, most) = (Welded::new(source.identity), most(&source));
        Self { welded, cut, most, windows, signs }
    }
}

/// Below this no derivative of a quad's half, divided by its UV area, is infinite. Then the frames of both halves at a decided vertex are
/// equal, part by part, and so is their average (see `cut`). Anything goes where there are no quads.
///
/// With coordinates up to P and U, components of derivatives are up to 8 P U, their squares add up to less than the largest float, and
/// lengths over areas to less than 14 P U / 1e-18.
fn most(source: &Source<'_>) -> f32 {
    if !source.is_cut() {
        return f32::INFINITY;
    }
    let uvs = (0..source.mesh.corner_count())
        .flat_map(|corner| source.mesh.uvs().get(source.mesh.vertex_of_corner(corner)));
    1e36 * LEAST_AREA / uvs.fold(0.0, |most: f32, x| most.max(x.abs()))
}

impl Fans {
    /// Writes the tangents of the decided vertices of a mesh whose vertices have moved since it was planned. False where the sums of
    /// its triangles do not suffice: welded vertices have moved apart, tangents are unusable, quads are too large.
    pub fn run_planned(
        &mut self,
        plan: &PlannedFans,
        mesh: &Mesh<'_>,
        limits: RunLimits<'_>,
        out: &mut [[f32; 4]],
    ) -> bool {
        let threads = limits.thread_count(triangle_count(mesh));
        self.workers.resize_with(threads, Worker::default);
        threads::on_pool(threads, || {
            let holds = self.holds(plan, mesh, limits);
            if holds {
                self.run_planned_on(plan, mesh, limits, out);
            }
            holds && self.workers.iter().all(|worker| worker.all_usable)
        })
    }

    /// True when vertices that were welded are still one, and none is too far. Takes their values where they are welded by corners.
    fn holds(&mut self, plan: &PlannedFans, mesh: &Mesh<'_>, limits: RunLimits<'_>) -> bool {
        let is_near =
            |[x, y, z]: [f32; 3]| x.abs() <= plan.most && y.abs() <= plan.most && z.abs() <= plan.most;
        let anything_goes = plan.most == f32::INFINITY;
        if let Welded::OfCorner { of, first } = &plan.welded {
            self.records.resize(first.len(), Record::default());
            let of_corner = |corner: u32| record(mesh, mesh.vertex_of_corner(corner as usize));
            threads::fill(limits, &mut self.records, |vertex| of_corner(first[vertex]));
            let near = |at: usize| {
                is_near({
                    let [x, y, z, ..] = self.records[at];
                    [x, y, z]
                })
            };
            return (anything_goes || threads::all(limits, first.len(), near))
                && self.are_one(of, mesh, limits.width);
        }
        let near = |vertex| is_near(mesh.positions().get(vertex));
        (anything_goes || threads::all(limits, mesh.vertex_count(), near)) && plan.welded.holds(mesh, limits)
    }

    /// True when the corners of each vertex still have its values.
    fn are_one(&mut self, of: &[u32], mesh: &Mesh<'_>, width: Width) -> bool {
        let records = &self.records[..];
        let ranges = split(0..of.len(), self.workers.len(), 1);
        threads::run(&mut self.workers, ranges, |worker, range| {
            worker.difference = 0;
            for start in range.clone().step_by(WINDOW) {
                let corners = start..(start + WINDOW).min(range.end);
                let rows = Rows::of_corners(mesh, corners.clone(), &mut worker.rows);
                width.run(Compare { rows, of: &of[corners], records, difference: &mut worker.difference });
            }
        });
        self.workers.iter().all(|worker| worker.difference == 0)
    }

    fn run_planned_on(
        &mut self,
        plan: &PlannedFans,
        mesh: &Mesh<'_>,
        limits: RunLimits<'_>,
        out: &mut [[f32; 4]],
    ) {
        let source = Source { mesh, identity: plan.welded.identity(&self.records), cut: &plan.cut };
        let (windows, count) = (&plan.windows[..], plan.signs.len());
        let stream = Stream { source, windows, tail: &TailCells::none(), signs: &plan.signs[..], limits };
        self.shares.clear();
        self.shares.extend(shares(windows, count, self.workers.len()));
        if overlap(&self.shares, windows) {
            scattered::run(&stream, count, &mut self.workers, &mut self.terms, out);
            return;
        }
        let ranges = self.shares.iter().map(|share| source.corners_of(share.windows.clone()));
        let jobs = self.shares.iter().zip(parts(&mut *out, 0, ranges));
        threads::run(&mut self.workers, jobs, |worker, (share, out)| stream.run(share, worker, out));
        write_pending(&source, &self.shares, &mut self.workers, out);
    }
}

/// Collects the bits in which rows differ from their records.
struct Compare<'a> {
    rows: Rows<'a>,
    of: &'a [u32],
    records: &'a [Record],
    difference: &'a mut u32,
}

impl Task for Compare<'_> {
    #[inline(always)]
    fn run(self) {
        let Rows { positions, normals, uvs } = self.rows;
        let rows = positions.iter().zip(normals).zip(uvs);
        for (((&[x, y, z], &[a, b, c]), &[u, v]), &vertex) in rows.zip(self.of) {
            let (record, row) = (&self.records[vertex as usize], [x, y, z, a, b, c, u, v]);
            for k in 0..8 {
                *self.difference |= record[k].to_bits() ^ row[k].to_bits();
            }
        }
    }
}
