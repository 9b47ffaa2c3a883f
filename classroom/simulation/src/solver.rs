//! What contacts do to balls: bounce, rest, and give way. The documentation of the crate says why.

use crate::bodies::{Bodies, inside_walls};
use crate::contacts::{Contact, Contacts, Surroundings, WallContact, normal_and_distance};
use crate::rows::Rows;
use crate::vector::{Row, add_scaled, difference, dot, greater, lesser};

/// How often a bounce is passed on within one substep, from ball to ball.
const BOUNCE_PASSES: u8 = 4;
/// Sweeps of the resting solver: up and down twice.
const REST_SWEEPS: usize = 4;
/// Sweeps of the projection: up and down twice.
const PROJECT_SWEEPS: usize = 4;
/// The share of an overlap that one sweep takes away.
const PROJECT_SHARE: f32 = 0.6;
/// The overlap that is not corrected, in radii of the smaller ball, so that contacts at rest persist.
const SLOP: f32 = 0.01;

/// Bounces all balls that meet faster than `threshold`: each impulse turns the speed of approach into
/// `restitution` times that speed of separation.
///
/// Each impulse by itself keeps momentum and, with restitution at most 1, adds no energy; so
/// neither does any number of them, one after another.
///
/// Two balls whose velocities have not changed since they were tested would not bounce now either, so they are skipped:
/// `last` holds for each ball the pass in which it last changed.
pub fn bounce<const D: usize>(
    contacts: &Contacts,
    velocities: &mut [Row],
    restitution: f32,
    threshold: f32,
    last: &mut Vec<u8>,
) {
    last.clear();
    last.resize(velocities.len(), 0);
    for pass in 1..=BOUNCE_PASSES {
        let mut quiet = true;
        for contact in &contacts.balls {
            let [a, b] = contact.pair.map(|id| id as usize);
            if pass > 1 && last[a].max(last[b]) < pass - 1 {
                continue;
            }
            let speed = speed_of_parting::<D>(contact, velocities);
            if speed < -threshold && speed < -contact.slack {
                let impulse = -(1.0 + restitution) * speed * contact.mass;
                push_apart(contact, impulse, velocities);
                (last[a], last[b]) = (pass, pass);
                quiet = false;
            }
        }
        for wall in &contacts.walls {
            let speed = speed_from_wall(wall, velocities);
            if *speed * wall.inward < -threshold {
                *speed *= -restitution;
                last[wall.body as usize] = pass;
                quiet = false;
            }
        }
        if quiet {
            break;
        }
    }
}

/// Stops touching balls from approaching each other, by the smallest change of velocities, measured in energy, after which
/// no contact closes (projected Gauss-Seidel on the contact impulses).
///
/// The solver starts from the impulses of the substep before, scaled to bring that minimum nearest. Each correction brings it
/// nearer still, so energy is never added, whether the solver converges or not.
///
/// `velocities` are the velocities of the balls before, and are changed to those after it.
pub fn rest<const D: usize>(contacts: &mut Contacts, bodies: &Bodies<D>, velocities: &mut [Row]) {
    for contact in &contacts.balls {
        push_apart(contact, contact.impulse, velocities);
    }
    for wall in &contacts.walls {
        *speed_from_wall(wall, velocities) += wall.inward * wall.push;
    }
    let slack: f64 = contacts
        .balls
        .iter()
        .map(|contact| f64::from(contact.impulse) * f64::from(contact.slack))
        .sum();
    let share = share_of_least_energy(bodies, velocities, slack);
    if share < 1.0 {
        for (row, &before) in velocities.iter_mut().zip(&bodies.velocities) {
            let change = difference(row.vector(), before);
            let mut velocity = before;
            add_scaled(&mut velocity, change, share);
            *row = Row::new(velocity, 0.0);
        }
        contacts.balls.iter_mut().for_each(|contact| contact.impulse *= share);
        contacts.walls.iter_mut().for_each(|wall| wall.push *= share);
    }

    for sweep in 0..REST_SWEEPS {
        let hold = |contact: &mut Contact| hold_apart::<D>(contact, velocities);
        up_and_down(sweep, contacts.balls.iter_mut(), hold);
        for wall in &mut contacts.walls {
            let speed = speed_from_wall(wall, velocities);
            let push = at_least_zero(wall.push - *speed * wall.inward);
            *speed += wall.inward * (push - wall.push);
            wall.push = push;
        }
    }
}

/// Corrects the impulse of one contact: the least impulse that keeps it from closing.
#[inline]
fn hold_apart<const D: usize>(contact: &mut Contact, velocities: &mut [Row]) {
    let speed = speed_of_parting::<D>(contact, velocities) + contact.slack;
    let impulse = at_least_zero(contact.impulse - speed * contact.mass);
    push_apart(contact, impulse - contact.impulse, velocities);
    contact.impulse = impulse;
}

/// Goes through contacts that are sorted from the top down: first upwards, so that the floor
/// supports a whole heap within one sweep, then downwards, so that the floor bears its weight.
#[inline]
fn up_and_down<C>(
    sweep: usize,
    contacts: impl DoubleEndedIterator<Item = C>,
    visit: impl FnMut(C),
) {
    if sweep.is_multiple_of(2) { contacts.rev().for_each(visit) } else { contacts.for_each(visit) }
}

/// Where on the line from the velocities of the balls (0) to `after` (1) the quantity that the resting solver minimizes is
/// least: on that line it is a parabola. `slack` is what the slack of the contacts adds to its slope.
fn share_of_least_energy<const D: usize>(bodies: &Bodies<D>, after: &[Row], slack: f64) -> f32 {
    let (mut slope, mut curvature) = (slack, 0.0);
    for ((row, &before), &mass) in after.iter().zip(&bodies.velocities).zip(&bodies.masses) {
        let change = difference(row.vector(), before);
        slope += f64::from(dot(before, change) * mass);
        curvature += f64::from(dot(change, change) * mass);
    }
    if slope < 0.0 { lesser((-slope / curvature) as f32, 1.0) } else { 0.0 }
}

/// Moves balls that overlap apart, and back inside the walls, without touching velocities.
///
/// The center of mass of two balls stays where it is, so in uniform gravity moving them apart
/// costs no energy; but moving a heap off the floor lifts it. That may add at most `allowance` of energy per
/// unit of mass; otherwise the balls are moved only the part of the way that adds this much.
///
/// `rows` holds the balls where they are, and afterwards where they would be without that limit.
pub fn project<const D: usize>(
    contacts: &Contacts,
    bodies: &mut Bodies<D>,
    rows: &mut Rows,
    around: &Surroundings<D>,
    allowance: f64,
) {
    let places = &mut rows.places[..];
    // The last coordinate of a row, the radius, stays.
    let lowest = Row::new(around.bounds.min, f32::NEG_INFINITY);
    let highest = Row::new(around.bounds.max, f32::INFINITY);
    for sweep in 0..PROJECT_SWEEPS {
        let mut quiet = true;
        let part = |contact: &Contact| quiet &= !move_apart::<D>(contact, places);
        up_and_down(sweep, contacts.balls.iter(), part);
        if quiet {
            // All are inside the walls already.
            if sweep == 0 {
                return;
            }
            break;
        }
        for Row(place) in &mut *places {
            let radius = place[3];
            for (axis, at) in place.iter_mut().enumerate() {
                let below_top = lesser(*at, highest.0[axis] - radius);
                *at = greater(below_top, lowest.0[axis] + radius);
            }
        }
    }
    let potential_before = bodies.potential_energy(around.gravity, &around.bounds);
    let potential =
        bodies.potential_energy_at(|ball| places[ball].vector(), around.gravity, &around.bounds);
    let lift = potential - potential_before;
    if lift > 0.0 && lift > allowance {
        // The potential energy is linear in the positions, and the inside of a box is convex.
        let share = if allowance > 0.0 { (allowance / lift) as f32 } else { 0.0 };
        for ((position, after), &radius) in
            bodies.positions.iter_mut().zip(places).zip(&bodies.radii)
        {
            for (axis, at) in position.iter_mut().enumerate() {
                let part_of_way = *at + (after.0[axis] - *at) * share;
                *at = inside_walls(part_of_way, radius, &around.bounds, axis);
            }
        }
    } else {
        for (position, after) in bodies.positions.iter_mut().zip(places) {
            *position = after.vector();
        }
    }
}

/// Takes away part of the overlap of two balls. False if they do not overlap.
#[inline]
fn move_apart<const D: usize>(contact: &Contact, places: &mut [Row]) -> bool {
    let [a, b] = contact.pair.map(|id| id as usize);
    let (radius_a, radius_b) = (places[a].0[3], places[b].0[3]);
    let reach = radius_a + radius_b - SLOP * lesser(radius_a, radius_b);
    let apart = places[b].minus(&places[a]);
    let overlap = apart.dot::<D>(&apart) < reach * reach;
    if overlap {
        let (normal, distance) = normal_and_distance::<D>(contact.pair, places);
        let share = at_least_zero(reach - distance) * PROJECT_SHARE * contact.mass;
        places[a].add_scaled(&normal, -share * contact.inverse_masses[0]);
        places[b].add_scaled(&normal, share * contact.inverse_masses[1]);
    }
    overlap
}

/// How fast two balls move apart; negative if they approach.
#[inline]
fn speed_of_parting<const D: usize>(contact: &Contact, velocities: &[Row]) -> f32 {
    let [a, b] = contact.pair.map(|id| &velocities[id as usize]);
    b.minus(a).dot::<D>(&contact.normal)
}

#[inline]
fn push_apart(contact: &Contact, impulse: f32, velocities: &mut [Row]) {
    let [a, b] = contact.pair.map(|id| id as usize);
    velocities[a].add_scaled(&contact.normal, -impulse * contact.inverse_masses[0]);
    velocities[b].add_scaled(&contact.normal, impulse * contact.inverse_masses[1]);
}

/// The velocity across the wall; the ball moves away from the wall if it has the sign of `inward`.
#[inline]
fn speed_from_wall<'a>(wall: &WallContact, velocities: &'a mut [Row]) -> &'a mut f32 {
    &mut velocities[wall.body as usize].0[wall.axis as usize]
}

#[inline]
fn at_least_zero(x: f32) -> f32 {
    if x > 0.0 { x } else { 0.0 }
}
