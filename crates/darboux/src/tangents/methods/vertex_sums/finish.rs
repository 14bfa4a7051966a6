//! From sums to frames, and from there to corners and the report.
//!
//! A *side* is a vertex and a UV orientation. All triangles of that orientation around the vertex share the
//! side's frame. So all corners of a face have one sign, that of its orientation, and a vertex splits where
//! both of its sides are used.
//!
//! ```text
//! frame of each side from its sum, in blocks; sides without a direction are listed
//! orientation of faces without one: the majority of their corners' sides
//! repair the listed sides
//! write every corner from its side
//! ```

use std::collections::HashMap;

use crate::Frame;
use crate::Mesh;
use crate::math::V3;

use crate::exec::limits::RunLimits;
use crate::exec::threads::{self, split_range, split_slice};
use crate::math_f64::unit;
use crate::tangents::methods::mesh_slices::MeshSlices;
use crate::tangents::methods::report_counts::{
    count_irregular_where, count_mirrored_edges, has_finite_normals, has_finite_vertices, vertices_of_both,
};
use crate::tangents::methods::uv_derivatives::Orientation;
use crate::tangents::methods::vertex_sums::frame_kernel::FrameBlock;
use crate::tangents::methods::vertex_sums::frame_math::{
    cancels, direction_across, precise_direction_across, sign_of, sure_tangent,
};
use crate::tangents::methods::vertex_sums::side_sums::SideSums;
use crate::tangents::methods::vertex_sums::term_kernel::TERM_BLOCK;
use crate::tangents::methods::vertex_sums::weighting::{SumRows, Weighting, adds};
use crate::tangents::output::{Output, fill};
use crate::tangents::repair::{across, direction, in_plane, mean_in_plane, perpendicular, u_direction_of};
use crate::tangents::report::Report;

/// A vertex, and 0 for preserved or 1 for mirrored UV orientation.
type Side = (u32, usize);

/// Computes all frames, writes the corners, and returns the report. The corners and the report are
/// unspecified after cancellation.
///
/// `frames`: reused buffers of the frames of all vertices, per orientation.
pub(crate) fn finish<const N: usize, W: Weighting<N>, O: Output>(
    mesh: &Mesh<'_>,
    slices: &MeshSlices<'_>,
    sums: &mut SideSums<N>,
    limits: RunLimits<'_>,
    frames: &mut [Vec<O>; 2],
    corners: &mut [O],
) -> Report {
    // Where no triangle is skipped, all positions and UVs that are used are finite.
    let adds_all = slices.is_triangles() && sums.skipped.is_empty();
    let is_finite =
        if adds_all { has_finite_normals(slices, limits) } else { has_finite_vertices(slices, limits) };
    let mut report = count_irregular_where(mesh, slices, is_finite);
    report.degenerate_triangles = sums.skipped.degenerate;
    report.uv_degenerate_triangles = sums.skipped.uv_degenerate;
    let mut of_both = vertices_of_both(slices, &sums.orientation_of_face);
    if let Some(of_both) = &of_both {
        report.mirrored_edges = count_mirrored_edges(slices, &sums.orientation_of_face, of_both);
        report.merged_vertices = if W::SPLITS { 0 } else { count(of_both) };
    }
    let mut missing = frames_of_sides::<N, W, O>(slices, limits, sums, frames);
    if limits.is_cancelled() {
        return report;
    }
    decide_faces::<N, W>(slices, sums, &mut missing);
    missing.sort_unstable();
    missing.dedup();
    if !missing.is_empty() {
        replace::<N, W, O>(slices, sums, &missing, frames);
    }
    if limits.is_cancelled() {
        return report;
    }
    report.repaired_corners = count_corners::<N, W>(slices, &sums.orientation_of_face, &missing);
    to_corners::<N, W, O>(slices, limits, &sums.orientation_of_face, frames, corners);
    if limits.is_cancelled() {
        return report;
    }
    if W::SPLITS {
        if !adds_all {
            of_both = vertices_of_both(slices, &sums.orientation_of_face);
        }
        report.split_vertices = of_both.map_or(0, |both| count(&both));
    } else if has_both_signs(&frames[0]) {
        report.mixed_sign_faces = count_mixed_sign_faces(slices, corners);
    }
    report
}

fn count(of_vertex: &[bool]) -> usize {
    of_vertex.iter().filter(|is| **is).count()
}

/// The number of corners whose side is in `sides`.
fn count_corners<const N: usize, W: Weighting<N>>(
    slices: &MeshSlices<'_>,
    orientation_of_face: &[Orientation],
    sides: &[Side],
) -> usize {
    if sides.is_empty() {
        return 0;
    }
    let mut listed = [vec![false; slices.positions.len()], vec![false; slices.positions.len()]];
    sides.iter().for_each(|&(v, side)| listed[side][v as usize] = true);
    let of_face = |(face, &orientation): (usize, &Orientation)| {
        let listed = &listed[side_of::<N, W>(orientation)];
        slices.vertex_of_corner[slices.corners(face)].iter().filter(|&&v| listed[v as usize]).count()
    };
    orientation_of_face.iter().enumerate().map(of_face).sum()
}

/// The side of the corners of a face with this orientation.
fn side_of<const N: usize, W: Weighting<N>>(orientation: Orientation) -> usize {
    usize::from(W::SPLITS && orientation == Orientation::Mirrors)
}

fn has_both_signs<O: Output>(frames: &[O]) -> bool {
    frames.iter().any(|frame| frame.tangent()[3] != frames[0].tangent()[3])
}

fn count_mixed_sign_faces<O: Output>(slices: &MeshSlices<'_>, corners: &[O]) -> usize {
    let is_mixed = |face: &usize| {
        let corners = &corners[slices.corners(*face)];
        matches!(corners.len(), 3 | 4)
            && corners.iter().any(|corner| corner.tangent()[3] != corners[0].tangent()[3])
    };
    (0..slices.face_count()).filter(is_mixed).count()
}

/// Writes the frame of every side. Returns the sides that have triangles but no direction.
fn frames_of_sides<const N: usize, W: Weighting<N>, O: Output>(
    slices: &MeshSlices<'_>,
    limits: RunLimits<'_>,
    sums: &SideSums<N>,
    frames: &mut [Vec<O>; 2],
) -> Vec<Side> {
    let threads = limits.thread_count(slices.triangles().len());
    let mut missing = vec![Vec::new(); threads];
    for (side, frames) in frames.iter_mut().enumerate() {
        let sums = &sums.sums_of_side[side];
        frames.resize(sums.len(), O::EMPTY);
        let ranges = split_range(0..sums.len(), threads, 1);
        let jobs = ranges.clone().zip(split_slice(frames, 0, ranges));
        threads::run(&mut missing, jobs, |missing, (range, frames)| {
            let place = SideRange { first: range.start, side, limits };
            frames_of_side::<N, W, O>(&sums[range.clone()], &slices.normals[range], place, frames, missing);
        });
    }
    missing.concat()
}

/// The first vertex and the side of consecutive sums, and the limits of the run.
struct SideRange<'a> {
    first: usize,
    side: usize,
    limits: RunLimits<'a>,
}

fn frames_of_side<const N: usize, W: Weighting<N>, O: Output>(
    sums: &[SumRows<N>],
    normals: &[V3],
    SideRange { first, side, limits }: SideRange<'_>,
    frames: &mut [O],
    missing: &mut Vec<Side>,
) {
    let sign = if side == 0 { 1.0 } else { -1.0 };
    let mut block = FrameBlock::new();
    let blocks = sums.chunks(TERM_BLOCK).zip(normals.chunks(TERM_BLOCK)).zip(frames.chunks_mut(TERM_BLOCK));
    for (first, ((sums, normals), frames)) in (first..).step_by(TERM_BLOCK).zip(blocks) {
        if limits.is_cancelled() {
            return;
        }
        if !O::IS_FULL {
            block.set::<N, W>(sums, normals);
            block.evaluate::<N, W>(sign, limits.width);
            if block.are_sure(sums.len()) {
                fill(frames, block.tangents.iter().map(|&tangent| O::from_tangent(tangent)));
                continue;
            }
        }
        for ((v, (sum, normal)), out) in (first as u32..).zip(sums.iter().zip(normals)).zip(frames) {
            *out = if !is_used(sum) {
                O::EMPTY
            } else if let Some(frame) = frame::<N, W, O>(sum, normal, sign) {
                O::from_frame(&frame)
            } else {
                missing.push((v, side));
                O::from_frame(&Frame { sign, ..Frame::EMPTY })
            };
        }
    }
}

/// True when a triangle has added to the sum.
fn is_used<const N: usize>(sum: &SumRows<N>) -> bool {
    sum[0][3] > 0.0
}

/// The frame of a sum. `None` where the tangent has no direction in the tangent plane.
#[inline(always)]
fn frame<const N: usize, W: Weighting<N>, O: Output>(
    sum: &SumRows<N>,
    normal: &V3,
    sign: f32,
) -> Option<Frame> {
    let ([s0, s1, s2, _], [t0, t1, t2, _]) = (sum[0], sum[1]);
    let (s, t) = ([s0, s1, s2], [t0, t1, t2]);
    let (mut normal, size) = (*normal, W::size(sum));
    let (mut tangent, is_sure) = sure_tangent(s, normal, size);
    if !is_sure {
        if cancels(s, size) {
            return None;
        }
        normal = if direction(normal).is_some() { normal } else { W::own_normal(sum) };
        tangent = precise_direction_across(s, normal)?;
    }
    let sign = if W::SPLITS { sign } else { sign_of(normal, tangent, t) };
    if !O::IS_FULL {
        return Some(Frame { tangent, sign, ..Frame::EMPTY });
    }
    let bitangent = direction_across(t, normal).unwrap_or_else(|| across(normal, tangent, sign));
    Some(Frame { tangent, bitangent, magnitude: W::magnitude(sum), sign })
}

/// Decides the orientation of faces without one: the orientation for which more of the face's corners have a
/// used side, preserved on a tie. Appends to `missing` the sides of corners to which no triangle has added.
fn decide_faces<const N: usize, W: Weighting<N>>(
    slices: &MeshSlices<'_>,
    sums: &mut SideSums<N>,
    missing: &mut Vec<Side>,
) {
    if sums.skipped.is_empty() && slices.is_triangles() {
        return;
    }
    for face in 0..slices.face_count() {
        let orientation = sums.orientation_of_face[face];
        // A triangle with an orientation has added to the sides of its own corners.
        if orientation != Orientation::None && slices.is_triangles() {
            continue;
        }
        let vertices = &slices.vertex_of_corner[slices.corners(face)];
        let used = |v: u32, side: usize| sums.sums_of_side[side].get(v as usize).is_some_and(is_used);
        let count = |side| vertices.iter().filter(|&&v| used(v, side)).count();
        let side = match orientation {
            _ if !W::SPLITS => 0,
            Orientation::None => usize::from(count(1) > count(0)),
            orientation => orientation as usize,
        };
        missing.extend(vertices.iter().filter(|&&v| !used(v, side)).map(|&v| (v, side)));
        if orientation == Orientation::None {
            sums.orientation_of_face[face] =
                if side == 0 { Orientation::Preserves } else { Orientation::Mirrors };
        }
    }
}

/// Repairs the frames of `missing`, which ascends. The tangent is the first of these that has a direction in
/// the tangent plane: the mean of the triangles' tangents, all weighted alike; dP/du of the first triangle; a
/// perpendicular of the normal. Without a normal it is (1, 0, 0).
fn replace<const N: usize, W: Weighting<N>, O: Output>(
    slices: &MeshSlices<'_>,
    sums: &SideSums<N>,
    missing: &[Side],
    frames: &mut [Vec<O>; 2],
) {
    let triangles = triangles_around(slices, missing);
    for &(v, side) in missing {
        let sum = sums.sums_of_side[side].get(v as usize).filter(|sum| is_used(sum));
        let normal = slices.normals[v as usize];
        let own_normal = || sum.map_or(normal, W::own_normal);
        let normal = if direction(normal).is_some() { normal } else { own_normal() };
        let around = triangles.get(&v).map_or(&[][..], Vec::as_slice);
        let sign = if side == 0 { 1.0 } else { -1.0 };
        let tangent = replacement::<N, W>(slices, &sums.orientation_of_face, around, normal, side);
        let magnitude = sum.map_or([1.0; 2], |sum| W::magnitude(sum));
        let magnitude = magnitude.map(|x| if x.is_finite() { x } else { 1.0 });
        let bitangent = across(normal, tangent, sign);
        frames[side][v as usize] = O::from_frame(&Frame { tangent, bitangent, magnitude, sign });
    }
}

fn replacement<const N: usize, W: Weighting<N>>(
    slices: &MeshSlices<'_>,
    orientation_of_face: &[Orientation],
    around: &[u32],
    normal: V3,
    side: usize,
) -> V3 {
    let Some(unit_normal) = direction(normal) else { return [1.0, 0.0, 0.0] };
    let is_on_side = |t: u32| !W::SPLITS || orientation_of_face[slices.face(t as usize)] as usize == side;
    let own = |t: u32| {
        let (positions, uvs) = slices.values(t as usize);
        unit(u_direction_of(positions, uvs))
    };
    let counted = around.iter().filter(|&&t| is_on_side(t) && adds::<N, W>(slices, t as usize));
    let directions = counted.filter_map(|&t| own(t));
    let mean = mean_in_plane(directions.map(|direction| direction.map(|x| x as f32)), normal);
    let first = || around.first().and_then(|&t| in_plane(own(t)?, unit_normal));
    let found = mean.map(|mean| mean.map(f64::from)).or_else(first);
    found.unwrap_or_else(|| perpendicular(unit_normal)).map(|x| x as f32)
}

/// The triangles around each vertex of `sides`, ascending.
fn triangles_around(slices: &MeshSlices<'_>, sides: &[Side]) -> HashMap<u32, Vec<u32>> {
    let mut around: HashMap<u32, Vec<u32>> = sides.iter().map(|&(v, _)| (v, Vec::new())).collect();
    let mut wanted = vec![false; slices.positions.len()];
    sides.iter().for_each(|&(v, _)| wanted[v as usize] = true);
    for (corner, &v) in slices.triangles().as_flattened().iter().enumerate() {
        if wanted[v as usize]
            && let Some(list) = around.get_mut(&v)
            && list.last() != Some(&(corner as u32 / 3))
        {
            list.push(corner as u32 / 3);
        }
    }
    around
}

fn to_corners<const N: usize, W: Weighting<N>, O: Output>(
    slices: &MeshSlices<'_>,
    limits: RunLimits<'_>,
    orientation_of_face: &[Orientation],
    frames: &[Vec<O>; 2],
    corners: &mut [O],
) {
    let threads = limits.thread_count(slices.triangles().len());
    let ranges = split_range(0..slices.face_count(), threads, 1);
    let corners = split_slice(corners, 0, ranges.clone().map(|faces| slices.corners_of(faces)));
    threads::run(&mut vec![(); threads], ranges.zip(corners), |(), (faces, corners)| {
        let range = slices.corners_of(faces.clone());
        let vertices = &slices.vertex_of_corner[range.clone()];
        if frames[1].is_empty() {
            for part in limits.parts(0..vertices.len()) {
                let values = vertices[part.clone()].iter().map(|&v| frames[0][v as usize]);
                fill(&mut corners[part], values);
            }
            return;
        }
        for face in limits.parts(faces).flatten() {
            let orientation = orientation_of_face[face];
            let side = &frames[side_of::<N, W>(orientation)];
            let own = slices.corners(face);
            let own = own.start - range.start..own.end - range.start;
            fill(&mut corners[own.clone()], vertices[own].iter().map(|&v| side[v as usize]));
        }
    });
}
