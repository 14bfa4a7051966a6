//! The sums of the methods angle-area and angle-edge: per group, weighted by corner angle and by the
//! triangle's area or the corner's edges; and the residuals of the least-squares fit.

use crate::Frame;
use crate::math::{V3, angle};
use crate::topology::triangles::{NONE, Triangles};

use crate::exec::limits::RunLimits;
use crate::exec::threads;
use crate::math_f64::{D3, add_scaled, cross, dot, length, sub};
use crate::tangents::mikktspace::derivatives::Derivative;
use crate::tangents::mikktspace::groups::Groups;
use crate::tangents::mikktspace::welded_mesh::WeldedMesh;

/// What a triangle's tangent is weighted by at a corner, beside the corner angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum GroupWeight {
    /// The area of the triangle.
    Area,
    /// The product of the lengths of the corner's two edges in the tangent plane.
    Edges,
}

/// The sums of one group.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct GroupSum {
    /// The weighted directions of dP/du in the tangent plane.
    pub s: D3,
    /// The weighted directions of dP/dv in the tangent plane; computed for full frames only, as are the
    /// magnitudes.
    pub t: D3,
    pub magnitude: [f64; 2],
    pub weight: f64,
}

/// The frame of a group, and whether it is a repair.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GroupFrame {
    pub frame: Frame,
    pub repaired: bool,
}

/// Buffers, reused from run to run: 44 bytes per triangle and 170 per group.
#[derive(Debug, Default)]
pub(crate) struct GroupBuffers {
    pub derivatives: Vec<Derivative>,
    /// The unit normal of each group, or zero.
    pub normals: Vec<D3>,
    pub sums: Vec<GroupSum>,
    /// The residual of each group's tangent in the fit, and the weight of the residual.
    pub residuals: Vec<(D3, f64)>,
    /// Twice the area of each triangle; 0 for skipped triangles.
    pub areas: Vec<f64>,
    pub frames: Vec<GroupFrame>,
}

/// The triangles and the groups of a mesh.
pub(crate) struct GroupedTriangles<'a> {
    pub triangles: &'a Triangles,
    pub welded: &'a WeldedMesh<'a>,
    pub groups: &'a Groups,
    pub group_of_corner: &'a [u32],
    pub weight: GroupWeight,
}

impl GroupedTriangles<'_> {
    /// Computes the sums of all groups from the derivatives and the normals in `buffers`, on all threads.
    ///
    /// `is_full`: with bitangents and magnitudes. The bits do not depend on the number of threads.
    pub fn add_up(&self, is_full: bool, limits: RunLimits<'_>, buffers: &mut GroupBuffers) {
        let GroupBuffers { derivatives, normals, sums, areas, .. } = buffers;
        let (derivatives, normals) = (&derivatives[..], &normals[..]);
        areas.resize(derivatives.len(), 0.0);
        threads::fill(limits, areas, |t| if derivatives[t].joins_any { 0.0 } else { self.doubled_area(t) });
        let areas = &areas[..];
        sums.resize(normals.len(), GroupSum::default());
        threads::fill(limits, sums, |group| self.sum(group, is_full, normals[group], (derivatives, areas)));
    }

    fn doubled_area(&self, t: usize) -> f64 {
        let [a, b, c] = self.positions(t);
        length(cross(sub(b, a), sub(c, a)))
    }

    fn positions(&self, t: usize) -> [D3; 3] {
        self.welded.positions(self.triangles, t).map(|position| position.map(f64::from))
    }

    /// The sum of a group, whose unit normal is `normal`, or zero.
    fn sum(
        &self,
        group: usize,
        is_full: bool,
        normal: D3,
        (derivatives, areas): (&[Derivative], &[f64]),
    ) -> GroupSum {
        let mut sum = GroupSum::default();
        for &member in self.groups.members(group) {
            let (t, k) = (member as usize / 3, member as usize % 3);
            let derivative = &derivatives[t];
            if derivative.joins_any {
                continue;
            }
            let positions = self.positions(t);
            let (at, next, last) = (positions[k], positions[(k + 1) % 3], positions[(k + 2) % 3]);
            let area = (self.weight == GroupWeight::Area).then_some(areas[t]);
            let [x, y, z, weight] = term(derivative.s, [sub(next, at), sub(at, last)], normal, area);
            sum.s = add_scaled(sum.s, 1.0, [x, y, z]);
            sum.weight += weight;
            if is_full {
                sum.t = add_scaled(sum.t, weight, direction_in_plane(derivative.t, normal));
                let lengths = derivative.magnitude.map(f64::from);
                sum.magnitude = [0, 1].map(|i| sum.magnitude[i] + weight * lengths[i]);
            }
        }
        sum
    }

    /// Computes the residuals of the least-squares fit, which minimises the integral over the surface of |T -
    /// s|^2, where T is the interpolated tangent and s the direction of dP/du.
    ///
    /// With barycentric weights w_i on a triangle of area A, the integral of w_i w_j is A/12, or A/6 for i =
    /// j, and that of w_i is A/3. So the residual of corner i is A/3 s - A/12 (t_i + t_0 + t_1 + t_2),
    /// and the Jacobi step divides it by the sum of A/6.
    pub fn fit(&self, frames: &[GroupFrame], limits: RunLimits<'_>, buffers: &mut GroupBuffers) {
        let GroupBuffers { derivatives, normals, areas, residuals, .. } = buffers;
        residuals.clear();
        residuals.resize(normals.len(), ([0.0; 3], 0.0));
        for (t, (derivative, doubled)) in derivatives.iter().zip(areas).enumerate() {
            if limits.check_at(t).is_err() {
                return;
            }
            let groups = self.triangles.corners[t].map(|corner| self.group_of_corner[corner as usize]);
            if derivative.joins_any || groups.contains(&NONE) {
                continue;
            }
            let area = 0.5 * *doubled;
            let tangents = groups.map(|group| frames[group as usize].frame.tangent.map(f64::from));
            let sum = tangents.into_iter().fold([0.0; 3], |sum, tangent| add_scaled(sum, 1.0, tangent));
            let target = add_scaled(sum, -4.0, derivative.s.map(f64::from));
            for (group, tangent) in groups.into_iter().zip(tangents) {
                let (residual, weight) = &mut residuals[group as usize];
                *residual = add_scaled(*residual, -area / 12.0, add_scaled(target, 1.0, tangent));
                *weight += area / 6.0;
            }
        }
    }
}

/// The term of a triangle at the corner where `edges[0]` begins and `edges[1]` ends. The weight has the
/// edges' lengths where there is no area.
#[inline(always)]
fn term(s: V3, edges: [D3; 2], normal: D3, area: Option<f64>) -> [f64; 4] {
    let [leaving, [x, y, z]] = edges;
    let (angle, lengths) = angle_in_plane(leaving, [-x, -y, -z], normal);
    let weight = angle * area.unwrap_or(lengths);
    let [x, y, z] = direction_in_plane(s, normal);
    [weight * x, weight * y, weight * z, weight]
}

/// The angle between the projections of `a` and `b` to the plane of the normal, which is a unit vector or
/// zero, and the product of their lengths. Both are 0 where a projection is rounding error.
#[inline(always)]
fn angle_in_plane(a: D3, b: D3, normal: D3) -> (f64, f64) {
    let (along_a, along_b) = (dot(a, normal), dot(b, normal));
    let (square_a, square_b) = (dot(a, a), dot(b, b));
    let (flat_a, flat_b) = (square_a - along_a * along_a, square_b - along_b * along_b);
    if flat_a > ROUNDING * square_a && flat_b > ROUNDING * square_b {
        let lengths = (flat_a * flat_b).sqrt();
        let cosine = (dot(a, b) - along_a * along_b) / lengths;
        (f64::from(angle(cosine as f32)), lengths)
    } else {
        (0.0, 0.0)
    }
}

/// The direction of the projection of `v` to the plane of the normal, which is a unit vector or zero. Zero
/// where the projection is rounding error.
#[inline(always)]
fn direction_in_plane(v: V3, normal: D3) -> D3 {
    let v = [f64::from(v[0]), f64::from(v[1]), f64::from(v[2])];
    let rest = add_scaled(v, -dot(v, normal), normal);
    let square = dot(rest, rest);
    let inverse = if square > ROUNDING * dot(v, v) { 1.0 / square.sqrt() } else { 0.0 };
    [inverse * rest[0], inverse * rest[1], inverse * rest[2]]
}

/// The fraction of a squared length below which a projection counts as rounding error: a millionth of the
/// length.
const ROUNDING: f64 = 1e-12;
