//! Frames of the corners that only degenerate triangles have: copies from good corners.
//!
//! A corner copies the first good corner at the same welded vertex, if there is one. The missing corner of a
//! quad with one good half copies the first corner of that half at the same position.
//!
//! Source: mikktspace.c, `DegenEpilogue`. We deviate: the reference searches the good corners linearly for
//! every degenerate one.

use crate::math::equal;
use crate::topology::triangles::{NONE, Triangles, Triangulation};
use crate::util::radix_sort::sort;

use crate::tangents::mikktspace::raw_frames::RawFrames;
use crate::tangents::mikktspace::welded_mesh::WeldedMesh;

/// A corner that only degenerate triangles have, and the source of its frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CornerCopy {
    /// The corner.
    pub corner: u32,
    /// The source of the frame.
    pub from: CopySource,
}

/// The good corner that is copied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CopySource {
    /// This corner: the first good one at the same welded vertex.
    Vertex(u32),
    /// The first of these corners that lies at the same position, if any does. They are the corners of the
    /// good half of the same quad.
    Half([u32; 3]),
}

/// Lists the copies in the order in which they are made.
pub fn copies(triangulation: &Triangulation) -> Vec<CornerCopy> {
    let Triangulation { good, degenerate, .. } = triangulation;
    let mut copies = Vec::new();
    if degenerate.len() == 0 {
        return copies;
    }
    let half_of_good_quad: Vec<bool> =
        degenerate.face.iter().map(|face| good.face.binary_search(face).is_ok()).collect();
    let first_good = first_good_corners(good, degenerate);
    for t in (0..degenerate.len()).filter(|&t| !half_of_good_quad[t]) {
        for (&corner, vertex) in degenerate.corners[t].iter().zip(&degenerate.vertices[t]) {
            let good = first_good[*vertex as usize];
            if good != NONE {
                copies.push(CornerCopy { corner, from: CopySource::Vertex(good) });
            }
        }
    }
    for t in (0..degenerate.len()).filter(|&t| half_of_good_quad[t]) {
        let Ok(half) = good.face.binary_search(&degenerate.face[t]) else { continue };
        let present = good.corners[half];
        let missing = degenerate.corners[t].into_iter().filter(|corner| !present.contains(corner));
        copies.extend(missing.map(|corner| CornerCopy { corner, from: CopySource::Half(present) }));
    }
    copies
}

/// Makes the copies. Returns the corners that were written, ascending.
pub(crate) fn fill_degenerate(
    triangulation: &Triangulation,
    welded: &WeldedMesh<'_>,
    raw: &mut RawFrames,
) -> Vec<u32> {
    let mut copied = Vec::new();
    for CornerCopy { corner, from } in copies(triangulation) {
        let is_at_same_position = |source: &u32| equal(welded.position(*source), welded.position(corner));
        let source = match from {
            CopySource::Vertex(good) => Some(good),
            CopySource::Half(present) => present.into_iter().find(is_at_same_position),
        };
        if let Some(source) = source {
            copy(raw, source, corner);
            copied.push(corner);
        }
    }
    sort(&mut copied);
    copied.dedup();
    copied
}

fn copy(raw: &mut RawFrames, source: u32, corner: u32) {
    raw.of_corner[corner as usize] = raw.of_corner[source as usize];
    raw.mean_of_corner[corner as usize] = raw.mean_of_corner[source as usize];
}

/// The first good corner at each welded vertex, or [`NONE`], for vertices up to the last one of degenerate
/// triangles.
fn first_good_corners(good: &Triangles, degenerate: &Triangles) -> Vec<u32> {
    let last = degenerate.vertices.as_flattened().iter().max();
    let mut first = vec![NONE; last.map_or(0, |&last| last as usize + 1)];
    for (&vertex, &corner) in good.vertices.as_flattened().iter().zip(good.corners.as_flattened()) {
        if let Some(free @ &mut NONE) = first.get_mut(vertex as usize) {
            *free = corner;
        }
    }
    first
}
