//! Faces whose corners have both signs: finds them, and unifies their signs
//! ([`Mode::Corrected`](crate::Mode::Corrected)).
//!
//! UV-degenerate faces have corners in groups of both orientations, and degenerate faces copy corners of both
//! orientations. A shader interpolates the sign, so that the bitangent of such a face flips somewhere inside
//! it.

use std::ops::Range;

use crate::Frame;
use crate::Mesh;
use crate::topology::corner_lookup::CornerLookup;
use crate::topology::triangles::Triangulation;
use crate::util::hash_map::InsertionMap;

use crate::tangents::mikktspace::derivatives::Derivative;
use crate::tangents::mikktspace::raw_frames::RawFrames;
use crate::tangents::repair::is_usable;

/// A face whose corners have both signs: its number and its corners.
pub(crate) type MixedSignFace = (u32, Range<usize>);

/// Finds the faces whose corners have both signs.
pub(crate) fn mixed_sign_faces(mesh: &Mesh<'_>, frames: &[Frame]) -> Vec<MixedSignFace> {
    let is_mixed = |(_, corners): &MixedSignFace| {
        frames[corners.clone()].windows(2).any(|pair| pair[0].sign != pair[1].sign)
    };
    (0..).zip(mesh.face_ranges()).filter(is_mixed).collect()
}

/// Sets one sign for every face of `mixed`. Returns the corners that need a repair afterwards, ascending.
///
/// The sign is that of the face's orientation; on degenerate faces it is the majority of the `copied`
/// corners, +1 on a tie. A corner of the other sign takes the first usable frame of the right sign at its
/// welded vertex. If there is none, it needs a repair.
pub(crate) fn unify_signs(
    mesh: &Mesh<'_>,
    triangulation: &Triangulation,
    derivatives: &[Derivative],
    copied: &[u32],
    mixed: &[MixedSignFace],
    raw: &mut RawFrames,
) -> Vec<u32> {
    if mixed.is_empty() {
        return Vec::new();
    }
    let mut wrong: Vec<(u32, f32)> = Vec::new();
    for (face, corners) in mixed {
        let sign = sign_of_face(triangulation, derivatives, copied, &raw.of_corner, *face, corners.clone());
        let corners = corners.clone().filter(|&corner| raw.of_corner[corner].sign != sign);
        wrong.extend(corners.map(|corner| (corner as u32, sign)));
    }
    let lookup = CornerLookup::new(triangulation, mesh.corner_count());
    let vertex = |corner: u32| lookup.get(corner).map_or(corner, |origin| origin.vertex);
    let mut sources = InsertionMap::new();
    for &(corner, sign) in &wrong {
        sources.get_or_insert_with(&key(vertex(corner), sign), || None);
    }
    find_first_frames(mesh, triangulation, &raw.of_corner, &mut sources);
    let mut unrepaired = Vec::new();
    for (corner, sign) in wrong {
        raw.mean_of_corner[corner as usize] = [0.0; 3];
        let frame = &mut raw.of_corner[corner as usize];
        match sources.get(&key(vertex(corner), sign)) {
            Some(Some(source)) => *frame = *source,
            _ => {
                frame.sign = sign;
                unrepaired.push(corner);
            }
        }
    }
    unrepaired
}

fn sign_of_face(
    triangulation: &Triangulation,
    derivatives: &[Derivative],
    copied: &[u32],
    frames: &[Frame],
    face: u32,
    corners: Range<usize>,
) -> f32 {
    let faces = &triangulation.good.face;
    let first = faces.partition_point(|&other| other < face);
    let halves = &derivatives[first..faces.partition_point(|&other| other <= face)];
    if let Some(decisive) = halves.iter().find(|half| !half.joins_any).or(halves.first()) {
        return if decisive.preserves { 1.0 } else { -1.0 };
    }
    let copied = corners.filter(|&corner| copied.binary_search(&(corner as u32)).is_ok());
    let balance: f32 = copied.map(|corner| frames[corner].sign).sum();
    if balance >= 0.0 { 1.0 } else { -1.0 }
}

/// The key of a frame: its welded vertex and its sign.
fn key(vertex: u32, sign: f32) -> [u32; 2] {
    [vertex, (sign > 0.0).into()]
}

/// Sets every value of `sources` to the first usable frame of its key.
fn find_first_frames(
    mesh: &Mesh<'_>,
    triangulation: &Triangulation,
    frames: &[Frame],
    sources: &mut InsertionMap<Option<Frame>>,
) {
    let good = &triangulation.good;
    for (&corner, &vertex) in good.corners.as_flattened().iter().zip(good.vertices.as_flattened()) {
        let frame = frames[corner as usize];
        let normal = mesh.normals().get(mesh.vertex_of_corner(corner as usize));
        if let Some(source @ None) = sources.get(&key(vertex, frame.sign))
            && is_usable(frame.tangent, normal)
        {
            *source = Some(frame);
        }
    }
}
