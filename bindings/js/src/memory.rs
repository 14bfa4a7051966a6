//! Where arrays lie, for one thread: small blocks come from a list per size, large ones from the first free stretch that is long enough.
//!
//! A tenth of the code of the standard library's allocator, whose lists are made for many large blocks; there are a few dozen here.

use std::alloc::{GlobalAlloc, Layout};
use std::arch::wasm32::{memory_grow, memory_size};
use std::cell::UnsafeCell;
use std::ptr::null_mut;

/// Sizes are multiples of this, and so are places: no type of ours wants more.
const UNIT: usize = 64;

/// Blocks up to this many units are small.
const SMALL: usize = 16;

/// What small blocks are cut from.
const CHUNK: usize = 1 << 14;

/// WebAssembly's pages.
const PAGE: usize = 1 << 16;

struct Memory(UnsafeCell<Stretches>);

/// What is free. Places beyond the last byte of 4 GiB are 0, so that sums of places wrap.
struct Stretches {
    /// The first free block of so many units; each begins with the place of the next, or 0.
    small: [usize; SMALL + 1],
    /// The first free stretch; they lie in the order of places, and touch nowhere.
    large: *mut Stretch,
    /// Of the last chunk.
    next: usize,
    left: usize,
}

/// How a free stretch begins.
struct Stretch {
    bytes: usize,
    next: *mut Stretch,
}

#[global_allocator]
static MEMORY: Memory =
    Memory(UnsafeCell::new(Stretches { small: [0; SMALL + 1], large: null_mut(), next: 0, left: 0 }));

// SAFETY: the module has one thread.
unsafe impl Sync for Memory {}

// SAFETY: of free memory everything has one owner, a list or a caller; blocks have their layout's size rounded up to whole units, and begin at one.
unsafe impl GlobalAlloc for Memory {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: there is one thread, and none of this calls back.
        unsafe { (*self.0.get()).take(units(layout)) as *mut u8 }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        // SAFETY: as in `alloc`; the block is the caller's to give.
        unsafe { (*self.0.get()).give(block as usize, units(layout)) }
    }
}

fn units(layout: Layout) -> usize {
    layout.size().div_ceil(UNIT).max(1)
}

impl Stretches {
    /// The place of a block, or 0 where there is no more memory.
    #[inline(never)]
    unsafe fn take(&mut self, units: usize) -> usize {
        if units > SMALL {
            // SAFETY: as the caller's.
            return unsafe { self.take_large(units * UNIT) };
        }
        let first = self.small[units];
        if first != 0 {
            // SAFETY: a free block begins with the place of the next.
            self.small[units] = unsafe { *(first as *const usize) };
            return first;
        }
        if self.left < units * UNIT {
            // SAFETY: as the caller's.
            let chunk = unsafe { self.take_large(CHUNK) };
            if chunk == 0 {
                return 0;
            }
            // What is left of the last chunk is too little to look for a use.
            (self.next, self.left) = (chunk, CHUNK);
        }
        let place = self.next;
        (self.next, self.left) = (place + units * UNIT, self.left - units * UNIT);
        place
    }

    #[inline(never)]
    unsafe fn give(&mut self, place: usize, units: usize) {
        if units > SMALL {
            // SAFETY: as the caller's.
            return unsafe { self.give_large(place, units * UNIT) };
        }
        // SAFETY: the block is free, and has room for a place.
        unsafe { *(place as *mut usize) = self.small[units] };
        self.small[units] = place;
    }

    #[inline(never)]
    unsafe fn take_large(&mut self, bytes: usize) -> usize {
        // SAFETY: what is in the list is free and begins as a stretch does, and so does what is left of it.
        unsafe {
            let (mut at, mut last) = (&raw mut self.large, 0);
            while !(*at).is_null() {
                let stretch = *at;
                if (*stretch).bytes >= bytes {
                    *at = (*stretch).next;
                    if (*stretch).bytes > bytes {
                        let rest = stretch.byte_add(bytes);
                        *rest = Stretch { bytes: (*stretch).bytes - bytes, next: *at };
                        *at = rest;
                    }
                    return stretch as usize;
                }
                let end = (stretch as usize).wrapping_add((*stretch).bytes);
                last = if end == memory_size::<0>().wrapping_mul(PAGE) { (*stretch).bytes } else { 0 };
                at = &raw mut (*stretch).next;
            }
            let pages = (bytes - last).div_ceil(PAGE);
            let first = memory_grow::<0>(pages);
            if first == usize::MAX {
                return 0;
            }
            self.give_large(first * PAGE, pages * PAGE);
            self.take_large(bytes)
        }
    }

    #[inline(never)]
    unsafe fn give_large(&mut self, place: usize, mut bytes: usize) {
        // SAFETY: as in `take_large`; the stretch is free, and lies between those that are before and behind it.
        unsafe {
            let mut stretch = place as *mut Stretch;
            let (mut at, mut before) = (&raw mut self.large, null_mut::<Stretch>());
            while !(*at).is_null() && *at < stretch {
                before = *at;
                at = &raw mut (*before).next;
            }
            let mut next = *at;
            if !next.is_null() && place.wrapping_add(bytes) == next as usize {
                bytes += (*next).bytes;
                next = (*next).next;
            }
            if !before.is_null() && before as usize + (*before).bytes == place {
                bytes += (*before).bytes;
                stretch = before;
            } else {
                *at = stretch;
            }
            *stretch = Stretch { bytes, next };
        }
    }
}
