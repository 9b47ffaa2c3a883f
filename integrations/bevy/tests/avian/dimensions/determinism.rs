//! The same simulation, bit for bit, with 1 and 2 threads and with other entities.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::process::Command;
use std::time::Duration;

use bevy::app::TaskPoolThreadAssignmentPolicy;
use bevy::prelude::*;
use bevy::time::TimeUpdateStrategy;

use super::avian::prelude::*;
use super::plugin::SweepAndPruneBroadPhasePlugin;
use super::{DEPTH, cuboid};
use crate::support::Random;

/// Refuses every pair of two bodies whose numbers are multiples of 5.
#[derive(bevy::ecs::system::SystemParam)]
struct Fifths<'w, 's> {
    numbers: Query<'w, 's, &'static Number>,
}

#[derive(Component)]
struct Number(usize);

impl CollisionHooks for Fifths<'_, '_> {
    fn filter_pairs(&self, one: Entity, other: Entity, _: &mut Commands) -> bool {
        let numbers = self.numbers.get_many([one, other]);
        !numbers.is_ok_and(|both| both.iter().all(|number| number.0 % 5 == 0))
    }
}

/// Bodies that fall, some of which are removed and replaced. Returns a hash of where all are after each step, and of
/// the contact pairs in their order.
fn simulate(threads: usize, other_entities: bool) -> u64 {
    let mut app = App::new();
    let mut pools = TaskPoolOptions::with_num_threads(threads);
    pools.compute = TaskPoolThreadAssignmentPolicy {
        min_threads: threads,
        max_threads: threads,
        ..pools.compute
    };
    let physics = PhysicsPlugins::default().with_collision_hooks::<Fifths>().build();
    app.add_plugins((
        MinimalPlugins.set(TaskPoolPlugin { task_pool_options: pools }),
        TransformPlugin,
        physics
            .disable::<BvhBroadPhasePlugin<Fifths>>()
            .add(SweepAndPruneBroadPhasePlugin::<Fifths>::default()),
    ));
    let step = Duration::from_secs_f64(1.0 / 64.0);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(step));
    app.finish();
    app.cleanup();
    let world = app.world_mut();
    if other_entities {
        // Entities of other numbers, not in the order in which they are spawned.
        let taken: Vec<_> = (0..500).map(|_| world.spawn_empty().id()).collect();
        for index in 0..taken.len() {
            world.despawn(taken[index * 7 % taken.len()]);
        }
    }
    let mut random = Random(7);
    let mut number = 0;
    let mut spawn = |world: &mut World| {
        number += 1;
        let [x, y, z] = [(); 3].map(|()| random.between(-4.0, 4.0));
        let transform = Transform::from_xyz(x, y + 5.0, z * DEPTH);
        let body = (RigidBody::Dynamic, cuboid([0.8; 3]), transform, Number(number));
        world.spawn((body, ActiveCollisionHooks::FILTER_PAIRS)).id()
    };
    let mut bodies: Vec<_> = (0..150).map(|_| spawn(world)).collect();
    let ground = Transform::from_xyz(0.0, -0.5, 0.0);
    bodies.push(world.spawn((RigidBody::Static, cuboid([50.0, 1.0, 50.0]), ground)).id());
    let mut hash = DefaultHasher::new();
    for step in 0..150 {
        if step % 10 == 9 {
            let world = app.world_mut();
            world.despawn(std::mem::replace(&mut bodies[step], Entity::PLACEHOLDER));
            bodies[step] = spawn(world);
        }
        app.update();
        let world = app.world();
        for &body in &bodies {
            let position = world.get::<Position>(body).expect("a body that is here").0;
            for coordinate in position.to_array() {
                coordinate.to_bits().hash(&mut hash);
            }
        }
        let place = |entity| bodies.iter().position(|&body| body == entity);
        for pair in world.resource::<ContactGraph>().iter_active() {
            (place(pair.collider1), place(pair.collider2)).hash(&mut hash);
        }
    }
    assert!(app.world().resource::<ContactGraph>().edges.edge_count() > 150);
    hash.finish()
}

/// Bevy has one pool of threads in a process, so each simulation gets a process of its own: this test, with variables.
#[test]
fn the_same_with_any_number_of_threads_and_with_other_entities() {
    let name = "the_same_with_any_number_of_threads_and_with_other_entities";
    if let Ok(threads) = std::env::var("SIMULATE_THREADS") {
        let other_entities = std::env::var_os("SIMULATE_OTHER_ENTITIES").is_some();
        println!("hash {:x}", simulate(threads.parse().expect("a number"), other_entities));
        return;
    }
    let module = module_path!().split_once("::").expect("a module of the test").1;
    let hash = |threads: &str, other_entities: bool| {
        let mut command = Command::new(std::env::current_exe().expect("this test"));
        command.args([&format!("{module}::{name}"), "--exact", "--nocapture"]);
        command.env("SIMULATE_THREADS", threads).env("RAYON_NUM_THREADS", threads);
        if other_entities {
            command.env("SIMULATE_OTHER_ENTITIES", "1");
        }
        let output = String::from_utf8(command.output().expect("it runs").stdout).expect("text");
        let line = output.lines().find_map(|line| Some(line.split_once("hash ")?.1.to_owned()));
        line.unwrap_or_else(|| panic!("no hash: {output}"))
    };
    let expected = hash("1", false);
    assert_eq!(hash("1", false), expected, "the same run again");
    assert_eq!(hash("2", false), expected, "2 threads");
    assert_eq!(hash("2", true), expected, "other entities");
}
