//! A single sweep on several threads.

use super::gather::jobs_on_threads;
use crate::Scalar;
use crate::pairs::control::Stop;
use crate::pairs::kernel::{Cursor, SortedBoxes};
use crate::pairs::sink::Sink;
use crate::pairs::sweep::Sweep;

/// Each thread takes so many probes at a time, so that their pairs stay in its cache.
const PROBES: usize = 256;

/// Runs a sweep on so many threads, at least two.
pub fn sweep_on_threads<T: Scalar, O: Sink>(
    sweep: Sweep<'_>,
    sorted: &[SortedBoxes<T>],
    threads: usize,
    sink: &mut O,
) -> Result<(), Stop> {
    let chunks = Cursor::chunks(sorted, PROBES);
    jobs_on_threads(chunks.len(), threads, sink, |job, sink| sweep.run(sorted, chunks[job], sink))
}
