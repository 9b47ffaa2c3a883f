//! Large pages for large arrays.
//!
//! Arrays of many megabytes that are written and read in no order cost a walk of the page tables
//! for every few lines, and one fault for every page when they are new. Pages of 2 MiB spare most
//! of both, where the system gives them on request: Linux in its usual setting (`madvise`).

use alloc::vec::Vec;

/// Asks for large pages behind an array that is to fill its capacity, if that surely holds a whole one. The system may
/// refuse, and nothing differs but time.
///
/// All pages of the array are named: if only some were, the system could not move it to where it can grow, and growing it
/// would copy it to new memory (300 million pairs were found in 11 s instead of 1.5 to 6).
#[cfg(all(
    feature = "std",
    target_os = "linux",
    any(target_arch = "x86_64", target_arch = "aarch64")
))]
pub fn enlarge_pages<V>(array: &mut Vec<V>) {
    use core::ffi::{c_int, c_void};

    unsafe extern "C" {
        fn madvise(address: *mut c_void, length: usize, advice: c_int) -> c_int;
    }
    const PAGE: usize = 4 << 10;
    const LARGE: usize = 2 << 20;
    const MADV_HUGEPAGE: c_int = 14;

    let length = array.capacity() * size_of::<V>();
    if length >= 2 * LARGE {
        let before = array.as_ptr().addr() % PAGE;
        let start = array.as_mut_ptr().cast::<u8>().wrapping_sub(before);
        // SAFETY: each page of the range holds at least one byte of the array's own allocation, and the advice changes
        // neither what the pages hold nor whether they may be used. Whether it is followed does not matter.
        unsafe { madvise(start.cast(), (before + length).next_multiple_of(PAGE), MADV_HUGEPAGE) };
    }
}

/// Elsewhere the system decides by itself.
#[cfg(not(all(
    feature = "std",
    target_os = "linux",
    any(target_arch = "x86_64", target_arch = "aarch64")
)))]
pub fn enlarge_pages<V>(_: &mut Vec<V>) {}
