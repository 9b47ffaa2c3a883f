//! How far ahead fat AABBs reach.

use crate::float::{greater, greatest, lesser};
use crate::sampling::positions;
use crate::{Aabb, Scalar};

/// Chooses fat AABBs by the motion of a sample of bodies.
///
/// A fat AABB that reaches further lasts longer and has more candidates. If most bodies move, all get
/// fat AABBs that last equally long, so that all are replaced at once, by the finder.
#[derive(Clone, Debug, Default)]
pub struct Motion {
    /// The median of the longest sides of the sample: one huge body says nothing of the others.
    size: f64,
    /// How many updates fat AABBs that are made together last.
    pub lifetime: f64,
}

// Chosen on the motions of `scenes/` in 3D at 10,000 and 100,000 bodies. What was tried since, paired, in 2D
// and 3D at 1,000 to 100,000 (Intel Xeon, 2.6 GHz), stands beside the constants.

/// How far a fat AABB reaches, in box sizes: if made together with others, on average; if made alone.
/// In drift 0.4 and 0.5 take 0.96 to 1.03 of the time in all, 0.3 1.00 to 1.10; 0.9 1.12 to 1.24 (medians).
const REACH: f64 = 0.6;
const REACH_ALONE: f64 = 1.2;
/// What moves further than this, in box sizes, jumps: its motion says nothing of the next step.
/// With 1 drift takes 1.9 to 2.8 of the time.
const JUMP: f64 = 2.0;
/// What moves further than this in an update, in box sizes, is fast.
const FAST: f64 = 0.3;
/// How many updates a fat AABB lasts at most.
const LONGEST: f64 = 80.0;
/// The margin of a fat AABB after a jump, in box sizes.
const LANDED: f64 = 0.4;
/// The margin for inexact motion, in displacements.
const SLACK: f64 = 0.125;
/// How many bodies are sampled.
const SAMPLE: usize = 512;

impl Motion {
    /// Samples motion: the boxes that each body had at the last update and has now.
    pub fn sample<'a, const D: usize, T: Scalar>(
        &mut self,
        bodies: usize,
        motion: impl Fn(usize) -> (&'a Aabb<D, T>, &'a Aabb<D, T>),
    ) {
        // The longest sides, and how far the bodies moved, of those that moved without a jump.
        let (mut sizes, mut ways, mut count) = ([0; SAMPLE], [0; SAMPLE], 0);
        for (before, now) in positions(bodies, SAMPLE).map(motion) {
            let (moved, side) = (displacement(before, now), longest_side(now));
            if moved > 0.0 && moved < JUMP * side && side < f64::INFINITY {
                (sizes[count], ways[count]) = (key(side), key(moved));
                count += 1;
            }
        }
        self.lifetime = 0.0;
        if count > 0 {
            self.size = median(&sizes[..count]);
            self.lifetime = lesser(REACH * self.size / median(&ways[..count]), LONGEST);
        }
    }

    /// The fat AABB of a body that moves together with most others.
    #[inline]
    pub fn together<const D: usize, T: Scalar>(
        &self,
        before: &Aabb<D, T>,
        now: &Aabb<D, T>,
    ) -> Aabb<D, T> {
        let is_jump = self.is_beyond(before, now, JUMP * self.size / self.lifetime);
        let steps = if is_jump { T::default() } else { T::from_f64(self.lifetime) };
        fatten(before, now, steps, T::default())
    }

    /// Whether a body moved so far that its motion says nothing of the next step.
    pub fn is_jump<const D: usize, T: Scalar>(
        &self,
        before: &Aabb<D, T>,
        now: &Aabb<D, T>,
    ) -> bool {
        self.is_beyond(before, now, JUMP * self.size)
    }

    #[inline]
    fn is_beyond<const D: usize, T: Scalar>(
        &self,
        before: &Aabb<D, T>,
        now: &Aabb<D, T>,
        limit: f64,
    ) -> bool {
        let limit = T::from_f64(limit);
        (0..D).fold(false, |beyond, axis| {
            let way = now.min[axis] - before.min[axis];
            beyond | !(way < limit && T::default() - way < limit)
        })
    }

    /// Whether a body moves so far that a fat AABB of its own would last a few updates at most.
    pub fn is_fast<const D: usize, T: Scalar>(
        &self,
        before: &Aabb<D, T>,
        now: &Aabb<D, T>,
    ) -> bool {
        let side = longest_side(now);
        side < f64::INFINITY && self.is_beyond(before, now, FAST * greater(side, self.size))
    }

    /// The fat AABB of a body that moves by itself. How long it lasts depends on the index, so that
    /// bodies do not all leave their fat AABBs at once.
    pub fn alone<const D: usize, T: Scalar>(
        &self,
        index: u32,
        before: &Aabb<D, T>,
        now: &Aabb<D, T>,
    ) -> Aabb<D, T> {
        let side = longest_side(now);
        let size = if side < f64::INFINITY { greater(side, self.size) } else { self.size };
        let way = displacement(before, now);
        let longest = LONGEST * (1.0 - f64::from(index % 16) / 32.0);
        let steps = if way > 0.0 { lesser(REACH_ALONE * size / way, longest) } else { 0.0 };
        if steps < 1.0 {
            // A jump: where it goes from here is unknown.
            let landed = T::from_f64(LANDED * size);
            let margin = if landed < T::INFINITY { landed } else { T::default() };
            return fatten(before, now, T::default(), margin);
        }
        fatten(before, now, T::from_f64(steps), T::default())
    }
}

/// A box that holds the next `steps` boxes if each side goes on as it did, some slack, and a finite margin. Holds
/// `now`, whatever the rounding, and has no NaN where `now` has none.
#[inline]
fn fatten<const D: usize, T: Scalar>(
    before: &Aabb<D, T>,
    now: &Aabb<D, T>,
    steps: T,
    margin: T,
) -> Aabb<D, T> {
    let zero = T::default();
    let size = |way: T| if way < zero { zero - way } else { way };
    let tenth = if steps > zero { T::from_f64(SLACK) } else { zero };
    let mut fat = *now;
    for axis in 0..D {
        // Infinite where a side comes from or goes to infinity, NaN where it stays there.
        let down = now.min[axis] - before.min[axis];
        let up = now.max[axis] - before.max[axis];
        let slack = (size(down) + size(up)) * tenth;
        let slack = slack + margin;
        let slack = if slack < T::INFINITY { slack } else { margin };
        let (down, up) = (down * steps, up * steps);
        let down = if down < zero { down } else { zero };
        let up = if up > zero { up } else { zero };
        fat.min[axis] = now.min[axis] - slack + down;
        fat.max[axis] = now.max[axis] + slack + up;
    }
    fat
}

/// How many of the lowest bits of a number its key leaves out: it is the number to 1 %.
const LEFT_OUT: u32 = 45;

/// The upper bits of a number that is not negative. Larger numbers have no smaller key.
fn key(number: f64) -> u32 {
    (number.to_bits() >> LEFT_OUT) as u32
}

/// The median of at least one number, given their keys, to 1 %. Bit by bit below those that all keys share, which takes
/// a few kilobytes less of WebAssembly than a selection of the standard library, and no more time.
fn median(keys: &[u32]) -> f64 {
    let middle = keys.len() / 2;
    let differing = keys.iter().fold(0, |bits, key| bits | key ^ keys[0]);
    let unknown = u32::BITS - differing.leading_zeros();
    let mut median = keys[0] >> unknown << unknown;
    for bit in (0..unknown).rev() {
        let next = median | 1 << bit;
        if keys.iter().map(|&key| u32::from(key < next)).sum::<u32>() as usize <= middle {
            median = next;
        }
    }
    f64::from_bits(u64::from(median) << LEFT_OUT)
}

/// The greatest displacement of a side of a box on an axis.
fn displacement<const D: usize, T: Scalar>(before: &Aabb<D, T>, now: &Aabb<D, T>) -> f64 {
    let sides = before.min.iter().chain(&before.max).zip(now.min.iter().chain(&now.max));
    greatest(sides.map(|(&from, &to)| (to.to_f64() - from.to_f64()).abs()))
}

/// The length of the longest side.
pub fn longest_side<const D: usize, T: Scalar>(aabb: &Aabb<D, T>) -> f64 {
    let sides = aabb.min.iter().zip(&aabb.max);
    greatest(sides.map(|(min, max)| max.to_f64() - min.to_f64()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_that_of_the_sorted_numbers() {
        for count in 1..40_u32 {
            let mut numbers: alloc::vec::Vec<f64> =
                (0..count).map(|i| f64::from(i * 7919 % 13) * 2.0_f64.powi(i as i32 % 5)).collect();
            let keys: alloc::vec::Vec<u32> = numbers.iter().copied().map(key).collect();
            numbers.sort_by(f64::total_cmp);
            assert_eq!(median(&keys), numbers[count as usize / 2]);
        }
    }

    #[test]
    fn a_fat_aabb_contains_its_body_even_at_infinity() {
        let ends = [f32::NEG_INFINITY, f32::MIN, -1.0, 0.0, 1e-30, f32::MAX, f32::INFINITY];
        let intervals = || {
            let pairs = ends.iter().flat_map(|&a| ends.iter().map(move |&b| (a, b)));
            pairs.filter(|(a, b)| a <= b).map(|(a, b)| Aabb::new([a], [b]))
        };
        for before in intervals() {
            for now in intervals() {
                for steps in [0.0, 1.0, 8.0, f32::MAX] {
                    let fat = fatten(&before, &now, steps, 0.5);
                    assert!(fat.contains(&now), "{before:?} {now:?} {steps} {fat:?}");
                }
                let mut motion = Motion::default();
                motion.sample(1, |_| (&before, &now));
                assert!(motion.alone(7, &before, &now).contains(&now));
                assert!(motion.together(&before, &now).contains(&now));
            }
        }
    }
}
