//! Stage 1: bins. Space is cut into columns (and long ones into slabs), and each box is copied to
//! every bin that it touches: count, prefix sum, scatter.

use alloc::vec::Vec;
use core::ops::Range;

use crate::{Aabb, Scalar};

/// A box on its way: where it came from, and how its pairs are reported once.
///
/// A pair may meet in several bins. It is reported by the one that holds the lower corner of
/// the two boxes' intersection, that is, where on each cut axis at least one of the two begins.
/// So bit `axis` of `marks` says that the box began in an earlier cell on that axis, and a pair
/// whose marks share a bit is left to that bin.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Record<const D: usize, T> {
    pub aabb: Aabb<D, T>,
    pub id: u32,
    pub marks: u32,
}

/// Boxes to be found pairs among: the caller's, or those of a column that is cut again.
pub(super) trait Source<const D: usize, T>: Copy + Sync {
    fn len(&self) -> usize;
    fn record(&self, i: usize) -> Record<D, T>;
}

impl<const D: usize, T: Scalar> Source<D, T> for &[Aabb<D, T>] {
    #[inline(always)]
    fn len(&self) -> usize {
        (**self).len()
    }

    #[inline(always)]
    fn record(&self, i: usize) -> Record<D, T> {
        Record { aabb: self[i], id: i as u32, marks: 0 }
    }
}

impl<const D: usize, T: Scalar> Source<D, T> for &[Record<D, T>] {
    #[inline(always)]
    fn len(&self) -> usize {
        (**self).len()
    }

    #[inline(always)]
    fn record(&self, i: usize) -> Record<D, T> {
        self[i]
    }
}

/// Equal cells on one axis; the outermost reach to infinity.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cells<T> {
    axis: usize,
    origin: T,
    scale: T,
    last: T,
    count: u32,
}

impl<T: Scalar> Cells<T> {
    /// One cell, all of the axis.
    pub fn one(axis: usize) -> Self {
        Cells { axis, origin: T::ZERO, scale: T::ZERO, last: T::ZERO, count: 1 }
    }

    /// `count` cells, less than 2^22, over `low ..= high`.
    pub fn new(axis: usize, low: f64, high: f64, count: u32) -> Self {
        let scale = f64::from(count) / (high - low);
        Cells {
            axis,
            // `cell` rounds to the nearest, so the first begins half a cell below its middle.
            origin: T::from_f64(low + 0.5 / scale),
            scale: T::from_f64(scale),
            last: T::from_f64(f64::from(count - 1)),
            count,
        }
    }

    /// The cells that a box touches, from and to. A NaN counts as the first.
    #[inline(always)]
    fn of<const D: usize>(&self, aabb: &Aabb<D, T>) -> (usize, usize) {
        if self.count == 1 {
            return (0, 0);
        }
        let cell = |at: T| at.cell(self.origin, self.scale, self.last) as usize;
        (cell(aabb.min[self.axis]), cell(aabb.max[self.axis]))
    }
}

/// How space is cut: into columns on the axes that are not swept, and if those are long, on the
/// sweep axis into slabs, for the sake of the caches and of threads.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid<T> {
    pub sweep: usize,
    /// The axes in turn, the first varying slowest: at first those that do not exist, of one cell,
    /// at last the sweep axis.
    cells: [Cells<T>; 3],
}

impl<T: Scalar> Grid<T> {
    /// A grid with these cells on each axis.
    pub fn new<const D: usize>(sweep: usize, cells: [Cells<T>; D]) -> Self {
        let mut grid = Self { sweep, cells: [cells[sweep]; 3] };
        let mut others = (0..D).filter(|&axis| axis != sweep);
        grid.cells[1] = others.next().map_or(Cells::one(0), |axis| cells[axis]);
        grid.cells[0] = others.next().map_or(Cells::one(0), |axis| cells[axis]);
        grid
    }

    /// One cell.
    pub fn uncut(sweep: usize) -> Self {
        Self { sweep, cells: [Cells::one(0), Cells::one(0), Cells::one(sweep)] }
    }

    /// The axes that are cut, and how wide their cells are.
    pub fn widths(&self) -> impl Iterator<Item = (usize, f64)> {
        let cut = self.cells.into_iter().filter(|cells| cells.count > 1);
        cut.map(|cells| (cells.axis, 1.0 / cells.scale.to_f64()))
    }

    /// How many bins there are.
    pub fn len(&self) -> usize {
        self.cells.iter().map(|cells| cells.count as usize).product()
    }

    /// Calls `each(bin, marks)` for every bin that a box touches, in ascending order.
    #[inline(always)]
    fn for_each_bin<const D: usize>(&self, aabb: &Aabb<D, T>, mut each: impl FnMut(usize, u32)) {
        let [x, y, z] = &self.cells;
        // Which of the axes exist is known to the compiler.
        let (x0, x1) = if D > 2 { x.of(aabb) } else { (0, 0) };
        let (y0, y1) = if D > 1 { y.of(aabb) } else { (0, 0) };
        let (z0, z1) = z.of(aabb);
        let bin = |i: usize, j: usize, k: usize| (i * y.count as usize + j) * z.count as usize + k;
        if x0 == x1 && y0 == y1 && z0 == z1 {
            return each(bin(x0, y0, z0), 0);
        }
        for i in x0..=x1 {
            let mark = u32::from(i > x0) << x.axis;
            for j in y0..=y1 {
                let mark = mark | u32::from(j > y0) << y.axis;
                for k in z0..=z1 {
                    each(bin(i, j, k), mark | u32::from(k > z0) << z.axis);
                }
            }
        }
    }
}

/// Records by bin. Within a bin they stand in the order of the source.
#[derive(Debug)]
pub(super) struct Bins<const D: usize, T> {
    records: Vec<Record<D, T>>,
    /// Where each bin ends.
    ends: Vec<u32>,
}

impl<const D: usize, T: Scalar> Bins<D, T> {
    pub const fn new() -> Self {
        Self { records: Vec::new(), ends: Vec::new() }
    }

    /// Counts the records that these boxes of the source become, bin by bin. Returns their sum, or
    /// none if a box is inverted or NaN.
    pub fn count<S: Source<D, T>>(
        &mut self,
        source: S,
        boxes: Range<usize>,
        grid: &Grid<T>,
    ) -> Option<u64> {
        self.ends.clear();
        self.ends.resize(grid.len(), 0);
        let mut valid = true;
        for i in boxes {
            let aabb = source.record(i).aabb;
            valid &= (0..D).fold(true, |valid, axis| valid & (aabb.min[axis] <= aabb.max[axis]));
            grid.for_each_bin(&aabb, |bin, _| self.ends[bin] += 1);
        }
        valid.then(|| self.ends.iter().map(|&count| u64::from(count)).sum())
    }

    /// Copies the boxes that were counted to their bins. There must be less than 2^32 records.
    pub fn scatter<S: Source<D, T>>(&mut self, source: S, boxes: Range<usize>, grid: &Grid<T>) {
        // From counts to where each bin begins; the copying moves that to where it ends.
        let mut total = 0;
        for end in &mut self.ends {
            total += core::mem::replace(end, total);
        }
        if self.records.len() < total as usize {
            let aabb = Aabb::new([T::ZERO; D], [T::ZERO; D]);
            let size = total as usize + total as usize / 16;
            self.records.resize(size, Record { aabb, id: 0, marks: 0 });
        }
        for i in boxes {
            let record = source.record(i);
            grid.for_each_bin(&record.aabb, |bin, marks| {
                let at = self.ends[bin];
                self.ends[bin] = at + 1;
                self.records[at as usize] = Record { marks: record.marks | marks, ..record };
            });
        }
    }

    /// How many records there are.
    pub fn len(&self) -> usize {
        self.ends.last().map_or(0, |&end| end as usize)
    }

    /// The records of a bin.
    pub fn bin(&self, bin: usize) -> &[Record<D, T>] {
        let start = if bin == 0 { 0 } else { self.ends[bin - 1] };
        &self.records[start as usize..self.ends[bin] as usize]
    }
}

/// Why bins were not filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Refusal {
    /// A box is inverted or NaN.
    Invalid,
    /// There would be more copies than allowed.
    TooMany,
}
