//! Hash tables of the weld: a chained table that inserts lazily, and a filter of one bit per hash.

/// A chained hash table of numbered items.
///
/// Items are inserted at the next search, many at once, so that their cache misses overlap.
#[derive(Debug, Default)]
pub(crate) struct ChainedTable {
    /// The hash of each item.
    hashes: Vec<u32>,
    /// The last item of each chain, or [`END`].
    last: Vec<u32>,
    /// For each inserted item the item before it in its chain, or [`END`].
    before: Vec<u32>,
}

/// A chain is too long to search: many items have one hash, by bad luck or by intent.
pub(crate) struct ChainTooLong;

/// The number of items that a search examines.
const LONGEST_CHAIN: usize = 256;

/// The end of a chain.
const END: u32 = u32::MAX;

impl ChainedTable {
    /// Removes all items, and chooses a size for about `count` items.
    pub fn clear(&mut self, count: usize) {
        let count = if cfg!(small_limits) { count / 16 } else { count };
        let chains = count.next_power_of_two();
        self.last.clear();
        self.last.resize(chains, END);
        self.before.clear();
        self.hashes.clear();
    }

    /// Adds the next item.
    #[inline(always)]
    pub fn push(&mut self, hash: u32) {
        self.hashes.push(hash);
    }

    /// The hashes of all items.
    pub fn hashes(&self) -> &[u32] {
        &self.hashes
    }

    /// The last item of this hash that is wanted. Errors: the chain is too long.
    #[inline(never)]
    pub fn find(&mut self, hash: u32, is_wanted: impl Fn(u32) -> bool) -> Result<Option<u32>, ChainTooLong> {
        self.insert_pushed();
        let mut item = self.last[chain(hash, self.last.len())];
        for _ in 0..LONGEST_CHAIN {
            if item == END {
                return Ok(None);
            }
            if self.hashes[item as usize] == hash && is_wanted(item) {
                return Ok(Some(item));
            }
            item = self.before[item as usize];
        }
        Err(ChainTooLong)
    }

    fn insert_pushed(&mut self) {
        let (first, chains) = (self.before.len(), self.last.len());
        let insert = |(&hash, item)| std::mem::replace(&mut self.last[chain(hash, chains)], item);
        self.before.extend(self.hashes[first..].iter().zip(first as u32..).map(insert));
    }
}

/// The chain of a hash: its highest bits. `chains`: a power of two.
fn chain(hash: u32, chains: usize) -> usize {
    ((u64::from(hash) * chains as u64) >> 32) as usize
}

/// One bit for each of many hash values, which the highest bits of a hash select.
#[derive(Debug, Default)]
pub(crate) struct HashFilter {
    words: Vec<u64>,
    /// How many of a hash's bits select its bit here.
    bits: u32,
}

impl HashFilter {
    /// Clears all bits, and chooses a size for `count` hashes.
    pub fn clear(&mut self, count: usize) {
        self.bits = if cfg!(small_limits) { 2 } else { (8 * count).max(64).ilog2().min(31) + 1 };
        self.words.clear();
        self.words.resize((1usize << self.bits).div_ceil(64), 0);
    }

    /// Sets the bit of a hash. True if it was set before.
    #[inline(always)]
    pub fn insert(&mut self, hash: u32) -> bool {
        let (word, bit) = place(hash, self.bits);
        let was_set = self.words[word] & bit != 0;
        self.words[word] |= bit;
        was_set
    }

    /// True if the bit of a hash is set.
    fn contains(&self, hash: u32) -> bool {
        let (word, bit) = place(hash, self.bits);
        self.words[word] & bit != 0
    }
}

/// The word and the bit of a hash.
#[inline(always)]
fn place(hash: u32, bits: u32) -> (usize, u64) {
    let at = ((u64::from(hash) << bits) >> 32) as usize;
    (at / 64, 1 << (at % 64))
}

/// Which hashes occur, and which occur more than once: two bits for each of many hash values.
#[derive(Debug, Default)]
pub(crate) struct SeenHashes {
    once: HashFilter,
    twice: HashFilter,
    /// How many hashes had a bit that was set before. No fewer vertices than this have a hash of `twice`,
    /// and no more than twice as many.
    pub collisions: usize,
}

impl SeenHashes {
    /// Removes all hashes, and chooses a size for `count` of them.
    pub fn clear(&mut self, count: usize) {
        self.once.clear(count);
        self.twice.clear(count);
        self.collisions = 0;
    }

    pub fn add(&mut self, hashes: &[u32]) {
        let (once, twice) = (&mut self.once.words[..], &mut self.twice.words[..]);
        let twice = &mut twice[..once.len()];
        for &hash in hashes {
            let (word, bit) = place(hash, self.once.bits);
            let found = once[word] & bit;
            twice[word] |= found;
            once[word] |= bit;
            self.collisions += usize::from(found != 0);
        }
    }

    /// Adds the hashes of another list of the same size.
    pub fn merge(&mut self, other: &Self) {
        let ours = self.once.words.iter_mut().zip(&mut self.twice.words);
        let others = other.once.words.iter().zip(&other.twice.words);
        let mut in_both = 0;
        for ((once, twice), (other_once, other_twice)) in ours.zip(others) {
            let both = *once & other_once;
            in_both += both.count_ones() as usize;
            *twice |= other_twice | both;
            *once |= other_once;
        }
        self.collisions += other.collisions + in_both;
    }

    /// True if the bit of a hash was set more than once.
    pub fn occurs_twice(&self, hash: u32) -> bool {
        self.twice.contains(hash)
    }
}
