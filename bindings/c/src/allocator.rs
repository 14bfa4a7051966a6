//! Memory: the system's, or the caller's own.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::UnsafeCell;
use std::ffi::c_void;
use std::ptr::null_mut;
use std::sync::atomic::{AtomicU8, Ordering};

use crate::pointers::null;
use crate::status::{Error, call, darboux_status};

/// Gives memory: `size` bytes at a multiple of `alignment`, a power of two. Null ends the program.
pub type darboux_allocate =
    Option<unsafe extern "C" fn(context: *mut c_void, size: usize, alignment: usize) -> *mut c_void>;

/// Takes memory back, with the size and alignment that it was asked for with.
pub type darboux_deallocate =
    Option<unsafe extern "C" fn(context: *mut c_void, memory: *mut c_void, size: usize, alignment: usize)>;

/// Has all of the library's memory come from the caller's functions.
///
/// Call it before any other function of the library: memory that was taken elsewhere could not be given back. `allocate`,
/// `deallocate`: called from any thread that calls the library and from the threads of every context that was made with more than one,
/// several at once. `context`: passed to them.
/// Errors: null; the library has memory already.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_set_allocator(
    allocate: darboux_allocate,
    deallocate: darboux_deallocate,
    context: *mut c_void,
) -> darboux_status {
    call(|| {
        let (Some(allocate), Some(deallocate)) = (allocate, deallocate) else {
            return Err(null("an allocator's function"));
        };
        ALLOCATOR.set(Functions { allocate, deallocate, context })
    })
}

#[derive(Clone, Copy)]
struct Functions {
    allocate: unsafe extern "C" fn(*mut c_void, usize, usize) -> *mut c_void,
    deallocate: unsafe extern "C" fn(*mut c_void, *mut c_void, usize, usize),
    context: *mut c_void,
}

#[global_allocator]
static ALLOCATOR: Allocator = Allocator { state: AtomicU8::new(UNDECIDED), functions: UnsafeCell::new(None) };

/// Decided once: by the first allocation, or by a caller before it.
struct Allocator {
    state: AtomicU8,
    functions: UnsafeCell<Option<Functions>>,
}

const UNDECIDED: u8 = 0;
const BEING_SET: u8 = 1;
const SYSTEM: u8 = 2;
const CALLERS: u8 = 3;

// SAFETY: `functions` is written by the one thread that turned the state from UNDECIDED to BEING_SET, and read after CALLERS.
unsafe impl Sync for Allocator {}

impl Allocator {
    fn set(&self, functions: Functions) -> Result<(), Error> {
        if self.decide(BEING_SET) != UNDECIDED {
            let message = "the library has memory already; set the allocator before any other call";
            return Err(Error::new(darboux_status::TooLate, message.into()));
        }
        // SAFETY: no other thread reads or writes it in this state.
        unsafe { *self.functions.get() = Some(functions) };
        self.state.store(CALLERS, Ordering::Release);
        Ok(())
    }

    /// Leaves UNDECIDED for `next`. Returns the state that was.
    fn decide(&self, next: u8) -> u8 {
        let decided = self.state.compare_exchange(UNDECIDED, next, Ordering::Acquire, Ordering::Acquire);
        decided.unwrap_or_else(|state| state)
    }

    /// The caller's functions, if they were set.
    fn functions(&self) -> Option<Functions> {
        loop {
            match self.state.load(Ordering::Acquire) {
                SYSTEM => return None,
                // SAFETY: written before the state was, and never again.
                CALLERS => return unsafe { *self.functions.get() },
                BEING_SET => std::hint::spin_loop(),
                _ => _ = self.decide(SYSTEM),
            }
        }
    }
}

// SAFETY: either the system's allocator throughout, or the caller's functions, which promise the same.
unsafe impl GlobalAlloc for Allocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        match self.functions() {
            // SAFETY: as of this function.
            None => unsafe { System.alloc(layout) },
            // SAFETY: the caller promised a function that can be called so.
            Some(own) => unsafe { (own.allocate)(own.context, layout.size(), layout.align()).cast() },
        }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        match self.functions() {
            // SAFETY: as of this function.
            None => unsafe { System.dealloc(memory, layout) },
            // SAFETY: the memory came from `allocate`, as the state never changes.
            Some(own) => unsafe {
                (own.deallocate)(own.context, memory.cast(), layout.size(), layout.align());
            },
        }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        if self.functions().is_none() {
            // SAFETY: as of this function.
            return unsafe { System.alloc_zeroed(layout) };
        }
        // SAFETY: as of this function.
        let memory = unsafe { self.alloc(layout) };
        if !memory.is_null() {
            // SAFETY: as many bytes were asked for.
            unsafe { memory.write_bytes(0, layout.size()) };
        }
        memory
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        if self.functions().is_none() {
            // SAFETY: as of this function.
            return unsafe { System.realloc(memory, layout, size) };
        }
        let Ok(larger) = Layout::from_size_align(size, layout.align()) else { return null_mut() };
        // SAFETY: as of this function.
        let moved = unsafe { self.alloc(larger) };
        if !moved.is_null() {
            // SAFETY: both are as long, and new memory overlaps nothing.
            unsafe { moved.copy_from_nonoverlapping(memory, layout.size().min(size)) };
            // SAFETY: as of this function.
            unsafe { self.dealloc(memory, layout) };
        }
        moved
    }
}
