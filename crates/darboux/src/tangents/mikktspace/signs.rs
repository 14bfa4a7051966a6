//! Faces whose corners carry both signs: finding them, and giving each face one sign.
//!
//! Signs mix on UV-degenerate faces, which have corners in groups of both orientations, and on degenerate ones, which copy corners
//! from faces of both. Shaders interpolate the sign, so on such a face the bitangent turns over somewhere in the middle.

use std::ops::Range;

use crate::Faces;
use crate::Frame;
use crate::Mesh;
use crate::topology::corner_lookup::CornerLookup;
use crate::topology::triangles::Triangulation;
use crate::util::hash_map::InsertionMap;

use crate::tangents::mikktspace::derivatives::Derivative;
use crate::tangents::mikktspace::raw_frames::RawFrames;
use crate::tangents::repair::is_usable;

/// A face with both signs: its number and its corners.
pub(crate) type MixedSignFace = (u32, Range<usize>);

/// The supported faces whose corners carry both signs.
pub(crate) fn mixed_faces(mesh: &Mesh<'_>, frames: &[Frame]) -> Vec<MixedSignFace> {
    let mut mixed = Vec::new();
    let mut end = 0;
    for face in 0..mesh.face_count() {
        let start = end;
        end += match mesh.faces() {
            Faces::Triangles => 3,
            Faces::Quads => 4,
            Faces::Mixed(sizes) => sizes[face] as usize,
        };
        if frames[start..end].windows(2).any(|pair| pair[0].sign != pair[1].sign) {
            mixed.push((face as u32, start..end));
        }
    }
    mixed
}

/// Gives every face of `mixed` one sign, and returns the corners that need a repair for it, ascending.
///
/// The sign is that of the face's orientation; on degenerate faces the majority of the corners that were `copied`, a tie +1. A
/// corner of the other sign takes the first usable frame of that sign at its welded vertex, if there is one.
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
    let places = CornerLookup::new(triangulation, mesh.corner_count());
    let vertex = |corner: u32| places.of(corner).map_or(corner, |place| place.vertex);
    let mut sources = InsertionMap::new();
    wrong.iter().for_each(|&(corner, sign)| _ = sources.first(&key(vertex(corner), sign), || None));
    find_first_frames(mesh, triangulation, &raw.of_corner, &mut sources);
    let mut needs = Vec::new();
    for (corner, sign) in wrong {
        raw.mean_of_corner[corner as usize] = [0.0; 3];
        let frame = &mut raw.of_corner[corner as usize];
        match sources.get(&key(vertex(corner), sign)) {
            Some(Some(source)) => *frame = *source,
            _ => {
                frame.sign = sign;
                needs.push(corner);
            }
        }
    }
    needs
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
    if let Some(decisive) = halves.iter().find(|half| !half.any).or(halves.first()) {
        return if decisive.preserves { 1.0 } else { -1.0 };
    }
    let copied = corners.filter(|&corner| copied.binary_search(&(corner as u32)).is_ok());
    let balance: f32 = copied.map(|corner| frames[corner].sign).sum();
    if balance >= 0.0 { 1.0 } else { -1.0 }
}

/// What frames are looked for by: a welded vertex and a sign.
fn key(vertex: u32, sign: f32) -> [u32; 2] {
    [vertex, (sign > 0.0).into()]
}

/// Finds the first usable frame of each vertex and sign that are asked for.
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
