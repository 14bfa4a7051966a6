//! Subgroups: which members of a group share a tangent under the angular threshold.
//!
//! Two members join when either is UV-degenerate, both are halves of one quad, or their tangents and their bitangents, in the
//! plane of the vertex, are both nearer than the threshold. A member's subgroup is all that it joins.
//!
//! Source: mikktspace.c, `GenerateTSpaces`.

use crate::math::{V3, direction_in_plane, dot};
use crate::triangles::Triangles;

use super::derivatives::Derivative;

/// Groups up to this size are compared pairwise without looking at their mean first.
const SMALL_GROUP: usize = 8;

/// The directions of one group's members; reused from group to group.
#[derive(Debug, Default)]
pub(crate) struct Subgroups {
    threshold_cosine: f32,
    s: [Vec<f32>; 3],
    t: [Vec<f32>; 3],
    any: Vec<bool>,
    face: Vec<u32>,
}

impl Subgroups {
    pub fn new(threshold_cosine: f32) -> Self {
        Self { threshold_cosine, ..Self::default() }
    }

    /// Takes the members of a group: corners `k` of triangles `t` as `3 t + k`.
    pub fn set(&mut self, triangles: &Triangles, members: &[u32], derivatives: &[Derivative], normal: V3) {
        self.s.iter_mut().chain(&mut self.t).for_each(Vec::clear);
        self.any.clear();
        self.face.clear();
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
    pub fn all_joined(&self) -> bool {
        let count = self.any.len();
        (count > SMALL_GROUP && self.is_near_mean(&self.s) && self.is_near_mean(&self.t))
            || (0..count).all(|a| (a + 1..count).all(|b| self.joins(a, b)))
    }

    /// Writes to `row` which members join member `at`.
    pub fn row(&self, at: usize, row: &mut Vec<bool>) {
        let count = self.any.len();
        let ([sx, sy, sz], [tx, ty, tz]) =
            (self.s.each_ref().map(|x| &x[..count]), self.t.each_ref().map(|x| &x[..count]));
        let (s, t) = ([sx[at], sy[at], sz[at]], [tx[at], ty[at], tz[at]]);
        row.clear();
        // Plain arithmetic over arrays, so that it runs several members at a time.
        row.extend((0..count).map(|other| {
            (dot(s, [sx[other], sy[other], sz[other]]) > self.threshold_cosine)
                & (dot(t, [tx[other], ty[other], tz[other]]) > self.threshold_cosine)
        }));
        for (joins, (&any, &face)) in row.iter_mut().zip(self.any.iter().zip(&self.face)) {
            *joins |= any | self.any[at] | (face == self.face[at]);
        }
    }

    #[inline]
    fn joins(&self, a: usize, b: usize) -> bool {
        let cosine = |axes: &[Vec<f32>; 3]| dot(axes.each_ref().map(|x| x[a]), axes.each_ref().map(|x| x[b]));
        let near = cosine(&self.s) > self.threshold_cosine && cosine(&self.t) > self.threshold_cosine;
        near | (self.any[a] | self.any[b]) | (self.face[a] == self.face[b])
    }

    /// True when every direction is within half the threshold of their mean, so that any two are within the threshold.
    ///
    /// The margin of 0.001 in the cosine of the half angle is at least 2e-6 in the cosine of the whole one (least at 180
    /// degrees: 1 - cos 0.002), five times the rounding errors of a dot product of unit vectors.
    fn is_near_mean(&self, axes: &[Vec<f32>; 3]) -> bool {
        let sum: V3 =
            axes.each_ref().map(|x| x.iter().zip(&self.any).filter(|(_, any)| !**any).map(|(x, _)| x).sum());
        let length = dot(sum, sum).sqrt();
        let bound = length * (((1.0 + self.threshold_cosine) / 2.0).sqrt() + 0.001);
        // Directions whose squares underflowed are not of unit length; for them the margin says nothing.
        let is_unit = |v: V3| (dot(v, v) - 1.0).abs() < 1e-6;
        let direction = |at: usize| axes.each_ref().map(|x| x[at]);
        (0..self.any.len())
            .all(|at| self.any[at] || (is_unit(direction(at)) && dot(direction(at), sum) > bound))
    }
}
