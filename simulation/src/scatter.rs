//! Balls at random places, none overlapping another.

use sweep_and_prune::Aabb;
use sweep_and_prune_scenes::Random;

use crate::setup::{Ball, SetupError};
use crate::vector::{difference, dot};

/// What to scatter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scatter<const D: usize> {
    /// How many balls.
    pub bodies: u32,
    /// The least and the greatest radius, both positive.
    pub radii: [f32; 2],
    /// Where: every ball lies inside.
    pub region: Aabb<D>,
    /// The greatest speed on each axis.
    pub speed: [f32; D],
    /// The same seed gives the same bits everywhere.
    pub seed: u64,
}

impl<const D: usize> Scatter<D> {
    /// How often a place is drawn for a ball before giving up.
    const TRIES: u32 = 2_000;

    /// The balls, the largest first: random sequential addition (Widom 1966), each at a place
    /// drawn uniformly until it overlaps none before it. It jams when 54.7 % of an area or 38 % of
    /// a volume is covered by equal balls; up to half of that it is fast, O(n).
    ///
    /// Radii have the density r^-2 between their bounds: many small ones, few large ones.
    ///
    /// # Errors
    /// [`SetupError::NoRoom`].
    pub fn balls(&self) -> Result<Vec<Ball<D>>, SetupError> {
        let mut random = Random::new(self.seed);
        let [least, greatest] = self.radii.map(|radius| 1.0 / radius);
        let mut radii: Vec<f32> =
            (0..self.bodies).map(|_| 1.0 / between(&mut random, least, greatest)).collect();
        radii.sort_unstable_by(|a, b| b.total_cmp(a));

        let mut grid = Grid::new(self.region, self.bodies, self.radii[1]);
        let mut balls: Vec<Ball<D>> = Vec::with_capacity(radii.len());
        for radius in radii {
            let centre = (0..Self::TRIES)
                .map(|_| self.draw_place(radius, &mut random))
                .find(|&centre| !grid.is_taken(&balls, centre, radius))
                .ok_or(SetupError::NoRoom { placed: balls.len() })?;
            let velocity = self.speed.map(|speed| between(&mut random, -speed, speed));
            grid.insert(centre);
            balls.push(Ball { centre, radius, velocity });
        }
        Ok(balls)
    }

    fn draw_place(&self, radius: f32, random: &mut Random) -> [f32; D] {
        std::array::from_fn(|axis| {
            let (min, max) = (self.region.min[axis], self.region.max[axis]);
            between(random, min + radius, max - radius)
        })
    }
}

/// Uniform from `low` to `high`.
fn between(random: &mut Random, low: f32, high: f32) -> f32 {
    low + random.unit() as f32 * (high - low)
}

/// A uniform grid of centres, its cells no smaller than the largest ball, so that balls which
/// overlap lie in the same cell or in neighbours.
struct Grid<const D: usize> {
    region: Aabb<D>,
    /// Cells on each axis.
    cells: [usize; D],
    /// The last ball put into each cell, and before each ball the one put there earlier.
    heads: Vec<u32>,
    links: Vec<u32>,
}

const NONE: u32 = u32::MAX;

impl<const D: usize> Grid<D> {
    fn new(region: Aabb<D>, bodies: u32, greatest_radius: f32) -> Self {
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

    fn insert(&mut self, centre: [f32; D]) {
        let cell = (0..D).fold(0, |index, axis| index * self.cells[axis] + self.cell(centre, axis));
        self.links.push(self.heads[cell]);
        self.heads[cell] = (self.links.len() - 1) as u32;
    }

    fn is_taken(&self, balls: &[Ball<D>], centre: [f32; D], radius: f32) -> bool {
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
                let ball = &balls[next as usize];
                let apart = difference(ball.centre, centre);
                let reach = ball.radius + radius;
                if dot(apart, apart) <= reach * reach {
                    return true;
                }
                next = self.links[next as usize];
            }
            false
        })
    }
}
