//! The plan of a search: the sweep axis and the number of columns on the other axes, from a sample of
//! the boxes and a model of the cost.

mod choose;
mod cost;
mod field;
mod float;
mod overlaps;
mod sample;

pub(super) use choose::{Among, SizeSplit};
use choose::{Choice, cheapest};
pub(super) use cost::CANDIDATE;
use cost::Cut;
use field::Field;
pub(super) use float::greater;
use float::lesser;
use sample::{Sample, unit};

use super::grid::{Cells, Grid};
use super::source::Source;
use crate::Scalar;

/// The most cells on an axis.
const MOST_CELLS: f64 = 65535.0;

/// What to do with one set of boxes, or with two.
#[derive(Clone, Copy, Debug)]
pub(super) enum Plan<T> {
    /// Cut space into columns (perhaps one) and sweep each.
    Cut(Grid<T>),
    /// Split the boxes of one set by their size, and search the two groups separately.
    SplitBySize(SizeSplit),
}

impl<T: Scalar> Plan<T> {
    /// Whether it does more than to sweep all boxes at once.
    pub fn divides(&self) -> bool {
        !matches!(self, Plan::Cut(grid) if grid.len() == 1)
    }
}

/// A plan for one set (pairs within it) or two (pairs between them), and the nanoseconds that it is
/// expected to take.
pub(super) fn plan<const D: usize, T: Scalar, S: Source<D, T>>(
    sets: &[&[S]],
    among: Among,
) -> (Plan<T>, f64) {
    let unit = unit(sets);
    let mut first = Sample::empty(D);
    first.draw(sets[0], unit);
    let mut second;
    let samples: &[&Sample] = if let Some(&source) = sets.get(1) {
        second = Sample::empty(D);
        second.draw(source, unit);
        &[&first, &second]
    } else {
        &[&first]
    };
    let field = Field::new(samples);
    let (choice, cost) = cheapest(&field, samples, among);
    let plan = match choice {
        Choice::Cut(cut) => Plan::Cut(grid::<D, T>(&cut, &field, unit)),
        Choice::SplitBySize(split) => {
            Plan::SplitBySize(SizeSplit { size: split.size / unit.to_f64(), ..split })
        }
    };
    (plan, cost)
}

fn grid<const D: usize, T: Scalar>(cut: &Cut, field: &Field, unit: T) -> Grid<T> {
    let cells = core::array::from_fn(|axis| {
        if cut.columns[axis] > 1.0 {
            let count = lesser(cut.columns[axis], MOST_CELLS);
            Cells::new(axis, unit, field.low[axis], field.high[axis], count as u32)
        } else {
            Cells::one(axis)
        }
    });
    Grid::new::<D>(cut.sweep, cells)
}

#[cfg(test)]
#[path = "../../../tests/recorded/plans.rs"]
mod tests;
