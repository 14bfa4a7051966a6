//! A run that goes on where another machine decided whole fans.

use crate::Mesh;
use crate::tangents::Mode;

use super::last_run::{LastRun, TailCells};
use super::{Fans, UNDECIDED, bounds_of_used};

impl Fans {
    /// As after [`Fans::run`].
    ///
    /// `welded`: the first vertex that equals each vertex of `mesh`, which is indexed. `out`: the tangents of decided vertices;
    /// [`UNDECIDED`] signs at all corners of the others, among which are those of degenerate and of UV-degenerate triangles.
    pub fn resume(&mut self, mesh: &Mesh<'_>, mode: Mode, welded: Vec<u32>, out: &mut [[f32; 4]]) {
        self.weld.take(welded);
        self.special.clear();
        let is_undecided = |corners: &[[f32; 4]; 3]| corners.iter().any(|corner| corner[3] == UNDECIDED);
        let triangles = (0..).zip(out.as_chunks().0);
        let undecided = triangles.filter(|(_, corners)| is_undecided(corners)).map(|(triangle, _)| triangle);
        self.special.undecided.extend(undecided);
        self.last_stretches.clear();
        if mode != Mode::Corrected && mesh.corner_count() > 0 {
            self.leave_last_edges_of_all(mesh, out);
        }
    }

    fn leave_last_edges_of_all(&mut self, mesh: &Mesh<'_>, out: &mut [[f32; 4]]) {
        let bounds = bounds_of_used(mesh);
        let run = LastRun { mesh, identity: self.weld.identity(), bounds: &bounds };
        let tail = TailCells::first(mesh, &bounds, true);
        if let Some(last) = run.find(tail, None, &mut self.lists) {
            let suspects = &self.special.undecided;
            self.last_stretches = self.names.last_stretches(&run, &last, self.weld.count, suspects);
            self.special.leave(self.names.corners_of(&last.vertices), out);
        }
    }
}
