//! Sums over groups, weighted by corner angle and triangle area; and a step of the fit to what is seen.

use crate::Frame;
use crate::math::{V3, angle};
use crate::triangles::Triangles;

use super::derivatives::Derivative;
use super::groups::Groups;
use super::repair::{D3, cross, dot, length};
use super::shape::Shape;
use super::threads;

/// No group.
pub(super) const NONE: u32 = u32::MAX;

/// What is summed over a group.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct GroupSum {
    /// The directions of dP/du and dP/dv in the plane of the normal; of the second and the magnitudes only where they are wanted.
    pub s: D3,
    pub t: D3,
    pub magnitude: [f64; 2],
    pub weight: f64,
}

/// A group's frame, and whether it is a repair.
#[derive(Clone, Copy, Debug)]
pub(super) struct GroupFrame {
    pub frame: Frame,
    pub repaired: bool,
}

/// What runs keep from one to the next.
#[derive(Debug, Default)]
pub(super) struct GroupMemory {
    pub derivatives: Vec<Derivative>,
    /// Of each group: its unit normal, or zero; its sum; what is left to the fit, and its weight.
    pub normals: Vec<D3>,
    pub sums: Vec<GroupSum>,
    pub residuals: Vec<(D3, f64)>,
    /// Twice the area of each triangle; 0 of those that add nothing.
    pub areas: Vec<f64>,
    pub frames: Vec<GroupFrame>,
}

/// What is summed, and where to.
pub(super) struct GroupedTriangles<'a> {
    pub triangles: &'a Triangles,
    pub shape: &'a Shape<'a>,
    pub groups: &'a Groups,
    pub group_of_corner: &'a [u32],
}

impl GroupedTriangles<'_> {
    /// Sums over every group; `memory` has the derivatives and the groups' normals. With bitangents and magnitudes, if `is_whole`.
    pub fn add_up(&self, is_whole: bool, memory: &mut GroupMemory) {
        let GroupMemory { derivatives, normals, sums, areas, .. } = memory;
        let derivatives = &derivatives[..];
        areas.resize(derivatives.len(), 0.0);
        threads::fill(areas, |t| if derivatives[t].any { 0.0 } else { self.doubled_area(t) });
        sums.resize(normals.len(), GroupSum::default());
        threads::fill(sums, |group| self.sum(group, is_whole, normals[group], derivatives, areas));
    }

    fn doubled_area(&self, t: usize) -> f64 {
        let [a, b, c] = self.positions(t);
        length(cross(sub(b, a), sub(c, a)))
    }

    fn positions(&self, t: usize) -> [D3; 3] {
        self.shape.positions(self.triangles, t).map(|position| position.map(f64::from))
    }

    fn sum(
        &self,
        group: usize,
        is_whole: bool,
        normal: D3,
        derivatives: &[Derivative],
        areas: &[f64],
    ) -> GroupSum {
        let mut sum = GroupSum::default();
        for &member in self.groups.members(group) {
            let (t, k) = (member as usize / 3, member as usize % 3);
            let derivative = &derivatives[t];
            if derivative.any {
                continue;
            }
            let positions = self.positions(t);
            let [next, last] = [1, 2].map(|step| sub(positions[(k + step) % 3], positions[k]));
            let weight = angle_in_plane(next, last, normal) * areas[t];
            sum.s = add(sum.s, weight, direction_in_plane(derivative.s, normal));
            sum.weight += weight;
            if is_whole {
                sum.t = add(sum.t, weight, direction_in_plane(derivative.t, normal));
                let lengths = derivative.magnitude.map(f64::from);
                sum.magnitude = [0, 1].map(|i| sum.magnitude[i] + weight * lengths[i]);
            }
        }
        sum
    }

    /// For every group the residual of the least squares of what is seen, and its weight: the integral over the surface of the squared
    /// distance between the interpolated tangent T and the direction s of dP/du.
    ///
    /// With linear weights w_i over a triangle of area A, integral w_i w_j = A/12, or A/6 for i = j, and integral w_i = A/3; so the
    /// residual of corner i is A/3 s - A/12 (t_i + t_0 + t_1 + t_2), and its step (Jacobi's) is that over the sum of A/6.
    pub fn fit(&self, frames: &[GroupFrame], memory: &mut GroupMemory) {
        let GroupMemory { derivatives, normals, areas, residuals, .. } = memory;
        residuals.clear();
        residuals.resize(normals.len(), ([0.0; 3], 0.0));
        for (t, (derivative, doubled)) in derivatives.iter().zip(areas).enumerate() {
            let groups = self.triangles.corners[t].map(|corner| self.group_of_corner[corner as usize]);
            if derivative.any || groups.contains(&NONE) {
                continue;
            }
            let area = 0.5 * *doubled;
            let tangents = groups.map(|group| frames[group as usize].frame.tangent.map(f64::from));
            let sum = tangents.into_iter().fold([0.0; 3], |sum, tangent| add(sum, 1.0, tangent));
            let target = add(sum, -4.0, derivative.s.map(f64::from));
            for (group, tangent) in groups.into_iter().zip(tangents) {
                let (residual, weight) = &mut residuals[group as usize];
                *residual = add(*residual, -area / 12.0, add(target, 1.0, tangent));
                *weight += area / 6.0;
            }
        }
    }
}

/// The angle between the parts of `a` and `b` perpendicular to the normal, which is a unit vector or zero; 0 where one has none but
/// rounding.
fn angle_in_plane(a: D3, b: D3, normal: D3) -> f64 {
    let (along_a, along_b) = (dot(a, normal), dot(b, normal));
    let (square_a, square_b) = (dot(a, a), dot(b, b));
    let (flat_a, flat_b) = (square_a - along_a * along_a, square_b - along_b * along_b);
    if flat_a > ROUNDING * square_a && flat_b > ROUNDING * square_b {
        let cosine = (dot(a, b) - along_a * along_b) / (flat_a * flat_b).sqrt();
        f64::from(angle(cosine as f32))
    } else {
        0.0
    }
}

/// The direction of the part of `v` perpendicular to the normal, which is a unit vector or zero; zero where there is none but rounding.
fn direction_in_plane(v: V3, normal: D3) -> D3 {
    let v = v.map(f64::from);
    let rest = add(v, -dot(v, normal), normal);
    let square = dot(rest, rest);
    let inverse = if square > ROUNDING * dot(v, v) { 1.0 / square.sqrt() } else { 0.0 };
    rest.map(|x| inverse * x)
}

/// The part of a squared length below which a difference is rounding: a millionth of the length.
const ROUNDING: f64 = 1e-12;

fn sub(a: D3, b: D3) -> D3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// sum + weight * v.
pub(super) fn add(sum: D3, weight: f64, v: D3) -> D3 {
    [sum[0] + weight * v[0], sum[1] + weight * v[1], sum[2] + weight * v[2]]
}
