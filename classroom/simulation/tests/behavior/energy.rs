//! The energy never grows: not in flight, not in a bounce, not in a dense heap.

use sweep_and_prune::Aabb;
use sweep_and_prune_simulation::scenes::{self, Population};
use sweep_and_prune_simulation::{Ball, Setup, Simulation};

/// Steps, and after each compares the energy with the least so far. Returns the energies.
///
/// Beside rounding there is one thing that the tolerance must hold: a ball at rest keeps half a
/// kick of gravity as its velocity, at most (g h)²/8 of energy.
fn fall<const D: usize>(setup: &Setup<D>, steps: u32) -> Vec<f64> {
    let mut simulation = Simulation::new(setup).unwrap();
    let start = simulation.energy().total();
    let mut least = start;
    let kick = setup.gravity[1] * setup.time_step / setup.substeps as f32;
    let tolerance = f64::from(kick * kick) / 8.0 + start * 1e-5;
    let energies = (1..=steps).map(|step| {
        simulation.step(|| 0.0).unwrap();
        let energy = simulation.energy().total();
        assert!(energy <= least + tolerance, "step {step}: {least} has grown to {energy}");
        least = least.min(energy);
        energy
    });
    energies.collect()
}

#[test]
fn energy_does_not_grow_in_falls_and_heaps() {
    let p = |bodies, size, spread| Population { bodies, size, spread, seed: 3 };
    fall(&scenes::falling::<3>(p(150, 0.6, 1.0)).unwrap(), 300);
    fall(&scenes::falling::<3>(p(100, 0.5, 6.0)).unwrap(), 200);
    fall(&scenes::falling::<2>(p(120, 0.3, 1.0)).unwrap(), 200);
    fall(&scenes::falling::<2>(p(80, 0.3, 20.0)).unwrap(), 200);
}

/// A heap at rest is neither compressed nor lifted: its energy stays where it is.
#[test]
fn a_heap_at_rest_keeps_its_energy() {
    let population = Population { bodies: 60, size: 0.7, spread: 1.0, seed: 3 };
    let energies = fall(&scenes::falling::<3>(population).unwrap(), 1500);
    let (settled, last) = (energies[1000], energies[1499]);
    assert!((last - settled).abs() < 0.0005 * settled, "{settled} became {last}");
}

#[test]
fn energy_does_not_grow_for_any_restitution_and_substeps() {
    for (restitution, substeps) in [(0.0, 1), (0.3, 2), (0.96, 4), (1.0, 1), (1.0, 16)] {
        let population = Population { bodies: 20, size: 25.0, spread: 5.0, seed: 8 };
        let setup = scenes::bouncing(population, [600.0, 400.0]).unwrap();
        fall(&Setup { restitution, substeps, ..setup }, 400);
    }
}

/// Where nothing takes energy away, none goes.
#[test]
fn elastic_balls_keep_their_energy() {
    let balls = [(100.0, 90.0, 30.0), (300.0, 100.0, 40.0), (470.0, 150.0, 25.0)];
    let balls: Vec<_> = balls.map(|(x, y, radius)| Ball::at_rest([x, y], radius)).to_vec();
    let energies = fall(&Setup { restitution: 1.0, ..scenes::canvas(balls, [600.0, 400.0]) }, 3600);
    let (start, end) = (energies[0], energies[3599]);
    assert!(end > 0.999 * start, "{start} has shrunk to {end}");
}

/// Overlapping starts, a heavy ball on a light one, everything in one place.
#[test]
fn energy_does_not_grow_from_overlapping_or_coincident_starts() {
    let heavy_on_light = vec![
        Ball::at_rest([100.0, 397.0], 3.0),
        Ball::at_rest([100.0, 300.0], 90.0),
        Ball::at_rest([102.0, 206.0], 4.0),
    ];
    fall(&scenes::canvas(heavy_on_light, [200.0, 400.0]), 600);
    let overlapping =
        (0..40).map(|i| Ball::at_rest([300.0 + i as f32, 200.0 + (i % 7) as f32], 20.0)).collect();
    fall(&scenes::canvas(overlapping, [600.0, 400.0]), 600);
    let coincident = vec![Ball::at_rest([300.0, 380.0], 20.0); 30];
    fall(&scenes::canvas(coincident, [600.0, 400.0]), 600);
}

/// Sideways, upwards, not at all.
#[test]
fn energy_does_not_grow_under_any_gravity() {
    let population = Population { bodies: 60, size: 0.5, spread: 2.0, seed: 8 };
    let setup = scenes::falling::<3>(population).unwrap();
    for gravity in [[0.0, 0.0, 0.0], [3.0, 9.0, -20.0], [0.0, 9.81, 0.0], [0.0, -200.0, 0.0]] {
        fall(&Setup { gravity, ..setup.clone() }, 200);
    }
}

#[test]
fn a_ball_as_wide_as_the_box_stays_in_place() {
    let balls = vec![Ball { center: [0.5, 0.5], radius: 0.5, velocity: [1e9, -3.0] }];
    let bounds = Aabb::new([0.0, 0.0], [1.0, 1.0]);
    let setup = Setup { balls, bounds, ..scenes::canvas(Vec::new(), [1.0, 1.0]) };
    let mut simulation = Simulation::new(&setup).unwrap();
    for _ in 0..100 {
        simulation.step(|| 0.0).unwrap();
        assert_eq!(simulation.positions(), [[0.5, 0.5]]);
        assert!(simulation.energy().total().is_finite());
    }
}
