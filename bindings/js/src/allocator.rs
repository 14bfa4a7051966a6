//! The allocator of the modules. It notes a failed allocation, by which JavaScript tells missing memory from
//! a fault: both end in the same trap.

#[cfg(target_family = "wasm")]
use std::alloc::{GlobalAlloc, Layout};
use std::sync::atomic::{AtomicBool, Ordering};

static HAS_FAILED: AtomicBool = AtomicBool::new(false);

/// Smaller than the standard library's allocator by 2.4 kB compressed. The larger modules, which allocate
/// more often, keep that one.
#[cfg(all(target_family = "wasm", not(any(feature = "full", feature = "bake", feature = "check"))))]
#[global_allocator]
static ALLOCATOR: Watched<talc::wasm::WasmDynamicTalc> = Watched(talc::wasm::new_wasm_dynamic_allocator());

#[cfg(all(target_family = "wasm", any(feature = "full", feature = "bake", feature = "check")))]
#[global_allocator]
static ALLOCATOR: Watched<std::alloc::System> = Watched(std::alloc::System);

/// Whether an allocation has failed in this instance.
#[unsafe(no_mangle)]
pub extern "C" fn lacks_memory() -> bool {
    HAS_FAILED.load(Ordering::Relaxed)
}

/// Ends the call as a failed allocation does.
pub fn end_without_memory() -> ! {
    HAS_FAILED.store(true, Ordering::Relaxed);
    std::process::abort();
}

/// An allocator that notes when there is no memory.
#[cfg(target_family = "wasm")]
struct Watched<A>(A);

#[cfg(target_family = "wasm")]
fn noted(address: *mut u8) -> *mut u8 {
    if address.is_null() {
        HAS_FAILED.store(true, Ordering::Relaxed);
    }
    address
}

// SAFETY: every call is passed on unchanged.
#[cfg(target_family = "wasm")]
unsafe impl<A: GlobalAlloc> GlobalAlloc for Watched<A> {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller keeps the promises of this function.
        noted(unsafe { self.0.alloc(layout) })
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller keeps the promises of this function.
        noted(unsafe { self.0.alloc_zeroed(layout) })
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: the caller keeps the promises of this function.
        noted(unsafe { self.0.realloc(block, layout, size) })
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps the promises of this function.
        unsafe { self.0.dealloc(block, layout) }
    }
}
