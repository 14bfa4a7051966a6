//! Insertion-ordered hash map keyed by `[u32]` slices of any length.
//!
//! All maps of the crate share one copy of the probing code, whatever the types of their keys;
//! `std::collections::HashMap` would be compiled once per type, which the WebAssembly build cannot afford.
//! The hash is seeded at random, so that no mesh can be made whose keys collide.

use crate::util::random::random_bits;

/// A map from keys to values. Values are stored in insertion order.
#[derive(Debug)]
pub(crate) struct InsertionMap<T> {
    keys: KeyTable,
    values: Vec<T>,
}

impl<T> InsertionMap<T> {
    pub fn new() -> Self {
        Self { keys: KeyTable::new(), values: Vec::new() }
    }

    /// A map that does not grow before it has `count` keys.
    pub fn with_capacity(count: usize) -> Self {
        Self { keys: KeyTable::with_capacity(count), values: Vec::with_capacity(count) }
    }

    /// The value of `key`, which is inserted with the value `make()` if it is absent.
    pub fn get_or_insert_with(&mut self, key: &[u32], make: impl FnOnce() -> T) -> &mut T {
        let number = self.keys.insert(key);
        if number == self.values.len() {
            self.values.push(make());
        }
        &mut self.values[number]
    }

    /// The value of `key`, if it is present.
    pub fn get(&mut self, key: &[u32]) -> Option<&mut T> {
        let slot = self.keys.slot(key);
        self.values.get_mut(self.keys.slots[slot] as usize)
    }
}

/// Keys, numbered in insertion order. Open addressing with linear probing.
#[derive(Debug)]
pub(crate) struct KeyTable {
    /// The keys, concatenated.
    words: Vec<u32>,
    /// The end of each key in `words`.
    ends: Vec<usize>,
    /// Key numbers or [`FREE`]. The length is a power of two, and at least half of the slots are free.
    slots: Vec<u32>,
    /// The hash seed: random and odd.
    factor: u64,
}

const FREE: u32 = u32::MAX;

impl KeyTable {
    pub fn new() -> Self {
        Self::with_capacity(2)
    }

    /// A table that does not grow before it has `count` keys.
    pub fn with_capacity(count: usize) -> Self {
        let slots = vec![FREE; (2 * count).next_power_of_two()];
        Self { words: Vec::new(), ends: Vec::new(), slots, factor: random_bits() | 1 }
    }

    /// A table of one key without words.
    pub fn of_empty_key() -> Self {
        let mut table = Self::with_capacity(1);
        table.insert(&[]);
        table
    }

    /// The number of a key, which is inserted if it is absent.
    pub fn insert(&mut self, key: &[u32]) -> usize {
        let mut slot = self.slot(key);
        if self.slots[slot] == FREE {
            if 2 * self.ends.len() >= self.slots.len() {
                self.grow();
                slot = self.slot(key);
            }
            self.slots[slot] = self.ends.len() as u32;
            self.words.extend_from_slice(key);
            self.ends.push(self.words.len());
        }
        self.slots[slot] as usize
    }

    /// The slot of a key, or the free slot where it would be inserted.
    #[inline(never)]
    fn slot(&self, key: &[u32]) -> usize {
        let hash = key.iter().fold(self.factor >> 32, |hash, &word| {
            let mixed = (hash ^ u64::from(word)).wrapping_mul(self.factor);
            mixed ^ mixed >> 32
        });
        let mut slot = hash as usize;
        loop {
            slot &= self.slots.len() - 1;
            let number = self.slots[slot];
            if number == FREE || self.key(number as usize) == key {
                return slot;
            }
            slot += 1;
        }
    }

    /// The number of keys.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// The length of all keys together.
    pub fn word_count(&self) -> usize {
        self.words.len()
    }

    /// The key of a number.
    pub fn key(&self, number: usize) -> &[u32] {
        let start = if number == 0 { 0 } else { self.ends[number - 1] };
        &self.words[start..self.ends[number]]
    }

    /// Doubles the number of slots.
    fn grow(&mut self) {
        self.slots = vec![FREE; 2 * self.slots.len()];
        for number in 0..self.ends.len() {
            let slot = self.slot(self.key(number));
            self.slots[slot] = number as u32;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_value_of_a_key_stays() {
        let (mut map, mut all) = (InsertionMap::new(), Vec::<(Vec<u32>, u32)>::new());
        for at in 0..2000u32 {
            let word = at.wrapping_mul(2_654_435_761) >> 27;
            let key = vec![word; word as usize % 5];
            let found = all.iter().find(|(other, _)| *other == key).map(|(_, value)| *value);
            assert_eq!(map.get(&key).copied(), found);
            assert_eq!(*map.get_or_insert_with(&key, || at), found.unwrap_or(at));
            if found.is_none() {
                all.push((key, at));
            }
        }
        assert!(all.len() > 20);
    }
}
