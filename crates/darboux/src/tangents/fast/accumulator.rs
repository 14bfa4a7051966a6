//! One cache line per vertex: what it is, and what its corners add up to.

#![allow(clippy::needless_range_loop, reason = "loops over lanes vectorise as they are written")]

use crate::topology::weld::Bounds;

use crate::tangents::fast::kernel::{BLOCK, Block, Record, fingerprint, key, marks};

/// A welded vertex.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub(crate) struct Vertex {
    pub record: Record,
    /// The sum of weighted tangents, and how often wedges hold the first ray; once finished the tangent and the sign.
    pub sum: [f32; 4],
    /// The sum of the corners' fingerprints.
    pub print: [u32; 4],
}

/// The sign of a vertex whose tangents are not known here.
pub const UNDECIDED: f32 = 0.0;

/// What signs are multiplied with where the vertex lies in the tail's cells; 0 becomes -0.
pub(crate) const IN_TAIL: f32 = -2.0;

impl Vertex {
    /// Nothing added yet.
    #[inline(always)]
    pub fn clear(&mut self) {
        self.sum = [0.0; 4];
        self.print = [0; 4];
    }

    /// The sign of a vertex all of whose corners have been added: [`UNDECIDED`] unless the triangles are certainly one
    /// subgroup and the tangent is usable; NaN where no triangle uses the vertex.
    #[inline(always)]
    pub fn sign(&self, found: u32, is_usable: bool) -> f32 {
        let decided = is_usable & is_one_subgroup(found) && is_one_fan(found, self.sum[3], self.print);
        let sign = match found & (marks::PRESERVES | marks::MIRRORS) {
            0 => f32::NAN,
            _ if !decided => UNDECIDED,
            marks::MIRRORS => -1.0,
            _ => 1.0,
        };
        if found & marks::IN_TAIL != 0 { sign * IN_TAIL } else { sign }
    }

    pub fn position(&self) -> [f32; 3] {
        let [x, y, z, ..] = self.record;
        [x, y, z]
    }
}

/// Vertices that no triangle uses.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Unused {
    /// Those that were not even read.
    pub unseen: usize,
    pub count: usize,
    bounds: Option<Bounds>,
}

impl Unused {
    #[cold]
    pub fn note(&mut self, position: [f32; 3]) {
        let bounds = self.bounds.unwrap_or(Bounds { min: position, max: position });
        self.bounds = Some(Bounds::of(bounds.min, [bounds.max, position].into_iter()));
        self.count += 1;
    }

    /// True when all vertices that were read lie inside the bounds of all, which are then those of the used ones.
    pub fn are_inside(&self, all: &Bounds) -> bool {
        let inside =
            |bounds: Bounds| (0..3).all(|i| bounds.min[i] > all.min[i] && bounds.max[i] < all.max[i]);
        self.bounds.is_none_or(inside)
    }
}

/// Copies the records of the vertices of a block's first `count` triangles.
#[inline(always)]
pub(crate) fn gather(block: &mut Block, count: usize, vertices: &[Vertex]) {
    for k in 0..3 {
        for i in 0..count.min(BLOCK) {
            let [a, b, c, d, e, f, g, h] = vertices[block.vertex[k][i] as usize].record;
            block.packed[k][0][i] = [a, b, c, d];
            block.packed[k][1][i] = [e, f, g, h];
        }
    }
}

/// Adds a block's first `count` triangles to those of their vertices that are in `vertices`, whose first is number `first`, in order.
#[inline(always)]
pub(crate) fn scatter(block: &Block, count: usize, first: u32, vertices: &mut [Vertex], marks: &mut [u32]) {
    let marks = &mut marks[..vertices.len()];
    for i in 0..count.min(BLOCK) {
        for k in 0..3 {
            let at = block.vertex[k][i].wrapping_sub(first) as usize;
            let Some(vertex) = vertices.get_mut(at) else { continue };
            for lane in 0..4 {
                vertex.sum[lane] += block.sum[k][i][lane];
            }
            for lane in 0..4 {
                vertex.print[lane] = vertex.print[lane].wrapping_add(block.print[k][i][lane]);
            }
            marks[at] |= block.marks[k][i];
        }
    }
}

/// As [`scatter`], the sums alone.
#[inline(always)]
pub(crate) fn scatter_sums(block: &Block, count: usize, vertices: &mut [Vertex]) {
    for i in 0..count.min(BLOCK) {
        for k in 0..3 {
            let vertex = &mut vertices[block.vertex[k][i] as usize];
            for lane in 0..4 {
                vertex.sum[lane] += block.sum[k][i][lane];
            }
        }
    }
}

/// True when the triangles have one orientation, and no two of them opposite tangents or bitangents.
///
/// Two unit vectors whose components on one axis are above 1/16 have a dot product above -1 + 2 / 256.
#[inline(always)]
fn is_one_subgroup(found: u32) -> bool {
    let orientation = found & (marks::PRESERVES | marks::MIRRORS | marks::TROUBLE);
    let has_axis = |shift: u32| found >> shift & marks::ALL_AXES != marks::ALL_AXES;
    (orientation == marks::PRESERVES) | (orientation == marks::MIRRORS)
        && has_axis(marks::TANGENT) & has_axis(marks::BITANGENT)
}

/// True when all triangles are joined by edges at the vertex, but for a chance below 2^-64.
///
/// An edge at the vertex that as many triangles leave along as come back along leaves nothing in the fingerprint. So it is zero
/// when all triangles lie in closed loops, and a difference of two vertices when there is one open row besides. Every closed
/// loop of triangles of one orientation turns once or more about the vertex in UV space and meets every ray on its way.
#[inline(always)]
fn is_one_fan(found: u32, turns: f32, print: [u32; 4]) -> bool {
    if print == [0; 4] {
        turns == 1.0
    } else {
        found & marks::RAYS != marks::RAYS && is_difference_of_two(print)
    }
}

/// True when a fingerprint is that of one vertex less that of another.
///
/// The first lanes hold a - b and a^2 - b^2 modulo 2^32, the second divided by the first is a + b, and both give a and b; the
/// other lanes then confirm them. A difference with many factors of two leaves several candidates.
fn is_difference_of_two(print: [u32; 4]) -> bool {
    let key = key();
    let difference = i64::from(print[0] as i32);
    if difference == 0 {
        return false;
    }
    let twos = difference.trailing_zeros();
    let first_sum = u64::from(print[1].wrapping_mul(inverse((difference >> twos) as u32)) >> twos);
    let mut sums = (0..CANDIDATES).map(|n| (first_sum + (n << (32 - twos))) as i64);
    sums.any(|sum| {
        let (a, b) = ((sum + difference) / 2, (sum - difference) / 2);
        let (Ok(a), Ok(b)) = (u32::try_from(a), u32::try_from(b)) else { return false };
        let (a, b) = (fingerprint(a, key), fingerprint(b, key));
        (0..4).all(|lane| a[lane].wrapping_sub(b[lane]) == print[lane])
    })
}

/// How many sums are tried; beyond, the vertex is left to the general path.
const CANDIDATES: u64 = 64;

/// The inverse of an odd number modulo 2^32 (Newton's iteration; each step doubles the right bits, of which an odd number's own are 3).
fn inverse(odd: u32) -> u32 {
    (0..4).fold(odd, |inverse, _| inverse.wrapping_mul(2u32.wrapping_sub(odd.wrapping_mul(inverse))))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn less(a: u32, b: u32) -> [u32; 4] {
        let (a, b) = (fingerprint(a, key()), fingerprint(b, key()));
        std::array::from_fn(|lane| a[lane].wrapping_sub(b[lane]))
    }

    #[test]
    fn a_difference_of_two_vertices_is_recognised() {
        for (a, b) in [(1, 0), (0, 1), (7, 1_000_000_000), (70_000, 4_464), (1 << 24, (1 << 24) + 4096)] {
            assert!(is_difference_of_two(less(a, b)), "{a} - {b}");
        }
    }

    #[test]
    fn a_difference_of_more_vertices_is_not() {
        let [first, second] = [less(10, 11), less(20, 25)];
        let both = std::array::from_fn(|lane| first[lane].wrapping_add(second[lane]));
        assert!(!is_difference_of_two(both));
    }
}
