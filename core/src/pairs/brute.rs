//! Brute force for small inputs, where a plan does not pay.

use super::control::{Stop, Task};
use super::kernel::{PairOrder, SortedBoxes};
use super::sink::{Sink, Store};
use super::sort::Sorter;
use super::source::Source;
use crate::{Aabb, Scalar};

// Measured on random boxes in the plane and in space, one core of an AMD EPYC (Zen 5).

/// Up to this many boxes of one set are tested one by one, and stored without a sink: 0.7 to 1.2 times
/// brute force that validates; 41 sparse boxes by vectors take 1.3 times.
const FEW: usize = 40;
/// Up to this many tests, boxes are tested one by one.
const FEW_TESTS: usize = 400;
/// Up to this many boxes in a set, vectors test each against each,
const BRUTE_FORCE: usize = 128;
/// and with two sets also if one of them has no more than this.
const BRUTE_FORCE_AGAINST_MANY: usize = 32;
/// Boxes laid out at a time: they stay in the second-level cache.
const CHUNK: usize = 4096;

/// Whether each box is tested against each, with nothing sorted.
pub(super) fn is_brute_force<const D: usize, T: Scalar, S: Source<D, T>>(sets: &[&[S]]) -> bool {
    let [first, last] = [sets[0].len(), sets[sets.len() - 1].len()];
    first.max(last) <= BRUTE_FORCE
        || (sets.len() == 2 && first.min(last) <= BRUTE_FORCE_AGAINST_MANY)
}

/// Whether boxes are so few that they are tested one by one.
#[inline]
pub(super) fn is_few<const D: usize, T: Scalar, S: Source<D, T>>(sets: &[&[S]]) -> bool {
    // With 65,536 boxes the product overflows where `usize` has 32 bits.
    sets[0].len().saturating_mul(sets[sets.len() - 1].len()) <= FEW_TESTS
}

/// Tests each box against each, by `sweep`, which sweeps the one or two sets that it is given on all
/// axes.
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
    for start in (0..first.len()).step_by(CHUNK) {
        let range = start..first.len().min(start + CHUNK);
        Sorter::unsorted(first, range, &mut laid_out[0])?;
        if sets.len() == 1 {
            return sweep(&laid_out[..1], sink);
        }
        for start in (0..last.len()).step_by(CHUNK) {
            let range = start..last.len().min(start + CHUNK);
            Sorter::unsorted(last, range, &mut laid_out[1])?;
            sweep(&laid_out[..], sink)?;
        }
    }
    Ok(())
}

/// Finds the pairs of up to [`FEW`] boxes. False, with nothing stored, if they are more, or invalid,
/// or there is not enough memory.
#[inline]
pub(super) fn find_few<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>], store: &mut Store) -> bool {
    if boxes.len() > FEW || !boxes.iter().all(Aabb::is_valid) {
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
