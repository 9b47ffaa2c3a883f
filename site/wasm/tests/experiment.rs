//! The comparison is fair only if all algorithms see the same boxes and find the same pairs.

use sweep_and_prune::Aabb;
use sweep_and_prune_algorithms::{Axis, Counts, Method, Runner, RunnerOptions, Sort};
use sweep_and_prune_scenes::Scene;
use sweep_and_prune_site_wasm::experiment::{Experiment, open_given};
use sweep_and_prune_site_wasm::motion::{LAWS, Moving, resize};
use sweep_and_prune_site_wasm::searcher::{Choice, Searcher, forecast};

const SCENES: [Scene; 5] =
    [Scene::Uniform, Scene::Clustered, Scene::Mixed, Scene::Grid, Scene::Needles];

fn algorithm(method: Method, sort: Sort) -> Choice {
    let axis = Axis::LargestVariance;
    Choice::Algorithm(RunnerOptions::new(method).sort(sort).axis(axis).persistent(true))
}

fn everyone() -> Vec<Choice> {
    let methods = Method::ALL.into_iter().enumerate();
    let algorithms = methods.map(|(i, method)| algorithm(method, Sort::ALL[i % Sort::ALL.len()]));
    [Choice::Finder, Choice::World].into_iter().chain(algorithms).collect()
}

fn race<const D: usize>(scene: Scene, law: usize) {
    let boxes = scene.boxes::<D, f32>(150, 7).unwrap();
    let mut world = Moving::new(boxes, &LAWS[law], 7);
    let mut searchers: Vec<Searcher<D>> =
        everyone().into_iter().map(|choice| Searcher::new(choice).unwrap()).collect();
    for step in 0..12 {
        let brute = brute_force(world.boxes());
        let mut fingerprints = Vec::new();
        for (who, searcher) in searchers.iter_mut().enumerate() {
            let report = searcher.run(world.boxes(), true, || 0.0).unwrap();
            let mut pairs = searcher.pairs().to_vec();
            pairs.sort_unstable();
            assert_eq!(pairs, brute, "{scene:?}, law {law}, step {step}, searcher {who}");
            assert_eq!(report.pairs, brute.len());
            fingerprints.push(report.fingerprint);
        }
        assert!(fingerprints.iter().all(|&one| one == fingerprints[0]), "in whatever order");
        world.advance();
    }
}

fn brute_force<const D: usize>(boxes: &[Aabb<D>]) -> Vec<[u32; 2]> {
    let n = boxes.len() as u32;
    let all = (0..n).flat_map(|a| (a + 1..n).map(move |b| [a, b]));
    all.filter(|&[a, b]| boxes[a as usize].overlaps(&boxes[b as usize])).collect()
}

#[test]
fn every_searcher_finds_the_pairs_in_every_motion() {
    for scene in SCENES {
        for law in 0..LAWS.len() {
            race::<2>(scene, law);
            race::<3>(scene, law);
        }
    }
}

#[test]
fn other_pairs_have_another_fingerprint() {
    let boxes = Scene::Uniform.boxes::<2, f32>(100, 1).unwrap();
    let print = |boxes: &[Aabb<2>]| {
        let mut finder = Searcher::new(Choice::Finder).unwrap();
        let report = finder.run(boxes, false, || 0.0).unwrap();
        (report.pairs, report.fingerprint)
    };
    let mut swapped = boxes.clone();
    swapped.swap(0, 50);
    assert_eq!(print(&boxes).0, print(&swapped).0, "as many");
    assert_ne!(print(&boxes).1, print(&swapped).1, "of others");
}

#[test]
fn a_world_begins_with_the_bits_of_its_scene() {
    for scene in SCENES {
        let boxes = scene.boxes::<3, f32>(300, 5).unwrap();
        let mut same = boxes.clone();
        resize(&mut same, 1.0, 1.0, 5);
        for law in &LAWS {
            assert_eq!(Moving::new(same.clone(), law, 5).boxes(), boxes);
        }
    }
}

#[test]
fn size_and_spread_scale_the_boxes_as_documented() {
    let boxes = Scene::Uniform.boxes::<2, f32>(2_000, 5).unwrap();
    let width = |aabb: &Aabb<2>| aabb.max[0] - aabb.min[0];
    let mut larger = boxes.clone();
    resize(&mut larger, 3.0, 16.0, 5);
    let factors: Vec<f32> = boxes.iter().zip(&larger).map(|(a, b)| width(b) / width(a)).collect();
    let least = factors.iter().copied().fold(f32::INFINITY, f32::min);
    let most = factors.iter().copied().fold(0.0, f32::max);
    assert!((0.74..0.77).contains(&least) && (11.8..12.1).contains(&most), "{least} {most}");
}

#[test]
fn boxes_stay_valid_and_where_they_were_for_a_long_time() {
    for law in &LAWS {
        let boxes = Scene::Clustered.boxes::<2, f32>(200, 3).unwrap();
        let mut world = Moving::new(boxes.clone(), law, 3);
        (0..1_000).for_each(|_| world.advance());
        let moved = world.boxes().iter().zip(&boxes).filter(|(a, b)| a != b).count();
        match law.name {
            "still" => assert_eq!(moved, 0),
            "mostly still" => assert!((5..50).contains(&moved), "{moved}"),
            _ => assert_eq!(moved, 200, "{}", law.name),
        }
        for aabb in world.boxes() {
            assert!(aabb.invalid_axis().is_none());
            assert!(aabb.min.iter().all(|&at| (-2.0..3.0).contains(&at)), "{aabb:?}");
        }
    }
}

#[test]
fn the_forecast_is_what_the_first_run_does() {
    for scene in SCENES {
        let boxes = scene.boxes::<2, f32>(400, 2).unwrap();
        for method in Method::ALL {
            let choice = algorithm(method, Sort::Standard);
            let report = Searcher::new(choice).unwrap().run(&boxes, true, || 0.0).unwrap();
            let counts = report.counts.unwrap();
            let cast = forecast(choice, &boxes).unwrap();
            let tested = if counts.tests > 0 { counts.tests } else { counts.axis_overlaps };
            assert_eq!(cast.tests, tested as f64, "{scene:?}, {method:?}");
        }
    }
}

/// Brute force is not observed, because its counts are known in advance.
#[test]
fn brute_force_has_the_counts_that_an_observer_sees() {
    for scene in SCENES {
        let boxes = scene.boxes::<3, f32>(150, 2).unwrap();
        let choice = algorithm(Method::Pairwise, Sort::Standard);
        let Choice::Algorithm(options) = choice else { unreachable!() };
        let mut observed = Counts::default();
        Runner::new(options).step(&boxes, &mut observed).unwrap();
        let counts = Searcher::new(choice).unwrap().run(&boxes, true, || 0.0).unwrap().counts;
        let Counts { tests, axis_overlaps, comparisons, swaps, .. } = counts.unwrap();
        assert_eq!((tests, axis_overlaps), (observed.tests, observed.axis_overlaps), "{scene:?}");
        assert_eq!((comparisons, swaps), (observed.comparisons, observed.swaps));
    }
}

/// Boxes that are given take the place of those of the world; the searchers go on from what they have kept.
#[test]
fn given_boxes_are_searched_as_they_are() {
    let area = |dimensions: f64| {
        std::array::from_fn(|at| [dimensions, 0.0, 0.0, 0.0, 7.0].get(at).copied().unwrap_or(0.0))
    };
    let mut rows: Vec<f32> = (0..100)
        .flat_map(|i| [(i * 37 % 100) as f32, 0.0, (i * 37 % 100) as f32 + 0.5, 1.0])
        .collect();
    let mut world = open_given(&rows, &area(2.0)).unwrap();
    let options = RunnerOptions::new(Method::SortedPairwise).sort(Sort::Insertion);
    world.enter(Choice::Algorithm(options.axis(Axis::Fixed(0)).persistent(true))).unwrap();
    let run = |world: &mut dyn Experiment| {
        let report = world.run(0, true).unwrap();
        (report.pairs, report.counts.unwrap().comparisons)
    };
    let (pairs, first) = run(&mut *world);
    assert_eq!(pairs, 0);
    assert!(first < 1_000, "sorted by the library: {first} comparisons");

    // Box 0 is made to reach into another: the order is kept, and looked at once.
    rows[2] = 1.2;
    assert_eq!(world.place(&rows, &area(2.0)), Some(()));
    assert_eq!(run(&mut *world), (1, 99));
    assert_eq!((world.count_pairs(), world.dimensions()), (Some(1), 2));

    // What is refused changes nothing.
    let inverted = [2.0, 0.0, 1.0, 1.0];
    for wrong in [inverted, [0.0, f32::NAN, 1.0, 1.0], [0.0, 0.0, f32::INFINITY, 1.0]] {
        assert_eq!(world.place(&wrong, &area(2.0)), None);
        assert!(open_given(&wrong, &area(2.0)).is_none());
    }
    assert_eq!(world.place(&[0.0; 5], &area(2.0)), None);
    assert!(open_given(&[0.0; 8], &area(4.0)).is_none());
    assert_eq!(run(&mut *world), (1, 99));
    assert!(open_given(&[0.0, 0.0, 0.0, 1.0, 1.0, 1.0], &area(3.0)).is_some());
    assert_eq!(open_given(&[], &area(2.0)).unwrap().count_pairs(), Some(0));
}
