//! Boxes on a line that find their pairs one by one, so that threads can share the boxes.

use core::ops::Range;

use super::parallel::{Helpers, Receiver};
use super::sink::Sink;
use super::task::{Stop, Task};
use crate::Scalar;

/// With fewer boxes, threads do not pay. (On two cores, two threads take 1.4 to 2 times as long at 10,000, 1.0 to 1.5
/// times at 100,000, and 0.8 to 0.9 at 200,000.)
const MIN_BOXES_FOR_THREADS: usize = 1 << 17;
/// A thread takes this many boxes at a time, so that their pairs stay in its cache.
const BOXES_AT_A_TIME: usize = 4096;

/// A way to search in which each box finds its pairs by itself.
pub(super) trait OneByOne<const D: usize, T: Scalar>: Sync {
    /// How many boxes there are.
    fn len(&self) -> usize;

    /// Sends the pairs of a range of the boxes to the sink.
    ///
    /// # Errors
    /// [`Stop::Memory`], [`Stop::Cancelled`].
    fn run<O: Sink>(&self, range: Range<usize>, task: Task<'_>, sink: &mut O) -> Result<(), Stop>;
}

/// Sends the pairs of all boxes to the sink.
pub(super) fn one_by_one<const D: usize, T: Scalar, W, O: Receiver>(
    search: &impl OneByOne<D, T>,
    helpers: &Helpers<W>,
    task: Task<'_>,
    sink: &mut O,
) -> Result<(), Stop> {
    let boxes = search.len();
    match helpers.threads::<O>(boxes) {
        Some(threads) if boxes >= MIN_BOXES_FOR_THREADS => {
            threads.in_chunks(0..boxes, BOXES_AT_A_TIME, sink, |chunk, sink| {
                one_chunk(search, chunk, task, sink)
            })
        }
        _ => (0..boxes).step_by(BOXES_AT_A_TIME).try_for_each(|start| {
            one_chunk(search, start..boxes.min(start + BOXES_AT_A_TIME), task, sink)
        }),
    }
}

fn one_chunk<const D: usize, T: Scalar, O: Sink>(
    search: &impl OneByOne<D, T>,
    chunk: Range<usize>,
    task: Task<'_>,
    sink: &mut O,
) -> Result<(), Stop> {
    let share = chunk.len() as f64 / search.len() as f64;
    search.run(chunk, task, sink)?;
    task.done(share)
}
