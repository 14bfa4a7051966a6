//! Faces whose corners carry both signs: finding them, and giving each face one sign.
//!
//! Signs mix on UV-degenerate faces, which have corners in groups of both orientations, and on degenerate ones, which copy corners
//! from faces of both. Shaders interpolate the sign, so on such a face the bitangent turns over somewhere in the middle.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use crate::triangles::Triangulation;
use crate::{Faces, Frame, Mesh};

use super::derivatives::Derivative;
use super::evaluate::RawFrames;
use super::repair::is_usable;

/// A face with both signs: its number and its corners.
pub(crate) type MixedFace = (u32, Range<usize>);

/// The supported faces whose corners carry both signs.
pub(crate) fn mixed_faces(mesh: &Mesh<'_>, frames: &[Frame]) -> Vec<MixedFace> {
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
    mixed: &[MixedFace],
    raw: &mut RawFrames,
) -> Vec<u32> {
    let mut wrong: HashMap<u32, f32> = HashMap::new();
    for (face, corners) in mixed {
        let sign = sign_of_face(triangulation, derivatives, copied, &raw.of_corner, *face, corners.clone());
        let corners = corners.clone().filter(|&corner| raw.of_corner[corner].sign != sign);
        wrong.extend(corners.map(|corner| (corner as u32, sign)));
    }
    let vertex_of_wrong = vertices(triangulation, &wrong);
    let sources = first_frames(mesh, triangulation, &raw.of_corner, &wrong, &vertex_of_wrong);
    let mut needs = Vec::new();
    for (&corner, &sign) in &wrong {
        raw.mean_of_corner.remove(&corner);
        let frame = &mut raw.of_corner[corner as usize];
        match sources.get(&(vertex_of_wrong[&corner], sign > 0.0)) {
            Some(source) => *frame = *source,
            None => {
                frame.sign = sign;
                needs.push(corner);
            }
        }
    }
    needs.sort_unstable();
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

/// The welded vertices of the corners in `wrong`.
fn vertices(triangulation: &Triangulation, wrong: &HashMap<u32, f32>) -> HashMap<u32, u32> {
    let mut vertices = HashMap::with_capacity(wrong.len());
    if wrong.is_empty() {
        return vertices;
    }
    for list in [&triangulation.good, &triangulation.degenerate] {
        let corners = list.corners.as_flattened().iter().zip(list.vertices.as_flattened());
        vertices.extend(corners.filter(|(corner, _)| wrong.contains_key(corner)));
    }
    vertices
}

/// The first usable frame of each wanted sign at each vertex where a corner of `wrong` wants one.
fn first_frames(
    mesh: &Mesh<'_>,
    triangulation: &Triangulation,
    frames: &[Frame],
    wrong: &HashMap<u32, f32>,
    vertex_of_wrong: &HashMap<u32, u32>,
) -> HashMap<(u32, bool), Frame> {
    let wanted: HashSet<(u32, bool)> =
        wrong.iter().map(|(corner, &sign)| (vertex_of_wrong[corner], sign > 0.0)).collect();
    let mut found = HashMap::with_capacity(wanted.len());
    if wanted.is_empty() {
        return found;
    }
    let good = &triangulation.good;
    for (&corner, &vertex) in good.corners.as_flattened().iter().zip(good.vertices.as_flattened()) {
        let frame = frames[corner as usize];
        let key = (vertex, frame.sign > 0.0);
        let normal = mesh.normals().get(mesh.vertex_of_corner(corner as usize));
        if wanted.contains(&key) && !found.contains_key(&key) && is_usable(frame.tangent, normal) {
            found.insert(key, frame);
        }
    }
    found
}
