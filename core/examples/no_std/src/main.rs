//! A game without a standard library, on a microcontroller (ARM Cortex-M4, 256 KiB of flash, 128 KiB of RAM). It needs a
//! global allocator, and nothing else.
//!
//! `cargo build --release --target thumbv7em-none-eabi`
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use panic_halt as _;
use sweep_and_prune::{Aabb, BroadPhase, Cast, Error, Filter, find_pairs};

#[global_allocator]
static ALLOCATOR: emballoc::Allocator<65_536> = emballoc::Allocator::new();

/// A paddle, a ball that bounces off it, and a wall behind. Returns how often the ball was hit.
fn play() -> Result<u32, Error> {
    let mut world = BroadPhase::<2>::new();
    let paddle = world.insert_with(Aabb::new([0.0, 4.0], [1.0, 6.0]), Filter::STATIC)?;
    let wall = world.insert_with(Aabb::new([20.0, 0.0], [21.0, 9.0]), Filter::STATIC)?;
    let ball = world.insert(Aabb::from_center([10.0, 5.0], [0.5, 0.5]))?;

    let (mut speed, mut bounces) = (-0.5, 0);
    for _frame in 0..600 {
        world.set(ball, world.aabb(ball)?.translate([speed, 0.0]))?;
        let hit = world.update().begun().any(|pair| pair == [paddle, ball] || pair == [wall, ball]);
        if hit {
            speed = -speed;
            bounces += 1;
        }
        let ahead = Cast::aabb(world.aabb(ball)?, [speed, 0.0], 100.0).ignore_touching();
        assert!(world.queries().cast(&ahead)?.is_some());
    }
    Ok(bounces)
}

#[entry]
fn main() -> ! {
    let boxes: [Aabb<3>; 100] =
        core::array::from_fn(|at| Aabb::from_center([at as f32; 3], [0.6; 3]));
    assert_eq!(find_pairs(&boxes).map(|pairs| pairs.len()), Ok(99));
    assert!(play().is_ok_and(|bounces| bounces > 10));
    loop {
        core::hint::spin_loop();
    }
}
