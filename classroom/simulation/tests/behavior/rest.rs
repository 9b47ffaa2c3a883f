//! Many bodies come to rest, in the box, without exploding and without sinking into each other.

use sweep_and_prune_simulation::scenes::{self, Population};
use sweep_and_prune_simulation::{Setup, Simulation};

/// The deepest overlap, in radii of the smaller ball, and the mean of all.
fn overlaps<const D: usize>(simulation: &Simulation<D>) -> (f32, f32) {
    let (positions, radii) = (simulation.positions(), simulation.radii());
    let depths: Vec<f32> = simulation
        .pairs()
        .iter()
        .map(|pair| {
            let [a, b] = pair.map(|id| id as usize);
            let square: f32 =
                (0..D).map(|axis| (positions[a][axis] - positions[b][axis]).powi(2)).sum();
            (radii[a] + radii[b] - square.sqrt()) / radii[a].min(radii[b])
        })
        .filter(|&depth| depth > 0.0)
        .collect();
    let deepest = depths.iter().copied().fold(0.0, f32::max);
    (deepest, depths.iter().sum::<f32>() / depths.len().max(1) as f32)
}

fn assert_inside<const D: usize>(simulation: &Simulation<D>) {
    let bounds = simulation.bounds();
    for (position, &radius) in simulation.positions().iter().zip(simulation.radii()) {
        for axis in 0..D {
            let (low, high) = (bounds.min[axis] + radius, bounds.max[axis] - radius);
            assert!((low..=high).contains(&position[axis]), "a ball is outside at {position:?}");
        }
    }
}

/// What is true of balls that have fallen for `steps` steps.
struct Rest {
    kinetic_energy: f64,
    deepest: f32,
    mean: f32,
    /// The mean height of the centers.
    height: f64,
}

fn drop_all<const D: usize>(setup: &Setup<D>, steps: u32) -> Rest {
    let mut simulation = Simulation::new(setup).unwrap();
    simulation.set_counting(false);
    for _ in 0..steps {
        simulation.step(|| 0.0).unwrap();
        assert_inside(&simulation);
    }
    let (deepest, mean) = overlaps(&simulation);
    let energy = simulation.energy();
    let height = energy.potential / f64::from(setup.gravity[1]).abs();
    Rest { kinetic_energy: energy.kinetic, deepest, mean, height }
}

/// After four seconds.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow where nothing is optimized")]
fn falling_spheres_come_to_rest() {
    let population = Population { bodies: 10_000, size: 0.2, spread: 1.0, seed: 1 };
    let setup = scenes::falling::<3>(population).unwrap();
    let rest = drop_all(&setup, 240);
    // Spheres that move a thousandth of their radius a step have 0.5 * 0.012² = 0.00007; gravity
    // alone, before support is felt, gives (g h)²/8 = 0.0002.
    assert!(rest.kinetic_energy < 0.003, "kinetic energy {}", rest.kinetic_energy);
    assert!(rest.deepest < 0.1, "deepest overlap {}", rest.deepest);
    assert!(rest.mean < 0.02, "mean overlap {}", rest.mean);
    // A random packing fills 0.55 to 0.64 of the space; the top layer is rough.
    let volume: f64 = 10_000.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.2f64.powi(3);
    let filled = volume / (100.0 * 2.0 * rest.height);
    assert!((0.55..0.68).contains(&filled), "fills {filled} of the space");
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow where nothing is optimized")]
fn falling_discs_come_to_rest() {
    let population = Population { bodies: 5_000, size: 0.06, spread: 1.0, seed: 1 };
    let rest = drop_all(&scenes::falling::<2>(population).unwrap(), 240);
    assert!(rest.kinetic_energy < 0.003, "kinetic energy {}", rest.kinetic_energy);
    assert!(rest.deepest < 0.4, "deepest overlap {}", rest.deepest);
    assert!(rest.mean < 0.05, "mean overlap {}", rest.mean);
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow where nothing is optimized")]
fn discs_of_very_different_sizes_come_to_rest() {
    let population = Population { bodies: 5_000, size: 0.06, spread: 8.0, seed: 1 };
    let rest = drop_all(&scenes::falling::<2>(population).unwrap(), 300);
    assert!(rest.kinetic_energy < 0.003, "kinetic energy {}", rest.kinetic_energy);
    assert!(rest.mean < 0.15, "mean overlap {}", rest.mean);
}
