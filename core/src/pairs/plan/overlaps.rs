//! Which boxes of the samples overlap on each axis: a closer look, where boxes are crowded.
//!
//! The [`Field`](super::field::Field) supposes that boxes are spread evenly within the finest cells that a
//! sample can tell, and each axis independent of the others. Where most boxes lie in a small part of an
//! axis, or small and large ones in different parts, only their edges show how many a sweep would test.

use super::float::greater;
use super::sample::{AXES, Sample};

/// The most boxes of a sample that are looked at: one bit each.
const LOOKED_AT: usize = u64::BITS as usize;
/// Two boxes of a set may overlap so many times more or less often than those of the sample,
const TOLERANCE: f64 = 1.5;
/// and so many overlaps in the sample are chance. (If boxes that all overlap are so few that the sample
/// has at most one of them one time in ten, it has four on average, and six pairs.)
const CHANCE: f64 = 6.0;

/// Boxes of a sample: one bit each.
pub type Members = u64;

/// A box of a sample; none if it is not looked at.
pub fn member(sample: &Sample, i: usize) -> Members {
    let step = step(sample.len, LOOKED_AT);
    if i.is_multiple_of(step) { 1 << (i / step) } else { 0 }
}

/// From one box that is looked at to the next, if at most so many of the sample are.
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

/// For each box of the first sample, which boxes of the last it overlaps; of each sample so many at most.
#[inline(never)]
fn compare(first: Edges<'_>, last: Edges<'_>, most: usize) -> [Members; LOOKED_AT] {
    let mut rows = [0; LOOKED_AT];
    let [first_step, last_step] = [first, last].map(|edges| step(edges.min.len(), most));
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
fn count(rows: &[Members; LOOKED_AT], first: Members, last: Members, is_one: bool) -> [f64; 2] {
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

/// How many boxes a glance at a sample takes, and how much more often they overlap than expected if that
/// asks for a closer look: so many times, and so many overlaps more.
const GLANCE: usize = 24;
const UNEXPECTED: f64 = 3.0;
const MORE: f64 = 8.0;

/// Whether many more boxes overlap on an axis than a chance of two boxes lets expect: to overlap if it is the sweep axis,
/// else to share a column, as boxes that overlap do.
pub fn is_unexpected(samples: &[&Sample], axis: usize, chance: f64) -> bool {
    let [first, last] = [samples[0], samples[samples.len() - 1]];
    let rows = compare(edges(first, axis), edges(last, axis), GLANCE);
    let all = Members::MAX >> (LOOKED_AT - GLANCE);
    let [pairs, overlaps] = count(&rows, all, all, samples.len() == 1);
    overlaps > UNEXPECTED * chance * pairs + MORE
}

/// Between what limits the chance is that two boxes overlap on each axis.
pub type Limits = [(f64, f64); AXES];

/// The limits without a closer look.
pub const UNKNOWN: (f64, f64) = (0.0, f64::INFINITY);

/// For each box of the first sample, which boxes of the last it overlaps on each axis. If there is one
/// sample, it is both.
pub struct Overlaps {
    rows: [[Members; LOOKED_AT]; AXES],
}

impl Overlaps {
    pub fn new(samples: &[&Sample]) -> Self {
        let [first, last] = [samples[0], samples[samples.len() - 1]];
        let rows = |axis| compare(edges(first, axis), edges(last, axis), LOOKED_AT);
        let mut overlaps = Self { rows: [[0; LOOKED_AT]; AXES] };
        (0..first.dimensions).for_each(|axis| overlaps.rows[axis] = rows(axis));
        overlaps
    }

    /// Between what limits the chance is that a box of one group and one of another overlap on each axis; or
    /// two boxes of one group, which is both.
    pub fn limits(&self, first: Members, last: Members, is_one: bool) -> Limits {
        self.rows.each_ref().map(|rows| {
            let [pairs, overlaps] = count(rows, first, last, is_one);
            let pairs = greater(pairs, 1.0);
            ((overlaps - CHANCE) / TOLERANCE / pairs, (overlaps + CHANCE) * TOLERANCE / pairs)
        })
    }
}
