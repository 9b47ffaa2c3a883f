//! The model of the cost of cutting space into columns.
//!
//! Two costs pull against each other. Narrower columns leave fewer candidates to test, but a box is
//! copied to each column that it touches, `1 + size / width` of them on average.
//!
//! The constants are the same for every kernel, since the order of the pairs follows from the plan.
//! They were fitted to one core of an AMD EPYC (Zen 5).

use super::field::Field;
use super::float::{greater, lesser};
use super::overlaps::{Limits, Members, member};
use super::sample::{AXES, SAMPLE, Sample};

/// Nanoseconds to place, sort and lay out one record, and to begin its scan.
pub const RECORD: f64 = 24.0;
/// Of these, nanoseconds to place it: all that it takes if the other set has none in its column.
const PLACE: f64 = 6.0;
/// Nanoseconds to test one candidate: between what 16 lanes take and what 4 do.
pub const CANDIDATE: f64 = 0.25;
/// Nanoseconds to begin and end a column.
const COLUMN: f64 = 250.0;

/// How many boxes, how large they are on average, and which of the sample they are.
#[derive(Clone, Copy)]
pub struct Shape {
    pub count: f64,
    pub mean: [f64; AXES],
    pub members: Members,
}

impl Shape {
    /// All boxes of a set.
    pub fn new(sample: &Sample, field: &Field) -> Self {
        Self::of(sample, field, 0, f64::INFINITY, false)
    }

    /// The boxes up to a size on an axis, and those above.
    pub fn split(sample: &Sample, field: &Field, axis: usize, size: f64) -> [Self; 2] {
        [false, true].map(|is_above| Self::of(sample, field, axis, size, is_above))
    }

    fn of(sample: &Sample, field: &Field, axis: usize, size: f64, is_above: bool) -> Self {
        let (mut len, mut sum, mut members) = (0.0, [0.0; AXES], 0);
        for i in 0..sample.len {
            if (sample.size(axis, i) > size) != is_above {
                continue;
            }
            len += 1.0;
            members |= member(sample, i);
            for (axis, sum) in sum.iter_mut().enumerate().take(field.dimensions) {
                *sum += field.size(sample, axis, i) / SAMPLE as f64;
            }
        }
        let scale = if len > 0.0 { SAMPLE as f64 / len } else { 0.0 };
        let count = sample.count * len / sample.len as f64;
        Self { count, mean: sum.map(|sum| sum * scale), members }
    }

    /// How many records the boxes become.
    pub fn records(&self, field: &Field, cut: &Cut) -> f64 {
        let mut records = self.count;
        for axis in 0..field.dimensions {
            records *= self.touched(field, cut, axis);
        }
        records
    }

    /// How many columns a box touches on an axis, on average.
    fn touched(&self, field: &Field, cut: &Cut, axis: usize) -> f64 {
        let columns = cut.columns[axis];
        if columns > 1.0 { 1.0 + self.mean[axis] / field.extent(axis) * columns } else { 1.0 }
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
pub struct Search<'a> {
    pub field: &'a Field,
    pub shapes: &'a [Shape],
    /// Between what limits the chance of two boxes is to overlap on each axis.
    pub limits: Limits,
}

/// The chance that two boxes overlap on an axis, by their mean sizes; of one set half of it.
pub fn chance(Search { field, shapes, .. }: &Search<'_>, axis: usize) -> f64 {
    let mut chance = field.ties[axis];
    for shape in *shapes {
        chance += if field.spread[axis] > 0.0 {
            lesser(shape.mean[axis] / field.spread[axis], 1.0)
        } else {
            1.0
        };
    }
    lesser(chance, 1.0)
}

/// The chance that two boxes share a column on an axis, if where they are does not depend on their sizes.
pub fn together(field: &Field, shapes: &[Shape; 2], cut: &Cut, axis: usize) -> f64 {
    let touched = shapes.each_ref().map(|shape| shape.touched(field, cut, axis));
    field.together(axis, cut.columns[axis]) * touched[0] * touched[1]
}

/// The nanoseconds that a search is expected to take with a cut.
pub fn cost(search: &Search<'_>, cut: &Cut) -> f64 {
    let Search { field, shapes, limits } = *search;
    let columns: f64 = cut.len();
    // The chance that two boxes are in the same column. Those that overlap are.
    let mut together = 1.0;
    for axis in (0..field.dimensions).filter(|&axis| cut.columns[axis] > 1.0) {
        together *= greater(field.together(axis, cut.columns[axis]), limits[axis].0);
    }
    let mut records = 0.0;
    let mut candidates = together;
    for shape in shapes {
        let count = shape.records(field, cut);
        records += count;
        candidates *= count;
        if shapes.len() == 1 {
            candidates *= count;
        }
    }
    let (least, most) = limits[cut.sweep];
    // Of one set there are n² / 2 pairs, which the model's chance takes into account.
    let of_all = if shapes.len() == 1 { 0.5 } else { 1.0 };
    let chance = lesser(chance(search, cut.sweep), of_all * most);
    let pairs = candidates * greater(chance, of_all * least);
    if let [first, second] = shapes {
        let counts = [first, second].map(|shape| shape.records(field, cut));
        // The share of the columns that have any of each set: as many as records, at most.
        let [with_first, with_second] = counts.map(|count| lesser(count / columns, 1.0));
        let shared = counts[0] * with_second + counts[1] * with_first;
        return records * PLACE
            + shared * (RECORD - PLACE)
            + pairs * CANDIDATE
            + columns * with_first * with_second * COLUMN;
    }
    records * RECORD + pairs * CANDIDATE + columns * COLUMN
}
