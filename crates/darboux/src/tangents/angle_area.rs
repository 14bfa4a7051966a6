//! MikkTSpace's groups, weighted by corner angle and triangle area, one sign per face.
//!
//! With angles alone a sliver or a thin bevel pulls the tangent of a vertex as much as the wide triangle beside it, which then shows the
//! error over its whole area. The angle keeps the result independent of how a flat fan is cut; the area makes it follow what is seen.
//! From there one step goes towards the least-squares fit, which takes into account that a triangle's inside is interpolated from three
//! vertices. Thresholds do not apply, all edges are matched, and sums are in f64.

use crate::math::{V3, angle};
use crate::topology::{EdgeOrder, neighbours};
use crate::triangles::{Triangles, Triangulation, triangulate};
use crate::{Frame, Mesh, Mode};

use super::Report;
use super::derivatives::{Derivative, agree_in_quads, derivatives};
use super::flat::Flat;
use super::groups::{Groups, group};
use super::mikktspace::count_mirrored_edges;
use super::repair::{
    D3, cross, direction, dot, in_plane, length, mean_in_plane, perpendicular, u_direction_of, unit,
};
use super::seams::{count_split_vertices, survey};
use super::shape::Shape;
use super::sides::{Output, across};
use super::threads;

/// No group.
const NONE: u32 = u32::MAX;

/// The frame of every corner's group.
pub(super) fn run<O: Output>(mesh: &Mesh<'_>, mode: Mode, corners: &mut [O]) -> Report {
    let (flat, shape) = (Flat::new(mesh), Shape::welded(mesh));
    let triangulation = triangulate(mesh);
    let good = &triangulation.good;
    let mut derivatives = derivatives(good, &shape);
    derivatives.iter_mut().for_each(leave_out_unless_finite);
    agree_in_quads(good, &shape, &mut derivatives);
    let neighbours = neighbours(good, EdgeOrder::Complete);
    let mut report = survey(mesh, &flat);
    report.degenerate_triangles = triangulation.degenerate.len();
    report.uv_degenerate_triangles = derivatives.iter().filter(|derivative| derivative.any).count();
    report.mirrored_edges = count_mirrored_edges(&neighbours, &derivatives);
    let preserves = orientation_of_faces(&flat, good, &derivatives);
    let groups = group(good, &neighbours, |_| true, &mut derivatives);
    let places = Places::new(&flat, &triangulation, &groups);
    let evaluation = Evaluation { triangles: good, derivatives: &derivatives, shape: &shape };
    let mut frames = evaluation.frames(&groups);
    evaluation.fit(&places, &mut frames);
    report.repaired_corners = to_corners(&flat, &places, (&groups, &frames), &preserves, mode, corners);
    report.split_vertices = count_split_vertices(&flat, corners);
    report
}

/// Triangles with values that are not finite join any group and add nothing.
fn leave_out_unless_finite(derivative: &mut Derivative) {
    let numbers = derivative.s.iter().chain(&derivative.t).chain(&derivative.magnitude);
    derivative.any |= !numbers.fold(0.0, |sum, x| sum + x).is_finite();
}

/// The orientation of every face that has one, from its triangles that add something.
fn orientation_of_faces(flat: &Flat<'_>, good: &Triangles, derivatives: &[Derivative]) -> Vec<Option<bool>> {
    let mut preserves = vec![None; flat.face_count()];
    for (&face, derivative) in good.face.iter().zip(derivatives) {
        if !derivative.any {
            preserves[face as usize] = Some(derivative.preserves);
        }
    }
    preserves
}

/// What groups are evaluated on.
struct Evaluation<'a> {
    triangles: &'a Triangles,
    derivatives: &'a [Derivative],
    shape: &'a Shape<'a>,
}

/// A group's frame, the direction of its normal, and whether it is a repair.
struct GroupFrame {
    frame: Frame,
    normal: Option<D3>,
    repaired: bool,
}

impl Evaluation<'_> {
    fn frames(&self, groups: &Groups) -> Vec<GroupFrame> {
        threads::map(groups.len(), |group| self.frame(groups.members(group), groups.preserves(group)))
    }

    fn frame(&self, members: &[u32], preserves: bool) -> GroupFrame {
        let normal = self.shape.normal(self.triangles.vertices.as_flattened()[members[0] as usize]);
        let unit_normal = direction(normal);
        let (mut s, mut t, mut magnitude, mut weights) = ([0.0; 3], [0.0; 3], [0.0; 2], 0.0);
        for &member in members {
            let (triangle, k) = (member as usize / 3, member as usize % 3);
            let derivative = &self.derivatives[triangle];
            if derivative.any {
                continue;
            }
            let weight = weight(self.shape.positions(self.triangles, triangle), k, unit_normal);
            s = add(s, weight, flat_direction(derivative.s, unit_normal));
            t = add(t, weight, flat_direction(derivative.t, unit_normal));
            let lengths = derivative.magnitude.map(f64::from);
            magnitude = [magnitude[0] + weight * lengths[0], magnitude[1] + weight * lengths[1]];
            weights += weight;
        }
        let sign = if preserves { 1.0 } else { -1.0 };
        let magnitude = magnitude.map(|sum| if weights > 0.0 { (sum / weights) as f32 } else { 1.0 });
        // What is left of tangents that cancel is rounding.
        let found = (length(s) > 1e-6 * weights).then(|| flat_direction_of(s, unit_normal)).flatten();
        let tangent = found.map_or_else(|| self.mean(members, normal), |s| s.map(|x| x as f32));
        let bitangent = flat_direction_of(t, unit_normal).map(|t| t.map(|x| x as f32));
        let bitangent = bitangent.unwrap_or_else(|| across(normal, tangent, sign));
        GroupFrame {
            frame: Frame { tangent, bitangent, magnitude, sign },
            normal: unit_normal,
            repaired: found.is_none(),
        }
    }

    /// The repair of a group: the mean of its tangents, all weighted alike; the first triangle's own; a perpendicular.
    fn mean(&self, members: &[u32], normal: V3) -> V3 {
        let Some(unit_normal) = direction(normal) else { return [1.0, 0.0, 0.0] };
        let counted = members.iter().map(|&member| &self.derivatives[member as usize / 3]);
        let directions = counted.filter(|derivative| !derivative.any).map(|derivative| derivative.s);
        mean_in_plane(directions, normal).unwrap_or_else(|| {
            let first = members[0] as usize / 3;
            let (positions, uvs) =
                (self.shape.positions(self.triangles, first), self.shape.uvs(self.triangles, first));
            let own = in_plane(u_direction_of(positions, uvs), unit_normal);
            own.unwrap_or_else(|| perpendicular(unit_normal)).map(|x| x as f32)
        })
    }
}

impl Evaluation<'_> {
    /// Moves every tangent a part of the way to the least squares of what is seen: the integral over the surface of the squared
    /// distance between the interpolated tangent T and the direction s of dP/du.
    ///
    /// With linear weights w_i over a triangle of area A, integral w_i w_j = A/12, or A/6 for i = j, and integral w_i = A/3; so the
    /// residual of corner i is A/3 s - A/12 (t_i + t_0 + t_1 + t_2), and its step (Jacobi's) is that over the sum of A/6. The whole step
    /// overshoots, half of one still does where neighbours differ much; see docs/notes/methods.md.
    fn fit(&self, places: &Places, frames: &mut [GroupFrame]) {
        const PART: f64 = 0.25;
        let mut residuals = vec![([0.0; 3], 0.0); frames.len()];
        for (t, derivative) in self.derivatives.iter().enumerate() {
            let groups = self.triangles.corners[t].map(|corner| places.group_of_corner[corner as usize]);
            if derivative.any || groups.contains(&NONE) {
                continue;
            }
            let area = 0.5 * doubled_area(self.shape.positions(self.triangles, t));
            let tangents = groups.map(|group| frames[group as usize].frame.tangent.map(f64::from));
            let sum = tangents.into_iter().fold([0.0; 3], |sum, tangent| add(sum, 1.0, tangent));
            let target = add(sum, -4.0, derivative.s.map(f64::from));
            for (group, tangent) in groups.into_iter().zip(tangents) {
                let (residual, weight) = &mut residuals[group as usize];
                *residual = add(*residual, -area / 12.0, add(target, 1.0, tangent));
                *weight += area / 6.0;
            }
        }
        for (group, (residual, weight)) in frames.iter_mut().zip(residuals) {
            let moved = add(group.frame.tangent.map(f64::from), PART / weight, residual);
            if !group.repaired
                && let Some(tangent) = flat_direction_of(moved, group.normal)
            {
                group.frame.tangent = tangent.map(|x| x as f32);
            }
        }
    }
}

fn doubled_area(positions: [V3; 3]) -> f64 {
    let [a, b, c] = positions.map(|position| position.map(f64::from));
    length(cross(add(b, -1.0, a), add(c, -1.0, a)))
}

/// The angle of corner `k` in the plane of the normal, times the triangle's area.
fn weight(positions: [V3; 3], k: usize, normal: Option<D3>) -> f64 {
    let [before, here, after] = [k + 2, k, k + 1].map(|k| positions[k % 3].map(f64::from));
    let [a, b] = [before, after].map(|end| add(end, -1.0, here));
    let directions = [a, b].map(|edge| flat_direction_of(edge, normal));
    let [Some(along_a), Some(along_b)] = directions else { return 0.0 };
    f64::from(angle(dot(along_a, along_b) as f32)) * doubled_area(positions)
}

fn flat_direction(v: V3, normal: Option<D3>) -> D3 {
    flat_direction_of(v.map(f64::from), normal).unwrap_or_default()
}

/// The direction of `v` in the plane of the normal; its direction where there is no normal.
fn flat_direction_of(v: D3, normal: Option<D3>) -> Option<D3> {
    normal.map_or_else(|| unit(v), |normal| in_plane(v, normal))
}

/// sum + weight * v.
fn add(sum: D3, weight: f64, v: D3) -> D3 {
    [sum[0] + weight * v[0], sum[1] + weight * v[1], sum[2] + weight * v[2]]
}

/// Where corners are: their group and their welded vertex, and the groups of each vertex.
struct Places {
    group_of_corner: Vec<u32>,
    /// None for corners of unsupported faces.
    vertex_of_corner: Vec<u32>,
    /// Per welded vertex and orientation its first group.
    first_group: Vec<[u32; 2]>,
}

impl Places {
    fn new(flat: &Flat<'_>, triangulation: &Triangulation, groups: &Groups) -> Self {
        let count = flat.vertex_of_corner.len();
        let mut places = Self {
            group_of_corner: vec![NONE; count],
            vertex_of_corner: vec![NONE; count],
            first_group: vec![[NONE; 2]; count],
        };
        for list in [&triangulation.degenerate, &triangulation.good] {
            for (&corner, &vertex) in list.corners.as_flattened().iter().zip(list.vertices.as_flattened()) {
                places.vertex_of_corner[corner as usize] = vertex;
            }
        }
        let good = &triangulation.good;
        for group in (0..groups.len()).rev() {
            for &member in groups.members(group) {
                let corner = good.corners.as_flattened()[member as usize];
                places.group_of_corner[corner as usize] = group as u32;
            }
            let vertex = good.vertices.as_flattened()[groups.members(group)[0] as usize];
            places.first_group[vertex as usize][usize::from(groups.preserves(group))] = group as u32;
        }
        places
    }

    /// A corner's group of the given orientation: its own, or the first at its vertex.
    fn group(&self, corner: usize, preserves: bool, groups: &Groups) -> Option<usize> {
        let own = self.group_of_corner[corner];
        if own != NONE && groups.preserves(own as usize) == preserves {
            return Some(own as usize);
        }
        let vertex = self.vertex_of_corner[corner];
        let first = self.first_group.get(vertex as usize)?[usize::from(preserves)];
        (first != NONE).then_some(first as usize)
    }
}

/// Gives every corner its group's frame of its face's orientation. A face without one takes the orientation that more of its corners have
/// groups of, +1 on a tie; a corner without a group, a frame from its normal, one per vertex and sign. Returns how many corners have a repair.
fn to_corners<O: Output>(
    flat: &Flat<'_>,
    places: &Places,
    (groups, frames): (&Groups, &[GroupFrame]),
    preserves: &[Option<bool>],
    mode: Mode,
    corners: &mut [O],
) -> usize {
    let mut repaired_corners = 0;
    for (face, &preserves) in preserves.iter().enumerate() {
        let range = flat.corners(face);
        let count =
            |preserves| range.clone().filter(|&c| places.group(c, preserves, groups).is_some()).count();
        let preserves = preserves.unwrap_or_else(|| count(true) >= count(false));
        for corner in range.clone() {
            let group = places.group(corner, preserves, groups).map(|group| &frames[group]);
            let frame = group.map_or_else(
                || from_normal(flat.normals[flat.vertex_of_corner[corner] as usize], preserves),
                |group| group.frame,
            );
            let repaired = group.is_none_or(|group| group.repaired);
            repaired_corners += usize::from(repaired);
            let left_out = repaired && mode == Mode::Reference;
            corners[corner] =
                O::from_frame(&if left_out { Frame { sign: frame.sign, ..Frame::NONE } } else { frame });
        }
    }
    repaired_corners
}

fn from_normal(normal: V3, preserves: bool) -> Frame {
    let tangent = direction(normal).map_or([1.0, 0.0, 0.0], perpendicular).map(|x| x as f32);
    let sign = if preserves { 1.0 } else { -1.0 };
    Frame { tangent, bitangent: across(normal, tangent, sign), magnitude: [1.0; 2], sign }
}
