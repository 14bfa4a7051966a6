//! From sums to frames: one per side of a vertex, and from there to corners.
//!
//! A *side* is a vertex and a UV orientation: all triangles of that orientation at the vertex share its frame. So the sign of a face is
//! its orientation, the same at all its corners, and a vertex splits where both of its sides are used.

use std::collections::HashMap;

use crate::Frame;
use crate::Mesh;
use crate::Mode;
use crate::math::V3;

use crate::exec::limits::RunLimits;
use crate::exec::simd::Width;
use crate::exec::threads::{self, split_range, split_slice};
use crate::tangents::mesh_slices::MeshSlices;
use crate::tangents::mirrored_edges::{
    count_mirrored_edges, has_finite_normals, has_finite_vertices, survey_where, vertices_of_both,
};
use crate::tangents::output::{Output, fill};
use crate::tangents::repair::{
    across, direction, in_plane, mean_in_plane, perpendicular, u_direction_of, unit,
};
use crate::tangents::report::Report;
use crate::tangents::uv_derivatives::Orientation;
use crate::tangents::vertex_sums::frame_kernel::FrameBlock;
use crate::tangents::vertex_sums::frame_math::{
    cancels, direction_across, precise_direction_across, sign_of, sure_tangent,
};
use crate::tangents::vertex_sums::side_sums::SideSums;
use crate::tangents::vertex_sums::term_kernel::TERM_BLOCK;
use crate::tangents::vertex_sums::weighting::{SumRows, Weighting, adds};

/// A vertex and which of its sides: 0 keeps the UV orientation, 1 mirrors it.
type Side = (u32, usize);

/// Makes frames of sums, repairs those without a direction, and gives every corner its side's.
pub(crate) fn finish<const N: usize, W: Weighting<N>, O: Output>(
    mesh: &Mesh<'_>,
    flat: &MeshSlices<'_>,
    sums: &mut SideSums<N>,
    (mode, limits): (Mode, RunLimits<'_>),
    frames: &mut [Vec<O>; 2],
    corners: &mut [O],
) -> Report {
    // A triangle with a position or a UV that is not finite is flawed.
    let adds_all = flat.is_triangles() && sums.flaws.are_none();
    let is_finite =
        if adds_all { has_finite_normals(flat, limits) } else { has_finite_vertices(flat, limits) };
    let mut report = survey_where(mesh, flat, is_finite);
    report.degenerate_triangles = sums.flaws.degenerate;
    report.uv_degenerate_triangles = sums.flaws.uv_degenerate;
    let mut of_both = vertices_of_both(flat, &sums.orientation_of_face);
    if let Some(of_both) = &of_both {
        report.mirrored_edges = count_mirrored_edges(flat, &sums.orientation_of_face, of_both);
        report.merged_vertices = if W::SPLITS { 0 } else { count(of_both) };
    }
    let mut missing = frames_of_sides::<N, W, O>(flat, limits, sums, frames);
    decide_faces::<N, W>(flat, sums, &mut missing);
    missing.sort_unstable();
    missing.dedup();
    if mode != Mode::Reference && !missing.is_empty() {
        replace::<N, W, O>(flat, sums, &missing, frames);
    }
    report.repaired_corners = count_corners::<N, W>(flat, &sums.orientation_of_face, &missing);
    to_corners::<N, W, O>(flat, limits, &sums.orientation_of_face, frames, corners);
    if W::SPLITS {
        if !adds_all {
            of_both = vertices_of_both(flat, &sums.orientation_of_face);
        }
        report.split_vertices = of_both.map_or(0, |both| count(&both));
    } else if has_both_signs(&frames[0]) {
        report.mixed_sign_faces = count_mixed_faces(flat, corners);
    }
    report
}

fn count(of_vertex: &[bool]) -> usize {
    of_vertex.iter().filter(|is| **is).count()
}

/// The corners that have one of `sides`.
fn count_corners<const N: usize, W: Weighting<N>>(
    flat: &MeshSlices<'_>,
    orientation_of_face: &[Orientation],
    sides: &[Side],
) -> usize {
    if sides.is_empty() {
        return 0;
    }
    let mut listed = [vec![false; flat.positions.len()], vec![false; flat.positions.len()]];
    sides.iter().for_each(|&(v, side)| listed[side][v as usize] = true);
    let of_face = |(face, &orientation): (usize, &Orientation)| {
        let listed = &listed[side_of::<N, W>(orientation)];
        flat.vertex_of_corner[flat.corners(face)].iter().filter(|&&v| listed[v as usize]).count()
    };
    orientation_of_face.iter().enumerate().map(of_face).sum()
}

/// The side that the corners of a face have.
fn side_of<const N: usize, W: Weighting<N>>(orientation: Orientation) -> usize {
    usize::from(W::SPLITS && orientation == Orientation::Mirrors)
}

fn has_both_signs<O: Output>(frames: &[O]) -> bool {
    frames.iter().any(|frame| frame.tangent()[3] != frames[0].tangent()[3])
}

fn count_mixed_faces<O: Output>(flat: &MeshSlices<'_>, corners: &[O]) -> usize {
    let is_mixed = |face: &usize| {
        let corners = &corners[flat.corners(*face)];
        matches!(corners.len(), 3 | 4)
            && corners.iter().any(|corner| corner.tangent()[3] != corners[0].tangent()[3])
    };
    (0..flat.face_count()).filter(is_mixed).count()
}

/// Writes the frame of every side; returns the sides that have triangles but no direction.
fn frames_of_sides<const N: usize, W: Weighting<N>, O: Output>(
    flat: &MeshSlices<'_>,
    limits: RunLimits<'_>,
    sums: &SideSums<N>,
    frames: &mut [Vec<O>; 2],
) -> Vec<Side> {
    let threads = limits.thread_count(flat.triangles().len());
    let mut missing = vec![Vec::new(); threads];
    for (side, frames) in frames.iter_mut().enumerate() {
        let sums = &sums.of_side[side];
        frames.resize(sums.len(), O::EMPTY);
        let ranges = split_range(0..sums.len(), threads, 1);
        let jobs = ranges.clone().zip(split_slice(frames, 0, ranges));
        threads::run(&mut missing, jobs, |missing, (range, frames)| {
            let place = SideRange { first: range.start, side, width: limits.width };
            frames_of_side::<N, W, O>(&sums[range.clone()], &flat.normals[range], place, frames, missing);
        });
    }
    missing.concat()
}

/// Where consecutive sums are, and how wide vectors may be.
struct SideRange {
    first: usize,
    side: usize,
    width: Width,
}

fn frames_of_side<const N: usize, W: Weighting<N>, O: Output>(
    sums: &[SumRows<N>],
    normals: &[V3],
    SideRange { first, side, width }: SideRange,
    frames: &mut [O],
    missing: &mut Vec<Side>,
) {
    let sign = if side == 0 { 1.0 } else { -1.0 };
    let mut block = FrameBlock::new();
    let blocks = sums.chunks(TERM_BLOCK).zip(normals.chunks(TERM_BLOCK)).zip(frames.chunks_mut(TERM_BLOCK));
    for (first, ((sums, normals), frames)) in (first..).step_by(TERM_BLOCK).zip(blocks) {
        if !O::IS_FULL {
            block.set::<N, W>(sums, normals);
            block.evaluate::<N, W>(sign, width);
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

fn is_used<const N: usize>(sum: &SumRows<N>) -> bool {
    sum[0][3] > 0.0
}

/// The frame that a sum makes, if its tangent has a direction in the plane of the normal.
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

/// Gives every face without an orientation the one that more of its corners have triangles of, +1 on a tie, and adds the sides
/// that no triangle adds to, but a corner has, to `missing`.
fn decide_faces<const N: usize, W: Weighting<N>>(
    flat: &MeshSlices<'_>,
    sums: &mut SideSums<N>,
    missing: &mut Vec<Side>,
) {
    if sums.flaws.are_none() && flat.is_triangles() {
        return;
    }
    for face in 0..flat.face_count() {
        let orientation = sums.orientation_of_face[face];
        // Every corner of a triangle with an orientation has that triangle to add to its sum.
        if orientation != Orientation::None && flat.is_triangles() {
            continue;
        }
        let vertices = &flat.vertex_of_corner[flat.corners(face)];
        let used = |v: u32, side: usize| sums.of_side[side].get(v as usize).is_some_and(is_used);
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

/// Gives the sides of `missing`, which is sorted, what [`crate::tangents::repair`] gives corners: the mean of their triangles' tangents, all
/// weighted alike; their first triangle's own dP/du; a perpendicular of the normal; (1, 0, 0).
fn replace<const N: usize, W: Weighting<N>, O: Output>(
    flat: &MeshSlices<'_>,
    sums: &SideSums<N>,
    missing: &[Side],
    frames: &mut [Vec<O>; 2],
) {
    let triangles = triangles_around(flat, missing);
    for &(v, side) in missing {
        let sum = sums.of_side[side].get(v as usize).filter(|sum| is_used(sum));
        let normal = flat.normals[v as usize];
        let own_normal = || sum.map_or(normal, W::own_normal);
        let normal = if direction(normal).is_some() { normal } else { own_normal() };
        let around = triangles.get(&v).map_or(&[][..], Vec::as_slice);
        let sign = if side == 0 { 1.0 } else { -1.0 };
        let tangent = replacement::<N, W>(flat, &sums.orientation_of_face, around, normal, side);
        let magnitude = sum.map_or([1.0; 2], |sum| W::magnitude(sum));
        let magnitude = magnitude.map(|x| if x.is_finite() { x } else { 1.0 });
        let bitangent = across(normal, tangent, sign);
        frames[side][v as usize] = O::from_frame(&Frame { tangent, bitangent, magnitude, sign });
    }
}

fn replacement<const N: usize, W: Weighting<N>>(
    flat: &MeshSlices<'_>,
    orientation_of_face: &[Orientation],
    around: &[u32],
    normal: V3,
    side: usize,
) -> V3 {
    let Some(unit_normal) = direction(normal) else { return [1.0, 0.0, 0.0] };
    let is_of_side = |t: u32| !W::SPLITS || orientation_of_face[flat.face(t as usize)] as usize == side;
    let own = |t: u32| {
        let (positions, uvs) = flat.values(t as usize);
        unit(u_direction_of(positions, uvs))
    };
    let counted = around.iter().filter(|&&t| is_of_side(t) && adds::<N, W>(flat, t as usize));
    let directions = counted.filter_map(|&t| own(t));
    let mean = mean_in_plane(directions.map(|direction| direction.map(|x| x as f32)), normal);
    let first = || around.first().and_then(|&t| in_plane(own(t)?, unit_normal));
    let found = mean.map(|mean| mean.map(f64::from)).or_else(first);
    found.unwrap_or_else(|| perpendicular(unit_normal)).map(|x| x as f32)
}

/// The triangles around each vertex of `sides`.
fn triangles_around(flat: &MeshSlices<'_>, sides: &[Side]) -> HashMap<u32, Vec<u32>> {
    let mut around: HashMap<u32, Vec<u32>> = sides.iter().map(|&(v, _)| (v, Vec::new())).collect();
    let mut wanted = vec![false; flat.positions.len()];
    sides.iter().for_each(|&(v, _)| wanted[v as usize] = true);
    for (corner, &v) in flat.triangles().as_flattened().iter().enumerate() {
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
    flat: &MeshSlices<'_>,
    limits: RunLimits<'_>,
    orientation_of_face: &[Orientation],
    frames: &[Vec<O>; 2],
    corners: &mut [O],
) {
    let threads = limits.thread_count(flat.triangles().len());
    let ranges = split_range(0..flat.face_count(), threads, 1);
    let corners = split_slice(corners, 0, ranges.clone().map(|faces| flat.corners_of(faces)));
    threads::run(&mut vec![(); threads], ranges.zip(corners), |(), (faces, corners)| {
        let range = flat.corners_of(faces.clone());
        let vertices = &flat.vertex_of_corner[range.clone()];
        if frames[1].is_empty() {
            fill(corners, vertices.iter().map(|&v| frames[0][v as usize]));
            return;
        }
        for (face, &orientation) in faces.clone().zip(&orientation_of_face[faces]) {
            let side = &frames[side_of::<N, W>(orientation)];
            let own = flat.corners(face);
            let own = own.start - range.start..own.end - range.start;
            fill(&mut corners[own.clone()], vertices[own].iter().map(|&v| side[v as usize]));
        }
    });
}
