//! The chunks of a list of terms in which each subgroup has a sum of its own, because it excludes terms
//! there.
//!
//! A subgroup is *active* in every chunk in which an excluded range begins or ends. Its sum does not change
//! in chunks that an excluded range covers. In all other chunks it adds every term, so its sum is kept with
//! those of other subgroups.

use crate::util::hash_map::KeyTable;

/// The number of terms per chunk.
pub(crate) const CHUNK: usize = if cfg!(small_limits) { 3 } else { 128 };

/// The number of active subgroups whose terms are added at once: one bit each in the masks.
pub(crate) const BLOCK: usize = if cfg!(small_limits) { 2 } else { 32 };

/// A batch ends with the chunk in which it reaches this number of activations: a limit of the memory.
const MAX_ACTIVATIONS: usize = if cfg!(small_limits) { 10 } else { 1 << 14 };

const NONE: u32 = u32::MAX;

/// Where the sum of a subgroup is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SumPlace {
    /// It is the sum of all terms so far: no term has been excluded yet.
    OfAll,
    /// In the subgroup's own variable.
    Own,
    /// Among the sorted sums of subgroups that add the same terms.
    Sorted,
}

/// A subgroup that is active in a chunk.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Activation {
    pub subgroup: u32,
    /// Where its sum is before the chunk.
    pub from: SumPlace,
    /// True where it adds all terms of the next chunk, so that its sum goes to the sorted ones.
    pub leaves: bool,
}

/// The schedule of consecutive chunks.
#[derive(Debug, Default)]
pub(crate) struct Batch {
    first_chunk: usize,
    activations: Vec<Activation>,
    /// Which terms each block of activations excludes: bit i of term t is set where activation i excludes
    /// it.
    masks: Vec<[u32; CHUNK]>,
    /// The ends of each chunk in `activations` and `masks`.
    ends: Vec<[usize; 2]>,
}

/// The schedule of one chunk.
pub(crate) struct ScheduledChunk<'a> {
    /// The index of the first term.
    pub first_term: usize,
    pub activations: &'a [Activation],
    /// One for each [`BLOCK`] of activations.
    pub masks: &'a [[u32; CHUNK]],
}

impl Batch {
    pub fn chunks(&self) -> impl Iterator<Item = ScheduledChunk<'_>> {
        let starts = [[0; 2]].into_iter().chain(self.ends.iter().copied());
        let chunks = starts.zip(&self.ends).enumerate();
        chunks.map(|(at, ([activations, masks], &[activations_end, masks_end]))| ScheduledChunk {
            first_term: (self.first_chunk + at) * CHUNK,
            activations: &self.activations[activations..activations_end],
            masks: &self.masks[masks..masks_end],
        })
    }
}

/// Goes through the chunks of a list. A subgroup has the number of its key.
pub(crate) struct Scheduler<'a> {
    term_count: usize,
    /// The starts and ends of the ranges that each subgroup excludes.
    excluded: &'a KeyTable,
    next_chunk: usize,
    /// Where each subgroup's sum is before the next chunk.
    place: Vec<SumPlace>,
    /// The index of each subgroup's next excluded range in its key.
    next_range: Vec<u32>,
    /// The active subgroups of each chunk, as linked lists: the first one, and the next one in the same
    /// chunk.
    first_of_chunk: Vec<u32>,
    next_of_chunk: Vec<u32>,
}

impl<'a> Scheduler<'a> {
    pub fn new(term_count: usize, excluded: &'a KeyTable) -> Self {
        let count = excluded.len();
        let mut scheduler = Self {
            term_count,
            excluded,
            next_chunk: 0,
            place: vec![SumPlace::OfAll; count],
            next_range: vec![0; count],
            first_of_chunk: vec![NONE; term_count.div_ceil(CHUNK)],
            next_of_chunk: vec![NONE; count],
        };
        for subgroup in 0..count as u32 {
            if let Some(&[start, _]) = scheduler.ranges(subgroup).first() {
                scheduler.activate_in(start as usize / CHUNK, subgroup);
            }
        }
        scheduler
    }

    /// Where each subgroup's sum is before the next chunk.
    pub fn places(&self) -> &[SumPlace] {
        &self.place
    }

    /// Writes the schedule of the next chunks to `batch`. False where there are none.
    pub fn next_batch(&mut self, batch: &mut Batch) -> bool {
        batch.first_chunk = self.next_chunk;
        batch.activations.clear();
        batch.masks.clear();
        batch.ends.clear();
        while self.next_chunk < self.first_of_chunk.len() && batch.activations.len() < MAX_ACTIVATIONS {
            self.append_chunk(batch);
            batch.ends.push([batch.activations.len(), batch.masks.len()]);
            self.next_chunk += 1;
        }
        !batch.ends.is_empty()
    }

    fn append_chunk(&mut self, batch: &mut Batch) {
        let mut subgroup = std::mem::replace(&mut self.first_of_chunk[self.next_chunk], NONE);
        let mut bit = BLOCK;
        while subgroup != NONE {
            let next = self.next_of_chunk[subgroup as usize];
            if bit == BLOCK {
                batch.masks.push([0; CHUNK]);
                bit = 0;
            }
            if let Some(masks) = batch.masks.last_mut() {
                batch.activations.push(self.activate(subgroup, masks, 1 << bit));
            }
            bit += 1;
            subgroup = next;
        }
    }

    /// Sets the bit of the terms that a subgroup excludes in the next chunk, and activates the subgroup in a
    /// later one if need be.
    fn activate(&mut self, subgroup: u32, masks: &mut [u32; CHUNK], bit: u32) -> Activation {
        let first = self.next_chunk * CHUNK;
        let end = self.term_count.min(first + CHUNK);
        let ranges = self.ranges(subgroup);
        let relative = |at: u32| (at as usize).clamp(first, end) - first;
        for [from, to] in ranges.iter().take_while(|[from, _]| (*from as usize) < end) {
            masks[relative(*from)..relative(*to)].iter_mut().for_each(|mask| *mask |= bit);
        }
        let passed = ranges.iter().take_while(|[_, to]| *to as usize <= end).count();
        self.next_range[subgroup as usize] += passed as u32;
        let leaves = match ranges.get(passed) {
            // The sum stays as it is up to the end of a range that reaches into the next chunk.
            Some(&[from, to]) if from as usize <= end => {
                self.activate_in(to as usize / CHUNK, subgroup);
                false
            }
            Some(&[from, _]) => {
                self.activate_in(from as usize / CHUNK, subgroup);
                from as usize >= end + CHUNK
            }
            None => end < self.term_count,
        };
        let place = if leaves { SumPlace::Sorted } else { SumPlace::Own };
        let from = std::mem::replace(&mut self.place[subgroup as usize], place);
        Activation { subgroup, from, leaves }
    }

    /// The excluded ranges of a subgroup from the next one on.
    fn ranges(&self, subgroup: u32) -> &'a [[u32; 2]] {
        let (ranges, _) = self.excluded.key(subgroup as usize).as_chunks();
        &ranges[self.next_range[subgroup as usize] as usize..]
    }

    /// Adds a subgroup to the active ones of a chunk, if there is such a chunk.
    fn activate_in(&mut self, chunk: usize, subgroup: u32) {
        if let Some(first) = self.first_of_chunk.get_mut(chunk) {
            self.next_of_chunk[subgroup as usize] = std::mem::replace(first, subgroup);
        }
    }
}
