//! How space is cut: columns and slabs, and between which of them a box lies.

use super::kernel::Copied;
use crate::{Aabb, Scalar};

/// Equal cells on one axis; the outermost reach to infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cells<T> {
    axis: usize,
    /// What coordinates are multiplied by first: see [`Number::unit`](super::numbers::Number::unit).
    unit: T,
    origin: T,
    scale: T,
    last: T,
    count: u32,
}

impl<T: Scalar> Cells<T> {
    /// One cell, all of the axis.
    pub fn one(axis: usize) -> Self {
        Cells { axis, unit: T::ZERO, origin: T::ZERO, scale: T::ZERO, last: T::ZERO, count: 1 }
    }

    /// `count` cells, less than 2^22, over `low ..= high`, which are coordinates times the unit.
    pub fn new(axis: usize, unit: T, low: f64, high: f64, count: u32) -> Self {
        let scale = f64::from(count) / (high - low);
        Cells {
            axis,
            unit,
            // `cell` rounds to the nearest, so the first begins half a cell below its middle.
            origin: T::from_f64(low + 0.5 / scale),
            scale: T::from_f64(scale),
            last: T::from_f64(f64::from(count - 1)),
            count,
        }
    }

    /// The cell of a coordinate. A NaN counts as the first.
    #[inline(always)]
    fn of(&self, at: T) -> u32 {
        (at * self.unit).cell(self.origin, self.scale, self.last)
    }
}

/// How space is cut: into columns on the axes that are not swept, and if those are long, on the
/// sweep axis into slabs, for the sake of the caches and of threads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grid<T> {
    pub sweep: usize,
    /// The axes in turn, the first varying slowest: at first those that do not exist, of one cell,
    /// at last the sweep axis.
    cells: [Cells<T>; 3],
}

impl<T: Scalar> Grid<T> {
    /// Between which bins a box lies: that of its lower corner and that of its upper.
    #[inline(always)]
    pub fn span<const D: usize>(&self, aabb: &Aabb<D, T>) -> [u32; 2] {
        let [x, y, z] = &self.cells;
        // All four in one go: on axes that are not cut, or do not exist, they are 0.
        let ends = [y, x].map(|cells| [aabb.min[cells.axis], aabb.max[cells.axis]]);
        let cells: [u32; 4] = core::array::from_fn(|k| [y, x][k / 2].of(ends[k / 2][k % 2]));
        let along = [aabb.min[z.axis], aabb.max[z.axis]];
        let along = if z.count > 1 { along.map(|at| z.of(at)) } else { [0; 2] };
        [self.bin([cells[2], cells[0], along[0]]), self.bin([cells[3], cells[1], along[1]])]
    }

    /// The bin of a cell.
    #[inline(always)]
    pub fn bin(&self, [x, y, z]: [u32; 3]) -> u32 {
        (x * self.cells[1].count + y) * self.cells[2].count + z
    }

    /// A grid with these cells on each axis.
    pub fn new<const D: usize>(sweep: usize, cells: [Cells<T>; D]) -> Self {
        let mut grid = Self { sweep, cells: [cells[sweep]; 3] };
        let mut others = (0..D).filter(|&axis| axis != sweep);
        grid.cells[1] = others.next().map_or(Cells::one(0), |axis| cells[axis]);
        grid.cells[0] = others.next().map_or(Cells::one(0), |axis| cells[axis]);
        grid
    }

    /// One cell.
    pub fn uncut<const D: usize>(sweep: usize) -> Self {
        Self::new::<D>(sweep, core::array::from_fn(Cells::one))
    }

    /// The axes that are cut, and how wide their cells are.
    pub fn widths(&self) -> impl Iterator<Item = (usize, f64)> {
        let cut = self.cells.into_iter().filter(|cells| cells.count > 1);
        cut.map(|cells| (cells.axis, 1.0 / cells.scale.to_f64() / cells.unit.to_f64()))
    }

    /// How many bins there are.
    pub fn len(&self) -> usize {
        self.cells.iter().map(|cells| cells.count as usize).product()
    }

    /// From a bin to the next on each axis.
    pub fn steps(&self) -> [u32; 3] {
        let [_, y, z] = &self.cells;
        [y.count * z.count, z.count, 1]
    }

    /// The mark of each axis, in the place where [`Copied`] holds it.
    pub fn marks(&self) -> [u32; 3] {
        self.cells.map(|cells| Copied::mark(cells.axis))
    }
}

/// Boxes that are placed at a time: cell by cell the same is done to each, so that the compiler
/// makes vectors of them.
pub(super) const BLOCK: usize = 64;

/// For each axis of a grid and each box of a block, the first cell that it touches, and how many
/// more. On an axis that is not cut they stay 0.
pub(super) struct Places {
    pub first: [[u32; BLOCK]; 3],
    pub more: [[u32; BLOCK]; 3],
}

impl Places {
    pub const fn new() -> Self {
        Self { first: [[0; BLOCK]; 3], more: [[0; BLOCK]; 3] }
    }

    /// Places up to [`BLOCK`] boxes. False if one is inverted or NaN.
    #[inline(always)]
    pub fn fill<'a, const D: usize, T: Scalar>(
        &mut self,
        boxes: impl Iterator<Item = &'a Aabb<D, T>> + Clone,
        grid: &Grid<T>,
    ) -> bool {
        let mut valid = true;
        for ((first, more), cells) in
            self.first.iter_mut().zip(&mut self.more).zip(&grid.cells).skip(3 - D)
        {
            let edges = boxes.clone().map(|aabb| (aabb.min[cells.axis], aabb.max[cells.axis]));
            // For browsers size counts more: then the cells are 0 by the arithmetic below.
            if cells.count == 1 && cfg!(feature = "std") {
                valid &= edges.fold(true, |valid, (min, max)| valid & (min <= max));
                continue;
            }
            for ((first, more), (min, max)) in first.iter_mut().zip(more).zip(edges) {
                valid &= min <= max;
                *first = cells.of(min);
                // An inverted box would touch less than none; it will be refused.
                *more = cells.of(max).saturating_sub(*first);
            }
        }
        valid
    }
}
