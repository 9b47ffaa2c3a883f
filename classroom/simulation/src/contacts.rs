//! The narrow phase: which of the pairs of boxes are pairs of balls that touch.

use sweep_and_prune::Aabb;

use crate::bodies::Bodies;
use crate::order::LevelOrder;
use crate::rows::Rows;
use crate::vector::{Row, dot};

/// Two balls that touch, or will before the substep ends.
#[derive(Clone, Copy, Debug, Default)]
pub struct Contact {
    /// The unit vector from the first ball towards the second, and last 0.
    pub normal: Row,
    /// The balls, smaller index first.
    pub pair: [u32; 2],
    /// 1/m₀ and 1/m₁.
    pub inverse_masses: [f32; 2],
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

/// The contacts of a substep. A contact that the substep before had, too, begins with its impulse. The order of the
/// contacts depends on the balls alone, not on the order in which a broad phase found them.
#[derive(Clone, Debug, Default)]
pub struct Contacts {
    /// From the top down, as gravity sees it; those on one level by their indices.
    pub balls: Vec<Contact>,
    /// By index and axis.
    pub walls: Vec<WallContact>,
    /// Where in `balls` each contact is, the contacts sorted by their indices.
    places: Vec<u32>,
    /// The pairs of the substep before and their impulses, sorted by their indices.
    before: Vec<(u64, f32)>,
    walls_before: Vec<WallContact>,
    /// The balls of the contacts, sorted.
    touching: Vec<[u32; 2]>,
    /// By ball.
    depths: Vec<f32>,
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

/// A ball touches a wall if it is at most this near, in radii. So a ball at rest on the floor stays a contact
/// although its position is rounded.
const WALL_MARGIN: f32 = 0.01;

impl Contacts {
    /// Finds the contacts among `pairs`, which are sorted by their indices, and at the walls. `rows` holds the balls where
    /// they are now.
    pub fn find<const D: usize>(
        &mut self,
        pairs: &[[u32; 2]],
        bodies: &Bodies<D>,
        rows: &Rows,
        around: &Surroundings<D>,
    ) {
        let balls = self.places.iter().map(|&place| &self.balls[place as usize]);
        self.before.clear();
        self.before.extend(balls.map(|contact| (key(contact.pair), contact.impulse)));
        std::mem::swap(&mut self.walls, &mut self.walls_before);

        // Each is written, and counts only if it touches. About half do, so a branch would often be mispredicted.
        self.touching.resize(pairs.len(), [0; 2]);
        let mut count = 0;
        for &pair in pairs {
            self.touching[count] = pair;
            count += usize::from(touch::<D>(pair, rows, around.time));
        }
        self.touching.truncate(count);

        self.depths.clear();
        self.depths.extend(bodies.positions.iter().map(|&at| dot(around.gravity, at)));
        let height = |&[a, b]: &[u32; 2]| -self.depths[a as usize] - self.depths[b as usize];
        self.level_order.sort(self.touching.iter().map(height), &mut self.places);

        let mut before = self.before.iter().peekable();
        self.balls.resize(self.touching.len(), Contact::default());
        for (&pair, &place) in self.touching.iter().zip(&self.places) {
            let key = key(pair);
            while before.next_if(|(old, _)| *old < key).is_some() {}
            let impulse = before.next_if(|(old, _)| *old == key).map_or(0.0, |&(_, old)| old);
            self.balls[place as usize] = contact(pair, impulse, bodies, rows, around.time);
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

    /// The balls that touch each other.
    pub fn touching(&self) -> &[[u32; 2]] {
        &self.touching
    }

    /// Forgets the contacts of balls with each other.
    pub fn part_balls(&mut self) {
        self.touching.clear();
        self.balls.clear();
        self.places.clear();
    }
}

/// One number for a pair, in the order of its indices.
#[inline]
fn key([a, b]: [u32; 2]) -> u64 {
    u64::from(a) << 32 | u64::from(b)
}

/// The exact test: whether two balls touch now, or will before `time` has passed if nothing
/// changes their velocities. Closed, as the boxes are. Without a branch.
#[inline]
fn touch<const D: usize>(pair: [u32; 2], rows: &Rows, time: f32) -> bool {
    let [a, b] = pair.map(|id| id as usize);
    let [at_a, at_b] = [&rows.places[a], &rows.places[b]];
    let reach = at_a.0[3] + at_b.0[3];
    let apart = at_b.minus(at_a);
    let gap = apart.dot::<D>(&apart) - reach * reach;
    // The square of the distance is a parabola in time; its least value decides.
    let velocity = rows.velocities[b].minus(&rows.velocities[a]);
    let slope = apart.dot::<D>(&velocity);
    let curvature = velocity.dot::<D>(&velocity);
    let is_least_at_end = -slope >= curvature * time;
    let touches_at_end = gap + (slope * 2.0 + curvature * time) * time <= 0.0;
    let touches_before = gap * curvature <= slope * slope;
    let will = (is_least_at_end & touches_at_end) | (!is_least_at_end & touches_before);
    (gap <= 0.0) | ((slope < 0.0) & will)
}

fn contact<const D: usize>(
    pair: [u32; 2],
    impulse: f32,
    bodies: &Bodies<D>,
    rows: &Rows,
    time: f32,
) -> Contact {
    let [a, b] = pair.map(|id| id as usize);
    let (normal, distance) = normal_and_distance::<D>(pair, &rows.places);
    let gap = distance - rows.places[a].0[3] - rows.places[b].0[3];
    let slack = if gap > 0.0 { gap / time } else { 0.0 };
    let inverse_masses = [bodies.inverse_masses[a], bodies.inverse_masses[b]];
    let mass = 1.0 / (inverse_masses[0] + inverse_masses[1]);
    Contact { normal, pair, inverse_masses, slack, mass, impulse }
}

/// The unit vector from the first center to the second, last 0, and how far apart they are.
///
/// Coincident centers have no direction between them; they get an axis by their indices, so that
/// many in one place do not all leave along one line.
#[inline]
pub fn normal_and_distance<const D: usize>([a, b]: [u32; 2], places: &[Row]) -> (Row, f32) {
    let apart = Row::new(places[b as usize].minus(&places[a as usize]).vector::<D>(), 0.0);
    let square = apart.dot::<D>(&apart);
    // Below this the square is subnormal, or was rounded to zero.
    if square < 1e-30 {
        let mut normal = [0.0; D];
        let direction = a.wrapping_add(b) as usize % (2 * D);
        normal[direction / 2] = if direction.is_multiple_of(2) { 1.0 } else { -1.0 };
        return (Row::new(normal, 0.0), 0.0);
    }
    let distance = square.sqrt();
    (Row(apart.0.map(|x| x / distance)), distance)
}

/// Balls at walls, in the order of their indices and then of the axes.
fn find_walls<const D: usize>(bodies: &Bodies<D>, bounds: &Aabb<D>, walls: &mut Vec<WallContact>) {
    walls.clear();
    for (body, (position, &radius)) in (0..).zip(bodies.positions.iter().zip(&bodies.radii)) {
        let reach = radius + radius * WALL_MARGIN;
        // Most balls are at no wall: that is one branch for each ball, and it is predicted.
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
