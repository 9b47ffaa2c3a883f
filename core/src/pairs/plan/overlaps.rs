//! Which boxes of the samples overlap on each axis: a closer look, where boxes are crowded.
//!
//! The [`Distribution`](super::distribution::Distribution) supposes that boxes are spread evenly within the finest cells
//! that a sample can tell apart, and that the axes are independent of each other. Where most boxes lie in a small part
//! of an axis, or small and large boxes in different parts, only their edges show how many a sweep would test.

use super::sample::{AXES, Sample};
use crate::float::greater;

/// The most boxes of a sample that are compared: one bit each.
const MOST_COMPARED: usize = u64::BITS as usize;
/// The true number of overlaps may differ from the sample's by this factor, plus or minus [`OVERLAPS_BY_CHANCE`].
const OVERLAP_TOLERANCE: f64 = 1.5;
/// This many overlaps in the sample may be chance. (If there are so few boxes that all overlap each other that one
/// sample in ten has at most one of them, a sample has four of them on average, which are six pairs.)
const OVERLAPS_BY_CHANCE: f64 = 6.0;

/// Boxes of a sample: one bit each.
pub type Members = u64;

/// A box of a sample; no member if it is not compared.
pub fn member(sample: &Sample, i: usize) -> Members {
    let step = step(sample.len, MOST_COMPARED);
    if i.is_multiple_of(step) { 1 << (i / step) } else { 0 }
}

/// The stride that visits at most `most` of `len` boxes.
fn step(len: usize, most: usize) -> usize {
    len.div_ceil(most).max(1)
}

/// The edges of the boxes of a sample on an axis.
#[derive(Clone, Copy)]
struct Edges<'a> {
    min: &'a [f64],
    max: &'a [f64],
}

fn edges(sample: &Sample, axis: usize) -> Edges<'_> {
    Edges { min: &sample.min[axis][..sample.len], max: &sample.max[axis][..sample.len] }
}

/// For each box of the first sample, which boxes of the last it overlaps.
#[inline(never)]
fn compare(first: Edges<'_>, last: Edges<'_>) -> [Members; MOST_COMPARED] {
    let mut rows = [0; MOST_COMPARED];
    let [first_step, last_step] = [first, last].map(|edges| step(edges.min.len(), MOST_COMPARED));
    for (row, i) in rows.iter_mut().zip((0..first.min.len()).step_by(first_step)) {
        for k in (0..last.min.len()).step_by(last_step).rev() {
            let overlap = (last.min[k] <= first.max[i]) & (first.min[i] <= last.max[k]);
            *row = *row << 1 | Members::from(overlap);
        }
    }
    rows
}

/// The pairs of a box of one group and a box of another, and how many overlap; of one group, the pairs
/// within it.
#[inline(never)]
fn count(rows: &[Members; MOST_COMPARED], first: Members, last: Members, is_one: bool) -> [f64; 2] {
    let (mut overlaps, mut left) = (0, first);
    while left != 0 {
        overlaps += (rows[left.trailing_zeros() as usize] & last).count_ones();
        left &= left - 1;
    }
    // In one group each box meets itself, and each pair is there twice. (Boxes that are not checked yet may
    // be inverted or NaN, and not overlap themselves.)
    let (with_itself, times) = if is_one { (first.count_ones(), 0.5) } else { (0, 1.0) };
    [first.count_ones() * last.count_ones(), overlaps]
        .map(|count| f64::from(count.saturating_sub(with_itself)) * times)
}

/// How many boxes of a sample a glance compares.
const GLANCED_BOXES: usize = 32;
/// A glance asks for a closer look if boxes overlap more than this many times as often as expected, plus
/// [`GLANCE_OVERLAP_MARGIN`].
const GLANCE_OVERLAP_RATIO: f64 = 3.0;
/// See [`GLANCE_OVERLAP_RATIO`].
const GLANCE_OVERLAP_MARGIN: f64 = 8.0;

/// The pairs of some boxes of one sample, or of each of two, and how many overlap on an axis.
#[inline(never)]
fn glance(samples: &[&Sample], axis: usize) -> [f64; 2] {
    let [first, last] = [samples[0], samples[samples.len() - 1]].map(|sample| edges(sample, axis));
    let [first_step, last_step] = [first, last].map(|edges| step(edges.min.len(), GLANCED_BOXES));
    let (mut pairs, mut overlaps) = (0, 0);
    for i in (0..first.min.len()).step_by(first_step) {
        let begin = if samples.len() == 1 { i + first_step } else { 0 };
        for k in (begin..last.min.len()).step_by(last_step) {
            pairs += 1;
            overlaps += u32::from((last.min[k] <= first.max[i]) & (first.min[i] <= last.max[k]));
        }
    }
    [pairs, overlaps].map(f64::from)
}

/// The chance that two boxes overlap on an axis, by a glance.
pub fn chance_to_overlap(samples: &[&Sample], axis: usize) -> f64 {
    let [pairs, overlaps] = glance(samples, axis);
    overlaps / greater(pairs, 1.0)
}

/// Whether a glance finds far more overlaps on an axis than the model expects. `chance` is that of two boxes to overlap
/// (sweep axis) or to share a column (other axes).
pub fn is_unexpected(samples: &[&Sample], axis: usize, chance: f64) -> bool {
    let [pairs, overlaps] = glance(samples, axis);
    overlaps > GLANCE_OVERLAP_RATIO * chance * pairs + GLANCE_OVERLAP_MARGIN
}

/// Lower and upper bound of the chance that two boxes overlap, per axis.
pub type Limits = [(f64, f64); AXES];

/// The limits without a closer look.
pub const NO_LIMITS: (f64, f64) = (0.0, f64::INFINITY);

/// For each box of the first sample, which boxes of the last it overlaps on each axis. If there is one
/// sample, it is both.
pub struct Overlaps {
    rows: [[Members; MOST_COMPARED]; AXES],
}

impl Overlaps {
    pub fn new(samples: &[&Sample]) -> Self {
        let [first, last] = [samples[0], samples[samples.len() - 1]];
        let rows = |axis| compare(edges(first, axis), edges(last, axis));
        let mut overlaps = Self { rows: [[0; MOST_COMPARED]; AXES] };
        (0..first.dimensions).for_each(|axis| overlaps.rows[axis] = rows(axis));
        overlaps
    }

    /// Lower and upper bound of the chance that a box of one group and a box of another overlap, per axis; or two boxes
    /// of one group, if that is both.
    pub fn limits(&self, first: Members, last: Members, is_one: bool) -> Limits {
        self.rows.each_ref().map(|rows| {
            let [pairs, overlaps] = count(rows, first, last, is_one);
            let pairs = greater(pairs, 1.0);
            (
                (overlaps - OVERLAPS_BY_CHANCE) / OVERLAP_TOLERANCE / pairs,
                (overlaps + OVERLAPS_BY_CHANCE) * OVERLAP_TOLERANCE / pairs,
            )
        })
    }
}
