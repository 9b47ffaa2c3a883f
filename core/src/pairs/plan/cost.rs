//! The model of the cost of cutting space into columns.
//!
//! Two costs pull against each other. Narrower columns leave fewer pairs to test, but a box is
//! copied to each column that it touches, `1 + size / width` of them on average.
//!
//! The constants are the same for every kernel, since the order of the pairs follows from the plan.
//! They were fitted to one core of an AMD EPYC (Zen 5).

use super::distribution::Distribution;
use super::overlaps::{Limits, Members, member};
use super::sample::{AXES, MOST_SAMPLED, Sample};
use crate::float::{greater, lesser};

/// Nanoseconds to place, sort and lay out one record, and to begin its scan.
pub const RECORD_NS: f64 = 24.0;
/// Nanoseconds of these to place it. If the other set has no boxes in its column, this is all that it takes.
const PLACE_NS: f64 = 6.0;
/// Nanoseconds that a box saves if space is not cut, since it is not placed: on a line, in the plane, in space. (In the
/// plane, 1,000 boxes take 0.80 to 0.95 of the time. In space, where each test that a cut saves takes longer, 4 ns made
/// mixed sizes 1.1 times as slow.)
pub const UNPLACED_NS: [f64; AXES] = [4.0, 4.0, 1.0];
/// Nanoseconds to plan a cut of few boxes. (In the plane 1.2 to 1.5 us, in space 1.6 to 2.3. Where none is planned, 300 boxes take
/// 0.75 to 0.9 of the time, 1,000 in the plane 0.91 to 0.98, and 1,000 in space up to 1.05.)
pub const PLAN_NS: f64 = 2000.0;
/// Nanoseconds to test one pair: between what 16 lanes and what 4 lanes take.
pub const TEST_NS: f64 = 0.25;
/// Nanoseconds to begin and end a column.
pub const COLUMN_NS: f64 = 250.0;

/// How many boxes, how large they are on average, and which of the sample they are.
#[derive(Clone, Copy)]
pub struct Shape {
    pub count: f64,
    pub mean: [f64; AXES],
    pub members: Members,
}

impl Shape {
    /// All boxes of a set.
    pub fn new(sample: &Sample, distribution: &Distribution) -> Self {
        Self::of(sample, distribution, 0, f64::INFINITY, false)
    }

    /// The boxes up to a size on an axis, and those above.
    pub fn split(
        sample: &Sample,
        distribution: &Distribution,
        axis: usize,
        size: f64,
    ) -> [Self; 2] {
        [false, true].map(|is_above| Self::of(sample, distribution, axis, size, is_above))
    }

    fn of(
        sample: &Sample,
        distribution: &Distribution,
        axis: usize,
        size: f64,
        is_above: bool,
    ) -> Self {
        let (mut len, mut sum, mut members) = (0.0, [0.0; AXES], 0);
        for i in 0..sample.len {
            if (sample.size(axis, i) > size) != is_above {
                continue;
            }
            len += 1.0;
            members |= member(sample, i);
            for (axis, sum) in sum.iter_mut().enumerate().take(distribution.dimensions) {
                *sum += distribution.size(sample, axis, i) / MOST_SAMPLED as f64;
            }
        }
        let scale = if len > 0.0 { MOST_SAMPLED as f64 / len } else { 0.0 };
        let count = sample.count * len / sample.len as f64;
        Self { count, mean: sum.map(|sum| sum * scale), members }
    }

    /// How many records the boxes become.
    pub fn records(&self, distribution: &Distribution, cut: &Cut) -> f64 {
        let mut records = self.count;
        for axis in 0..distribution.dimensions {
            records *= self.touched(distribution, cut, axis);
        }
        records
    }

    /// How many columns a box touches on an axis, on average.
    fn touched(&self, distribution: &Distribution, cut: &Cut, axis: usize) -> f64 {
        let columns = cut.columns[axis];
        if columns > 1.0 {
            1.0 + self.mean[axis] / distribution.extent(axis) * columns
        } else {
            1.0
        }
    }
}

/// A sweep axis, columns on the other axes, slabs on the sweep axis.
#[derive(Clone, Copy)]
pub struct Cut {
    pub sweep: usize,
    pub columns: [f64; AXES],
}

impl Cut {
    /// One column.
    pub fn uncut(sweep: usize) -> Self {
        Self { sweep, columns: [1.0; AXES] }
    }

    /// How many columns there are.
    pub fn len(&self) -> f64 {
        self.columns.iter().product()
    }
}

/// What is searched: one group of boxes (pairs within it) or two (pairs between them).
pub struct PlannedSearch<'a> {
    pub distribution: &'a Distribution,
    pub shapes: &'a [Shape],
    /// Lower and upper bound of the chance that two boxes overlap, per axis.
    pub limits: Limits,
}

/// The chance that two boxes overlap on an axis, by their mean sizes; of one set half of it.
pub fn chance(PlannedSearch { distribution, shapes, .. }: &PlannedSearch<'_>, axis: usize) -> f64 {
    let mut chance = distribution.ties[axis];
    for shape in *shapes {
        chance += if distribution.spread[axis] > 0.0 {
            lesser(shape.mean[axis] / distribution.spread[axis], 1.0)
        } else {
            1.0
        };
    }
    lesser(chance, 1.0)
}

/// The chance that two boxes share a column on an axis, if where they are does not depend on their sizes.
pub fn chance_to_share(
    distribution: &Distribution,
    shapes: &[Shape; 2],
    cut: &Cut,
    axis: usize,
) -> f64 {
    let touched = shapes.each_ref().map(|shape| shape.touched(distribution, cut, axis));
    distribution.chance_to_share(axis, cut.columns[axis]) * touched[0] * touched[1]
}

/// The nanoseconds that a search is expected to take with a cut.
pub fn cost(search: &PlannedSearch<'_>, cut: &Cut) -> f64 {
    let PlannedSearch { distribution, shapes, limits } = *search;
    let columns: f64 = cut.len();
    // The chance that two boxes are in the same column. Those that overlap are.
    let mut share = 1.0;
    for axis in (0..distribution.dimensions).filter(|&axis| cut.columns[axis] > 1.0) {
        share *= greater(distribution.chance_to_share(axis, cut.columns[axis]), limits[axis].0);
    }
    let mut records = 0.0;
    let mut tests = share;
    for shape in shapes {
        let count = shape.records(distribution, cut);
        records += count;
        tests *= count;
        if shapes.len() == 1 {
            tests *= count;
        }
    }
    let (least, most) = limits[cut.sweep];
    // Of one set there are n² / 2 pairs, which the model's chance takes into account.
    let of_all = if shapes.len() == 1 { 0.5 } else { 1.0 };
    let chance = lesser(chance(search, cut.sweep), of_all * most);
    let tests = tests * greater(chance, of_all * least);
    if let [first, second] = shapes {
        let counts = [first, second].map(|shape| shape.records(distribution, cut));
        // The share of the columns that have any of each set: as many as records, at most.
        let [with_first, with_second] = counts.map(|count| lesser(count / columns, 1.0));
        let shared = counts[0] * with_second + counts[1] * with_first;
        return records * PLACE_NS
            + shared * (RECORD_NS - PLACE_NS)
            + tests * TEST_NS
            + columns * with_first * with_second * COLUMN_NS;
    }
    records * RECORD_NS + tests * TEST_NS + columns * COLUMN_NS
}
