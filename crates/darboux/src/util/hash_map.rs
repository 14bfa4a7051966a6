//! What is known of keys: one table for all kinds of keys, which are lists of words, and of values.

use std::hash::{BuildHasher, RandomState};

/// Values by key. Values lie in the order in which their keys came.
#[derive(Debug)]
pub(crate) struct InsertionMap<T> {
    numbers: Numbers,
    values: Vec<T>,
}

impl<T> InsertionMap<T> {
    pub fn new() -> Self {
        Self { numbers: Numbers::new(), values: Vec::new() }
    }

    /// The value of a key; at first it is `value`.
    pub fn first(&mut self, key: &[u32], value: impl FnOnce() -> T) -> &mut T {
        let number = self.numbers.of(key);
        if number == self.values.len() {
            self.values.push(value());
        }
        &mut self.values[number]
    }

    /// The value of a key, if it has one.
    pub fn get(&mut self, key: &[u32]) -> Option<&mut T> {
        let place = self.numbers.place(key);
        self.values.get_mut(self.numbers.places[place] as usize)
    }
}

/// Keys, numbered in the order in which they come: open addressing.
#[derive(Debug)]
struct Numbers {
    words: Vec<u32>,
    /// Where the words of each key end.
    ends: Vec<usize>,
    /// Numbers, each at the first place from its key's hash on that was free, or [`FREE`]: a power of two, of which half are free.
    places: Vec<u32>,
    /// Odd, and drawn by chance, so that no mesh can be made whose keys crowd.
    factor: u64,
}

const FREE: u32 = u32::MAX;

impl Numbers {
    fn new() -> Self {
        Self { words: Vec::new(), ends: Vec::new(), places: vec![FREE; 4], factor: chance() | 1 }
    }

    /// The number of a key: how many others there were when it first came.
    fn of(&mut self, key: &[u32]) -> usize {
        let mut place = self.place(key);
        if self.places[place] == FREE {
            if 2 * self.ends.len() >= self.places.len() {
                self.grow();
                place = self.place(key);
            }
            self.places[place] = self.ends.len() as u32;
            self.words.extend_from_slice(key);
            self.ends.push(self.words.len());
        }
        self.places[place] as usize
    }

    /// Where a key is, or belongs.
    #[inline(never)]
    fn place(&self, key: &[u32]) -> usize {
        let hash = key.iter().fold(self.factor >> 32, |hash, &word| {
            let mixed = (hash ^ u64::from(word)).wrapping_mul(self.factor);
            mixed ^ mixed >> 32
        });
        let mut place = hash as usize;
        loop {
            place &= self.places.len() - 1;
            let number = self.places[place];
            if number == FREE || self.key(number as usize) == key {
                return place;
            }
            place += 1;
        }
    }

    fn key(&self, number: usize) -> &[u32] {
        let start = if number == 0 { 0 } else { self.ends[number - 1] };
        &self.words[start..self.ends[number]]
    }

    /// Makes room for twice as many.
    fn grow(&mut self) {
        self.places = vec![FREE; 2 * self.places.len()];
        for number in 0..self.ends.len() {
            let place = self.place(self.key(number));
            self.places[place] = number as u32;
        }
    }
}

/// Bits that nobody can foretell.
#[inline(never)]
pub(crate) fn chance() -> u64 {
    RandomState::new().hash_one(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_value_of_a_key_stays() {
        let (mut known, mut all) = (InsertionMap::new(), Vec::<(Vec<u32>, u32)>::new());
        for at in 0..2000u32 {
            let word = at.wrapping_mul(2_654_435_761) >> 27;
            let key = vec![word; word as usize % 5];
            let found = all.iter().find(|(other, _)| *other == key).map(|(_, value)| *value);
            assert_eq!(known.get(&key).copied(), found);
            assert_eq!(*known.first(&key, || at), found.unwrap_or(at));
            if found.is_none() {
                all.push((key, at));
            }
        }
        assert!(all.len() > 20);
    }
}
