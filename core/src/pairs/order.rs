//! Stage 2: the boxes of a column in the order of their left edges, as a structure of arrays.
//!
//! A counting pass spreads the edges over about as many equal intervals as there are edges, one
//! pass exchanges neighbours, and insertion sort finishes. Where many edges fall into one interval
//! (clusters, equal edges), the standard library's sort does that interval, so the whole is
//! O(n log n) on any input.

use alloc::collections::TryReserveError;
use alloc::vec::Vec;
use core::ops::Range;

use super::bins::Source;
use super::kernel::Column;
use super::numbers::Ruler;
use super::plan::greater;
use crate::memory::grow;
use crate::{Aabb, Scalar};

/// Up to this many keys insertion sort has no need of intervals.
const FEW: usize = 24;

/// An interval with more keys than this goes to the standard sort.
const CROWD: u32 = 16;

/// The buffers of the sort.
#[derive(Debug)]
pub(super) struct Sorter<T: Scalar> {
    keys: Vec<T::Key>,
    sorted: Vec<T::Key>,
    lefts: Vec<T>,
    intervals: Vec<u32>,
    ends: Vec<u32>,
}

impl<T: Scalar> Sorter<T> {
    pub const fn new() -> Self {
        Self {
            keys: Vec::new(),
            sorted: Vec::new(),
            lefts: Vec::new(),
            intervals: Vec::new(),
            ends: Vec::new(),
        }
    }

    /// Fills `column` with the boxes of `source` in the order of left edge on `axis`, then place
    /// in the source.
    pub fn order<const D: usize, S: Source<D, T>>(
        &mut self,
        source: S,
        axis: usize,
        column: &mut Column<T>,
    ) -> Result<(), TryReserveError> {
        self.sort(source, axis)?;
        self.lay_out(source, axis, column)
    }

    /// Fills `column` with some of the boxes as they stand, all axes beside the sweep axis, on
    /// which all overlap: for a sweep that tests each against each.
    pub fn unordered<const D: usize, S: Source<D, T>>(
        source: S,
        boxes: Range<usize>,
        column: &mut Column<T>,
    ) -> Result<(), TryReserveError> {
        column.reset(boxes.len(), D)?;
        column.left[..boxes.len()].fill(T::ZERO);
        column.right[..boxes.len()].fill(T::ZERO);
        for (at, i) in boxes.enumerate() {
            let Aabb { min, max } = source.aabb(i);
            for axis in 0..D {
                column.min[axis][at] = min[axis];
                column.max[axis][at] = max[axis];
            }
            column.id[at] = source.id(i);
            column.marks[at] = source.marks(i);
        }
        Ok(())
    }

    /// Fills the column as the keys in `sorted` say.
    fn lay_out<const D: usize, S: Source<D, T>>(
        &self,
        source: S,
        axis: usize,
        column: &mut Column<T>,
    ) -> Result<(), TryReserveError> {
        let len = source.len();
        column.reset(len, D - 1)?;
        for (at, &key) in self.sorted[..len].iter().enumerate() {
            put(column, at, source, T::place(key) as usize, axis);
        }
        Ok(())
    }

    /// Leaves the sorted keys of the boxes in `sorted`.
    #[inline(never)]
    fn sort<const D: usize, S: Source<D, T>>(
        &mut self,
        source: S,
        axis: usize,
    ) -> Result<(), TryReserveError> {
        let len = source.len();
        grow(&mut self.sorted, len, T::Key::default())?;
        if len <= FEW {
            for (i, key) in self.sorted[..len].iter_mut().enumerate() {
                *key = edge(source, i, axis).key(i as u32);
            }
            insertion(&mut self.sorted[..len]);
            return Ok(());
        }
        grow(&mut self.keys, len, T::Key::default())?;
        grow(&mut self.lefts, len, T::ZERO)?;
        // The least and the greatest by their keys: comparing whole numbers takes less time.
        let mut least = edge(source, 0, axis).key(0);
        let mut greatest = least;
        for (i, (key, left)) in self.keys.iter_mut().zip(&mut self.lefts[..len]).enumerate() {
            *left = edge(source, i, axis);
            *key = left.key(i as u32);
            least = least.min(*key);
            greatest = greatest.max(*key);
        }
        self.spread(len, [least, greatest])
    }

    /// Leaves `keys`, of `lefts`, sorted in `sorted`; given are the least and the greatest of them.
    fn spread(&mut self, len: usize, ends: [T::Key; 2]) -> Result<(), TryReserveError> {
        let ends = ends.map(|key| self.lefts[T::place(key) as usize].to_f64());
        let unit = T::unit(greater(ends[0].abs(), ends[1].abs()));
        let [low, high] = ends.map(|end| (end * unit.to_f64()).clamp(-T::LIMIT, T::LIMIT));
        let count = len.next_power_of_two().min(1 << 16);
        let last = (count - 1) as f64;
        let [origin, scale, last] = [low, last / (high - low), last].map(T::from_f64);
        grow(&mut self.intervals, len, 0)?;
        let ruler = Ruler { unit, origin, scale, last };
        for (interval, left) in self.intervals.iter_mut().zip(&self.lefts[..len]) {
            *interval = left.cell(&ruler);
        }
        grow(&mut self.ends, count, 0)?;
        let ends = &mut self.ends[..count];
        ends.fill(0);
        for &interval in &self.intervals[..len] {
            ends[interval as usize] += 1;
        }
        let (mut total, mut most) = (0, 0);
        for end in &mut *ends {
            most = most.max(*end);
            total += core::mem::replace(end, total);
        }
        for (&key, &interval) in self.keys[..len].iter().zip(&self.intervals[..len]) {
            let end = &mut ends[interval as usize];
            self.sorted[*end as usize] = key;
            *end += 1;
        }
        if most > CROWD {
            let mut begin = 0;
            for &end in &*ends {
                if end - begin > CROWD {
                    self.sorted[begin as usize..end as usize].sort_unstable();
                }
                begin = end;
            }
        }
        exchange(&mut self.sorted[..len]);
        insertion(&mut self.sorted[..len]);
        Ok(())
    }
}

/// One pass of exchanges between neighbours, without a branch, which could not be foretold: most
/// keys that are not in their place are one beside it.
fn exchange<K: Copy + Ord>(keys: &mut [K]) {
    if let [first, ..] = *keys {
        let mut most = first;
        for i in 1..keys.len() {
            let key = keys[i];
            keys[i - 1] = most.min(key);
            most = most.max(key);
        }
        keys[keys.len() - 1] = most;
    }
}

#[inline(always)]
fn edge<const D: usize, T: Scalar, S: Source<D, T>>(source: S, i: usize, axis: usize) -> T {
    source.aabb(i).min[axis]
}

/// Insertion sort: linear where each key is near its place.
#[inline(never)]
fn insertion<K: Copy + Ord>(keys: &mut [K]) {
    for i in 1..keys.len() {
        let key = keys[i];
        let mut at = i;
        while at > 0 && key < keys[at - 1] {
            keys[at] = keys[at - 1];
            at -= 1;
        }
        keys[at] = key;
    }
}

/// Writes box `i` of the source to its position in the column.
#[inline(always)]
fn put<const D: usize, T: Scalar, S: Source<D, T>>(
    column: &mut Column<T>,
    at: usize,
    source: S,
    i: usize,
    axis: usize,
) {
    let Aabb { min, max } = source.aabb(i);
    column.left[at] = min[axis];
    column.right[at] = max[axis];
    let mut other = axis;
    for k in 0..D - 1 {
        other = if other + 1 == D { 0 } else { other + 1 };
        column.min[k][at] = min[other];
        column.max[k][at] = max[other];
    }
    column.id[at] = source.id(i);
    column.marks[at] = source.marks(i);
}
