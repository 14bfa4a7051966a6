//! The groups around undecided vertices, found from the triangles around each of them alone.
//!
//! The reference sorts all edges by the names of their vertices, then by triangle, and matches each half-edge with the first unmatched one
//! that runs the opposite way between the same vertices. Names only bring the half-edges between the same two vertices together; their
//! order is that of the triangles. All of them belong to triangles around either vertex. So the triangles around one vertex, in order, are
//! enough to match the edges that meet there, however many triangles an edge has:
//!
//! ```text
//! for each undecided vertex v:                                            match_edges
//!     for each triangle around v, in order, and each of its two half-edges at v, which joins v with x:
//!         if unmatched half-edges between v and x run the opposite way: match it with the first of them
//!         else: it is unmatched
//! for each corner of each triangle, in order, at an undecided vertex:     find_groups
//!     unless the triangle has no UV area or the corner has a group:
//!         flood fill from the triangle, across matched edges at the vertex, to triangles of the same orientation
//! ```
//!
//! Where the order of the reference's last edges matters, the half-edges of each of its runs are matched with each other only
//! (see `edge_tail.rs`).
//!
//! A triangle without UV area adopts the orientation of the first group that reaches it, whichever of its three vertices that is at. Each of
//! these is undecided or has no groups, so all groups that can reach the triangle are found here, in the reference's order.

use crate::math::add;
use crate::topology::triangles::NONE;

use crate::tangents::fast::undecided::{FrameTerm, UndecidedTriangles, kinds};

/// A group: the triangles around a vertex that are connected by edges there and have one orientation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Group {
    /// The sum of the members' weighted tangents.
    pub sum: [f32; 3],
    /// The members' marks, OR-ed together.
    pub marks: u32,
    pub vertex: u32,
    pub preserves: bool,
}

impl Group {
    /// Adds the weighted tangent of a member.
    #[inline(always)]
    pub fn add(&mut self, term: [f32; 3]) {
        self.sum = add(self.sum, term);
    }
}

/// The groups around undecided vertices. The memory is reused from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct Fans {
    /// The end of each vertex's entries in `entries`.
    ends: Vec<u32>,
    /// The entries of each undecided vertex, ascending.
    entries: Vec<u32>,
    /// The entry of the same vertex across each half-edge, or [`NONE`]. Half-edge `2 e` leaves the vertex of entry `e`, `2 e + 1` enters it.
    across: Vec<u32>,
    /// The next unmatched half-edge between the same vertices.
    later: Vec<u32>,
    /// The first and the last unmatched half-edge between the current vertex and each other.
    unmatched: Vec<[u32; 2]>,
    /// The group of each entry, or [`NONE`].
    pub group_of_entry: Vec<u32>,
    pub groups: Vec<Group>,
    /// The number of groups found around vertices. Those of members that do not all join come after them.
    pub first_shared: usize,
    /// The members of the latter: group and entry.
    pub shared_members: Vec<[u32; 2]>,
    /// What the members of each group add to its frame besides the tangent. Empty where full frames are not wanted.
    pub frame_sums: Vec<FrameTerm>,
    /// The edges between triangles of opposite orientation, both with UV area.
    pub mirrored_edges: usize,
    pending: Vec<u32>,
}

impl Fans {
    /// Finds the groups. `tail_runs`: the runs of the last edges whose order matters, by the entries where the edges start.
    pub fn find(&mut self, mesh: &mut UndecidedTriangles, tail_runs: &[Vec<u32>]) {
        self.list_entries(mesh);
        self.match_edges(mesh, tail_runs);
        self.find_groups(mesh);
    }

    /// The entries of an undecided vertex, ascending.
    pub fn entries_of(&self, vertex: usize) -> &[u32] {
        let start = if vertex == 0 { 0 } else { self.ends[vertex - 1] };
        &self.entries[start as usize..self.ends[vertex] as usize]
    }

    fn list_entries(&mut self, mesh: &UndecidedTriangles) {
        let count = mesh.is_undecided.len();
        self.ends.clear();
        self.ends.resize(count + 1, 0);
        for &vertex in mesh.triangles.as_flattened() {
            self.ends[vertex as usize + 1] += u32::from(mesh.is_undecided[vertex as usize]);
        }
        for vertex in 0..count {
            self.ends[vertex + 1] += self.ends[vertex];
        }
        self.entries.resize(self.ends[count] as usize, 0);
        for (&vertex, entry) in mesh.triangles.as_flattened().iter().zip(0..) {
            if mesh.is_undecided[vertex as usize] {
                let next = &mut self.ends[vertex as usize];
                self.entries[*next as usize] = entry;
                *next += 1;
            }
        }
        self.ends.truncate(count);
    }

    fn match_edges(&mut self, mesh: &UndecidedTriangles, tail_runs: &[Vec<u32>]) {
        let count = mesh.is_undecided.len();
        self.mirrored_edges = 0;
        self.across.clear();
        self.across.resize(6 * mesh.triangles.len(), NONE);
        self.later.resize(6 * mesh.triangles.len(), NONE);
        self.unmatched.clear();
        self.unmatched.resize(count, [NONE; 2]);
        let mut in_runs: Vec<u32> = tail_runs.concat();
        in_runs.sort_unstable();
        for vertex in 0..count {
            let (start, end) = (if vertex == 0 { 0 } else { self.ends[vertex - 1] }, self.ends[vertex]);
            for at in start..end {
                let entry = self.entries[at as usize];
                if mesh.kind(entry) & kinds::DEGENERATE == 0 {
                    self.match_entry(mesh, entry, |edge| in_runs.binary_search(&edge).is_err());
                }
            }
            self.forget_unmatched(mesh, start..end);
            for run in tail_runs {
                self.match_run(mesh, vertex as u32, run);
                self.forget_unmatched(mesh, start..end);
            }
        }
    }

    /// Matches both half-edges of an entry, if they are wanted. An edge is named by the entry where it starts.
    #[inline(always)]
    fn match_entry(&mut self, mesh: &UndecidedTriangles, entry: u32, is_wanted: impl Fn(u32) -> bool) {
        let [next, before] = around(entry);
        if is_wanted(entry) {
            self.match_half_edge(mesh, 2 * entry, mesh.vertex(next));
        }
        if is_wanted(before) {
            self.match_half_edge(mesh, 2 * entry + 1, mesh.vertex(before));
        }
    }

    /// Matches the half-edges of a run that meet at `vertex`.
    #[cold]
    fn match_run(&mut self, mesh: &UndecidedTriangles, vertex: u32, run: &[u32]) {
        for &edge in run {
            let end = around(edge)[0];
            if mesh.vertex(edge) == vertex {
                self.match_half_edge(mesh, 2 * edge, mesh.vertex(end));
            } else if mesh.vertex(end) == vertex {
                self.match_half_edge(mesh, 2 * end + 1, mesh.vertex(edge));
            }
        }
    }

    /// Matches a half-edge with the first unmatched one that runs the opposite way. All unmatched half-edges between the same vertices run
    /// the same way, because opposite ones would have matched.
    #[inline(always)]
    fn match_half_edge(&mut self, mesh: &UndecidedTriangles, half_edge: u32, other: u32) {
        let [first, last] = &mut self.unmatched[other as usize];
        if *first == NONE {
            (*first, *last) = (half_edge, half_edge);
            self.later[half_edge as usize] = NONE;
        } else if *first & 1 == half_edge & 1 {
            self.later[*last as usize] = half_edge;
            self.later[half_edge as usize] = NONE;
            *last = half_edge;
        } else {
            let [entry, matched] = [half_edge / 2, *first / 2];
            self.across[*first as usize] = entry;
            self.across[half_edge as usize] = matched;
            *first = self.later[*first as usize];
            let (a, b) = (mesh.kind(entry), mesh.kind(matched));
            let is_mirrored = (a | b) & kinds::JOINS_ANY == 0 && (a ^ b) & kinds::PRESERVES != 0;
            // Both vertices of such an edge are undecided: it is counted at one of them.
            self.mirrored_edges += usize::from(is_mirrored && mesh.vertex(entry) < other);
        }
    }

    /// Empties the lists of unmatched half-edges between a vertex with the given entries and all others.
    #[inline(always)]
    fn forget_unmatched(&mut self, mesh: &UndecidedTriangles, entries: std::ops::Range<u32>) {
        for &entry in &self.entries[entries.start as usize..entries.end as usize] {
            around(entry).iter().for_each(|&other| self.unmatched[mesh.vertex(other) as usize] = [NONE; 2]);
        }
    }

    fn find_groups(&mut self, mesh: &mut UndecidedTriangles) {
        self.groups.clear();
        self.shared_members.clear();
        self.group_of_entry.clear();
        self.group_of_entry.resize(3 * mesh.triangles.len(), NONE);
        for seed in 0..3 * mesh.triangles.len() as u32 {
            let (kind, vertex) = (mesh.kind(seed), mesh.vertex(seed));
            let starts_none = kind & (kinds::JOINS_ANY | kinds::DEGENERATE) != 0;
            if starts_none
                || self.group_of_entry[seed as usize] != NONE
                || !mesh.is_undecided[vertex as usize]
            {
                continue;
            }
            let (group, orientation) = (self.groups.len() as u32, kind & kinds::PRESERVES);
            self.groups.push(Group { sum: [0.0; 3], marks: 0, vertex, preserves: orientation != 0 });
            self.pending.push(seed);
            while let Some(entry) = self.pending.pop() {
                let kind = &mut mesh.kinds[entry as usize / 3];
                if self.group_of_entry[entry as usize] != NONE {
                    continue;
                }
                if *kind & kinds::JOINS_ANY != 0 && *kind & kinds::IS_GROUPED == 0 {
                    *kind = *kind & !kinds::PRESERVES | orientation;
                }
                if *kind & kinds::PRESERVES == orientation {
                    *kind |= kinds::IS_GROUPED;
                    self.group_of_entry[entry as usize] = group;
                    let neighbours = [2 * entry, 2 * entry + 1].map(|at| self.across[at as usize]);
                    self.pending.extend(neighbours.into_iter().filter(|&entry| entry != NONE));
                }
            }
        }
        self.first_shared = self.groups.len();
    }
}

/// Adds what a member of a group adds to its frame.
#[inline(always)]
pub(crate) fn add_frame_term(sum: &mut FrameTerm, term: &FrameTerm) {
    for lane in 0..6 {
        sum[lane] += term[lane];
    }
}

/// The next entry of a triangle, and the one before.
#[inline(always)]
fn around(entry: u32) -> [u32; 2] {
    match entry % 3 {
        0 => [entry + 1, entry + 2],
        1 => [entry + 1, entry - 1],
        _ => [entry - 2, entry - 1],
    }
}
