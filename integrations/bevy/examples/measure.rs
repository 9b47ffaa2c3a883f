//! Measures Avian with its own broad phase and with this one: the search for pairs, and the whole step.
//!
//! ```sh
//! cargo run --release --features testing-f32 --example measure [SCENE...]
//! ```
//!
//! Two apps have the same scene and take turns, step by step. Printed are medians over the steps, and the median of the
//! quotients of both apps in a step.

#[cfg(feature = "bevy-0.19")]
extern crate bevy_0_19 as bevy;

use std::time::{Duration, Instant};

#[cfg(feature = "avian3d-0.8")]
use ::avian3d as avian;
#[cfg(feature = "avian3d-0.7")]
use ::avian3d_0_7 as avian;
use avian::collision::CollisionDiagnostics;
use avian::prelude::*;
use bevy::prelude::*;
use bevy::time::TimeUpdateStrategy;
use bevy_sweep_and_prune::avian3d::SweepAndPruneBroadPhasePlugin;

/// A scene: its name, how many steps are left out, how many are measured, and what it consists of.
type Scene = (&'static str, usize, usize, fn(&mut World));

const SCENES: [Scene; 8] = [
    ("1,000 cubes fall", 20, 80, |world| fall(world, 10)),
    ("10,648 cubes fall", 20, 100, |world| fall(world, 22)),
    ("1,000 cubes drift", 20, 200, |world| drift(world, 1_000, 0, false)),
    ("10,000 cubes drift", 20, 100, |world| drift(world, 10_000, 0, false)),
    ("1,000 among 10,000 static", 20, 200, |world| drift(world, 1_000, 10_000, false)),
    ("1,000 among 100,000 static", 20, 100, |world| drift(world, 1_000, 100_000, false)),
    ("20,000 sensors drift", 20, 60, |world| drift(world, 20_000, 0, true)),
    ("50,000 bullets, 100 targets", 20, 40, bullets),
];

fn main() {
    let wanted: Vec<_> = std::env::args().skip(1).collect();
    println!(
        "| scene | search: Avian | search: this | quotient | step: Avian | step: this | quotient |"
    );
    println!("|---|--:|--:|--:|--:|--:|--:|");
    for scene in SCENES {
        if wanted.is_empty() || wanted.iter().any(|name| scene.0.contains(name.as_str())) {
            measure(scene);
        }
    }
}

fn measure((name, skipped, measured, build): Scene) {
    let mut apps = [false, true].map(|is_own| app(is_own, build));
    let mut searches = [vec![], vec![]];
    let mut steps = [vec![], vec![]];
    for step in 0..skipped + measured {
        // The app that goes first changes with each step.
        for turn in [step % 2, 1 - step % 2] {
            let app = &mut apps[turn];
            app.world_mut().resource_mut::<CollisionDiagnostics>().broad_phase = Duration::ZERO;
            let start = Instant::now();
            app.update();
            let whole = start.elapsed();
            if step >= skipped {
                searches[turn].push(app.world().resource::<CollisionDiagnostics>().broad_phase);
                steps[turn].push(whole);
            }
        }
    }
    let contacts = apps.map(|app| app.world().resource::<ContactGraph>().edges.edge_count());
    let cells = [searches, steps].map(|[avian, this]| {
        let quotients =
            avian.iter().zip(&this).map(|(avian, this)| avian.as_secs_f64() / this.as_secs_f64());
        let quotient = median(quotients.collect());
        let [avian, this] = [avian, this]
            .map(|times| median(times.iter().map(|time| time.as_secs_f64() * 1e3).collect()));
        format!("{avian:.3} ms | {this:.3} ms | {quotient:.2}")
    });
    println!("| {name} | {} | {} |", cells[0], cells[1]);
    eprintln!("   contact pairs at the end: {contacts:?}");
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

fn app(is_own: bool, build: fn(&mut World)) -> App {
    let mut app = App::new();
    let physics = PhysicsPlugins::default().build();
    app.add_plugins((MinimalPlugins, TransformPlugin));
    if is_own {
        let physics = physics.disable::<BvhBroadPhasePlugin>();
        app.add_plugins(physics.add(SweepAndPruneBroadPhasePlugin::<()>::default()));
    } else {
        app.add_plugins(physics);
    }
    let step = Duration::from_secs_f64(1.0 / 64.0);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(step));
    app.finish();
    app.cleanup();
    build(app.world_mut());
    app
}

/// A cube of `side` times `side` times `side` cubes above a ground.
fn fall(world: &mut World, side: u16) {
    let ground = Transform::from_xyz(0.0, -0.5, 0.0);
    world.spawn((RigidBody::Static, Collider::cuboid(200.0, 1.0, 200.0), ground));
    for index in 0..side * side * side {
        let [x, y, z] = [index % side, index / side % side, index / side / side].map(f32::from);
        // Slightly shifted, so that towers fall apart.
        let shift = 0.2 * (y * 1.7).sin();
        let at = Transform::from_xyz(1.3 * x + shift, 1.0 + 1.3 * y, 1.3 * z + shift);
        world.spawn((RigidBody::Dynamic, Collider::cuboid(1.0, 1.0, 1.0), at));
    }
}

/// Cubes that drift without gravity among static ones, all at random places, with as much space for each.
fn drift(world: &mut World, moving: usize, fixed: usize, are_sensors: bool) {
    world.insert_resource(Gravity(Vec3::ZERO));
    let mut random = Random(1);
    let size = 2.0 * ((moving + fixed) as f32).cbrt();
    for _ in 0..fixed {
        let at = Transform::from_translation(random.vector(size));
        world.spawn((RigidBody::Static, Collider::cuboid(1.0, 1.0, 1.0), at));
    }
    for _ in 0..moving {
        let at = Transform::from_translation(random.vector(size));
        let velocity = LinearVelocity(random.vector(5.0) - 2.5);
        let mut body =
            world.spawn((RigidBody::Dynamic, Collider::cuboid(1.0, 1.0, 1.0), at, velocity));
        if are_sensors {
            body.insert(Sensor);
        }
    }
}

/// Bullets that do not meet each other, and targets.
fn bullets(world: &mut World) {
    world.insert_resource(Gravity(Vec3::ZERO));
    let mut random = Random(1);
    for _ in 0..50_000 {
        let at = Transform::from_translation(random.vector(60.0));
        let velocity = LinearVelocity(random.vector(60.0) - 30.0);
        let layers = CollisionLayers::from_bits(2, 1);
        world.spawn((RigidBody::Dynamic, Collider::sphere(0.1), at, velocity, layers, Sensor));
    }
    for _ in 0..100 {
        let at = Transform::from_translation(random.vector(60.0));
        world.spawn((RigidBody::Kinematic, Collider::cuboid(1.0, 1.0, 1.0), at));
    }
}

/// A generator of random numbers: the same in each run.
struct Random(u64);

impl Random {
    fn vector(&mut self, size: f32) -> Vec3 {
        let [x, y, z] = [(); 3].map(|()| {
            self.0 = self.0.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(0x1405_7B7E_F767_814F);
            (self.0 >> 40) as f32 / (1 << 24) as f32
        });
        size * Vec3::new(x, y, z)
    }
}
