//! When boxes that are swept together are so crowded that another plan is made for them.

use super::kernel::SortedBoxes;
use super::plan::{Among, CANDIDATE, Plan, plan};
use super::source::Source;
use crate::Scalar;

// Chosen on clustered scenes, 10,000 to 100,000 boxes in the plane and in space. Clusters within clusters, at
// 100,000, took 11 ms instead of 33 after a change of which plans that see clusters were the main part.

/// A column with more boxes, or with so many times its share of them, is planned again before it is
/// sorted: that many were not expected.
const LARGE: usize = 16384;
const UNEXPECTED: usize = 10;
/// Fewer boxes take less time to sort than to plan.
const WORTH_A_PLAN: usize = 2048;

/// Sorted boxes are never planned again if they are fewer,
const WORTH_PROBING: usize = 512;
/// or if a sweep has fewer candidates per box. (At 0.25 ns a candidate these cost as much as to place and
/// sort the box.)
const CROWDED: u64 = 96;
/// How many probes show that boxes are not crowded, and how many decide that they are planned again.
pub(super) const FEW_PROBES: u64 = 32;
const MANY_PROBES: u64 = 512;
/// They are planned again if that costs less than this share of the sweep: the model is not exact.
const PLAN_PAYS: f64 = 0.75;

/// A column with more records is planned again before it is sorted.
pub(super) fn most_records(boxes: usize, columns: usize) -> usize {
    (UNEXPECTED * (boxes / columns)).clamp(WORTH_A_PLAN, LARGE)
}

/// A plan that costs less than to sweep these boxes, which are sorted on an axis, at once.
pub(super) fn better_plan<const D: usize, T: Scalar, S: Source<D, T>>(
    sets: &[&[S]],
    sorted: &[SortedBoxes<T>],
    axis: usize,
    among: Among,
) -> Option<Plan<T>> {
    let boxes: usize = sets.iter().map(|set| set.len()).sum();
    let crowd = CROWDED * boxes as u64;
    if boxes < WORTH_PROBING || candidates(sorted, FEW_PROBES) <= crowd {
        return None;
    }
    let candidates = candidates(sorted, MANY_PROBES);
    if candidates <= crowd {
        return None;
    }
    let (plan, cost) = plan(sets, among);
    let is_same = matches!(plan, Plan::Cut(grid) if grid.len() == 1 && grid.sweep == axis);
    (!is_same && cost < PLAN_PAYS * CANDIDATE * candidates as f64).then_some(plan)
}

/// About how many candidates a sweep would test, from so many probes.
pub(super) fn candidates<T: Scalar>(sets: &[SortedBoxes<T>], probes: u64) -> u64 {
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
