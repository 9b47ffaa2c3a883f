//! Creatures that notice each other, without physics: a spatial index over their boxes.
//!
//! ```sh
//! cargo run --release --no-default-features --features bevy-0.20 --example spatial_index
//! ```

#[cfg(feature = "bevy-0.19")]
extern crate bevy_0_19 as bevy;

use bevy::app::{AppExit, ScheduleRunnerPlugin};
use bevy::prelude::*;
use bevy_sweep_and_prune::index::{
    BoundingBox, OverlapBegan, OverlapEnded, SpatialIndex, SpatialIndexPlugin, SpatialIndexSystems,
};
use bevy_sweep_and_prune::sweep_and_prune::{Aabb, Cast};

#[derive(Component)]
struct Creature {
    name: &'static str,
    at: Vec2,
    velocity: Vec2,
}

fn main() {
    App::new()
        .add_plugins((ScheduleRunnerPlugin::default(), SpatialIndexPlugin::<2>::default()))
        .add_systems(Startup, spawn)
        .add_systems(Update, walk)
        .add_systems(PostUpdate, (notice, look_ahead).chain().after(SpatialIndexSystems))
        .run();
}

fn spawn(mut commands: Commands) {
    let fox = Creature { name: "fox", at: Vec2::ZERO, velocity: Vec2::new(1.0, 0.0) };
    let hare = Creature { name: "hare", at: Vec2::new(5.0, 0.5), velocity: Vec2::ZERO };
    let owl = Creature { name: "owl", at: Vec2::new(8.0, 9.0), velocity: Vec2::new(0.0, -1.0) };
    for creature in [fox, hare, owl] {
        commands.spawn((bounds(&creature), creature));
    }
}

/// A creature notices what is this near, in the sense of boxes.
fn bounds(creature: &Creature) -> BoundingBox<2> {
    BoundingBox(Aabb::new((creature.at - 1.0).to_array(), (creature.at + 1.0).to_array()))
}

/// Creatures that rest have no changed box: they take no time.
fn walk(mut creatures: Query<(&mut Creature, &mut BoundingBox<2>)>) {
    for (mut creature, mut aabb) in &mut creatures {
        if creature.velocity != Vec2::ZERO {
            let step = creature.velocity;
            creature.at += step;
            *aabb = bounds(&creature);
        }
    }
}

fn notice(
    creatures: Query<&Creature>,
    mut began: MessageReader<OverlapBegan<2>>,
    mut ended: MessageReader<OverlapEnded<2>>,
) {
    for message in began.read() {
        if let Ok([one, other]) = creatures.get_many(message.entities) {
            println!("{} and {} notice each other", one.name, other.name);
        }
    }
    for message in ended.read() {
        if let Ok([one, other]) = creatures.get_many(message.entities) {
            println!("{} and {} part", one.name, other.name);
        }
    }
}

/// What is straight ahead of the fox? Queries take a shared borrow, so such systems run in parallel.
fn look_ahead(
    index: Res<SpatialIndex<2>>,
    creatures: Query<&Creature>,
    mut exit: MessageWriter<AppExit>,
) -> Result {
    let Some(fox) = creatures.iter().find(|creature| creature.name == "fox") else { return Ok(()) };
    let ray = Cast::ray([fox.at.x + 1.5, fox.at.y], [1.0, 0.0], 3.0);
    if let Some(hit) = index.cast(&ray)? {
        println!("the fox sees the {} ahead", creatures.get(hit.entity)?.name);
    }
    if fox.at.x > 12.0 {
        exit.write(AppExit::Success);
    }
    Ok(())
}
