//! A game with an entity component system, here `hecs`: bullets fly, enemies walk, and the broad phase says who is hit.
//!
//! The broad phase is a resource beside the entities. An entity with a collider has its id in the broad phase as a component;
//! the way back, from ids to entities, is a table by slot.
//!
//! `cargo run --example ecs`

use hecs::{Entity, World};
use sweep_and_prune::{Aabb, BroadPhase, Error, Filter, ProxyId};

const ENEMY: u32 = 1;
const BULLET: u32 = 2;

struct Position([f32; 2]);
struct Velocity([f32; 2]);
struct HalfExtents([f32; 2]);
struct Health(u32);
struct Collider(ProxyId);

/// The broad phase and the entities of its bodies.
#[derive(Default)]
struct Collisions {
    broad_phase: BroadPhase<2>,
    /// By slot.
    entities: Vec<Option<Entity>>,
}

impl Collisions {
    /// Gives an entity a collider.
    fn add(&mut self, world: &mut World, entity: Entity, filter: Filter) -> Result<(), Error> {
        let aabb = {
            let mut query = world.query_one::<(&Position, &HalfExtents)>(entity);
            let (position, half) = query.get().expect("it was spawned with both");
            Aabb::from_center(position.0, half.0)
        };
        let id = self.broad_phase.insert_with(aabb, filter)?;
        let slot = id.slot() as usize;
        self.entities.resize(self.entities.len().max(slot + 1), None);
        self.entities[slot] = Some(entity);
        world.insert_one(entity, Collider(id)).expect("it was spawned");
        Ok(())
    }

    /// Removes an entity and its body.
    fn despawn(&mut self, world: &mut World, entity: Entity) -> Result<(), Error> {
        if let Ok(Collider(id)) = world.remove_one::<Collider>(entity) {
            self.broad_phase.remove(id)?;
            self.entities[id.slot() as usize] = None;
        }
        world.despawn(entity).expect("it was there");
        Ok(())
    }
}

/// A system: moves all that has a velocity.
fn move_all(world: &mut World) {
    for (position, velocity) in world.query_mut::<(&mut Position, &Velocity)>() {
        (0..2).for_each(|axis| position.0[axis] += velocity.0[axis]);
    }
}

/// A system: tells the broad phase where everything is. It finds out itself what moved.
fn place_all(world: &mut World, collisions: &mut Collisions) -> Result<(), Error> {
    for (position, half, collider) in world.query_mut::<(&Position, &HalfExtents, &Collider)>() {
        collisions.broad_phase.set(collider.0, Aabb::from_center(position.0, half.0))?;
    }
    Ok(())
}

/// A system: bullets that hit an enemy are gone, and the enemy is hurt. Returns how many hit.
fn hit(world: &mut World, collisions: &mut Collisions) -> Result<usize, Error> {
    let (mut hits, mut gone) = (0, Vec::new());
    let entities = &collisions.entities;
    for pair in collisions.broad_phase.update().begun() {
        let [a, b] = pair.map(|id| entities[id.slot() as usize].expect("bodies have entities"));
        let is_bullet = |entity| world.get::<&Health>(entity).is_err();
        let (bullet, enemy) = if is_bullet(a) { (a, b) } else { (b, a) };
        if gone.contains(&bullet) || gone.contains(&enemy) {
            continue; // One of them has met another in this frame, and is gone.
        }
        hits += 1;
        gone.push(bullet);
        let mut health = world.get::<&mut Health>(enemy).expect("filters let no others pair");
        health.0 -= 1;
        if health.0 == 0 {
            gone.push(enemy);
        }
    }
    gone.into_iter().try_for_each(|entity| collisions.despawn(world, entity))?;
    Ok(hits)
}

fn main() -> Result<(), Error> {
    let (mut world, mut collisions) = (World::new(), Collisions::default());
    // Bullets meet enemies, and neither meets its own kind: pairs that are not allowed are not even searched.
    let enemies = Filter::default().category(ENEMY).mask(BULLET);
    let bullets = Filter::default().category(BULLET).mask(ENEMY);
    for at in 0..50 {
        let position = Position([10.0 + at as f32, (at % 10) as f32]);
        let enemy =
            world.spawn((position, Velocity([-0.1, 0.0]), HalfExtents([0.4, 0.4]), Health(3)));
        collisions.add(&mut world, enemy, enemies)?;
    }

    let (mut hits, mut shots) = (0, 0);
    for frame in 0..300 {
        if frame % 2 == 0 {
            shots += 1;
            let position = Position([0.0, (frame / 2 % 10) as f32]);
            let bullet = world.spawn((position, Velocity([0.7, 0.0]), HalfExtents([0.1, 0.1])));
            collisions.add(&mut world, bullet, bullets)?;
        }
        move_all(&mut world);
        place_all(&mut world, &mut collisions)?;
        hits += hit(&mut world, &mut collisions)?;

        assert_eq!(collisions.broad_phase.len(), world.len() as usize);
        // Of each pair of the last update one is gone: no bullet flies on through an enemy.
        let is_gone = |id: &ProxyId| !collisions.broad_phase.contains(*id);
        assert!(collisions.broad_phase.pairs().all(|pair| pair.iter().any(is_gone)));
    }
    let health: u32 = world.query_mut::<&Health>().into_iter().map(|health| health.0).sum();
    println!("{shots} shots, {hits} hits, {} entities are left", world.len());
    assert_eq!(hits, 50 * 3 - health as usize);
    assert!(hits > 100);
    Ok(())
}
