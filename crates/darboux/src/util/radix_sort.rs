//! Stable sorting by integer keys: insertion sort for short lists, radix sort (least significant byte first)
//! for long ones.
//!
//! It replaces the standard library's sort for the sake of code size in the WebAssembly build: the standard
//! sort is ten times as large and compiled once per element type. It is not slower here, because lists are
//! short, nearly sorted or very long.

/// The longest list that is sorted by insertion, without a buffer.
pub(crate) const MAX_INSERTION_SORT: usize = if cfg!(small_limits) { 4 } else { 64 };

/// Sorts integers.
pub(crate) fn sort<T: Copy + Into<u64>>(list: &mut [T]) {
    sort_by_key(list, |&number| number.into(), &mut Vec::new());
}

/// Sorts a list by keys (stable).
///
/// `buffer`: scratch memory for lists longer than [`MAX_INSERTION_SORT`].
#[inline(never)]
pub(crate) fn sort_by_key<T: Copy>(list: &mut [T], key: impl Fn(&T) -> u64, buffer: &mut Vec<T>) {
    if list.len() > MAX_INSERTION_SORT {
        return sort_by_bytes(list, key, buffer);
    }
    for end in 1..list.len() {
        let element = list[end];
        let mut at = end;
        while at > 0 && key(&list[at - 1]) > key(&element) {
            list[at] = list[at - 1];
            at -= 1;
        }
        list[at] = element;
    }
}

/// Counting sort by each byte in which keys differ, the lowest first.
fn sort_by_bytes<T: Copy>(list: &mut [T], key: impl Fn(&T) -> u64, buffer: &mut Vec<T>) {
    if list.is_sorted_by_key(&key) {
        return;
    }
    let first = key(&list[0]);
    let differing = list.iter().fold(0, |bits, element| bits | (key(element) ^ first));
    buffer.clear();
    buffer.extend_from_slice(list);
    for shift in (0..u64::BITS).step_by(8).filter(|shift| differing >> shift & 0xff != 0) {
        let byte = |element: &T| (key(element) >> shift) as usize & 0xff;
        // The next free slot of each byte value.
        let mut next = [0; 257];
        list.iter().for_each(|element| next[byte(element) + 1] += 1);
        for byte in 0..256 {
            next[byte + 1] += next[byte];
        }
        for element in &*list {
            let next = &mut next[byte(element)];
            buffer[*next] = *element;
            *next += 1;
        }
        list.copy_from_slice(buffer);
    }
}

/// Packs two numbers into one, which sorts by the first and then by the second.
pub(crate) fn pair(first: u32, second: u32) -> u64 {
    u64::from(first) << 32 | u64::from(second)
}

/// The first number of a [`pair`].
pub(crate) fn first(pair: u64) -> u32 {
    (pair >> 32) as u32
}

/// The second number of a [`pair`].
pub(crate) fn second(pair: u64) -> u32 {
    pair as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_are_sorted_and_equals_keep_their_order() {
        for count in [0, 1, 5, MAX_INSERTION_SORT as u32, 1000] {
            let random = |at: u32| at.wrapping_mul(2_654_435_761) >> 3;
            let pairs: Vec<u64> =
                (0..count).map(|at| pair(random(at) % 300_000, random(at + 7) % 3)).collect();
            let (mut ours, mut theirs) = (pairs.clone(), pairs.clone());
            sort(&mut ours);
            theirs.sort_unstable();
            assert_eq!(ours, theirs);
            let (mut ours, mut theirs) = (pairs.clone(), pairs);
            sort_by_key(&mut ours, |&pair| second(pair).into(), &mut Vec::new());
            theirs.sort_by_key(|&pair| second(pair));
            assert_eq!(ours, theirs);
        }
    }
}
