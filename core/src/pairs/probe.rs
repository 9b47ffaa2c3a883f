//! What watches the work of a search: nothing, but in tests and benchmarks.

use super::kernel::SortedBoxes;
use crate::Scalar;

/// Is told of the work that a thread does.
pub(super) trait Probe: Default + Send {
    /// Whether boxes are swept once they are sorted.
    const SWEEPS: bool = true;

    /// Boxes were copied to columns: there are this many copies.
    #[inline(always)]
    fn copied(&mut self, _copies: usize) {}

    /// Boxes were sorted.
    #[inline(always)]
    fn sorted(&mut self, _boxes: usize) {}

    /// Sorted boxes will be swept.
    #[inline(always)]
    fn swept<T: Scalar>(&mut self, _sorted: &[SortedBoxes<T>]) {}
}

impl Probe for () {}

/// Ends a search before the sweep, to measure the stages before it.
#[cfg(feature = "std")]
#[derive(Debug, Default)]
pub(super) struct SortOnly;

#[cfg(feature = "std")]
impl Probe for SortOnly {
    const SWEEPS: bool = false;
}
