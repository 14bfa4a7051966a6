//! Many running sums to which the same terms are added: the time is far below one addition per sum and term,
//! and every bit is that of adding one by one.
//!
//! Sums of one *binade* (sign and exponent) are multiples of one ulp. Let r be such a sum and s = r + d ulps
//! another one. Where `r + x` and `s + x` are rounded to the same binade, both are rounded to multiples of
//! that ulp, so the difference stays d. The exception is a tie, `r + x` halfway between two multiples: each
//! sum is rounded to its even neighbour. After a tie all sums of the binade are even, so that the next tie
//! rounds all of them alike.
//!
//! Rounding is monotone, so sorted sums stay sorted. If the least and the greatest sum of a slice are in one
//! binade, so are all between:
//!
//! ```text
//! advance(sorted sums, terms):
//!     for each slice of sums of one binade:
//!         for each term:
//!             add it to the least and to the greatest sum
//!             if both stay in the binade: the shift of the slice changes by the ulps that the least sum moved
//!             else: advance the sums that leave the binade by themselves, and go on with the slice of those that stay
//!         apply the shift to the slice
//! ```
//!
//! No sum is -0: it begins with +0, and x + y is -0 only where both are. Sums and terms are finite.

use crate::exec::simd::{Task, Width};
use crate::util::radix_sort::sort_by_key;

/// The longest slice whose sums are advanced one by one.
const MAX_ONE_BY_ONE: usize = if cfg!(small_limits) { 1 } else { 16 };

/// Sums that left a binade more often than this while terms were added are advanced one by one: they are
/// about to leave again.
const MAX_DEPARTURES: u32 = 6;

/// The fraction bits of an `f32`.
const FRACTION: u32 = 0x7f_ffff;

/// The running sums of many owners: sorted runs, whose lengths when they were made at least halve from one to
/// the next, so that there are few of them and a sum is merged a logarithmic number of times. Sums that have
/// become equal are merged into one; in large fans nine in ten do.
#[derive(Debug)]
pub(crate) struct SortedSums {
    runs: Vec<Run>,
    /// The run of each owner's sum, and the index of the sum.
    place: Vec<(u32, u32)>,
    /// The number of the next run.
    next_number: u32,
    /// Scratch memory of [`SortedSums::insert`] and of merging.
    pairs: Vec<(f32, u32)>,
    buffer: Vec<(f32, u32)>,
    spare: Run,
}

#[derive(Debug, Default)]
struct Run {
    number: u32,
    /// Ascending; the pending shift of [`Slice`] is not applied.
    sums: Vec<f32>,
    shift: u32,
    have_equal_parity: bool,
    /// The owners of all sums, and the end of each sum's owners. The sum of an owner whose place is another
    /// one was removed.
    owners: Vec<u32>,
    ends: Vec<u32>,
    /// The number of owners whose sums were removed.
    removed: usize,
}

impl SortedSums {
    /// `owner_count`: owners have smaller numbers.
    pub fn new(owner_count: usize) -> Self {
        Self {
            runs: Vec::new(),
            place: vec![(0, 0); owner_count],
            next_number: 1,
            pairs: Vec::new(),
            buffer: Vec::new(),
            spare: Run::default(),
        }
    }

    /// Adds `terms`, in order, to every sum.
    pub fn advance(&mut self, terms: &[f32], width: Width) {
        self.runs.iter_mut().filter(|run| !run.sums.is_empty()).for_each(|run| run.advance(terms, width));
    }

    /// Stores sums with their owners.
    pub fn insert(&mut self, sums: impl Iterator<Item = (f32, u32)>) {
        self.pairs.clear();
        self.pairs.extend(sums);
        if self.pairs.is_empty() {
            return;
        }
        let key = |(sum, _): &(f32, u32)| u64::from(ordered(*sum).cast_unsigned() ^ 1 << 31);
        sort_by_key(&mut self.pairs, key, &mut self.buffer);
        let mut run = self.new_run();
        for &(sum, owner) in &self.pairs {
            self.place[owner as usize] = run.push(sum, owner);
        }
        while let Some(last) = self.runs.pop_if(|last| last.owners.len() < 2 * run.owners.len()) {
            run = self.merged(last, run);
        }
        self.runs.push(run);
    }

    /// Removes and returns the sum of an owner. `None` if the owner has none.
    pub fn remove(&mut self, owner: u32) -> Option<f32> {
        let (number, at) = std::mem::take(&mut self.place[owner as usize]);
        let index = self.runs.iter().position(|run| run.number == number)?;
        let run = &mut self.runs[index];
        let sum = run.sum(at as usize);
        run.removed += 1;
        if 2 * run.removed > run.owners.len() {
            let run = std::mem::take(run);
            self.runs[index] = self.merged(run, Run::default());
        }
        Some(sum)
    }

    /// Calls `visit` with every owner and its sum.
    pub fn for_each(&self, mut visit: impl FnMut(u32, f32)) {
        for run in &self.runs {
            for at in 0..run.sums.len() {
                let is_here = |owner: &&u32| self.place[**owner as usize] == (run.number, at as u32);
                run.owners(at).iter().filter(is_here).for_each(|&owner| visit(owner, run.sum(at)));
            }
        }
    }

    fn new_run(&mut self) -> Run {
        let run = Run { number: self.next_number, ..std::mem::take(&mut self.spare) };
        self.next_number += 1;
        run
    }

    /// Merges two runs, without the sums that were removed.
    fn merged(&mut self, a: Run, b: Run) -> Run {
        let mut merged = self.new_run();
        let mut copy = |run: &Run, at: usize| {
            let sum = run.sum(at);
            for &owner in run.owners(at) {
                let place = &mut self.place[owner as usize];
                if *place == (run.number, at as u32) {
                    *place = merged.push(sum, owner);
                }
            }
        };
        let mut next = 0;
        for at in 0..a.sums.len() {
            let sum = a.sum(at);
            while next < b.sums.len() && b.sum(next) < sum {
                copy(&b, next);
                next += 1;
            }
            copy(&a, at);
        }
        (next..b.sums.len()).for_each(|at| copy(&b, at));
        self.spare = a.cleared();
        merged
    }
}

impl Run {
    /// Appends a sum that is not below the others. Returns its place.
    fn push(&mut self, sum: f32, owner: u32) -> (u32, u32) {
        self.owners.push(owner);
        let end = self.owners.len() as u32;
        match (self.sums.last(), self.ends.last_mut()) {
            (Some(last), Some(last_end)) if last.to_bits() == sum.to_bits() => *last_end = end,
            _ => {
                self.sums.push(sum);
                self.ends.push(end);
            }
        }
        (self.number, self.sums.len() as u32 - 1)
    }

    #[inline]
    fn sum(&self, at: usize) -> f32 {
        plus_ulps(self.sums[at], self.shift)
    }

    fn owners(&self, at: usize) -> &[u32] {
        let start = if at == 0 { 0 } else { self.ends[at - 1] };
        &self.owners[start as usize..self.ends[at] as usize]
    }

    /// An empty run with the memory of this one.
    fn cleared(mut self) -> Self {
        self.sums.clear();
        self.owners.clear();
        self.ends.clear();
        Self { sums: self.sums, owners: self.owners, ends: self.ends, ..Self::default() }
    }

    /// Adds `terms` to every sum. The run has sums.
    fn advance(&mut self, terms: &[f32], width: Width) {
        let (shift, have_equal_parity) = (self.shift, self.have_equal_parity);
        let mut slice = Slice { sums: &mut self.sums, shift, have_equal_parity };
        let added = slice.add_while_together(terms);
        if added < terms.len() {
            slice.apply_shift();
            advance(slice.sums, &terms[added..], 0, width);
            slice.have_equal_parity = false;
        }
        (self.shift, self.have_equal_parity) = (slice.shift, slice.have_equal_parity);
    }
}

/// Sorted sums that move together while they are in one binade.
struct Slice<'a> {
    /// Not empty.
    sums: &'a mut [f32],
    /// The ulps that every sum has moved since `sums` was written.
    shift: u32,
    /// True after a tie.
    have_equal_parity: bool,
}

impl<'a> Slice<'a> {
    /// Adds terms to every sum, up to the first one that takes a sum to another binade. Returns the number of
    /// terms added.
    fn add_while_together(&mut self, terms: &[f32]) -> usize {
        let [mut least, mut greatest] =
            [0, self.sums.len() - 1].map(|at| plus_ulps(self.sums[at], self.shift));
        let binade = binade(least);
        let mut added = 0;
        for &term in terms {
            let next = [least + term, greatest + term];
            if next.map(self::binade) != [binade; 2] || self::binade(greatest) != binade {
                break;
            }
            if !self.have_equal_parity && is_tie(least, term, next[0]) {
                self.shift = ulps(self.sums[0], least);
                self.apply_shift();
                self.sums.iter_mut().for_each(|sum| *sum += term);
                self.have_equal_parity = true;
            }
            [least, greatest] = next;
            added += 1;
        }
        self.shift = ulps(self.sums[0], least);
        added
    }

    /// Splits the sums into those that `term` takes to a lower binade, those that stay, and those that it
    /// takes to a higher one.
    fn split(self, term: f32) -> [&'a mut [f32]; 3] {
        let binade = binade(plus_ulps(self.sums[0], self.shift));
        let after = |sum: f32| self::binade(plus_ulps(sum, self.shift) + term);
        let below = self.sums.partition_point(|&sum| after(sum) < binade);
        let stay = self.sums[below..].partition_point(|&sum| after(sum) == binade);
        let (below, rest) = self.sums.split_at_mut(below);
        let (stay, above) = rest.split_at_mut(stay);
        [below, stay, above]
    }

    fn apply_shift(&mut self) {
        shift(self.sums, self.shift);
        self.shift = 0;
    }
}

/// Adds `terms`, in order, to every value. `values` ascend, also afterwards. `departures`: how often the
/// values left a binade before.
fn advance(mut values: &mut [f32], terms: &[f32], departures: u32, width: Width) {
    while values.len() > MAX_ONE_BY_ONE && departures <= MAX_DEPARTURES {
        let (first, last) = (values[0], values[values.len() - 1]);
        if first.to_bits() == last.to_bits() {
            return values.fill(terms.iter().fold(first, |sum, term| sum + term));
        }
        let binade = binade(first);
        let count = values.partition_point(|&value| self::binade(value) == binade);
        let (slice, rest) = values.split_at_mut(count);
        advance_binade(slice, terms, departures, width);
        values = rest;
    }
    width.run(AddOneByOne { values, terms });
}

/// As [`advance`], for values of one binade.
fn advance_binade(values: &mut [f32], mut terms: &[f32], departures: u32, width: Width) {
    let mut slice = Slice { sums: values, shift: 0, have_equal_parity: false };
    loop {
        terms = &terms[slice.add_while_together(terms)..];
        let Some((&term, rest)) = terms.split_first() else { return slice.apply_shift() };
        let (shift, have_equal_parity) = (slice.shift, slice.have_equal_parity);
        let [below, stay, above] = slice.split(term);
        for leaving in [below, above] {
            self::shift(leaving, shift);
            leaving.iter_mut().for_each(|value| *value += term);
            advance(leaving, rest, departures + 1, width);
        }
        if stay.len() <= MAX_ONE_BY_ONE {
            self::shift(stay, shift);
            return width.run(AddOneByOne { values: stay, terms });
        }
        slice = Slice { sums: stay, shift, have_equal_parity };
    }
}

/// As [`advance`], one addition per value and term. The values of a block are added independently of each
/// other, which vectorises.
struct AddOneByOne<'a> {
    values: &'a mut [f32],
    terms: &'a [f32],
}

impl Task for AddOneByOne<'_> {
    #[inline(always)]
    fn run(self) {
        let (blocks, rest) = self.values.as_chunks_mut::<64>();
        blocks.iter_mut().for_each(|block| add_to_block(block, self.terms));
        for values in rest.chunks_mut(16) {
            let mut block = [0.0; 16];
            block[..values.len()].copy_from_slice(values);
            add_to_block(&mut block, self.terms);
            values.copy_from_slice(&block[..values.len()]);
        }
    }
}

#[inline(always)]
fn add_to_block<const N: usize>(block: &mut [f32; N], terms: &[f32]) {
    let mut sums = *block;
    for term in terms {
        sums.iter_mut().for_each(|sum| *sum += term);
    }
    *block = sums;
}

/// The sign and exponent as a number that ascends with the value.
#[inline(always)]
fn binade(value: f32) -> i32 {
    ordered(value) >> 23
}

/// A number that ascends with the value.
#[inline(always)]
fn ordered(value: f32) -> i32 {
    let bits = value.to_bits().cast_signed();
    bits ^ ((bits >> 31).cast_unsigned() >> 1).cast_signed()
}

/// The distance of two values of one binade, as the difference of their bits.
#[inline(always)]
fn ulps(from: f32, to: f32) -> u32 {
    to.to_bits().wrapping_sub(from.to_bits())
}

fn shift(values: &mut [f32], ulps: u32) {
    values.iter_mut().for_each(|value| *value = plus_ulps(*value, ulps));
}

#[inline(always)]
fn plus_ulps(value: f32, ulps: u32) -> f32 {
    f32::from_bits(value.to_bits().wrapping_add(ulps))
}

/// True where `before + term` lay halfway between `after`, its rounded value, and another float of the same
/// binade.
///
/// The rounding error is exact (D. E. Knuth, "The Art of Computer Programming", volume 2, theorem 4.2.2 B).
#[inline(always)]
fn is_tie(before: f32, term: f32, after: f32) -> bool {
    let added = after - before;
    let error = (before - (after - added)) + (term - added);
    let power = after.to_bits() & !FRACTION;
    let ulp = f32::from_bits(power | 1) - f32::from_bits(power);
    2.0 * error.abs() == ulp.abs()
}

#[cfg(test)]
mod tests {
    use darboux_dice::Dice;

    use super::*;
    use crate::exec::simd::WidthLimit;

    /// A number in [-1, 1) with `bits` binary digits.
    fn number(dice: &mut Dice<'_>, bits: u32) -> f32 {
        (dice.word() >> (32 - bits)) as f32 / (1u32 << (bits - 1)) as f32 - 1.0
    }

    /// Terms that grow, random walks, ties, tiny palettes, subnormal numbers.
    fn term(dice: &mut Dice<'_>, kind: usize) -> f32 {
        match kind {
            0 => 1.0 + 0.1 * number(dice, 23),
            1 => number(dice, 24),
            2 => number(dice, 5) + 1.0 + f32::EPSILON * number(dice, 3),
            3 => number(dice, 2),
            4 => 1e-3 * number(dice, 24),
            5 => number(dice, 4) * f32::EPSILON,
            _ => number(dice, 12) * f32::MIN_POSITIVE,
        }
    }

    #[test]
    fn sums_are_those_of_adding_one_by_one() {
        let mut dice = Dice::from_seed(1);
        for round in 0..400 {
            let (kind, spread) = (round % 7, [0.0, 1e-6, 1e-3, 1.0, 30.0][round / 7 % 5]);
            let unit = if kind == 6 { 64.0 * f32::MIN_POSITIVE } else { spread };
            let terms: Vec<f32> = (0..300).map(|_| term(&mut dice, kind)).collect();
            let start = terms.iter().take(round).sum::<f32>();
            let mut values: Vec<f32> = (0..500).map(|_| start + unit * number(&mut dice, 20) + 0.0).collect();
            values.sort_unstable_by(f32::total_cmp);
            let expected: Vec<f32> =
                values.iter().map(|&value| terms.iter().fold(value, |sum, term| sum + term)).collect();
            advance(&mut values, &terms, 0, Width::widest(WidthLimit::default()));
            let bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&values), bits(&expected), "kind {kind}, spread {spread}");
        }
    }
}
