//! SubgroupFinder: which members of a group share a tangent under the angular threshold.
//!
//! Two members join when either is UV-degenerate, both are halves of one quad, or their tangents and their bitangents, in the
//! plane of the vertex, are both nearer than the threshold. A member's subgroup is all that it joins. At 180 degrees directions have
//! to be exactly opposite not to join, and only candidates for that are compared; below, all pairs are.
//!
//! Source: mikktspace.c, `GenerateTSpaces`.

use std::ops::Range;

use crate::math::{V3, direction_in_plane, dot};
use crate::topology::triangles::Triangles;
use crate::util::hash_map::InsertionMap;
use crate::util::radix_sort::sort;

use crate::tangents::mikktspace::antipodes::AntipodeGrid;
use crate::tangents::mikktspace::derivatives::Derivative;

/// Groups up to this size are compared pairwise without looking at their mean first.
const SMALL_GROUP: usize = 8;

/// The directions of one group's members; reused from group to group.
#[derive(Debug, Default)]
pub(crate) struct SubgroupFinder {
    threshold_cosine: f32,
    s: [Vec<f32>; 3],
    t: [Vec<f32>; 3],
    any: Vec<bool>,
    face: Vec<u32>,
    /// At 180 degrees, in a large group: of the tangents and of the bitangents.
    opposites: Option<[AntipodeGrid; 2]>,
    /// With `opposites`: the first member of which all members joined are the same.
    first_alike: Vec<u32>,
    row: Vec<bool>,
    apart: Vec<u32>,
}

impl SubgroupFinder {
    pub fn new(threshold_cosine: f32) -> Self {
        Self { threshold_cosine, ..Self::default() }
    }

    /// Takes the members of a group: corners `k` of triangles `t` as `3 t + k`.
    pub fn set(&mut self, triangles: &Triangles, members: &[u32], derivatives: &[Derivative], normal: V3) {
        self.s.iter_mut().chain(&mut self.t).for_each(Vec::clear);
        self.any.clear();
        self.face.clear();
        self.opposites = None;
        for &member in members {
            let triangle = member as usize / 3;
            let derivative = &derivatives[triangle];
            let (s, t) = (direction_in_plane(normal, derivative.s), direction_in_plane(normal, derivative.t));
            for axis in 0..3 {
                self.s[axis].push(s[axis]);
                self.t[axis].push(t[axis]);
            }
            self.any.push(derivative.any);
            self.face.push(triangles.face[triangle]);
        }
    }

    /// True when every member joins every other.
    pub fn all_joined(&mut self) -> bool {
        let count = self.any.len();
        if count <= SMALL_GROUP || self.threshold_cosine != -1.0 {
            return (count > SMALL_GROUP && self.is_near_mean())
                || (0..count).all(|a| (a + 1..count).all(|b| self.joins(a, b)));
        }
        if self.is_near_mean() {
            return true;
        }
        self.opposites = Some([&self.s, &self.t].map(|axes| {
            let of_all = (0..count).filter(|&at| !self.any[at]).map(|at| (at as u32, direction(axes, at)));
            AntipodeGrid::new(of_all)
        }));
        self.find_alike();
        let mut left_out = Vec::new();
        (0..count).all(|at| {
            self.first_alike(at) < at || {
                self.find_left_out(at, &mut left_out);
                left_out.is_empty()
            }
        })
    }

    /// Groups members of equal directions. Alone is a half of a quad whose other half is a member too, and who is NaN.
    fn find_alike(&mut self) {
        let count = self.any.len();
        let mut first = InsertionMap::new();
        self.first_alike.clear();
        for at in 0..count {
            let other_half = (at > 0 && self.face[at - 1] == self.face[at])
                || (at + 1 < count && self.face[at + 1] == self.face[at]);
            let [s, t] = [&self.s, &self.t].map(|axes| direction(axes, at).map(f32::to_bits));
            let alone = if other_half || !self.are_near(at, at) { at as u32 } else { u32::MAX };
            let key = [s[0], s[1], s[2], t[0], t[1], t[2], self.any[at].into(), alone];
            self.first_alike.push(*first.first(&key, || at as u32));
        }
    }

    /// A member that the same members join as member `at`.
    pub fn first_alike(&self, at: usize) -> usize {
        if self.opposites.is_some() { self.first_alike[at] as usize } else { at }
    }

    /// Writes to `left_out` the members that do not join member `at`, in order.
    pub fn find_left_out(&mut self, at: usize, left_out: &mut Vec<Range<usize>>) {
        left_out.clear();
        if self.any[at] {
            return;
        }
        if self.find_apart(at).is_some() {
            self.apart.iter().for_each(|&other| push(left_out, other as usize));
        } else {
            self.compare_with_all(at);
            let apart = self.row.iter().enumerate().filter(|(_, joins)| !**joins);
            apart.for_each(|(other, _)| push(left_out, other));
        }
    }

    /// Finds in `apart`, sorted, the members that do not join member `at`; none where all have to be compared.
    fn find_apart(&mut self, at: usize) -> Option<()> {
        let [of_s, of_t] = self.opposites.as_ref()?;
        let mut apart = std::mem::take(&mut self.apart);
        apart.clear();
        let mut test = |other: u32| {
            if !self.joins(at, other as usize) {
                apart.push(other);
            }
        };
        // Of many candidates, comparing with all is quicker.
        let limit = self.any.len() / 8;
        let found = of_s.near(direction(&self.s, at), limit, &mut test);
        let found = found.and_then(|()| of_t.near(direction(&self.t, at), limit, &mut test));
        sort(&mut apart);
        apart.dedup();
        self.apart = apart;
        found
    }

    /// Writes to `row` which members join member `at`, which is not UV-degenerate.
    fn compare_with_all(&mut self, at: usize) {
        let count = self.any.len();
        let ([sx, sy, sz], [tx, ty, tz]) =
            (self.s.each_ref().map(|x| &x[..count]), self.t.each_ref().map(|x| &x[..count]));
        let (s, t) = ([sx[at], sy[at], sz[at]], [tx[at], ty[at], tz[at]]);
        self.row.clear();
        // Plain arithmetic over arrays, so that it runs several members at a time.
        self.row.extend((0..count).map(|other| {
            (dot(s, [sx[other], sy[other], sz[other]]) > self.threshold_cosine)
                & (dot(t, [tx[other], ty[other], tz[other]]) > self.threshold_cosine)
        }));
        for (joins, (&any, &face)) in self.row.iter_mut().zip(self.any.iter().zip(&self.face)) {
            *joins |= any | (face == self.face[at]);
        }
    }

    #[inline]
    fn joins(&self, a: usize, b: usize) -> bool {
        self.are_near(a, b) | (self.any[a] | self.any[b]) | (self.face[a] == self.face[b])
    }

    #[inline]
    fn are_near(&self, a: usize, b: usize) -> bool {
        let cosine = |axes| dot(direction(axes, a), direction(axes, b));
        cosine(&self.s) > self.threshold_cosine && cosine(&self.t) > self.threshold_cosine
    }

    /// True when every direction is within half the threshold of their mean, so that any two are within the threshold.
    ///
    /// The margin of 0.001 in the cosine of the half angle is at least 2e-6 in the cosine of the whole one (least at 180
    /// degrees: 1 - cos 0.002), five times the rounding errors of a dot product of unit vectors.
    fn is_near_mean(&self) -> bool {
        self.are_near_mean(&self.s) && self.are_near_mean(&self.t)
    }

    fn are_near_mean(&self, axes: &[Vec<f32>; 3]) -> bool {
        let sum: V3 =
            axes.each_ref().map(|x| x.iter().zip(&self.any).filter(|(_, any)| !**any).map(|(x, _)| x).sum());
        let length = dot(sum, sum).sqrt();
        let bound = length * (((1.0 + self.threshold_cosine) / 2.0).sqrt() + 0.001);
        // Directions whose squares underflowed are not of unit length; for them the margin says nothing.
        let is_unit = |v: V3| (dot(v, v) - 1.0).abs() < 1e-6;
        (0..self.any.len()).all(|at| {
            let direction = direction(axes, at);
            self.any[at] || (is_unit(direction) && dot(direction, sum) > bound)
        })
    }
}

#[inline]
fn direction(axes: &[Vec<f32>; 3], at: usize) -> V3 {
    axes.each_ref().map(|x| x[at])
}

/// Adds `next`, which is past all of `ranges`.
fn push(ranges: &mut Vec<Range<usize>>, next: usize) {
    match ranges.last_mut() {
        Some(last) if last.end == next => last.end += 1,
        _ => ranges.push(next..next + 1),
    }
}
