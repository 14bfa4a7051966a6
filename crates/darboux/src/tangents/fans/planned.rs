//! A run whose vertices are welded and decided beforehand: sums alone are left.

use crate::Mesh;
use crate::cancel::Stop;

use super::super::threads::{self, parts};
use super::super::width::Width;
use super::super::windows::{Window, overlap, shares};
use super::cut::{UNCUT, triangle_count};
use super::last_run::TailCells;
use super::source::Identity;
use super::stream::Stream;
use super::weld::Weld;
use super::workers::Worker;
use super::{Fans, UNDECIDED, source, write_pending};

/// What a run has found out about a mesh of triangles.
#[derive(Debug)]
pub(crate) struct PlannedFans {
    weld: Weld,
    windows: Vec<Window>,
    /// Of each welded vertex; [`UNDECIDED`] where other stages decide.
    signs: Vec<f32>,
}

impl PlannedFans {
    /// Of the mesh that `fans` has just run on, with the tangents that it wrote.
    pub fn new(mesh: &Mesh<'_>, fans: Fans, tangents: &[[f32; 4]]) -> Self {
        let Fans { weld, windows, .. } = fans;
        let source = source(mesh, &weld, &UNCUT);
        let mut signs = vec![UNDECIDED; weld.count];
        for (corner, tangent) in (0..).zip(tangents) {
            signs[source.vertex(corner) as usize] = tangent[3];
        }
        Self { weld, windows, signs }
    }

    /// True when vertices that were welded are still one.
    fn holds(&self, mesh: &Mesh<'_>) -> bool {
        match self.weld.identity() {
            Identity::Own => true,
            Identity::OfVertex(of) => {
                let values = |vertex: usize| (mesh.positions().get(vertex), mesh.normals().get(vertex));
                of.iter().enumerate().all(|(vertex, &first)| values(vertex) == values(first as usize))
            }
            Identity::OfCorner(..) => false,
        }
    }
}

impl Fans {
    /// Writes the tangents of the decided vertices of a mesh whose vertices have moved since it was planned. False where the sums of
    /// its triangles do not suffice: welded vertices have moved apart, tangents are unusable, the mesh has no indices.
    pub fn run_planned(
        &mut self,
        plan: &PlannedFans,
        mesh: &Mesh<'_>,
        width: Width,
        stop: &Stop,
        out: &mut [[f32; 4]],
    ) -> bool {
        if !plan.holds(mesh) {
            return false;
        }
        let threads = threads::count(triangle_count(mesh));
        self.workers.resize_with(threads, Worker::default);
        threads::on_pool(threads, || self.run_planned_on(plan, mesh, width, stop, out));
        self.workers[..self.shares.len()].iter().all(|worker| worker.all_usable)
    }

    fn run_planned_on(
        &mut self,
        plan: &PlannedFans,
        mesh: &Mesh<'_>,
        width: Width,
        stop: &Stop,
        out: &mut [[f32; 4]],
    ) {
        let (windows, source) = (&plan.windows[..], source(mesh, &plan.weld, &UNCUT));
        let stream =
            Stream { source, windows, tail: &TailCells::none(), signs: &plan.signs[..], width, stop };
        self.shares.clear();
        self.shares.extend(shares(windows, plan.weld.count, self.workers.len()));
        if overlap(&self.shares, windows) {
            // Shares would overlap too much.
            self.shares.clear();
            self.shares.extend(shares(windows, plan.weld.count, 1));
        }
        // The others' memory is that of earlier meshes.
        let workers = &mut self.workers[..self.shares.len()];
        let ranges = self.shares.iter().map(|share| source.corners_of(share.windows.clone()));
        let jobs = self.shares.iter().zip(parts(&mut *out, 0, ranges));
        threads::run(workers, jobs, |worker, (share, out)| stream.run(share, worker, out));
        write_pending(&source, &self.shares, workers, out);
    }
}
