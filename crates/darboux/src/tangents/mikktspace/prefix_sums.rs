//! Sums of a list without some of its terms: bit for bit what adding the others one by one gives, without adding all of them.
//!
//! Let P be the prefix sum of all terms, and R the sum of the terms before the same index without the excluded ones. If P and R have the
//! same sign and exponent, they differ by a whole number d of ulps. Adding the next term to both keeps that difference, because rounding to
//! a multiple of an ulp commutes with adding d ulps, with two exceptions:
//! - P was rounded from a tie, to the even neighbour. With an odd d, R is rounded from a tie in the other direction, also to its even
//!   neighbour: d changes by one and is even from there on, so that no later tie changes it;
//! - R leaves the exponent, where ulps have another size.
//!
//! So we store per block of terms the range of offsets that keep R in the exponent, and the change of odd offsets at the first tie:
//!
//! ```text
//! block: max_below, max_above = distance of P's extremes to the ends of their exponent, in ulps
//!        tie_shift = +1 if P's first tie was rounded down, -1 if up, 0 without a tie
//! sum_without(excluded):
//!     R = P before the first excluded term
//!     between excluded terms, from each index on:
//!         d = ulps between R and P
//!         take the longest block whose range contains d: R = P at the block's end + d ulps, + tie_shift if d is odd
//!         otherwise add one term to R
//! ```
//!
//! R = P (d = 0) is in the range of every block.

use std::ops::Range;

/// The number of lanes of a term.
pub(crate) const LANES: usize = 12;

/// A term, or a sum of terms.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TermLanes(pub [f32; LANES]);

/// The number of terms in the shortest blocks.
const SHORTEST: usize = 8;
/// The number of blocks that make one block of the next level.
const RADIX: usize = 4;

/// A list of terms, its prefix sums and its blocks.
#[derive(Debug, Default)]
pub(crate) struct PrefixSums {
    /// `None` where a member adds nothing, not even a zero.
    terms: Vec<Option<TermLanes>>,
    /// `sums[n]` is the sum of the first `n` terms.
    sums: Vec<TermLanes>,
    /// The blocks of each level, built when the first term is excluded. Block `i` of a level begins at term `i` times its length.
    levels: Vec<Vec<SkipBlock>>,
}

impl PrefixSums {
    /// Replaces the list.
    pub fn load(&mut self, terms: impl Iterator<Item = Option<TermLanes>>) {
        self.terms.clear();
        self.sums.clear();
        self.levels.clear();
        let mut sum = TermLanes::default();
        self.sums.push(sum);
        for term in terms {
            sum.add(&term);
            self.terms.push(term);
            self.sums.push(sum);
        }
    }

    /// True when there is a term at index `at`.
    pub fn has_term(&self, at: usize) -> bool {
        self.terms[at].is_some()
    }

    fn build_blocks(&mut self) {
        let shortest = |(at, terms): (usize, &[Option<TermLanes>])| {
            SkipBlock::new(&self.sums[at * SHORTEST..=(at + 1) * SHORTEST], terms)
        };
        let mut blocks: Vec<_> = self.terms.chunks_exact(SHORTEST).enumerate().map(shortest).collect();
        while !blocks.is_empty() {
            let longer = blocks.chunks_exact(RADIX).map(SkipBlock::merged).collect();
            self.levels.push(std::mem::replace(&mut blocks, longer));
        }
    }

    /// The sum of all terms but those in `excluded`, whose ranges ascend and are disjoint.
    pub fn sum_without(&mut self, excluded: &[Range<usize>]) -> TermLanes {
        let Some(first) = excluded.first() else { return self.sums[self.terms.len()] };
        if self.levels.is_empty() {
            self.build_blocks();
        }
        let mut sum = self.sums[first.start];
        let ends = excluded.iter().skip(1).map(|next| next.start).chain([self.terms.len()]);
        for (gap, end) in excluded.iter().zip(ends) {
            self.add_range(&mut sum, gap.end..end);
        }
        sum
    }

    /// Adds the terms of a range to `sum`.
    fn add_range(&self, sum: &mut TermLanes, range: Range<usize>) {
        let mut at = range.start;
        while at < range.end {
            let end = self.skip(sum, at, range.end);
            if end == at {
                sum.add(&self.terms[at]);
                at += 1;
            } else {
                at = end;
            }
        }
    }

    /// Adds the longest block that begins at `at`, ends by `limit` and allows the offset of `sum`. Returns its end, or `at`.
    fn skip(&self, sum: &mut TermLanes, at: usize, limit: usize) -> usize {
        let (mut longest, mut length) = (None, SHORTEST);
        if !at.is_multiple_of(length) || at + length > limit {
            return at;
        }
        let offsets = sum.ulps_from(&self.sums[at]);
        for blocks in &self.levels {
            if !at.is_multiple_of(length) || at + length > limit || !blocks[at / length].allows(&offsets) {
                break;
            }
            longest = Some((&blocks[at / length], at + length));
            length *= RADIX;
        }
        let Some((block, end)) = longest else { return at };
        *sum = self.sums[end].plus_ulps(&block.shifted(&offsets));
        end
    }
}

impl TermLanes {
    #[inline]
    fn add(&mut self, term: &Option<TermLanes>) {
        if let Some(term) = term {
            for (sum, term) in self.0.iter_mut().zip(&term.0) {
                *sum += term;
            }
        }
    }

    /// The difference to `other` in ulps, per lane. Meaningful where sign and exponent are equal.
    #[inline]
    fn ulps_from(&self, other: &TermLanes) -> [i32; LANES] {
        std::array::from_fn(|lane| self.0[lane].to_bits().wrapping_sub(other.0[lane].to_bits()).cast_signed())
    }

    #[inline]
    fn plus_ulps(&self, offsets: &[i32; LANES]) -> TermLanes {
        TermLanes(std::array::from_fn(|lane| {
            f32::from_bits(self.0[lane].to_bits().wrapping_add(offsets[lane].cast_unsigned()))
        }))
    }
}

/// What happens to ulp offsets from the prefix sums over a block, per lane.
#[derive(Clone, Copy, Debug)]
struct SkipBlock {
    /// The largest allowed negative offset, as a positive number.
    max_below: [i32; LANES],
    /// The largest allowed positive offset.
    max_above: [i32; LANES],
    /// The change of odd offsets at the first tie, or 0.
    tie_shift: [i32; LANES],
}

impl SkipBlock {
    fn new(sums: &[TermLanes], terms: &[Option<TermLanes>]) -> Self {
        let mut block = Self { max_below: [0; LANES], max_above: [0; LANES], tie_shift: [0; LANES] };
        for lane in 0..LANES {
            let steps = sums
                .windows(2)
                .zip(terms)
                .filter_map(|(sums, term)| term.map(|term| [sums[0].0[lane], term.0[lane], sums[1].0[lane]]));
            let bits = |sum: &TermLanes| sum.0[lane].to_bits();
            let (least, most) = (sums.iter().map(bits).min(), sums.iter().map(bits).max());
            let (Some(least), Some(most)) = (least, most) else { continue };
            if least >> 23 != most >> 23 || !f32::from_bits(least).is_normal() {
                continue;
            }
            // One ulp less than the distance, because a tie may shift the offset; and one ulp less below, because a sum with fraction zero
            // can be rounded from below, where ulps are smaller.
            block.max_below[lane] = ((least & FRACTION).cast_signed() - 2).max(0);
            block.max_above[lane] = ((FRACTION - (most & FRACTION)).cast_signed() - 1).max(0);
            let shifts = steps.into_iter().map(|[before, term, after]| tie_shift(before, term, after));
            block.tie_shift[lane] = shifts.into_iter().find(|&shift| shift != 0).unwrap_or(0);
        }
        block
    }

    fn merged(parts: &[SkipBlock]) -> Self {
        let mut all = parts[0];
        for part in &parts[1..] {
            for lane in 0..LANES {
                all.max_below[lane] = all.max_below[lane].min(part.max_below[lane]);
                all.max_above[lane] = all.max_above[lane].min(part.max_above[lane]);
                if all.tie_shift[lane] == 0 {
                    all.tie_shift[lane] = part.tie_shift[lane];
                }
            }
        }
        all
    }

    /// The offsets at the end of the block.
    #[inline]
    fn shifted(&self, offsets: &[i32; LANES]) -> [i32; LANES] {
        std::array::from_fn(|lane| offsets[lane] + (offsets[lane] & 1) * self.tie_shift[lane])
    }

    /// No branches, so that it vectorises.
    #[inline]
    fn allows(&self, offsets: &[i32; LANES]) -> bool {
        (0..LANES).fold(true, |all, lane| {
            let d = offsets[lane];
            all & (-self.max_below[lane] <= d) & (d <= self.max_above[lane])
        })
    }
}

/// The fraction bits of an `f32`.
const FRACTION: u32 = 0x7f_ffff;

/// The change of an odd offset where `before + term` lay halfway between `after`, its rounded value, and another float of the same
/// exponent: +1 where the magnitude was rounded down, -1 where it was rounded up. 0 without a tie.
///
/// The rounding error is exact (D. E. Knuth, "The Art of Computer Programming", volume 2, theorem 4.2.2 B).
fn tie_shift(before: f32, term: f32, after: f32) -> i32 {
    let added = after - before;
    let error = (before - (after - added)) + (term - added);
    let ulp = f32::from_bits(after.to_bits() & !FRACTION | 1) - f32::from_bits(after.to_bits() & !FRACTION);
    let is_tie = 2.0 * error.abs() == ulp.abs();
    let was_rounded_down = error.is_sign_positive() == after.is_sign_positive();
    if !is_tie {
        0
    } else if was_rounded_down {
        1
    } else {
        -1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number in [-1, 1) with `bits` binary digits.
    fn number(state: &mut u32, bits: u32) -> f32 {
        *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (*state >> (32 - bits)) as f32 / (1u32 << (bits - 1)) as f32 - 1.0
    }

    /// Lanes whose sums grow, stay near zero, or are mostly ties.
    fn terms(state: &mut u32, count: usize) -> Vec<Option<TermLanes>> {
        let lane = |state: &mut u32, lane: usize| match lane % 4 {
            0 => 1.0 + 0.1 * number(state, 23),
            1 => number(state, 24),
            2 => number(state, 5) + 1.0 + f32::EPSILON * number(state, 3),
            _ => 0.0,
        };
        let term = |at: usize| (at % 7 != 3).then(|| TermLanes(std::array::from_fn(|n| lane(state, n))));
        (0..count).map(term).collect()
    }

    #[test]
    fn sums_are_those_of_adding_one_by_one() {
        let mut state = 1;
        let mut sums = PrefixSums::default();
        for count in [1, 8, 31, 300, 3000] {
            let terms = terms(&mut state, count);
            sums.load(terms.iter().copied());
            for _ in 0..300 {
                let start = ((number(&mut state, 16) + 1.0) * 0.5 * count as f32) as usize;
                let gaps = [start..start + 1, start + 2..start + 4];
                let excluded: Vec<_> = gaps.into_iter().filter(|gap| gap.end <= count).collect();
                let is_included = |at: &usize| excluded.iter().all(|gap| !gap.contains(at));
                let mut expected = TermLanes::default();
                (0..count).filter(is_included).for_each(|at| expected.add(&terms[at]));
                let found = sums.sum_without(&excluded);
                assert_eq!(found.0.map(f32::to_bits), expected.0.map(f32::to_bits), "{count}, {excluded:?}");
            }
        }
    }

    #[test]
    fn blocks_are_skipped() {
        let mut sums = PrefixSums::default();
        sums.load((0..4096).map(|at| Some(TermLanes([1.0 + 0.01 * (at as f32).sin(); LANES]))));
        sums.build_blocks();
        let mut sum = sums.sums[2560].plus_ulps(&[16; LANES]);
        assert_eq!(sums.skip(&mut sum, 2560, 4096), 3072);
    }
}
