//! Decides undecided vertices by the groups around each of them: several fans, mirrored halves, triangles
//! without UV area, edges of more than two triangles.
//!
//! ```text
//! collect the triangles with undecided vertices, and what their corners add              undecided.rs
//! match the edges at each vertex, and find the groups                                     fans.rs
//! add every triangle, in order, to the groups of its corners
//! for each group: if nothing is opposite, all members share the sum; else compare all pairs   pairs.rs
//! copy the tangents of groups to corners
//! ```
//!
//! A group takes the place of the vertex in the first pass: its sum is that of its triangles in their order,
//! with the same terms. Only what needs a repair, and large groups that are not one subgroup, stay undecided,
//! and go through the general path; with such a vertex go those that it shares a triangle without UV area or
//! a degenerate triangle with, because the groups around these depend on each other.

use std::ops::Range;

use crate::Frame;
use crate::Mesh;
use crate::math::{distinct_bits, normalized_unless_zero};
use crate::tangents::mikktspace::raw_frames::DEFAULT_FRAME;
use crate::tangents::options::Mode;
use crate::tangents::repair::is_usable;
use crate::tangents::report::Report;
use crate::topology::triangles::NONE;
use crate::util::radix_sort::{first, pair, second, sort};

use crate::tangents::fast::fans::{Fans, add_frame_term};
use crate::tangents::fast::pairs::PairwiseTest;
use crate::tangents::fast::passes::is_clearly_usable;
use crate::tangents::fast::proof::is_one_subgroup;
use crate::tangents::fast::undecided::{FrameTerm, UndecidedTriangles, kinds};

/// The memory of the resolution, reused from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct Resolution {
    pub triangles: UndecidedTriangles,
    pub fans: Fans,
    pairs: PairwiseTest,
    /// The tangent and the sign of each group.
    tangents: Vec<[f32; 4]>,
    /// True for groups whose tangent needs no repair.
    is_usable: Vec<bool>,
    /// True for vertices that stay undecided.
    is_left: Vec<bool>,
}

impl Resolution {
    /// Adds up the tangents of all groups.
    pub fn find_tangents(&mut self, threshold_cosine: f32) {
        let Self { triangles, fans, pairs, tangents, is_usable: usable, is_left } = self;
        is_left.clear();
        is_left.resize(triangles.is_undecided.len(), false);
        for (terms, groups) in triangles
            .terms
            .iter()
            .zip(fans.group_of_entry.as_chunks::<3>().0)
            .zip(&triangles.kinds)
            .filter(|(_, kind)| **kind & kinds::JOINS_ANY == 0)
            .map(|(both, _)| both)
        {
            for (&[x, y, z, marks], &group) in terms.iter().zip(groups) {
                if let Some(group) = fans.groups.get_mut(group as usize) {
                    group.add([x, y, z]);
                    group.marks |= marks.to_bits();
                }
            }
        }
        fans.frame_sums.clear();
        if !triangles.frame_terms.is_empty() {
            fans.frame_sums.resize(fans.groups.len(), FrameTerm::default());
            add_frame_terms(triangles, &fans.group_of_entry, &mut fans.frame_sums);
        }
        for group in 0..fans.groups.len() {
            let joined = threshold_cosine == -1.0 && is_one_subgroup(fans.groups[group].marks);
            if !joined && !pairs.separate(triangles, fans, group as u32, threshold_cosine) {
                is_left[fans.groups[group].vertex as usize] = true;
            }
        }
        tangents.clear();
        usable.clear();
        for group in &fans.groups {
            let [x, y, z] = normalized_unless_zero(group.sum);
            tangents.push([x, y, z, if group.preserves { 1.0 } else { -1.0 }]);
            usable.push(needs_no_repair([x, y, z], triangles.normal(group.vertex)));
        }
        for &vertex in &triangles.inexact {
            is_left[vertex as usize] |= triangles.is_undecided[vertex as usize];
        }
        self.join_corners_of_quads();
    }

    /// The corners on the diagonal of a quad have two entries. One that no group has reached takes the group
    /// of the other. Where the groups differ, the reference averages two frames; so it does where a frame
    /// is not finite, and so not equal to itself, which a sum of opposite directions can be. These
    /// vertices are left.
    fn join_corners_of_quads(&mut self) {
        let Self { triangles, fans, is_left, .. } = self;
        for second in (1..triangles.kinds.len()).filter(|&at| triangles.is_second[at]) {
            for (a, corner) in (3 * (second as u32 - 1)..).zip(triangles.corners[second - 1]) {
                let Some(k) = (0..3).find(|&k| triangles.corners[second][k] == corner) else { continue };
                let [a, b] = [a as usize, 3 * second + k];
                match (fans.group_of_entry[a], fans.group_of_entry[b]) {
                    (NONE, group) | (group, NONE) => {
                        fans.group_of_entry[a] = group;
                        fans.group_of_entry[b] = group;
                    }
                    (one, other) => {
                        let is_doubtful = !is_one_subgroup(fans.groups[one as usize].marks);
                        is_left[triangles.vertex(a as u32) as usize] |= one != other || is_doubtful;
                    }
                }
            }
        }
    }

    /// The undecided vertices that are not left.
    pub fn decided_vertices(&self) -> impl Iterator<Item = usize> {
        (0..self.is_left.len()).filter(|&vertex| self.triangles.is_undecided[vertex] && !self.is_left[vertex])
    }

    /// True where some vertex stays undecided.
    pub fn leaves_any(&self) -> bool {
        self.is_left.contains(&true)
    }

    /// True for a face without a vertex that is left. `face`: its triangles.
    pub fn is_complete(&self, face: Range<usize>) -> bool {
        !self.triangles.triangles[face].as_flattened().iter().any(|&vertex| self.is_left[vertex as usize])
    }

    /// The corners of a face, those on the diagonal of a quad twice.
    fn corners_of(&self, face: Range<usize>) -> impl Iterator<Item = usize> {
        self.triangles.corners[face].as_flattened().iter().map(|&corner| corner as usize)
    }

    /// True for a face with a triangle whose corners can have both signs. The corners of all others have the
    /// orientation of their triangle.
    fn can_have_both_signs(&self, face: Range<usize>) -> bool {
        let kinds = self.triangles.kinds[face].iter();
        kinds.fold(0, |all, kind| all | kind) & (kinds::JOINS_ANY | kinds::DEGENERATE) != 0
    }

    /// Finds the vertices that stay undecided.
    pub fn find_left(&mut self, mode: Mode, out: &[[f32; 4]]) {
        let count = self.is_left.len();
        if mode != Mode::Reference {
            for vertex in (0..count).filter(|&vertex| self.triangles.is_undecided[vertex]) {
                let all_usable = self.values_at(vertex).all(|(_, _, is_usable)| is_usable);
                self.is_left[vertex] |= !all_usable;
            }
        }
        if mode == Mode::Corrected {
            self.leave_mixed_signs(out);
        }
        self.leave_dependent();
    }

    /// Leaves the vertices whose groups depend on those around others that are left. Around a vertex that no
    /// group has reached there is nothing to depend on a triangle without UV area.
    fn leave_dependent(&mut self) {
        if !self.leaves_any() {
            return;
        }
        let has_groups: Vec<bool> = (0..self.is_left.len()).map(|vertex| self.has_groups(vertex)).collect();
        let mut pending: Vec<usize> = (0..has_groups.len()).filter(|&vertex| self.is_left[vertex]).collect();
        while let Some(vertex) = pending.pop() {
            for &entry in self.fans.entries_of(vertex) {
                let kind = self.triangles.kind(entry);
                for other in self.triangles.triangles[entry as usize / 3].map(|vertex| vertex as usize) {
                    let depends = kind & kinds::DEGENERATE != 0
                        || kind & kinds::JOINS_ANY != 0 && has_groups[vertex] && has_groups[other];
                    if depends && self.triangles.is_undecided[other] && !self.is_left[other] {
                        self.is_left[other] = true;
                        pending.push(other);
                    }
                }
            }
        }
    }

    /// True where a group has reached a corner at a vertex.
    fn has_groups(&self, vertex: usize) -> bool {
        self.fans.entries_of(vertex).iter().any(|&entry| self.fans.group_of_entry[entry as usize] != NONE)
    }

    /// Leaves the vertices of triangles whose corners have both signs.
    fn leave_mixed_signs(&mut self, out: &[[f32; 4]]) {
        let sign = |corner: u32| out[corner as usize][3];
        let mut signs: Vec<[f32; 3]> =
            self.triangles.corners.iter().map(|corners| corners.map(sign)).collect();
        for vertex in (0..self.is_left.len()).filter(|&vertex| self.triangles.is_undecided[vertex]) {
            for (entry, tangent, _) in self.values_at(vertex) {
                signs[entry as usize / 3][entry as usize % 3] = tangent[3];
            }
        }
        for face in self.triangles.faces() {
            if has_both_signs(signs[face.clone()].as_flattened().iter().copied()) {
                for &vertex in self.triangles.triangles[face].as_flattened() {
                    self.is_left[vertex as usize] |= self.triangles.is_undecided[vertex as usize];
                }
            }
        }
    }

    /// The entries of an undecided vertex with their tangents, and whether these need no repair.
    fn values_at(&self, vertex: usize) -> impl Iterator<Item = (u32, [f32; 4], bool)> {
        self.groups_at(vertex).map(move |(entry, group, is_usable)| {
            let tangent = self.tangents.get(group).copied();
            (entry, tangent.unwrap_or_else(|| DEFAULT_FRAME.tangent_and_sign()), is_usable)
        })
    }

    /// The entries of an undecided vertex with their groups, and whether the tangents need no repair.
    ///
    /// A corner that no group has reached keeps the default; its group is a number above all. One of a
    /// degenerate triangle has what the first other corner at the vertex has.
    pub fn groups_at(&self, vertex: usize) -> impl Iterator<Item = (u32, usize, bool)> {
        let Self { triangles, fans, is_usable, .. } = self;
        let entries = fans.entries_and_degenerate(vertex);
        let first_good = entries.clone().find(|(_, is_degenerate)| !is_degenerate);
        let of_degenerate = first_good.map_or(NONE, |(entry, _)| fans.group_of_entry[entry as usize]);
        entries.map(move |(entry, is_degenerate)| {
            let group = if is_degenerate { of_degenerate } else { fans.group_of_entry[entry as usize] };
            let default = || needs_no_repair(DEFAULT_FRAME.tangent, triangles.normal(vertex as u32));
            let is_usable = is_usable.get(group as usize).copied();
            (entry, group as usize, is_usable.unwrap_or_else(default))
        })
    }

    /// Writes the tangents of all vertices that are not left. Returns the counts of all triangles, and those
    /// of corners of triangles without a vertex that is left.
    pub fn write(&self, out: &mut [[f32; 4]]) -> Report {
        let Self { triangles, fans, .. } = self;
        let count = |kind: u8| triangles.kinds.iter().filter(|&&other| other & kind != 0).count();
        let mut report = Report {
            degenerate_triangles: count(kinds::DEGENERATE),
            uv_degenerate_triangles: count(kinds::JOINS_ANY),
            mirrored_edges: fans.mirrored_edges,
            ..Report::default()
        };
        for vertex in self.decided_vertices() {
            for (entry, tangent, is_usable) in self.values_at(vertex) {
                out[triangles.corner(entry) as usize] = tangent;
                report.repaired_corners += usize::from(!is_usable && self.is_counted(entry));
            }
        }
        if report.degenerate_triangles + report.uv_degenerate_triangles == 0 {
            return report;
        }
        for face in triangles.faces().filter(|face| self.can_have_both_signs(face.clone())) {
            let signs = self.corners_of(face.clone()).map(|corner| out[corner][3]);
            report.mixed_sign_faces += usize::from(has_both_signs(signs) && self.is_complete(face));
        }
        report
    }

    /// True for one entry of each corner of faces without a vertex that is left.
    fn is_counted(&self, entry: u32) -> bool {
        let is_second = &self.triangles.is_second;
        let at = entry as usize / 3;
        let first = if is_second[at] { at - 1 } else { at };
        let end = if is_second.get(first + 1) == Some(&true) { first + 2 } else { first + 1 };
        !self.is_repeated(entry) && self.is_complete(first..end)
    }

    /// True for the second entry of a corner.
    fn is_repeated(&self, entry: u32) -> bool {
        let UndecidedTriangles { is_second, corners, .. } = &self.triangles;
        let at = entry as usize / 3;
        is_second[at] && corners[at - 1].contains(&self.triangles.corner(entry))
    }

    /// Lists the corners of all vertices that are not left, with their full frames.
    pub fn list_frames(&self, frames: &mut Vec<(u32, Frame)>) {
        let Self { triangles, fans, tangents, .. } = self;
        for vertex in self.decided_vertices() {
            for (entry, group, _) in self.groups_at(vertex).filter(|(entry, ..)| !self.is_repeated(*entry)) {
                let frame = match (tangents.get(group), fans.frame_sums.get(group)) {
                    (Some(&tangent), Some(&[x, y, z, weight, s, t])) => {
                        frame(tangent, [x, y, z], weight, [s, t])
                    }
                    _ => DEFAULT_FRAME,
                };
                frames.push((triangles.corner(entry), frame));
            }
        }
    }

    /// The number of vertices of the mesh whose corners have different tangents. `out`: the tangents of all
    /// corners.
    pub fn count_split(&self, mesh: &Mesh<'_>, out: &[[f32; 4]]) -> usize {
        let Self { triangles, fans, .. } = self;
        let tangent = |entry: u32| out[triangles.corner(entry) as usize];
        let bits = |entry: u32| distinct_bits(tangent(entry));
        let mut count = 0;
        let mut by_vertex = Vec::new();
        for vertex in (0..triangles.is_undecided.len()).filter(|&vertex| triangles.is_undecided[vertex]) {
            let entries = fans.entries_of(vertex);
            let of_mesh = |entry: u32| mesh.vertex_of_corner(triangles.corner(entry) as usize) as u32;
            // Most are equal in all bits; then nothing has to be told apart.
            let first_bits = tangent(entries[0]).map(f32::to_bits);
            if entries.iter().all(|&entry| tangent(entry).map(f32::to_bits) == first_bits) {
                continue;
            }
            by_vertex.clear();
            by_vertex.extend(entries.iter().map(|&entry| pair(of_mesh(entry), entry)));
            sort(&mut by_vertex);
            let same = by_vertex.chunk_by(|&a, &b| first(a) == first(b));
            let is_split =
                |same: &&[u64]| same.iter().any(|&entry| bits(second(entry)) != bits(second(same[0])));
            count += same.filter(is_split).count();
        }
        count
    }
}

/// Adds what the members of groups add to their frames.
fn add_frame_terms(triangles: &UndecidedTriangles, group_of_entry: &[u32], sums: &mut [FrameTerm]) {
    for (&group, entry) in group_of_entry.iter().zip(0..) {
        if triangles.kind(entry) & kinds::JOINS_ANY == 0
            && let (Some(sum), Some(term)) = (sums.get_mut(group as usize), triangles.frame_term(entry))
        {
            add_frame_term(sum, term);
        }
    }
}

/// The frame of a group. `bitangent`, `magnitude`: sums of weighted values.
fn frame([x, y, z, sign]: [f32; 4], bitangent: [f32; 3], weight: f32, magnitude: [f32; 2]) -> Frame {
    let magnitude = if weight > 0.0 { magnitude.map(|sum| sum / weight) } else { magnitude };
    Frame { tangent: [x, y, z], bitangent: normalized_unless_zero(bitangent), magnitude, sign }
}

/// True when the signs differ.
fn has_both_signs(mut signs: impl Iterator<Item = f32>) -> bool {
    let first = signs.next();
    signs.any(|sign| Some(sign) != first)
}

/// As [`is_usable`], which is asked only near its limits.
pub(crate) fn needs_no_repair(tangent: [f32; 3], normal: [f32; 3]) -> bool {
    is_clearly_usable(tangent, normal) || is_usable(tangent, normal)
}
