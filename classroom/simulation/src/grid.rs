//! A uniform grid: which cells a box touches. The caller keeps what is in the cells.

use std::array::from_fn;
use std::cmp::Ordering;
use std::ops::Range;

use sweep_and_prune::Aabb;

/// Numbered cells of one size. What lies outside the region belongs to the cells at its border.
#[derive(Debug)]
pub struct Grid<const D: usize> {
    origin: [f32; D],
    /// Cells a unit of length.
    scale: [f32; D],
    /// Cells on each axis.
    cells: [usize; D],
}

impl<const D: usize> Grid<D> {
    /// Cells this wide on each axis, or wider where they would be more than about one a point.
    pub fn new(region: &Aabb<D>, points: usize, widths: [f32; D]) -> Self {
        let most = (1..).find(|k: &usize| k.pow(D as u32) >= points).unwrap_or(1);
        let extent: [f32; D] = from_fn(|axis| region.max[axis] - region.min[axis]);
        let cells = from_fn(|axis| ((extent[axis] / widths[axis]) as usize).clamp(1, most));
        let scale = from_fn(|axis| cells[axis] as f32 / extent[axis]);
        Self { origin: region.min, scale, cells }
    }

    /// How many cells there are.
    pub fn len(&self) -> usize {
        self.cells.iter().product()
    }

    /// The cell of a point.
    pub fn cell(&self, at: [f32; D]) -> usize {
        self.index(self.place(at))
    }

    /// Whether `test` holds for any row of cells that the region touches: cells side by side along
    /// the last axis, whose numbers follow each other. Stops at the first.
    pub fn any_row(&self, region: &Aabb<D>, mut test: impl FnMut(Range<usize>) -> bool) -> bool {
        let (first, last) = (self.place(region.min), self.place(region.max));
        let mut place = first;
        loop {
            let row = self.index(place);
            if test(row..row + last[D - 1] - first[D - 1] + 1) {
                return true;
            }
            // Counts up, the last axis but one fastest.
            let Some(axis) = (0..D - 1).rfind(|&axis| place[axis] < last[axis]) else {
                return false;
            };
            // Each coordinate by itself: in WebAssembly a call that copies takes longer than a row.
            place = from_fn(|i| match i.cmp(&axis) {
                Ordering::Less => place[i],
                Ordering::Equal => place[i] + 1,
                Ordering::Greater => first[i],
            });
        }
    }

    #[inline]
    fn index(&self, place: [usize; D]) -> usize {
        (0..D).fold(0, |index, axis| index * self.cells[axis] + place[axis])
    }

    /// Monotone in every coordinate, whatever is rounded. So the search of a region finds every point in it.
    #[inline]
    fn place(&self, at: [f32; D]) -> [usize; D] {
        from_fn(|axis| {
            let place = (at[axis] - self.origin[axis]) * self.scale[axis];
            (place as usize).min(self.cells[axis] - 1)
        })
    }
}

impl<const D: usize> Default for Grid<D> {
    fn default() -> Self {
        Self { origin: [0.0; D], scale: [0.0; D], cells: [1; D] }
    }
}
