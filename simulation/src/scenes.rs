//! The usual starts.

use sweep_and_prune::Aabb;

use crate::scatter::Scatter;
use crate::setup::{Ball, Setup, SetupError};

/// How many balls, how large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Population {
    /// How many.
    pub bodies: u32,
    /// The middle radius: the geometric mean of the least and the greatest.
    pub size: f32,
    /// The greatest radius divided by the least, at least 1. Small ones are more frequent.
    pub spread: f32,
    /// The same seed gives the same balls everywhere.
    pub seed: u64,
}

impl Population {
    fn radii(&self) -> [f32; 2] {
        let root = self.spread.sqrt();
        [self.size / root, self.size * root]
    }
}

/// The width of the box that balls fall into.
const WIDTH: f32 = 10.0;
/// The largest ball that may fall.
pub const LARGEST_FALLING: f32 = WIDTH / 4.0;
/// The greatest height of the box that balls fall into.
const GREATEST_HEIGHT: f32 = 60.0;
/// How far above the floor the lowest ball begins.
const DROP: f32 = 2.5;
/// The share of the space that the balls take up at the start: well below what random placing
/// can fill.
const FILL: f32 = 0.25;

/// Balls that fall into a box 10 wide, `y` up, gravity 9.81 downwards.
///
/// They begin in a loose cloud above the floor; the box is as high as the cloud, and no lower
/// than it is wide. The floor is at 0, the box is centred on the `y` axis. If the cloud were
/// higher than 60, all radii are made smaller until it is not.
///
/// # Errors
/// [`SetupError::Parameter`] for a size, a spread or a number out of range.
pub fn falling<const D: usize>(population: Population) -> Result<Setup<D>, SetupError> {
    let mut population = population;
    check(&population, LARGEST_FALLING * 1.001)?;
    let ground: f32 = (1..D).map(|_| WIDTH).product();
    let mut cloud = volume_bound::<D>(&population) / (FILL * ground);
    while cloud > GREATEST_HEIGHT - DROP {
        population.size *= 0.95;
        cloud = volume_bound::<D>(&population) / (FILL * ground);
    }
    let cloud = cloud.max(4.0 * population.radii()[1]);
    let half = WIDTH / 2.0;
    let bounds = box_of([-half; D], [half; D], 0.0, (DROP + cloud).max(WIDTH));
    let region = box_of([-half; D], [half; D], DROP, DROP + cloud);
    let balls = Scatter {
        bodies: population.bodies,
        radii: population.radii(),
        region,
        speed: [0.5; D],
        seed: population.seed,
    }
    .balls()?;
    let mut gravity = [0.0; D];
    gravity[1] = -9.81;
    Ok(Setup { balls, bounds, gravity, restitution: 0.4, time_step: 1.0 / 60.0, substeps: 4 })
}

/// A canvas of `width` x `height` pixels, `y` down, with balls at random, none overlapping.
///
/// # Errors
/// [`SetupError::NoRoom`] if they do not fit; [`SetupError::Parameter`].
pub fn bouncing(population: Population, size: [f32; 2]) -> Result<Setup<2>, SetupError> {
    let canvas = canvas(Vec::new(), size);
    canvas.validate()?;
    check(&population, size[0].min(size[1]) / 2.0)?;
    let speed = [200.0, 200.0];
    let balls = Scatter {
        bodies: population.bodies,
        radii: population.radii(),
        region: canvas.bounds,
        speed,
        seed: population.seed,
    }
    .balls()?;
    Ok(Setup { balls, ..canvas })
}

/// The canvas with these balls.
pub fn canvas(balls: Vec<Ball<2>>, size: [f32; 2]) -> Setup<2> {
    Setup {
        balls,
        bounds: Aabb::new([0.0, 0.0], size),
        gravity: [0.0, 500.0],
        restitution: 0.96,
        time_step: 1.0 / 60.0,
        substeps: 4,
    }
}

fn box_of<const D: usize>(
    mut min: [f32; D],
    mut max: [f32; D],
    bottom: f32,
    top: f32,
) -> Aabb<D> {
    (min[1], max[1]) = (bottom, top);
    Aabb::new(min, max)
}

fn volume_bound<const D: usize>(p: &Population) -> f32 {
    let [least, greatest] = p.radii();
    // The mean of r^D under the density r^-2.
    let mean = if D == 2 { least * greatest } else { least * greatest * 0.5 * (least + greatest) };
    let unit = if D == 2 { std::f32::consts::PI } else { 4.0 / 3.0 * std::f32::consts::PI };
    p.bodies as f32 * mean * unit
}

fn check(p: &Population, greatest: f32) -> Result<(), SetupError> {
    if !(1.0..=100.0).contains(&p.spread) {
        return Err(SetupError::Parameter { name: "spread" });
    }
    if !(1e-6..=greatest).contains(&p.radii()[1]) {
        return Err(SetupError::Parameter { name: "size" });
    }
    Ok(())
}
