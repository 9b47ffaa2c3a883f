//! Balls move as balls do.

use sweep_and_prune::Aabb;
use sweep_and_prune_simulation::scenes::{self, canvas};
use sweep_and_prune_simulation::{Ball, Setup, SetupError, Simulation};

fn ball(x: f32, y: f32, radius: f32, velocity: [f32; 2]) -> Ball<2> {
    Ball { center: [x, y], radius, velocity }
}

/// A canvas without gravity or loss.
fn frictionless(balls: Vec<Ball<2>>) -> Setup<2> {
    Setup { gravity: [0.0; 2], restitution: 1.0, ..canvas(balls, [600.0, 400.0]) }
}

fn after<const D: usize>(setup: &Setup<D>, steps: u32) -> Simulation<D> {
    let mut simulation = Simulation::new(setup).unwrap();
    for _ in 0..steps {
        simulation.step(|| 0.0).unwrap();
    }
    simulation
}

fn assert_near(a: f32, b: f32, tolerance: f32) {
    assert!((a - b).abs() <= tolerance, "{a} is not {b}");
}

#[test]
fn equal_discs_exchange_their_velocities() {
    let balls = vec![ball(100.0, 200.0, 20.0, [120.0, 0.0]), ball(200.0, 200.0, 20.0, [0.0; 2])];
    let simulation = after(&frictionless(balls), 60);
    assert_eq!(simulation.velocities(), [[0.0, 0.0], [120.0, 0.0]]);
}

/// Mass is area: a disc of twice the radius has four times the mass.
#[test]
fn unequal_discs_bounce_by_their_areas() {
    let balls = vec![ball(100.0, 200.0, 40.0, [100.0, 0.0]), ball(200.0, 200.0, 20.0, [0.0; 2])];
    let simulation = after(&frictionless(balls), 60);
    let [heavy, light] = [0, 1].map(|index| simulation.velocities()[index]);
    assert_near(heavy[0], 100.0 * (4.0 - 1.0) / 5.0, 0.01);
    assert_near(light[0], 100.0 * 2.0 * 4.0 / 5.0, 0.01);
}

/// In 3D it is volume: eight times.
#[test]
fn unequal_spheres_bounce_by_their_volumes() {
    let sphere =
        |x, radius, speed| Ball { center: [x, 5.0, 5.0], radius, velocity: [speed, 0.0, 0.0] };
    let setup = Setup {
        balls: vec![sphere(2.0, 1.0, 3.0), sphere(4.0, 0.5, 0.0)],
        bounds: Aabb::new([0.0; 3], [10.0; 3]),
        gravity: [0.0; 3],
        restitution: 1.0,
        time_step: 1.0 / 60.0,
        substeps: 4,
    };
    let simulation = after(&setup, 30);
    assert_near(simulation.velocities()[0][0], 3.0 * 7.0 / 9.0, 0.001);
    assert_near(simulation.velocities()[1][0], 3.0 * 16.0 / 9.0, 0.001);
}

/// The height of a bounce is the square of the restitution.
#[test]
fn a_bounce_returns_the_share_of_energy_that_restitution_says() {
    let setup = canvas(vec![Ball::at_rest([300.0, 100.0], 50.0)], [600.0, 400.0]);
    let mut simulation = Simulation::new(&setup).unwrap();
    let mut heights = Vec::new();
    for _ in 0..200 {
        simulation.step(|| 0.0).unwrap();
        heights.push(350.0 - simulation.positions()[0][1]);
    }
    let low = heights.iter().position(|&height| height < 10.0).unwrap();
    let bounce = heights[low + 5..].iter().copied().fold(0.0, f32::max);
    assert_near(bounce, 250.0 * 0.96 * 0.96, 1.0);
}

#[test]
fn free_fall_is_exact() {
    let setup = canvas(vec![Ball::at_rest([300.0, 50.0], 10.0)], [600.0, 400.0]);
    let simulation = after(&setup, 60);
    assert_near(simulation.positions()[0][1], 50.0 + 0.5 * 500.0, 0.02);
}

#[test]
fn a_ball_on_the_floor_stays_there() {
    let balls = vec![Ball::at_rest([300.0, 350.0], 50.0), Ball::at_rest([300.0, 290.0], 10.0)];
    let simulation = after(&canvas(balls, [600.0, 400.0]), 300);
    assert_near(simulation.positions()[0][1], 350.0, 0.01);
    assert!(simulation.velocities().iter().all(|velocity| velocity[1].abs() < 0.1));
}

/// Centers in one place have no direction between them; they part all the same.
#[test]
fn coincident_balls_separate() {
    for count in [2, 3, 12] {
        let balls = vec![Ball::at_rest([300.0, 200.0], 10.0); count];
        let setup = Setup { gravity: [0.0; 2], ..canvas(balls, [600.0, 400.0]) };
        let simulation = after(&setup, 300);
        for (index, a) in simulation.positions().iter().enumerate() {
            assert!(a.iter().all(|x| x.is_finite()));
            for b in &simulation.positions()[..index] {
                let distance = ((a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)).sqrt();
                assert!(distance > 15.0, "{count}: two are {distance} apart");
            }
        }
    }
}

/// Each moves eight radii in a substep, and yet they meet.
#[test]
fn fast_balls_do_not_pass_through_each_other() {
    let balls =
        vec![ball(100.0, 200.0, 3.0, [6000.0, 0.0]), ball(500.0, 200.0, 3.0, [-6000.0, 0.0])];
    let simulation = after(&frictionless(balls), 3);
    assert!(simulation.positions()[0][0] < simulation.positions()[1][0]);
    assert!(simulation.velocities()[0][0] < 0.0 && simulation.velocities()[1][0] > 0.0);
}

#[test]
fn balls_pass_through_each_other_without_collisions() {
    let balls = vec![ball(100.0, 200.0, 20.0, [120.0, 0.0]), ball(200.0, 200.0, 20.0, [0.0; 2])];
    let mut simulation = Simulation::new(&frictionless(balls)).unwrap();
    simulation.set_collisions(false);
    let mut met = false;
    for _ in 0..100 {
        met |= simulation.step(|| 0.0).unwrap().contacts > 0;
    }
    assert!(met, "contacts are found and counted");
    assert_near(simulation.positions()[0][0], 300.0, 0.01);
    assert_eq!(simulation.positions()[1], [200.0, 200.0]);
}

#[test]
fn momentum_is_kept() {
    let balls = (0..8).map(|i| {
        let angle = i as f32 * 0.785;
        let place = [300.0 + 90.0 * angle.cos(), 200.0 + 90.0 * angle.sin()];
        let velocity = [-150.0 * angle.cos() + 20.0, -150.0 * angle.sin()];
        Ball { center: place, radius: 8.0 + i as f32, velocity }
    });
    let setup = Setup { restitution: 0.5, ..frictionless(balls.collect()) };
    let momentum = |simulation: &Simulation<2>| {
        let masses = simulation.radii().iter().map(|radius| radius * radius);
        let each = simulation.velocities().iter().zip(masses);
        each.fold([0.0, 0.0], |[x, y], (v, m)| [x + m * v[0], y + m * v[1]])
    };
    let before = momentum(&Simulation::new(&setup).unwrap());
    let after = momentum(&after(&setup, 60));
    assert_near(after[0], before[0], 2.0);
    assert_near(after[1], before[1], 2.0);
}

#[test]
fn a_simulation_without_balls_steps() {
    let simulation = after(&canvas(Vec::new(), [600.0, 400.0]), 3);
    assert_eq!(simulation.energy().total(), 0.0);
    assert_eq!(simulation.steps(), 3);
}

/// Whatever is done to gravity on the way, the state stays finite and inside.
#[test]
fn changing_gravity_keeps_the_state_finite_and_inside() {
    let balls = (0..30).map(|i| Ball::at_rest([20.0 + 19.0 * i as f32, 200.0], 9.0)).collect();
    let mut simulation = Simulation::new(&canvas(balls, [600.0, 400.0])).unwrap();
    for step in 0..200 {
        let strength = if step % 2 == 0 { 1e6 } else { -1e6 };
        simulation.set_gravity([strength, -strength]).unwrap();
        simulation.set_substeps(1 + step % 5).unwrap();
        simulation.step(|| 0.0).unwrap();
        for [x, y] in simulation.positions() {
            assert!((9.0..=591.0).contains(x) && (9.0..=391.0).contains(y));
        }
    }
    assert!(simulation.velocities().as_flattened().iter().all(|speed| speed.is_finite()));
}

/// Resting contacts keep their impulses from step to step, so a heap is where a copy that lacks
/// something would go another way.
#[test]
fn a_restored_simulation_takes_the_same_steps_bit_for_bit() {
    let population = scenes::Population { bodies: 40, size: 20.0, spread: 3.0, seed: 3 };
    let mut simulation =
        Simulation::new(&scenes::bouncing(population, [600.0, 400.0]).unwrap()).unwrap();
    let walk = |simulation: &mut Simulation<2>, steps| -> Vec<u64> {
        (0..steps)
            .map(|_| {
                simulation.step(|| 0.0).unwrap();
                simulation.hash()
            })
            .collect()
    };
    walk(&mut simulation, 900);
    let (moment, hash, energy) = (simulation.save(), simulation.hash(), simulation.energy());
    let first = walk(&mut simulation, 200);
    assert_ne!(first[0], hash, "it moves");
    simulation.restore(&moment);
    assert_eq!((simulation.hash(), simulation.energy()), (hash, energy));
    assert_eq!(simulation.steps(), 900);
    assert_eq!(walk(&mut simulation, 200), first);
}

#[test]
fn a_ball_is_placed_inside_the_walls_or_refused() {
    let setup = canvas(vec![ball(100.0, 100.0, 20.0, [0.0; 2]); 2], [600.0, 400.0]);
    let mut simulation = Simulation::new(&setup).unwrap();
    simulation.place(1, [1e9, -7.0], [3.0, 4.0]).unwrap();
    assert_eq!(simulation.positions(), [[100.0, 100.0], [580.0, 20.0]]);
    let energy = simulation.energy();
    assert!((energy.kinetic - 0.5 * 12.5).abs() < 1e-3, "{energy:?}");
    let hash = simulation.hash();
    for (index, at) in [(2, [1.0, 1.0]), (0, [f32::NAN, 1.0]), (0, [1.0, f32::INFINITY])] {
        assert_eq!(simulation.place(index, at, [0.0; 2]), Err(SetupError::Ball { index }));
    }
    let endless = simulation.place(1, [1.0, 1.0], [f32::NEG_INFINITY, 0.0]);
    assert_eq!(endless, Err(SetupError::Ball { index: 1 }));
    assert_eq!(simulation.hash(), hash);
}
