//! Sums over groups, weighted by corner angle and triangle area; and a step of the fit to what is seen.

use crate::Frame;
use crate::math::{V3, angle};
use crate::topology::triangles::{NONE, Triangles};

use crate::exec::limits::RunLimits;
use crate::exec::threads;
use crate::tangents::mikktspace::derivatives::Derivative;
use crate::tangents::mikktspace::groups::Groups;
use crate::tangents::mikktspace::welded_mesh::WeldedMesh;
use crate::tangents::repair::{D3, cross, dot, length};

/// What is summed over a group.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct GroupSum {
    /// The directions of dP/du and dP/dv in the plane of the normal; of the second and the magnitudes only where they are wanted.
    pub s: D3,
    pub t: D3,
    pub magnitude: [f64; 2],
    pub weight: f64,
}

/// A group's frame, and whether it is a repair.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GroupFrame {
    pub frame: Frame,
    pub repaired: bool,
}

/// What runs keep from one to the next: 140 bytes per triangle (for whole frames 212) and 170 per group.
#[derive(Debug, Default)]
pub(crate) struct GroupBuffers {
    pub derivatives: Vec<Derivative>,
    /// Of each group: its unit normal, or zero; its sum; what is left to the fit, and its weight.
    pub normals: Vec<D3>,
    pub sums: Vec<GroupSum>,
    pub residuals: Vec<(D3, f64)>,
    /// Twice the area of each triangle; 0 of those that add nothing.
    pub areas: Vec<f64>,
    /// What each triangle adds at its corners.
    terms: Vec<[[f64; 4]; 3]>,
    t_terms: Vec<[D3; 3]>,
    pub frames: Vec<GroupFrame>,
}

/// What is summed, and where to.
pub(crate) struct GroupedTriangles<'a> {
    pub triangles: &'a Triangles,
    pub welded: &'a WeldedMesh<'a>,
    pub groups: &'a Groups,
    pub group_of_corner: &'a [u32],
}

impl GroupedTriangles<'_> {
    /// Sums over every group; `memory` has the derivatives and the groups' normals. With bitangents and magnitudes, if `is_whole`.
    ///
    /// First what every triangle adds at its corners, then what groups gather: both by all threads, in the same order on any number.
    pub fn add_up(&self, is_whole: bool, limits: RunLimits<'_>, memory: &mut GroupBuffers) {
        let GroupBuffers { derivatives, normals, sums, areas, terms, t_terms, .. } = memory;
        let (derivatives, normals) = (&derivatives[..], &normals[..]);
        areas.resize(derivatives.len(), 0.0);
        threads::fill(limits, areas, |t| if derivatives[t].joins_any { 0.0 } else { self.doubled_area(t) });
        terms.resize(derivatives.len(), [[0.0; 4]; 3]);
        threads::fill(limits, terms, |t| self.terms(t, &derivatives[t], normals, areas[t]));
        t_terms.resize(if is_whole { derivatives.len() } else { 0 }, [[0.0; 3]; 3]);
        threads::fill(limits, t_terms, |t| {
            self.corner_normals(t, normals).map(|n| direction_in_plane(derivatives[t].t, n))
        });
        sums.resize(normals.len(), GroupSum::default());
        threads::fill(limits, sums, |group| self.gathered(group, derivatives, terms, t_terms));
    }

    fn doubled_area(&self, t: usize) -> f64 {
        let [a, b, c] = self.positions(t);
        length(cross(sub(b, a), sub(c, a)))
    }

    fn positions(&self, t: usize) -> [D3; 3] {
        self.welded.positions(self.triangles, t).map(|position| position.map(f64::from))
    }

    /// The normal of the group at each corner; zero where there is none.
    fn corner_normals(&self, t: usize, normals: &[D3]) -> [D3; 3] {
        let groups = self.triangles.corners[t].map(|corner| self.group_of_corner[corner as usize]);
        groups.map(|group| normals.get(group as usize).copied().unwrap_or_default())
    }

    /// What a triangle adds at each corner: the weight times the direction of dP/du, and the weight.
    #[inline(always)]
    fn terms(&self, t: usize, derivative: &Derivative, normals: &[D3], area: f64) -> [[f64; 4]; 3] {
        if derivative.joins_any {
            return [[0.0; 4]; 3];
        }
        let [a, b, c] = self.positions(t);
        let (ab, bc, ca) = (sub(b, a), sub(c, b), sub(a, c));
        let [of_a, of_b, of_c] = self.corner_normals(t, normals);
        // Written out, as `map` becomes calls.
        [
            term(derivative.s, [ab, ca], of_a, area),
            term(derivative.s, [bc, ab], of_b, area),
            term(derivative.s, [ca, bc], of_c, area),
        ]
    }

    fn gathered(
        &self,
        group: usize,
        derivatives: &[Derivative],
        terms: &[[[f64; 4]; 3]],
        t_terms: &[[D3; 3]],
    ) -> GroupSum {
        let mut sum = GroupSum::default();
        for &member in self.groups.members(group) {
            let (t, k) = (member as usize / 3, member as usize % 3);
            let [x, y, z, weight] = terms[t][k];
            sum.s = add(sum.s, 1.0, [x, y, z]);
            sum.weight += weight;
            if let Some(t_term) = t_terms.get(t).filter(|_| !derivatives[t].joins_any) {
                sum.t = add(sum.t, weight, t_term[k]);
                let lengths = derivatives[t].magnitude.map(f64::from);
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
    pub fn fit(&self, frames: &[GroupFrame], memory: &mut GroupBuffers) {
        let GroupBuffers { derivatives, normals, areas, residuals, .. } = memory;
        residuals.clear();
        residuals.resize(normals.len(), ([0.0; 3], 0.0));
        for (t, (derivative, doubled)) in derivatives.iter().zip(areas).enumerate() {
            let groups = self.triangles.corners[t].map(|corner| self.group_of_corner[corner as usize]);
            if derivative.joins_any || groups.contains(&NONE) {
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

/// What a triangle adds at the corner between `edges`, of which one leaves it and the other comes to it.
#[inline(always)]
fn term(s: V3, edges: [D3; 2], normal: D3, area: f64) -> [f64; 4] {
    let [leaving, [x, y, z]] = edges;
    let weight = angle_in_plane(leaving, [-x, -y, -z], normal) * area;
    let [x, y, z] = direction_in_plane(s, normal);
    [weight * x, weight * y, weight * z, weight]
}

/// The angle between the parts of `a` and `b` perpendicular to the normal, which is a unit vector or zero; 0 where one has none but
/// rounding.
#[inline(always)]
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
#[inline(always)]
fn direction_in_plane(v: V3, normal: D3) -> D3 {
    let v = [f64::from(v[0]), f64::from(v[1]), f64::from(v[2])];
    let rest = add(v, -dot(v, normal), normal);
    let square = dot(rest, rest);
    let inverse = if square > ROUNDING * dot(v, v) { 1.0 / square.sqrt() } else { 0.0 };
    [inverse * rest[0], inverse * rest[1], inverse * rest[2]]
}

/// The part of a squared length below which a difference is rounding: a millionth of the length.
const ROUNDING: f64 = 1e-12;

#[inline(always)]
fn sub(a: D3, b: D3) -> D3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// sum + weight * v.
#[inline(always)]
pub(crate) fn add(sum: D3, weight: f64, v: D3) -> D3 {
    [sum[0] + weight * v[0], sum[1] + weight * v[1], sum[2] + weight * v[2]]
}
