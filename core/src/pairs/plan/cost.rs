//! The model of the cost of cutting space into columns.
//!
//! Two costs pull against each other. Narrower columns leave fewer candidates to test, but a box is
//! copied to each column that it touches, `1 + size / width` of them on average.
//!
//! The constants are the same for every kernel, since the order of the pairs follows from the plan.
//! They were fitted to one core of an AMD EPYC (Zen 5).

use super::field::Field;
use super::float::lesser;
use super::sample::{SAMPLE, Sample};

/// Nanoseconds to place, sort and lay out one record, and to begin its scan.
pub const RECORD: f64 = 24.0;
/// Of these, nanoseconds to place it: all that it takes if the other set has none in its column.
const PLACE: f64 = 6.0;
/// Nanoseconds to test one candidate: between what 16 lanes take and what 4 do.
pub const CANDIDATE: f64 = 0.25;
/// Nanoseconds to begin and end a column.
const COLUMN: f64 = 250.0;

/// How many boxes, and how large they are on average.
#[derive(Clone, Copy)]
pub struct Shape<const D: usize> {
    pub count: f64,
    pub mean: [f64; D],
}

impl<const D: usize> Shape<D> {
    /// All boxes of a set.
    pub fn new(sample: &Sample<D>, field: &Field<D>) -> Self {
        Self::of(sample, field, |_| true)
    }

    /// The boxes up to a size on an axis, and those above.
    pub fn split(sample: &Sample<D>, field: &Field<D>, axis: usize, size: f64) -> [Self; 2] {
        [
            Self::of(sample, field, |i| field.size(sample, axis, i) <= size),
            Self::of(sample, field, |i| field.size(sample, axis, i) > size),
        ]
    }

    fn of(sample: &Sample<D>, field: &Field<D>, belongs: impl Fn(usize) -> bool) -> Self {
        let (mut len, mut sum) = (0.0, [0.0; D]);
        for i in (0..sample.len).filter(|&i| belongs(i)) {
            len += 1.0;
            for (axis, sum) in sum.iter_mut().enumerate() {
                *sum += field.size(sample, axis, i) / SAMPLE as f64;
            }
        }
        let scale = if len > 0.0 { SAMPLE as f64 / len } else { 0.0 };
        Self { count: sample.count * len / sample.len as f64, mean: sum.map(|sum| sum * scale) }
    }

    /// How many records the boxes become.
    pub fn records(&self, field: &Field<D>, cut: &Cut<D>) -> f64 {
        let mut records = self.count;
        for axis in 0..D {
            if cut.columns[axis] > 1.0 {
                records *= 1.0 + self.mean[axis] / field.extent(axis) * cut.columns[axis];
            }
        }
        records
    }
}

/// A sweep axis, columns on the other axes, slabs on the sweep axis.
#[derive(Clone, Copy)]
pub struct Cut<const D: usize> {
    pub sweep: usize,
    pub columns: [f64; D],
}

impl<const D: usize> Cut<D> {
    /// One column.
    pub fn uncut(sweep: usize) -> Self {
        Self { sweep, columns: [1.0; D] }
    }

    /// How many columns there are.
    pub fn len(&self) -> f64 {
        self.columns.iter().product()
    }
}

/// The nanoseconds that a search of one set, or of two, is expected to take with a cut.
pub fn cost<const D: usize>(field: &Field<D>, shapes: &[Shape<D>], cut: &Cut<D>) -> f64 {
    let columns: f64 = cut.len();
    // The chance that two boxes are in the same column.
    let mut together = 1.0;
    for axis in (0..D).filter(|&axis| cut.columns[axis] > 1.0) {
        together *= field.together(axis, cut.columns[axis]);
    }
    let mut records = 0.0;
    let mut candidates = together;
    let mut chance = field.ties[cut.sweep];
    for shape in shapes {
        let count = shape.records(field, cut);
        records += count;
        candidates *= count;
        if shapes.len() == 1 {
            candidates *= count;
        }
        chance += if field.spread[cut.sweep] > 0.0 {
            lesser(shape.mean[cut.sweep] / field.spread[cut.sweep], 1.0)
        } else {
            1.0
        };
    }
    let pairs = candidates * lesser(chance, 1.0);
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
