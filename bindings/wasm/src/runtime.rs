//! What the standard library would provide: the allocator, and what happens on a panic.
//!
//! Neither may trap. Where the core cannot continue, it calls JavaScript, which throws.

use core::alloc::{GlobalAlloc, Layout};
use core::arch::wasm32::memory_size;
use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, Ordering::Relaxed};

use dlmalloc::GlobalDlmalloc;

use crate::call::stack;

#[link(wasm_import_module = "sweep_and_prune")]
unsafe extern "C" {
    /// Throws: `OutOfMemoryError`, or an internal error.
    safe fn fail(is_out_of_memory: bool) -> !;
}

/// The allocator. It notes whether its last allocation failed, and checks for stack before it changes anything.
struct Noting;

static LAST_FAILED: AtomicBool = AtomicBool::new(false);

fn note(pointer: *mut u8) -> *mut u8 {
    LAST_FAILED.store(pointer.is_null(), Relaxed);
    pointer
}

// SAFETY: each method hands its arguments, with their contract, to the same method of another
// allocator, and returns what that returned.
unsafe impl GlobalAlloc for Noting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        stack::check(stack::ALLOCATOR);
        // SAFETY: as above.
        note(unsafe { GlobalDlmalloc.alloc(layout) })
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        stack::check(stack::ALLOCATOR);
        // SAFETY: as above.
        note(unsafe { GlobalDlmalloc.alloc_zeroed(layout) })
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        stack::check(stack::ALLOCATOR);
        // SAFETY: as above.
        note(unsafe { GlobalDlmalloc.realloc(pointer, layout, size) })
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        stack::check(stack::ALLOCATOR);
        // SAFETY: as above.
        unsafe { GlobalDlmalloc.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Noting = Noting;

/// A gigabyte, in pages of WebAssembly.
const GIGABYTE: usize = 1 << 14;

/// A panic is a bug, or means that memory has run out. `alloc` panics in two cases: an allocation has failed, or its size
/// does not fit 32 bits. An array that grows reaches the second case only after it has taken a gigabyte. The message of
/// the panic is not read: formatting it would add 1.5 KB, for code that prints numbers, to the finder's 40 KB.
#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    fail(LAST_FAILED.load(Relaxed) || memory_size(0) >= GIGABYTE)
}
