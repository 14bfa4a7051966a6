//! The last resort where memory is missing: one sentence and the exit code of a failed file, where Rust's own
//! allocator ends the process by SIGABRT.
//!
//! Limits that are known are kept before memory is allocated (`memory.rs`). This allocator answers where the
//! system still refuses.

use std::alloc::{GlobalAlloc, Layout, System};

use crate::exit;

/// The system's allocator; if it has no memory, the process ends with a sentence. For programs of their own
/// only.
pub struct ExitWithoutMemory;

const SENTENCE: &[u8] = b"error: there is not enough memory; give the process more memory (ulimit -v, the \
     limit of its container), process fewer files at the same time (--jobs 1), or smaller ones\n";

/// Ends the process where `memory` is null. Nothing is allocated, and no handler runs: temporary files are
/// left to the next run.
fn or_exit(memory: *mut u8) -> *mut u8 {
    if memory.is_null() {
        // SAFETY: `write` reads the bytes of a constant, and `_exit` does not return; both may be called
        // anywhere.
        unsafe {
            libc::write(libc::STDERR_FILENO, SENTENCE.as_ptr().cast(), SENTENCE.len());
            libc::_exit(exit::FAILED.into());
        }
    }
    memory
}

/// Lets all threads allocate from one arena where addresses are limited, as by `ulimit -v`. Otherwise glibc
/// reserves at least 64 MiB of addresses for each thread, which the limit counts and nothing uses.
pub fn share_arena_where_addresses_are_limited() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    {
        let mut limit = libc::rlimit { rlim_cur: libc::RLIM_INFINITY, rlim_max: libc::RLIM_INFINITY };
        // SAFETY: `getrlimit` writes the limit at a valid address; `mallopt` may be called at any time and
        // changes the arenas of later threads alone.
        unsafe {
            libc::getrlimit(libc::RLIMIT_AS, &raw mut limit);
            if limit.rlim_cur != libc::RLIM_INFINITY {
                libc::mallopt(libc::M_ARENA_MAX, 1);
            }
        }
    }
}

// SAFETY: every call goes to the system's allocator with the caller's arguments, and its memory is returned
// as it is.
unsafe impl GlobalAlloc for ExitWithoutMemory {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller keeps the contract of `alloc`.
        or_exit(unsafe { System.alloc(layout) })
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller keeps the contract of `alloc_zeroed`.
        or_exit(unsafe { System.alloc_zeroed(layout) })
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: the caller keeps the contract of `realloc`.
        or_exit(unsafe { System.realloc(memory, layout, size) })
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps the contract of `dealloc`.
        unsafe { System.dealloc(memory, layout) }
    }
}
