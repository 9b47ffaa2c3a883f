//! The narrow phase: which of the pairs of boxes are pairs of balls that touch.

use sweep_and_prune::Aabb;

use crate::bodies::Bodies;
use crate::order::LevelOrder;
use crate::vector::{difference, dot};

/// Two balls that touch, or will before the substep ends.
#[derive(Clone, Copy, Debug)]
pub struct Contact<const D: usize> {
    /// The balls, smaller index first.
    pub pair: [u32; 2],
    /// The unit vector from the first towards the second.
    pub normal: [f32; D],
    /// How fast they may approach without overlapping at the end of the substep.
    pub slack: f32,
    /// The mass that the impulse moves: 1 / (1/m₀ + 1/m₁).
    pub mass: f32,
    /// The impulse that holds them apart, never negative: along `normal` on the second, against
    /// it on the first.
    pub impulse: f32,
}

/// A ball that touches a wall.
#[derive(Clone, Copy, Debug)]
pub struct WallContact {
    /// The ball.
    pub body: u32,
    /// The axis that the wall stands across.
    pub axis: u32,
    /// +1 for the lower wall, -1 for the upper: the way back inside.
    pub inward: f32,
    /// The impulse divided by the ball's mass, never negative.
    pub push: f32,
}

/// The contacts of a substep, with the impulses that those that last had in the substep before.
/// Their order depends on the balls alone, not on the order in which a broad phase found them.
#[derive(Clone, Debug, Default)]
pub struct Contacts<const D: usize> {
    /// From the top down, as gravity sees it; those on one level by their indices.
    pub balls: Vec<Contact<D>>,
    /// By index and axis.
    pub walls: Vec<WallContact>,
    /// Where in `balls` each contact is, the contacts sorted by their indices.
    places: Vec<u32>,
    /// The pairs of the substep before and their impulses, sorted by their indices.
    before: Vec<([u32; 2], f32)>,
    walls_before: Vec<WallContact>,
    touching: Vec<[u32; 2]>,
    level_order: LevelOrder,
}

/// What the narrow phase must know beside pairs and balls.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings<const D: usize> {
    /// The walls.
    pub bounds: Aabb<D>,
    /// Which way is down.
    pub gravity: [f32; D],
    /// How long the substep is.
    pub time: f32,
}

/// How near to a wall a ball touches it, in radii. A ball at rest on the floor stays a contact
/// although its position is rounded.
const WALL_MARGIN: f32 = 0.01;

impl<const D: usize> Contacts<D> {
    /// Finds the contacts among `pairs`, which are sorted by their indices, and at the walls.
    pub fn find(&mut self, pairs: &[[u32; 2]], bodies: &Bodies<D>, around: &Surroundings<D>) {
        let balls = self.places.iter().map(|&place| &self.balls[place as usize]);
        self.before.clear();
        self.before.extend(balls.map(|contact| (contact.pair, contact.impulse)));
        std::mem::swap(&mut self.walls, &mut self.walls_before);
        self.touching.clear();
        self.touching.extend(pairs.iter().filter(|&&pair| touch(pair, bodies, around.time)));

        let height = |[a, b]: [u32; 2]| {
            let (a, b) = (bodies.positions[a as usize], bodies.positions[b as usize]);
            -dot(around.gravity, a) - dot(around.gravity, b)
        };
        let heights = self.touching.iter().map(|&pair| height(pair));
        self.level_order.sort(heights, &mut self.places);

        let mut before = self.before.iter().peekable();
        self.balls.resize(self.touching.len(), Contact::NONE);
        for (&pair, &place) in self.touching.iter().zip(&self.places) {
            while before.next_if(|(old, _)| *old < pair).is_some() {}
            let impulse = before.next_if(|(old, _)| *old == pair).map_or(0.0, |&(_, old)| old);
            self.balls[place as usize] = contact(pair, impulse, bodies, around.time);
        }

        find_walls(bodies, &around.bounds, &mut self.walls);
        let key = |wall: &WallContact| (wall.body, wall.axis);
        let mut before = self.walls_before.iter().peekable();
        for wall in &mut self.walls {
            while before.next_if(|old| key(old) < key(wall)).is_some() {}
            if let Some(old) = before.next_if(|old| key(old) == key(wall)) {
                wall.push = if old.inward == wall.inward { old.push } else { 0.0 };
            }
        }
    }

    /// Forgets the contacts of balls with each other.
    pub fn part_balls(&mut self) {
        self.balls.clear();
        self.places.clear();
    }
}

impl<const D: usize> Contact<D> {
    /// To fill an array with.
    const NONE: Self = Self { pair: [0; 2], normal: [0.0; D], slack: 0.0, mass: 0.0, impulse: 0.0 };
}

/// The exact test: whether two balls touch now, or will before `time` has passed if nothing
/// changes their velocities. Closed, as the boxes are.
#[inline]
fn touch<const D: usize>([a, b]: [u32; 2], bodies: &Bodies<D>, time: f32) -> bool {
    let (a, b) = (a as usize, b as usize);
    let reach = bodies.radii[a] + bodies.radii[b];
    let apart = difference(bodies.positions[b], bodies.positions[a]);
    let gap = dot(apart, apart) - reach * reach;
    if gap <= 0.0 {
        return true;
    }
    // The square of the distance is a parabola in time; its least value decides.
    let velocity = difference(bodies.velocities[b], bodies.velocities[a]);
    let slope = dot(apart, velocity);
    let curvature = dot(velocity, velocity);
    if slope >= 0.0 {
        false
    } else if -slope >= curvature * time {
        gap + (slope * 2.0 + curvature * time) * time <= 0.0
    } else {
        gap * curvature <= slope * slope
    }
}

fn contact<const D: usize>(
    pair: [u32; 2],
    impulse: f32,
    bodies: &Bodies<D>,
    time: f32,
) -> Contact<D> {
    let [a, b] = pair.map(|id| id as usize);
    let (normal, distance) = normal_and_distance(pair, bodies);
    let gap = distance - bodies.radii[a] - bodies.radii[b];
    let slack = if gap > 0.0 { gap / time } else { 0.0 };
    let mass = 1.0 / (bodies.inverse_masses[a] + bodies.inverse_masses[b]);
    Contact { pair, normal, slack, mass, impulse }
}

/// The unit vector from the first centre to the second, and how far apart they are.
///
/// Coincident centres have no direction between them; they get an axis by their indices, so that
/// many in one place do not all leave along one line.
#[inline]
pub fn normal_and_distance<const D: usize>(
    [a, b]: [u32; 2],
    bodies: &Bodies<D>,
) -> ([f32; D], f32) {
    let apart = difference(bodies.positions[b as usize], bodies.positions[a as usize]);
    let square = dot(apart, apart);
    // Below this the square is subnormal, or was rounded to nothing.
    if square < 1e-30 {
        let mut normal = [0.0; D];
        let direction = a.wrapping_add(b) as usize % (2 * D);
        normal[direction / 2] = if direction.is_multiple_of(2) { 1.0 } else { -1.0 };
        return (normal, 0.0);
    }
    let distance = square.sqrt();
    (apart.map(|x| x / distance), distance)
}

/// Balls at walls, in the order of their indices and then of the axes.
fn find_walls<const D: usize>(bodies: &Bodies<D>, bounds: &Aabb<D>, walls: &mut Vec<WallContact>) {
    walls.clear();
    for (body, (position, &radius)) in (0..).zip(bodies.positions.iter().zip(&bodies.radii)) {
        let reach = radius + radius * WALL_MARGIN;
        // Most are at none: that is one branch a ball, and guessed right.
        let is_near = (0..D).fold(false, |near, axis| {
            let at = position[axis];
            near | (at - bounds.min[axis] <= reach) | (bounds.max[axis] - at <= reach)
        });
        if !is_near {
            continue;
        }
        for (axis, &at) in position.iter().enumerate() {
            let mut touch = |inward| {
                walls.push(WallContact { body, axis: axis as u32, inward, push: 0.0 });
            };
            if at - bounds.min[axis] <= reach {
                touch(1.0);
            } else if bounds.max[axis] - at <= reach {
                touch(-1.0);
            }
        }
    }
}
