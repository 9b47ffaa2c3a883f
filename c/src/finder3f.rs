//! Finds pairs of boxes of the kind `3f`.

use std::ffi::c_void;

use crate::boxes3f::{boxes_at, sap_aabb3f};
use crate::common::{sap_pair, sap_pairs_callback};
use crate::failure::{Failure, run, sap_error, sap_status};
use crate::finder::{Finder, Sets};
use crate::handle::{Handle, create, destroy, write};
use crate::memory::{list, place};

/// Finds all pairs of boxes that overlap, each once, in an order that depends on the boxes alone. It keeps its memory from call
/// to call: a search like the one before allocates nothing.
pub struct sap_finder3f {
    _state: Finder<3, f32>,
}

impl Handle for sap_finder3f {
    type State = Finder<3, f32>;
    const NAME: &'static str = "sap_finder3f";
    const TAG: u64 = u64::from_le_bytes(*b"sapfin3f");
}

/// One set.
///
/// # Safety `boxes` is null or points to `count` boxes.
unsafe fn one_set<'a>(boxes: *const sap_aabb3f, count: usize) -> Result<Sets<'a, 3, f32>, Failure> {
    // SAFETY: as promised above.
    unsafe { Ok(Sets { boxes: boxes_at(boxes, count, "boxes")?, others: None }) }
}

/// Two sets.
///
/// # Safety `a` is null or points to `a_count` boxes, and `b` is null or points to `b_count` boxes.
unsafe fn two_sets<'a>(
    a: *const sap_aabb3f,
    a_count: usize,
    b: *const sap_aabb3f,
    b_count: usize,
) -> Result<Sets<'a, 3, f32>, Failure> {
    // SAFETY: as promised above.
    unsafe {
        let (boxes, others) = (boxes_at(a, a_count, "a")?, boxes_at(b, b_count, "b")?);
        Ok(Sets { boxes, others: Some(others) })
    }
}

/// Creates a finder that uses at most `threads` threads, and no more than there are processors; 0 counts as 1. The threads are
/// the finder's own. Destroy it by `sap_finder3f_destroy`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_finder3f_create(
    threads: u32,
    finder: *mut *mut sap_finder3f,
    error: *mut sap_error,
) -> sap_status {
    let call = || {
        // SAFETY: C promises it, see lib.rs.
        let finder = unsafe { place(finder, "finder")? };
        finder.set(create(Finder::new(threads)?))
    };
    // SAFETY: C promises it, see lib.rs.
    unsafe { run(error, call) }
}

/// Destroys a finder and sets the pointer to it to NULL. Does nothing if `finder` or the pointer that it points to is NULL, or
/// if the finder is in use.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_finder3f_destroy(finder: *mut *mut sap_finder3f) {
    let call = || {
        // SAFETY: C promises it, see lib.rs.
        unsafe { destroy(finder) };
        Ok(())
    };
    // SAFETY: there is no error to write.
    unsafe { run(std::ptr::null_mut(), call) };
}

/// Finds the pairs of boxes of one set that overlap, the smaller index first. `*pairs` points to memory of the finder, which
/// is valid until its next call; NULL if there are no pairs. Takes O(n log n + pairs) time on typical inputs.
///
/// Errors: `SAP_ERROR_INVALID_BOX`, `SAP_ERROR_TOO_MANY_BOXES`, `SAP_ERROR_OUT_OF_MEMORY`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_finder3f_find(
    finder: *mut sap_finder3f,
    boxes: *const sap_aabb3f,
    count: usize,
    pairs: *mut *const sap_pair,
    pair_count: *mut usize,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe { run(error, || find(finder, one_set(boxes, count)?, pairs, pair_count)) }
}

/// Finds the pairs of a box of the set `a` and a box of the set `b` that overlap: `a` of a pair is an index of the first set,
/// `b` an index of the second. Otherwise as `sap_finder3f_find`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_finder3f_find_between(
    finder: *mut sap_finder3f,
    a: *const sap_aabb3f,
    a_count: usize,
    b: *const sap_aabb3f,
    b_count: usize,
    pairs: *mut *const sap_pair,
    pair_count: *mut usize,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe { run(error, || find(finder, two_sets(a, a_count, b, b_count)?, pairs, pair_count)) }
}

/// # Safety As C promises it, see lib.rs.
unsafe fn find(
    finder: *mut sap_finder3f,
    sets: Sets<'_, 3, f32>,
    pairs: *mut *const sap_pair,
    pair_count: *mut usize,
) -> Result<(), Failure> {
    // SAFETY: as promised above.
    let (pairs, count) = unsafe { (place(pairs, "pairs")?, place(pair_count, "pair_count")?) };
    let find = |state: &mut Finder<3, f32>| {
        let found = state.find(sets)?;
        count.set(found.len())?;
        pairs.set(if found.is_empty() { std::ptr::null() } else { found.as_ptr() })
    };
    // SAFETY: as promised above.
    unsafe { write(finder, find) }
}

/// Finds the pairs of `sap_finder3f_find` and writes the first `capacity` of them to `pairs`, which may be NULL if `capacity`
/// is 0. `*pair_count` is how many there are in all. Uses one thread, and no memory for pairs.
///
/// Errors: as `sap_finder3f_find`. If a box is invalid, nothing has been written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_finder3f_find_into(
    finder: *mut sap_finder3f,
    boxes: *const sap_aabb3f,
    count: usize,
    pairs: *mut sap_pair,
    capacity: usize,
    pair_count: *mut usize,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let (sets, pairs) = (one_set(boxes, count)?, list(pairs, capacity, pair_count)?);
            write(finder, |state| state.find_into(sets, pairs))
        })
    }
}

/// Finds the pairs of `sap_finder3f_find_between`. Otherwise as `sap_finder3f_find_into`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_finder3f_find_between_into(
    finder: *mut sap_finder3f,
    a: *const sap_aabb3f,
    a_count: usize,
    b: *const sap_aabb3f,
    b_count: usize,
    pairs: *mut sap_pair,
    capacity: usize,
    pair_count: *mut usize,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let sets = two_sets(a, a_count, b, b_count)?;
            let pairs = list(pairs, capacity, pair_count)?;
            write(finder, |state| state.find_into(sets, pairs))
        })
    }
}

/// Counts the pairs of `sap_finder3f_find` without storing them.
///
/// Errors: as `sap_finder3f_find`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_finder3f_count(
    finder: *mut sap_finder3f,
    boxes: *const sap_aabb3f,
    count: usize,
    pair_count: *mut u64,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let (sets, place) = (one_set(boxes, count)?, place(pair_count, "pair_count")?);
            write(finder, |state| place.set(state.count(sets)?))
        })
    }
}

/// Counts the pairs of `sap_finder3f_find_between` without storing them.
///
/// Errors: as `sap_finder3f_find`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_finder3f_count_between(
    finder: *mut sap_finder3f,
    a: *const sap_aabb3f,
    a_count: usize,
    b: *const sap_aabb3f,
    b_count: usize,
    pair_count: *mut u64,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let sets = two_sets(a, a_count, b, b_count)?;
            let place = place(pair_count, "pair_count")?;
            write(finder, |state| place.set(state.count(sets)?))
        })
    }
}

/// Calls `callback` with the pairs of `sap_finder3f_find`, in their order, until it returns false. Uses one thread, and no
/// memory for pairs. The callback cannot use this finder: `SAP_ERROR_BUSY`.
///
/// Errors: as `sap_finder3f_find`. If a box is invalid, the callback has not been called.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_finder3f_each(
    finder: *mut sap_finder3f,
    boxes: *const sap_aabb3f,
    count: usize,
    callback: sap_pairs_callback,
    context: *mut c_void,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let sets = one_set(boxes, count)?;
            write(finder, |state| state.each(sets, callback, context))
        })
    }
}

/// Calls `callback` with the pairs of `sap_finder3f_find_between`. Otherwise as `sap_finder3f_each`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_finder3f_each_between(
    finder: *mut sap_finder3f,
    a: *const sap_aabb3f,
    a_count: usize,
    b: *const sap_aabb3f,
    b_count: usize,
    callback: sap_pairs_callback,
    context: *mut c_void,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let sets = two_sets(a, a_count, b, b_count)?;
            write(finder, |state| state.each(sets, callback, context))
        })
    }
}
