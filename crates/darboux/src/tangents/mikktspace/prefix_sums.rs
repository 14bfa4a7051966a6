//! Sums of a list with some terms left out: the bits of adding one by one, without adding all.
//!
//! Let P be the running sum of all terms and R that of a row which leaves some out, at the same place and with the same sign and
//! exponent, so that R = P + d units in the last place with a whole d. The next term moves both by the same number of units:
//! rounding to multiples of a unit commutes with adding d units, but for two exceptions. Where P was rounded from halfway between
//! two floats, to the even one, an odd d takes R the other way. And below the least float of that exponent units are smaller. So
//! for stretches of the list we keep how far d may be from zero such that R meets neither; then R at the end is P there and d
//! units, in one step. Where R = P, bit for bit, every stretch will do.

use std::ops::Range;

/// Numbers that are summed side by side.
pub(crate) const LANES: usize = 12;

/// What one member adds, or a sum of these.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TermLanes(pub [f32; LANES]);

/// The shortest stretches have this many terms,
const SHORTEST: usize = 8;
/// and the next longer ones so many of those.
const RADIX: usize = 4;

/// A list of terms, their running sums, and what stretches of it can be skipped.
#[derive(Debug, Default)]
pub(crate) struct PrefixSums {
    /// None where a member adds nothing, not even a zero.
    terms: Vec<Option<TermLanes>>,
    /// `sums[n]` is the sum of the first `n` terms.
    sums: Vec<TermLanes>,
    /// By length, then by place.
    stretches: Vec<Vec<SkipBlock>>,
}

impl PrefixSums {
    /// Takes the terms in their order.
    pub fn set(&mut self, terms: impl Iterator<Item = Option<TermLanes>>) {
        self.terms.clear();
        self.sums.clear();
        self.stretches.clear();
        let mut sum = TermLanes::default();
        self.sums.push(sum);
        for term in terms {
            sum.add(&term);
            self.terms.push(term);
            self.sums.push(sum);
        }
    }

    /// Whether the member at `at` adds anything.
    pub fn adds(&self, at: usize) -> bool {
        self.terms[at].is_some()
    }

    /// Prepares many sums of the same list.
    pub fn find_stretches(&mut self) {
        let shortest = |(place, terms): (usize, &[Option<TermLanes>])| {
            SkipBlock::new(&self.sums[place * SHORTEST..=(place + 1) * SHORTEST], terms)
        };
        let mut stretches: Vec<_> = self.terms.chunks_exact(SHORTEST).enumerate().map(shortest).collect();
        while !stretches.is_empty() {
            let longer = stretches.chunks_exact(RADIX).map(SkipBlock::joined).collect();
            self.stretches.push(std::mem::replace(&mut stretches, longer));
        }
    }

    /// The sum of all terms but those in `left_out`, in order and disjoint.
    pub fn sum_without(&self, left_out: &[Range<usize>]) -> TermLanes {
        let Some(first) = left_out.first() else { return self.sums[self.terms.len()] };
        let mut sum = self.sums[first.start];
        let ends = left_out.iter().skip(1).map(|next| next.start).chain([self.terms.len()]);
        for (gap, end) in left_out.iter().zip(ends) {
            self.add_stretch(&mut sum, gap.end..end);
        }
        sum
    }

    fn add_stretch(&self, sum: &mut TermLanes, range: Range<usize>) {
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

    /// Adds the longest stretch from `at` on that can be added in one step and ends by `limit`; returns where it ends.
    fn skip(&self, sum: &mut TermLanes, at: usize, limit: usize) -> usize {
        let (mut end, mut length) = (at, SHORTEST);
        if !at.is_multiple_of(length) || at + length > limit {
            return end;
        }
        let units = sum.units_from(&self.sums[at]);
        for stretches in &self.stretches {
            if !at.is_multiple_of(length) || at + length > limit || !stretches[at / length].admits(&units) {
                break;
            }
            end = at + length;
            length *= RADIX;
        }
        if end > at {
            *sum = self.sums[end].plus_units(&units);
        }
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

    /// By how many units in the last place this is above `other`, where sign and exponent are the same.
    #[inline]
    fn units_from(&self, other: &TermLanes) -> [i32; LANES] {
        std::array::from_fn(|lane| self.0[lane].to_bits().wrapping_sub(other.0[lane].to_bits()).cast_signed())
    }

    #[inline]
    fn plus_units(&self, units: &[i32; LANES]) -> TermLanes {
        TermLanes(std::array::from_fn(|lane| {
            f32::from_bits(self.0[lane].to_bits().wrapping_add(units[lane].cast_unsigned()))
        }))
    }
}

/// How many units a sum may be from the running sum at the start of a stretch, to be as many from it all along.
#[derive(Clone, Copy, Debug)]
struct SkipBlock {
    below: [i32; LANES],
    above: [i32; LANES],
    /// 1 where the number has to be even.
    even: [i32; LANES],
}

impl SkipBlock {
    fn new(sums: &[TermLanes], terms: &[Option<TermLanes>]) -> Self {
        let mut stretch = Self { below: [0; LANES], above: [0; LANES], even: [0; LANES] };
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
            // A sum with the least fraction can come from below, where units are smaller.
            stretch.below[lane] = ((least & FRACTION).cast_signed() - 1).max(0);
            stretch.above[lane] = (FRACTION - (most & FRACTION)).cast_signed();
            stretch.even[lane] =
                i32::from(steps.into_iter().any(|[before, term, after]| is_tie(before, term, after)));
        }
        stretch
    }

    fn joined(parts: &[SkipBlock]) -> Self {
        let mut all = parts[0];
        for part in &parts[1..] {
            for lane in 0..LANES {
                all.below[lane] = all.below[lane].min(part.below[lane]);
                all.above[lane] = all.above[lane].min(part.above[lane]);
                all.even[lane] |= part.even[lane];
            }
        }
        all
    }

    /// Without a branch, so that it runs several lanes at a time.
    #[inline]
    fn admits(&self, units: &[i32; LANES]) -> bool {
        (0..LANES).fold(true, |all, lane| {
            let d = units[lane];
            all & (-self.below[lane] <= d) & (d <= self.above[lane]) & (d & self.even[lane] == 0)
        })
    }
}

/// The bits of a float that are neither sign nor exponent.
const FRACTION: u32 = 0x7f_ffff;

/// Whether `before + term` lay halfway between `after`, which it was rounded to, and another float of its exponent.
///
/// The rounding error is exact (D. E. Knuth, "The Art of Computer Programming", volume 2, theorem 4.2.2 B).
fn is_tie(before: f32, term: f32, after: f32) -> bool {
    let added = after - before;
    let error = (before - (after - added)) + (term - added);
    let unit = f32::from_bits(after.to_bits() & !FRACTION | 1) - f32::from_bits(after.to_bits() & !FRACTION);
    2.0 * error.abs() == unit.abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number in [-1, 1) with `bits` binary digits.
    fn number(state: &mut u32, bits: u32) -> f32 {
        *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (*state >> (32 - bits)) as f32 / (1u32 << (bits - 1)) as f32 - 1.0
    }

    /// TermLanes with sums that grow, wander about zero, or are mostly halfway between two floats.
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
        let mut running = PrefixSums::default();
        for count in [1, 8, 31, 300, 3000] {
            let terms = terms(&mut state, count);
            running.set(terms.iter().copied());
            running.find_stretches();
            for _ in 0..300 {
                let start = ((number(&mut state, 16) + 1.0) * 0.5 * count as f32) as usize;
                let gaps = [start..start + 1, start + 2..start + 4];
                let left_out: Vec<_> = gaps.into_iter().filter(|gap| gap.end <= count).collect();
                let joins = |at: &usize| left_out.iter().all(|gap| !gap.contains(at));
                let mut expected = TermLanes::default();
                (0..count).filter(joins).for_each(|at| expected.add(&terms[at]));
                let found = running.sum_without(&left_out);
                assert_eq!(found.0.map(f32::to_bits), expected.0.map(f32::to_bits), "{count}, {left_out:?}");
            }
        }
    }

    #[test]
    fn stretches_are_skipped() {
        let mut running = PrefixSums::default();
        running.set((0..4096).map(|at| Some(TermLanes([1.0 + 0.01 * (at as f32).sin(); LANES]))));
        running.find_stretches();
        let mut sum = running.sums[2560].plus_units(&[16; LANES]);
        assert_eq!(running.skip(&mut sum, 2560, 4096), 3072);
    }
}
