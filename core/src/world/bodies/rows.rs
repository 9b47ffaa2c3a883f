//! Tables with a row for each body.

use alloc::vec::Vec;

/// Writes a row, whose index is that of an existing one or the next.
pub fn put_row<V>(table: &mut Vec<V>, index: u32, value: V) {
    match table.get_mut(index as usize) {
        Some(row) => *row = value,
        None => table.push(value),
    }
}
