//! The sweep itself, once for every instruction set: each box against those ahead of it.
//!
//! ```text
//! for each box in sweep order                      (the probe)
//!     for each box ahead, LANES at a time
//!         report those that overlap on every axis and that no other column reports
//!         stop when a left edge passes the probe's right edge
//! ```
//!
//! The order of the pairs (by probe, then by position) does not depend on the number of lanes.

use core::ops::Range;

use super::output::{Notes, Output};
use super::sorted_boxes::SortedBoxes;
use super::vector::{PairOrder, Reporter, Vector};
use crate::Scalar;
use crate::pairs::parallel::MAY_SPLIT;

/// Where a sweep stopped because its output was full: it goes on from here in the next call.
#[derive(Clone, Copy, Debug)]
pub struct Cursor {
    /// The next probe of the first set, and of the second if there are two.
    first: usize,
    second: usize,
    /// How far ahead of the probe the scan has come.
    ahead: usize,
    /// The sweep ends before this probe, of those of all sets in sweep order.
    end: usize,
    done: bool,
}

impl Default for Cursor {
    /// Before the first probe of a whole sweep.
    fn default() -> Self {
        Self { first: 0, second: 0, ahead: 0, end: usize::MAX, done: false }
    }
}

impl Cursor {
    /// Whether the sweep has come to its end.
    pub fn is_done(&self) -> bool {
        self.done
    }

    /// Whether a sweep of these sets, one or two, may go on from here: the scan of the next probe
    /// would begin at a box or at the sentinels. Always so, unless the cursor is from another sweep.
    pub(super) fn fits<T: Scalar>(&self, sets: &[SortedBoxes<T>]) -> bool {
        match sets {
            [a] => self.first >= a.len() || self.ahead < a.len() - self.first,
            [a, b] => {
                self.first >= a.len()
                    || self.second >= b.len()
                    || if a.left[self.first] <= b.left[self.second] {
                        self.ahead <= b.len() - self.second
                    } else {
                        self.ahead <= a.len() - self.first
                    }
            }
            _ => false,
        }
    }

    /// Whether the next probe is beyond those of its chunk.
    #[inline(always)]
    fn is_at_end(&self) -> bool {
        MAY_SPLIT && self.first + self.second >= self.end
    }

    /// The part of a sweep with these of its probes.
    pub fn of<T: Scalar>(sets: &[SortedBoxes<T>], probes: Range<usize>) -> Self {
        let Range { start, end } = probes;
        let first = sets.get(1).map_or(start, |second| probes_of(&sets[0], second, start));
        Self { first, second: start - first, end, ..Self::default() }
    }
}

/// How many of the first `probes` probes are boxes of the first set. Binary search (Odeh et al. 2012,
/// "Merge Path").
fn probes_of<T: Scalar>(first: &SortedBoxes<T>, second: &SortedBoxes<T>, probes: usize) -> usize {
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

/// Writes the pairs of one set or of two to `out` and returns how many; `cursor.done` tells whether that
/// was all. The scan of a box stops where `out` has no space for a full vector. `K` axes are tested beside the sweep axis. The
/// second set is looked at if there are `TWO`: then the probe is the box that comes first in sweep order, that of the first
/// set where both begin together. (The sets are parameters of their own: of references in an array the compiler does not
/// know that nothing else writes to them, which took 7 % at 1,000 boxes.)
///
/// # Safety
/// The instructions of `V` are present; the sets are ready for `K` axes; the cursor fits the sets; `out.len() >= V::LANES`.
#[inline(always)]
pub(super) unsafe fn sweep<T: Scalar, V: Vector<T>, const TWO: bool, const K: usize>(
    a: &SortedBoxes<T>,
    b: &SortedBoxes<T>,
    pair_order: PairOrder,
    cursor: &mut Cursor,
    out: &mut [[u32; 2]],
) -> usize {
    let ascending = !TWO || pair_order == PairOrder::Ascending;
    let (mut output, mut notes) = (Output::<T, V>::new(out), Notes::new());
    loop {
        // Where one of two sets has ended, nothing of it is ahead of the rest of the other.
        while cursor.first < a.len()
            && (!TWO || cursor.second < b.len())
            && !cursor.is_at_end()
            && !output.is_full()
        {
            let Cursor { first: i, second: j, .. } = *cursor;
            // SAFETY: i and j are positions of boxes. A scan begins at a box or at the sentinels: the
            // cursor fits, and later probes start with ahead = 0.
            let finished = unsafe {
                if !TWO {
                    let probe = Probe::<T, V, K>::new(a, i, true, false);
                    let finished = probe.scan(a, i + 1, &mut cursor.ahead, &mut output, &mut notes);
                    cursor.first = if finished { i + 1 } else { i };
                    finished
                } else if *a.left.get_unchecked(i) <= *b.left.get_unchecked(j) {
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
        // SAFETY: all hits are those of `a` and, if there are two sets, of `b`.
        let has_space = unsafe {
            if TWO {
                output.flush([a, b], ascending, &mut notes)
            } else {
                output.flush([a], true, &mut notes)
            }
        };
        if !has_space || cursor.done {
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

impl<T: Scalar, V: Vector<T>, const K: usize> Probe<T, V, K> {
    /// # Safety
    /// `i` is the position of a box, and `boxes` are ready for `K`.
    #[inline(always)]
    unsafe fn new(boxes: &SortedBoxes<T>, i: usize, ascending: bool, in_first: bool) -> Self {
        // SAFETY: i is inside every array.
        unsafe {
            Self {
                last: *boxes.right.get_unchecked(i),
                right: V::splat(*boxes.right.get_unchecked(i)),
                min: core::array::from_fn(|k| V::splat(*boxes.min[k].get_unchecked(i))),
                max: core::array::from_fn(|k| V::splat(*boxes.max[k].get_unchecked(i))),
                reporter: Reporter {
                    id: *boxes.id.get_unchecked(i),
                    dedup: *boxes.dedup.get_unchecked(i),
                    ascending,
                    in_first,
                },
            }
        }
    }

    /// Tests the boxes from `start + ahead` on. Returns false if it stopped because the output was
    /// full; then it goes on from `ahead`.
    ///
    /// # Safety
    /// `start + ahead <= boxes.len()`, and they are ready for `K`; the output is not full.
    #[inline(always)]
    unsafe fn scan(
        &self,
        boxes: &SortedBoxes<T>,
        start: usize,
        ahead: &mut usize,
        output: &mut Output<'_, T, V>,
        notes: &mut Notes,
    ) -> bool {
        let mut j = start + *ahead;
        loop {
            // SAFETY: j <= len, so LANES <= PAD entries from j are inside every array: a vector
            // that reaches the sentinels ends the scan.
            let more = unsafe {
                let begun = V::le(V::load(boxes.left.as_ptr().add(j)), self.right);
                let mut hits = begun;
                for k in 0..K {
                    hits = V::and_le(hits, V::load(boxes.min[k].as_ptr().add(j)), self.max[k]);
                    hits = V::and_le(hits, self.min[k], V::load(boxes.max[k].as_ptr().add(j)));
                }
                output.take(hits, &self.reporter, boxes, j, notes);
                // They ascend: if the last of these has begun, all have.
                *boxes.left.get_unchecked(j + V::LANES - 1) <= self.last
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
