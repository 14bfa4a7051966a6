//! Resumes the fast path from the results of a GPU, which welds vertices and computes the tangents of
//! vertices that it can decide.

use crate::Mesh;
use crate::tangents::options::Mode;
use crate::topology::weld::Bounds;

use crate::tangents::fast::edge_tail::{TailCells, are_degenerate};
use crate::tangents::fast::proof::UNDECIDED;
use crate::tangents::fast::quads::FaceSplit;
use crate::tangents::fast::state::FastPath;

impl FastPath {
    /// Brings the state to what it is after `FastPath::run`.
    ///
    /// `mesh`: indexed triangles. `welded`: for each vertex the first vertex that equals it. `out`: the
    /// tangents of decided vertices; [`UNDECIDED`] signs at all corners of other vertices, among them
    /// those of UV-degenerate triangles, and at the corners of degenerate triangles.
    pub fn resume(&mut self, mesh: &Mesh<'_>, mode: Mode, welded: Vec<u32>, out: &mut [[f32; 4]]) {
        self.weld.set(mesh, welded);
        self.split = FaceSplit::default();
        self.exceptions.clear();
        let is_undecided = |corners: &[[f32; 4]; 3]| corners.iter().any(|corner| corner[3] == UNDECIDED);
        let triangles = (0..).zip(out.as_chunks().0);
        let undecided = triangles.filter(|(_, corners)| is_undecided(corners)).map(|(triangle, _)| triangle);
        self.exceptions.undecided.extend(undecided);
        self.tail_runs.clear();
        if mode != Mode::Corrected && mesh.corner_count() > 0 {
            self.search_last_edges_in_mesh(mesh, out);
        }
        self.list_copied_triangles(mesh, out);
    }

    /// Lists triangles with decided corners at vertices whose tangents undecided corners of degenerate
    /// triangles copy.
    fn list_copied_triangles(&mut self, mesh: &Mesh<'_>, out: &[[f32; 4]]) {
        let list = self.list(mesh);
        let corners = |triangle: u32| 3 * triangle..3 * triangle + 3;
        let is_undecided = |corner: &u32| out[*corner as usize][3] == UNDECIDED;
        let position = |vertex| list.position(vertex);
        let is_degenerate = |triangle: &&u32| are_degenerate(list.triangle(**triangle).map(position));
        let degenerate = self.exceptions.undecided.iter().filter(is_degenerate);
        let mut wanted = degenerate.flat_map(|&triangle| corners(triangle)).filter(is_undecided).peekable();
        if wanted.peek().is_none() {
            return;
        }
        let mut is_wanted = vec![false; self.weld.count];
        wanted.for_each(|corner| is_wanted[list.vertex(corner) as usize] = true);
        let mut next = self.exceptions.undecided.iter().peekable();
        let mut added = Vec::new();
        for triangle in 0..list.count() as u32 {
            let is_listed = next.next_if_eq(&&triangle).is_some();
            for corner in corners(triangle).filter(|corner| !is_undecided(corner)) {
                if std::mem::take(&mut is_wanted[list.vertex(corner) as usize]) && !is_listed {
                    added.push(triangle);
                }
            }
        }
        self.exceptions.undecided.append(&mut added);
        self.exceptions.undecided.sort_unstable();
        self.exceptions.undecided.dedup();
    }

    /// Searches for the last edges whose order changes the result.
    fn search_last_edges_in_mesh(&mut self, mesh: &Mesh<'_>, out: &mut [[f32; 4]]) {
        let mut is_used = vec![false; mesh.vertex_count()];
        (0..mesh.corner_count()).for_each(|corner| is_used[mesh.vertex_of_corner(corner)] = true);
        let position = |vertex| mesh.positions().get(vertex);
        let mut used = (0..is_used.len()).filter(|&vertex| is_used[vertex]).map(position);
        let bounds = Bounds::of(used.next().unwrap_or_default(), used);
        let cells = TailCells::first(&self.list(mesh), &bounds, true);
        self.undecide_last_edges(mesh, &bounds, &cells, false, out);
    }
}
