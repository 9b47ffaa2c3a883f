//! Large pages for large arrays.
//!
//! Arrays of many megabytes that are written and read in no order cost a walk of the page tables
//! for every few lines, and one fault for every page when they are new. Pages of 2 MiB spare most
//! of both, where the system gives them on request: Linux in its usual setting (`madvise`).

use alloc::vec::Vec;

/// Asks for large pages behind the spare capacity of an array. The system may
/// refuse, and nothing differs but time. Only whole large pages are asked for, so that no memory is
/// taken that would not be anyway.
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
    const LARGE: usize = 2 << 20;
    const MADV_HUGEPAGE: c_int = 14;

    let spare = array.spare_capacity_mut().as_mut_ptr_range();
    let start = spare.start.cast::<u8>();
    let skipped = start.addr().next_multiple_of(LARGE) - start.addr();
    let pages = (spare.end.addr() - spare.start.addr()).saturating_sub(skipped) / LARGE;
    if pages > 0 {
        // SAFETY: the range lies in the array's own allocation, and the advice changes neither what
        // it holds nor whether it may be used. Whether it is followed does not matter.
        unsafe { madvise(start.add(skipped).cast(), pages * LARGE, MADV_HUGEPAGE) };
    }
}

/// Elsewhere the system decides by itself.
#[cfg(not(all(
    feature = "std",
    target_os = "linux",
    any(target_arch = "x86_64", target_arch = "aarch64")
)))]
pub fn enlarge_pages<V>(_: &mut Vec<V>) {}
