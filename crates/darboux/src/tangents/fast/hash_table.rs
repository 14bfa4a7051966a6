//! What has been met, by hash.

/// Numbered things in lists by hash. They are put in when something is looked for: many at once, for whose memory is waited together.
#[derive(Debug, Default)]
pub(crate) struct Chains {
    /// Of all things.
    hashes: Vec<u32>,
    /// The last thing of each list, and the one before each thing that is in a list; or [`END`].
    last: Vec<u32>,
    before: Vec<u32>,
}

/// Many things have one hash, by bad luck or by intent: looking for them would take long.
pub(crate) struct Crowded;

/// So many things are looked at.
const LONGEST_LIST: usize = 256;

/// The end of a list.
const END: u32 = u32::MAX;

impl Chains {
    /// Nothing, in a size for about `count`.
    pub fn clear(&mut self, count: usize) {
        let count = if cfg!(small_limits) { count / 16 } else { count };
        let lists = count.next_power_of_two();
        self.last.clear();
        self.last.resize(lists, END);
        self.before.clear();
        self.hashes.clear();
    }

    /// Takes the next thing.
    #[inline(always)]
    pub fn push(&mut self, hash: u32) {
        self.hashes.push(hash);
    }

    /// The hashes of all things.
    pub fn hashes(&self) -> &[u32] {
        &self.hashes
    }

    /// The last thing of this hash that is the one looked for. Errors: the list is too long.
    #[inline(never)]
    pub fn find(&mut self, hash: u32, is_it: impl Fn(u32) -> bool) -> Result<Option<u32>, Crowded> {
        self.put_in();
        let mut thing = self.last[list(hash, self.last.len())];
        for _ in 0..LONGEST_LIST {
            if thing == END {
                return Ok(None);
            }
            if self.hashes[thing as usize] == hash && is_it(thing) {
                return Ok(Some(thing));
            }
            thing = self.before[thing as usize];
        }
        Err(Crowded)
    }

    fn put_in(&mut self) {
        let (first, lists) = (self.before.len(), self.last.len());
        let put_in = |(&hash, thing)| std::mem::replace(&mut self.last[list(hash, lists)], thing);
        self.before.extend(self.hashes[first..].iter().zip(first as u32..).map(put_in));
    }
}

/// The list of a hash, of a power of two of them: by the highest bits.
fn list(hash: u32, lists: usize) -> usize {
    ((u64::from(hash) * lists as u64) >> 32) as usize
}

/// One bit for each of many hash values.
#[derive(Debug, Default)]
pub(crate) struct BitMap {
    pub words: Vec<u64>,
    /// How many of a hash's highest bits choose the bit.
    pub bits: u32,
}

impl BitMap {
    /// No bit set, in a size for `count` hashes.
    pub fn clear(&mut self, count: usize) {
        self.bits = if cfg!(small_limits) { 2 } else { (8 * count).max(64).ilog2().min(31) + 1 };
        self.words.clear();
        self.words.resize((1usize << self.bits).div_ceil(64), 0);
    }

    /// Sets a hash's bit; true if it was.
    #[inline(always)]
    pub fn set(&mut self, hash: u32) -> bool {
        let (word, bit) = place(hash, self.bits);
        let was_set = self.words[word] & bit != 0;
        self.words[word] |= bit;
        was_set
    }

    /// True if a hash's bit is set.
    pub fn has(&self, hash: u32) -> bool {
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

/// Marks hashes in `seen` and those met before in `again`, both the words from `first` on; returns how many of these there are.
pub(crate) fn mark_collisions(
    hashes: &[u32],
    bits: u32,
    first: usize,
    seen: &mut [u64],
    again: &mut [u64],
) -> usize {
    let mut collisions = 0;
    if seen.is_empty() {
        return 0;
    }
    for &hash in hashes {
        let (word, bit) = place(hash, bits);
        // Whether a hash is among these words cannot be foretold: no branch.
        let at = word.wrapping_sub(first);
        let (at, bit) = if at < seen.len() { (at, bit) } else { (0, 0) };
        let met = seen[at] & bit;
        again[at] |= met;
        seen[at] |= bit;
        collisions += usize::from(met != 0);
    }
    collisions
}
