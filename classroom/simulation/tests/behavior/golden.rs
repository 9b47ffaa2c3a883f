//! The same bits in every build, over every broad phase.

use sweep_and_prune_algorithms::{Axis, Method, RunnerOptions, Sort};
use sweep_and_prune_simulation::scenes::{self, Population};
use sweep_and_prune_simulation::{BroadPhase, Setup, Simulation};

const GOLDEN: &str = include_str!("../../golden.txt");

/// The hash after `steps` steps, with one broad phase or another.
fn hash<const D: usize>(setup: &Setup<D>, steps: u32, choice: BroadPhase) -> u64 {
    let mut simulation = Simulation::new(setup).unwrap();
    simulation.set_broad_phase(choice).unwrap();
    for _ in 0..steps {
        simulation.step(|| 0.0).unwrap();
    }
    simulation.hash()
}

/// One line of the file: scene, dimensions, bodies, size, spread, seed, steps, hash.
fn computed_line(line: &str, choice: BroadPhase) -> String {
    let fields: Vec<&str> = line.split(' ').collect();
    let [scene, dimensions, bodies, size, spread, seed, steps, _] = fields[..] else {
        panic!("'{line}' has not eight fields")
    };
    let population = Population {
        bodies: bodies.parse().unwrap(),
        size: size.parse().unwrap(),
        spread: spread.parse().unwrap(),
        seed: seed.parse().unwrap(),
    };
    let number = steps.parse().unwrap();
    let hash = match (scene, dimensions) {
        ("falling", "2") => hash(&scenes::falling::<2>(population).unwrap(), number, choice),
        ("falling", "3") => hash(&scenes::falling::<3>(population).unwrap(), number, choice),
        ("bouncing", "2") => {
            hash(&scenes::bouncing(population, [600.0, 400.0]).unwrap(), number, choice)
        }
        _ => panic!("'{line}' names no scene"),
    };
    format!("{scene} {dimensions} {bodies} {size} {spread} {seed} {steps} {hash:016x}")
}

fn report(choice: BroadPhase) -> String {
    GOLDEN.lines().map(|line| computed_line(line, choice) + "\n").collect()
}

#[test]
fn state_is_golden() {
    let report = report(BroadPhase::Library);
    assert_eq!(report, GOLDEN, "if the change is meant, this is the new golden.txt:\n{report}");
}

/// Every algorithm finds its pairs in another order; the motion must not depend on it.
#[test]
fn every_algorithm_gives_the_same_state() {
    for method in Method::ALL {
        let (sort, axis, persistent) = (Sort::Insertion, Axis::LargestVariance, true);
        let options = RunnerOptions::new(method).sort(sort).axis(axis).persistent(persistent);
        assert_eq!(report(BroadPhase::Algorithm(options)), GOLDEN, "{options:?}");
    }
}

/// Neither counting nor a change of algorithm on the way leaves a trace.
#[test]
fn switching_algorithms_and_counting_do_not_change_the_motion() {
    let population = Population { bodies: 150, size: 0.5, spread: 3.0, seed: 5 };
    let setup = scenes::falling::<2>(population).unwrap();
    let mut plain = Simulation::new(&setup).unwrap();
    plain.set_counting(false);
    let mut restless = Simulation::new(&setup).unwrap();
    for step in 0..70 {
        let method = Method::ALL[step % Method::ALL.len()];
        let axis = Axis::Fixed(step % 2);
        let options = RunnerOptions::new(method).sort(Sort::Insertion).axis(axis).persistent(true);
        restless.set_broad_phase(BroadPhase::Algorithm(options)).unwrap();
        let counts = restless.step(|| 0.0).unwrap().counts;
        assert!(counts.is_some());
        assert!(plain.step(|| 0.0).unwrap().counts.is_none());
        assert_eq!(plain.hash(), restless.hash());
    }
}

#[test]
fn counts_mean_the_same_for_each_algorithm() {
    let population = Population { bodies: 60, size: 0.5, spread: 1.0, seed: 5 };
    let setup = scenes::falling::<3>(population).unwrap();
    let counts = |method, persistent| {
        let mut simulation = Simulation::new(&setup).unwrap();
        let axis = Axis::Fixed(0);
        let options =
            RunnerOptions::new(method).sort(Sort::Standard).axis(axis).persistent(persistent);
        simulation.set_broad_phase(BroadPhase::Algorithm(options)).unwrap();
        for _ in 0..60 {
            simulation.step(|| 0.0).unwrap();
        }
        let report = simulation.step(|| 0.0).unwrap();
        let counts = report.counts.unwrap();
        assert_eq!(report.pairs, simulation.pairs().len());
        assert_eq!(counts.pairs, report.pairs as u64);
        counts
    };
    let brute = counts(Method::Pairwise, false);
    assert_eq!((brute.tests, brute.comparisons, brute.swaps), (60 * 59 / 2, 0, 0));
    for persistent in [false, true] {
        for method in [Method::SortedPairwise, Method::EndpointSweep, Method::SwapSweep] {
            let swept = counts(method, persistent);
            assert_eq!(swept.axis_overlaps, brute.axis_overlaps, "{method:?}");
            assert_eq!(swept.tests, brute.axis_overlaps, "{method:?}");
            assert_eq!(swept.pairs, brute.pairs, "{method:?}");
        }
        let [sweeps, swaps] = [Method::AxisSweeps, Method::AxisSwapSweeps]
            .map(|method| counts(method, persistent).axis_overlaps);
        assert_eq!(sweeps, swaps, "summed over the axes");
    }
}

/// A world of 5,000 balls took 12 million comparisons of an insertion sort in its first step.
#[test]
fn a_first_step_is_sorted_by_the_library() {
    let population = Population { bodies: 5_000, size: 0.03, spread: 8.0, seed: 1 };
    let mut simulation = Simulation::new(&scenes::falling::<2>(population).unwrap()).unwrap();
    for method in [Method::SortedPairwise, Method::EndpointSweep] {
        let options = RunnerOptions::new(method).sort(Sort::Insertion).persistent(true);
        simulation.set_broad_phase(BroadPhase::Algorithm(options)).unwrap();
        let mut comparisons = || simulation.step(|| 0.0).unwrap().counts.unwrap().comparisons;
        let (first, second) = (comparisons(), comparisons());
        assert!(first < 200_000, "{method:?}: {first}");
        assert!(second < 60_000, "{method:?}: {second}");
    }
}

#[test]
fn refused_axis_changes_nothing() {
    let population = Population { bodies: 10, size: 0.5, spread: 1.0, seed: 5 };
    let mut simulation = Simulation::new(&scenes::falling::<2>(population).unwrap()).unwrap();
    let (method, sort) = (Method::SortedPairwise, Sort::Standard);
    let options =
        |axis| RunnerOptions::new(method).sort(sort).axis(Axis::Fixed(axis)).persistent(true);
    simulation.set_broad_phase(BroadPhase::Algorithm(options(1))).unwrap();
    assert!(simulation.set_broad_phase(BroadPhase::Algorithm(options(2))).is_err());
    assert!(simulation.step(|| 0.0).unwrap().counts.is_some());
}

/// The clock is read, and nothing but the report depends on it.
#[test]
fn times_come_from_the_clock() {
    let population = Population { bodies: 10, size: 0.5, spread: 1.0, seed: 5 };
    let mut simulation = Simulation::new(&scenes::falling::<2>(population).unwrap()).unwrap();
    let ticks = std::cell::Cell::new(0.0);
    let report = simulation
        .step(|| {
            ticks.set(ticks.get() + 1.0);
            ticks.get()
        })
        .unwrap();
    let substeps = f64::from(simulation.substeps());
    assert_eq!(report.broad_phase_ms, 2.0 * substeps, "boxes, pairs");
    assert_eq!(report.narrow_phase_ms, substeps);
    assert_eq!(report.total_ms, 5.0 * substeps, "all but the counting");
}
