//! Stage 1: bins. Space is cut into columns (and long ones into slabs), and each box is copied to
//! every bin that it touches: count, prefix sum, scatter.

use alloc::collections::TryReserveError;
use alloc::vec::Vec;
use core::ops::Range;

use super::kernel::prefetch;
use super::memory::{grow, grow_to};
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

/// Boxes to find pairs of: the caller's, or those of a bin that is cut again.
pub(super) trait Source<const D: usize, T>: Copy + Sync {
    fn len(&self) -> usize;
    fn aabb(&self, i: usize) -> &Aabb<D, T>;
    fn id(&self, i: usize) -> u32;
    fn marks(&self, i: usize) -> u32;

    /// Some of the boxes, one after the other.
    fn aabbs(&self, boxes: Range<usize>) -> impl Iterator<Item = &Aabb<D, T>> + Clone
    where
        T: 'static;

    #[inline(always)]
    fn record(&self, i: usize) -> Record<D, T>
    where
        T: Copy,
    {
        Record { aabb: *self.aabb(i), id: self.id(i), marks: self.marks(i) }
    }
}

impl<const D: usize, T: Scalar> Source<D, T> for &[Aabb<D, T>] {
    #[inline(always)]
    fn len(&self) -> usize {
        (**self).len()
    }

    #[inline(always)]
    fn aabb(&self, i: usize) -> &Aabb<D, T> {
        &self[i]
    }

    #[inline(always)]
    fn id(&self, i: usize) -> u32 {
        i as u32
    }

    #[inline(always)]
    fn marks(&self, _: usize) -> u32 {
        0
    }

    #[inline(always)]
    fn aabbs(&self, boxes: Range<usize>) -> impl Iterator<Item = &Aabb<D, T>> + Clone {
        self[boxes].iter()
    }
}

impl<const D: usize, T: Scalar> Source<D, T> for &[Record<D, T>] {
    #[inline(always)]
    fn len(&self) -> usize {
        (**self).len()
    }

    #[inline(always)]
    fn aabb(&self, i: usize) -> &Aabb<D, T> {
        &self[i].aabb
    }

    #[inline(always)]
    fn id(&self, i: usize) -> u32 {
        self[i].id
    }

    #[inline(always)]
    fn marks(&self, i: usize) -> u32 {
        self[i].marks
    }

    #[inline(always)]
    fn aabbs(&self, boxes: Range<usize>) -> impl Iterator<Item = &Aabb<D, T>> + Clone {
        self[boxes].iter().map(|record| &record.aabb)
    }
}

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
    fn bin(&self, [x, y, z]: [u32; 3]) -> u32 {
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

    /// The mark of each axis, in the place where [`Copied`] holds it.
    fn marks(&self) -> [u32; 3] {
        self.cells.map(|cells| 1 << BIN_BITS << cells.axis)
    }
}

/// Boxes that are placed at a time: cell by cell the same is done to each, so that the compiler
/// makes vectors of them.
const BLOCK: usize = 64;

/// For each axis of a grid and each box of a block, the first cell that it touches, and how many
/// more. On an axis that is not cut they stay 0.
struct Places {
    first: [[u32; BLOCK]; 3],
    more: [[u32; BLOCK]; 3],
}

impl Places {
    /// Places up to [`BLOCK`] boxes. False if one is inverted or NaN.
    #[inline(always)]
    fn fill<'a, const D: usize, T: Scalar>(
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

/// One copy of a box to a bin.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Copied {
    /// The bin, and above it the marks that the copy adds.
    bin: u32,
    /// The box's position in the source.
    pub of: u32,
}

/// Bytes of records that the second cache may hold,
const LARGE: usize = 1 << 20;
/// and how far ahead they are asked for, if they are more.
const LINES: usize = 128;

/// Bits of [`Copied::bin`] that are the bin.
const BIN_BITS: u32 = 29;

impl Copied {
    #[inline(always)]
    fn bin(self) -> usize {
        (self.bin & ((1 << BIN_BITS) - 1)) as usize
    }

    #[inline(always)]
    pub fn marks(self) -> u32 {
        self.bin >> BIN_BITS
    }
}

/// Records by bin. Within a bin they stand in the order of the source.
#[derive(Debug)]
pub(super) struct Bins<const D: usize, T> {
    records: Vec<Record<D, T>>,
    /// Box by box, what goes where; the rest of the array is scratch.
    copies: Vec<Copied>,
    len: usize,
    /// Boxes that were listed, and bins that they are listed for.
    boxes: usize,
    bins: usize,
    /// Where each bin ends.
    ends: Vec<u32>,
}

impl<const D: usize, T: Scalar> Bins<D, T> {
    pub const fn new() -> Self {
        Self {
            records: Vec::new(),
            copies: Vec::new(),
            len: 0,
            boxes: 0,
            bins: 0,
            ends: Vec::new(),
        }
    }

    /// Lists the copies that these boxes of the source become, and returns how many.
    ///
    /// # Errors
    /// A [`Refusal`]; of more than `limit` copies as soon as there are.
    pub fn list<S: Source<D, T>>(
        &mut self,
        source: S,
        boxes: Range<usize>,
        grid: &Grid<T>,
        limit: u64,
    ) -> Result<u64, Refusal> {
        (self.bins, self.boxes) = (grid.len(), boxes.len());
        let [_, y, z] = &grid.cells;
        let (above, beside) = (y.count * z.count, z.count);
        let [above_mark, beside_mark, _] = grid.marks();
        let mut places = Places { first: [[0; BLOCK]; 3], more: [[0; BLOCK]; 3] };
        let mut valid = true;
        let mut len = 0;
        for start in boxes.clone().step_by(BLOCK) {
            let block = start..boxes.end.min(start + BLOCK);
            valid &= places.fill(source.aabbs(block.clone()), grid);
            for (at, of) in block.enumerate() {
                if len + 4 > self.copies.len() {
                    let room = 2 * self.copies.len() + 1024;
                    grow_to(&mut self.copies, room, Copied::default())?;
                }
                let first = places.first.each_ref().map(|first| first[at]);
                let more = places.more.each_ref().map(|more| more[at]);
                let bin = grid.bin(first);
                let of = of as u32;
                if more[0] <= 1 && more[1] <= 1 && more[2] == 0 {
                    // Nearly always. How many copies there are cannot be foretold, and a branch
                    // would cost more than writing all four; those that are none are overwritten
                    // by the next.
                    let to = &mut self.copies[len..len + 4];
                    let row = 1 + more[1] as usize;
                    to[0] = Copied { bin, of };
                    if D > 1 {
                        to[1] = Copied { bin: bin + beside + beside_mark, of };
                    }
                    if D > 2 {
                        let marks = above_mark + beside_mark;
                        to[row] = Copied { bin: bin + above + above_mark, of };
                        to[row + 1] = Copied { bin: bin + above + beside + marks, of };
                    }
                    len += row << more[0];
                } else {
                    len = self.list_many(len, of, bin, more, grid, limit)?;
                }
            }
        }
        self.len = len;
        match (valid, len as u64 <= limit) {
            (true, true) => Ok(len as u64),
            (true, false) => Err(Refusal::TooMany),
            (false, _) => Err(Refusal::Invalid),
        }
    }

    /// Lists the copies of a box that touches any number of bins, from position `len` on. Returns
    /// the position behind them.
    #[cold]
    fn list_many(
        &mut self,
        mut len: usize,
        of: u32,
        bin: u32,
        more: [u32; 3],
        grid: &Grid<T>,
        limit: u64,
    ) -> Result<usize, Refusal> {
        let marks = grid.marks();
        let mark = |axis: usize, at: u32| if at > 0 { marks[axis] } else { 0 };
        for i in 0..=more[0] {
            for j in 0..=more[1] {
                if len as u64 > limit {
                    return Err(Refusal::TooMany);
                }
                let end = len + more[2] as usize + 1;
                if end > self.copies.len() {
                    grow_to(&mut self.copies, 2 * end, Copied::default())?;
                }
                let first = bin + grid.bin([i, j, 0]);
                for (k, to) in (0..).zip(&mut self.copies[len..end]) {
                    *to = Copied { bin: first + k + mark(0, i) + mark(1, j) + mark(2, k), of };
                }
                len = end;
            }
        }
        Ok(len)
    }

    /// Drops the copies that were listed for bins in which another set, already scattered, has none:
    /// there are no pairs.
    pub fn keep_shared(&mut self, other: &Self) {
        let mut len = 0;
        for index in 0..self.len {
            let copy = self.copies[index];
            self.copies[len] = copy;
            len += usize::from(!other.bin(copy.bin()).is_empty());
        }
        self.len = len;
    }

    /// Puts the copies that were listed into the order of the bins, then of the boxes, instead of
    /// their records, with the boxes' own indices, and notes where those of each bin begin, and at last where they end.
    ///
    /// # Errors
    /// [`Refusal::Memory`].
    pub fn by_bin<S: Source<D, T>>(
        &self,
        source: S,
        copies: &mut Vec<Copied>,
        starts: &mut Vec<u32>,
    ) -> Result<(), TryReserveError> {
        grow(copies, self.len, Copied::default())?;
        grow(starts, self.bins + 2, 0)?;
        // Shifted by two, and then by one, so that the copying moves each start to where it belongs.
        let starts = &mut starts[..self.bins + 2];
        starts.fill(0);
        for copy in &self.copies[..self.len] {
            starts[copy.bin() + 2] += 1;
        }
        let mut total = 0;
        for start in &mut starts[2..] {
            total += *start;
            *start = total;
        }
        for &copy in &self.copies[..self.len] {
            let start = &mut starts[copy.bin() + 1];
            copies[*start as usize] = Copied { of: source.id(copy.of as usize), ..copy };
            *start += 1;
        }
        Ok(())
    }

    /// Copies the boxes to their bins as listed. There must be less than 2^32 copies.
    ///
    /// # Errors
    /// [`Refusal::Memory`].
    pub fn scatter<S: Source<D, T>>(&mut self, source: S) -> Result<(), Refusal> {
        grow(&mut self.ends, self.bins, 0)?;
        self.ends[..self.bins].fill(0);
        for copy in &self.copies[..self.len] {
            self.ends[copy.bin()] += 1;
        }
        // From counts to where each bin begins; the copying moves that to where it ends.
        let mut total = 0;
        for end in &mut self.ends[..self.bins] {
            total += core::mem::replace(end, total);
        }
        if self.records.len() < self.len {
            let aabb = Aabb::new([T::ZERO; D], [T::ZERO; D]);
            // Plans for boxes that move differ by that much.
            let room = self.len + self.len / 4;
            grow_to(&mut self.records, room, Record { aabb, id: 0, marks: 0 })?;
        }
        // Records of bins that the caches do not hold take their time to come, but are known early.
        let are_many = self.len > LARGE / size_of::<Record<D, T>>();
        for copy in &self.copies[..self.len] {
            let record = source.record(copy.of as usize);
            let end = &mut self.ends[copy.bin()];
            if are_many {
                prefetch(&self.records, *end as usize + LINES / size_of::<Record<D, T>>());
            }
            self.records[*end as usize] = Record { marks: record.marks | copy.marks(), ..record };
            *end += 1;
        }
        Ok(())
    }

    /// How many boxes were listed.
    pub fn boxes(&self) -> usize {
        self.boxes
    }

    /// How many records there are.
    pub fn len(&self) -> usize {
        self.len
    }

    /// The records of a bin.
    pub fn bin(&self, bin: usize) -> &[Record<D, T>] {
        let start = if bin == 0 { 0 } else { self.ends[bin - 1] };
        &self.records[start as usize..self.ends[bin] as usize]
    }
}

/// Why bins were not filled, the gravest reason first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Refusal {
    /// A box is inverted or NaN.
    Invalid,
    /// There is not enough memory.
    Memory,
    /// There would be more copies than allowed.
    TooMany,
}

impl From<TryReserveError> for Refusal {
    fn from(_: TryReserveError) -> Self {
        Refusal::Memory
    }
}
