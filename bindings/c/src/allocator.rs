//! The library's allocator: the system's allocator, or functions of the caller.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::UnsafeCell;
use std::ffi::c_void;
use std::ptr::null_mut;
use std::sync::atomic::{AtomicU8, Ordering};

use crate::pointers::null;
use crate::status::{Error, call, darboux_status};

/// Allocates `size` bytes at a multiple of `alignment`, which is a power of two. `context`: the pointer that
/// was passed to darboux_set_allocator. Where it returns NULL, the library aborts the program.
pub type darboux_allocate =
    Option<unsafe extern "C" fn(context: *mut c_void, size: usize, alignment: usize) -> *mut c_void>;

/// Frees memory. `size`, `alignment`: the values that the memory was allocated with.
pub type darboux_deallocate =
    Option<unsafe extern "C" fn(context: *mut c_void, memory: *mut c_void, size: usize, alignment: usize)>;

/// Makes the library allocate all of its memory with the caller's functions.
///
/// It must be called before any other function of the library, because memory of the system's allocator
/// cannot be freed with the caller's functions. `allocate`, `deallocate`: called concurrently, from all
/// threads that call the library and from the worker threads of contexts. `context`: passed to both
/// functions; may be NULL. Errors: a null function; the library has allocated memory already.
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

/// Either kind of allocator, chosen once: by darboux_set_allocator, or by the first allocation.
struct Allocator {
    state: AtomicU8,
    functions: UnsafeCell<Option<Functions>>,
}

const UNDECIDED: u8 = 0;
const BEING_SET: u8 = 1;
const SYSTEM: u8 = 2;
const CALLERS: u8 = 3;

// SAFETY: `functions` is written only by the thread that changed the state from UNDECIDED to BEING_SET, and
// read only after CALLERS.
unsafe impl Sync for Allocator {}

impl Allocator {
    fn set(&self, functions: Functions) -> Result<(), Error> {
        if self.decide(BEING_SET) != UNDECIDED {
            let message = "the library has memory already; set the allocator before any other call";
            return Err(Error::new(darboux_status::TooLate, message.into()));
        }
        // SAFETY: no other thread reads or writes `functions` in this state.
        unsafe { *self.functions.get() = Some(functions) };
        self.state.store(CALLERS, Ordering::Release);
        Ok(())
    }

    /// Changes the state from UNDECIDED to `next`; any other state stays. Returns the previous state.
    fn decide(&self, next: u8) -> u8 {
        let decided = self.state.compare_exchange(UNDECIDED, next, Ordering::Acquire, Ordering::Acquire);
        decided.unwrap_or_else(|state| state)
    }

    /// The caller's functions. `None` for the system's allocator.
    fn functions(&self) -> Option<Functions> {
        loop {
            match self.state.load(Ordering::Acquire) {
                SYSTEM => return None,
                // SAFETY: `functions` was written before the state became CALLERS, and is never written
                // again.
                CALLERS => return unsafe { *self.functions.get() },
                BEING_SET => std::hint::spin_loop(),
                _ => _ = self.decide(SYSTEM),
            }
        }
    }
}

// SAFETY: all calls go either to the system's allocator or to the caller's functions, which must meet the
// same contract.
unsafe impl GlobalAlloc for Allocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        match self.functions() {
            // SAFETY: the caller's promise.
            None => unsafe { System.alloc(layout) },
            // SAFETY: the caller of `darboux_set_allocator` promised a valid allocation function.
            Some(own) => unsafe { (own.allocate)(own.context, layout.size(), layout.align()).cast() },
        }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        match self.functions() {
            // SAFETY: the caller's promise.
            None => unsafe { System.dealloc(memory, layout) },
            // SAFETY: the memory came from `allocate`, because the state never changes again.
            Some(own) => unsafe {
                (own.deallocate)(own.context, memory.cast(), layout.size(), layout.align());
            },
        }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        if self.functions().is_none() {
            // SAFETY: the caller's promise.
            return unsafe { System.alloc_zeroed(layout) };
        }
        // SAFETY: the caller's promise.
        let memory = unsafe { self.alloc(layout) };
        if !memory.is_null() {
            // SAFETY: the allocation has `layout.size()` bytes.
            unsafe { memory.write_bytes(0, layout.size()) };
        }
        memory
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        if self.functions().is_none() {
            // SAFETY: the caller's promise.
            return unsafe { System.realloc(memory, layout, size) };
        }
        let Ok(larger) = Layout::from_size_align(size, layout.align()) else { return null_mut() };
        // SAFETY: the caller's promise.
        let moved = unsafe { self.alloc(larger) };
        if !moved.is_null() {
            // SAFETY: both allocations have at least so many bytes, and do not overlap.
            unsafe { moved.copy_from_nonoverlapping(memory, layout.size().min(size)) };
            // SAFETY: the caller's promise.
            unsafe { self.dealloc(memory, layout) };
        }
        moved
    }
}
