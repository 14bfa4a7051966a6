//! The test of open rows: whether the fingerprint of a vertex is that of one vertex minus that of another.
//! The head of `fast.rs` says why this proves that all triangles around the vertex are one row.

use crate::tangents::fast::kernel::BLOCK_SIZE;
use crate::tangents::fast::proof::{difference, fingerprint, fingerprint_key};

/// Fingerprints of up to [`BLOCK_SIZE`] vertices that are tested for being the difference of two vertices, in
/// lanes. The head of `fast.rs` says how probable it is that the test is wrongly passed.
#[derive(Debug)]
pub(crate) struct OpenRows {
    fingerprint: [[u32; BLOCK_SIZE]; 4],
    /// The place of each vertex in its block.
    place: [u32; BLOCK_SIZE],
    /// 1 where the first candidate is confirmed, else 0.
    is_confirmed: [u32; BLOCK_SIZE],
    count: usize,
}

/// How many vertices are tested at once: few, because most blocks have few open rows.
const LANES: usize = if cfg!(small_limits) { 1 } else { 8 };

impl Default for OpenRows {
    fn default() -> Self {
        let zero = [0; BLOCK_SIZE];
        Self { fingerprint: [zero; 4], place: zero, is_confirmed: zero, count: 0 }
    }
}

impl OpenRows {
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// Adds a vertex to the test. At most [`BLOCK_SIZE`] are added between two calls of [`OpenRows::clear`].
    #[inline(always)]
    pub fn push(&mut self, place: usize, fingerprint: &[u32; 4]) {
        let at = self.count % BLOCK_SIZE;
        self.place[at] = place as u32;
        for (lane, &value) in self.fingerprint.iter_mut().zip(fingerprint) {
            lane[at] = value;
        }
        self.count += 1;
    }

    /// Calls `visit` with the places of the vertices that fail the test. `vertex_count`: the number of
    /// vertices of the mesh.
    #[inline(always)]
    pub fn for_each_failed(&mut self, vertex_count: u32, mut visit: impl FnMut(usize)) {
        if self.count == 0 {
            return;
        }
        let key = fingerprint_key();
        let chunks = self.fingerprint.each_ref().map(|lane| lane.as_chunks::<LANES>().0);
        let confirmed = self.is_confirmed.as_chunks_mut::<LANES>().0.iter_mut();
        for (at, confirmed) in confirmed.take(self.count.div_ceil(LANES)).enumerate() {
            let chunk = chunks.map(|lane| lane[at]);
            for (i, confirmed) in confirmed.iter_mut().enumerate() {
                let sum = [chunk[0][i], chunk[1][i], chunk[2][i], chunk[3][i]];
                let is_confirmed = is_difference_with(sum, first_candidate(sum), key);
                *confirmed = if is_confirmed { 1 } else { 0 };
            }
        }
        for i in 0..self.count.min(BLOCK_SIZE) {
            if self.is_confirmed[i] == 0 {
                let sum = [0, 1, 2, 3].map(|lane| self.fingerprint[lane][i]);
                if !has_later_candidate(sum, vertex_count) {
                    visit(self.place[i] as usize);
                }
            }
        }
    }
}

/// The least a + b for which a fingerprint can be that of vertex a minus that of vertex b. Unspecified where
/// a - b is zero.
///
/// The first lanes hold a - b and a^2 - b^2 modulo 2^32. Their quotient is a + b. A difference with factors
/// of two leaves further candidates.
#[inline(always)]
fn first_candidate([a_minus_b, of_squares, ..]: [u32; 4]) -> u32 {
    let twos = factors_of_two(a_minus_b);
    of_squares.wrapping_mul(inverse((a_minus_b as i32 >> twos) as u32)) >> twos
}

/// How many factors of two a number has; 31 for zero. The exponent of a float, because few processors count
/// zeros in lanes.
#[inline(always)]
fn factors_of_two(number: u32) -> u32 {
    let lowest_bit = number & number.wrapping_neg();
    ((lowest_bit as i32 as f32).to_bits() >> 23 & 0xff).wrapping_sub(127) & 31
}

/// True when `sum` is the fingerprint of vertex a minus that of vertex b, a + b being given.
#[inline(always)]
fn is_difference_with(sum: [u32; 4], a_plus_b: u32, key: [u32; 2]) -> bool {
    let (a, b) = (a_plus_b.wrapping_add(sum[0]) >> 1, a_plus_b.wrapping_sub(sum[0]) >> 1);
    let found = difference(fingerprint(a, key), fingerprint(b, key));
    (found[0] == sum[0]) & (found[1] == sum[1]) & (found[2] == sum[2]) & (found[3] == sum[3])
}

/// As [`is_difference_with`], for the candidates after the first that are sums of two vertices.
#[cold]
fn has_later_candidate(sum: [u32; 4], vertex_count: u32) -> bool {
    let (first, step) = (u64::from(first_candidate(sum)), 1 << (32 - factors_of_two(sum[0])));
    let later = (1..CANDIDATES).map(|n| first + n * step);
    let mut possible = later.take_while(|&a_plus_b| a_plus_b < 2 * u64::from(vertex_count));
    possible.any(|a_plus_b| is_difference_with(sum, a_plus_b as u32, fingerprint_key()))
}

/// How many values of a + b are tried; a vertex with more candidates is left to the general path.
const CANDIDATES: u64 = 64;

/// The inverse of an odd number modulo 2^32, by Newton's iteration: each step doubles the number of right
/// bits, 5 at the start.
#[inline(always)]
fn inverse(odd: u32) -> u32 {
    (0..3).fold(odd.wrapping_mul(3) ^ 2, |inverse, _| {
        inverse.wrapping_mul(2u32.wrapping_sub(odd.wrapping_mul(inverse)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_two(a: u32, b: u32) -> [u32; 4] {
        let key = fingerprint_key();
        difference(fingerprint(a, key), fingerprint(b, key))
    }

    fn is_difference_of_two(sum: [u32; 4], vertex_count: u32) -> bool {
        let (mut rows, mut passes) = (OpenRows::default(), true);
        rows.push(0, &sum);
        rows.for_each_failed(vertex_count, |_| passes = false);
        passes
    }

    #[test]
    fn a_difference_of_two_vertices_is_recognised() {
        let pairs = [(1_u32, 0), (0, 1), (7, 1_000_000_000), (70_000, 4_464), (1 << 24, (1 << 24) + 4096)];
        let multiples = (0..30).flat_map(|twos| [(1 << twos, 0), (5, (1 << twos) + 5)]);
        for (a, b) in pairs.into_iter().chain(multiples) {
            let step = 1u64 << (32 - a.abs_diff(b).trailing_zeros());
            if u64::from(a + b) / step < CANDIDATES {
                assert!(is_difference_of_two(of_two(a, b), a.max(b) + 1), "{a} - {b}");
            }
        }
    }

    #[test]
    fn a_difference_of_more_vertices_is_not() {
        let [first, second] = [of_two(10, 11), of_two(20, 25)];
        let both = std::array::from_fn(|lane| first[lane].wrapping_add(second[lane]));
        assert!(!is_difference_of_two(both, 26));
        assert!(!is_difference_of_two([0, 2, 3, 4], 26));
    }
}
