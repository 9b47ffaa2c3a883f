//! How far ahead a fat box reaches.

use super::options::Options;
use crate::{Aabb, Scalar};

/// Chooses fat boxes from what is seen of the motion.
///
/// A fat box that reaches further lasts longer and has more candidates. Bodies that all move get
/// boxes that last equally long, so that they are done with at once, by the finder.
#[derive(Clone, Debug, Default)]
pub(super) struct Prediction {
    /// The mean longest side of the boxes that moved when last seen together.
    size: f64,
    /// The updates that boxes made together last.
    steps: f64,
}

/// How far a fat box reaches in box sizes: alone and together.
const REACH_ALONE: f64 = 0.5;
const REACH: f64 = 0.4;
/// The updates it is to last at most.
const LONGEST: f64 = 24.0;
/// What it has on every side for inexact motion, in displacements.
const SLACK: f64 = 0.125;

impl Prediction {
    /// Looks at bodies that move: where they were at the last update and where they are.
    pub fn look<'a, const D: usize, T: Scalar>(
        &mut self,
        moves: impl Iterator<Item = (&'a Aabb<D, T>, &'a Aabb<D, T>)>,
    ) {
        let (mut size, mut way, mut count) = (0.0, 0.0, 0.0);
        // Every body counts where there are few; of many a sample says as much.
        for (before, now) in moves {
            let (moved, side) = (displacement(before, now), longest_side(now));
            if moved < f64::INFINITY && side < f64::INFINITY {
                (size, way, count) = (size + side, way + moved, count + 1.0);
            }
        }
        if count > 0.0 && way > 0.0 {
            self.size = size / count;
            self.steps = (REACH * size / way).clamp(0.0, LONGEST);
        }
    }

    /// The fat box of a body that moves with most others.
    pub fn together<const D: usize, T: Scalar>(
        &self,
        before: &Aabb<D, T>,
        now: &Aabb<D, T>,
        options: &Options<T>,
    ) -> Aabb<D, T> {
        fatten(before, now, self.steps, options)
    }

    /// The fat box of a body that moves by itself.
    pub fn alone<const D: usize, T: Scalar>(
        &self,
        before: &Aabb<D, T>,
        now: &Aabb<D, T>,
        options: &Options<T>,
    ) -> Aabb<D, T> {
        let side = longest_side(now);
        let size = if side < f64::INFINITY { side.max(self.size) } else { self.size };
        let way = displacement(before, now);
        let steps = if way > 0.0 { (REACH_ALONE * size / way).min(LONGEST) } else { 0.0 };
        fatten(before, now, steps, options)
    }
}

/// A box that holds the next `steps` boxes if each side goes on as it did, and some slack. Holds
/// `now`, whatever the rounding, and has no NaN.
fn fatten<const D: usize, T: Scalar>(
    before: &Aabb<D, T>,
    now: &Aabb<D, T>,
    steps: f64,
    options: &Options<T>,
) -> Aabb<D, T> {
    let zero = T::default();
    let steps = T::from_f64((steps as u32).into());
    let slack = T::from_f64(SLACK);
    let mut fat = *now;
    for axis in 0..D {
        let down = finite_way(before.min[axis], now.min[axis]);
        let up = finite_way(before.max[axis], now.max[axis]);
        let size = |way: T| if way < zero { zero - way } else { way };
        let slack = if steps > zero { (size(down) + size(up)) * slack } else { zero };
        let slack = slack + options.margin;
        let ahead = |way: T| way * steps;
        fat.min[axis] = now.min[axis] - slack;
        fat.max[axis] = now.max[axis] + slack;
        if down < zero {
            fat.min[axis] = fat.min[axis] + ahead(down);
        }
        if up > zero {
            fat.max[axis] = fat.max[axis] + ahead(up);
        }
    }
    fat
}

/// `to - from`, or 0 where that is no finite number.
fn finite_way<T: Scalar>(from: T, to: T) -> T {
    let way = to - from;
    if way < T::INFINITY && way > T::NEG_INFINITY { way } else { T::default() }
}

/// The greatest displacement of a side of a box on an axis.
fn displacement<const D: usize, T: Scalar>(before: &Aabb<D, T>, now: &Aabb<D, T>) -> f64 {
    let sides = before.min.iter().chain(&before.max).zip(now.min.iter().chain(&now.max));
    sides.map(|(&from, &to)| finite_way(from, to).to_f64().abs()).fold(0.0, f64::max)
}

fn longest_side<const D: usize, T: Scalar>(aabb: &Aabb<D, T>) -> f64 {
    let sides = aabb.min.iter().zip(&aabb.max);
    sides.map(|(min, max)| max.to_f64() - min.to_f64()).fold(0.0, f64::max)
}
