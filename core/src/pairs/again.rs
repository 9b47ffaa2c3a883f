//! Coherence: a search that starts from the order that the last one ended with.
//!
//! It keeps, for each box, between which bins it lay, and for each bin the boxes in sweep order.
//! Of boxes that moved little, few begin to touch a bin or cease to, and those that stay are nearly
//! in order. So nothing is listed and scattered but what changed bins, and nothing is sorted but by
//! insertion.
//!
//! What it finds and in what order is the same: the plan comes of the boxes alone, and what was
//! kept is used only if the new plan is the old one.

use alloc::collections::TryReserveError;
use alloc::vec::Vec;
use core::mem::{replace, swap};
use core::ops::RangeInclusive;

use super::bins::{Record, Source};
use super::grid::Grid;
use super::kernel::Copied;
use super::search::{Search, Stop, Task, crowd, limit};
use super::sink::Sink;
use crate::memory::grow;
use crate::{Aabb, Scalar};

/// With fewer boxes it does not pay, nor with more: the boxes are read in the order of their bins,
/// which is no order in memory, and beyond the second cache that takes longer than to sort them.
const WORTH: RangeInclusive<usize> = 512..=1 << 14;
/// Nor if more than one box in so many changed bins,
const CHANGED: usize = 16;
/// or one record in so many was in a crowded bin, which is planned anew,
const CROWDED: usize = 8;
/// or more than one in so many was out of order by a position: to sort by insertion then takes as
/// long as to sort anew.
const DISORDER: usize = 3;
/// If it did not pay, so many calls pass until the next attempt; twice as many each time, up to
const PAUSE: u32 = 8;
const LONGEST_PAUSE: u32 = 128;

/// Bits of an entry of the order that are the box.
const ID_BITS: u32 = 29;

/// What is kept from call to call.
#[derive(Debug)]
pub(super) struct Last<const D: usize, T> {
    /// The plan of the last call, and how many boxes there were.
    plan: Option<(Grid<T>, usize)>,
    /// Whether the order below is that of the last call.
    kept: bool,
    /// Whether no order is ever kept.
    never: bool,
    /// Calls to let pass, and how many they were when it did not pay the last time.
    pause: u32,
    paused: u32,
    /// Between which bins each box lies.
    spans: Vec<[u32; 2]>,
    /// The boxes of each bin in sweep order, and above [`ID_BITS`] their marks:
    /// `starts[bin] .. starts[bin + 1]`.
    order: Vec<u32>,
    starts: Vec<u32>,
    /// That of the call under way.
    next: Vec<u32>,
    /// A bit for each box, whether it changed bins; and in which bins those boxes are now.
    changed: Vec<u64>,
    new: Vec<Copied>,
    new_starts: Vec<u32>,
    /// The records of those boxes, and then of one bin after the other.
    gathered: Vec<Record<D, T>>,
}

impl<const D: usize, T: Scalar> Last<D, T> {
    pub const fn new() -> Self {
        Self {
            plan: None,
            kept: false,
            never: false,
            pause: 0,
            paused: 0,
            spans: Vec::new(),
            order: Vec::new(),
            starts: Vec::new(),
            next: Vec::new(),
            changed: Vec::new(),
            new: Vec::new(),
            new_starts: Vec::new(),
            gathered: Vec::new(),
        }
    }

    /// Nothing, ever.
    pub fn never() -> Self {
        Self { never: true, ..Self::new() }
    }

    /// Whether the last order, or if there is none, to make one for the next call, is worth an
    /// attempt: not where all is new, nor in a pause.
    fn is_worth_while(&mut self, boxes: usize, grid: &Grid<T>) -> bool {
        if self.never {
            return false;
        }
        let plan = Some((*grid, boxes));
        let same = self.plan == plan;
        // The plan changes now and then while boxes move little.
        let known = same || (self.kept && self.plan.is_some_and(|(_, last)| last == boxes));
        self.plan = plan;
        self.kept &= same;
        self.pause = self.pause.saturating_sub(1);
        known && grid.len() > 1 && self.pause == 0 && WORTH.contains(&boxes)
    }

    /// Notes whether it paid.
    fn note(&mut self, paid: bool) {
        self.kept = paid;
        self.paused = if paid { 0 } else { (2 * self.paused).clamp(PAUSE, LONGEST_PAUSE) };
        self.pause = self.paused;
    }

    /// Finds the boxes that changed bins, all of them if nothing is known of the last call. False
    /// if they are too many, or any box is invalid.
    fn compare(&mut self, boxes: &[Aabb<D, T>], grid: &Grid<T>) -> Result<bool, TryReserveError> {
        grow(&mut self.spans, boxes.len(), [0; 2])?;
        grow(&mut self.changed, boxes.len().div_ceil(64), 0)?;
        let (all, most) = if self.kept { (0, boxes.len() / CHANGED) } else { (!0, boxes.len()) };
        let mut count = 0;
        let words = self.changed.iter_mut().zip(self.spans.chunks_mut(64));
        for (boxes, (word, spans)) in boxes.chunks(64).zip(words) {
            let (mut bits, mut valid) = (0, true);
            for (aabb, last) in boxes.iter().zip(spans).rev() {
                valid &=
                    (0..D).fold(true, |valid, axis| valid & (aabb.min[axis] <= aabb.max[axis]));
                let span = grid.span(aabb);
                bits = bits << 1 | u64::from(span != *last);
                *last = span;
            }
            *word = bits | all;
            count += bits.count_ones() as usize;
            if !valid || count > most {
                return Ok(false);
            }
        }
        Ok(true)
    }
}

/// The numbers of the bits that are set, ascending.
fn ones(words: &[u64]) -> impl Iterator<Item = usize> {
    words.iter().enumerate().flat_map(|(at, &word)| {
        let mut left = word;
        core::iter::from_fn(move || {
            let bit = left.trailing_zeros() as usize;
            left &= left.wrapping_sub(1);
            (bit < 64).then_some(64 * at + bit)
        })
    })
}

impl<const D: usize, T: Scalar> Search<D, T> {
    /// As a cut of the whole by this grid, from the order of the last call. None if that does not
    /// pay; then nothing was sent to the sink.
    pub fn again<O: Sink>(
        &mut self,
        boxes: &[Aabb<D, T>],
        grid: &Grid<T>,
        task: Task<'_>,
        sink: &mut O,
    ) -> Option<Result<(), Stop>> {
        if !self.last.is_worth_while(boxes.len(), grid) {
            return None;
        }
        let mut last = replace(&mut self.last, Last::new());
        let result = if self.move_boxes(&mut last, boxes, grid).is_some() {
            Some(self.bins_again(&mut last, boxes, grid, task, sink))
        } else {
            last.note(false);
            None
        };
        self.last = last;
        result
    }

    /// Takes the boxes that changed bins to those where they are now. None if it does not pay, or
    /// there is not enough memory.
    fn move_boxes(
        &mut self,
        last: &mut Last<D, T>,
        boxes: &[Aabb<D, T>],
        grid: &Grid<T>,
    ) -> Option<()> {
        let len = boxes.len();
        if !last.compare(boxes, grid).ok()? {
            return None;
        }
        grow(&mut last.starts, grid.len() + 1, 0).ok()?;
        if !last.kept {
            last.starts.fill(0);
        }
        // What was and what is new together: hardly more than there will be.
        let kept = last.starts[grid.len()] as u64;
        let changed = &last.changed[..len.div_ceil(64)];
        let count = changed.iter().map(|word| word.count_ones() as usize).sum();
        last.gathered.clear();
        last.gathered.try_reserve(count).ok()?;
        let changed = ones(changed).take_while(|&i| i < len);
        last.gathered.extend(changed.map(|i| boxes.record(i)));
        let records = &last.gathered[..];
        let limit = limit(len).saturating_sub(kept);
        let new = self.list.fill(records, 0..records.len(), grid, limit);
        self.list.by_bin(records, &mut last.new, &mut last.new_starts).ok()?;
        grow(&mut last.next, (kept + new.ok()?) as usize, 0).ok()
    }

    /// The pairs of all bins, each put in order from its last.
    fn bins_again<O: Sink>(
        &mut self,
        last: &mut Last<D, T>,
        boxes: &[Aabb<D, T>],
        grid: &Grid<T>,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        // Until all is well.
        last.kept = false;
        let crowd = crowd(boxes.len(), grid);
        let (mut begin, mut len, mut disorder, mut crowded) = (0, 0, 0, 0);
        for bin in 0..grid.len() {
            let end = last.starts[bin + 1] as usize;
            let new = last.new_starts[bin] as usize..last.new_starts[bin + 1] as usize;
            let new = &last.new[new];

            let room = end - begin + new.len();
            grow(&mut last.gathered, room, Record { aabb: boxes[0], id: 0, marks: 0 })?;
            let records = &mut last.gathered[..room];
            let record = |id: u32, marks| Record { aabb: boxes[id as usize], id, marks };
            let mut kept = 0;
            for &entry in &last.order[begin..end] {
                let id = entry & ((1 << ID_BITS) - 1);
                records[kept] = record(id, entry >> ID_BITS);
                kept += (!last.changed[id as usize / 64] >> (id % 64) & 1) as usize;
            }
            let count = kept + new.len();
            for (to, copy) in records[kept..count].iter_mut().zip(new) {
                *to = record(copy.of, copy.marks());
            }
            let records = &mut records[..count];
            begin = end;

            let column = &mut self.columns[0];
            disorder += self.sorter.reorder(records, kept, grid.sweep, column)?;
            let order = column.id[..count].iter().zip(&column.marks);
            let next = &mut last.next[len..len + count];
            next.iter_mut().zip(order).for_each(|(to, (&id, &marks))| *to = id | marks << ID_BITS);
            len += count;
            last.starts[bin + 1] = len as u32;

            if count > crowd || self.is_crowded(1) {
                crowded += count;
                // As it would be found by itself.
                records.sort_unstable_by_key(|record| record.id);
                self.ordered(&[&*records], grid.sweep, crowd, task, sink)?;
            } else {
                self.sweep(1, D - 1, task, sink)?;
            }
            task.done(1.0 / grid.len() as f64)?;
        }
        swap(&mut last.order, &mut last.next);
        last.note(CROWDED * crowded <= len && DISORDER * disorder <= len);
        Ok(())
    }
}
