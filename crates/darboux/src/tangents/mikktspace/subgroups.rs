//! Subgroups: which members of a group share a tangent under the angular threshold.
//!
//! A *member* is corner `k` of triangle `t`, as `3 t + k`. Two members join when
//! - one of the triangles is UV-degenerate, or
//! - the triangles are halves of one quad, or
//! - the angle between their tangents and the angle between their bitangents, both in the tangent plane of the vertex, are below the
//!   threshold.
//!
//! The subgroup of a member is the set of all members that it joins. [`SubgroupFinder`] stores its complement, the *excluded* members,
//! which are few in most groups:
//!
//! ```text
//! if every direction is within half the threshold of the mean direction: nothing is excluded
//! for each member, in the order in which the reference writes them:
//!     excluded = members that it does not join
//!         threshold 180 degrees: only exactly opposite directions are excluded; AntipodeGrid lists the candidates
//!         smaller thresholds: compare with all members
//!     compute each distinct subgroup once
//! ```
//!
//! Source: mikktspace.c, `GenerateTSpaces`.

use crate::math::{V3, direction_in_plane, dot};
use crate::topology::triangles::Triangles;
use crate::util::hash_map::{InsertionMap, KeyTable};
use crate::util::radix_sort::sort;

use crate::tangents::mikktspace::antipodes::AntipodeGrid;
use crate::tangents::mikktspace::derivatives::Derivative;

/// In groups up to this size all pairs are compared, without the test of the mean direction.
const SMALL_GROUP: usize = 8;

/// The most distinct subgroups that are computed at once, and the most numbers in the lists of their excluded members: limits of the memory.
const MAX_SUBGROUPS: usize = if cfg!(small_limits) { 20 } else { 1 << 18 };
const MAX_WORDS: usize = if cfg!(small_limits) { 200 } else { 1 << 23 };

/// The members whose pairs are compared between two checks of the visitor.
const MEMBERS_PER_CHECK: usize = 64;

/// Receives the subgroups of one group.
pub(crate) trait SubgroupVisitor {
    /// What is computed once per subgroup.
    type Value;

    /// Computes one value for each subgroup of all members but those of each key of `excluded`: the starts and ends of ranges of indices into
    /// [`SubgroupFinder::members`], ascending and disjoint.
    fn compute(&mut self, excluded: &KeyTable) -> Vec<Self::Value>;

    /// Gives a member the value of its subgroup. `excluded`: the key of the subgroup.
    fn write(&mut self, member: u32, value: &Self::Value, excluded: &[u32]);

    /// True ends the visit early.
    fn is_stopped(&self) -> bool;

    /// Reports how many members have their subgroup.
    fn show_progress(&self, _found: usize) {}
}

/// Finds the subgroups of one group at a time. The buffers are reused from group to group.
#[derive(Debug, Default)]
pub(crate) struct SubgroupFinder {
    threshold_cosine: f32,
    /// The members, ascending. All arrays below have one entry per member.
    members: Vec<u32>,
    /// The directions of the tangents and of the bitangents in the tangent plane, as separate coordinates.
    s: [Vec<f32>; 3],
    t: [Vec<f32>; 3],
    joins_any: Vec<bool>,
    face: Vec<u32>,
    /// The lookup of opposite tangents and of opposite bitangents; only in large groups at 180 degrees.
    antipodes: Option<[AntipodeGrid; 2]>,
    /// With `antipodes`: the first member that has the same subgroup for certain.
    representative: Vec<u32>,
    /// Scratch memory of [`SubgroupFinder::find_excluded`].
    joins: Vec<bool>,
    candidates: Vec<u32>,
}

impl SubgroupFinder {
    pub fn new(threshold_cosine: f32) -> Self {
        Self { threshold_cosine, ..Self::default() }
    }

    /// Loads the members of a group, in any order. `normal`: the group's normal.
    pub fn load(&mut self, triangles: &Triangles, members: &[u32], derivatives: &[Derivative], normal: V3) {
        self.members.clear();
        self.members.extend_from_slice(members);
        sort(&mut self.members);
        self.s.iter_mut().chain(&mut self.t).for_each(Vec::clear);
        self.joins_any.clear();
        self.face.clear();
        self.antipodes = None;
        for &member in &self.members {
            let triangle = member as usize / 3;
            let derivative = &derivatives[triangle];
            let (s, t) = (direction_in_plane(normal, derivative.s), direction_in_plane(normal, derivative.t));
            for axis in 0..3 {
                self.s[axis].push(s[axis]);
                self.t[axis].push(t[axis]);
            }
            self.joins_any.push(derivative.joins_any);
            self.face.push(triangles.face[triangle]);
        }
    }

    /// The members of the loaded group, ascending.
    pub fn members(&self) -> &[u32] {
        &self.members
    }

    /// Calls `visitor` with the subgroup of every member. `members`: the loaded members in the order of the writes.
    pub fn visit<V: SubgroupVisitor>(&mut self, members: &[u32], visitor: &mut V) {
        let all_join = self.all_join(&*visitor);
        let mut rest = members;
        while !rest.is_empty() && !visitor.is_stopped() {
            let (excluded, subgroup_of_member) = if all_join {
                (KeyTable::of_empty_key(), vec![0; rest.len()])
            } else {
                self.find_subgroups(members, members.len() - rest.len(), &*visitor)
            };
            let values = visitor.compute(&excluded);
            for (&member, &number) in rest.iter().zip(&subgroup_of_member) {
                visitor.write(member, &values[number as usize], excluded.key(number as usize));
            }
            rest = &rest[subgroup_of_member.len()..];
        }
    }

    /// The distinct subgroups of the members from `first` on, as many as the limits of the memory allow: the excluded ranges of each, and the
    /// subgroup of each member.
    fn find_subgroups<V: SubgroupVisitor>(
        &mut self,
        members: &[u32],
        first: usize,
        visitor: &V,
    ) -> (KeyTable, Vec<u32>) {
        let mut distinct = KeyTable::with_capacity(members.len().min(MAX_SUBGROUPS));
        let mut of_member = Vec::new();
        let mut of_representative = vec![u32::MAX; self.members.len()];
        let mut excluded = Vec::new();
        for (found, &member) in members.iter().enumerate().skip(first) {
            visitor.show_progress(found);
            let is_full = distinct.len() >= MAX_SUBGROUPS || distinct.word_count() >= MAX_WORDS;
            if is_full || visitor.is_stopped() {
                break;
            }
            let at = self.representative(self.members.partition_point(|&other| other < member));
            if of_representative[at] == u32::MAX {
                self.find_excluded(at, &mut excluded);
                of_representative[at] = distinct.insert(&excluded) as u32;
            }
            of_member.push(of_representative[at]);
        }
        (distinct, of_member)
    }

    /// True when every member joins every other. False when `visitor` has stopped the visit before that is known.
    fn all_join<V: SubgroupVisitor>(&mut self, visitor: &V) -> bool {
        let count = self.members.len();
        let goes_on = |at: usize| !(at + 1).is_multiple_of(MEMBERS_PER_CHECK) || !visitor.is_stopped();
        if count <= SMALL_GROUP || self.threshold_cosine != -1.0 {
            return (count > SMALL_GROUP && self.is_near_mean())
                || (0..count).all(|a| goes_on(a) && (a + 1..count).all(|b| self.joins(a, b)));
        }
        if self.is_near_mean() {
            return true;
        }
        self.antipodes = Some([&self.s, &self.t].map(|axes| {
            let counted = (0..count as u32).filter(|&at| !self.joins_any[at as usize]);
            AntipodeGrid::new(counted, |at| direction(axes, at as usize))
        }));
        self.find_representatives();
        let mut excluded = Vec::new();
        (0..count).all(|at| {
            goes_on(at) && {
                self.representative(at) < at || {
                    self.find_excluded(at, &mut excluded);
                    excluded.is_empty()
                }
            }
        })
    }

    /// Fills `representative`: members with equal directions have equal subgroups. Two kinds of members are equal only to themselves: halves
    /// of a quad whose both halves are members, and members with NaN.
    fn find_representatives(&mut self) {
        let count = self.members.len();
        let mut first = InsertionMap::new();
        self.representative.clear();
        for at in 0..count {
            let has_other_half = (at > 0 && self.face[at - 1] == self.face[at])
                || (at + 1 < count && self.face[at + 1] == self.face[at]);
            let [s, t] = [&self.s, &self.t].map(|axes| direction(axes, at).map(f32::to_bits));
            let unique = if has_other_half || !self.are_near(at, at) { at as u32 } else { u32::MAX };
            let key = [s[0], s[1], s[2], t[0], t[1], t[2], self.joins_any[at].into(), unique];
            self.representative.push(*first.get_or_insert_with(&key, || at as u32));
        }
    }

    /// A member with the same subgroup as member `at`.
    fn representative(&self, at: usize) -> usize {
        if self.antipodes.is_some() { self.representative[at] as usize } else { at }
    }

    /// Writes the starts and ends of the ranges of members that member `at` does not join to `excluded`, ascending.
    fn find_excluded(&mut self, at: usize, excluded: &mut Vec<u32>) {
        excluded.clear();
        if self.joins_any[at] {
            return;
        }
        if self.find_candidates(at).is_some() {
            self.candidates.iter().for_each(|&other| push(excluded, other));
        } else {
            self.compare_with_all(at);
            let apart = (0..).zip(&self.joins).filter(|(_, joins)| !**joins);
            apart.for_each(|(other, _)| push(excluded, other));
        }
    }

    /// Writes the members that member `at` does not join to `candidates`, ascending. `None` where comparing with all is needed or faster.
    fn find_candidates(&mut self, at: usize) -> Option<()> {
        let [of_s, of_t] = self.antipodes.as_ref()?;
        let mut apart = std::mem::take(&mut self.candidates);
        apart.clear();
        let mut test = |other: u32| {
            if !self.joins(at, other as usize) {
                apart.push(other);
            }
        };
        // For more candidates than this, comparing with all is faster.
        let limit = self.members.len() / 8;
        let found = of_s.for_each_opposite(direction(&self.s, at), limit, &mut test);
        let found = found.and_then(|()| of_t.for_each_opposite(direction(&self.t, at), limit, &mut test));
        sort(&mut apart);
        apart.dedup();
        self.candidates = apart;
        found
    }

    /// Writes to `joins` which members join member `at`, which is not UV-degenerate.
    fn compare_with_all(&mut self, at: usize) {
        let count = self.members.len();
        let ([sx, sy, sz], [tx, ty, tz]) =
            (self.s.each_ref().map(|x| &x[..count]), self.t.each_ref().map(|x| &x[..count]));
        let (s, t) = ([sx[at], sy[at], sz[at]], [tx[at], ty[at], tz[at]]);
        self.joins.clear();
        // Arithmetic on arrays without branches, which vectorises.
        self.joins.extend((0..count).map(|other| {
            (dot(s, [sx[other], sy[other], sz[other]]) > self.threshold_cosine)
                & (dot(t, [tx[other], ty[other], tz[other]]) > self.threshold_cosine)
        }));
        for (joins, (&any, &face)) in self.joins.iter_mut().zip(self.joins_any.iter().zip(&self.face)) {
            *joins |= any | (face == self.face[at]);
        }
    }

    #[inline]
    fn joins(&self, a: usize, b: usize) -> bool {
        self.are_near(a, b) | (self.joins_any[a] | self.joins_any[b]) | (self.face[a] == self.face[b])
    }

    #[inline]
    fn are_near(&self, a: usize, b: usize) -> bool {
        let cosine = |axes| dot(direction(axes, a), direction(axes, b));
        cosine(&self.s) > self.threshold_cosine && cosine(&self.t) > self.threshold_cosine
    }

    /// True when every direction is within half the threshold of the mean direction, so that any two are within the threshold.
    ///
    /// The margin of 0.001 in the cosine of the half angle is at least 2e-6 in the cosine of the full angle (least at 180 degrees:
    /// 1 - cos 0.002), five times the rounding error of a dot product of unit vectors.
    fn is_near_mean(&self) -> bool {
        self.are_near_mean(&self.s) && self.are_near_mean(&self.t)
    }

    fn are_near_mean(&self, axes: &[Vec<f32>; 3]) -> bool {
        let sum: V3 = axes
            .each_ref()
            .map(|x| x.iter().zip(&self.joins_any).filter(|(_, any)| !**any).map(|(x, _)| x).sum());
        let length = dot(sum, sum).sqrt();
        let bound = length * (((1.0 + self.threshold_cosine) / 2.0).sqrt() + 0.001);
        // Directions whose squares underflowed are not unit vectors; the margin does not hold for them.
        let is_unit = |v: V3| (dot(v, v) - 1.0).abs() < 1e-6;
        (0..self.members.len()).all(|at| {
            let direction = direction(axes, at);
            self.joins_any[at] || (is_unit(direction) && dot(direction, sum) > bound)
        })
    }
}

/// The indices below `count` that are not in `excluded`, ascending. `excluded`: the starts and ends of ranges.
pub(crate) fn included(count: usize, excluded: &[u32]) -> impl Iterator<Item = usize> {
    let (gaps, _) = excluded.as_chunks();
    let starts = [0].into_iter().chain(gaps.iter().map(|[_, end]| *end as usize));
    let ends = gaps.iter().map(|[start, _]| *start as usize).chain([count]);
    starts.zip(ends).flat_map(|(start, end)| start..end)
}

#[inline]
fn direction(axes: &[Vec<f32>; 3], at: usize) -> V3 {
    axes.each_ref().map(|x| x[at])
}

/// Appends an index that is above all of `ranges`, which are starts and ends.
fn push(ranges: &mut Vec<u32>, next: u32) {
    match ranges.last_mut() {
        Some(end) if *end == next => *end += 1,
        _ => ranges.extend([next, next + 1]),
    }
}
