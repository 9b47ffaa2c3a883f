//! Bullets: swept boxes find what a fast body would have jumped over, a cast where it was hit.
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
    let filter = Filter { group: -1, ..Filter::default() };
    let low = world.insert_with(bullet(0.0, 1.0), filter)?;
    let high = world.insert_with(bullet(0.0, 5.0), filter)?;
    world.update();

    let speed = 30.0;
    for frame in 0..3 {
        let x = frame as f32 * speed;
        for (id, y) in [(low, 1.0), (high, 5.0)] {
            world.set_swept(id, bullet(x, y), bullet(x + speed, y))?;
        }
        let hits: Vec<_> = world.update().begun().collect();
        for pair in hits {
            assert_eq!(pair, [target, low]);
            // The sweep says that they meet; the cast says where. It looks for static bodies.
            let way = Cast::aabb(bullet(x, 1.0), [speed, 0.0], 1.0);
            let hit = world.queries().with_filter(filter).cast(&way)?;
            let at = hit.expect("what overlaps the sweep of a straight shot is hit").at;
            println!("frame {frame}: hit {:?} at x = {:.1}", target, x as f64 + at * 30.0);
        }
    }
    Ok(())
}
