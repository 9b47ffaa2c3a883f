//! How counts and endpoints are written as numbers.

use sweep_and_prune_algorithms::{Counts, Side};

/// The counts, in the order in which `classroom/demo/src/algorithms/runner.ts` reads them.
pub fn counts(counts: &Counts) -> [f64; 10] {
    [
        counts.comparisons,
        counts.swaps,
        counts.tests,
        counts.axis_overlaps,
        counts.axis_ends,
        counts.pairs,
        counts.begun,
        counts.ended,
        counts.active,
        counts.max_active,
    ]
    .map(|count| count as f64)
}

/// An endpoint as in a trace: twice the box, and one more for the right endpoint.
pub fn edge(id: u32, side: Side) -> f64 {
    2.0 * f64::from(id) + f64::from(side as u8)
}
