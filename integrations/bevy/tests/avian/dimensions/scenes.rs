//! Scenes in which both broad phases have to add the same contact pairs in each step.

use bevy::ecs::entity_disabling::Disabled;
use bevy::prelude::*;

use super::avian::prelude::*;
use super::oracle::Both;
use super::{DEPTH, Scalar, Vector, cuboid};
use crate::support::Random;

/// Makes the position of a scene one of as many dimensions as there are.
pub fn at(x: f32, y: f32, z: f32) -> Transform {
    Transform::from_xyz(x, y, z * DEPTH)
}

pub fn ground(world: &mut World) {
    world.spawn((RigidBody::Static, cuboid([100.0, 1.0, 100.0]), at(0.0, -0.5, 0.0)));
}

/// A place in a cube above the ground.
pub fn place(random: &mut Random, size: f32) -> Transform {
    at(random.between(-size, size), random.between(0.0, size), random.between(-size, size))
}

/// A velocity of up to `along` on the x-axis and up to `across` on the others.
pub fn velocity(random: &mut Random, along: f32, across: f32) -> Vector {
    let mut velocity = Vector::splat(Scalar::from(random.between(-across, across)));
    velocity.x = Scalar::from(random.between(-along, along));
    velocity
}

/// Runs the steps of a scene. `act` changes the world before each step.
pub fn run(mut both: Both, steps: usize, mut act: impl FnMut(&mut World, usize)) -> Both {
    for step in 0..steps {
        act(both.world(), step);
        both.step();
    }
    let (ran, pairs) = both.done();
    assert!(ran + 2 >= steps, "{ran} of {steps} steps");
    assert!(pairs > 0, "a scene without contacts shows nothing");
    both
}

#[test]
fn falling_cubes() {
    let mut both = Both::new::<()>();
    let mut random = Random(1);
    ground(both.world());
    for _ in 0..150 {
        let transform = place(&mut random, 6.0);
        both.world().spawn((RigidBody::Dynamic, cuboid([0.8; 3]), transform));
    }
    let both = run(both, 120, |_, _| {});
    // Pairs that end are told from pairs that Avian takes away.
    assert_eq!(both.search().counts().comparisons, 1);
}

#[test]
fn a_pyramid_of_which_one_cube_is_taken() {
    let mut both = Both::new::<()>();
    ground(both.world());
    let mut cubes = Vec::new();
    for row in 0..8_u8 {
        for column in 0..8 - row {
            let x = f32::from(column) + 0.5 * f32::from(row);
            let cube =
                (RigidBody::Dynamic, cuboid([0.9; 3]), at(x, 0.45 + 0.9 * f32::from(row), 0.0));
            cubes.push(both.world().spawn(cube).id());
        }
    }
    run(both, 100, |world, step| {
        if step == 40 {
            world.despawn(cubes[3]);
        }
    });
}

#[test]
fn static_tiles_and_what_moves_over_them() {
    let mut both = Both::new::<()>();
    both.world().insert_resource(Gravity(Vector::ZERO));
    let mut random = Random(2);
    for tile in 0..400_u16 {
        let (x, y) = (f32::from(tile % 20) - 10.0, f32::from(tile / 20) - 10.0);
        both.world().spawn((RigidBody::Static, cuboid([1.0; 3]), at(x, y, 0.0)));
    }
    for moving in 0..40 {
        let transform = place(&mut random, 9.0);
        let body = if moving % 3 == 0 { RigidBody::Kinematic } else { RigidBody::Dynamic };
        let velocity = velocity(&mut random, 8.0, 3.0);
        both.world().spawn((body, cuboid([0.3; 3]), transform, LinearVelocity(velocity)));
    }
    run(both, 80, |_, _| {});
}

#[test]
fn sensors_that_are_static_that_move_and_that_come_and_go() {
    let mut both = Both::new::<()>();
    let mut random = Random(3);
    ground(both.world());
    let bodies: Vec<_> = (0..60)
        .map(|index| {
            let body = [RigidBody::Static, RigidBody::Dynamic, RigidBody::Kinematic][index % 3];
            let transform = place(&mut random, 3.0);
            let mut entity = both.world().spawn((body, cuboid([1.0; 3]), transform));
            if index % 2 == 0 {
                entity.insert(Sensor);
            }
            if index % 5 == 0 {
                entity.insert(CollisionEventsEnabled);
            }
            entity.id()
        })
        .collect();
    run(both, 120, |world, step| {
        if step > 20 {
            let mut entity = world.entity_mut(bodies[random.below(bodies.len())]);
            match random.below(3) {
                0 => drop(entity.insert(Sensor)),
                1 => drop(entity.remove::<Sensor>()),
                _ => drop(entity.insert(place(&mut random, 3.0))),
            }
        }
    });
}

#[derive(PhysicsLayer, Default)]
pub enum Layer {
    #[default]
    Scenery,
    Bullet,
    Enemy,
}

#[test]
fn bullets_that_do_not_meet_each_other_and_live_shortly() {
    let mut both = Both::new::<()>();
    let mut random = Random(4);
    ground(both.world());
    for _ in 0..40 {
        let transform = place(&mut random, 8.0);
        let layers = CollisionLayers::new(Layer::Enemy, LayerMask::ALL);
        both.world().spawn((RigidBody::Dynamic, cuboid([1.0; 3]), transform, layers));
    }
    let mut flying = Vec::new();
    let both = run(both, 100, |world, _| {
        for _ in 0..5 {
            let layers = CollisionLayers::new(Layer::Bullet, [Layer::Enemy, Layer::Scenery]);
            let velocity = velocity(&mut random, 60.0, 30.0);
            let bullet = (RigidBody::Dynamic, cuboid([0.2; 3]), at(0.0, 4.0, 0.0), layers);
            flying.push(world.spawn((bullet, LinearVelocity(velocity), GravityScale(0.0))).id());
        }
        if flying.len() > 100 {
            for bullet in flying.drain(..5) {
                world.despawn(bullet);
            }
        }
    });
    // What comes and goes between steps is known without reading all colliders, or comparing all pairs.
    let counts = both.search().counts();
    assert_eq!((counts.full_reads, counts.comparisons), (0, 1));
    // Bullets overlap where they begin, and their layers keep these pairs from being examined.
    let (_, pairs) = both.done();
    assert!(counts.examined <= pairs as u64, "{} pairs examined, {pairs} added", counts.examined);
}

#[test]
fn joints_that_disable_collisions_until_they_do_not() {
    let mut both = Both::new::<()>();
    ground(both.world());
    let links: Vec<_> = (0..20_u8)
        .map(|link| {
            let transform = at(0.6 * f32::from(link), 3.0, 0.0);
            both.world().spawn((RigidBody::Dynamic, cuboid([0.8; 3]), transform)).id()
        })
        .collect();
    let joints: Vec<_> = links
        .windows(2)
        .map(|pair| {
            let joint = DistanceJoint::new(pair[0], pair[1]);
            both.world().spawn((joint, JointCollisionDisabled)).id()
        })
        .collect();
    run(both, 120, |world, step| {
        if step % 10 == 5 {
            world.entity_mut(joints[step / 10]).remove::<JointCollisionDisabled>();
        }
    });
}

#[test]
fn layers_that_change() {
    let mut both = Both::new::<()>();
    let mut random = Random(5);
    ground(both.world());
    let bodies: Vec<_> = (0..80)
        .map(|_| {
            let transform = place(&mut random, 4.0);
            both.world().spawn((RigidBody::Dynamic, cuboid([1.0; 3]), transform)).id()
        })
        .collect();
    run(both, 100, |world, _| {
        for _ in 0..3 {
            let bits = [random.below(8) as u32, random.below(8) as u32 | 1];
            let layers = CollisionLayers::from_bits(bits[0], bits[1]);
            world.entity_mut(bodies[random.below(bodies.len())]).insert(layers);
        }
    });
}

/// A body of one of two teams.
#[derive(Component)]
struct Team(usize);

#[derive(bevy::ecs::system::SystemParam)]
struct Teams<'w, 's> {
    teams: Query<'w, 's, &'static Team>,
}

impl CollisionHooks for Teams<'_, '_> {
    fn filter_pairs(&self, one: Entity, other: Entity, _: &mut Commands) -> bool {
        match self.teams.get_many([one, other]) {
            Ok([one, other]) => one.0 != other.0,
            _ => true,
        }
    }
}

#[test]
fn hooks_that_refuse_pairs_and_change_their_minds() {
    let mut both = Both::new::<Teams>();
    let mut random = Random(6);
    ground(both.world());
    let bodies: Vec<_> = (0..80)
        .map(|index| {
            let transform = place(&mut random, 4.0);
            let team = Team(index % 2);
            // Avian reads whether contacts are modified when it adds a collider, and not again.
            let hooks = if index % 4 == 2 {
                ActiveCollisionHooks::MODIFY_CONTACTS
            } else {
                ActiveCollisionHooks::empty()
            };
            let body = (RigidBody::Dynamic, cuboid([1.0; 3]), transform, team, hooks);
            let mut entity = both.world().spawn(body);
            if index % 4 < 2 {
                entity.insert(ActiveCollisionHooks::FILTER_PAIRS);
            }
            entity.id()
        })
        .collect();
    run(both, 120, |world, _| {
        let mut entity = world.entity_mut(bodies[random.below(bodies.len())]);
        match random.below(4) {
            0 => drop(entity.insert(ActiveCollisionHooks::FILTER_PAIRS)),
            1 => drop(entity.insert(ActiveCollisionHooks::empty())),
            _ => drop(entity.insert(Team(random.below(2)))),
        }
    });
}

#[test]
fn resting_bodies_take_no_work() {
    let mut both = Both::new::<()>();
    ground(both.world());
    for tile in 0..100_u8 {
        let (x, z) = (f32::from(tile % 10), f32::from(tile / 10));
        both.world().spawn((RigidBody::Dynamic, cuboid([0.9; 3]), at(x, 0.45 + z, z)));
    }
    let both = run(both, 200, |_, _| {});
    let before = both.search().counts();
    let both = run(both, 200, |_, _| {});
    let after = both.search().counts();
    assert_eq!(after, before);
    assert_eq!(both.search().len(), 101);
    assert_eq!((after.full_reads, after.comparisons), (0, 1));
}

#[test]
fn bodies_that_are_disabled_for_a_while() {
    let mut both = Both::new::<()>();
    let mut random = Random(8);
    ground(both.world());
    let bodies: Vec<_> = (0..60)
        .map(|_| {
            let transform = place(&mut random, 4.0);
            both.world().spawn((RigidBody::Dynamic, cuboid([1.0; 3]), transform)).id()
        })
        .collect();
    let both = run(both, 120, |world, step| {
        let mut entity = world.entity_mut(bodies[random.below(bodies.len())]);
        match step % 6 {
            0 => drop(entity.insert(Disabled)),
            1 => drop(entity.remove::<Disabled>()),
            2 => drop(entity.insert(ColliderDisabled)),
            3 => drop(entity.remove::<ColliderDisabled>()),
            4 => drop(entity.insert(RigidBodyDisabled)),
            _ => drop(entity.remove::<RigidBodyDisabled>()),
        }
    });
    assert_eq!(both.search().counts().full_reads, 0);
}

/// Which collider a system after the search of a step disables.
#[derive(Resource)]
struct DisabledNext(Option<Entity>);

/// Avian puts a collider that is disabled once more into its trees again.
#[test]
fn a_collider_that_is_disabled_once_more_after_the_search() {
    let mut both = Both::new::<()>();
    both.app.insert_resource(DisabledNext(None)).add_systems(
        PhysicsSchedule,
        (|mut commands: Commands, mut next: ResMut<DisabledNext>| {
            if let Some(collider) = next.0.take() {
                commands.entity(collider).insert(ColliderDisabled);
            }
        })
        .in_set(PhysicsStepSystems::Finalize)
        .ambiguous_with_all(),
    );
    ground(both.world());
    let resting = (RigidBody::Static, cuboid([1.0; 3]), at(0.0, 5.0, 0.0));
    let resting = both.world().spawn(resting).id();
    let moving = (RigidBody::Kinematic, Sensor, cuboid([1.0; 3]), at(50.0, 5.0, 0.0));
    let moving = both.world().spawn(moving).id();
    run(both, 40, |world, step| {
        match step {
            5 | 10 => drop(world.entity_mut(resting).insert(ColliderDisabled)),
            // A disabled collider stays in its tree until it is disabled again.
            15 => drop(world.entity_mut(resting).insert(RigidBody::Dynamic)),
            20 => world.resource_mut::<DisabledNext>().0 = Some(resting),
            _ => {}
        }
        let x = if step < 25 { 50.0 } else { 0.5 };
        world.entity_mut(moving).insert(at(x, 5.0, 0.0));
    });
}

/// A collider that is inserted once more leaves its tree and comes back in one step: its contact pair stays, and ends with it
/// in the next step, in which another contact pair of the body ends though its colliders still overlap.
#[test]
fn a_collider_that_is_inserted_once_more_before_its_body_is_disabled() {
    let mut both = Both::new::<()>();
    ground(both.world());
    let body = |x: f32| (RigidBody::Static, cuboid([1.0; 3]), at(x, 5.0, 0.0));
    let [removed, body] = [50.0, 0.0].map(|x| both.world().spawn(body(x)).id());
    both.world().entity_mut(body).with_child((cuboid([1.0; 3]), at(0.8, 0.0, 0.0)));
    let moving = (RigidBody::Kinematic, Sensor, cuboid([1.0; 3]), at(0.4, 5.0, 0.0));
    let moving = both.world().spawn(moving).id();
    run(both, 20, |world, step| {
        match step {
            10 => {
                // So that the collider gets another place in its tree.
                world.despawn(removed);
                world.entity_mut(body).insert(cuboid([1.5; 3]));
            }
            11 => drop(world.entity_mut(body).insert(Disabled)),
            _ => {}
        }
        let x = if step % 2 == 0 { 0.4 } else { 0.5 };
        world.entity_mut(moving).insert(at(x, 5.0, 0.0));
    });
}

/// What a random step does to a collider or its body.
fn disturb(world: &mut World, random: &mut Random, living: &mut Vec<Entity>) {
    let index = random.below(living.len());
    let target = living[index];
    let kinds = [RigidBody::Static, RigidBody::Dynamic, RigidBody::Kinematic];
    let mut entity = world.entity_mut(target);
    match random.below(16) {
        0 => {
            world.despawn(target);
            living.swap_remove(index);
        }
        1 => drop(entity.insert(ColliderDisabled)),
        2 => drop(entity.remove::<ColliderDisabled>()),
        3 => drop(entity.insert(Disabled)),
        // Avian 0.8 fails an assertion of its own some steps after a disabled body has come back.
        4 if cfg!(feature = "bevy-0.19") || !entity.contains::<RigidBody>() => {
            entity.remove::<Disabled>();
        }
        5 => drop(entity.insert(RigidBodyDisabled)),
        6 => drop(entity.remove::<RigidBodyDisabled>()),
        // Avian 0.7 fails an assertion of its own where a collider without a body gets a static one, or where the body is
        // disabled and its other colliders are not.
        7 if entity.contains::<RigidBody>() && !entity.contains::<Disabled>() => {
            entity.insert(kinds[random.below(3)]);
        }
        8 => drop(entity.insert(cuboid([random.between(0.2, 2.0); 3]))),
        9 => drop(entity.insert(Sensor)),
        10 => drop(entity.remove::<Sensor>()),
        11 => drop(entity.insert(place(random, 5.0))),
        12 => drop(entity.insert(CollisionLayers::from_bits(random.below(4) as u32, 3))),
        13 => drop(entity.insert(ActiveCollisionHooks::FILTER_PAIRS)),
        14 => drop(entity.insert(CollisionEventsEnabled)),
        _ => {
            let transform = place(random, 5.0);
            living.push(spawn(world, random, transform));
        }
    }
}

/// A body with one collider, a body with three, or a collider without a body.
fn spawn(world: &mut World, random: &mut Random, transform: Transform) -> Entity {
    let kinds = [RigidBody::Static, RigidBody::Dynamic, RigidBody::Dynamic, RigidBody::Kinematic];
    let kind = kinds[random.below(4)];
    let side = random.between(0.3, 1.5);
    let team = Team(random.below(2));
    match random.below(5) {
        0 => world.spawn((cuboid([side; 3]), transform, team)).id(),
        1 => {
            let child = |x: f32| (cuboid([side; 3]), at(x, 0.0, 0.0), Team(0));
            world
                .spawn((kind, cuboid([side; 3]), transform, team))
                .with_children(|children| {
                    children.spawn(child(side));
                    children.spawn(child(-side));
                })
                .id()
        }
        _ => world.spawn((kind, cuboid([side; 3]), transform, team)).id(),
    }
}

/// Which entities a system in the middle of a step disturbs.
#[derive(Resource)]
struct Disturbance {
    random: Random,
    living: Vec<Entity>,
}

fn disturb_within_a_step(world: &mut World) {
    world.resource_scope(|world, mut disturbance: Mut<Disturbance>| {
        let Disturbance { random, living } = &mut *disturbance;
        if random.chance(30) {
            disturb(world, random, living);
        }
    });
}

#[test]
fn anything_that_can_happen_at_random() {
    let seeds = if std::env::var_os("TEST_LONG").is_some() { 80 } else { 5 };
    for seed in 0..seeds {
        let mut both = Both::for_random_changes::<Teams>();
        // Events of collisions run here, for example.
        both.app.add_systems(
            PhysicsSchedule,
            disturb_within_a_step.in_set(PhysicsStepSystems::Finalize).ambiguous_with_all(),
        );
        let mut random = Random(100 + seed);
        ground(both.world());
        let living: Vec<_> = (0..100)
            .map(|_| {
                let transform = place(&mut random, 5.0);
                spawn(both.world(), &mut random, transform)
            })
            .collect();
        both.world().insert_resource(Disturbance { random, living });
        let both = run(both, 200, |world, step| {
            world.resource_scope(|world, mut disturbance: Mut<Disturbance>| {
                let Disturbance { random, living } = &mut *disturbance;
                for _ in 0..step % 4 {
                    disturb(world, random, living);
                }
            });
        });
        assert!(both.search().counts().full_reads > 0);
    }
}
