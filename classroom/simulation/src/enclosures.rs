//! Boxes that hold the balls through a step, unless a bounce sends one out of its box.

use std::array::from_fn;
use std::ops::Range;

use sweep_and_prune::Aabb;

use crate::bodies::Bodies;
use crate::contacts::Contacts;
use crate::vector::{BLOCK, dot, greater, lesser, repeated};

/// The margin of a box around the path that its ball is expected to take, as a share of the path. It is for a ball that
/// has not touched another lately, so that it most likely flies on.
/// (Wider boxes make more pairs, and more balls leave narrower ones.)
const MARGIN_IN_FLIGHT: f32 = 0.15;
/// The same for a ball that has touched another lately, and may be sent anywhere.
const MARGIN_IN_TOUCH: f32 = 0.7;
/// The margin that is added in either case, as a share of the radius.
const MARGIN_OF_RADIUS: f32 = 0.05;
/// How near to the side of its box a ball may come, as a share of the radius. This exceeds any rounding error, so that a
/// ball inside its box overlaps only what the box overlaps.
const CLEARANCE: f32 = 0.01;

/// The most coordinates of a ball.
const ONE: usize = 3;

/// Where balls are about to go.
#[derive(Clone, Copy, Debug)]
pub struct Ahead<const D: usize> {
    /// What gravity adds to the velocities before they carry the balls on.
    pub kick: [f32; D],
    pub gravity: [f32; D],
    /// How long the substep is.
    pub time: f32,
    /// How many substeps the step has left, this one included.
    pub substeps: u32,
}

/// A box for each ball.
#[derive(Debug)]
pub struct Enclosures<const D: usize> {
    pub boxes: Vec<Aabb<D>>,
    /// The region in which the center has to stay for the ball to be inside its box.
    lowest: Vec<[f32; D]>,
    highest: Vec<[f32; D]>,
    /// By axis, at least the greatest side of any box.
    pub widest: [f32; D],
    /// Which balls touched another when the boxes were made.
    in_touch: Vec<bool>,
}

impl<const D: usize> Default for Enclosures<D> {
    fn default() -> Self {
        let (boxes, lowest, highest) = (Vec::new(), Vec::new(), Vec::new());
        Self { boxes, lowest, highest, widest: [0.0; D], in_touch: Vec::new() }
    }
}

impl<const D: usize> Enclosures<D> {
    /// Makes all boxes from scratch. A box holds all that its ball sweeps through to the end of the step if nothing stops
    /// it, and a margin around that. `contacts` are what the last substep found.
    pub fn enclose_all(&mut self, bodies: &Bodies<D>, contacts: &Contacts, ahead: &Ahead<D>) {
        self.in_touch.clear();
        self.in_touch.resize(bodies.len(), false);
        for ball in contacts.touching().as_flattened() {
            self.in_touch[*ball as usize] = true;
        }
        self.boxes.resize(bodies.len(), Aabb::new([0.0; D], [0.0; D]));
        self.lowest.resize(bodies.len(), [0.0; D]);
        self.highest.resize(bodies.len(), [0.0; D]);
        let mut widest = [0.0; BLOCK];
        for first in (0..bodies.len()).step_by(BLOCK / D) {
            let balls = first..bodies.len().min(first + BLOCK / D);
            let (min, max) =
                extents::<D, BLOCK>(balls.clone(), bodies, &self.in_touch[balls.clone()], ahead);
            for i in 0..BLOCK {
                widest[i] = greater(max[i] - min[i], widest[i]);
            }
            let (min, max) = (min.as_chunks().0, max.as_chunks().0);
            for (ball, (&min, &max)) in balls.zip(min.iter().zip(max)) {
                self.set(ball, Aabb::new(min, max), bodies.radii[ball]);
            }
        }
        self.widest = [0.0; D];
        for of_ball in widest.as_chunks::<D>().0 {
            self.widest = from_fn(|axis| greater(of_ball[axis], self.widest[axis]));
        }
    }

    /// Enlarges the box of a ball that was sent elsewhere, so that it holds the rest of the step, too. Returns the box before.
    pub fn enclose_too(&mut self, ball: u32, bodies: &Bodies<D>, ahead: &Ahead<D>) -> Aabb<D> {
        let ball = ball as usize;
        let before = self.boxes[ball];
        let (min, max) = extents::<D, ONE>(ball..ball + 1, bodies, &[true], ahead);
        let union = Aabb::new(
            from_fn(|axis| lesser(before.min[axis], min[axis])),
            from_fn(|axis| greater(before.max[axis], max[axis])),
        );
        self.set(ball, union, bodies.radii[ball]);
        before
    }

    #[inline]
    fn set(&mut self, ball: usize, large: Aabb<D>, radius: f32) {
        let inset = radius + CLEARANCE * radius;
        self.lowest[ball] = large.min.map(|min| min + inset);
        self.highest[ball] = large.max.map(|max| max - inset);
        self.boxes[ball] = large;
    }

    /// The middles of the boxes.
    pub fn middles(&self) -> impl Iterator<Item = [f32; D]> {
        let ends = self.lowest.iter().zip(&self.highest);
        ends.map(|(low, high)| from_fn(|axis| 0.5 * (low[axis] + high[axis])))
    }

    /// Lists the balls that are not inside their boxes, or will not be before the substep ends,
    /// ascending.
    pub fn list_leaving(&self, bodies: &Bodies<D>, ahead: &Ahead<D>, leaving: &mut Vec<u32>) {
        leaving.clear();
        let kicks: [f32; BLOCK] = repeated(ahead.kick);
        let leaves = |coordinates: Range<usize>| {
            let at = &bodies.positions.as_flattened()[coordinates.clone()];
            let speeds = &bodies.velocities.as_flattened()[coordinates.clone()];
            let lowest = &self.lowest.as_flattened()[coordinates.clone()];
            let highest = &self.highest.as_flattened()[coordinates];
            let mut leaves = 0;
            for i in 0..at.len().min(BLOCK) {
                let next = at[i] + (speeds[i] + kicks[i]) * ahead.time;
                leaves |= u32::from(lesser(at[i], next) < lowest[i]);
                leaves |= u32::from(greater(at[i], next) > highest[i]);
            }
            leaves != 0
        };
        for first in (0..bodies.len()).step_by(BLOCK / D) {
            let end = bodies.len().min(first + BLOCK / D);
            if leaves(first * D..end * D) {
                let leaving_of_block = (first..end).filter(|ball| leaves(ball * D..(ball + 1) * D));
                leaving.extend(leaving_of_block.map(|ball| ball as u32));
            }
        }
    }
}

/// The lower and the upper corners of the boxes of balls that have at most `N` coordinates,
/// coordinate by coordinate. `in_touch` is by ball of these.
fn extents<const D: usize, const N: usize>(
    balls: Range<usize>,
    bodies: &Bodies<D>,
    in_touch: &[bool],
    ahead: &Ahead<D>,
) -> ([f32; N], [f32; N]) {
    let time = ahead.time * ahead.substeps as f32;
    let mut reaches = [0.0; N];
    let (reach_of, _) = reaches.as_chunks_mut();
    let properties = bodies.velocities[balls.clone()].iter().zip(&bodies.radii[balls.clone()]);
    for ((reach, (velocity, &radius)), &in_touch) in
        reach_of.iter_mut().zip(properties).zip(in_touch)
    {
        let margin = if in_touch { MARGIN_IN_TOUCH } else { MARGIN_IN_FLIGHT };
        let way: [f32; D] = from_fn(|axis| (velocity[axis] + ahead.kick[axis]) * time);
        *reach = [margin * dot(way, way).sqrt() + MARGIN_OF_RADIUS * radius + radius; D];
    }

    let coordinates = balls.start * D..balls.end * D;
    let at = &bodies.positions.as_flattened()[coordinates.clone()];
    let speeds = &bodies.velocities.as_flattened()[coordinates];
    let kicks: [f32; N] = repeated(ahead.kick);
    let falls: [f32; N] = repeated(ahead.gravity.map(|g| g * time * time));
    let (mut min, mut max) = ([0.0; N], [0.0; N]);
    for i in 0..at.len().min(N) {
        let speed = speeds[i] + kicks[i];
        // The end of this substep lies on the path to the end of the step, except for rounding.
        let (next, end) = (at[i] + speed * ahead.time, at[i] + speed * time);
        let fallen = end + falls[i];
        min[i] = lesser(lesser(at[i], next), lesser(end, fallen)) - reaches[i];
        max[i] = greater(greater(at[i], next), greater(end, fallen)) + reaches[i];
    }
    (min, max)
}
