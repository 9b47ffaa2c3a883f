//! The plan of a search: the sweep axis and the number of columns on the other axes, from a sample of
//! the boxes and a model of the cost.
//!
//! ```text
//! draw a sample
//! if there are few boxes, and by their overlaps in the sample no cut pays
//!     sweep them at once, on the axis on which the fewest overlap
//! estimate the distribution of the sample
//! for each sweep axis
//!     cut the other axes finer, the axis first whose columns save most, until the cost no longer falls
//! take the cheapest cut
//! if it is dear, or a glance at the sample contradicts the model
//!     compare the boxes of the sample with each other; choose again with these bounds
//!     try to split the boxes by size
//! ```
//!
//! # The constants
//!
//! The order of the pairs follows from the plan, so no constant depends on the machine. All were chosen on the scenes of
//! the benchmark, 1,000 to 1,000,000 boxes, on one core of an AMD EPYC (Zen 5). The comments beside them have the figures.
//!
//! | constant | what it trades |
//! |---|---|
//! | `MOST_SAMPLED`, `SAMPLED_ONE_IN`, `LEAST_SAMPLED` | a sharper picture of the boxes for time to draw and sort it |
//! | `RESOLUTIONS`, `LEAST_SURE_CHANCE` | seeing small clusters for mistaking noise for clusters |
//! | `RECORD_NS`, `PLACE_NS`, `UNPLACED_NS`, `PLAN_NS`, `TEST_NS`, `COLUMN_NS` | the model: fewer tests in narrow columns for more copies and columns |
//! | `CHEAPER_COST_SHARE` | a slightly cheaper plan for one that stays the same from call to call |
//! | `DEAR_COST_RATIO`, `MIN_BOXES_TO_GLANCE` | a closer look, and splits by size, for the time to plan |
//! | `GLANCED_BOXES`, `GLANCE_OVERLAP_RATIO`, `GLANCE_OVERLAP_MARGIN` | noticing that the model is wrong for needless closer looks |
//! | `MOST_COMPARED`, `OVERLAP_TOLERANCE`, `OVERLAPS_BY_CHANCE` | trust in the model for trust in the overlaps of the sample |
//! | `SPLIT_COST_SHARE` | three searches instead of one for columns that suit each size |
//! | `MOST_NEAR_CELLS`, `LARGER_ONE_IN`, `MOST_REACH` | leaving out more of many boxes against few for a larger bitmap |
//! | `MOST_COLUMNS_PER_BOX`, `MOST_COLUMNS`, `MOST_CELLS_PER_AXIS` | a limit on what the model leaves out: empty columns |
//! | `RECORDS_PER_SLAB` | more slabs for columns that fit the second-level cache |
//! | `LEAST_UNCUT_TO_SLAB` | slabs that fit this cache, and that threads share, for no copies |

mod choose;
mod cost;
mod distribution;
mod near;
mod overlaps;
mod sample;

pub(super) use choose::{Among, SizeSplit};
use choose::{Choice, cheapest, sweep_of_few};
use cost::Cut;
pub(super) use cost::TEST_NS;
use distribution::Distribution;
pub(super) use near::{MOST_NEAR_CELLS, near_cells};
use sample::{AXES, Sample, scale};

use super::grid::{Cells, Grid};
use super::source::Source;
use crate::Scalar;
use crate::float::lesser;

/// The most cells on an axis.
const MOST_CELLS_PER_AXIS: f64 = 65535.0;

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
    let mut first = Sample::empty(D);
    first.draw(sets[0]);
    let Some(&set) = sets.get(1) else { return plan_of::<T>(&mut [&mut first], among) };
    let mut second = Sample::empty(D);
    second.draw(set);
    plan_of::<T>(&mut [&mut first, &mut second], among)
}

/// The plan of the sets from which these samples were drawn.
#[inline(never)]
fn plan_of<T: Scalar>(samples: &mut [&mut Sample], among: Among) -> (Plan<T>, f64) {
    let unit: T = scale(samples);
    let samples: &[&Sample] = match samples {
        [first, second] => &[first, second],
        _ => &[samples[0]],
    };
    if let Some((axis, cost)) = sweep_of_few(samples, among) {
        let cells: [_; AXES] = core::array::from_fn(Cells::one);
        return (Plan::Cut(Grid::new(axis, &cells[..samples[0].dimensions])), cost);
    }
    let distribution = Distribution::new(samples);
    let (choice, cost) = cheapest(&distribution, samples, among);
    let plan = match choice {
        Choice::Cut(cut) => Plan::Cut(grid(&cut, &distribution, unit)),
        Choice::SplitBySize(split) => {
            Plan::SplitBySize(SizeSplit { size: split.size / unit.to_f64(), ..split })
        }
    };
    (plan, cost)
}

fn grid<T: Scalar>(cut: &Cut, distribution: &Distribution, unit: T) -> Grid<T> {
    let cells: [_; AXES] = core::array::from_fn(|axis| {
        if cut.columns[axis] > 1.0 {
            let count = lesser(cut.columns[axis], MOST_CELLS_PER_AXIS);
            Cells::new(axis, unit, distribution.low[axis], distribution.high[axis], count as u32)
        } else {
            Cells::one(axis)
        }
    });
    Grid::new(cut.sweep, &cells[..distribution.dimensions])
}

#[cfg(test)]
mod tests;
