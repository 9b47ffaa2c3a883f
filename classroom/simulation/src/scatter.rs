//! Balls at random places, none overlapping another.

use sweep_and_prune::Aabb;
use sweep_and_prune_scenes::Random;

use crate::grid::Grid;
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
    /// [`SetupError::TooCrowded`].
    pub fn balls(&self) -> Result<Vec<Ball<D>>, SetupError> {
        let mut random = Random::new(self.seed);
        let [least, greatest] = self.radii.map(|radius| 1.0 / radius);
        let mut radii: Vec<f32> =
            (0..self.bodies).map(|_| 1.0 / between(&mut random, least, greatest)).collect();
        radii.sort_unstable_by(|a, b| b.total_cmp(a));

        let widths = [2.0 * self.radii[1]; D];
        let grid = Grid::new(&self.region, self.bodies as usize, widths);
        let mut chains = Chains { heads: vec![NONE; grid.len()], links: Vec::new() };
        let mut balls: Vec<Ball<D>> = Vec::with_capacity(radii.len());
        for radius in radii {
            let center = (0..Self::TRIES)
                .map(|_| self.draw_place(radius, &mut random))
                .find(|&center| !self.is_taken(&grid, &chains, &balls, center, radius))
                .ok_or(SetupError::TooCrowded { placed: balls.len() })?;
            let velocity = self.speed.map(|speed| between(&mut random, -speed, speed));
            chains.insert(grid.cell(center));
            balls.push(Ball { center, radius, velocity });
        }
        Ok(balls)
    }

    fn draw_place(&self, radius: f32, random: &mut Random) -> [f32; D] {
        std::array::from_fn(|axis| {
            let (min, max) = (self.region.min[axis], self.region.max[axis]);
            between(random, min + radius, max - radius)
        })
    }

    /// Whether a ball there would touch one of the others.
    fn is_taken(
        &self,
        grid: &Grid<D>,
        chains: &Chains,
        balls: &[Ball<D>],
        center: [f32; D],
        radius: f32,
    ) -> bool {
        // A hair more than the farthest center of a ball that touches, for sums are rounded.
        let farthest = 1.01 * (radius + self.radii[1]);
        let near = Aabb::new(center.map(|at| at - farthest), center.map(|at| at + farthest));
        let touches = |other: u32| {
            let ball = &balls[other as usize];
            let apart = difference(ball.center, center);
            let reach = ball.radius + radius;
            dot(apart, apart) <= reach * reach
        };
        grid.any_row(&near, |mut cells| cells.any(|cell| chains.of(cell).any(touches)))
    }
}

/// The balls of each cell, in no order that matters.
struct Chains {
    /// The last ball put into each cell, and before each ball the one put there earlier.
    heads: Vec<u32>,
    links: Vec<u32>,
}

const NONE: u32 = u32::MAX;

impl Chains {
    /// Puts in the next ball, whose index is the number of those before it.
    fn insert(&mut self, cell: usize) {
        let ball = self.links.len() as u32;
        self.links.push(std::mem::replace(&mut self.heads[cell], ball));
    }

    fn of(&self, cell: usize) -> impl Iterator<Item = u32> {
        let ball = |index: u32| (index != NONE).then_some(index);
        std::iter::successors(ball(self.heads[cell]), move |&last| ball(self.links[last as usize]))
    }
}

/// Uniform from `low` to `high`.
fn between(random: &mut Random, low: f32, high: f32) -> f32 {
    low + random.unit() as f32 * (high - low)
}
