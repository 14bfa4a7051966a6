//! A run that goes on where another machine decided whole fans.

use crate::Mesh;
use crate::tangents::Mode;
use crate::topology::weld::{Bounds, Point};

use crate::tangents::fast::Fans;
use crate::tangents::fast::UNDECIDED;
use crate::tangents::fast::edge_tail::{LastRun, TailCells, are_degenerate};
use crate::tangents::fast::quads::UNCUT;
use crate::tangents::fast::source;

impl Fans {
    /// As after [`Fans::run`].
    ///
    /// `mesh`: of triangles, with indices. `welded`: the first vertex that equals each of its vertices. `out`: the tangents of decided vertices;
    /// [`UNDECIDED`] signs at all corners of the others, among which are those of UV-degenerate triangles, and at the corners of degenerate
    /// triangles.
    pub fn resume(&mut self, mesh: &Mesh<'_>, mode: Mode, welded: Vec<u32>, out: &mut [[f32; 4]]) {
        self.weld.take(welded);
        self.special.clear();
        let is_undecided = |corners: &[[f32; 4]; 3]| corners.iter().any(|corner| corner[3] == UNDECIDED);
        let triangles = (0..).zip(out.as_chunks().0);
        let undecided = triangles.filter(|(_, corners)| is_undecided(corners)).map(|(triangle, _)| triangle);
        self.special.undecided.extend(undecided);
        self.tail_runs.clear();
        if mode != Mode::Corrected && mesh.corner_count() > 0 {
            self.leave_last_edges_of_all(mesh, out);
        }
        self.add_sources(mesh, out);
    }

    /// Lists triangles with decided corners at those vertices where undecided corners of degenerate triangles copy them.
    fn add_sources(&mut self, mesh: &Mesh<'_>, out: &[[f32; 4]]) {
        let source = source(mesh, &self.weld, &UNCUT);
        let corners = |triangle: u32| 3 * triangle..3 * triangle + 3;
        let is_undecided = |corner: &u32| out[*corner as usize][3] == UNDECIDED;
        let position = |vertex| source.position(vertex);
        let is_degenerate = |triangle: &&u32| are_degenerate(source.triangle(**triangle).map(position));
        let degenerate = self.special.undecided.iter().filter(is_degenerate);
        let mut wanted = degenerate.flat_map(|&triangle| corners(triangle)).filter(is_undecided).peekable();
        if wanted.peek().is_none() {
            return;
        }
        let mut is_wanted = vec![false; self.weld.count];
        wanted.for_each(|corner| is_wanted[source.vertex(corner) as usize] = true);
        let mut next = self.special.undecided.iter().peekable();
        let mut added = Vec::new();
        for triangle in 0..source.count() as u32 {
            let is_listed = next.next_if_eq(&&triangle).is_some();
            for corner in corners(triangle).filter(|corner| !is_undecided(corner)) {
                if std::mem::take(&mut is_wanted[source.vertex(corner) as usize]) && !is_listed {
                    added.push(triangle);
                }
            }
        }
        self.special.undecided.append(&mut added);
        self.special.undecided.sort_unstable();
        self.special.undecided.dedup();
    }

    /// Positions are looked at vertex by vertex: by corners it would take as long as a run.
    fn leave_last_edges_of_all(&mut self, mesh: &Mesh<'_>, out: &mut [[f32; 4]]) {
        let position = |vertex| mesh.positions().get(vertex);
        let mut is_wanted = vec![false; mesh.vertex_count()];
        (0..mesh.corner_count()).for_each(|corner| is_wanted[mesh.vertex_of_corner(corner)] = true);
        let mut used = (0..is_wanted.len()).filter(|&vertex| is_wanted[vertex]).map(position);
        let bounds = Bounds::of(used.next().unwrap_or_default(), used);
        let run = LastRun { source: source(mesh, &self.weld, &UNCUT), bounds: &bounds };
        let tail = TailCells::first(&run.source, &bounds, true);
        for (vertex, is_wanted) in is_wanted.iter_mut().enumerate() {
            *is_wanted = tail.hold(position(vertex));
        }
        let vertices = (0..).zip((0..mesh.corner_count()).map(|corner| mesh.vertex_of_corner(corner)));
        let in_tail = vertices.filter(|(_, vertex)| is_wanted[*vertex]);
        let points: Vec<Point> =
            in_tail.map(|(entry, vertex)| Point { position: position(vertex), entry }).collect();
        if let Some(last) = run.find(tail, Some(&points), &mut self.lists) {
            let suspects = &self.special.undecided;
            self.tail_runs = self.names.tail_runs(&run, &last, self.weld.count, suspects);
            self.special.leave(&run.source, self.names.entries_of(&last.vertices), out);
        }
    }
}
