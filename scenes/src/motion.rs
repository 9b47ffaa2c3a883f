//! Boxes in motion: cubes that fly straight and bounce off the walls of the unit cube.

use sweep_and_prune::{Aabb, Scalar};

use crate::random::Random;
use crate::recipes::{self, Draw};
use crate::scene::round;

/// A law of motion for the cubes of [`Scene::Uniform`](crate::Scene::Uniform).
///
/// Directions are even over the circle or sphere, speeds even from 0 to twice the mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Motion {
    /// All drift, by a twentieth of a box width per frame on average.
    Drift,
    /// All fly, by half a box width per frame on average.
    Fast,
    /// One in ten drifts, the others rest.
    MostlyStill,
    /// All drift, and in each frame one in a hundred jumps to a random place.
    Teleport,
}

impl Motion {
    /// Every motion.
    pub const ALL: [Motion; 4] =
        [Motion::Drift, Motion::Fast, Motion::MostlyStill, Motion::Teleport];

    /// The name in reports and on command lines, lower case with hyphens.
    pub const fn name(self) -> &'static str {
        match self {
            Motion::Drift => "drift",
            Motion::Fast => "fast",
            Motion::MostlyStill => "mostly-still",
            Motion::Teleport => "teleport",
        }
    }

    /// One sentence on what the motion is, and what it is hard on.
    pub const fn description(self) -> &'static str {
        match self {
            Motion::Drift => {
                "All boxes drift by a twentieth of their width a frame: the order hardly changes."
            }
            Motion::Fast => {
                "All boxes fly by half their width a frame: little is left of the last frame's order."
            }
            Motion::MostlyStill => "One box in ten drifts: work on the others is work done twice.",
            Motion::Teleport => {
                "All boxes drift and one in a hundred jumps anywhere: each jump passes many others in the order."
            }
        }
    }

    /// The motion of this [`name`](Self::name).
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|motion| motion.name() == name)
    }

    /// Mean speed in box widths a frame, share of the boxes that move, share that jumps a frame.
    const fn law(self) -> (f64, f64, f64) {
        match self {
            Motion::Drift => (0.05, 1.0, 0.0),
            Motion::Fast => (0.5, 1.0, 0.0),
            Motion::MostlyStill => (0.05, 0.1, 0.0),
            Motion::Teleport => (0.05, 1.0, 0.01),
        }
    }

    /// The first frame of `n` boxes in motion; `None` unless `D` is 1, 2 or 3.
    pub fn start<const D: usize, T: Scalar>(self, n: usize, seed: u64) -> Option<Moving<D, T>> {
        if !(1..=3).contains(&D) {
            return None;
        }
        let (speed, share, jumps) = self.law();
        let mut draw = Draw::new::<T>(n, Random::new(seed));
        let (centers, half) = recipes::uniform_cubes(&mut draw);
        let mut random = draw.random;
        let velocities = (0..n)
            .map(|_| {
                let pace = speed * 2.0 * half * 2.0 * random.unit();
                let velocity = direction(&mut random).map(|at| at * pace);
                if random.unit() < share { velocity } else { [0.0; D] }
            })
            .collect();
        let mut moving = Moving { half, centers, velocities, jumps, random, boxes: Vec::new() };
        moving.place();
        Some(moving)
    }
}

/// A random direction of length 1.
fn direction<const D: usize>(random: &mut Random) -> [f64; D] {
    loop {
        let vector: [f64; D] = core::array::from_fn(|_| random.normal());
        let length = vector.iter().fold(0.0, |sum, at| sum + at * at).sqrt();
        if length > 0.0 {
            return vector.map(|at| at / length);
        }
    }
}

/// Boxes in motion: one frame, and how to get to the next.
#[derive(Clone, Debug)]
pub struct Moving<const D: usize, T: Scalar = f32> {
    half: f64,
    centers: Vec<[f64; D]>,
    velocities: Vec<[f64; D]>,
    jumps: f64,
    random: Random,
    boxes: Vec<Aabb<D, T>>,
}

impl<const D: usize, T: Scalar> Moving<D, T> {
    /// The boxes of the current frame, all valid; a box keeps its index from frame to frame.
    pub fn boxes(&self) -> &[Aabb<D, T>] {
        &self.boxes
    }

    /// Moves on by one frame, in place. O(n) time.
    ///
    /// Centers stay within the unit cube; boxes reach over its walls by half their width.
    pub fn advance(&mut self) {
        for (center, velocity) in self.centers.iter_mut().zip(&mut self.velocities) {
            for (at, speed) in center.iter_mut().zip(velocity) {
                *at += *speed;
                // More than once only if the few boxes are wider than the cube.
                while !(0.0..=1.0).contains(at) {
                    *at = if *at < 0.0 { -*at } else { 2.0 - *at };
                    *speed = -*speed;
                }
            }
            if self.jumps > 0.0 && self.random.unit() < self.jumps {
                *center = self.random.point();
            }
        }
        self.place();
    }

    /// Puts the boxes around their centers.
    fn place(&mut self) {
        let half = [self.half; D];
        self.boxes.clear();
        self.boxes.extend(self.centers.iter().map(|&at| round(&recipes::around(at, half))));
    }
}
