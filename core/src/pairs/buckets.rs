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

use super::lookup::{Indexed, Lookup};
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
pub(super) struct Buckets<T> {
    records: Vec<Record<1, T>>,
    /// Where those of each bucket end.
    ends: Vec<u32>,
}

/// How many boxes are put in order at a time.
pub(super) fn chunk_of<T: Scalar>(indexed: &Indexed<'_, T>) -> usize {
    LEAST_CHUNK.max(indexed.len())
}

impl<T: Scalar> Buckets<T> {
    /// Has the boxes of a chunk look up the sorted ones.
    ///
    /// # Errors
    /// [`Stop::Memory`], [`Stop::Cancelled`].
    pub fn look_up<const D: usize, S: Source<D, T>, O: Sink>(
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

    /// Copies the boxes of a chunk to buckets, each of which has this many `cells`. Returns the records and where those of each
    /// bucket end.
    ///
    /// # Errors
    /// [`Stop::Memory`].
    fn fill<const D: usize, S: Source<D, T>>(
        &mut self,
        Lookup { indexed, boxes, first }: Lookup<'_, S, T>,
        cells: usize,
    ) -> Result<(&[Record<1, T>], &[u32]), Stop> {
        let record = |begin, end, id| Record { aabb: Aabb::new([begin], [end]), id, dedup: 0 };
        grow(&mut self.records, boxes.len(), record(T::default(), T::default(), 0))?;
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
            let aabb = each.aabb();
            records[*end as usize] = record(aabb.min[0], aabb.max[0], each.id(at));
            *end += 1;
        }
        Ok((records, ends))
    }
}
