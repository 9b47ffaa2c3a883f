//! The cells by which to tell which of many boxes lie near one of a few.

use super::cost::{Cut, Shape};
use super::distribution::Distribution;
use super::grid;
use super::sample::{AXES, Sample, scale};
use crate::float::{greater, lesser, whole};
use crate::pairs::grid::Grid;
use crate::{Aabb, Scalar};

/// How many boxes are drawn from each set.
const SAMPLED: usize = 64;
/// The most cells, on one axis, on two and on three.
const MOST_CELLS: [f64; AXES] = [MOST_NEAR_CELLS as f64, 362.0, 50.0];
/// The most cells in all.
pub const MOST_NEAR_CELLS: usize = 1 << 17;
/// Of the many boxes one of this many is larger than the cells in reach.
const LARGER_ONE_IN: usize = 4;
/// How many cells on the others reach, if there are not too many cells. (With one, twice as many boxes are kept where they
/// touch several others.)
const MOST_REACH: f64 = 2.0;

/// A grid, and how many cells on most of the many boxes reach on each of its axes. `None` if the few boxes seem to be near more
/// than half of the cells.
pub fn near_cells<const D: usize, T: Scalar>(
    few: &[Aabb<D, T>],
    many: &[Aabb<D, T>],
) -> Option<(Grid<T>, [u32; AXES])> {
    let [mut of_few, mut of_many] = [Sample::empty(D), Sample::empty(D)];
    of_few.draw_some(few, SAMPLED);
    of_many.draw_some(many, SAMPLED);
    near_cells_of(&mut of_few, &mut of_many)
}

#[inline(never)]
fn near_cells_of<T: Scalar>(few: &mut Sample, many: &mut Sample) -> Option<(Grid<T>, [u32; AXES])> {
    let unit: T = scale(&mut [few, many]);
    let distribution = Distribution::new(&[few, many]);
    let (cut, reach) = cut(few, many, &distribution)?;
    let grid = grid(&cut, &distribution, unit);
    Some((grid, grid.axes().map(|axis| reach[axis])))
}

#[inline(never)]
fn cut(few: &Sample, many: &Sample, distribution: &Distribution) -> Option<(Cut, [u32; AXES])> {
    let few = Shape::new(few, distribution);
    let (mut cut, mut reach) = (Cut::uncut(0), [1; AXES]);
    let mut near = few.count;
    for (axis, reach) in reach.iter_mut().enumerate().take(distribution.dimensions) {
        let extent = distribution.extent(axis);
        let size = many.sorted_sizes(axis)[many.len - 1 - many.len / LARGER_ONE_IN];
        if extent > 0.0 {
            let cells = lesser(MOST_REACH * extent / size, MOST_CELLS[distribution.dimensions - 1]);
            cut.columns[axis] = greater(whole(cells), 1.0);
        }
        let cells = cut.columns[axis];
        *reach += u32::from(size * cells > extent);
        near *= lesser(1.0 + f64::from(*reach) + few.mean[axis] / extent * cells, cells);
    }
    (near < 0.5 * cut.len()).then_some((cut, reach))
}
