//! The finder gives the pairs of brute force: on every scene, on every frame of every motion, and on
//! random boxes full of ties.

use proptest::prelude::*;
use sweep_and_prune::{Aabb, Error, PairFinder, Scalar, find_pairs, validate};
use sweep_and_prune_scenes::testing::{coordinate, valid_box, valid_boxes};
use sweep_and_prune_scenes::{Motion, Scene, brute_force, in_all_dimensions};

fn sorted(pairs: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let mut pairs = pairs.to_vec();
    pairs.sort_unstable();
    pairs
}

/// The finder finds the pairs of each set, in the same order whether its buffers are new or not.
fn finder_agrees<const D: usize, T: Scalar>(name: &str, sets: &[Vec<Aabb<D, T>>]) {
    let mut finder = PairFinder::new();
    for boxes in sets {
        let (found, expected) = (find_pairs(boxes).unwrap(), brute_force(boxes).unwrap());
        let n = boxes.len();
        assert!(sorted(&found) == expected, "{name}, {D}D: find_pairs is wrong about {n} boxes");
        assert!(finder.find(boxes).unwrap() == found, "{name}, {D}D: old buffers, {n} boxes");
    }
}

fn scenes_in<const D: usize>() -> impl Iterator<Item = Scene> {
    Scene::ALL.iter().copied().filter(|scene| scene.dimensions().contains(&D))
}

/// Enough boxes to fill many columns and vectors; more where the oracle is not a debug build.
const MANY: usize = if cfg!(debug_assertions) { 300 } else { 2000 };

fn finder_agrees_on_scenes<const D: usize, T: Scalar>() {
    for scene in scenes_in::<D>() {
        let sets = [(0, 1), (1, 1), (2, 1), (3, 1), (17, 1), (64, 1), (MANY, 2), (65, 3)];
        let sets = sets.map(|(n, seed)| scene.boxes::<D, T>(n, seed).unwrap());
        finder_agrees(scene.name(), &sets);
    }
}
in_all_dimensions!(finder_agrees_on_every_scene, finder_agrees_on_scenes);

fn finder_agrees_in_motion<const D: usize, T: Scalar>() {
    for motion in Motion::ALL {
        let mut moving = motion.start::<D, T>(40, 8).unwrap();
        let mut frames = vec![moving.boxes().to_vec()];
        for _ in 0..10 {
            moving.advance();
            frames.push(moving.boxes().to_vec());
        }
        finder_agrees(motion.name(), &frames);
    }
}
in_all_dimensions!(finder_agrees_on_every_motion, finder_agrees_in_motion);

fn finder_agrees_on_random_boxes<const D: usize, T: Scalar>() {
    proptest!(|(few in valid_boxes::<D, T>(30), many in valid_boxes::<D, T>(90))| {
        finder_agrees("random", &[few, many]);
    });
}
in_all_dimensions!(finder_agrees_on_all_random_boxes, finder_agrees_on_random_boxes);

/// NaN or inverted boxes: the error names the first, and the next search is as if there had been no bad one.
fn refuses<const D: usize, T: Scalar>(good: &[Aabb<D, T>], bad: &[Aabb<D, T>], error: Error) {
    assert_eq!(validate(bad), Err(error));
    assert_eq!(brute_force(bad), Err(error));
    assert_eq!(find_pairs(bad), Err(error));
    let mut finder = PairFinder::new();
    let before = finder.find(good).unwrap().to_vec();
    assert_eq!(finder.find(bad), Err(error));
    assert_eq!(finder.find(good).unwrap(), before);
}

fn bad_boxes_are_refused<const D: usize, T: Scalar>() {
    let nan = T::from_f64(f64::NAN);
    let [zero, one] = [0.0, 1.0].map(T::from_f64);
    let good = Scene::Reversed.boxes::<D, T>(12, 1).unwrap();
    for index in [0, 5, 11] {
        for axis in 0..D {
            let error = |bad: &[Aabb<D, T>]| {
                let Aabb { min, max } = bad[index];
                let [min, max] = [min, max].map(|corner| corner[axis].to_f64().into());
                Error::InvalidBox { set: 0, index, axis, min, max }
            };
            for (min, max) in [
                (nan, one),
                (zero, nan),
                (nan, nan),
                (one, zero),
                (T::INFINITY, T::NEG_INFINITY),
                (T::INFINITY, one),
            ] {
                let mut bad = good.clone();
                (bad[index].min[axis], bad[index].max[axis]) = (min, max);
                refuses(&good, &bad, error(&bad));
            }
            // A different number of boxes, and a later one that is worse.
            let mut bad = [&good[..], &good[..]].concat();
            bad[index].min[axis] = nan;
            bad[index + 12] = Aabb::new([nan; D], [nan; D]);
            let error = error(&bad);
            refuses(&good, &bad, error);
            assert!(error.to_string().contains(&format!("box {index} ")));
            assert!(error.to_string().contains(&format!("axis {axis}")));
        }
    }
}
in_all_dimensions!(bad_boxes_are_refused_by_name, bad_boxes_are_refused);

fn bad_random_boxes_are_refused<const D: usize, T: Scalar>() {
    let wild = prop_oneof![40 => coordinate::<T>(), 1 => Just(T::from_f64(f64::NAN))];
    let corners = (prop::array::uniform::<_, D>(wild.clone()), prop::array::uniform::<_, D>(wild));
    let wild_box = corners.prop_map(|(min, max)| Aabb::new(min, max));
    let any_box = prop_oneof![4 => valid_box(), 1 => wild_box];
    let sets = (valid_boxes::<D, T>(12), prop::collection::vec(any_box, 0..12));
    proptest!(ProptestConfig::with_cases(64), |((good, wild) in sets)| {
        let valid = |index: usize, axis: usize| wild[index].min[axis] <= wild[index].max[axis];
        let everywhere = (0..wild.len()).flat_map(|index| (0..D).map(move |axis| (index, axis)));
        match everywhere.into_iter().find(|&(index, axis)| !valid(index, axis)) {
            Some((index, axis)) => {
                let Aabb { min, max } = wild[index];
                let [min, max] = [min, max].map(|corner| corner[axis].to_f64().into());
                refuses(&good, &wild, Error::InvalidBox { set: 0, index, axis, min, max });
            }
            None => finder_agrees("wild", &[wild]),
        }
    });
}
in_all_dimensions!(bad_random_boxes_are_refused_by_name, bad_random_boxes_are_refused);
