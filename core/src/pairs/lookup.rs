//! Pairs between two sets on a line. The smaller set is sorted, and each box of the larger set looks up the first
//! sorted box that it may overlap. So the larger set is neither copied nor sorted, which is most of the work of a
//! sweep.
//!
//! ```text
//! sort the smaller set by left edge
//! for each cell of the line
//!     first[cell] = the first sorted box that reaches the cell or anything to its right
//! for each box of the larger set
//!     for each sorted box from first[cell of its left edge] on, until one begins behind its right edge
//!         report the pair if they overlap
//! ```
//!
//! Where the table does not fit a cache, the boxes of the larger set are first put in order, roughly: `buckets.rs`.
//!
//! One long box hides where those behind it end. So if too many tests would fail, the few long ones get a table of their
//! own.
//!
//! All sorted boxes that begin within a box are its pairs, so a test can only fail for a sorted box that begins before
//! it.

use alloc::collections::TryReserveError;
use alloc::vec::Vec;
use core::ops::{ControlFlow, Range};

use super::grid::BLOCK;
use super::kernel::{PAD, SortedBoxes};
use super::one_by_one::OneByOne;
use super::sink::Sink;
use super::sort::intervals;
use super::source::Source;
use super::task::{Progress, Stop, Task};
use crate::geometry::{Arithmetic, Quantizer};
use crate::memory::{grow, prefetch_ahead, prefetch_range, preload};
use crate::sampling::positions;
use crate::{Aabb, Scalar};

// Chosen on uniform intervals and on clusters, one core of an AMD EPYC (Zen 4 and Zen 5). At one to ten, lookups take 0.55
// (11,000 boxes), 0.56 (110,000) and 0.84 (1,100,000) of the time of a sweep; where a table was made and not used, 1.06.

/// The most boxes of the smaller set that stay in the second-level cache with their table.
const MOST_CACHED_BOXES: usize = 1 << 14;
/// Above [`MOST_CACHED_BOXES`], the larger set must be at least this many times as large. (At one to four, lookups take 0.6 to
/// 0.9 of the time of a sweep, 100,000 to 10 million boxes; at one to two, up to 1.2.)
const MIN_SET_RATIO: usize = 4;
/// The most boxes of the smaller set that are looked up in any order: see `buckets.rs`. (In buckets, 250,000 took 1.4 of the
/// time, and a million 0.6 to 0.7.)
const MOST_IN_ANY_ORDER: usize = 1 << 18;
/// The most cells that a [`Quantizer`] can have.
const MOST_CELLS: usize = 1 << 22;
/// The most tests that may fail for any one box. With more, all boxes are swept.
const MOST_FAILED_TESTS: usize = 1024;
/// The most tests that may fail per box, on average over a sample. With more, all boxes are swept.
const MEAN_FAILED_TESTS: usize = 16;
/// The size of that sample.
pub(super) const SAMPLED_BOXES: usize = 64;
/// Boxes are long if this many others begin within one, where all are spread evenly.
const OTHERS_IN_LONG: f64 = 16.0;
/// Long boxes are few if there are at least this many others for each.
const OTHERS_FOR_EACH_LONG: usize = 8;
/// How many sorted boxes are tested at a time, without a branch. Behind the last box there is padding for this many.
const TESTED_AT_A_TIME: usize = 4;
const _: () = assert!(TESTED_AT_A_TIME <= PAD);

/// Whether a set of `smaller` boxes is small enough that sorting it may pay, where the larger one has `larger` boxes.
pub(super) fn are_few(smaller: usize, larger: usize) -> bool {
    smaller <= MOST_CACHED_BOXES.max(larger / MIN_SET_RATIO)
}

/// Whether sorting the smaller set is likely to pay, where the larger one has `larger` boxes: in a sample its boxes do not overlap
/// each other too much.
pub(super) fn may_pay<const D: usize, T: Scalar, S: Source<D, T>>(
    smaller: &[S],
    larger: usize,
) -> bool {
    let len = smaller.len();
    if !are_few(len, larger) {
        return false;
    }
    // All of the sample are compared with each other, which takes no longer than to read the smaller set.
    let sampled = len.isqrt().min(SAMPLED_BOXES);
    let sample = || positions(len, sampled).map(|at| smaller[at].aabb());
    let overlaps = |a: &Aabb<D, T>| sample().filter(|b| a.overlaps(b)).count();
    let (overlaps, drawn) = (sample().map(overlaps).sum::<usize>(), sample().len());
    // Half of the boxes that overlap a box begin before it. Each overlaps itself, too.
    (overlaps - overlaps.min(drawn)) / 2 * len <= 2 * MEAN_FAILED_TESTS * drawn * drawn
}

/// Moves the long ones of sorted boxes, at least one, to another list. Returns false, with all where they were, if there is
/// none, or if they are not few.
#[inline(never)]
pub(super) fn move_long<T: Scalar>(
    boxes: &mut SortedBoxes<T>,
    long: &mut SortedBoxes<T>,
) -> Result<bool, TryReserveError> {
    let len = boxes.len();
    let length = |from: T, to: T| to.to_f64() - from.to_f64();
    let limit = OTHERS_IN_LONG * length(boxes.left[0], boxes.left[len - 1]) / len as f64;
    let is_long =
        |boxes: &SortedBoxes<T>, at: usize| length(boxes.left[at], boxes.right[at]) > limit;
    let count = (0..len).filter(|&at| is_long(boxes, at)).count();
    if count == 0 || len - count < OTHERS_FOR_EACH_LONG * count {
        return Ok(false);
    }
    long.reset(count, 0)?;
    let (mut moved, mut kept) = (0, 0);
    for at in 0..len {
        let (left, right, id) = (boxes.left[at], boxes.right[at], boxes.id[at]);
        let (to, end) =
            if is_long(boxes, at) { (&mut *long, &mut moved) } else { (&mut *boxes, &mut kept) };
        (to.left[*end], to.right[*end], to.id[*end]) = (left, right, id);
        *end += 1;
    }
    boxes.reset(kept, 0)?;
    Ok(true)
}

/// Where to begin among the sorted boxes, for each cell of the line.
#[derive(Debug, Default)]
pub(super) struct Table<T> {
    first: Vec<u32>,
    intervals: Vec<Interval<T>>,
    /// What it was filled with.
    filled: Option<Filled<T>>,
}

/// How many sorted boxes a table has, and its cells.
#[derive(Clone, Copy, Debug)]
struct Filled<T> {
    len: usize,
    cells: usize,
    quantizer: Quantizer<T>,
}

/// A sorted box. All of it is read together, most often from one cache line.
#[derive(Clone, Copy, Debug, Default)]
struct Interval<T> {
    left: T,
    right: T,
    id: u32,
}

/// The sorted boxes and their table, ready to be looked up.
pub(super) struct Indexed<'a, T> {
    /// With padding behind the last, whose left edges are NaN.
    sorted: &'a [Interval<T>],
    first: &'a [u32],
    quantizer: Quantizer<T>,
    /// Whether pairs begin with the sorted box.
    swap: bool,
}

/// Boxes that look up sorted ones, in the order in which they come. The index of the first one is `first`.
#[derive(Clone, Copy)]
pub(super) struct Lookup<'a, S, T> {
    pub indexed: &'a Indexed<'a, T>,
    pub boxes: &'a [S],
    pub first: usize,
}

impl<T: Scalar> Table<T> {
    /// Fills it with sorted boxes, at least one, which boxes of a larger set look up; `begins` are the left edges of a sample
    /// of these. False, with an empty table, if too many tests would fail.
    pub fn fill(&mut self, boxes: &SortedBoxes<T>, begins: &[T]) -> Result<bool, TryReserveError> {
        self.filled = None;
        let (left, right) = (&boxes.left[..boxes.len()], &boxes.right[..boxes.len()]);
        let end = right.iter().fold(right[0], |end, &right| if right > end { right } else { end });
        let cells = (2 * left.len().next_power_of_two()).min(MOST_CELLS);
        let quantizer = intervals([left[0], end], cells);
        grow(&mut self.first, cells, 0)?;
        let first = &mut self.first[..cells];
        let cell = |at: T| T::Arithmetic::cell(at, &quantizer) as usize;
        // Cells up to this one have their first box.
        let (mut done, mut failed) = (0, 0);
        for (i, (&left, &right)) in left.iter().zip(right).enumerate() {
            let reached = cell(right) + 1;
            if reached > done {
                first[done..reached].fill(i as u32);
                done = reached;
            }
            failed = failed.max(i - first[cell(left)] as usize);
        }
        first[done..].fill(left.len() as u32);
        if failed > MOST_FAILED_TESTS {
            return Ok(false);
        }
        let before = |at: T| left.partition_point(|&left| left < at);
        let failed = |&at: &T| before(at).saturating_sub(first[cell(at)] as usize);
        let is_crowded =
            begins.iter().map(failed).sum::<usize>() > MEAN_FAILED_TESTS * begins.len();
        if is_crowded {
            return Ok(false);
        }
        let padded = left.len() + TESTED_AT_A_TIME;
        grow(&mut self.intervals, padded, Interval::default())?;
        let sorted = &mut self.intervals[..padded];
        for (i, interval) in sorted.iter_mut().enumerate() {
            let (left, right, id) = (boxes.left[i], boxes.right[i], boxes.id[i]);
            *interval = Interval { left, right, id };
        }
        self.filled = Some(Filled { len: left.len(), cells, quantizer });
        Ok(true)
    }

    /// Empties it.
    pub fn clear(&mut self) {
        self.filled = None;
    }

    /// The sorted boxes, unless it is empty. `swap`: they are the first set.
    pub fn indexed(&self, swap: bool) -> Option<Indexed<'_, T>> {
        let Filled { len, cells, quantizer } = self.filled?;
        let sorted = &self.intervals[..len + TESTED_AT_A_TIME];
        Some(Indexed { sorted, first: &self.first[..cells], quantizer, swap })
    }
}

/// The positions of the boxes of a larger set of which a sample is drawn.
pub(super) fn sampled(count: usize) -> impl ExactSizeIterator<Item = usize> {
    positions(count, SAMPLED_BOXES)
}

impl<const D: usize, T: Scalar, S: Source<D, T>> OneByOne<D, T> for Lookup<'_, S, T> {
    fn len(&self) -> usize {
        self.boxes.len()
    }

    fn run<O: Sink>(&self, range: Range<usize>, task: Task<'_>, sink: &mut O) -> Result<(), Stop> {
        self.indexed.look_up(self.boxes, self.first, range, task, sink)
    }
}

impl<T: Scalar> Indexed<'_, T> {
    /// Whether the sorted boxes are few enough to be looked up in any order.
    pub fn takes_any_order(&self) -> bool {
        self.len() <= MOST_IN_ANY_ORDER
    }

    /// How many sorted boxes there are.
    pub fn len(&self) -> usize {
        self.sorted.len() - TESTED_AT_A_TIME
    }

    /// How many cells there are, a power of two.
    pub fn cells(&self) -> usize {
        self.first.len()
    }

    /// The cell from which a box looks.
    #[inline(always)]
    pub fn cell<const D: usize>(&self, aabb: &Aabb<D, T>) -> usize {
        T::Arithmetic::cell(aabb.min[0], &self.quantizer) as usize
    }

    /// Brings into a cache what boxes look up from these cells.
    pub fn preload(&self, cells: Range<usize>) {
        let first = &self.first[cells];
        preload(first);
        if let [from, .., to] = *first {
            preload(&self.sorted[from as usize..to as usize]);
        }
    }

    /// Sends the pairs of a range of boxes to the sink. The index of the first of all is `first_index`.
    ///
    /// # Errors
    /// [`Stop::Memory`], [`Stop::Cancelled`].
    pub fn look_up<const D: usize, S: Source<D, T>, O: Sink>(
        &self,
        boxes: &[S],
        first_index: usize,
        range: Range<usize>,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        if self.swap {
            self.send(boxes, first_index, range, task, sink, |id, other| [other, id])
        } else {
            self.send(boxes, first_index, range, task, sink, |id, other| [id, other])
        }
    }

    #[inline(always)]
    fn send<const D: usize, S: Source<D, T>, O: Sink>(
        &self,
        boxes: &[S],
        first_index: usize,
        range: Range<usize>,
        task: Task<'_>,
        sink: &mut O,
        pair: impl Fn(u32, u32) -> [u32; 2],
    ) -> Result<(), Stop> {
        let sorted = self.sorted;
        // Tests some sorted boxes. Returns how many pairs it wrote, and whether all of these boxes begin within this one.
        let test = |each: &S, at: usize, next: u32, to: &mut [[u32; 2]]| {
            let (begin, end) = (each.aabb().min[0], each.aabb().max[0]);
            let (mut found, mut begins) = (0, false);
            for other in &sorted[next as usize..][..TESTED_AT_A_TIME] {
                to[found] = pair(each.id(first_index + at), other.id);
                // Behind the last box the left edges are NaN.
                begins = other.left <= end;
                // Not `&&`: which of them overlap is unpredictable.
                found += usize::from(begins & (begin <= other.right));
            }
            (found, begins)
        };
        let mut first = [0; BLOCK];
        let mut waiting = [0; BLOCK];
        let (mut out, mut count) = (sink.spare()?, 0);
        for start in range.clone().step_by(BLOCK) {
            let block = &boxes[start..range.end.min(start + BLOCK)];
            prefetch_ahead(boxes, start..start + block.len());
            for (first, each) in first.iter_mut().zip(block) {
                *first = self.first[self.cell(each.aabb())];
            }
            if sorted.len() > MOST_CACHED_BOXES {
                for &first in &first[..block.len()] {
                    prefetch_range(sorted, first as usize..first as usize + TESTED_AT_A_TIME);
                }
            }
            // Those that have to test more than a few wait, since a branch on it would be unpredictable. (10,000 to a million boxes
            // in no order take 0.9 of the time.)
            let mut left = 0;
            for (at, (each, next)) in block.iter().zip(&mut first).enumerate() {
                if out.len() - count < TESTED_AT_A_TIME {
                    (out, count) = (next_spare(sink, count, task)?, 0);
                }
                let to = &mut out[count..count + TESTED_AT_A_TIME];
                let (found, begins) = test(each, start + at, *next, to);
                count += found;
                *next += TESTED_AT_A_TIME as u32;
                waiting[left] = at as u8;
                left += usize::from(begins);
            }
            for &at in &waiting[..left] {
                let (each, place) = (&block[at as usize], start + at as usize);
                let mut next = first[at as usize];
                let mut is_done = false;
                while !is_done {
                    if out.len() - count < TESTED_AT_A_TIME {
                        (out, count) = (next_spare(sink, count, task)?, 0);
                    }
                    let to = &mut out[count..count + TESTED_AT_A_TIME];
                    let (found, begins) = test(each, place, next, to);
                    (count, is_done) = (count + found, !begins);
                    next += TESTED_AT_A_TIME as u32;
                }
            }
        }
        sink.take(count)
    }
}

/// Hands over the pairs that were written, and returns where to write more.
fn next_spare<'s, O: Sink>(
    sink: &'s mut O,
    count: usize,
    task: Task<'_>,
) -> Result<&'s mut [[u32; 2]], Stop> {
    sink.take(count)?;
    if task.progress.map(Progress::report) == Some(ControlFlow::Break(())) {
        return Err(Stop::Cancelled);
    }
    sink.spare()
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::super::sort::Sorter;
    use super::*;

    fn begins(larger: &[Aabb<1>]) -> Vec<f32> {
        sampled(larger.len()).map(|at| larger[at].min[0]).collect()
    }

    /// Whether boxes look up those of a smaller set.
    fn pays(smaller: &[Aabb<1>], larger: &[Aabb<1>]) -> bool {
        let mut sorted = SortedBoxes::default();
        Sorter::default().sort(smaller, 0, &mut sorted).unwrap();
        may_pay(smaller, larger.len()) && Table::default().fill(&sorted, &begins(larger)).unwrap()
    }

    #[test]
    fn no_pattern_in_the_order_of_the_larger_set_hides_the_tests_that_fail() {
        // Boxes at the end test all points behind the long one, and all tests fail. Boxes before it test nothing.
        let points = (0..1000).map(|at| Aabb::new([at as f32], [at as f32]));
        let smaller: Vec<_> = points.chain([Aabb::new([0.0], [2000.0])]).collect();
        let easy = Aabb::new([-2.0], [-1.0]);
        let hard = Aabb::new([1500.0], [1501.0]);
        assert!(pays(&smaller, &[easy; 20_000]));
        assert!(!pays(&smaller, &[hard; 20_000]));
        for period in (2..400).chain([1000, 1024, 5000]) {
            for easy_at in [0, 1, period / 2] {
                let at = |i| if i % period == easy_at { easy } else { hard };
                let larger: Vec<_> = (0..20_000).map(at).collect();
                assert!(
                    !pays(&smaller, &larger),
                    "every {period}th, the {easy_at}th first, is easy"
                );
            }
        }
    }

    #[test]
    fn a_few_long_boxes_have_a_table_of_their_own() {
        let at = |at: usize, length: usize| Aabb::new([at as f32], [(at + length) as f32]);
        let smaller: Vec<_> =
            (0..1000).map(|i| at(i, if i % 200 == 7 { 400 } else { i % 3 })).collect();
        let larger: Vec<_> = (0..9000).map(|i| at(i % 1000, 0)).collect();
        assert!(!pays(&smaller, &larger));
        let (mut short, mut long) = (SortedBoxes::default(), SortedBoxes::default());
        Sorter::default().sort(&smaller, 0, &mut short).unwrap();
        assert!(move_long(&mut short, &mut long).unwrap());
        assert!(short.is_ready(0) && long.is_ready(0) && [short.len(), long.len()] == [995, 5]);
        assert_eq!(long.id[..5], [7, 207, 407, 607, 807]);
        for boxes in [&short, &long] {
            assert!(Table::default().fill(boxes, &begins(&larger)).unwrap());
        }
        assert!(!move_long(&mut long, &mut short).unwrap());
    }

    #[test]
    fn no_pattern_in_the_order_of_the_smaller_set_hides_that_its_boxes_overlap() {
        let apart = |i| Aabb::new([-2.0 * i as f32], [1.0 - 2.0 * i as f32]);
        let together = |i| Aabb::new([i as f32], [10_000.0 + i as f32]);
        for period in (2..100).chain([1000]) {
            for apart_at in [0, 1, period / 2] {
                let at = |i| if i % period == apart_at { apart(i) } else { together(i) };
                let smaller: Vec<_> = (0..4000).map(at).collect();
                assert!(!may_pay(&smaller, 20_000), "every {period}th, the {apart_at}th first");
            }
        }
    }
}
