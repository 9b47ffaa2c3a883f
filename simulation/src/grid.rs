//! Who is near whom: a uniform grid.

use std::array::from_fn;

use sweep_and_prune::Aabb;

/// A uniform grid of points.
#[derive(Debug)]
pub struct Grid<const D: usize> {
    origin: [f32; D],
    /// Cells a unit of length.
    scale: [f32; D],
    /// Cells on each axis.
    cells: [usize; D],
    /// The last point put into each cell, and before each point the one put there earlier.
    heads: Vec<u32>,
    links: Vec<u32>,
}

const NONE: u32 = u32::MAX;

impl<const D: usize> Grid<D> {
    /// Empties the grid, and makes its cells this wide, or wider where they would be more than
    /// about one a point. What lies outside the region belongs to the cells at its rim.
    pub fn reset(&mut self, region: &Aabb<D>, points: usize, width: f32) {
        let most = (1..).find(|k: &usize| k.pow(D as u32) >= points).unwrap_or(1);
        let extent: [f32; D] = from_fn(|axis| region.max[axis] - region.min[axis]);
        self.origin = region.min;
        self.cells = extent.map(|extent| ((extent / width) as usize).clamp(1, most));
        self.scale = from_fn(|axis| self.cells[axis] as f32 / extent[axis]);
        self.heads.clear();
        self.heads.resize(self.cells.iter().product(), NONE);
        self.links.clear();
    }

    /// Puts in the next point, whose index is the number of those before it.
    pub fn insert(&mut self, at: [f32; D]) {
        let cell = self.index(self.cell(at));
        self.links.push(self.heads[cell]);
        self.heads[cell] = (self.links.len() - 1) as u32;
    }

    /// Whether `test` holds for any point in the region, or in a cell that the region touches.
    /// Stops at the first.
    pub fn any_within(&self, region: &Aabb<D>, mut test: impl FnMut(u32) -> bool) -> bool {
        let (first, last) = (self.cell(region.min), self.cell(region.max));
        // Rows of cells that lie side by side along the last axis.
        let mut cell = first;
        loop {
            let row = self.index(cell);
            for &head in &self.heads[row..=row + last[D - 1] - first[D - 1]] {
                let mut next = head;
                while next != NONE {
                    if test(next) {
                        return true;
                    }
                    next = self.links[next as usize];
                }
            }
            // Counts up, the last axis but one fastest.
            let Some(axis) = (0..D - 1).rfind(|&axis| cell[axis] < last[axis]) else {
                return false;
            };
            cell[axis] += 1;
            cell[axis + 1..].copy_from_slice(&first[axis + 1..]);
        }
    }

    #[inline]
    fn index(&self, cell: [usize; D]) -> usize {
        (0..D).fold(0, |index, axis| index * self.cells[axis] + cell[axis])
    }

    /// Monotone in every coordinate, whatever rounds: so no point escapes the search of a region
    /// that holds it.
    #[inline]
    fn cell(&self, at: [f32; D]) -> [usize; D] {
        from_fn(|axis| {
            let cell = (at[axis] - self.origin[axis]) * self.scale[axis];
            (cell as usize).min(self.cells[axis] - 1)
        })
    }
}

impl<const D: usize> Default for Grid<D> {
    fn default() -> Self {
        let (origin, scale) = ([0.0; D], [0.0; D]);
        Self { origin, scale, cells: [1; D], heads: vec![NONE], links: Vec::new() }
    }
}
