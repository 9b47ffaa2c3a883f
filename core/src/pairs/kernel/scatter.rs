//! The last step of a counting sort, by one thread or by several at once: each has a list of what goes
//! to which column, and all write to one array.
//!
//! ```text
//! for each list: count what it has in each column
//! for each column, for each list: its slots begin where those before it end
//! for each list, on its own thread: write each value to the next slot of its list and column
//! ```
//!
//! No two threads write to one place. That follows from the counts, which are made here, of lists that
//! cannot change until they are written.

use core::marker::PhantomData;
use core::mem::{replace, take};

use crate::memory::prefetch;

/// Arrays above this many bytes exceed the second-level cache, so their lines are prefetched. (With large pages this
/// takes 0.69 to 0.85 of the time at 1,000,000 boxes in the plane and in space.)
const MOST_CACHED_BYTES: usize = 1 << 20;
/// How many bytes ahead to prefetch. A column is written front to back, so these are its next lines.
const PREFETCHED_BYTES_AHEAD: usize = 128;

/// The bits of [`Placement::column`] that are the column.
const COLUMN_BITS: u32 = 29;

/// Which column a box is copied to.
#[derive(Clone, Copy, Debug, Default)]
pub struct Placement {
    /// The column, and above it the dedup bits that the copy adds.
    column: u32,
    /// The position of the box in the source.
    pub of: u32,
}

impl Placement {
    /// The placement of box `of` in a column, to which its [dedup bits](Self::dedup_bit) are added.
    #[inline(always)]
    pub fn new(column: u32, of: u32) -> Self {
        Self { column, of }
    }

    /// What to add to a column to set the dedup bit of an axis.
    pub fn dedup_bit(axis: usize) -> u32 {
        1 << COLUMN_BITS << axis
    }

    #[inline(always)]
    pub fn column(self) -> usize {
        (self.column & ((1 << COLUMN_BITS) - 1)) as usize
    }

    #[inline(always)]
    pub fn dedup(self) -> u32 {
        self.column >> COLUMN_BITS
    }
}

/// A list of placements, and how many of them each column has.
#[derive(Debug)]
pub struct CountedPlacements<'a> {
    placements: &'a [Placement],
    /// How many each column has; while they are written, where the next one goes.
    ends: &'a mut [u32],
}

impl<'a> CountedPlacements<'a> {
    /// Counts. There is an end for each column.
    pub fn new(placements: &'a [Placement], ends: &'a mut [u32]) -> Self {
        ends.fill(0);
        for placement in placements {
            ends[placement.column()] += 1;
        }
        Self { placements, ends }
    }

    /// How many placements there are.
    pub fn len(&self) -> usize {
        self.placements.len()
    }
}

/// Gives each list its slots in an array, which is exactly as long as all lists together: column by
/// column, and within a column list by list.
///
/// # Panics
/// If the array has another length, or the lists have different numbers of columns.
pub fn assign_slots<'a, V: Copy>(
    lists: &mut [CountedPlacements<'a>],
    array: &'a mut [V],
) -> impl Iterator<Item = ColumnSlots<'a, V>> {
    let columns = lists.first().map_or(0, |list| list.ends.len());
    let len = lists.iter().map(CountedPlacements::len).sum::<usize>();
    assert!(len == array.len() && u32::try_from(len).is_ok());
    assert!(lists.iter().all(|list| list.ends.len() == columns));
    let mut total = 0;
    let mut start = |end: &mut u32| total += replace(end, total);
    if let [list] = lists {
        list.ends.iter_mut().for_each(&mut start);
    } else {
        (0..columns).for_each(|at| lists.iter_mut().for_each(|list| start(&mut list.ends[at])));
    }
    let start = array.as_mut_ptr();
    // Taken, so that no list gets slots twice.
    lists.iter_mut().map(move |list| ColumnSlots {
        placements: take(&mut list.placements),
        ends: take(&mut list.ends),
        start,
        is_large: size_of::<V>() * len > MOST_CACHED_BYTES,
        array: PhantomData,
    })
}

/// The places in an array that one list fills. See [`assign_slots`].
#[derive(Debug)]
pub struct ColumnSlots<'a, V> {
    placements: &'a [Placement],
    ends: &'a mut [u32],
    start: *mut V,
    is_large: bool,
    array: PhantomData<&'a mut [V]>,
}

// SAFETY: it writes values to places that no other `ColumnSlots` of the array has.
unsafe impl<V: Send> Send for ColumnSlots<'_, V> {}

impl<V: Copy> ColumnSlots<'_, V> {
    /// Writes the value of each placement to its slot.
    #[inline(always)]
    pub fn write(self, value: impl Fn(Placement) -> V) {
        for &placement in self.placements {
            let value = value(placement);
            let end = &mut self.ends[placement.column()];
            // In bounds, as is the slot itself.
            let slot = self.start.wrapping_add(*end as usize);
            if self.is_large {
                prefetch(slot.wrapping_add(PREFETCHED_BYTES_AHEAD / size_of::<V>()));
            }
            // SAFETY: `assign_slots` gave each column of each list as many slots of the array, which
            // `self` has borrowed, as the list has placements in the column, and no two share one.
            // The list is the one that was counted: it has been borrowed since. So there is a slot
            // for this placement.
            unsafe { slot.write(value) };
            *end += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;
    use alloc::vec::Vec;

    use super::*;

    /// More than 1 MiB, so that lines are prefetched; by one list and by three.
    #[test]
    fn values_are_sorted_by_column_and_stay_in_order_within_it() {
        for len in [0, 10, 40_000] {
            let column = |of: u32| (of.wrapping_mul(0x9E37_79B9) >> 8) % 1000;
            let all: Vec<_> = (0..len).map(|of| Placement::new(column(of), of)).collect();
            let mut expected: Vec<_> = all.iter().map(|it| [u64::from(it.of); 6]).collect();
            expected.sort_by_key(|&[of, ..]| all[of as usize].column());
            for lists in [1, 3] {
                let mut ends = vec![vec![0; 1000]; lists];
                let chunks = all.chunks(all.len().div_ceil(lists).max(1));
                let counted = chunks.zip(&mut ends);
                let mut counted: Vec<_> =
                    counted.map(|(chunk, ends)| CountedPlacements::new(chunk, ends)).collect();
                let mut array = vec![[u64::MAX; 6]; all.len()];
                assign_slots(&mut counted, &mut array)
                    .for_each(|slots| slots.write(|placement| [u64::from(placement.of); 6]));
                assert!(array == expected, "{len} in {lists} lists");
            }
        }
    }
}
