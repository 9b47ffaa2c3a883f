//! What every scene and every motion promises, and what the classic ones are known for.

use sweep_and_prune::{Aabb, Scalar, find_pairs, validate};
use sweep_and_prune_scenes::{Motion, Scene, golden_report, hash, hash_boxes, hash_pairs};

/// Runs a generic check `fn check<const D: usize, T: Scalar>()` in every dimension and type.
macro_rules! in_all_dimensions {
    ($check:ident) => {
        $check::<1, f32>();
        $check::<2, f32>();
        $check::<3, f32>();
        $check::<1, f64>();
        $check::<2, f64>();
        $check::<3, f64>();
    };
}

/// Line by line, so that a failure names the scene.
#[test]
fn golden_results_hold() {
    let report = golden_report();
    let golden = include_str!("../golden.txt");
    for (now, golden) in report.lines().zip(golden.lines()) {
        assert_eq!(now, golden);
    }
    assert_eq!(report.lines().count(), golden.lines().count());
}

#[test]
fn any_number_and_any_seed_give_valid_boxes() {
    fn check<const D: usize, T: Scalar>() {
        for &scene in Scene::ALL.iter().filter(|scene| scene.dimensions().contains(&D)) {
            for n in [0, 1, 2, 3, 7, 8, 9, 33, 1000] {
                for seed in [0, 1, u64::MAX] {
                    let boxes = scene.boxes::<D, T>(n, seed).unwrap();
                    assert_eq!(boxes.len(), n, "{} in {D}D", scene.name());
                    assert_eq!(validate(&boxes), Ok(()), "{} in {D}D, n = {n}", scene.name());
                }
            }
        }
    }
    in_all_dimensions!(check);
}

#[test]
fn equal_seeds_give_equal_scenes_and_others_differ() {
    let boxes = |scene: Scene, seed| scene.boxes::<3, f32>(50, seed).unwrap();
    for &scene in Scene::ALL {
        assert_eq!(boxes(scene, 5), boxes(scene, 5));
        assert_eq!(
            boxes(scene, 5) == boxes(scene, 6),
            scene == Scene::BoxPruning,
            "{}",
            scene.name()
        );
    }
}

#[test]
fn f32_boxes_are_the_f64_boxes_rounded() {
    for &scene in Scene::ALL {
        if [Scene::Extreme, Scene::Subnormal].contains(&scene) {
            continue; // made of the limits of the type
        }
        let (narrow, wide) = (scene.boxes::<3, f32>(99, 4), scene.boxes::<3, f64>(99, 4));
        for (narrow, wide) in narrow.unwrap().iter().zip(wide.unwrap()) {
            assert_eq!(*narrow, Aabb::new(wide.min.map(|x| x as f32), wide.max.map(|x| x as f32)));
        }
    }
}

#[test]
fn names_are_unique_and_found_again() {
    for &scene in Scene::ALL {
        assert_eq!(Scene::from_name(scene.name()), Some(scene));
    }
    for motion in Motion::ALL {
        assert_eq!(Motion::from_name(motion.name()), Some(motion));
        assert_eq!(Scene::from_name(motion.name()), None);
    }
    assert_eq!(Scene::from_name("Uniform"), None);
}

#[test]
fn scenes_exist_in_the_dimensions_that_they_list() {
    assert!(Scene::BoxPruning.boxes::<2, f32>(9, 1).is_none());
    assert!(Scene::BoxPruning.boxes::<3, f32>(9, 1).is_some());
    assert!(Scene::NeedlesY.boxes::<1, f32>(9, 1).is_none());
    assert!(Scene::Uniform.boxes::<4, f32>(9, 1).is_none());
    assert!(Scene::Uniform.boxes::<0, f32>(9, 1).is_none());
    assert!(Motion::Drift.start::<0, f32>(9, 1).is_none());
    assert!(Motion::Drift.start::<4, f32>(9, 1).is_none());
}

/// The test vectors of the authors of FNV.
#[test]
fn the_hash_is_fnv_1a() {
    assert_eq!(hash([]), 0xcbf2_9ce4_8422_2325);
    assert_eq!(hash(*b"a"), 0xaf63_dc4c_8601_ec8c);
    assert_eq!(hash(*b"foobar"), 0x8594_4171_f739_67e8);
    assert_eq!(hash_pairs(&[[1, 2]]), hash([1, 0, 0, 0, 2, 0, 0, 0]));
    let zero = |zero: f32| hash_boxes(&[Aabb::new([zero], [1.0])]);
    assert_ne!(zero(0.0), zero(-0.0));
}

/// The counts that Terdiman published.
#[test]
fn box_pruning_has_its_known_pairs() {
    let pairs = |n| find_pairs(&Scene::BoxPruning.boxes::<3, f32>(n, 0).unwrap()).unwrap().len();
    assert_eq!(pairs(10_000), 11_811);
    if !cfg!(debug_assertions) {
        assert_eq!(pairs(100_000), 1_144_045);
    }
}

#[test]
fn scenes_have_about_the_intended_number_of_pairs() {
    fn pairs<const D: usize, T: Scalar>(scene: Scene, n: usize) -> usize {
        find_pairs(&scene.boxes::<D, T>(n, 11).unwrap()).unwrap().len()
    }
    fn check<const D: usize, T: Scalar>() {
        let n = 2000;
        let near = |found: usize, expected: f64| {
            assert!((found as f64) < 1.2 * expected && found as f64 > 0.8 * expected, "{found}");
        };
        near(pairs::<D, T>(Scene::Uniform, n), 1.2 * n as f64);
        near(pairs::<D, T>(Scene::Diagonal, n), 1.2 * n as f64);
        assert_eq!(pairs::<D, T>(Scene::Coincident, 300), 300 * 299 / 2);
        assert_eq!(pairs::<D, T>(Scene::Nested, 300), 300 * 299 / 2);
        for order in [Scene::Sorted, Scene::Reversed, Scene::NearlySorted] {
            assert_eq!(pairs::<D, T>(order, n), pairs::<D, T>(Scene::Uniform, n));
        }
        // The giant meets the boxes that it did not meet as one of the crowd.
        assert!(pairs::<D, T>(Scene::Giant, n) > pairs::<D, T>(Scene::Uniform, n) + n - 20);
        assert!(pairs::<D, T>(Scene::Beam, n) > pairs::<D, T>(Scene::Uniform, n));
        assert!(pairs::<D, T>(Scene::Giants, n) > n / 10 * n * 9 / 10);
    }
    in_all_dimensions!(check);
    // A full lattice of w by w (by w): each box and those around it, counted once.
    assert_eq!(pairs::<1, f32>(Scene::Grid, 50), 49);
    assert_eq!(pairs::<2, f32>(Scene::Grid, 100), (28 * 28 - 100) / 2);
    assert_eq!(pairs::<3, f32>(Scene::Grid, 1000), (28 * 28 * 28 - 1000) / 2);
    assert_eq!(pairs::<2, f32>(Scene::Flat, 10), pairs::<2, f64>(Scene::Flat, 10));
}

#[test]
fn nested_boxes_are_strictly_nested() {
    let boxes = Scene::Nested.boxes::<2, f64>(1000, 3).unwrap();
    for pair in boxes.windows(2) {
        assert!((0..2).all(|k| pair[1].min[k] < pair[0].min[k] && pair[0].max[k] < pair[1].max[k]));
    }
}

#[test]
fn scenes_contain_signed_zeros_infinities_and_subnormals() {
    let coordinates = |scene: Scene| -> Vec<f32> {
        let boxes = scene.boxes::<2, f32>(400, 1).unwrap();
        boxes.iter().flat_map(|aabb| [aabb.min, aabb.max]).flatten().collect()
    };
    let any = |scene, test: fn(&f32) -> bool| coordinates(scene).iter().any(test);
    let all = |scene, test: fn(&f32) -> bool| coordinates(scene).iter().all(test);
    assert!(
        any(Scene::Points, |x| x.to_bits() == 0) && any(Scene::Points, |x| x.to_bits() == 1 << 31)
    );
    assert!(any(Scene::Infinite, |x| *x == f32::INFINITY));
    assert!(any(Scene::Infinite, |x| *x == f32::NEG_INFINITY));
    assert!(all(Scene::Extreme, |x| x.is_finite()) && any(Scene::Extreme, |x| *x > f32::MAX / 1.1));
    assert!(any(Scene::Extreme, |x| *x < -f32::MAX / 1.1));
    assert!(all(Scene::Subnormal, |x| *x == 0.0 || x.is_subnormal()));
    assert!(any(Scene::Huge, |x| *x > 9e29) && any(Scene::Tiny, |x| *x > 9e-31));
    assert!(all(Scene::Tiny, |x| x.abs() <= 1e-30));
}

#[test]
fn orders_are_what_their_names_say() {
    let descents = |scene: Scene| {
        let boxes = scene.boxes::<2, f64>(1000, 1).unwrap();
        boxes.windows(2).filter(|pair| pair[0].min[0] > pair[1].min[0]).count()
    };
    assert_eq!(descents(Scene::Sorted), 0);
    assert_eq!(descents(Scene::Reversed), 999);
    assert!((50..=100).contains(&descents(Scene::NearlySorted)));
}

#[test]
fn moving_boxes_keep_to_the_cube_and_to_their_size() {
    fn check<const D: usize, T: Scalar>() {
        // One box is wider than the cube, and fast enough to meet two walls in a frame.
        let runs = (0..20).flat_map(|seed| [(0, seed), (1, seed), (2, seed)]).chain([(40, 2)]);
        for (motion, (n, seed)) in
            Motion::ALL.into_iter().flat_map(|m| runs.clone().map(move |r| (m, r)))
        {
            let mut moving = motion.start::<D, T>(n, seed).unwrap();
            for _ in 0..100 {
                moving.advance();
                assert_eq!(moving.boxes().len(), n);
                assert_eq!(validate(moving.boxes()), Ok(()));
                for aabb in moving.boxes() {
                    for k in 0..D {
                        let center = (aabb.min[k].to_f64() + aabb.max[k].to_f64()) / 2.0;
                        assert!((-1e-6..=1.0 + 1e-6).contains(&center), "{center}");
                    }
                }
            }
        }
    }
    in_all_dimensions!(check);
}

#[test]
fn motions_move_as_many_boxes_as_they_say() {
    let n = 2000;
    // The mean distance on x in box widths, among those that moved, their share, and jumps.
    let measure = |motion: Motion| {
        let mut moving = motion.start::<1, f64>(n, 9).unwrap();
        let (mut distance, mut moved, mut jumped) = (0.0, 0.0, 0.0);
        for _ in 0..10 {
            let before = moving.boxes().to_vec();
            moving.advance();
            for (a, b) in before.iter().zip(moving.boxes()) {
                let step = (a.min[0] - b.min[0]).abs() / (a.max[0] - a.min[0]);
                if step > 1.01 {
                    jumped += 0.1 / n as f64;
                } else if step > 0.0 {
                    distance += step;
                    moved += 1.0;
                }
            }
        }
        (distance / moved, moved / (10 * n) as f64, jumped)
    };
    let check = |motion: Motion, expected: [f64; 3]| {
        let (distance, moved, jumped) = measure(motion);
        for (found, expected) in [distance, moved, jumped].into_iter().zip(expected) {
            assert!((found - expected).abs() <= 0.1 * expected, "{found} instead of {expected}");
        }
    };
    check(Motion::Drift, [0.05, 1.0, 0.0]);
    check(Motion::Fast, [0.5, 1.0, 0.0]);
    check(Motion::MostlyStill, [0.05, 0.1, 0.0]);
    check(Motion::Teleport, [0.05, 0.99, 0.01]);
}
