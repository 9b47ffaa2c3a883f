//! Bullets: swept boxes find what a fast body would have jumped over, and a cast finds where.
//!
//! `cargo run --example bullets`

use sweep_and_prune::{Aabb, BroadPhase, Cast, Filter};

fn bullet(x: f32, y: f32) -> Aabb<2> {
    Aabb::new([x, y], [x + 0.1, y + 0.1])
}

fn main() -> Result<(), sweep_and_prune::Error> {
    let mut world = BroadPhase::<2>::new();
    let target = world.insert_with(Aabb::new([50.0, 0.0], [50.2, 2.0]), Filter::STATIC)?;
    // Bullets of one negative group never meet each other.
    let filter = Filter::default().group(-1);
    let low = world.insert_with(bullet(0.0, 1.0), filter)?;
    let high = world.insert_with(bullet(0.0, 5.0), filter)?;
    world.update();

    let speed = 30.0;
    for frame in 0..3 {
        let x = frame as f32 * speed;
        for (id, y) in [(low, 1.0), (high, 5.0)] {
            world.set_swept(id, bullet(x, y), bullet(x + speed, y))?;
        }
        if world.update().begun().any(|pair| pair == [target, low]) {
            // The sweep shows that they meet; the cast shows where.
            let way = Cast::aabb(bullet(x, 1.0), [speed, 0.0], 1.0);
            let hit = world.queries().with_filter(filter).cast(&way)?;
            let t = hit.expect("what overlaps the sweep of a straight shot is hit").t;
            println!("frame {frame}: hit {:?} at x = {:.1}", target, x as f64 + t * 30.0);
        }
    }
    Ok(())
}
