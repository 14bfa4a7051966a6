//! The subgroups of small groups, by comparing all pairs of members (see
//! `crate::tangents::mikktspace::subgroups`).

use crate::math::{V3, add, direction_in_plane, dot};
use crate::tangents::mikktspace::derivatives::derivative;

use crate::tangents::fast::fans::{Fans, Group, add_frame_term};
use crate::tangents::fast::undecided::{FrameTerm, UndecidedTriangles, kinds};

/// The most triangles around a vertex whose groups are separated here: the bits of a mask.
const MAX_ENTRIES: usize = if cfg!(small_limits) { 5 } else { u64::BITS as usize };

/// The members of one group. The memory is reused from group to group.
#[derive(Debug, Default)]
pub(crate) struct PairwiseTest {
    members: Vec<Member>,
    /// The members that each member joins, as bits.
    masks: Vec<u64>,
}

#[derive(Clone, Copy, Debug)]
struct Member {
    entry: u32,
    joins_any: bool,
    /// The directions of the tangent and of the bitangent in the plane of the normal.
    s: V3,
    t: V3,
}

impl Member {
    fn joins(&self, other: &Self, threshold_cosine: f32) -> bool {
        self.joins_any
            || other.joins_any
            || dot(self.s, other.s) > threshold_cosine && dot(self.t, other.t) > threshold_cosine
    }
}

impl PairwiseTest {
    /// Gives the members of a group that are not one subgroup groups of their own. False where the vertex has
    /// too many triangles.
    #[cold]
    pub fn separate(
        &mut self,
        mesh: &UndecidedTriangles,
        fans: &mut Fans,
        group: u32,
        threshold_cosine: f32,
    ) -> bool {
        let Group { vertex, marks, preserves, .. } = fans.groups[group as usize];
        let entries = fans.entries_of(vertex as usize);
        if entries.len() > MAX_ENTRIES {
            return false;
        }
        let Self { members, masks } = self;
        let of_group = entries.iter().filter(|&&entry| fans.group_of_entry[entry as usize] == group);
        members.clear();
        members.extend(of_group.map(|&entry| member(mesh, entry)));
        let bit = |is: bool, at: usize| if is { 1 << at } else { 0 };
        masks.clear();
        masks.extend(members.iter().map(|member| {
            let joined = members.iter().map(|other| {
                mesh.are_of_one_face(member.entry, other.entry) || member.joins(other, threshold_cosine)
            });
            joined.enumerate().fold(0, |mask, (at, joined)| mask | bit(joined, at))
        }));
        if masks.iter().all(|mask| mask.count_ones() as usize == members.len()) {
            return true;
        }
        for (at, (&mask, member)) in masks.iter().zip(&*members).enumerate() {
            let known = masks[..at].iter().position(|&earlier| earlier == mask);
            fans.group_of_entry[member.entry as usize] = match known {
                Some(known) => fans.group_of_entry[members[known].entry as usize],
                None => {
                    let joined = members.iter().enumerate().filter(|(at, _)| mask >> at & 1 == 1);
                    let terms = joined.filter(|(_, other)| !other.joins_any);
                    let sum = terms.fold([0.0; 3], |sum, (_, other)| {
                        let [x, y, z, _] = mesh.term(other.entry);
                        add(sum, [x, y, z])
                    });
                    if !mesh.frame_terms.is_empty() {
                        let mut sum = FrameTerm::default();
                        let joined = members.iter().enumerate().filter(|(at, _)| mask >> at & 1 == 1);
                        for (_, other) in joined.filter(|(_, other)| !other.joins_any) {
                            mesh.frame_term(other.entry)
                                .into_iter()
                                .for_each(|term| add_frame_term(&mut sum, term));
                        }
                        fans.frame_sums.push(sum);
                    }
                    let number = fans.groups.len() as u32;
                    let joined = members.iter().enumerate().filter(|(at, _)| mask >> at & 1 == 1);
                    fans.shared_members.extend(joined.map(|(_, other)| [number, other.entry]));
                    fans.groups.push(Group { sum, marks, vertex, preserves });
                    number
                }
            };
        }
        true
    }
}

fn member(mesh: &UndecidedTriangles, entry: u32) -> Member {
    let records = mesh.triangles[entry as usize / 3].map(|vertex| mesh.records[vertex as usize]);
    let derivative = derivative(records.map(|[x, y, z, ..]| [x, y, z]), records.map(|[.., u, v]| [u, v]));
    let normal = mesh.normal(mesh.vertex(entry));
    let [s, t] = [derivative.s, derivative.t].map(|v| direction_in_plane(normal, v));
    Member { entry, joins_any: mesh.kind(entry) & kinds::JOINS_ANY != 0, s, t }
}
