//! The task of a search: its share of the work, its progress callback, how deep plans are nested, why it stopped.

use alloc::collections::TryReserveError;
use core::ops::ControlFlow;
use core::sync::atomic::{AtomicU32, Ordering};

use super::kernel::PairOrder;

/// Progress is counted in units of 2^-24.
const PROGRESS_UNIT: f64 = 1.0 / (1 << 24) as f64;
/// It is reported each time it has grown by 2^-8.
const PROGRESS_STEP_BITS: u32 = 16;

/// The caller's progress callback. Threads share it.
pub(super) type ProgressCallback<'a> = &'a (dyn Fn(f64) -> ControlFlow<()> + Sync);

/// A progress callback, and how much of the work is done.
pub(super) struct Progress<'a> {
    report: ProgressCallback<'a>,
    /// In units of 2^-24.
    done: AtomicU32,
}

impl<'a> Progress<'a> {
    pub fn new(report: ProgressCallback<'a>) -> Self {
        Self { report, done: AtomicU32::new(0) }
    }

    /// Adds a share of the work, and reports what is done if a step is complete.
    fn add(&self, share: f64) -> ControlFlow<()> {
        let share = (share / PROGRESS_UNIT) as u32;
        let before = self.done.fetch_add(share, Ordering::Relaxed);
        if before >> PROGRESS_STEP_BITS == (before + share) >> PROGRESS_STEP_BITS {
            ControlFlow::Continue(())
        } else {
            self.report()
        }
    }

    /// Reports what is done, even if that is no more than before, to ask whether to go on.
    pub fn report(&self) -> ControlFlow<()> {
        (self.report)((f64::from(self.done.load(Ordering::Relaxed)) * PROGRESS_UNIT).min(1.0))
    }
}

/// What holds for a search and for all searches within it.
#[derive(Clone, Copy)]
pub(super) struct Task<'a> {
    pub pair_order: PairOrder,
    pub progress: Option<&'a Progress<'a>>,
    /// The share of the whole work.
    pub share: f64,
    /// How many plans enclose this search.
    pub depth: u32,
    /// How many boxes the innermost of them had.
    pub boxes: usize,
    /// Whether all boxes are known to be valid.
    pub is_checked: bool,
}

impl<'a> Task<'a> {
    pub fn new(pair_order: PairOrder, progress: Option<&'a Progress<'a>>) -> Self {
        Self { pair_order, progress, share: 1.0, depth: 0, boxes: usize::MAX, is_checked: false }
    }

    /// A task nested in this one, with a share of its work. Its plan has this many boxes, all valid.
    pub fn nested(self, share: f64, boxes: usize) -> Self {
        let depth = self.depth + 1;
        Self { depth, share: self.share * share, boxes, is_checked: true, ..self }
    }

    /// Adds a share of the task to the progress.
    ///
    /// # Errors
    /// [`Stop::Cancelled`].
    pub fn done(self, share: f64) -> Result<(), Stop> {
        match self.progress.map(|progress| progress.add(self.share * share)) {
            Some(ControlFlow::Break(())) => Err(Stop::Cancelled),
            _ => Ok(()),
        }
    }
}

/// Why a search, or the cut of its boxes, stopped early: the most important reason first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Stop {
    /// A box is inverted or NaN; no pair has been found.
    Invalid,
    /// There is not enough memory.
    Memory,
    /// A cut would make more records than allowed: it is dropped, and the search goes on without it.
    TooMany,
    /// The progress callback or the receiver of the pairs ended it.
    Cancelled,
}

impl From<TryReserveError> for Stop {
    fn from(_: TryReserveError) -> Self {
        Stop::Memory
    }
}
