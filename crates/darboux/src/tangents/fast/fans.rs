//! The groups around undecided vertices, found from the triangles around each of them alone.
//!
//! The reference sorts all edges by the names of their vertices, then by triangle, and matches each half-edge
//! with the first unmatched one that runs the opposite way between the same vertices. Names only bring the
//! half-edges between the same two vertices together; their order is that of the triangles. All of them
//! belong to triangles around either vertex. So the triangles around one vertex, in order, are
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
//! Where the order of the reference's last edges matters, the half-edges of each of its runs are matched with
//! each other only (see `edge_tail.rs`).
//!
//! A triangle without UV area adopts the orientation of the first group that reaches it, whichever of its
//! three vertices that is at. Each of these is undecided or has no groups, so all groups that can reach the
//! triangle are found here, in the reference's order.

use std::ops::Range;

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
    /// The entries of each undecided vertex, ascending. The next three arrays have one element for each of
    /// these.
    entries: Vec<u32>,
    /// The next vertex of the entry's triangle, and the one before; [`NONE`] where the triangle is
    /// degenerate and has no edges.
    others: Vec<[u32; 2]>,
    /// The places in `entries` across the edge to the next vertex, and across the edge to the one before; or
    /// [`NONE`].
    across: Vec<[u32; 2]>,
    /// For each entry its place in `entries`. Filled where a triangle has no UV area.
    place_of_entry: Vec<u32>,
    unmatched: UnmatchedEdges,
    /// The group of each entry, or [`NONE`].
    pub group_of_entry: Vec<u32>,
    pub groups: Vec<Group>,
    /// The number of groups found around vertices. Groups whose members do not all join come after them.
    pub first_shared: usize,
    /// The members of the latter: group and entry.
    pub shared_members: Vec<[u32; 2]>,
    /// What the members of each group add to its frame besides the tangent. Empty where full frames are not
    /// wanted.
    pub frame_sums: Vec<FrameTerm>,
    /// The edges between triangles of opposite orientation, both with UV area.
    pub mirrored_edges: usize,
}

/// The half-edges around one vertex that are not matched yet. Half-edge `2 p` leaves the vertex of place `p`,
/// `2 p + 1` enters it.
#[derive(Debug, Default)]
struct UnmatchedEdges {
    /// The first and the last one between the current vertex and each other; [`NONE`] between two searches.
    of_vertex: Vec<[u32; 2]>,
    /// The next one between the same vertices.
    later: Vec<u32>,
}

/// The most triangles around a vertex whose edges are compared in pairs, and the most of a vertex that has
/// few.
const MAX_COMPARED: usize = if cfg!(small_limits) { 3 } else { 16 };
const FEW: usize = if cfg!(small_limits) { 2 } else { 8 };

impl Fans {
    /// Finds the groups. `tail_runs`: the runs of the last edges whose order matters, by the entries where
    /// the edges start.
    pub fn find(&mut self, mesh: &mut UndecidedTriangles, tail_runs: &[Vec<u32>]) {
        self.list_entries(mesh);
        self.match_edges(mesh, tail_runs);
        self.find_groups(mesh);
    }

    /// The places of an undecided vertex's entries.
    fn places_of(&self, vertex: usize) -> Range<usize> {
        let start = if vertex == 0 { 0 } else { self.ends[vertex - 1] };
        start as usize..self.ends[vertex] as usize
    }

    /// The entries of an undecided vertex, ascending.
    pub fn entries_of(&self, vertex: usize) -> &[u32] {
        &self.entries[self.places_of(vertex)]
    }

    /// The entries of an undecided vertex, and whether their triangles are degenerate.
    pub fn entries_and_degenerate(&self, vertex: usize) -> impl Iterator<Item = (u32, bool)> + Clone {
        let places = self.places_of(vertex);
        let others = &self.others[places.clone()];
        self.entries[places].iter().zip(others).map(|(&entry, others)| (entry, others[0] == NONE))
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
        self.others.resize(self.entries.len(), [NONE; 2]);
        for ((&[a, b, c], &kind), first) in mesh.triangles.iter().zip(&mesh.kinds).zip((0..).step_by(3)) {
            let is_degenerate = kind & kinds::DEGENERATE != 0;
            for (vertex, others, entry) in
                [(a, [b, c], first), (b, [c, a], first + 1), (c, [a, b], first + 2)]
            {
                if mesh.is_undecided[vertex as usize] {
                    let next = &mut self.ends[vertex as usize];
                    self.entries[*next as usize] = entry;
                    self.others[*next as usize] = if is_degenerate { [NONE; 2] } else { others };
                    *next += 1;
                }
            }
        }
        self.ends.truncate(count);
    }

    fn match_edges(&mut self, mesh: &UndecidedTriangles, tail_runs: &[Vec<u32>]) {
        self.across.clear();
        self.across.resize(self.entries.len(), [NONE; 2]);
        let mut in_runs: Vec<u32> = tail_runs.concat();
        in_runs.sort_unstable();
        for vertex in 0..mesh.is_undecided.len() {
            let places = self.places_of(vertex);
            match places.len() {
                0..=FEW if tail_runs.is_empty() => self.match_few::<FEW>(places),
                ..=MAX_COMPARED if tail_runs.is_empty() => self.match_few::<MAX_COMPARED>(places),
                _ => {
                    self.match_many(mesh, places.clone(), &in_runs);
                    tail_runs.iter().for_each(|run| self.match_run(mesh, (vertex, places.clone()), run));
                }
            }
        }
    }

    /// Matches the half-edges of up to `N` triangles around a vertex. The first of those that leave towards
    /// one vertex is matched with the first that comes back, the second with the second, and so on: the
    /// order in which [`UnmatchedEdges`] matches them.
    fn match_few<const N: usize>(&mut self, places: Range<usize>) {
        let (start, others) = (places.start as u32, &self.others[places.clone()]);
        let across = &mut self.across[places];
        let mut nexts = [NONE; N];
        for (to, [next, _]) in nexts.iter_mut().zip(others) {
            *to = *next;
        }
        let mut unmatched = u32::MAX;
        for (entering, &[_, before]) in others.iter().enumerate() {
            let leaving: [u32; N] = std::array::from_fn(|at| if nexts[at] == before { 1 << at } else { 0 });
            let leaving = leaving.iter().fold(0, |all, bit| all | bit) & unmatched;
            if leaving != 0 && before != NONE {
                unmatched ^= leaving & leaving.wrapping_neg();
                let leaving = leaving.trailing_zeros();
                across[leaving as usize][0] = start + entering as u32;
                across[entering][1] = start + leaving;
            }
        }
    }

    /// Matches the half-edges around a vertex, but for those in runs. `in_runs`: the entries where these
    /// start, ascending.
    fn match_many(&mut self, mesh: &UndecidedTriangles, places: Range<usize>, in_runs: &[u32]) {
        let Self { entries, others, across, unmatched, .. } = self;
        unmatched.start(mesh.is_undecided.len(), across.len());
        for place in places.clone().filter(|&place| others[place][0] != NONE) {
            let starts = [entries[place], around(entries[place])[1]];
            for side in [0, 1] {
                if in_runs.binary_search(&starts[side]).is_err() {
                    unmatched.match_half_edge((2 * place + side) as u32, others[place][side], across);
                }
            }
        }
        unmatched.forget(&others[places]);
    }

    /// Matches the half-edges of a run that meet at a vertex.
    #[cold]
    fn match_run(&mut self, mesh: &UndecidedTriangles, (vertex, places): (usize, Range<usize>), run: &[u32]) {
        let Self { entries, others, across, unmatched, .. } = self;
        let place =
            |entry: u32| places.start + entries[places.clone()].partition_point(|&other| other < entry);
        for &edge in run {
            let end = around(edge)[0];
            if mesh.vertex(edge) as usize == vertex {
                unmatched.match_half_edge(2 * place(edge) as u32, mesh.vertex(end), across);
            } else if mesh.vertex(end) as usize == vertex {
                unmatched.match_half_edge(2 * place(end) as u32 + 1, mesh.vertex(edge), across);
            }
        }
        unmatched.forget(&others[places]);
    }

    /// Finds the groups. Their order matters only where a triangle without UV area adopts the orientation of
    /// the first group that reaches it.
    fn find_groups(&mut self, mesh: &mut UndecidedTriangles) {
        self.mirrored_edges = 0;
        self.groups.clear();
        self.shared_members.clear();
        self.group_of_entry.clear();
        self.group_of_entry.resize(3 * mesh.triangles.len(), NONE);
        if mesh.kinds.iter().all(|kind| kind & kinds::JOINS_ANY == 0) {
            (0..self.entries.len()).for_each(|place| self.fill_from(mesh, place));
        } else {
            self.place_of_entry.clear();
            self.place_of_entry.resize(3 * mesh.triangles.len(), NONE);
            for (&entry, place) in self.entries.iter().zip(0..) {
                self.place_of_entry[entry as usize] = place;
            }
            for entry in 0..self.place_of_entry.len() {
                let place = self.place_of_entry[entry];
                if place != NONE {
                    self.fill_from(mesh, place as usize);
                }
            }
        }
        self.first_shared = self.groups.len();
    }

    /// Makes a group of the triangle at a place, if that starts one, and all that it reaches across edges at
    /// the vertex. No triangle has more than two neighbours there.
    fn fill_from(&mut self, mesh: &mut UndecidedTriangles, seed: usize) {
        let entry = self.entries[seed];
        let kind = mesh.kind(entry);
        let starts_none = kind & (kinds::JOINS_ANY | kinds::DEGENERATE) != 0;
        if starts_none || self.group_of_entry[entry as usize] != NONE {
            return;
        }
        let (group, orientation, vertex) =
            (self.groups.len() as u32, kind & kinds::PRESERVES, mesh.vertex(entry));
        self.groups.push(Group { sum: [0.0; 3], marks: 0, vertex, preserves: orientation != 0 });
        self.group_of_entry[entry as usize] = group;
        mesh.kinds[entry as usize / 3] |= kinds::IS_GROUPED;
        for side in [0, 1] {
            let (mut from, mut at) = (kind, seed);
            loop {
                let next = self.across[at][side] as usize;
                let Some(&entry) = self.entries.get(next) else { break };
                let kind = &mut mesh.kinds[entry as usize / 3];
                // Both vertices of such an edge are undecided: it is counted at one of them.
                let is_mirrored =
                    (from | *kind) & kinds::JOINS_ANY == 0 && (from ^ *kind) & kinds::PRESERVES != 0;
                self.mirrored_edges += usize::from(is_mirrored && side == 0 && vertex < self.others[at][0]);
                if self.group_of_entry[entry as usize] != NONE {
                    break;
                }
                if *kind & kinds::JOINS_ANY != 0 && *kind & kinds::IS_GROUPED == 0 {
                    *kind = *kind & !kinds::PRESERVES | orientation;
                }
                if *kind & kinds::PRESERVES != orientation {
                    break;
                }
                *kind |= kinds::IS_GROUPED;
                self.group_of_entry[entry as usize] = group;
                (from, at) = (*kind, next);
            }
        }
    }
}

impl UnmatchedEdges {
    /// Prepares a search for a vertex. `vertex_count`: the number of all vertices. `place_count`: that of the
    /// places.
    fn start(&mut self, vertex_count: usize, place_count: usize) {
        self.of_vertex.resize(vertex_count.max(self.of_vertex.len()), [NONE; 2]);
        self.later.resize((2 * place_count).max(self.later.len()), NONE);
    }

    /// Matches a half-edge with the first unmatched one that runs the opposite way. All unmatched half-edges
    /// between the same vertices run the same way, because opposite ones would have matched.
    fn match_half_edge(&mut self, half_edge: u32, other: u32, across: &mut [[u32; 2]]) {
        let [first, last] = &mut self.of_vertex[other as usize];
        if *first == NONE {
            (*first, *last) = (half_edge, half_edge);
            self.later[half_edge as usize] = NONE;
        } else if *first & 1 == half_edge & 1 {
            self.later[*last as usize] = half_edge;
            self.later[half_edge as usize] = NONE;
            *last = half_edge;
        } else {
            for [one, other] in [[half_edge, *first], [*first, half_edge]] {
                across[one as usize / 2][one as usize % 2] = other / 2;
            }
            *first = self.later[*first as usize];
        }
    }

    /// Empties the lists between the current vertex and others.
    fn forget(&mut self, others: &[[u32; 2]]) {
        for &other in others.as_flattened().iter().filter(|other| **other != NONE) {
            self.of_vertex[other as usize] = [NONE; 2];
        }
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
