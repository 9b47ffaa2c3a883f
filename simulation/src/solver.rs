//! What contacts do to balls: bounce, rest, and give way. The crate's front page says why so.

use crate::bodies::{Bodies, inside_walls};
use crate::contacts::{Contact, Contacts, Surroundings, WallContact, normal_and_distance};
use crate::vector::{add_scaled, difference, dot, lesser};

/// How often a bounce is passed on within one substep, from ball to ball.
const BOUNCE_PASSES: usize = 4;
/// Sweeps of the resting solver: up and down twice.
const REST_SWEEPS: usize = 4;
/// Sweeps of the projection: up and down twice.
const PROJECT_SWEEPS: usize = 4;
/// The share of an overlap that one sweep takes away.
const PROJECT_SHARE: f32 = 0.6;
/// The overlap that is left alone, in radii of the smaller ball: so contacts at rest last.
const SLOP: f32 = 0.01;

/// Bounces all that meet faster than `threshold`: each impulse turns the speed of approach into
/// `restitution` times as much speed of parting.
///
/// Each impulse by itself keeps momentum and, with restitution at most 1, adds no energy; so
/// neither does any number of them, one after another.
pub fn bounce<const D: usize>(
    contacts: &Contacts<D>,
    bodies: &mut Bodies<D>,
    restitution: f32,
    threshold: f32,
) {
    for _ in 0..BOUNCE_PASSES {
        let mut quiet = true;
        for contact in &contacts.balls {
            let speed = speed_of_parting(contact, bodies);
            if speed < -threshold && speed < -contact.slack {
                let impulse = -(1.0 + restitution) * speed * contact.mass;
                push_apart(contact, impulse, bodies);
                quiet = false;
            }
        }
        for wall in &contacts.walls {
            let speed = speed_from_wall(wall, bodies);
            if *speed * wall.inward < -threshold {
                *speed *= -restitution;
                quiet = false;
            }
        }
        if quiet {
            break;
        }
    }
}

/// Lets no two that touch approach each other: the smallest change of velocities, measured in
/// energy, after which no contact closes (projected Gauss-Seidel on the contact impulses).
///
/// It starts from the impulses of the substep before, as far as they bring that minimum nearer.
/// Each correction brings it nearer still; so none of this ever adds energy, converged or not.
pub fn rest<const D: usize>(
    contacts: &mut Contacts<D>,
    bodies: &mut Bodies<D>,
    velocities_before: &mut Vec<[f32; D]>,
) {
    velocities_before.clone_from(&bodies.velocities);
    for contact in &contacts.balls {
        push_apart(contact, contact.impulse, bodies);
    }
    for wall in &contacts.walls {
        *speed_from_wall(wall, bodies) += wall.inward * wall.push;
    }
    let slack: f64 = contacts
        .balls
        .iter()
        .map(|contact| f64::from(contact.impulse) * f64::from(contact.slack))
        .sum();
    let share = share_of_least_energy(bodies, velocities_before, slack);
    if share < 1.0 {
        for (velocity, before) in bodies.velocities.iter_mut().zip(velocities_before) {
            let change = difference(*velocity, *before);
            *velocity = *before;
            add_scaled(velocity, change, share);
        }
        contacts.balls.iter_mut().for_each(|contact| contact.impulse *= share);
        contacts.walls.iter_mut().for_each(|wall| wall.push *= share);
    }

    for sweep in 0..REST_SWEEPS {
        let hold = |contact: &mut Contact<D>| hold_apart(contact, bodies);
        up_and_down(sweep, contacts.balls.iter_mut(), hold);
        for wall in &mut contacts.walls {
            let speed = speed_from_wall(wall, bodies);
            let push = at_least_zero(wall.push - *speed * wall.inward);
            *speed += wall.inward * (push - wall.push);
            wall.push = push;
        }
    }
}

/// Corrects the impulse of one contact: as much as it takes, as little as it can be.
#[inline]
fn hold_apart<const D: usize>(contact: &mut Contact<D>, bodies: &mut Bodies<D>) {
    let speed = speed_of_parting(contact, bodies) + contact.slack;
    let impulse = at_least_zero(contact.impulse - speed * contact.mass);
    push_apart(contact, impulse - contact.impulse, bodies);
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

/// Between the velocities `before` (0) and now (1), where what the resting solver minimizes is
/// least: it is a parabola on the way. `slack` is what the slack of the contacts adds to its slope.
fn share_of_least_energy<const D: usize>(
    bodies: &Bodies<D>,
    before: &[[f32; D]],
    slack: f64,
) -> f32 {
    let (mut slope, mut curvature) = (slack, 0.0);
    for ((velocity, before), &mass) in bodies.velocities.iter().zip(before).zip(&bodies.masses) {
        let change = difference(*velocity, *before);
        slope += f64::from(dot(*before, change) * mass);
        curvature += f64::from(dot(change, change) * mass);
    }
    if slope < 0.0 { lesser((-slope / curvature) as f32, 1.0) } else { 0.0 }
}

/// Moves balls that overlap apart, and back inside the walls, without touching velocities.
///
/// The centre of mass of two balls stays where it is, so in uniform gravity moving them apart
/// costs no energy; but moving a heap off the floor lifts it. What that adds must not exceed
/// `allowance`, per unit of mass: else the balls are moved only that part of the way.
pub fn project<const D: usize>(
    contacts: &Contacts<D>,
    bodies: &mut Bodies<D>,
    around: &Surroundings<D>,
    allowance: f64,
    positions_before: &mut Vec<[f32; D]>,
) {
    positions_before.clone_from(&bodies.positions);
    let potential_before = bodies.potential_energy(around.gravity, &around.bounds);
    for sweep in 0..PROJECT_SWEEPS {
        let part = |contact: &Contact<D>| move_apart(contact, bodies);
        up_and_down(sweep, contacts.balls.iter(), part);
        for (position, &radius) in bodies.positions.iter_mut().zip(&bodies.radii) {
            for (axis, at) in position.iter_mut().enumerate() {
                *at = inside_walls(*at, radius, &around.bounds, axis);
            }
        }
    }
    let lift = bodies.potential_energy(around.gravity, &around.bounds) - potential_before;
    if lift > 0.0 && lift > allowance {
        // The potential energy is linear in the positions, and the inside of a box is convex.
        let share = if allowance > 0.0 { (allowance / lift) as f32 } else { 0.0 };
        for ((position, before), &radius) in
            bodies.positions.iter_mut().zip(positions_before).zip(&bodies.radii)
        {
            for axis in 0..D {
                let at = before[axis] + (position[axis] - before[axis]) * share;
                position[axis] = inside_walls(at, radius, &around.bounds, axis);
            }
        }
    }
}

/// Takes away part of the overlap of two balls.
#[inline]
fn move_apart<const D: usize>(contact: &Contact<D>, bodies: &mut Bodies<D>) {
    let [a, b] = contact.pair.map(|id| id as usize);
    let (radius_a, radius_b) = (bodies.radii[a], bodies.radii[b]);
    let reach = radius_a + radius_b - SLOP * lesser(radius_a, radius_b);
    let apart = difference(bodies.positions[b], bodies.positions[a]);
    if dot(apart, apart) < reach * reach {
        let (normal, distance) = normal_and_distance(contact.pair, bodies);
        let share = at_least_zero(reach - distance) * PROJECT_SHARE * contact.mass;
        add_scaled(&mut bodies.positions[a], normal, -share * bodies.inverse_masses[a]);
        add_scaled(&mut bodies.positions[b], normal, share * bodies.inverse_masses[b]);
    }
}

/// How fast two balls part; negative if they approach.
#[inline]
fn speed_of_parting<const D: usize>(contact: &Contact<D>, bodies: &Bodies<D>) -> f32 {
    let [a, b] = contact.pair.map(|id| bodies.velocities[id as usize]);
    dot(difference(b, a), contact.normal)
}

#[inline]
fn push_apart<const D: usize>(contact: &Contact<D>, impulse: f32, bodies: &mut Bodies<D>) {
    let [a, b] = contact.pair.map(|id| id as usize);
    add_scaled(&mut bodies.velocities[a], contact.normal, -impulse * bodies.inverse_masses[a]);
    add_scaled(&mut bodies.velocities[b], contact.normal, impulse * bodies.inverse_masses[b]);
}

/// The velocity across the wall; along `inward` it parts from the wall.
#[inline]
fn speed_from_wall<'a, const D: usize>(
    wall: &WallContact,
    bodies: &'a mut Bodies<D>,
) -> &'a mut f32 {
    &mut bodies.velocities[wall.body as usize][wall.axis as usize]
}

#[inline]
fn at_least_zero(x: f32) -> f32 {
    if x > 0.0 { x } else { 0.0 }
}
