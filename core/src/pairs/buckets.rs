//! Boxes in no order that look up sorted ones whose table does not fit a cache (see `lookup.rs`). A chunk of them at a time
//! is copied to buckets, so that those that read the same part of the table come together.
//!
//! ```text
//! for each chunk of the boxes
//!     for each box
//!         append a record of it to the bucket of its cell: some hundred cells have one bucket
//!     for each bucket
//!         read the part of the table that its cells lead to, from front to back
//!         look up its records
//! ```

use alloc::vec::Vec;
use core::mem::replace;
use core::ops::Range;

use super::lookup::{Indexed, Lookup};
use super::parallel::{Helpers, Receiver};
use super::sink::Sink;
use super::source::{Record, Source};
use super::task::{Stop, Task};
use crate::memory::grow;
use crate::{Aabb, Scalar};

/// A chunk has at least this many boxes, and at least as many as are sorted, so that most of what is read of the table is
/// needed.
const LEAST_CHUNK: usize = 1 << 20;
/// The part of the table that belongs to a bucket has about this many sorted boxes: it fits the second-level cache.
const SORTED_BOXES_PER_BUCKET: usize = 1 << 12;
/// The most buckets. Each is written to in turn, and has a cache line and a page at that time.
const MOST_BUCKETS: usize = 1 << 10;

/// The records of a chunk, by bucket.
#[derive(Debug, Default)]
pub(super) struct Buckets<const D: usize, T> {
    records: Vec<Record<D, T>>,
    /// Where those of each bucket end.
    ends: Vec<u32>,
}

/// How many boxes are put in order at a time.
pub(super) fn chunk_of<T: Scalar>(indexed: &Indexed<'_, T>) -> usize {
    LEAST_CHUNK.max(indexed.len())
}

/// Has boxes look up sorted ones, on several threads if there are helpers, and sends the pairs to the sink. `own` and
/// `buckets` are the buckets of this thread and of a helper.
///
/// # Errors
/// [`Stop::Memory`], [`Stop::Cancelled`].
pub(super) fn look_up_in_buckets<
    const D: usize,
    T: Scalar,
    S: Source<D, T>,
    W: Send,
    O: Receiver,
>(
    Lookup { indexed, boxes, first }: Lookup<'_, S, T>,
    own: &mut Buckets<D, T>,
    helpers: &mut Helpers<W>,
    buckets: fn(&mut W) -> &mut Buckets<D, T>,
    task: Task<'_>,
    sink: &mut O,
) -> Result<(), Stop> {
    let (all, chunk) = (0..boxes.len(), chunk_of(indexed));
    let one = |range: Range<usize>| {
        let share = task.share * range.len() as f64 / boxes.len() as f64;
        let (first, boxes) = (first + range.start, &boxes[range]);
        (Lookup { indexed, boxes, first }, Task { share, ..task })
    };
    let mut team = helpers.team::<O>(boxes.len());
    let found = match &mut team {
        Some(team) => team.in_chunks(all, chunk, own, buckets, sink, |own, range, sink| {
            let (chunk, task) = one(range);
            own.look_up(chunk, task, sink)
        }),
        None => all.step_by(chunk).try_for_each(|start| {
            let (chunk, task) = one(start..boxes.len().min(start + chunk));
            own.look_up(chunk, task, sink)
        }),
    };
    helpers.rest(team);
    found
}

impl<const D: usize, T: Scalar> Buckets<D, T> {
    /// Has the boxes of a chunk look up the sorted ones.
    ///
    /// # Errors
    /// [`Stop::Memory`], [`Stop::Cancelled`].
    fn look_up<S: Source<D, T>, O: Sink>(
        &mut self,
        chunk: Lookup<'_, S, T>,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        let indexed = chunk.indexed;
        let count = indexed.len().next_power_of_two() / SORTED_BOXES_PER_BUCKET;
        let cells = indexed.cells() / count.clamp(1, MOST_BUCKETS);
        let (records, ends) = self.fill(chunk, cells)?;
        let mut begin = 0;
        for (bucket, &end) in ends.iter().enumerate() {
            if begin < end {
                indexed.preload(bucket * cells..(bucket + 1) * cells);
                indexed.look_up(records, 0, begin as usize..end as usize, task, sink)?;
            }
            task.done(1.0 / ends.len() as f64)?;
            begin = end;
        }
        Ok(())
    }

    /// Copies the boxes of a chunk to the buckets of so many cells each. Returns the records and where those of each bucket end.
    ///
    /// # Errors
    /// [`Stop::Memory`].
    fn fill<S: Source<D, T>>(
        &mut self,
        Lookup { indexed, boxes, first }: Lookup<'_, S, T>,
        cells: usize,
    ) -> Result<(&[Record<D, T>], &[u32]), Stop> {
        let nothing = Aabb::new([T::default(); D], [T::default(); D]);
        grow(&mut self.records, boxes.len(), nothing.record(0))?;
        let count = indexed.cells() / cells;
        grow(&mut self.ends, count, 0)?;
        let (records, ends) = (&mut self.records[..boxes.len()], &mut self.ends[..count]);
        let shift = cells.trailing_zeros();
        let bucket = |each: &S| indexed.cell(each.aabb()) >> shift;
        ends.fill(0);
        for each in boxes {
            ends[bucket(each)] += 1;
        }
        let mut total = 0;
        for end in &mut *ends {
            total += replace(end, total);
        }
        for (at, each) in (first..).zip(boxes) {
            let end = &mut ends[bucket(each)];
            records[*end as usize] = each.record(at);
            *end += 1;
        }
        Ok((records, ends))
    }
}
