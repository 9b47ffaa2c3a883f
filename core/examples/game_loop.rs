//! A game loop: bodies move, and the world reports which contacts begin and end.
//!
//! `cargo run --example game_loop`

use sweep_and_prune::{Aabb, BroadPhase, Filter, ProxyId};

/// A ball of radius 0.5 that bounces between two walls.
struct Ball {
    id: ProxyId,
    x: f32,
    speed: f32,
}

fn aabb(x: f32) -> Aabb<2> {
    Aabb::new([x - 0.5, 0.0], [x + 0.5, 1.0])
}

fn main() -> Result<(), sweep_and_prune::Error> {
    let mut world = BroadPhase::<2>::new();
    let walls = [Aabb::new([-1.0, 0.0], [0.0, 3.0]), Aabb::new([10.0, 0.0], [11.0, 3.0])];
    let walls = world.insert_many(&walls, Filter::STATIC)?;
    let mut balls = Vec::new();
    for (x, speed) in [(2.0, 0.5), (8.0, -0.25)] {
        balls.push(Ball { id: world.insert(aabb(x))?, x, speed });
    }
    for frame in 0..30 {
        for ball in &mut balls {
            ball.x += ball.speed;
            world.set(ball.id, aabb(ball.x))?;
        }
        world.update();
        for pair in world.changes().begun() {
            println!("frame {frame}: {} meets {}", pair[0].slot(), pair[1].slot());
            let turns = |ball: &&mut Ball| pair.contains(&ball.id);
            balls.iter_mut().filter(turns).for_each(|ball| ball.speed = -ball.speed);
        }
    }
    assert!(balls.iter().all(|ball| world.contains(ball.id)) && world.len() == 2 + walls.len());
    Ok(())
}
