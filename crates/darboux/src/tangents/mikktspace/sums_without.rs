//! Sums of a list of terms without some of them, for many subgroups at once: bit for bit what adding the
//! others one by one gives.
//!
//! The list is passed once per lane, in chunks. Subgroups that exclude terms of a chunk add its other terms
//! one by one, many subgroups per instruction. All other subgroups add the same terms; their sums are kept in
//! sorted runs, which advance together ([`crate::tangents::mikktspace::sorted_sums`]). Subgroups whose first
//! excluded term comes later have the sum of all terms so far. Which subgroups are active in which chunk is
//! the same for all lanes ([`crate::tangents::mikktspace::schedule`]).
//!
//! ```text
//! for each batch of chunks:
//!     schedule the active subgroups of each chunk: those that exclude a term
//!     for each lane, on several threads:
//!         for each chunk:
//!             remove the sums of active subgroups from the runs
//!             advance all runs by the chunk
//!             for each active subgroup: add the terms that it does not exclude
//!             insert the sums of active subgroups that add all of the next chunk into the runs
//! ```

use crate::exec::limits::RunLimits;
use crate::exec::simd::{Task, Width};
use crate::exec::threads;
use crate::tangents::mikktspace::sorted_sums::SortedSums;
use crate::tangents::mikktspace::term_chunks::{
    Activation, BLOCK, Batch, CHUNK, ScheduledChunk, Scheduler, SumPlace,
};
use crate::util::hash_map::KeyTable;

/// The number of lanes of a term.
pub(crate) const LANES: usize = 12;

/// A term, or a sum of terms.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TermLanes(pub [f32; LANES]);

/// Sorted sums must not overflow. Rounding to nearest moves a sum by at most as much as the term, because the
/// sum before the addition is a float at that distance. So every sum is below twice the total, however many
/// terms there are.
const MAX_TOTAL: f64 = 1e20;

/// A list of terms.
#[derive(Debug, Default)]
pub(crate) struct TermList {
    /// A member that adds nothing has zeros here. They change no sum, because no sum is -0: it begins with
    /// +0.
    terms: Vec<TermLanes>,
    has_term: Vec<bool>,
}

impl TermList {
    /// Replaces the list. `None`: a member that adds nothing.
    pub fn load(&mut self, terms: impl Iterator<Item = Option<TermLanes>>) {
        self.terms.clear();
        self.has_term.clear();
        for term in terms {
            self.terms.push(term.unwrap_or_default());
            self.has_term.push(term.is_some());
        }
    }

    /// True when there is a term at index `at`.
    pub fn has_term(&self, at: usize) -> bool {
        self.has_term[at]
    }

    /// The sum of all terms but those of each key of `excluded`, which has the starts and ends of ascending,
    /// disjoint ranges.
    ///
    /// Sums are unspecified after cancellation.
    pub fn sums_without(&self, excluded: &KeyTable, limits: RunLimits<'_>) -> Vec<TermLanes> {
        if self.terms.len() <= 2 * CHUNK || !self.is_bounded() {
            return self.sums_one_by_one(excluded, limits);
        }
        let mut scheduler = Scheduler::new(self.terms.len(), excluded);
        let mut batch = Batch::default();
        let mut sweeps = self.sweeps(excluded.len());
        let threads = limits.thread_count(self.terms.len());
        while !limits.is_cancelled() && scheduler.next_batch(&mut batch) {
            threads::for_each(threads, &mut sweeps, |sweep| {
                batch.chunks().for_each(|chunk| sweep.add_chunk(&chunk, limits.width));
            });
        }
        let mut sums = vec![TermLanes::default(); excluded.len()];
        sweeps.iter_mut().for_each(|sweep| sweep.finish(scheduler.places(), &mut sums));
        sums
    }

    /// One sweep for each lane that is not zero throughout.
    fn sweeps(&self, subgroup_count: usize) -> Vec<Sweep> {
        let is_used = |lane: &usize| self.terms.iter().any(|term| term.0[*lane] != 0.0);
        let sweep = |lane| Sweep {
            lane,
            terms: self.terms.iter().map(|term| term.0[lane]).collect(),
            of_all: 0.0,
            own: vec![0.0; subgroup_count],
            sorted: SortedSums::new(subgroup_count),
        };
        (0..LANES).filter(is_used).map(sweep).collect()
    }

    /// True when no sum of terms can overflow or be NaN.
    fn is_bounded(&self) -> bool {
        let total = |lane: usize| self.terms.iter().map(|term| f64::from(term.0[lane].abs())).sum::<f64>();
        (0..LANES).all(|lane| total(lane) < MAX_TOTAL)
    }

    fn sums_one_by_one(&self, excluded: &KeyTable, limits: RunLimits<'_>) -> Vec<TermLanes> {
        let mut sums = vec![TermLanes::default(); excluded.len()];
        for (number, sum) in sums.iter_mut().enumerate().take_while(|_| !limits.is_cancelled()) {
            sum.add_without(&self.terms, excluded.key(number));
        }
        sums
    }
}

impl TermLanes {
    #[inline]
    fn add(&mut self, term: &TermLanes) {
        for (sum, term) in self.0.iter_mut().zip(&term.0) {
            *sum += term;
        }
    }

    /// Adds the terms that are not in `excluded`.
    fn add_without(&mut self, terms: &[TermLanes], excluded: &[u32]) {
        let mut at = 0;
        for &[start, end] in excluded.as_chunks().0 {
            terms[at..start as usize].iter().for_each(|term| self.add(term));
            at = end as usize;
        }
        terms[at..].iter().for_each(|term| self.add(term));
    }
}

/// The sums of one lane, while the list is passed. A subgroup has the number of its key.
struct Sweep {
    lane: usize,
    terms: Vec<f32>,
    /// The sum of all terms so far.
    of_all: f32,
    /// The sums of the subgroups whose place is [`SumPlace::Own`].
    own: Vec<f32>,
    sorted: SortedSums,
}

impl Sweep {
    /// Adds the terms of a chunk to all sums.
    fn add_chunk(&mut self, chunk: &ScheduledChunk<'_>, width: Width) {
        let terms = &self.terms[chunk.first_term..];
        let terms = &terms[..terms.len().min(CHUNK)];
        for activation in chunk.activations {
            let own = &mut self.own[activation.subgroup as usize];
            match activation.from {
                SumPlace::OfAll => *own = self.of_all,
                SumPlace::Own => {}
                SumPlace::Sorted => *own = self.sorted.remove(activation.subgroup).unwrap_or(*own),
            }
        }
        self.sorted.advance(terms, width);
        for (activations, excluded) in chunk.activations.chunks(BLOCK).zip(chunk.masks) {
            let mut sums = [0.0; BLOCK];
            for (sum, activation) in sums.iter_mut().zip(activations) {
                *sum = self.own[activation.subgroup as usize];
            }
            width.run(AddIncluded { sums: &mut sums, terms, excluded });
            for (sum, activation) in sums.iter().zip(activations) {
                self.own[activation.subgroup as usize] = *sum;
            }
        }
        self.of_all = terms.iter().fold(self.of_all, |sum, term| sum + term);
        let leaving = chunk.activations.iter().filter(|activation| activation.leaves);
        self.sorted
            .insert(leaving.map(|&Activation { subgroup, .. }| (self.own[subgroup as usize], subgroup)));
    }

    /// Writes the sums of all subgroups. `places`: where they are.
    fn finish(&mut self, places: &[SumPlace], sums: &mut [TermLanes]) {
        for ((sum, own), place) in sums.iter_mut().zip(&self.own).zip(places) {
            sum.0[self.lane] = if *place == SumPlace::OfAll { self.of_all } else { *own };
        }
        self.sorted.for_each(|owner, sum| sums[owner as usize].0[self.lane] = sum);
    }
}

/// Adds terms to the sums of a block of subgroups, without those that each excludes.
struct AddIncluded<'a> {
    sums: &'a mut [f32; BLOCK],
    terms: &'a [f32],
    /// Bit i of a term's mask is set where sum i excludes it.
    excluded: &'a [u32; CHUNK],
}

impl Task for AddIncluded<'_> {
    #[inline(always)]
    fn run(self) {
        let mut sums = *self.sums;
        for (&term, &excluded) in self.terms.iter().zip(self.excluded) {
            if excluded == 0 {
                sums.iter_mut().for_each(|sum| *sum += term);
            } else {
                for (bit, sum) in sums.iter_mut().enumerate() {
                    // Adding zero changes no sum, because no sum is -0.
                    *sum += if excluded >> bit & 1 == 0 { term } else { 0.0 };
                }
            }
        }
        *self.sums = sums;
    }
}

#[cfg(test)]
mod tests {
    use darboux_dice::Dice;

    use super::*;

    /// Terms whose lanes grow, walk at random, are mostly ties, or are zero. One in seven members adds
    /// nothing.
    fn terms(dice: &mut Dice<'_>, count: usize) -> Vec<Option<TermLanes>> {
        let number =
            |dice: &mut Dice<'_>, bits: u32| (dice.word() >> (32 - bits)) as f32 / (1 << bits) as f32;
        let mut lane = |lane: usize| match lane % 5 {
            0 => 1.0 + 0.1 * number(dice, 23),
            1 => number(dice, 24) - 0.5,
            2 => number(dice, 5) + f32::EPSILON * number(dice, 3) - 0.5,
            3 => number(dice, 1) - 0.5,
            _ => 0.0,
        };
        let term = |at: usize| (at % 7 != 3).then(|| TermLanes(std::array::from_fn(&mut lane)));
        (0..count).map(term).collect()
    }

    /// Ascending ranges: few or many, single members or longer, up to the end or not.
    fn ranges(dice: &mut Dice<'_>, count: usize) -> Vec<u32> {
        let mut one_of = |choices: [usize; 3]| dice.pick(&choices);
        let (most, longest, farthest) = (one_of([1, 3, 40]), one_of([1, 5, 700]), one_of([1, 30, 2000]));
        let mut ends: Vec<u32> = Vec::new();
        let mut at = dice.below(count);
        while ends.len() < 2 * most && at < count {
            let end = (at + 1 + dice.below(longest)).min(count);
            ends.extend([at as u32, end as u32]);
            at = end + 1 + dice.below(farthest);
        }
        ends
    }

    fn assert_sums(terms: &[Option<TermLanes>], excluded: &KeyTable) {
        let mut list = TermList::default();
        list.load(terms.iter().copied());
        let found = list.sums_without(excluded, RunLimits::default());
        assert_eq!(found.len(), excluded.len());
        for (number, found) in found.iter().enumerate() {
            let (gaps, _) = excluded.key(number).as_chunks::<2>();
            let is_included = |at: u32| gaps.iter().all(|[start, end]| at < *start || at >= *end);
            let mut expected = TermLanes::default();
            let included = (0..).zip(terms).filter(|(at, _)| is_included(*at));
            included.filter_map(|(_, term)| *term).for_each(|term| expected.add(&term));
            assert_eq!(found.0.map(f32::to_bits), expected.0.map(f32::to_bits), "{:?}", excluded.key(number));
        }
    }

    #[test]
    fn sums_are_those_of_adding_one_by_one() {
        let mut dice = Dice::from_seed(1);
        for count in [1, 8, 200, 257, 384, 3000] {
            let terms = terms(&mut dice, count);
            let mut excluded = KeyTable::of_empty_key();
            for _ in 0..400 {
                excluded.insert(&ranges(&mut dice, count));
            }
            assert_sums(&terms, &excluded);
        }
    }

    #[test]
    fn sums_may_overflow() {
        let mut dice = Dice::from_seed(1);
        let mut terms = terms(&mut dice, 1000);
        terms[500] = Some(TermLanes([f32::MAX; LANES]));
        terms[700] = Some(TermLanes([1e38; LANES]));
        let mut excluded = KeyTable::of_empty_key();
        [[500, 501], [700, 701], [3, 4]].iter().for_each(|gap| _ = excluded.insert(gap));
        assert_sums(&terms, &excluded);
    }
}
