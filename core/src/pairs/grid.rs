//! How space is cut: columns and slabs, and between which of them a box lies.

use super::kernel::Copied;
use super::numbers::{BLOCK, Ruler};
use crate::{Aabb, Scalar};

/// Equal cells on one axis; the outermost reach to infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cells<T> {
    axis: usize,
    ruler: Ruler<T>,
    count: u32,
}

impl<T: Scalar> Cells<T> {
    /// One cell, all of the axis.
    pub fn one(axis: usize) -> Self {
        let zero = T::ZERO;
        Cells { axis, ruler: Ruler { unit: zero, origin: zero, scale: zero, last: zero }, count: 1 }
    }

    /// `count` cells, less than 2^22, over `low ..= high`, which are coordinates times the unit.
    pub fn new(axis: usize, unit: T, low: f64, high: f64, count: u32) -> Self {
        let scale = f64::from(count) / (high - low);
        let ruler = Ruler {
            unit,
            // The first cell begins half a cell below its middle.
            origin: T::from_f64(low + 0.5 / scale),
            scale: T::from_f64(scale),
            last: T::from_f64(f64::from(count - 1)),
        };
        Cells { axis, ruler, count }
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
        cut.map(|cells| (cells.axis, 1.0 / cells.ruler.scale.to_f64() / cells.ruler.unit.to_f64()))
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

/// A block of boxes in the grid: for each box the bin of its lower corner, and how many more cells
/// it touches on each axis; none on one that is not cut.
pub(super) struct Places<T> {
    pub bin: [u32; BLOCK],
    pub more: [[u32; BLOCK]; 3],
    /// The edges of the boxes on one axis.
    low: [T; BLOCK],
    high: [T; BLOCK],
}

impl<T: Scalar> Places<T> {
    pub const fn new() -> Self {
        let edges = [T::ZERO; BLOCK];
        Self { bin: [0; BLOCK], more: [[0; BLOCK]; 3], low: edges, high: edges }
    }

    /// Places up to [`BLOCK`] boxes. False if one is inverted or NaN, now or before.
    #[inline(always)]
    pub fn fill<'a, const D: usize>(
        &mut self,
        boxes: impl Iterator<Item = &'a Aabb<D, T>> + Clone,
        grid: &Grid<T>,
    ) -> bool {
        let mut valid = true;
        self.bin.fill(0);
        let steps = grid.steps();
        for (k, Cells { axis, ruler, count }) in grid.cells.iter().enumerate().skip(3 - D) {
            let edges = boxes.clone().map(|aabb| (aabb.min[*axis], aabb.max[*axis]));
            if *count == 1 {
                valid &= edges.fold(true, |valid, (min, max)| valid & (min <= max));
                continue;
            }
            for ((low, high), edges) in self.low.iter_mut().zip(&mut self.high).zip(edges) {
                (*low, *high) = edges;
            }
            let edges = [&self.low, &self.high];
            valid &= T::spans(edges, ruler, steps[k], &mut self.bin, &mut self.more[k]);
        }
        valid
    }
}
