//! The narrow phase: which of the pairs of boxes are pairs of balls that touch.

use sweep_and_prune::Aabb;

use crate::bodies::Bodies;
use crate::vector::{difference, dot};

/// Two balls that touch.
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

/// The contacts of a substep. They are in the order of their indices, whatever the order in which
/// the broad phase found the pairs, and remember their impulses of the substep before.
#[derive(Clone, Debug)]
pub struct Contacts<const D: usize> {
    pub balls: Vec<Contact<D>>,
    pub walls: Vec<WallContact>,
    balls_before: Vec<Contact<D>>,
    walls_before: Vec<WallContact>,
    order: PairOrder,
}

/// How near to a wall a ball touches it, in radii. A ball at rest on the floor stays a contact
/// although its position is rounded.
const WALL_MARGIN: f32 = 0.01;

impl<const D: usize> Contacts<D> {
    pub fn new() -> Self {
        Self {
            balls: Vec::new(),
            walls: Vec::new(),
            balls_before: Vec::new(),
            walls_before: Vec::new(),
            order: PairOrder::default(),
        }
    }

    /// Finds the contacts among `pairs`, in any order, and at the walls.
    pub fn find(
        &mut self,
        pairs: &[[u32; 2]],
        bodies: &Bodies<D>,
        time: f32,
        bounds: &Aabb<D>,
    ) {
        std::mem::swap(&mut self.balls, &mut self.balls_before);
        std::mem::swap(&mut self.walls, &mut self.walls_before);
        self.balls.clear();
        let touching = pairs.iter().copied().filter(|&pair| touch(pair, bodies, time));
        let sorted = self.order.sort(touching, bodies.len());
        self.balls.extend(sorted.iter().map(|&pair| contact(pair, bodies, time)));
        find_walls(bodies, bounds, &mut self.walls);
        self.remember_impulses();
    }

    /// Both lists are sorted: one walk along each finds the contacts that last.
    fn remember_impulses(&mut self) {
        let mut before = self.balls_before.iter().peekable();
        for contact in &mut self.balls {
            while before.next_if(|old| old.pair < contact.pair).is_some() {}
            if let Some(old) = before.next_if(|old| old.pair == contact.pair) {
                contact.impulse = old.impulse;
            }
        }
        let key = |wall: &WallContact| (wall.body, wall.axis);
        let mut before = self.walls_before.iter().peekable();
        for wall in &mut self.walls {
            while before.next_if(|old| key(old) < key(wall)).is_some() {}
            if let Some(old) = before.next_if(|old| key(old) == key(wall)) {
                wall.push = if old.inward == wall.inward { old.push } else { 0.0 };
            }
        }
    }
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

fn contact<const D: usize>(pair: [u32; 2], bodies: &Bodies<D>, time: f32) -> Contact<D> {
    let [a, b] = pair.map(|id| id as usize);
    let (normal, distance) = normal_and_distance(pair, bodies);
    let gap = distance - bodies.radii[a] - bodies.radii[b];
    let slack = if gap > 0.0 { gap / time } else { 0.0 };
    let mass = 1.0 / (bodies.inverse_masses[a] + bodies.inverse_masses[b]);
    Contact { pair, normal, slack, mass, impulse: 0.0 }
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
        normal[direction / 2] = if direction % 2 == 0 { 1.0 } else { -1.0 };
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
        for axis in 0..D {
            let mut touch = |inward| {
                walls.push(WallContact { body, axis: axis as u32, inward, push: 0.0 });
            };
            if position[axis] - bounds.min[axis] <= reach {
                touch(1.0);
            } else if bounds.max[axis] - position[axis] <= reach {
                touch(-1.0);
            }
        }
    }
}

/// Sorts pairs by (a, b): counted into one bucket an `a`, each bucket then sorted by `b`.
#[derive(Clone, Debug, Default)]
struct PairOrder {
    unsorted: Vec<[u32; 2]>,
    sorted: Vec<[u32; 2]>,
    ends: Vec<u32>,
}

impl PairOrder {
    /// The pairs of indices below `n`, sorted. O(n + pairs) for few pairs a body.
    fn sort(&mut self, pairs: impl Iterator<Item = [u32; 2]>, n: usize) -> &[[u32; 2]] {
        self.unsorted.clear();
        self.unsorted.extend(pairs);
        if self.unsorted.is_sorted() {
            return &self.unsorted;
        }
        self.ends.clear();
        self.ends.resize(n + 1, 0);
        for &[a, _] in &self.unsorted {
            self.ends[a as usize + 1] += 1;
        }
        for a in 0..n {
            self.ends[a + 1] += self.ends[a];
        }
        self.sorted.resize(self.unsorted.len(), [0; 2]);
        // While scattering, `ends[a]` is where the next of bucket `a` goes, and so ends as its end.
        for &pair in &self.unsorted {
            let place = &mut self.ends[pair[0] as usize];
            self.sorted[*place as usize] = pair;
            *place += 1;
        }
        let mut start = 0;
        for &end in &self.ends[..n] {
            self.sorted[start..end as usize].sort_unstable();
            start = end as usize;
        }
        &self.sorted
    }
}
