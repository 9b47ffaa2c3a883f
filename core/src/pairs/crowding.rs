//! When the boxes of one sweep are so crowded that another plan is made for them.

use super::kernel::SortedBoxes;
use super::plan::{Among, Plan, TEST_NS, plan};
use super::source::Source;
use crate::Scalar;

// Chosen on clustered scenes, 10,000 to 100,000 boxes in the plane and in space. 100,000 boxes in clusters within
// clusters took 11 ms instead of 33 after a change that, for the most part, let plans see clusters.

/// A column with more records than this is planned again before it is sorted.
const MOST_COLUMN_RECORDS: usize = 16384;
/// So is a column with more than this many times its share of the records: the plan did not expect them.
const MOST_SHARES_IN_COLUMN: usize = 10;
/// Fewer boxes take less time to sort than to plan.
const MIN_BOXES_TO_PLAN: usize = 2048;

/// With fewer boxes, a second plan never pays after the sort.
const MIN_BOXES_TO_PROBE: usize = 512;
/// Nor does it if a sweep has fewer tests per box than this. (At 0.25 ns a test, this many cost as much as placing and
/// sorting the box.)
const CROWDED_TESTS_PER_BOX: u64 = 96;
/// Bytes of the left edges that a probe tests, on average, below which a vector of 32 bytes is faster than one of 64: a
/// quarter of its lanes. (2.2 tests per box take 0.87 to 0.91 of the time, 4.2 the same, 8.6 take 1.1 times as long: tower
/// and slab, mixed, and uniform boxes in the plane.)
const SPARSE_BYTES_PER_BOX: usize = 16;
/// How many probes suffice to show that boxes are not crowded.
const FEW_PROBES: u64 = 32;
/// How many probes decide whether crowded boxes are planned again.
const MANY_PROBES: u64 = 512;
/// They are planned again if the plan costs less than this share of the sweep: the model is not exact. (With 0.75 17,799 flat
/// boxes in one of three orders were swept at once, in three times the time. With 0.9 more plans of the recorded groups of boxes
/// change, and three of five cost more than they save.)
const PLAN_COST_SHARE: f64 = 0.8;

/// A column with more records is planned again before it is sorted.
pub(super) fn most_records(boxes: usize, columns: usize) -> usize {
    (MOST_SHARES_IN_COLUMN * (boxes / columns)).clamp(MIN_BOXES_TO_PLAN, MOST_COLUMN_RECORDS)
}

/// About how many pairs of these boxes a sweep would test, if they are enough that it matters.
pub(super) fn tests<T: Scalar>(sorted: &[SortedBoxes<T>], boxes: usize) -> Option<u64> {
    (boxes >= MIN_BOXES_TO_PROBE).then(|| count_tests(sorted, FEW_PROBES))
}

/// Whether there are enough tests for this many boxes that another plan may pay.
pub(super) fn are_crowded(tests: u64, boxes: usize) -> bool {
    tests > CROWDED_TESTS_PER_BOX * boxes as u64
}

/// Whether this many tests are few for this many boxes.
pub(super) fn are_sparse<T: Scalar>(tests: u64, boxes: usize) -> bool {
    tests < (SPARSE_BYTES_PER_BOX / T::BYTES * boxes) as u64
}

/// A plan that costs less than to sweep these boxes at once on an axis, on which they are sorted and which takes about this
/// many tests.
pub(super) fn better_plan<const D: usize, T: Scalar, S: Source<D, T>>(
    sets: &[&[S]],
    sorted: &[SortedBoxes<T>],
    tests: u64,
    axis: usize,
    among: Among,
) -> Option<Plan<T>> {
    let boxes: usize = sets.iter().map(|set| set.len()).sum();
    if !are_crowded(tests, boxes) {
        return None;
    }
    let tests = count_tests(sorted, MANY_PROBES);
    if !are_crowded(tests, boxes) {
        return None;
    }
    let (plan, cost) = plan(sets, among);
    let is_same = matches!(plan, Plan::Cut(grid) if grid.len() == 1 && grid.sweep == axis);
    (!is_same && cost < PLAN_COST_SHARE * TEST_NS * tests as f64).then_some(plan)
}

/// About how many pairs of boxes a sweep would test, estimated from this many probes.
pub(super) fn count_tests<T: Scalar>(sets: &[SortedBoxes<T>], probes: u64) -> u64 {
    let last = &sets[sets.len() - 1];
    let one_way = |boxes: &SortedBoxes<T>, against: &SortedBoxes<T>| {
        let left = &against.left[..against.len()];
        let len = boxes.len() as u64; // `usize` has 32 bits in WebAssembly
        let ahead: u64 = (0..probes)
            .map(|probe| {
                let i = ((2 * probe + 1) * len / (2 * probes)) as usize;
                let end = left.partition_point(|&left| left <= boxes.right[i]);
                (end - left.partition_point(|&left| left < boxes.left[i])) as u64
            })
            .sum();
        ahead * len / probes
    };
    match sets {
        [first, _] => one_way(first, last) + one_way(last, first),
        _ => one_way(last, last),
    }
}
