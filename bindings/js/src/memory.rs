//! Where arrays lie: blocks of about a hundred sizes, of which free ones wait in a list per size. An allocator that joins free blocks again takes ten
//! times the code; what calls keep from one to the next is given back with the whole memory.

use std::alloc::{GlobalAlloc, Layout};
use std::arch::wasm32::memory_grow;
use std::cell::UnsafeCell;
use std::ptr::null_mut;

/// Sizes are multiples of this, and so are places: no type of ours wants more.
const UNIT: usize = 64;

/// WebAssembly's pages.
const PAGE: usize = 1 << 16;

struct Memory(UnsafeCell<Blocks>);

struct Blocks {
    /// The first free block of each size; it begins with the place of the next.
    free: [*mut u8; 128],
    /// What of the memory was never used. Nobody else asks for pages, so that they follow each other.
    next: usize,
    end: usize,
}

#[global_allocator]
static MEMORY: Memory = Memory(UnsafeCell::new(Blocks { free: [null_mut(); 128], next: 0, end: 0 }));

// SAFETY: the module has one thread.
unsafe impl Sync for Memory {}

/// The number of the size that serves `bytes`, and that size: four for each doubling.
fn size(bytes: usize) -> (usize, usize) {
    let units = bytes.div_ceil(UNIT).max(1);
    let shift = units.ilog2().saturating_sub(2);
    let steps = (units - 1 >> shift) + 1;
    (4 * shift as usize + steps, steps << shift)
}

// SAFETY: blocks do not overlap, are as large as their size says and aligned as any type of the module wants; a block is in a list only while it is free.
unsafe impl GlobalAlloc for Memory {
    #[inline(never)]
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let (number, units) = size(layout.size());
        // SAFETY: nothing else holds the blocks: no function here is called from within another but for `realloc`, which holds none.
        let blocks = unsafe { &mut *self.0.get() };
        let first = blocks.free[number];
        if !first.is_null() {
            // SAFETY: a free block begins with the place of the next.
            blocks.free[number] = unsafe { first.cast::<*mut u8>().read() };
            return first;
        }
        let bytes = units * UNIT;
        // All places together are one more than a number can be.
        let left = blocks.end.wrapping_sub(blocks.next);
        if left < bytes {
            let pages = (bytes - left).div_ceil(PAGE);
            let start = memory_grow::<0>(pages);
            if start == usize::MAX {
                return null_mut();
            }
            if left == 0 {
                blocks.next = start * PAGE;
            }
            blocks.end = (start + pages).wrapping_mul(PAGE);
        }
        let place = blocks.next;
        blocks.next = place.wrapping_add(bytes);
        place as *mut u8
    }

    #[inline(never)]
    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        let (number, _) = size(layout.size());
        // SAFETY: as in `alloc`; the block has room for a place.
        unsafe {
            let blocks = &mut *self.0.get();
            block.cast::<*mut u8>().write(blocks.free[number]);
            blocks.free[number] = block;
        }
    }

    #[inline(never)]
    unsafe fn realloc(&self, block: *mut u8, layout: Layout, bytes: usize) -> *mut u8 {
        if size(bytes) == size(layout.size()) {
            return block;
        }
        // SAFETY: the caller's layout has its alignment; both blocks hold what is copied.
        unsafe {
            let moved = self.alloc(Layout::from_size_align_unchecked(bytes, layout.align()));
            if !moved.is_null() {
                block.copy_to_nonoverlapping(moved, bytes.min(layout.size()));
                self.dealloc(block, layout);
            }
            moved
        }
    }
}
