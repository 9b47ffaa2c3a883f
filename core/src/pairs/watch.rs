//! Progress of a long run, and the way to end it.

use core::ops::ControlFlow;
use core::sync::atomic::{AtomicU32, Ordering};

/// The caller's function and how much it has been told. Shared by threads.
pub(super) struct Watch<'a> {
    tell: &'a (dyn Fn(f64) -> ControlFlow<()> + Sync),
    /// The share that is done, in units of 2^-24.
    done: AtomicU32,
}

const UNIT: f64 = 1.0 / (1 << 24) as f64;

impl<'a> Watch<'a> {
    pub fn new(tell: &'a (dyn Fn(f64) -> ControlFlow<()> + Sync)) -> Self {
        Self { tell, done: AtomicU32::new(0) }
    }

    /// Adds a share, and tells how much is done if a step of 1/256 is complete.
    pub fn add(&self, share: f64) -> ControlFlow<()> {
        let share = (share / UNIT) as u32;
        let before = self.done.fetch_add(share, Ordering::Relaxed);
        if before >> 16 == (before + share) >> 16 { ControlFlow::Continue(()) } else { self.look() }
    }

    /// Tells how much is done, though it be no more than before: asks whether to go on.
    pub fn look(&self) -> ControlFlow<()> {
        (self.tell)((f64::from(self.done.load(Ordering::Relaxed)) * UNIT).min(1.0))
    }
}
