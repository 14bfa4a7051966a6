//! Subgroups: which members of a group share a tangent under the angular threshold.
//!
//! A *member* is corner `k` of triangle `t`, as `3 t + k`. Two members join when
//! - one of the triangles is UV-degenerate, or
//! - the triangles are halves of one quad, or
//! - the angle between their tangents and the angle between their bitangents, both in the tangent plane of
//!   the vertex, are below the threshold.
//!
//! The subgroup of a member is the set of all members that it joins. [`SubgroupFinder`] stores its
//! complement, the *excluded* members, which are few in most groups:
//!
//! ```text
//! if every direction is within half the threshold of the mean direction: nothing is excluded
//! for each member, in the order in which the reference writes them:
//!     excluded = members that it does not join
//!         threshold 180 degrees: only exactly opposite directions are excluded; AntipodeGrid lists them
//!         smaller thresholds: compare with all members
//!     compute each distinct subgroup once
//! ```
//!
//! The excluded members of different members are found on several threads.
//!
//! Source: mikktspace.c, `GenerateTSpaces`.

use std::ops::Range;

use crate::exec::limits::RunLimits;
use crate::exec::threads;
use crate::math::{V3, direction_in_plane, dot};
use crate::topology::triangles::Triangles;
use crate::util::hash_map::{InsertionMap, KeyTable};
use crate::util::radix_sort::sort;

use crate::tangents::mikktspace::antipodes::AntipodeGrid;
use crate::tangents::mikktspace::derivatives::Derivative;

/// In groups up to this size all pairs are compared, without the test of the mean direction.
const SMALL_GROUP: usize = 8;

/// The most distinct subgroups that are computed at once, and the most numbers in the lists of their excluded
/// members: limits of the memory.
const MAX_SUBGROUPS: usize = if cfg!(small_limits) { 20 } else { 1 << 18 };
const MAX_WORDS: usize = if cfg!(small_limits) { 200 } else { 1 << 23 };

/// The members whose excluded members are found between two barriers of the threads, and the most numbers in
/// their lists.
const PART: usize = if cfg!(small_limits) { 7 } else { 1 << 12 };
const MAX_PART_WORDS: usize = MAX_WORDS / 8;

/// The members whose pairs are compared between two checks of the visitor.
const MEMBERS_PER_CHECK: usize = 64;

/// Receives the subgroups of one group.
pub(crate) trait SubgroupVisitor {
    /// What is computed once per subgroup.
    type Value;

    /// Computes one value for each subgroup of all members but those of each key of `excluded`: the starts
    /// and ends of ranges of indices into [`SubgroupFinder::members`], ascending and disjoint.
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
pub(crate) struct SubgroupFinder<'a> {
    threshold_cosine: f32,
    limits: RunLimits<'a>,
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
    /// One per thread.
    searches: Vec<Search>,
}

/// The excluded members of some members, found by one thread.
#[derive(Debug, Default)]
struct Search {
    /// The lists of ranges, concatenated, and the end of each.
    words: Vec<u32>,
    ends: Vec<usize>,
    scratch: Scratch,
}

/// Scratch memory of [`SubgroupFinder::find_excluded`].
#[derive(Debug, Default)]
struct Scratch {
    joins: Vec<bool>,
    opposites: Vec<u32>,
    excluded: Vec<u32>,
}

/// In [`SubgroupFinder::subgroups_of`]: no subgroup has been assigned.
const UNKNOWN: u32 = u32::MAX;
/// As [`UNKNOWN`], while the member is among those that are searched next.
const PENDING: u32 = u32::MAX - 1;

impl<'a> SubgroupFinder<'a> {
    pub fn new(threshold_cosine: f32, limits: RunLimits<'a>) -> Self {
        Self { threshold_cosine, limits, ..Self::default() }
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

    /// Calls `visitor` with the subgroup of every member. `members`: the loaded members in the order of the
    /// writes.
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

    /// The distinct subgroups of the members from `first` on, as many as the limits of the memory allow: the
    /// excluded ranges of each, and the subgroup of each member.
    fn find_subgroups<V: SubgroupVisitor>(
        &mut self,
        members: &[u32],
        first: usize,
        visitor: &V,
    ) -> (KeyTable, Vec<u32>) {
        let mut distinct = KeyTable::with_capacity(members.len().min(MAX_SUBGROUPS));
        let mut of_member = Vec::new();
        let mut of_representative = vec![UNKNOWN; self.members.len()];
        let mut part_size = PART;
        while first + of_member.len() < members.len() {
            let rest = &members[first + of_member.len()..];
            let part = &rest[..part_size.min(rest.len())];
            let found = self.subgroups_of(part, &mut distinct, &mut of_representative);
            // Where lists are long, a part has about as many as their limit allows.
            part_size = (2 * found.len()).clamp(1, PART);
            of_member.extend(found);
            visitor.show_progress(first + of_member.len());
            let is_full = distinct.len() >= MAX_SUBGROUPS || distinct.word_count() >= MAX_WORDS;
            if is_full || visitor.is_stopped() || self.limits.is_cancelled() {
                break;
            }
        }
        (distinct, of_member)
    }

    /// The subgroups of the first of some members: all, unless their lists become too long. Without
    /// cancellation there is at least one.
    fn subgroups_of(
        &mut self,
        members: &[u32],
        distinct: &mut KeyTable,
        of_representative: &mut [u32],
    ) -> Vec<u32> {
        let representative =
            |member| self.representative(self.members.partition_point(|&other| other < member));
        let representatives: Vec<usize> = members.iter().map(|&member| representative(member)).collect();
        let mut wanted = Vec::new();
        for &at in &representatives {
            if of_representative[at] == UNKNOWN {
                of_representative[at] = PENDING;
                wanted.push(at);
            }
        }
        self.search(&wanted);
        wanted.iter().for_each(|&at| of_representative[at] = UNKNOWN);
        let lists = self.searches.iter().flat_map(Search::lists);
        for (&at, excluded) in wanted.iter().zip(lists) {
            of_representative[at] = distinct.insert(excluded) as u32;
        }
        let numbers = representatives.iter().map(|&at| of_representative[at]);
        numbers.take_while(|&number| number != UNKNOWN).collect()
    }

    /// Finds the excluded members of some members, on several threads. After cancellation, and where the
    /// lists become too long, there are lists for the first ones only.
    fn search(&mut self, wanted: &[usize]) {
        let mut searches = std::mem::take(&mut self.searches);
        let threads = self.limits.thread_count(self.members.len());
        searches.resize_with(threads, Search::default);
        let parts = threads::split_range(0..wanted.len(), threads, 1);
        let max_words = MAX_PART_WORDS / threads;
        threads::run(&mut searches, parts.clone(), |search, range: Range<usize>| {
            search.words.clear();
            search.ends.clear();
            for &at in &wanted[range] {
                if search.words.len() > max_words || self.limits.is_cancelled() {
                    break;
                }
                self.find_excluded(at, &mut search.scratch);
                search.words.extend_from_slice(&search.scratch.excluded);
                search.ends.push(search.words.len());
            }
        });
        // Lists behind a thread that has not finished do not follow its lists.
        let is_whole = |(search, part): &(&Search, Range<usize>)| search.ends.len() == part.len();
        let whole = searches.iter().zip(parts).take_while(is_whole).count();
        searches.truncate(whole + 1);
        self.searches = searches;
    }

    /// True when every member joins every other. False when `visitor` has stopped the visit before that is
    /// known.
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
        let mut scratch = Scratch::default();
        (0..count).all(|at| {
            goes_on(at) && {
                self.representative(at) < at || {
                    self.find_excluded(at, &mut scratch);
                    scratch.excluded.is_empty()
                }
            }
        })
    }

    /// Fills `representative`: members with equal directions have equal subgroups. Two kinds of members are
    /// equal only to themselves: halves of a quad whose both halves are members, and members with NaN.
    fn find_representatives(&mut self) {
        let count = self.members.len();
        let mut first = InsertionMap::with_capacity(count);
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

    /// Writes the starts and ends of the ranges of members that member `at` does not join to
    /// `scratch.excluded`, ascending.
    fn find_excluded(&self, at: usize, scratch: &mut Scratch) {
        let Scratch { joins, opposites, excluded } = scratch;
        excluded.clear();
        if self.joins_any[at] {
            return;
        }
        if self.find_opposites(at, opposites).is_some() {
            let apart = opposites.iter().filter(|&&other| self.face[at] != self.face[other as usize]);
            apart.for_each(|&other| push(excluded, other));
        } else {
            self.compare_with_all(at, joins);
            let apart = (0..).zip(&*joins).filter(|(_, joins)| !**joins);
            apart.for_each(|(other, _)| push(excluded, other));
        }
    }

    /// Writes the members whose tangent or bitangent is opposite to that of member `at` to `opposites`,
    /// ascending. `None` where comparing with all is needed or faster.
    fn find_opposites(&self, at: usize, opposites: &mut Vec<u32>) -> Option<()> {
        let [of_s, of_t] = self.antipodes.as_ref()?;
        // For more candidates than this, comparing with all is faster.
        let limit = self.members.len() / 8;
        let width = self.limits.width;
        opposites.clear();
        of_s.find_opposites(direction(&self.s, at), limit, width, opposites)?;
        of_t.find_opposites(direction(&self.t, at), limit, width, opposites)?;
        sort(opposites);
        opposites.dedup();
        Some(())
    }

    /// Writes to `joins` which members join member `at`, which is not UV-degenerate.
    fn compare_with_all(&self, at: usize, joins: &mut Vec<bool>) {
        let count = self.members.len();
        let ([sx, sy, sz], [tx, ty, tz]) =
            (self.s.each_ref().map(|x| &x[..count]), self.t.each_ref().map(|x| &x[..count]));
        let (s, t) = ([sx[at], sy[at], sz[at]], [tx[at], ty[at], tz[at]]);
        joins.clear();
        // Arithmetic on arrays without branches, which vectorises.
        joins.extend((0..count).map(|other| {
            (dot(s, [sx[other], sy[other], sz[other]]) > self.threshold_cosine)
                & (dot(t, [tx[other], ty[other], tz[other]]) > self.threshold_cosine)
        }));
        for (joins, (&any, &face)) in joins.iter_mut().zip(self.joins_any.iter().zip(&self.face)) {
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

    /// True when every direction is within half the threshold of the mean direction, so that any two are
    /// within the threshold.
    ///
    /// The margin of 0.001 in the cosine of the half angle is at least 2e-6 in the cosine of the full angle
    /// (least at 180 degrees: 1 - cos 0.002), five times the rounding error of a dot product of unit
    /// vectors.
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

impl Search {
    fn lists(&self) -> impl Iterator<Item = &[u32]> {
        let starts = [0].into_iter().chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, &end)| &self.words[start..end])
    }
}

/// The indices below `count` that are not in `excluded`, ascending. `excluded`: the starts and ends of
/// ranges.
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
