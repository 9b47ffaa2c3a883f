//! Scenes of the sizes of games, and those of Avian's own tests. They run in release builds if the
//! variable `TEST_LONG` is set.

use bevy::prelude::*;

use super::avian::prelude::*;
use super::oracle::Both;
use super::scenes::{Layer, at, ground, place, run, velocity};
use super::{Vector, cuboid};
use crate::support::Random;

/// Both broad phases in a world without gravity, if long tests run.
fn weightless() -> Option<(Both, Random)> {
    std::env::var_os("TEST_LONG").filter(|_| !cfg!(debug_assertions))?;
    let mut both = Both::new::<()>();
    both.world().insert_resource(Gravity(Vector::ZERO));
    Some((both, Random(6)))
}

/// Cubes in a row or a cube of places, as many along each axis, this far apart.
fn stack(both: &mut Both, count: u16, width: f32, height: f32, side: f32) {
    ground(both.world());
    for index in 0..count * count * count {
        let [x, y, z] = [index % count, index / count % count, index / count / count];
        let [x, z] = [x, z].map(|at| (f32::from(at) - f32::from(count) * 0.5) * width);
        let cube = at(x, 0.5 * side + f32::from(y) * height, z);
        both.world().spawn((RigidBody::Dynamic, cuboid([side; 3]), cube));
    }
}

#[test]
fn a_thousand_bodies_among_a_hundred_thousand_static_ones() {
    let Some((mut both, mut random)) = weightless() else { return };
    for tile in 0..100_000_u32 {
        let [x, y] = [tile % 320, tile / 320].map(|at| at as f32 - 160.0);
        both.world().spawn((RigidBody::Static, cuboid([1.0; 3]), at(x, y, 0.0)));
    }
    for _ in 0..1_000 {
        let body = (RigidBody::Dynamic, cuboid([0.5; 3]), place(&mut random, 150.0));
        both.world().spawn((body, LinearVelocity(velocity(&mut random, 20.0, 20.0))));
    }
    run(both, 20, |_, _| {});
}

#[test]
fn twenty_thousand_sensors() {
    let Some((mut both, mut random)) = weightless() else { return };
    for _ in 0..20_000 {
        let body = (RigidBody::Kinematic, cuboid([1.0; 3]), place(&mut random, 60.0));
        let velocity = LinearVelocity(velocity(&mut random, 10.0, 10.0));
        both.world().spawn((body, Sensor, velocity));
    }
    run(both, 20, |_, _| {});
}

#[test]
fn fifty_thousand_bullets_and_a_hundred_targets() {
    let Some((mut both, mut random)) = weightless() else { return };
    for _ in 0..100 {
        let layers = CollisionLayers::new(Layer::Enemy, LayerMask::ALL);
        both.world().spawn((
            RigidBody::Kinematic,
            cuboid([4.0; 3]),
            place(&mut random, 100.0),
            layers,
        ));
    }
    for _ in 0..50_000 {
        let layers = CollisionLayers::new(Layer::Bullet, [Layer::Enemy]);
        let body = (RigidBody::Dynamic, cuboid([0.2; 3]), place(&mut random, 100.0), layers);
        both.world().spawn((body, LinearVelocity(velocity(&mut random, 60.0, 60.0))));
    }
    run(both, 20, |_, _| {});
}

#[test]
fn ten_thousand_cubes_fall() {
    let Some((mut both, _)) = weightless() else { return };
    both.world().insert_resource(Gravity::default());
    stack(&mut both, 22, 1.1, 1.3, 1.0);
    run(both, 60, |_, _| {});
}

/// The scene of `cubes_simulation_is_locally_deterministic` in Avian.
#[test]
fn the_cubes_of_avian() {
    let Some((mut both, _)) = weightless() else { return };
    both.world().insert_resource(Gravity::default());
    stack(&mut both, 4, 2.1, 10.0, 2.0);
    run(both, 300, |_, _| {});
}

/// The scene of Avian's `determinism_2d`: leaning columns in which every two are joined and do not collide.
#[test]
fn the_joined_columns_of_avian() {
    let Some((mut both, _)) = weightless() else { return };
    both.world().insert_resource(Gravity::default());
    ground(both.world());
    for column in 0..15_u8 {
        let mut below = None;
        for row in 0..30_u8 {
            let [column, row] = [column, row].map(f32::from);
            let turned = Quat::from_rotation_z(0.1 * row - 1.0);
            let place = at(2.5 * column - 17.5 + 0.1 * row, 0.25 + 0.5 * row, 0.0);
            let square = (RigidBody::Dynamic, cuboid([0.5; 3]), place.with_rotation(turned));
            let square = both.world().spawn(square).id();
            below = match below {
                None => Some(square),
                Some(below) => {
                    let joint = RevoluteJoint::new(below, square);
                    both.world().spawn((joint, JointCollisionDisabled));
                    None
                }
            };
        }
    }
    run(both, 200, |_, _| {});
}
