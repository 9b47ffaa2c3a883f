//! The simplest observer: it counts.

use crate::endpoint::Edge;
use crate::observer::{Observer, Separation};

/// Counts what an algorithm does, over as many steps as it watches. The same thing is counted for
/// every algorithm, so the numbers can be put side by side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Comparisons of the sort.
    pub comparisons: u64,
    /// Swaps of the sort.
    pub swaps: u64,
    /// Pairs of boxes handed to the box test, those that it rejects included.
    pub tests: u64,
    /// Pairs found to overlap on a swept axis. The persistent swap-driven forms report only overlaps that begin, so there
    /// `axis_overlaps - axis_ends` is how many there are now.
    pub axis_overlaps: u64,
    /// Pairs found to overlap no longer on a swept axis.
    pub axis_ends: u64,
    /// Pairs that overlap on every axis.
    pub pairs: u64,
    /// Pairs that began.
    pub begun: u64,
    /// Pairs that ended.
    pub ended: u64,
    /// How many boxes the sweep line is in.
    pub active: u64,
    /// The most boxes that the sweep line has been in at once.
    pub max_active: u64,
}

impl Counts {
    /// Everything an algorithm spends time on, as one number: comparisons, swaps, tests, axis
    /// overlaps and their ends, and pairs reported. What the complexity table is fitted to.
    pub fn operations(&self) -> u64 {
        let sort = self.comparisons + self.swaps;
        sort + self.tests + self.axis_overlaps + self.axis_ends + self.pairs
    }
}

/// Methods that count their event.
macro_rules! counted {
    ($($count:ident: $method:ident($($type:ty),*);)*) => {$(
        #[inline]
        fn $method(&mut self, $(_: $type),*) {
            self.$count += 1;
        }
    )*};
}

impl Observer for Counts {
    counted! {
        comparisons: compare(Edge, Edge);
        swaps: swap([usize; 2], Edge, Edge);
        tests: test(u32, u32, Option<Separation>);
        axis_overlaps: axis_overlap(usize, u32, u32);
        axis_ends: axis_apart(usize, u32, u32);
        pairs: overlap(u32, u32);
        begun: begin(u32, u32);
        ended: end(u32, u32);
    }

    #[inline]
    fn enter(&mut self, _: u32) {
        self.active += 1;
        self.max_active = self.max_active.max(self.active);
    }

    #[inline]
    fn leave(&mut self, _: u32) {
        self.active = self.active.saturating_sub(1);
    }
}
