//! Arrays that grow, or tell that they cannot.

use alloc::collections::TryReserveError;
use alloc::vec::Vec;
use core::ops::ControlFlow;

use super::pages::enlarge_pages;
use crate::Error;

/// There is not enough memory. An error without content takes less code than [`Error`].
#[derive(Debug)]
pub struct OutOfMemory;

impl From<OutOfMemory> for Error {
    fn from(_: OutOfMemory) -> Self {
        Self::OutOfMemory
    }
}

/// Grows `array` to at least `size` items, with slack (an eighth; for small arrays twice the size), so that sizes that
/// vary a little from call to call do not reallocate each time. Never shrinks.
///
/// # Errors
/// If there is not enough memory; then the array is as it was.
pub fn grow<V: Copy>(array: &mut Vec<V>, size: usize, value: V) -> Result<(), TryReserveError> {
    if array.len() < size {
        grow_to(array, size + (size / 8).max(2 * size.min(2048)), value)?;
    }
    Ok(())
}

/// Grows `array` to exactly `size` items.
///
/// # Errors
/// As [`grow`].
#[cold]
pub fn grow_to<V: Copy>(array: &mut Vec<V>, size: usize, value: V) -> Result<(), TryReserveError> {
    array.try_reserve_exact(size - array.len())?;
    enlarge_pages(array);
    array.resize(size, value);
    Ok(())
}

/// Reserves capacity for `count` items in all, and an eighth more, so that numbers that vary a little do not reallocate.
///
/// # Errors
/// [`OutOfMemory`]: then the table is as it was.
#[inline(never)]
pub fn reserve_for<V>(table: &mut Vec<V>, count: usize) -> Result<(), OutOfMemory> {
    if table.capacity() < count {
        table.try_reserve(count + count / 8 - table.len()).map_err(|_| OutOfMemory)?;
        enlarge_pages(table);
    }
    Ok(())
}

/// Appends an item. Breaks, and the table is as it was, if there is no memory for it.
#[inline]
pub fn push<V>(table: &mut Vec<V>, item: V) -> ControlFlow<()> {
    if table.len() == table.capacity() {
        grow_by_one(table)?;
    }
    table.push(item);
    ControlFlow::Continue(())
}

#[cold]
#[inline(never)]
fn grow_by_one<V>(table: &mut Vec<V>) -> ControlFlow<()> {
    if table.try_reserve(1).is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
}

/// Reserves capacity for `more` items, and an eighth of all more, on large pages where they are many: random access to many
/// small pages costs a walk of the page tables each time.
#[inline(never)]
pub fn reserve<V>(table: &mut Vec<V>, more: usize) {
    if table.capacity() - table.len() < more {
        table.reserve_exact(more + (table.len() + more) / 8);
        enlarge_pages(table);
    }
}

/// The one item of a list, which is made if it is not there.
///
/// # Errors
/// If there is not enough memory.
pub fn only_item<V: Default>(list: &mut Vec<V>) -> Result<&mut V, TryReserveError> {
    if list.is_empty() {
        list.try_reserve_exact(1)?;
        list.push(V::default());
    }
    Ok(&mut list[0])
}
