//! Who is near whom: a uniform grid.

use sweep_and_prune::Aabb;

/// A uniform grid of centres, its cells no smaller than the largest ball, so that balls which
/// overlap lie in the same cell or in neighbours.
#[derive(Debug)]
pub struct Grid<const D: usize> {
    region: Aabb<D>,
    /// Cells on each axis.
    cells: [usize; D],
    /// The last ball put into each cell, and before each ball the one put there earlier.
    heads: Vec<u32>,
    links: Vec<u32>,
}

const NONE: u32 = u32::MAX;

impl<const D: usize> Grid<D> {
    /// An empty grid for so many balls; it takes more.
    pub fn new(region: Aabb<D>, bodies: u32, greatest_radius: f32) -> Self {
        // No more cells than about one a body.
        let most = (1..).find(|k: &usize| k.pow(D as u32) >= bodies as usize).unwrap_or(1);
        let cells = std::array::from_fn(|axis| {
            let extent = region.max[axis] - region.min[axis];
            ((extent / (2.0 * greatest_radius)) as usize).clamp(1, most)
        });
        Self { region, cells, heads: vec![NONE; cells.iter().product()], links: Vec::new() }
    }

    fn cell(&self, at: [f32; D], axis: usize) -> usize {
        let (min, max) = (self.region.min[axis], self.region.max[axis]);
        let cell = (at[axis] - min) / (max - min) * self.cells[axis] as f32;
        (cell as usize).min(self.cells[axis] - 1)
    }

    /// Puts in the next ball, whose index is the number of those before it.
    pub fn insert(&mut self, centre: [f32; D]) {
        let cell = (0..D).fold(0, |index, axis| index * self.cells[axis] + self.cell(centre, axis));
        self.links.push(self.heads[cell]);
        self.heads[cell] = (self.links.len() - 1) as u32;
    }

    /// Whether `test` holds for any ball in the cell of a centre or in one beside it: all that a
    /// ball there could touch. Stops at the first.
    pub fn any_near(&self, centre: [f32; D], mut test: impl FnMut(u32) -> bool) -> bool {
        // All 3^D neighbours, those beyond the rim left out.
        (0..3usize.pow(D as u32)).any(|neighbour| {
            let (mut index, mut digits) = (0, neighbour);
            for axis in 0..D {
                let cell = self.cell(centre, axis) + digits % 3;
                digits /= 3;
                if cell < 1 || cell > self.cells[axis] {
                    return false;
                }
                index = index * self.cells[axis] + cell - 1;
            }
            let mut next = self.heads[index];
            while next != NONE {
                if test(next) {
                    return true;
                }
                next = self.links[next as usize];
            }
            false
        })
    }
}
