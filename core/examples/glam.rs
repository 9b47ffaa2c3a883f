//! Boxes from the vectors of `glam` and back: asteroids that drift, and a ship that looks for the nearest one.
//!
//! `cargo run --example glam --features glam034`

// In your own crate it is `glam`: this one knows several versions of it.
use glam034::{Vec2, vec2};
use sweep_and_prune::{Aabb, BroadPhase, Cast, Error, Filter, ProxyId};

struct Asteroid {
    id: ProxyId,
    center: Vec2,
    velocity: Vec2,
    radius: f32,
}

impl Asteroid {
    fn aabb(&self) -> Aabb<2> {
        (self.center - self.radius, self.center + self.radius).into()
    }
}

fn main() -> Result<(), Error> {
    let mut world = BroadPhase::<2>::new();
    let mut asteroids = Vec::new();
    for index in 0..200 {
        let angle = 2.4 * index as f32;
        let (velocity, radius) = (Vec2::from_angle(7.0 * angle), 0.4);
        let center = Vec2::from_angle(angle) * (0.4 * angle.sqrt());
        // A pair of vectors is a box: min corner, max corner.
        let id = world.insert((center - radius, center + radius).into())?;
        asteroids.push(Asteroid { id, center, velocity, radius });
    }

    for _frame in 0..60 {
        for asteroid in &mut asteroids {
            asteroid.center += asteroid.velocity / 60.0;
            world.set(asteroid.id, asteroid.aabb())?;
        }
        world.update();
    }

    // The boxes give the candidates; whether two round asteroids touch is for their distance to say.
    let by_slot = |id: ProxyId| &asteroids[id.slot() as usize];
    let touch = |a: &Asteroid, b: &Asteroid| a.center.distance(b.center) <= a.radius + b.radius;
    let found = world.pairs().filter(|&[a, b]| touch(by_slot(a), by_slot(b))).count();
    let all = (0..200).flat_map(|a| (a + 1..200).map(move |b| [a, b]));
    let expected = all.filter(|&[a, b]| touch(&asteroids[a], &asteroids[b])).count();
    println!("{found} of {} pairs of boxes touch", world.pairs().len());
    assert!(found > 0 && found == expected);

    // Points and directions are arrays, which glam's vectors convert to.
    let ship = vec2(-20.0, 0.5);
    let queries = world.queries().with_filter(Filter::ALL);
    let nearest = queries.nearest(ship.into(), 1, f64::INFINITY)?[0].id;
    let way = by_slot(nearest).center - ship;
    let hit = queries.cast(&Cast::ray(ship.into(), way.into(), 1.0))?.expect("it looks at one");
    let at = ship + way * hit.t as f32;
    let (min, max): (Vec2, Vec2) = world.aabb(hit.id)?.into();
    println!("the nearest asteroid is hit at {at}");
    assert!(at.cmpge(min - 0.001).all() && at.cmple(max + 0.001).all());
    Ok(())
}
