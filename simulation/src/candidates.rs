//! The pairs that may touch within a step: found once, and kept up while it lasts.

use std::array::from_fn;

use sweep_and_prune::algorithms::Counts;
use sweep_and_prune::{Aabb, Error};

use crate::bodies::Bodies;
use crate::broad_phase::Engine;
use crate::grid::Grid;
use crate::vector::{dot, greater, lesser};

/// What a box leaves around the way that its ball is expected to take, as a share of the way...
const MARGIN_OF_WAY: f32 = 0.25;
/// ...and of the radius.
const MARGIN_OF_RADIUS: f32 = 0.05;
/// The pairs of all balls are found anew if more than one in so many have left their boxes.
const MOST_LEFT: usize = 8;

/// A box for each ball that holds it to the end of the step, as far as can be foreseen, and the
/// pairs of boxes that overlap.
///
/// The broad phase runs once a step, over boxes that are large enough for all its substeps
/// (Müller et al. 2020, "Detailed rigid body simulation with extended position based dynamics",
/// §3.5). It is not left at that: in each substep every ball that is about to leave its box, because
/// a bounce sent it elsewhere, gets a new one, and is tested against all that are near. So no contact
/// is missed, and the motion is to the bit that of a broad phase in every substep.
#[derive(Debug, Default)]
pub struct Candidates<const D: usize> {
    /// By ball.
    pub boxes: Vec<Aabb<D>>,
    /// In the order in which they were found.
    pub pairs: Vec<[u32; 2]>,
    /// The balls that left their boxes before this substep, ascending.
    left: Vec<u32>,
    /// By ball, whether it is among them.
    has_left: Vec<bool>,
    /// Whether all balls are to be looked at.
    is_stale: bool,
}

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

impl<const D: usize> Candidates<D> {
    /// Makes the boxes of a step that begins.
    pub fn enclose(&mut self, bodies: &Bodies<D>, ahead: &Ahead<D>) {
        self.boxes.clear();
        self.boxes.extend((0..bodies.len()).map(|ball| large_box(bodies, ball, ahead)));
        self.is_stale = true;
    }

    /// Makes new boxes for the balls that would leave theirs in this substep.
    pub fn follow(&mut self, bodies: &Bodies<D>, ahead: &Ahead<D>) {
        self.left.clear();
        for (ball, large) in self.boxes.iter().enumerate() {
            if !contains(large, &swept_box(bodies, ball, ahead)) {
                self.left.push(ball as u32);
            }
        }
        if self.left.len() > self.boxes.len() / MOST_LEFT {
            self.enclose(bodies, ahead);
            return;
        }
        for &ball in &self.left {
            self.boxes[ball as usize] = large_box(bodies, ball as usize, ahead);
        }
    }

    /// What the engine would do next, counted, if it is its turn; the library's finder counts nothing.
    pub fn count(&self, engine: &Engine<D>) -> Result<Option<Counts>, Error> {
        engine.count(&self.boxes)
    }

    /// Brings the pairs up to the boxes: by the engine, if the boxes are all new, which is then
    /// returned as true; or of the balls alone that left theirs, by a grid.
    pub fn find(&mut self, engine: &mut Engine<D>) -> Result<bool, Error> {
        if std::mem::take(&mut self.is_stale) {
            self.pairs.clear();
            self.pairs.extend_from_slice(engine.find(&self.boxes)?);
            return Ok(true);
        }
        if self.left.is_empty() {
            return Ok(false);
        }
        self.has_left.clear();
        self.has_left.resize(self.boxes.len(), false);
        self.left.iter().for_each(|&ball| self.has_left[ball as usize] = true);
        let Self { boxes, pairs, left, has_left, .. } = self;
        pairs.retain(|pair| !pair.iter().any(|&ball| has_left[ball as usize]));
        let grid = grid_of(boxes);
        for &ball in &*left {
            let own = &boxes[ball as usize];
            grid.any_near(centre(own), |other| {
                // Of two that left, the first one finds the pair.
                if own.overlaps(&boxes[other as usize])
                    && other != ball
                    && (other > ball || !has_left[other as usize])
                {
                    pairs.push([ball.min(other), ball.max(other)]);
                }
                false
            });
        }
        Ok(false)
    }
}

/// The boxes by their centres. O(boxes).
fn grid_of<const D: usize>(boxes: &[Aabb<D>]) -> Grid<D> {
    let mut hull = boxes[0];
    let mut widest = 0.0;
    for aabb in boxes {
        for axis in 0..D {
            hull.min[axis] = lesser(aabb.min[axis], hull.min[axis]);
            hull.max[axis] = greater(aabb.max[axis], hull.max[axis]);
            widest = greater(aabb.max[axis] - aabb.min[axis], widest);
        }
    }
    // A hair more than half, for centres are rounded.
    let mut grid = Grid::new(hull, boxes.len() as u32, 0.501 * widest);
    boxes.iter().for_each(|aabb| grid.insert(centre(aabb)));
    grid
}

fn centre<const D: usize>(aabb: &Aabb<D>) -> [f32; D] {
    from_fn(|axis| 0.5 * (aabb.min[axis] + aabb.max[axis]))
}

/// The box that a ball sweeps out within the substep.
#[inline]
fn swept_box<const D: usize>(bodies: &Bodies<D>, ball: usize, ahead: &Ahead<D>) -> Aabb<D> {
    let (position, velocity) = (bodies.positions[ball], bodies.velocities[ball]);
    let radius = bodies.radii[ball];
    let next: [f32; D] =
        from_fn(|axis| position[axis] + (velocity[axis] + ahead.kick[axis]) * ahead.time);
    Aabb::new(
        from_fn(|axis| lesser(position[axis], next[axis]) - radius),
        from_fn(|axis| greater(position[axis], next[axis]) + radius),
    )
}

/// The box of all that a ball sweeps through to the end of the step if nothing stops it, and a
/// margin around it. At least as large as that of the substep.
#[inline]
fn large_box<const D: usize>(bodies: &Bodies<D>, ball: usize, ahead: &Ahead<D>) -> Aabb<D> {
    let (position, velocity) = (bodies.positions[ball], bodies.velocities[ball]);
    let radius = bodies.radii[ball];
    let time = ahead.time * ahead.substeps as f32;
    let way: [f32; D] = from_fn(|axis| (velocity[axis] + ahead.kick[axis]) * time);
    let fall = ahead.gravity.map(|g| g * time * time);
    let margin = MARGIN_OF_WAY * dot(way, way).sqrt() + MARGIN_OF_RADIUS * radius;
    let mut large = swept_box(bodies, ball, ahead);
    for axis in 0..D {
        let (near, far) = (position[axis] + way[axis], position[axis] + way[axis] + fall[axis]);
        large.min[axis] = lesser(large.min[axis], lesser(near, far) - radius) - margin;
        large.max[axis] = greater(large.max[axis], greater(near, far) + radius) + margin;
    }
    large
}

/// Whether a box holds another.
#[inline]
fn contains<const D: usize>(outer: &Aabb<D>, inner: &Aabb<D>) -> bool {
    (0..D).all(|axis| outer.min[axis] <= inner.min[axis] && inner.max[axis] <= outer.max[axis])
}
