//! How the boxes of any scene are set in motion.

use sweep_and_prune::Aabb;
use sweep_and_prune_scenes::Random;

/// A law of motion. Lengths are in widths of the middle box, times in steps.
#[derive(Clone, Copy, Debug)]
pub struct Law {
    /// The name that a person reads.
    pub name: &'static str,
    /// One sentence on what it does.
    pub description: &'static str,
    /// The mean speed.
    speed: f64,
    /// The share of the boxes that move.
    share: f64,
    /// The share that jumps in a step.
    jumps: f64,
    /// Whether they fall.
    falls: bool,
}

/// Every law. Those that the scenes' own motion has are the same here.
pub const LAWS: [Law; 6] = [
    Law {
        name: "drift",
        description: "All drift by a twentieth of their width a step: the order hardly changes.",
        speed: 0.05,
        share: 1.0,
        jumps: 0.0,
        falls: false,
    },
    Law {
        name: "bounce",
        description: "All fall, and bounce off the floor without loss: slow above, fast below.",
        speed: 0.05,
        share: 1.0,
        jumps: 0.0,
        falls: true,
    },
    Law {
        name: "fast",
        description: "All fly by half their width a step: little is left of the last order.",
        speed: 0.5,
        share: 1.0,
        jumps: 0.0,
        falls: false,
    },
    Law {
        name: "teleport",
        description: "All drift, and one in a hundred jumps anywhere: each jump passes many others.",
        speed: 0.05,
        share: 1.0,
        jumps: 0.01,
        falls: false,
    },
    Law {
        name: "mostly still",
        description: "One box in ten drifts: work on the others is work done twice.",
        speed: 0.05,
        share: 0.1,
        jumps: 0.0,
        falls: false,
    },
    Law {
        name: "still",
        description: "Nothing moves: what is kept from step to step costs next to nothing.",
        speed: 0.0,
        share: 0.0,
        jumps: 0.0,
        falls: false,
    },
];

/// How many steps a box needs to fall from the top of the scene to its floor.
const FALL_STEPS: f64 = 90.0;

/// The boxes of a scene in motion. Centers stay inside the bounds of the first centers.
#[derive(Clone, Debug)]
pub struct Moving<const D: usize> {
    boxes: Vec<Aabb<D>>,
    centers: Vec<[f64; D]>,
    halves: Vec<[f64; D]>,
    velocities: Vec<[f64; D]>,
    /// The bounds of the first centers.
    walls: Aabb<D, f64>,
    /// What falling adds to the velocity on each axis.
    gravity: [f64; D],
    jumps: f64,
    random: Random,
}

impl<const D: usize> Moving<D> {
    /// Boxes with finite coordinates, about to move. The same seed gives the same motion.
    pub fn new(boxes: Vec<Aabb<D>>, law: &Law, seed: u64) -> Self {
        let centers: Vec<[f64; D]> = boxes.iter().map(center).collect();
        let halves: Vec<[f64; D]> = boxes.iter().map(half).collect();
        let mut walls = Aabb::new([f64::INFINITY; D], [f64::NEG_INFINITY; D]);
        for at in &centers {
            for (axis, &at) in at.iter().enumerate() {
                walls.min[axis] = walls.min[axis].min(at);
                walls.max[axis] = walls.max[axis].max(at);
            }
        }
        let mut gravity = [0.0; D];
        if law.falls && !boxes.is_empty() {
            gravity[1] = -2.0 * (walls.max[1] - walls.min[1]) / (FALL_STEPS * FALL_STEPS);
        }
        let mut random = Random::new(!seed);
        let width = middle_width(&halves);
        let velocities = (0..boxes.len())
            .map(|_| {
                let pace = 2.0 * law.speed * width * random.unit();
                let velocity = direction(&mut random).map(|at| at * pace);
                if random.unit() < law.share { velocity } else { [0.0; D] }
            })
            .collect();
        Self { boxes, centers, halves, velocities, walls, gravity, jumps: law.jumps, random }
    }

    /// The boxes of the current step.
    pub fn boxes(&self) -> &[Aabb<D>] {
        &self.boxes
    }

    /// Moves on by one step. O(n).
    pub fn advance(&mut self) {
        for index in 0..self.boxes.len() {
            let (center, velocity) = (&mut self.centers[index], &mut self.velocities[index]);
            let before = *center;
            for axis in 0..D {
                // Half of the acceleration before the move and half after it, so that a box that falls rises as high again.
                velocity[axis] += 0.5 * self.gravity[axis];
                center[axis] += velocity[axis];
                velocity[axis] += 0.5 * self.gravity[axis];
                let (low, high) = (self.walls.min[axis], self.walls.max[axis]);
                if center[axis] < low || center[axis] > high {
                    let wall = if center[axis] < low { low } else { high };
                    center[axis] = (2.0 * wall - center[axis]).clamp(low, high);
                    velocity[axis] = -velocity[axis];
                }
            }
            if self.jumps > 0.0 && self.random.unit() < self.jumps {
                for (axis, at) in center.iter_mut().enumerate() {
                    let (low, high) = (self.walls.min[axis], self.walls.max[axis]);
                    *at = low + self.random.unit() * (high - low);
                }
            }
            // A box that rests keeps the bits of its scene.
            if *center != before {
                let half = self.halves[index];
                self.boxes[index] = Aabb::new(
                    std::array::from_fn(|axis| (center[axis] - half[axis]) as f32),
                    std::array::from_fn(|axis| (center[axis] + half[axis]) as f32),
                );
            }
        }
    }
}

/// Scales each box about its center by a random factor from `size / √spread` to `size * √spread`, whose logarithm is uniform:
/// the largest factor is `spread` times the smallest. If both are 1, no bit changes.
pub fn resize<const D: usize>(boxes: &mut [Aabb<D>], size: f64, spread: f64, seed: u64) {
    if size == 1.0 && spread == 1.0 {
        return;
    }
    let mut random = Random::new(seed.wrapping_add(1));
    for aabb in boxes {
        let factor = size * spread.powf(random.unit() - 0.5);
        let (center, half) = (center(aabb), half(aabb).map(|at| at * factor));
        *aabb = Aabb::new(
            std::array::from_fn(|axis| (center[axis] - half[axis]) as f32),
            std::array::from_fn(|axis| (center[axis] + half[axis]) as f32),
        );
    }
}

fn center<const D: usize>(aabb: &Aabb<D>) -> [f64; D] {
    std::array::from_fn(|axis| 0.5 * (f64::from(aabb.min[axis]) + f64::from(aabb.max[axis])))
}

fn half<const D: usize>(aabb: &Aabb<D>) -> [f64; D] {
    std::array::from_fn(|axis| 0.5 * (f64::from(aabb.max[axis]) - f64::from(aabb.min[axis])))
}

/// The median over the boxes of their mean width.
fn middle_width<const D: usize>(halves: &[[f64; D]]) -> f64 {
    let mut widths: Vec<f64> =
        halves.iter().map(|half| 2.0 * half.iter().sum::<f64>() / D as f64).collect();
    let middle = widths.len() / 2;
    if widths.is_empty() { 0.0 } else { *widths.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

/// A random direction of length 1.
fn direction<const D: usize>(random: &mut Random) -> [f64; D] {
    loop {
        let vector: [f64; D] = std::array::from_fn(|_| random.normal());
        let length = vector.iter().fold(0.0, |sum, at| sum + at * at).sqrt();
        if length > 0.0 {
            return vector.map(|at| at / length);
        }
    }
}
