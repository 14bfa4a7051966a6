//! The tests that prove that all triangles around a vertex share one tangent. The head of `fast.rs` says why
//! they suffice.
//!
//! The kernel computes marks (bits that are OR-ed together) and a fingerprint (numbers that are added up) for
//! every corner of a triangle. [`sign_of_marks`], [`fan`] and `open_rows.rs` read the marks and the
//! fingerprint of a vertex to which all corners have been added.

use std::sync::OnceLock;

use crate::math::V3;
use crate::util::random::random_bits;

/// The sign of a vertex at which the tests fail: its tangent is left to the general path.
pub const UNDECIDED: f32 = 0.0;

/// Marks of corners, as bits. The marks of a vertex are the marks of all its corners, OR-ed together.
pub(crate) mod marks {
    /// One bit for each of the rays +u, -u, +v, -v that start at the vertex and lie in the corner's wedge in
    /// UV space.
    pub const RAYS: u32 = 0xf;
    /// The ray +u.
    pub const FIRST_RAY: u32 = 1;
    /// The shift of six bits for the tangent's direction in the plane of the normal: x, y, z not clearly
    /// positive, then x, y, z not clearly negative.
    pub const TANGENT: u32 = 8;
    /// The shift of the same six bits for the bitangent.
    pub const BITANGENT: u32 = 14;
    /// All six bits of a direction.
    pub const ALL_AXES: u32 = 0x3f;
    /// The triangle keeps the orientation of UV space.
    pub const PRESERVES: u32 = 1 << 20;
    /// The triangle reverses the orientation of UV space.
    pub const MIRRORS: u32 = 1 << 21;
    /// The triangle or the corner is one that the fast path does not decide.
    pub const NEEDS_GENERAL_PATH: u32 = 1 << 22;
    /// The triangle has no UV area: the reference starts no group with it. It has no orientation.
    pub const FLAT: u32 = 1 << 23;
}

/// The smallest ratio of a triangle's doubled UV area to the two products whose difference it is, at which
/// the sign of the area is certain.
///
/// Differences and products are right to 2^-24 each, three roundings per product and one for the sum: 2^-21
/// is twice that.
pub(crate) const MIN_AREA_RATIO: f32 = 1.0 / 2_097_152.0;

/// The smallest ratio of a direction's component to the direction's length at which the component counts as
/// clearly positive or clearly negative.
pub(crate) const CLEAR_COMPONENT: f32 = 1.0 / 16.0;

/// The six bits of a direction: which components are not above `clear`, then which are not below `-clear`.
#[inline(always)]
pub(crate) fn direction_marks(v: V3, clear: f32) -> u32 {
    let above = |x: f32, bit: u32| if x > clear { 0 } else { bit };
    let below = |x: f32, bit: u32| if x < -clear { 0 } else { bit };
    (above(v[0], 1) | above(v[1], 2) | above(v[2], 4)) | (below(v[0], 8) | below(v[1], 16) | below(v[2], 32))
}

/// The rays in the wedges of a triangle's three corners, in UV space.
#[inline(always)]
pub(crate) fn ray_marks([t0, t1, t2]: [[f32; 2]; 3], is_mirrored: bool) -> [u32; 3] {
    let flip = if is_mirrored { u32::MAX } else { 0 };
    let edges = [edge_sides(t0, t1), edge_sides(t1, t2), edge_sides(t2, t0)];
    [0, 1, 2].map(|k| {
        // The incoming edge is seen from its other end.
        let (after, before) = (edges[k] & 0xff, edges[(k + 2) % 3] >> 8);
        let (entered, left) = (after & !before, before & !after);
        let (up, down) = ((entered & !flip) | (left & flip), (left & !flip) | (entered & flip));
        (up & 5) | (down & 5) << 1
    })
}

/// Where the end of an edge lies, seen from its start: bit 0 below, bit 2 to the right. Bits 8 and 10 say the
/// same of the start, seen from the end.
#[inline(always)]
fn edge_sides(from: [f32; 2], to: [f32; 2]) -> u32 {
    let bit = |is: bool, bit: u32| if is { bit } else { 0 };
    (bit(to[1] < from[1], 1) | bit(to[0] > from[0], 4))
        | (bit(from[1] < to[1], 0x100) | bit(from[0] > to[0], 0x400))
}

/// 1 when the corner's wedge holds the ray +u, else 0.
#[inline(always)]
pub(crate) fn first_ray_count(marks: u32) -> f32 {
    if marks & marks::FIRST_RAY == 0 { 0.0 } else { 1.0 }
}

/// The random key of all fingerprints of this process. Without the key nobody can construct a mesh that
/// passes the tests wrongly.
pub(crate) fn fingerprint_key() -> [u32; 2] {
    static KEY: OnceLock<[u32; 2]> = OnceLock::new();
    *KEY.get_or_init(|| {
        let bits = random_bits();
        [bits as u32, (bits >> 32) as u32]
    })
}

/// The fingerprint of one vertex: its number, the square of the number, and two keyed hashes of it.
///
/// The high bits are folded over the low ones before the first product. It would drop them otherwise, and the
/// hashes of vertices whose numbers differ in high bits alone would cancel often: one of them for one key in
/// ten thousand where vertices are 2^20 apart.
#[inline(always)]
pub(crate) fn fingerprint(vertex: u32, key: [u32; 2]) -> [u32; 4] {
    let (first, second) = (vertex ^ key[0], vertex ^ key[1]);
    let first = (first ^ first >> 16).wrapping_mul(0x85eb_ca6b);
    let first = (first ^ first >> 15).wrapping_mul(0xc2b2_ae35);
    let second = (second ^ second >> 16).wrapping_mul(0x21f0_aaad);
    let second = (second ^ second >> 15).wrapping_mul(0xd35a_2d97);
    [vertex, vertex.wrapping_mul(vertex), first ^ first >> 16, second ^ second >> 15]
}

/// The difference of two fingerprints.
#[inline(always)]
pub(crate) fn difference(a: [u32; 4], b: [u32; 4]) -> [u32; 4] {
    [0, 1, 2, 3].map(|lane| a[lane].wrapping_sub(b[lane]))
}

/// The tangent sign of a vertex to which all corners have been added, if its triangles are one fan:
/// [`UNDECIDED`] where another test fails, NaN where the vertex has no triangle with UV area. Has no
/// branches, so that loops over vertices vectorise.
///
/// `found`: the vertex's marks. `is_usable`: the tangent needs no repair.
#[inline(always)]
pub(crate) fn sign_of_marks(found: u32, is_usable: bool) -> f32 {
    let has_axis = |shift: u32| found >> shift & marks::ALL_AXES != marks::ALL_AXES;
    let orientation = found & (marks::PRESERVES | marks::MIRRORS | marks::NEEDS_GENERAL_PATH);
    let sign = if found & marks::MIRRORS == 0 { 1.0 } else { -1.0 };
    let has_one_orientation = (orientation == marks::PRESERVES) | (orientation == marks::MIRRORS);
    let is_decided = is_usable & has_one_orientation & has_axis(marks::TANGENT) & has_axis(marks::BITANGENT);
    let sign = if is_decided { sign } else { UNDECIDED };
    if found & (marks::PRESERVES | marks::MIRRORS) == 0 { f32::NAN } else { sign }
}

/// True when the triangles have one orientation, and no two of them have opposite tangents or opposite
/// bitangents.
///
/// Two unit vectors whose components on one axis are both above 1/16 have a dot product above -1 + 2 / 256.
#[inline(always)]
pub(crate) fn is_one_subgroup(found: u32) -> bool {
    let orientation = found & (marks::PRESERVES | marks::MIRRORS | marks::NEEDS_GENERAL_PATH);
    let has_axis = |shift: u32| found >> shift & marks::ALL_AXES != marks::ALL_AXES;
    (orientation == marks::PRESERVES) | (orientation == marks::MIRRORS)
        && has_axis(marks::TANGENT) & has_axis(marks::BITANGENT)
}

/// Whether all triangles are connected by edges at a vertex.
///
/// An edge at the vertex that as many triangles leave along as come back along adds nothing to the
/// fingerprint. So the fingerprint is zero when all triangles lie in closed loops, and the difference of two
/// vertices when there is one open row besides. Every closed loop of triangles of one orientation turns about
/// the vertex in UV space at least once and crosses every ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fan {
    /// The triangles are one closed loop.
    Loop,
    /// They are one open row if the fingerprint is the difference of two vertices (see `open_rows.rs`).
    Row,
    /// They are several fans.
    Several,
}

/// The kind of a vertex's fan.
///
/// `found`: the vertex's marks. `first_ray_count`: how many wedges hold the ray +u. `fingerprint`: a
/// reference, because a copy on the stack, written in pieces and read as a whole, stalls the processor.
#[inline(always)]
pub(crate) fn fan(found: u32, first_ray_count: f32, fingerprint: &[u32; 4]) -> Fan {
    match *fingerprint == [0; 4] {
        true if first_ray_count == 1.0 => Fan::Loop,
        false if found & marks::RAYS != marks::RAYS => Fan::Row,
        _ => Fan::Several,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::util::random::random_bits;

    /// Vertices, with their signs, whose numbers and squares add up to zero for every distance between them,
    /// or modulo 2^32 for large ones.
    const CANCELLING: [&[(u32, bool)]; 3] = [
        &[(0, true), (3, true), (5, true), (6, true), (1, false), (2, false), (4, false), (7, false)],
        &[(0, true), (4, true), (5, true), (1, false), (2, false), (6, false)],
        &[(0, true), (3, true), (1, false), (2, false)],
    ];

    /// A lane of 32 random bits cancels once in 2^32 keys; without the fold, lanes cancelled for one key in
    /// 80 here.
    #[test]
    fn hashes_of_regular_vertices_do_not_cancel() {
        const KEYS: usize = if cfg!(debug_assertions) { 4_000 } else { 40_000 };
        let mut count_of_lane = [0; 2];
        for _ in 0..KEYS {
            let bits = random_bits();
            let key = [bits as u32, (bits >> 32) as u32];
            for (vertices, shift) in CANCELLING.iter().flat_map(|set| (0..28).map(move |shift| (set, shift)))
            {
                let sum = vertices.iter().fold([0; 4], |sum, &(number, is_added)| {
                    let found = fingerprint((number << shift) + 17, key);
                    if is_added { difference(sum, difference([0; 4], found)) } else { difference(sum, found) }
                });
                assert_eq!(sum[0], 0);
                for lane in 0..2 {
                    count_of_lane[lane] += usize::from(sum[2 + lane] == 0);
                }
            }
        }
        assert!(count_of_lane.iter().all(|&count| count <= 2), "{count_of_lane:?} of {}", KEYS * 84);
    }
}
