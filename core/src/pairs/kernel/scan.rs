//! The sweep itself, once for every instruction set: each box against those ahead of it.
//!
//! ```text
//! for each box in sweep order                      (the probe)
//!     for each box ahead, LANES at a time
//!         report those that overlap on every axis and are not reported by another column
//!         stop when a left edge passes the probe's right edge
//! ```
//!
//! The order of the pairs (by probe, then by position) does not depend on the number of lanes.

#[cfg(feature = "parallel")]
use alloc::vec::Vec;

use super::Coordinate;
use super::column::Column;
use super::output::{Notes, Output};
use super::vector::{Arrange, Reporter, Vector};

/// Where a sweep stands when its output is full: it is called again to go on.
#[derive(Clone, Copy, Debug)]
pub struct Cursor {
    /// The next probe of the first column, and of the second where there are two.
    pub first: usize,
    pub second: usize,
    /// How far ahead of the probe the scan has come.
    pub ahead: usize,
    /// Before which probe the sweep ends, of those of all columns in sweep order.
    #[cfg(feature = "parallel")]
    end: usize,
    pub done: bool,
}

impl Default for Cursor {
    /// Of the whole sweep.
    fn default() -> Self {
        Self {
            first: 0,
            second: 0,
            ahead: 0,
            #[cfg(feature = "parallel")]
            end: usize::MAX,
            done: false,
        }
    }
}

impl Cursor {
    /// Whether the next probe is beyond those of its stretch.
    #[inline(always)]
    fn is_at_end(&self) -> bool {
        #[cfg(feature = "parallel")]
        return self.first + self.second >= self.end;
        #[cfg(not(feature = "parallel"))]
        false
    }

    /// The sweep of columns that stand ordered in stretches of so many probes, one behind the other.
    #[cfg(feature = "parallel")]
    pub fn stretches<T: Coordinate>(columns: &[Column<T>], probes: usize) -> Vec<Self> {
        let boxes = columns.iter().map(Column::len).sum();
        let stretch = |begin| {
            let first = columns.get(1).map_or(begin, |second| part(&columns[0], second, begin));
            let end = begin + probes;
            Self { first, second: begin - first, end, ..Self::default() }
        };
        (0..boxes).step_by(probes).map(stretch).collect()
    }
}

/// How many of the first so many probes are boxes of the first column. Binary search (Odeh et al.
/// 2012, "Merge Path").
#[cfg(feature = "parallel")]
fn part<T: Coordinate>(first: &Column<T>, second: &Column<T>, probes: usize) -> usize {
    let (mut low, mut high) = (probes.saturating_sub(second.len()), probes.min(first.len()));
    while low < high {
        let middle = (low + high) / 2;
        if first.left[middle] <= second.left[probes - 1 - middle] {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    low
}

/// Pairs of one column, with `K` axes tested beside the sweep axis. Writes to `out` and returns how
/// many; `cursor.done` tells whether that was all. The scan of a box stops where `out` has no room
/// for a full vector.
///
/// # Safety
/// The instructions of `V` are present; `column.is_ready(K)`; `out.len() >= V::LANES`.
#[inline(always)]
pub(super) unsafe fn within<T: Coordinate, V: Vector<T>, const K: usize>(
    column: &Column<T>,
    cursor: &mut Cursor,
    out: &mut [[u32; 2]],
) -> usize {
    let (mut output, mut notes) = (Output::<V>::new(out), Notes::new());
    loop {
        while cursor.first < column.len() && !cursor.is_at_end() && !output.is_full() {
            let i = cursor.first;
            // SAFETY: i < len, and the scan begins at i + 1 + ahead, which the last vector of the
            // sentinels ends.
            let finished = unsafe {
                let probe = Probe::<T, V, K>::new(column, i, true, false);
                probe.scan(column, i + 1, &mut cursor.ahead, &mut output, &mut notes)
            };
            if finished {
                cursor.first = i + 1;
                cursor.ahead = 0;
            }
        }
        cursor.done = !output.is_full();
        // SAFETY: the column is that which is swept.
        if !unsafe { output.make_room([column], true, &mut notes) } || cursor.done {
            return output.written();
        }
    }
}

/// Pairs of one box of each column. The probe is whichever comes first in sweep order, the first
/// column's where both begin together.
///
/// # Safety
/// The instructions of `V` are present; both columns are ready for `K`; `out.len() >= V::LANES`.
#[inline(always)]
pub(super) unsafe fn between<T: Coordinate, V: Vector<T>, const K: usize>(
    [a, b]: [&Column<T>; 2],
    arrange: Arrange,
    cursor: &mut Cursor,
    out: &mut [[u32; 2]],
) -> usize {
    let ascending = arrange == Arrange::Ascending;
    let (mut output, mut notes) = (Output::<V>::new(out), Notes::new());
    loop {
        // Where one column has ended, nothing of it is ahead of the rest of the other.
        while cursor.first < a.len()
            && cursor.second < b.len()
            && !cursor.is_at_end()
            && !output.is_full()
        {
            let Cursor { first: i, second: j, .. } = *cursor;
            // SAFETY: i and j are positions of boxes; a scan begins at a box or at the sentinels.
            let finished = unsafe {
                if *a.left.get_unchecked(i) <= *b.left.get_unchecked(j) {
                    let probe = Probe::<T, V, K>::new(a, i, ascending, false);
                    let finished = probe.scan(b, j, &mut cursor.ahead, &mut output, &mut notes);
                    cursor.first += usize::from(finished);
                    finished
                } else {
                    let probe = Probe::<T, V, K>::new(b, j, ascending, true);
                    let finished = probe.scan(a, i, &mut cursor.ahead, &mut output, &mut notes);
                    cursor.second += usize::from(finished);
                    finished
                }
            };
            if finished {
                cursor.ahead = 0;
            }
        }
        cursor.done = !output.is_full();
        // SAFETY: the columns are those which are swept.
        if !unsafe { output.make_room([a, b], ascending, &mut notes) } || cursor.done {
            return output.written();
        }
    }
}

/// One box, spread over vectors.
struct Probe<T, V, const K: usize> {
    last: T,
    right: V,
    min: [V; K],
    max: [V; K],
    reporter: Reporter,
}

impl<T: Coordinate, V: Vector<T>, const K: usize> Probe<T, V, K> {
    /// # Safety
    /// `i` is the position of a box in a column that is ready for `K`.
    #[inline(always)]
    unsafe fn new(column: &Column<T>, i: usize, ascending: bool, in_first: bool) -> Self {
        // SAFETY: i is inside every array.
        unsafe {
            Self {
                last: *column.right.get_unchecked(i),
                right: V::splat(*column.right.get_unchecked(i)),
                min: core::array::from_fn(|k| V::splat(*column.min[k].get_unchecked(i))),
                max: core::array::from_fn(|k| V::splat(*column.max[k].get_unchecked(i))),
                reporter: Reporter {
                    id: *column.id.get_unchecked(i),
                    marks: *column.marks.get_unchecked(i),
                    ascending,
                    in_first,
                },
            }
        }
    }

    /// Tests the boxes from `start + ahead` on. Returns false if it stopped because the output was
    /// full; then `ahead` tells where to go on.
    ///
    /// # Safety
    /// `start + ahead <= column.len()`, and the column is ready for `K`; the output is not full.
    #[inline(always)]
    unsafe fn scan(
        &self,
        column: &Column<T>,
        start: usize,
        ahead: &mut usize,
        output: &mut Output<'_, V>,
        notes: &mut Notes,
    ) -> bool {
        let mut j = start + *ahead;
        loop {
            // SAFETY: j <= len, so LANES <= PAD entries from j are inside every array: a vector
            // that reaches the sentinels ends the scan.
            let more = unsafe {
                let begun = V::le(V::load(column.left.as_ptr().add(j)), self.right);
                let mut hits = begun;
                for k in 0..K {
                    hits = V::and_le(hits, V::load(column.min[k].as_ptr().add(j)), self.max[k]);
                    hits = V::and_le(hits, self.min[k], V::load(column.max[k].as_ptr().add(j)));
                }
                output.take(hits, &self.reporter, column, j, notes);
                // They ascend: if the last of these has begun, all have.
                *column.left.get_unchecked(j + V::LANES - 1) <= self.last
            };
            if !more {
                return true;
            }
            j += V::LANES;
            if output.is_full() {
                *ahead = j - start;
                return false;
            }
        }
    }
}
