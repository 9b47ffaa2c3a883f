//! Sensors: a door that opens when a guest comes near and closes when the last one has left.
//! By its filter it reacts only to guests.
//!
//! `cargo run --example sensors`

use sweep_and_prune::{Aabb, BroadPhase, Filter};

const GUEST: u32 = 1;
const CAT: u32 = 2;
const SENSOR: u32 = 4;

fn main() -> Result<(), sweep_and_prune::Error> {
    let mut world = BroadPhase::<1>::new();
    let of = |category, mask| Filter::default().category(category).mask(mask);
    let sensor = world.insert_with(Aabb::new([4.0], [6.0]), of(SENSOR, GUEST))?;
    let ada = world.insert_with(Aabb::new([0.0], [0.5]), of(GUEST, u32::MAX))?;
    let bob = world.insert_with(Aabb::new([1.0], [1.5]), of(GUEST, u32::MAX))?;
    let cat = world.insert_with(Aabb::new([5.0], [5.2]), of(CAT, u32::MAX))?;

    let mut inside = 0;
    for step in 1..=8 {
        for (walker, start) in [(ada, 0.0), (bob, 1.0)] {
            let x = start + step as f32;
            world.set(walker, Aabb::new([x], [x + 0.5]))?;
        }
        let changes = world.update();
        let entered = changes.begun().filter(|pair| pair.contains(&sensor)).count();
        let left = changes.ended().filter(|pair| pair.contains(&sensor)).count();
        let was_open = inside > 0;
        inside = inside + entered - left;
        if was_open != (inside > 0) {
            println!("step {step}: the door {}", if inside > 0 { "opens" } else { "closes" });
        }
    }
    assert!(!world.pairs_of(sensor)?.any(|other| other == cat));
    Ok(())
}
