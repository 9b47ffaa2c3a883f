//! What is read in order comes from memory ten times as fast as what is read here and there: 0.9
//! against 8 to 11 ns a line for tables of 10 MB (one core of a virtual AMD EPYC of 2024, which has
//! some 4 MB of its third cache to itself). So a table that fits there is read through before it is
//! read here and there: worth while where more than one line in so many is looked at.

use alloc::vec::Vec;
use core::hint::black_box;

use crate::finder::{enlarge_pages, prefetch};

/// The bytes that come from memory at once.
const LINE: usize = 64;
/// Of a table of more bytes than the second cache holds only some is that near after it was read through.
const FITS: usize = 1 << 20;

/// Reads a table from front to back, so that it is near when its items are looked at out of order.
#[inline]
pub(super) fn warm<V: Copy>(table: &[V]) {
    let stride = (LINE / size_of::<V>().max(1)).max(1);
    for item in table.iter().step_by(stride) {
        black_box(*item);
    }
}

/// Whether to call what is needed a little later: not where all of a table that was read through is
/// still near, nor where the processor cannot be told.
pub(super) fn is_far<V>(table: &[V]) -> bool {
    cfg!(target_arch = "x86_64") && size_of_val(table) > FITS
}

/// Calls the line of an item from memory, and does not wait for it.
#[inline(always)]
pub(super) fn call<V>(table: &[V], at: usize) {
    prefetch(table.as_ptr().wrapping_add(at));
}

/// Makes room for so many more items, behind large pages where there are many: what is looked at here
/// and there in many small ones costs a walk of the page tables each time.
#[inline(never)]
pub(super) fn make_room<V>(table: &mut Vec<V>, more: usize) {
    if table.capacity() - table.len() < more {
        table.reserve(more);
        enlarge_pages(table);
    }
}
