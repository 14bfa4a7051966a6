//! Sums of a list of terms without some of them, for many subgroups at once: bit for bit what adding the others one by one gives.
//!
//! The list is passed once, in chunks. Subgroups that exclude terms of a chunk add its other terms one by one. All other subgroups add
//! the same terms; per lane, their sums are kept in sorted runs, which advance together ([`crate::tangents::mikktspace::sorted_sums`]).
//! Subgroups whose first excluded term comes later have the sum of all terms so far.
//!
//! ```text
//! for each chunk of terms:
//!     active = subgroups that exclude a term of the chunk
//!     remove the sums of active subgroups from the runs
//!     advance all runs by the chunk
//!     for each active subgroup: add the terms that it does not exclude
//!     insert the sums of active subgroups that add all of the next chunk into the runs
//! ```

use std::ops::Range;

use crate::tangents::mikktspace::sorted_sums::SortedSums;
use crate::util::hash_map::KeyTable;

/// The number of lanes of a term.
pub(crate) const LANES: usize = 12;

/// A term, or a sum of terms.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TermLanes(pub [f32; LANES]);

/// The number of terms per chunk.
const CHUNK: usize = if cfg!(small_limits) { 3 } else { 128 };

/// Sorted sums must not overflow. Rounding to nearest moves a sum by at most as much as the term, because the sum before the addition is a
/// float at that distance. So every sum is below twice the total, however many terms there are.
const MAX_TOTAL: f64 = 1e20;

const NONE: u32 = u32::MAX;

/// A list of terms.
#[derive(Debug, Default)]
pub(crate) struct TermList {
    /// A member that adds nothing has zeros here. They change no sum, because no sum is -0: it begins with +0.
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

    /// The sum of all terms but those of each key of `excluded`, which has the starts and ends of ascending, disjoint ranges.
    ///
    /// Sums are unspecified once `is_stopped` returned true.
    pub fn sums_without(&self, excluded: &KeyTable, is_stopped: impl Fn() -> bool) -> Vec<TermLanes> {
        if self.terms.len() <= 2 * CHUNK || !self.is_bounded() {
            return self.sums_one_by_one(excluded, is_stopped);
        }
        let mut sweep = Sweep::new(&self.terms, excluded);
        (0..sweep.first_of_chunk.len())
            .take_while(|_| !is_stopped())
            .for_each(|chunk| sweep.add_chunk(chunk));
        sweep.finish()
    }

    /// True when no sum of terms can overflow or be NaN.
    fn is_bounded(&self) -> bool {
        let total = |lane: usize| self.terms.iter().map(|term| f64::from(term.0[lane].abs())).sum::<f64>();
        (0..LANES).all(|lane| total(lane) < MAX_TOTAL)
    }

    fn sums_one_by_one(&self, excluded: &KeyTable, is_stopped: impl Fn() -> bool) -> Vec<TermLanes> {
        let mut sums = vec![TermLanes::default(); excluded.len()];
        for (number, sum) in sums.iter_mut().enumerate().take_while(|_| !is_stopped()) {
            sum.add_without(&self.terms, 0, excluded.key(number));
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

    /// Adds the terms that are not in `excluded`. `first`: the index of the first term.
    fn add_without(&mut self, terms: &[TermLanes], first: usize, excluded: &[u32]) {
        let relative = |at: u32| (at as usize).saturating_sub(first).min(terms.len());
        let mut at = 0;
        for gap in excluded.chunks_exact(2) {
            let [start, end] = [relative(gap[0]), relative(gap[1])];
            if at < start {
                terms[at..start].iter().for_each(|term| self.add(term));
            }
            at = end;
            if at == terms.len() {
                return;
            }
        }
        terms[at..].iter().for_each(|term| self.add(term));
    }
}

/// The state of one pass over the list. A subgroup has the number of its key.
struct Sweep<'a> {
    terms: &'a [TermLanes],
    excluded: &'a KeyTable,
    /// The sum of all terms so far.
    of_all: TermLanes,
    sums: Vec<TermLanes>,
    /// Where each subgroup's current sum is.
    place: Vec<SumPlace>,
    /// The index of each subgroup's next excluded range in its key.
    next_range: Vec<u32>,
    /// The subgroups that are active in each chunk, as linked lists: the first one, and the next one in the same chunk.
    first_of_chunk: Vec<u32>,
    next_of_chunk: Vec<u32>,
    /// The sums of every lane that is not zero throughout.
    lanes: Vec<(usize, SortedSums)>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SumPlace {
    /// In [`Sweep::of_all`]: no term has been excluded yet.
    OfAll,
    /// In [`Sweep::sums`].
    Sums,
    /// In [`Sweep::lanes`].
    Lanes,
}

impl<'a> Sweep<'a> {
    fn new(terms: &'a [TermLanes], excluded: &'a KeyTable) -> Self {
        let count = excluded.len();
        let is_used = |lane: &usize| terms.iter().any(|term| term.0[*lane] != 0.0);
        let lanes = (0..LANES).filter(is_used).map(|lane| (lane, SortedSums::new(count))).collect();
        let mut sweep = Self {
            terms,
            excluded,
            of_all: TermLanes::default(),
            sums: vec![TermLanes::default(); count],
            place: vec![SumPlace::OfAll; count],
            next_range: vec![0; count],
            first_of_chunk: vec![NONE; terms.len().div_ceil(CHUNK)],
            next_of_chunk: vec![NONE; count],
            lanes,
        };
        for subgroup in 0..count as u32 {
            if let Some(&[start, _]) = sweep.ranges(subgroup).first() {
                sweep.activate_in(start as usize / CHUNK, subgroup);
            }
        }
        sweep
    }

    /// The excluded ranges of a subgroup from the next one on.
    fn ranges(&self, subgroup: u32) -> &'a [[u32; 2]] {
        let (ranges, _) = self.excluded.key(subgroup as usize).as_chunks();
        &ranges[self.next_range[subgroup as usize] as usize..]
    }

    fn activate_in(&mut self, chunk: usize, subgroup: u32) {
        self.next_of_chunk[subgroup as usize] = std::mem::replace(&mut self.first_of_chunk[chunk], subgroup);
    }

    /// Adds the terms of a chunk to all sums.
    fn add_chunk(&mut self, chunk: usize) {
        let range = chunk * CHUNK..self.terms.len().min((chunk + 1) * CHUNK);
        let active = self.active(chunk);
        self.move_to_sums(&active);
        let terms = &self.terms[range.clone()];
        for (lane, sums) in &mut self.lanes {
            sums.advance(&terms.iter().map(|term| term.0[*lane]).collect::<Vec<_>>());
        }
        let leaving: Vec<u32> = active
            .into_iter()
            .filter(|&subgroup| self.add_chunk_to_active(subgroup, range.clone()))
            .collect();
        terms.iter().for_each(|term| self.of_all.add(term));
        self.move_to_lanes(&leaving);
    }

    fn active(&self, chunk: usize) -> Vec<u32> {
        let listed = |subgroup: u32| (subgroup != NONE).then_some(subgroup);
        let next = |&subgroup: &u32| listed(self.next_of_chunk[subgroup as usize]);
        std::iter::successors(listed(self.first_of_chunk[chunk]), next).collect()
    }

    /// Moves the sums of subgroups to `sums`.
    fn move_to_sums(&mut self, subgroups: &[u32]) {
        for &subgroup in subgroups {
            if self.place[subgroup as usize] == SumPlace::OfAll {
                self.sums[subgroup as usize] = self.of_all;
            }
        }
        let in_lanes = |subgroup: &&u32| self.place[**subgroup as usize] == SumPlace::Lanes;
        for (lane, sums) in &mut self.lanes {
            for &subgroup in subgroups.iter().filter(in_lanes) {
                if let Some(sum) = sums.remove(subgroup) {
                    self.sums[subgroup as usize].0[*lane] = sum;
                }
            }
        }
        subgroups.iter().for_each(|&subgroup| self.place[subgroup as usize] = SumPlace::Sums);
    }

    /// Moves the sums of subgroups from `sums` to the lanes.
    fn move_to_lanes(&mut self, subgroups: &[u32]) {
        for (lane, sums) in &mut self.lanes {
            sums.insert(subgroups.iter().map(|&subgroup| (self.sums[subgroup as usize].0[*lane], subgroup)));
        }
        subgroups.iter().for_each(|&subgroup| self.place[subgroup as usize] = SumPlace::Lanes);
    }

    /// Adds the terms of a chunk to the sum of an active subgroup. True when the subgroup adds all terms of the next chunk.
    fn add_chunk_to_active(&mut self, subgroup: u32, range: Range<usize>) -> bool {
        let ranges = self.ranges(subgroup);
        self.sums[subgroup as usize].add_without(
            &self.terms[range.clone()],
            range.start,
            ranges.as_flattened(),
        );
        let passed = ranges.iter().take_while(|gap| gap[1] as usize <= range.end).count();
        self.next_range[subgroup as usize] += passed as u32;
        let Some(&[start, end]) = ranges.get(passed) else { return range.end < self.terms.len() };
        // The sum stays as it is up to the end of a range that reaches into the next chunk.
        let is_inside = (start as usize) <= range.end;
        let next = if is_inside { end } else { start } as usize / CHUNK;
        if next < self.first_of_chunk.len() {
            self.activate_in(next, subgroup);
        }
        !is_inside && start as usize >= range.end + CHUNK
    }

    fn finish(mut self) -> Vec<TermLanes> {
        let all: Vec<u32> = (0..self.sums.len() as u32).collect();
        self.move_to_sums(&all);
        self.sums
    }
}

#[cfg(test)]
mod tests {
    use darboux_dice::Dice;

    use super::*;

    /// Terms whose lanes grow, walk at random, are mostly ties, or are zero. One in seven members adds nothing.
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
        let found = list.sums_without(excluded, || false);
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
