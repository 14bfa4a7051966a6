//! MikkTSpace's groups, weighted by corner angle and triangle area, one sign per face.
//!
//! With angles alone a sliver or a thin bevel pulls the tangent of a vertex as much as the wide triangle beside it, which then shows the
//! error over its whole area. The angle keeps the result independent of how a flat fan is cut; the area makes it follow what is seen.
//! From there one step goes towards the least-squares fit, which takes into account that a triangle's inside is interpolated from three
//! vertices. Thresholds do not apply, all edges are matched, and sums are in f64.

pub(crate) mod group_sums;

use crate::Frame;
use crate::Mesh;
use crate::Mode;
use crate::math::V3;
use crate::topology::neighbours::{EdgeOrder, neighbours};
use crate::topology::triangles::{NONE, Triangles, Triangulation};
use crate::topology::triangulate::triangulate;

use crate::exec::limits::RunLimits;
use crate::exec::threads;
use crate::tangents::Report;
use crate::tangents::angle_area::group_sums::{GroupBuffers, GroupFrame, GroupSum, GroupedTriangles, add};
use crate::tangents::mesh_slices::MeshSlices;
use crate::tangents::mikktspace::derivatives::count_mirrored_edges;
use crate::tangents::mikktspace::derivatives::{
    Derivative, count_uv_degenerate, derivatives, derivatives_into, unify_quads,
};
use crate::tangents::mikktspace::groups::{Groups, build_groups};
use crate::tangents::mikktspace::welded_mesh::WeldedMesh;
use crate::tangents::mirrored_edges::survey;
use crate::tangents::output::Output;
use crate::tangents::repair::across;
use crate::tangents::repair::{
    D3, direction, in_plane, length, mean_in_plane, perpendicular, u_direction_of, unit,
};
use crate::tangents::report::count_split_vertices;

/// The frame of every corner's group.
pub(crate) fn run<O: Output>(
    mesh: &Mesh<'_>,
    mode: Mode,
    limits: RunLimits<'_>,
    memory: &mut GroupBuffers,
    corners: &mut [O],
) -> Report {
    on_pool(mesh, limits, || topology_and_report(mesh, mode, limits, memory, corners).1)
}

/// Enters the thread pool once for all stages.
fn on_pool<R: Send>(mesh: &Mesh<'_>, limits: RunLimits<'_>, work: impl FnOnce() -> R + Send) -> R {
    threads::on_pool(limits.thread_count(mesh.face_count()), work)
}

/// What does not depend on where vertices are, and the tangents where they are now.
pub(crate) fn plan(
    mesh: &Mesh<'_>,
    mode: Mode,
    limits: RunLimits<'_>,
) -> (AngleAreaPlan, Vec<[f32; 4]>, Report) {
    let mut corners = vec![Output::EMPTY; mesh.corner_count()];
    let buffers = &mut GroupBuffers::default();
    let (plan, report) =
        on_pool(mesh, limits, || topology_and_report(mesh, mode, limits, buffers, &mut corners));
    (plan, corners, report)
}

fn topology_and_report<O: Output>(
    mesh: &Mesh<'_>,
    mode: Mode,
    limits: RunLimits<'_>,
    memory: &mut GroupBuffers,
    corners: &mut [O],
) -> (AngleAreaPlan, Report) {
    let (topology, mut report) = AngleAreaPlan::new(mesh, limits, memory);
    let flat = MeshSlices::new(mesh);
    report.repaired_corners = topology.frames(&flat, &WeldedMesh::new(mesh), mode, limits, memory, corners);
    report.split_vertices = count_split_vertices(mesh, corners);
    (topology, report)
}

/// What does not depend on where vertices are, once they are welded and grouped.
#[derive(Debug)]
pub(crate) struct AngleAreaPlan {
    triangulation: Triangulation,
    groups: Groups,
    places: CornerGroups,
    /// Of good triangles: those that add nothing, wherever they are.
    is_left_out: Vec<bool>,
    orientation_of_face: Vec<Option<bool>>,
}

impl AngleAreaPlan {
    /// Welds, finds neighbours and groups; leaves the derivatives in `memory`, and what is known of the report.
    pub(crate) fn new(mesh: &Mesh<'_>, limits: RunLimits<'_>, memory: &mut GroupBuffers) -> (Self, Report) {
        let (flat, welded) = (MeshSlices::new(mesh), WeldedMesh::new(mesh));
        let triangulation = triangulate(mesh);
        let good = &triangulation.good;
        let mut derivatives = derivatives(good, &welded, limits);
        derivatives.iter_mut().for_each(leave_out_unless_finite);
        unify_quads(good, &welded, &mut derivatives);
        let neighbours = neighbours(good, EdgeOrder::Complete);
        let mut report = survey(mesh, &flat, limits);
        report.degenerate_triangles = triangulation.degenerate.len();
        report.uv_degenerate_triangles = count_uv_degenerate(good, &welded, &derivatives);
        report.mirrored_edges = count_mirrored_edges(&neighbours, &derivatives);
        let orientation_of_face = orientation_of_faces(&flat, good, &derivatives);
        let groups = build_groups(good, &neighbours, |_| true, &mut derivatives);
        let places = CornerGroups::new(&flat, &triangulation, &groups);
        let is_left_out = derivatives.iter().map(|derivative| derivative.joins_any).collect();
        memory.derivatives = derivatives;
        (Self { triangulation, groups, places, is_left_out, orientation_of_face }, report)
    }

    /// The frames of a mesh whose vertices have moved since it was grouped.
    pub(crate) fn frames_of_moved<O: Output>(
        &self,
        mesh: &Mesh<'_>,
        mode: Mode,
        limits: RunLimits<'_>,
        memory: &mut GroupBuffers,
        corners: &mut [O],
    ) {
        let welded = WeldedMesh::moved(mesh);
        on_pool(mesh, limits, || {
            derivatives_into(&self.triangulation.good, &welded, limits, &mut memory.derivatives);
            threads::update(limits, &mut memory.derivatives, |t, derivative| {
                leave_out_unless_finite(derivative);
                derivative.joins_any |= self.is_left_out[t];
            });
            self.frames(&MeshSlices::new(mesh), &welded, mode, limits, memory, corners);
        });
    }

    /// Gives every corner a frame, by the derivatives in `memory`; says how many have a repair.
    fn frames<O: Output>(
        &self,
        flat: &MeshSlices<'_>,
        welded: &WeldedMesh<'_>,
        mode: Mode,
        limits: RunLimits<'_>,
        memory: &mut GroupBuffers,
        corners: &mut [O],
    ) -> usize {
        let triangles = &self.triangulation.good;
        let grouped = GroupedTriangles {
            triangles,
            welded,
            groups: &self.groups,
            group_of_corner: &self.places.group_of_corner,
        };
        let normal = |group| direction(self.normal_of_vertex(group, welded)).unwrap_or_default();
        memory.normals.resize(self.groups.len(), [0.0; 3]);
        threads::fill(limits, &mut memory.normals, normal);
        grouped.add_up(O::IS_FULL, limits, memory);
        let mut frames = std::mem::take(&mut memory.frames);
        frames.resize(self.groups.len(), GroupFrame { frame: Frame::EMPTY, repaired: true });
        let known = &*memory;
        threads::fill(limits, &mut frames, |group| self.frame(group, O::IS_FULL, welded, known));
        grouped.fit(&frames, memory);
        let known = &*memory;
        threads::update(limits, &mut frames, |group, frame| {
            fit(frame, known.normals[group], known.residuals[group]);
            if O::IS_FULL && frame.frame.bitangent == Frame::EMPTY.bitangent {
                let Frame { tangent, sign, .. } = frame.frame;
                frame.frame.bitangent = across(self.normal_of_vertex(group, welded), tangent, sign);
            }
        });
        let groups = (&self.groups, &frames[..]);
        let repaired = to_corners(flat, &self.places, groups, &self.orientation_of_face, mode, corners);
        memory.frames = frames;
        repaired
    }

    fn normal_of_vertex(&self, group: usize, welded: &WeldedMesh<'_>) -> V3 {
        let first = self.groups.members(group)[0] as usize;
        welded.normal(self.triangulation.good.vertices.as_flattened()[first])
    }

    fn frame(
        &self,
        group: usize,
        is_whole: bool,
        welded: &WeldedMesh<'_>,
        memory: &GroupBuffers,
    ) -> GroupFrame {
        let GroupSum { s, t, magnitude, weight } = memory.sums[group];
        let normal = unless_zero(memory.normals[group]);
        let sign = if self.groups.preserves(group) { 1.0 } else { -1.0 };
        // What is left of tangents that cancel is rounding.
        let found = (length(s) > 1e-6 * weight).then(|| flat_direction_of(s, normal)).flatten();
        let mean = || self.mean(group, welded, &memory.derivatives);
        let tangent = found.map_or_else(mean, |s| s.map(|x| x as f32));
        let mut frame = Frame { tangent, sign, ..Frame::EMPTY };
        if is_whole {
            let bitangent = flat_direction_of(t, normal).map(|t| t.map(|x| x as f32));
            // Without a direction it is made from the tangent, once that is fitted.
            frame.bitangent = bitangent.unwrap_or(Frame::EMPTY.bitangent);
            frame.magnitude = magnitude.map(|sum| if weight > 0.0 { (sum / weight) as f32 } else { 1.0 });
        }
        GroupFrame { frame, repaired: found.is_none() }
    }

    /// The repair of a group: the mean of its tangents, all weighted alike; the first triangle's own; a perpendicular.
    fn mean(&self, group: usize, welded: &WeldedMesh<'_>, derivatives: &[Derivative]) -> V3 {
        let normal = self.normal_of_vertex(group, welded);
        let Some(unit_normal) = direction(normal) else { return [1.0, 0.0, 0.0] };
        let members = self.groups.members(group);
        let counted = members.iter().map(|&member| &derivatives[member as usize / 3]);
        let directions = counted.filter(|derivative| !derivative.joins_any).map(|derivative| derivative.s);
        mean_in_plane(directions, normal).unwrap_or_else(|| {
            let (first, good) = (members[0] as usize / 3, &self.triangulation.good);
            let own = u_direction_of(welded.positions(good, first), welded.uvs(good, first));
            in_plane(own, unit_normal).unwrap_or_else(|| perpendicular(unit_normal)).map(|x| x as f32)
        })
    }
}

/// Moves a tangent a part of the way to the fit. The whole step overshoots, half of one still does where neighbours differ much; see
/// docs/notes/methods.md.
fn fit(group: &mut GroupFrame, normal: D3, (residual, weight): (D3, f64)) {
    const PART: f64 = 0.25;
    let moved = add(group.frame.tangent.map(f64::from), PART / weight, residual);
    if !group.repaired
        && let Some(tangent) = flat_direction_of(moved, unless_zero(normal))
    {
        group.frame.tangent = tangent.map(|x| x as f32);
    }
}

fn unless_zero(normal: D3) -> Option<D3> {
    Some(normal).filter(|normal| *normal != [0.0; 3])
}

/// The direction of `v` in the plane of the normal; its direction where there is no normal.
fn flat_direction_of(v: D3, normal: Option<D3>) -> Option<D3> {
    normal.map_or_else(|| unit(v), |normal| in_plane(v, normal))
}

/// Triangles with values that are not finite join any group and add nothing.
fn leave_out_unless_finite(derivative: &mut Derivative) {
    let numbers = derivative.s.iter().chain(&derivative.t).chain(&derivative.magnitude);
    derivative.joins_any |= !numbers.fold(0.0, |sum, x| sum + x).is_finite();
}

/// The orientation of every face that has one, from its triangles that add something.
fn orientation_of_faces(
    flat: &MeshSlices<'_>,
    good: &Triangles,
    derivatives: &[Derivative],
) -> Vec<Option<bool>> {
    let mut preserves = vec![None; flat.face_count()];
    for (&face, derivative) in good.face.iter().zip(derivatives) {
        if !derivative.joins_any {
            preserves[face as usize] = Some(derivative.preserves);
        }
    }
    preserves
}

/// Where corners are: their group and their welded vertex, and the groups of each vertex.
#[derive(Debug)]
struct CornerGroups {
    group_of_corner: Vec<u32>,
    /// None for corners of unsupported faces.
    vertex_of_corner: Vec<u32>,
    /// Per welded vertex and orientation its first group.
    first_group: Vec<[u32; 2]>,
}

impl CornerGroups {
    fn new(flat: &MeshSlices<'_>, triangulation: &Triangulation, groups: &Groups) -> Self {
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
    flat: &MeshSlices<'_>,
    places: &CornerGroups,
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
                O::from_frame(&if left_out { Frame { sign: frame.sign, ..Frame::EMPTY } } else { frame });
        }
    }
    repaired_corners
}

fn from_normal(normal: V3, preserves: bool) -> Frame {
    let tangent = direction(normal).map_or([1.0, 0.0, 0.0], perpendicular).map(|x| x as f32);
    let sign = if preserves { 1.0 } else { -1.0 };
    Frame { tangent, bitangent: across(normal, tangent, sign), magnitude: [1.0; 2], sign }
}
