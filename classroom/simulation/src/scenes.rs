//! The usual starts.

use sweep_and_prune::Aabb;

use crate::scatter::Scatter;
use crate::setup::{Ball, Setup, SetupError};
use crate::vector::greater;

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
/// The most balls of a random start.
pub const MOST_BODIES: u32 = 1_000_000;
/// About the greatest height of the box that balls fall into.
const GREATEST_HEIGHT: f32 = 60.0;
/// How far above the floor the lowest ball begins.
const DROP: f32 = 2.5;
/// The share of the space that the balls take up at the start: well below what random placing
/// can fill.
fn fill<const D: usize>() -> f32 {
    if D == 2 { 0.4 } else { 0.25 }
}

/// Balls that fall into a box 10 wide, `y` up, gravity 9.81 downwards.
///
/// They begin in a loose cloud above the floor; the box is as high as the cloud, and no lower
/// than it is wide. The floor is at 0, the box is centered on the `y` axis. If the cloud were
/// higher than 60, all radii are made smaller until it is not.
///
/// # Errors
/// [`SetupError::Parameter`] for a size, a spread or a number out of range.
pub fn falling<const D: usize>(population: Population) -> Result<Setup<D>, SetupError> {
    let mut population = population;
    check(&population, LARGEST_FALLING * 1.001)?;
    let ground: f32 = (1..D).map(|_| WIDTH).product();
    let height = |population: &Population| volume::<D>(population) / (fill::<D>() * ground);
    while height(&population) > GREATEST_HEIGHT - DROP {
        population.size *= 0.95;
    }
    // Large balls cannot come near the walls, and a few of them may need more space than the mean.
    let mut cloud = height(&population) + 2.0 * population.radii()[1];
    let half = WIDTH / 2.0;
    let balls = loop {
        let scatter = Scatter {
            bodies: population.bodies,
            radii: population.radii(),
            region: upright([-half; D], [half; D], DROP, DROP + cloud),
            speed: [0.5; D],
            seed: population.seed,
        };
        match scatter.balls() {
            Err(SetupError::TooCrowded { .. }) => cloud *= 1.25,
            balls => break balls?,
        }
    };
    let bounds = upright([-half; D], [half; D], 0.0, greater(DROP + cloud, WIDTH));
    let mut gravity = [0.0; D];
    gravity[1] = -9.81;
    // Discs lie in higher heaps than spheres do, and small substeps carry those.
    let substeps = if D == 2 { 8 } else { 4 };
    Ok(Setup { balls, bounds, gravity, restitution: 0.4, time_step: 1.0 / 60.0, substeps })
}

/// A canvas of `width` x `height` pixels, `y` down, with balls at random, none overlapping.
///
/// # Errors
/// [`SetupError::TooCrowded`] if they do not fit; [`SetupError::Parameter`].
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

/// The box with these corners, its second axis from `bottom` to `top`.
fn upright<const D: usize>(mut min: [f32; D], mut max: [f32; D], bottom: f32, top: f32) -> Aabb<D> {
    (min[1], max[1]) = (bottom, top);
    Aabb::new(min, max)
}

/// What the balls fill, on average over all seeds.
fn volume<const D: usize>(population: &Population) -> f32 {
    const PI: f32 = std::f32::consts::PI;
    let [least, greatest] = population.radii();
    // The mean of r², or of r³, where radii have the density r^-2.
    let mean = match D {
        2 => PI * least * greatest,
        _ => 4.0 / 3.0 * PI * least * greatest * 0.5 * (least + greatest),
    };
    population.bodies as f32 * mean
}

fn check(population: &Population, largest: f32) -> Result<(), SetupError> {
    let refuse = |name| Err(SetupError::Parameter { name });
    if population.bodies > MOST_BODIES {
        refuse("bodies")
    } else if !(1.0..=100.0).contains(&population.spread) {
        refuse("spread")
    } else if !(1e-4..=largest).contains(&population.radii()[1]) {
        refuse("size")
    } else {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::{difference, dot};

    fn assert_apart<const D: usize>(setup: &Setup<D>) {
        assert_eq!(setup.validate(), Ok(()));
        for (index, a) in setup.balls.iter().enumerate() {
            for b in &setup.balls[..index] {
                let apart = difference(a.center, b.center);
                assert!(dot(apart, apart) > (a.radius + b.radius) * (a.radius + b.radius));
            }
        }
    }

    #[test]
    fn balls_start_apart_and_inside() {
        for (bodies, size, spread) in
            [(0, 0.2, 1.0), (1, 2.5, 1.0), (7, 0.25, 100.0), (100, 0.5, 1.0), (300, 2.0, 1.5)]
        {
            for seed in 0..5 {
                let population = Population { bodies, size, spread, seed };
                let flat = falling::<2>(population).unwrap();
                let solid = falling::<3>(population).unwrap();
                assert_eq!(
                    (flat.balls.len(), solid.balls.len()),
                    (bodies as usize, bodies as usize)
                );
                assert_apart(&flat);
                assert_apart(&solid);
            }
        }
        let population = Population { bodies: 25, size: 20.0, spread: 4.0, seed: 1 };
        assert_apart(&bouncing(population, [600.0, 400.0]).unwrap());
    }

    #[test]
    fn radii_keep_to_their_bounds_and_are_mostly_small() {
        let population = Population { bodies: 1000, size: 0.1, spread: 9.0, seed: 2 };
        let radii: Vec<f32> =
            falling::<2>(population).unwrap().balls.iter().map(|ball| ball.radius).collect();
        assert!(radii.iter().all(|radius| (0.0333..=0.3001).contains(radius)));
        // With the density r^-2 three quarters are below the middle: (3 - 1) / (3 - 1/3).
        let small = radii.iter().filter(|&&radius| radius < 0.1).count();
        assert!((700..800).contains(&small), "{small}");
    }

    #[test]
    fn equal_seeds_give_equal_balls_and_others_differ() {
        let balls = |seed| {
            falling::<3>(Population { bodies: 10, size: 0.2, spread: 1.0, seed }).unwrap().balls
        };
        assert_eq!(balls(1), balls(1));
        assert_ne!(balls(1), balls(2));
    }

    #[test]
    fn impossible_populations_are_refused_with_the_parameter_name() {
        let good = Population { bodies: 10, size: 0.2, spread: 1.0, seed: 1 };
        for (bad, name) in [
            (Population { size: f32::NAN, ..good }, "size"),
            (Population { size: 0.0, ..good }, "size"),
            (Population { size: 3.0, ..good }, "size"),
            (Population { spread: 0.5, ..good }, "spread"),
            (Population { spread: f32::INFINITY, ..good }, "spread"),
            (Population { bodies: u32::MAX, ..good }, "bodies"),
        ] {
            assert_eq!(falling::<2>(bad), Err(SetupError::Parameter { name }));
        }
        let crowd = Population { bodies: 100, size: 60.0, ..good };
        assert!(matches!(bouncing(crowd, [600.0, 400.0]), Err(SetupError::TooCrowded { .. })));
        let nowhere = bouncing(good, [f32::NAN, 400.0]);
        assert_eq!(nowhere, Err(SetupError::Parameter { name: "bounds" }));
    }
}
