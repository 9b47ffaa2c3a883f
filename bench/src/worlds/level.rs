//! A large level: many static boxes, and 2,000 that fly among some of them, as in issue 1081 of Jolt Physics.

use sweep_and_prune::Aabb;
use sweep_and_prune_scenes::Random;

/// The name of the scene in tables and on command lines.
pub const NAME: &str = "level";

/// How many boxes move.
pub const MOVERS: usize = 2000;

/// The distance from one static box to the next, before each is shifted by up to a quarter of it.
const SPACING: f64 = 4.0;
/// How many different sizes the static boxes have: levels are built from a few things.
const SIZES: usize = 16;
/// The moving boxes stay above this many static boxes along each axis, in the middle of the level. So the number of pairs
/// hardly depends on the number of static boxes.
const INHABITED: usize = 100;
/// The highest speed along an axis, in units a frame.
const SPEED: f64 = 0.2;
/// How high the moving boxes fly, where there is a third axis.
const HEIGHT: f64 = 4.0;

/// The level and its current frame. In 3D, the second axis points up.
pub struct Level<const D: usize> {
    /// The moving boxes come first.
    boxes: Vec<Aabb<D>>,
    movers: Vec<Mover<D>>,
    low: [f64; D],
    high: [f64; D],
}

struct Mover<const D: usize> {
    center: [f64; D],
    velocity: [f64; D],
    half: [f32; D],
}

impl<const D: usize> Level<D> {
    /// The first frame with this many static boxes.
    pub fn new(statics: usize, seed: u64) -> Self {
        let mut random = Random::new(seed);
        let side = (1..).find(|side| side * side >= statics).unwrap_or(1);
        let middle = 0.5 * side as f64 * SPACING;
        let reach = 0.5 * side.min(INHABITED) as f64 * SPACING;
        let is_up = |axis: usize| D == 3 && axis == 1;
        let low = std::array::from_fn(|axis| if is_up(axis) { 0.0 } else { middle - reach });
        let high = std::array::from_fn(|axis| if is_up(axis) { HEIGHT } else { middle + reach });

        // Sizes and places are multiples of a 64th, which `f32` represents exactly: boxes of one size have one size.
        let sizes: Vec<[f32; D]> = (0..SIZES)
            .map(|_| std::array::from_fn(|_| (8 + random.below(25)) as f32 / 16.0))
            .collect();
        let statics = (0..statics).map(|index| {
            let row = [index % side, index / side];
            let center = std::array::from_fn(|axis| {
                let at = if is_up(axis) { 0 } else { row[usize::from(axis > 0)] };
                (at as f32 + 0.5) * SPACING as f32 + (random.below(129) as f32 - 64.0) / 64.0
            });
            Aabb::from_center(center, sizes[random.below(SIZES)])
        });
        let statics: Vec<_> = statics.collect();

        let movers: Vec<_> = (0..MOVERS)
            .map(|_| Mover {
                center: std::array::from_fn(|axis| {
                    low[axis] + (high[axis] - low[axis]) * random.unit()
                }),
                velocity: std::array::from_fn(|_| SPEED * (2.0 * random.unit() - 1.0)),
                half: [(4 + random.below(9)) as f32 / 16.0; D],
            })
            .collect();
        let boxes = movers.iter().map(Mover::aabb).chain(statics).collect();
        Self { boxes, movers, low, high }
    }

    /// All boxes of the frame: the first [`MOVERS`] move.
    pub fn boxes(&self) -> &[Aabb<D>] {
        &self.boxes
    }

    /// Goes on to the next frame, in O([`MOVERS`]) time, so that what a library has in the caches stays there.
    pub fn advance(&mut self) {
        let Self { boxes, movers, low, high } = self;
        for (mover, aabb) in movers.iter_mut().zip(boxes) {
            for axis in 0..D {
                let next = mover.center[axis] + mover.velocity[axis];
                if next < low[axis] || high[axis] < next {
                    mover.velocity[axis] = -mover.velocity[axis];
                } else {
                    mover.center[axis] = next;
                }
            }
            *aabb = mover.aabb();
        }
    }
}

impl<const D: usize> Mover<D> {
    fn aabb(&self) -> Aabb<D> {
        Aabb::from_center(self.center.map(|at| at as f32), self.half)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_first_boxes_move_and_as_many_pairs_remain_in_a_larger_level() {
        let pairs = |statics| {
            let mut level = Level::<3>::new(statics, 1);
            let before = level.boxes().to_vec();
            level.advance();
            assert_eq!(level.boxes().len(), MOVERS + statics);
            assert_eq!(level.boxes()[MOVERS..], before[MOVERS..]);
            let moved = level.boxes().iter().zip(&before).filter(|(a, b)| a != b).count();
            assert!(moved > MOVERS / 2, "{moved} moved");
            let mut pairs = 0_usize;
            for mover in before[..MOVERS].iter().step_by(4) {
                pairs += before[MOVERS..].iter().filter(|other| other.overlaps(mover)).count();
            }
            pairs
        };
        let [small, large] = [10_000, 40_000].map(pairs);
        assert!(small > 100 && large.abs_diff(small) < small / 4, "{small} and {large} pairs");
    }
}
