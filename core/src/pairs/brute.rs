//! Brute force for small inputs, where a plan does not pay.

use super::kernel::{PairOrder, SortedBoxes};
use super::sink::{Sink, Store};
use super::sort::Sorter;
use super::source::Source;
use super::task::{Stop, Task};
use crate::{Aabb, Scalar};

// Measured on random boxes in the plane and in space, one core of an AMD EPYC (Zen 5).

/// Up to this many boxes of one set are tested one by one, and their pairs are stored without a sink. (This takes 0.7
/// to 1.2 times as long as brute force that validates. 41 sparse boxes, tested by vectors, take 1.3 times as long.)
const MOST_SCALAR_BOXES: usize = 40;
/// Up to this many tests, the boxes of any one or two sets are tested one by one.
const MOST_SCALAR_TESTS: usize = 400;
/// Up to this many boxes per set, every box is tested against every other with vectors.
const MOST_BRUTE_FORCE_BOXES: usize = 128;
/// Between two sets this also holds if the smaller has at most this many boxes.
const MOST_BOXES_AGAINST_MANY: usize = 32;
/// How many boxes are laid out at a time: they stay in the second-level cache.
const BOXES_AT_A_TIME: usize = 4096;

/// Whether every box is tested against every other, with nothing sorted.
pub(super) fn is_brute_force<const D: usize, T: Scalar, S: Source<D, T>>(sets: &[&[S]]) -> bool {
    match *sets {
        [first, second] => is_brute_force_between(first.len(), second.len()),
        _ => sets[0].len() <= MOST_BRUTE_FORCE_BOXES,
    }
}

/// Whether that is so between two sets of these numbers of boxes.
pub(super) fn is_brute_force_between(first: usize, second: usize) -> bool {
    first.max(second) <= MOST_BRUTE_FORCE_BOXES || first.min(second) <= MOST_BOXES_AGAINST_MANY
}

/// Whether boxes are so few that they are tested one by one.
#[inline]
pub(super) fn is_few<const D: usize, T: Scalar, S: Source<D, T>>(sets: &[&[S]]) -> bool {
    // With 65,536 boxes the product overflows where `usize` has 32 bits.
    sets[0].len().saturating_mul(sets[sets.len() - 1].len()) <= MOST_SCALAR_TESTS
}

/// Tests every box against every other by `sweep`, which sweeps one or two sets on all axes.
pub(super) fn brute_force<const D: usize, T: Scalar, S: Source<D, T>, O: Sink>(
    sets: &[&[S]],
    task: Task<'_>,
    laid_out: &mut [SortedBoxes<T>; 2],
    sink: &mut O,
    sweep: impl Fn(&[SortedBoxes<T>], &mut O) -> Result<(), Stop>,
) -> Result<(), Stop> {
    let [first, last] = [sets[0], sets[sets.len() - 1]];
    if is_few(sets) {
        return send_few(sets, task.pair_order, sink);
    }
    for start in (0..first.len()).step_by(BOXES_AT_A_TIME) {
        let range = start..first.len().min(start + BOXES_AT_A_TIME);
        Sorter::unsorted(first, range, &mut laid_out[0])?;
        if sets.len() == 1 {
            return sweep(&laid_out[..1], sink);
        }
        for start in (0..last.len()).step_by(BOXES_AT_A_TIME) {
            let range = start..last.len().min(start + BOXES_AT_A_TIME);
            Sorter::unsorted(last, range, &mut laid_out[1])?;
            sweep(&laid_out[..], sink)?;
        }
    }
    Ok(())
}

/// Finds the pairs of up to [`MOST_SCALAR_BOXES`] boxes. Returns false, with nothing stored, if there are more boxes, if
/// one is invalid, or if there is not enough memory.
#[inline]
pub(super) fn find_few<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>], store: &mut Store) -> bool {
    if boxes.len() > MOST_SCALAR_BOXES || !boxes.iter().all(Aabb::is_valid) {
        return false;
    }
    store.clear();
    boxes.len() < 2 || find_few_pairs(boxes, store)
}

/// See [`find_few`]. Not inline, so that there is little to save and restore for none or one.
#[inline(never)]
fn find_few_pairs<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>], store: &mut Store) -> bool {
    store.put(boxes.len() * (boxes.len() - 1) / 2, |pairs| {
        let (mut count, mut i, mut boxes) = (0, 0, boxes);
        while let [a, behind @ ..] = boxes {
            for (j, b) in (i + 1..).zip(behind) {
                if a.overlaps(b)
                    && let Some(pair) = pairs.get_mut(count)
                {
                    *pair = [i, j];
                    count += 1;
                }
            }
            (i, boxes) = (i + 1, behind);
        }
        count
    })
}

/// Sends the pairs of few valid boxes to the sink, box by box.
#[inline]
pub(super) fn send_few<const D: usize, T: Scalar, S: Source<D, T>, O: Sink>(
    sets: &[&[S]],
    pair_order: PairOrder,
    sink: &mut O,
) -> Result<(), Stop> {
    let [first, last] = [sets[0], sets[sets.len() - 1]];
    let mut out = sink.spare()?;
    let mut count = 0;
    for (i, a) in first.iter().enumerate() {
        let start = if sets.len() == 1 { i + 1 } else { 0 };
        for (j, b) in (start..).zip(&last[start..]) {
            if a.aabb().overlaps(b.aabb()) && a.dedup() & b.dedup() == 0 {
                if count == out.len() {
                    sink.take(count)?;
                    (out, count) = (sink.spare()?, 0);
                }
                let (a, b) = (a.id(i), b.id(j));
                let swap = pair_order == PairOrder::Ascending && b < a;
                out[count] = if swap { [b, a] } else { [a, b] };
                count += 1;
            }
        }
    }
    sink.take(count)
}
