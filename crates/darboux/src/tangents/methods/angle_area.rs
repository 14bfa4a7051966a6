//! The methods angle-area and angle-edge: the groups of MikkTSpace, weighted by corner angle times triangle
//! area, or times the lengths of the corner's edges.
//!
//! ```text
//! weld, find neighbours and build groups as MikkTSpace does, with all edges matched and without a threshold
//! frame of each group = sum of its triangles' dP/du in the tangent plane, weighted, in f64
//!     angle-area: corner angle times triangle area
//!     angle-edge: corner angle times the product of the lengths of the corner's two edges in the tangent plane
//! angle-area: move each tangent a quarter of a Jacobi step towards the least-squares fit of the interpolated tangents
//! orientation of each face; each corner has the frame of its group of that orientation
//! ```
//!
//! With weights by angle alone, a sliver changes the tangent of a vertex as much as the wide triangle beside
//! it, which shows the error over its whole area. The angle makes the result independent of the triangulation
//! of a flat fan; the area reduces the visible error. Derivation: docs/algorithms/methods.md.

pub(crate) mod group_sums;

use crate::Frame;
use crate::Mesh;
use crate::math::V3;
use crate::math_f64::{D3, add_scaled, length, unit};
use crate::topology::neighbours::{EdgeOrder, neighbours};
use crate::topology::triangles::{NONE, Triangles, Triangulation};
use crate::topology::triangulate::triangulate;

use crate::exec::limits::RunLimits;
use crate::exec::threads;
use crate::tangents::Report;
use crate::tangents::methods::angle_area::group_sums::{
    GroupBuffers, GroupFrame, GroupSum, GroupWeight, GroupedTriangles,
};
use crate::tangents::methods::mesh_slices::MeshSlices;
use crate::tangents::methods::report_counts::count_irregular;
use crate::tangents::mikktspace::derivatives::{
    Derivative, count_mirrored_edges, count_uv_degenerate, derivatives, derivatives_into, unify_quads,
};
use crate::tangents::mikktspace::groups::{Groups, build_groups};
use crate::tangents::mikktspace::welded_mesh::WeldedMesh;
use crate::tangents::output::Output;
use crate::tangents::repair::{across, direction, in_plane, mean_in_plane, perpendicular, u_direction_of};
use crate::tangents::report::count_split_vertices;

/// Runs the method. The corners are unspecified after cancellation.
pub(crate) fn run<O: Output>(
    mesh: &Mesh<'_>,
    weight: GroupWeight,
    limits: RunLimits<'_>,
    buffers: &mut GroupBuffers,
    corners: &mut [O],
) -> Report {
    plan_and_report(mesh, weight, limits, buffers, corners).map_or_else(Report::default, |(_, report)| report)
}

/// Computes the plan, the tangents and the report of a mesh. `None` after cancellation.
pub(crate) fn plan(
    mesh: &Mesh<'_>,
    weight: GroupWeight,
    limits: RunLimits<'_>,
) -> Option<(AngleAreaPlan, Vec<[f32; 4]>, Report)> {
    let mut corners = vec![Output::EMPTY; mesh.corner_count()];
    let buffers = &mut GroupBuffers::default();
    let (plan, report) = plan_and_report(mesh, weight, limits, buffers, &mut corners)?;
    Some((plan, corners, report))
}

fn plan_and_report<O: Output>(
    mesh: &Mesh<'_>,
    weight: GroupWeight,
    limits: RunLimits<'_>,
    buffers: &mut GroupBuffers,
    corners: &mut [O],
) -> Option<(AngleAreaPlan, Report)> {
    let (plan, mut report) = AngleAreaPlan::new(mesh, weight, limits, buffers)?;
    let slices = MeshSlices::new(mesh);
    report.repaired_corners = plan.frames(&slices, &WeldedMesh::new(mesh), limits, buffers, corners);
    limits.check().ok()?;
    report.split_vertices = count_split_vertices(mesh, corners, limits);
    Some((plan, report))
}

/// The triangulation, the groups and the orientations of a mesh, to evaluate it again after its vertices
/// moved.
#[derive(Debug)]
pub(crate) struct AngleAreaPlan {
    weight: GroupWeight,
    triangulation: Triangulation,
    groups: Groups,
    corner_groups: CornerGroups,
    /// True for good triangles that are skipped: UV-degenerate or not finite in the base.
    is_skipped: Vec<bool>,
    orientation_of_face: Vec<Option<bool>>,
}

impl AngleAreaPlan {
    /// Builds the groups. Leaves the derivatives in `buffers`, and returns the counts that do not depend on
    /// evaluation. `None` after cancellation.
    pub(crate) fn new(
        mesh: &Mesh<'_>,
        weight: GroupWeight,
        limits: RunLimits<'_>,
        buffers: &mut GroupBuffers,
    ) -> Option<(Self, Report)> {
        let (slices, welded) = (MeshSlices::new(mesh), WeldedMesh::new(mesh));
        let triangulation = triangulate(mesh, limits);
        let good = &triangulation.good;
        let mut derivatives = derivatives(good, &welded, limits);
        limits.check().ok()?;
        derivatives.iter_mut().for_each(skip_unless_finite);
        unify_quads(good, &welded, &mut derivatives);
        let neighbours = neighbours(good, EdgeOrder::Complete, limits);
        limits.check().ok()?;
        let mut report = count_irregular(mesh, &slices, limits);
        report.degenerate_triangles = triangulation.degenerate.len();
        report.uv_degenerate_triangles = count_uv_degenerate(good, &welded, &derivatives);
        report.mirrored_edges = count_mirrored_edges(&neighbours, &derivatives);
        let orientation_of_face = orientation_of_faces(&slices, good, &derivatives);
        let groups = build_groups(good, &neighbours, |_| true, limits, &mut derivatives);
        limits.check().ok()?;
        let corner_groups = CornerGroups::new(&slices, &triangulation, &groups);
        let is_skipped = derivatives.iter().map(|derivative| derivative.joins_any).collect();
        buffers.derivatives = derivatives;
        Some((Self { weight, triangulation, groups, corner_groups, is_skipped, orientation_of_face }, report))
    }

    /// Writes the frames of the mesh after its vertices moved.
    pub(crate) fn frames_of_moved<O: Output>(
        &self,
        mesh: &Mesh<'_>,
        limits: RunLimits<'_>,
        buffers: &mut GroupBuffers,
        corners: &mut [O],
    ) {
        let welded = WeldedMesh::moved(mesh);
        derivatives_into(&self.triangulation.good, &welded, limits, &mut buffers.derivatives);
        threads::update(limits, &mut buffers.derivatives, |t, derivative| {
            skip_unless_finite(derivative);
            derivative.joins_any |= self.is_skipped[t];
        });
        self.frames(&MeshSlices::new(mesh), &welded, limits, buffers, corners);
    }

    /// Writes the frames of all corners from the derivatives in `buffers`. Returns the number of repaired
    /// corners. Both are unspecified after cancellation.
    fn frames<O: Output>(
        &self,
        slices: &MeshSlices<'_>,
        welded: &WeldedMesh<'_>,
        limits: RunLimits<'_>,
        buffers: &mut GroupBuffers,
        corners: &mut [O],
    ) -> usize {
        let triangles = &self.triangulation.good;
        let grouped = GroupedTriangles {
            triangles,
            welded,
            groups: &self.groups,
            group_of_corner: &self.corner_groups.group_of_corner,
            weight: self.weight,
        };
        let normal = |group| direction(self.normal_of_vertex(group, welded)).unwrap_or_default();
        buffers.normals.resize(self.groups.len(), [0.0; 3]);
        threads::fill(limits, &mut buffers.normals, normal);
        grouped.add_up(O::IS_FULL, limits, buffers);
        let mut frames = std::mem::take(&mut buffers.frames);
        frames.resize(self.groups.len(), GroupFrame { frame: Frame::EMPTY, repaired: true });
        let inputs = &*buffers;
        threads::fill(limits, &mut frames, |group| self.frame(group, O::IS_FULL, welded, inputs));
        let fits = self.weight == GroupWeight::Area;
        if fits {
            grouped.fit(&frames, limits, buffers);
        }
        let inputs = &*buffers;
        threads::update(limits, &mut frames, |group, frame| {
            if fits {
                fit(frame, inputs.normals[group], inputs.residuals[group]);
            }
            if O::IS_FULL && frame.frame.bitangent == Frame::EMPTY.bitangent {
                let Frame { tangent, sign, .. } = frame.frame;
                frame.frame.bitangent = across(self.normal_of_vertex(group, welded), tangent, sign);
            }
        });
        let groups = (&self.groups, &frames[..]);
        let repaired =
            to_corners(slices, limits, &self.corner_groups, groups, &self.orientation_of_face, corners);
        buffers.frames = frames;
        repaired
    }

    fn normal_of_vertex(&self, group: usize, welded: &WeldedMesh<'_>) -> V3 {
        let first = self.groups.members(group)[0] as usize;
        welded.normal(self.triangulation.good.vertices.as_flattened()[first])
    }

    fn frame(
        &self,
        group: usize,
        is_full: bool,
        welded: &WeldedMesh<'_>,
        buffers: &GroupBuffers,
    ) -> GroupFrame {
        let GroupSum { s, t, magnitude, weight } = buffers.sums[group];
        let normal = normal_unless_zero(buffers.normals[group]);
        let sign = if self.groups.preserves(group) { 1.0 } else { -1.0 };
        // A sum of tangents that cancel is rounding error.
        let found = (length(s) > 1e-6 * weight).then(|| flat_direction_of(s, normal)).flatten();
        let mean = || self.mean(group, welded, &buffers.derivatives);
        let tangent = found.map_or_else(mean, |s| s.map(|x| x as f32));
        let mut frame = Frame { tangent, sign, ..Frame::EMPTY };
        if is_full {
            let bitangent = flat_direction_of(t, normal).map(|t| t.map(|x| x as f32));
            // A bitangent without a direction is computed from the tangent after the fit.
            frame.bitangent = bitangent.unwrap_or(Frame::EMPTY.bitangent);
            frame.magnitude = magnitude.map(|sum| if weight > 0.0 { (sum / weight) as f32 } else { 1.0 });
        }
        GroupFrame { frame, repaired: found.is_none() }
    }

    /// The tangent of a group without one: the mean of its triangles' tangents, all weighted alike; else
    /// dP/du of its first triangle; else a perpendicular of the normal.
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

/// Moves a tangent a quarter of a Jacobi step towards the fit. Larger steps overshoot where neighbouring
/// tangents differ much; see docs/notes/methods.md.
fn fit(group: &mut GroupFrame, normal: D3, (residual, weight): (D3, f64)) {
    const STEP_SIZE: f64 = 0.25;
    let moved = add_scaled(group.frame.tangent.map(f64::from), STEP_SIZE / weight, residual);
    if !group.repaired
        && let Some(tangent) = flat_direction_of(moved, normal_unless_zero(normal))
    {
        group.frame.tangent = tangent.map(|x| x as f32);
    }
}

fn normal_unless_zero(normal: D3) -> Option<D3> {
    Some(normal).filter(|normal| *normal != [0.0; 3])
}

/// The direction of `v` in the tangent plane; without a normal, the direction of `v`.
fn flat_direction_of(v: D3, normal: Option<D3>) -> Option<D3> {
    normal.map_or_else(|| unit(v), |normal| in_plane(v, normal))
}

/// Marks triangles with values that are not finite: they join any group and are skipped.
fn skip_unless_finite(derivative: &mut Derivative) {
    let numbers = derivative.s.iter().chain(&derivative.t).chain(&derivative.magnitude);
    derivative.joins_any |= !numbers.fold(0.0, |sum, x| sum + x).is_finite();
}

/// The orientation of every face, from its triangles that are not skipped. `None` where all are skipped.
fn orientation_of_faces(
    slices: &MeshSlices<'_>,
    good: &Triangles,
    derivatives: &[Derivative],
) -> Vec<Option<bool>> {
    let mut preserves = vec![None; slices.face_count()];
    for (&face, derivative) in good.face.iter().zip(derivatives) {
        if !derivative.joins_any {
            preserves[face as usize] = Some(derivative.preserves);
        }
    }
    preserves
}

/// The group and the welded vertex of each corner, and the groups of each welded vertex.
#[derive(Debug)]
struct CornerGroups {
    group_of_corner: Vec<u32>,
    /// [`NONE`] for corners of unsupported faces.
    vertex_of_corner: Vec<u32>,
    /// The first group of each welded vertex, per orientation: mirrored, preserved.
    first_group: Vec<[u32; 2]>,
}

impl CornerGroups {
    fn new(slices: &MeshSlices<'_>, triangulation: &Triangulation, groups: &Groups) -> Self {
        let count = slices.vertex_of_corner.len();
        let mut corner_groups = Self {
            group_of_corner: vec![NONE; count],
            vertex_of_corner: vec![NONE; count],
            first_group: vec![[NONE; 2]; count],
        };
        for list in [&triangulation.degenerate, &triangulation.good] {
            for (&corner, &vertex) in list.corners.as_flattened().iter().zip(list.vertices.as_flattened()) {
                corner_groups.vertex_of_corner[corner as usize] = vertex;
            }
        }
        let good = &triangulation.good;
        for group in (0..groups.len()).rev() {
            for &member in groups.members(group) {
                let corner = good.corners.as_flattened()[member as usize];
                corner_groups.group_of_corner[corner as usize] = group as u32;
            }
            let vertex = good.vertices.as_flattened()[groups.members(group)[0] as usize];
            corner_groups.first_group[vertex as usize][usize::from(groups.preserves(group))] = group as u32;
        }
        corner_groups
    }

    /// The group of a corner with the given orientation: its own, or the first one at its vertex.
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

/// Writes to every corner the frame of its group that has the face's orientation. Returns the number of
/// repaired corners.
///
/// A face without an orientation takes the one for which more of its corners have groups; on a tie,
/// preserved. A corner without a group gets a frame from its normal.
fn to_corners<O: Output>(
    slices: &MeshSlices<'_>,
    limits: RunLimits<'_>,
    corner_groups: &CornerGroups,
    (groups, frames): (&Groups, &[GroupFrame]),
    preserves: &[Option<bool>],
    corners: &mut [O],
) -> usize {
    let mut repaired_corners = 0;
    for face in limits.parts(0..preserves.len()).flatten() {
        let (range, preserves) = (slices.corners(face), preserves[face]);
        let count = |preserves| {
            range.clone().filter(|&c| corner_groups.group(c, preserves, groups).is_some()).count()
        };
        let preserves = preserves.unwrap_or_else(|| count(true) >= count(false));
        for corner in range.clone() {
            let group = corner_groups.group(corner, preserves, groups).map(|group| &frames[group]);
            let frame = group.map_or_else(
                || from_normal(slices.normals[slices.vertex_of_corner[corner] as usize], preserves),
                |group| group.frame,
            );
            let repaired = group.is_none_or(|group| group.repaired);
            repaired_corners += usize::from(repaired);
            corners[corner] = O::from_frame(&frame);
        }
    }
    repaired_corners
}

/// A frame whose tangent is a perpendicular of the normal.
fn from_normal(normal: V3, preserves: bool) -> Frame {
    let tangent = direction(normal).map_or([1.0, 0.0, 0.0], perpendicular).map(|x| x as f32);
    let sign = if preserves { 1.0 } else { -1.0 };
    Frame { tangent, bitangent: across(normal, tangent, sign), magnitude: [1.0; 2], sign }
}
