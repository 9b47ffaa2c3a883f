//! Every algorithm gives the pairs of brute force: on every scene, on every frame of every motion, and
//! on random boxes full of ties. Each refuses what is invalid.

use proptest::prelude::*;
use sweep_and_prune::{Aabb, Error as BoxError, Scalar, validate};
use sweep_and_prune_algorithms::{Axis, Counts, Error, Method, Runner, RunnerOptions, Sort};
use sweep_and_prune_scenes::testing::{coordinate, valid_box, valid_boxes};
use sweep_and_prune_scenes::{Motion, Scene, brute_force, in_all_dimensions};

/// Every algorithm with every sort, from scratch each step or from the last order, along one of
/// the axes or choices of axis: the `turn`th, counted round and round.
fn all_options<const D: usize>(turn: usize) -> Vec<RunnerOptions> {
    // Of the fixed ones, `ALL` has the first.
    let axes: Vec<Axis> = (1..D).map(Axis::Fixed).chain(Axis::ALL).collect();
    let axis = axes[turn % axes.len()];
    let mut all = Vec::new();
    for method in Method::ALL {
        for sort in Sort::ALL {
            for persistent in [false, true] {
                all.push(RunnerOptions::new(method).sort(sort).axis(axis).persistent(persistent));
            }
        }
    }
    all
}

fn sorted(pairs: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let mut pairs = pairs.to_vec();
    pairs.sort_unstable();
    pairs
}

/// Each algorithm steps through the sets in turn, and finds the pairs of each.
fn algorithms_agree<const D: usize, T: Scalar>(name: &str, turn: usize, sets: &[Vec<Aabb<D, T>>]) {
    let expected: Vec<_> = sets.iter().map(|boxes| brute_force(boxes).unwrap()).collect();
    for options in all_options::<D>(turn) {
        let mut runner = Runner::new(options);
        for (step, (boxes, expected)) in sets.iter().zip(&expected).enumerate() {
            let found = sorted(runner.step(boxes, &mut ()).unwrap().pairs);
            assert!(
                found == *expected,
                "{name}, {D}D, step {step}: {options:?}\n{boxes:?}\nfound {found:?}\nnot {expected:?}"
            );
        }
    }
}

fn scenes_in<const D: usize>() -> impl Iterator<Item = Scene> {
    Scene::ALL.iter().copied().filter(|scene| scene.dimensions().contains(&D))
}

fn algorithms_agree_on_scenes<const D: usize, T: Scalar>() {
    for (turn, scene) in scenes_in::<D>().enumerate() {
        // The second set meets the order that the first has left behind.
        let sets = [(30, 1), (30, 2), (29, 2), (1, 3), (0, 4), (2, 5), (12, 6)];
        let sets = sets.map(|(n, seed)| scene.boxes::<D, T>(n, seed).unwrap());
        algorithms_agree(scene.name(), turn, &sets);
    }
}
in_all_dimensions!(every_algorithm_agrees_on_every_scene, algorithms_agree_on_scenes);

fn algorithms_agree_in_motion<const D: usize, T: Scalar>() {
    for (turn, motion) in Motion::ALL.into_iter().enumerate() {
        let mut moving = motion.start::<D, T>(40, 8).unwrap();
        let mut frames = vec![moving.boxes().to_vec()];
        for _ in 0..10 {
            moving.advance();
            frames.push(moving.boxes().to_vec());
        }
        algorithms_agree(motion.name(), turn, &frames);
    }
}
in_all_dimensions!(every_algorithm_agrees_on_every_motion, algorithms_agree_in_motion);

fn algorithms_agree_on_random_boxes<const D: usize, T: Scalar>() {
    // Two frames of as many boxes, and one of any number.
    let sets = (0..=25usize).prop_flat_map(|n| {
        let frame = || prop::collection::vec(valid_box::<D, T>(), n);
        (frame(), frame(), valid_boxes::<D, T>(25))
    });
    proptest!(ProptestConfig::with_cases(64), |((a, b, c) in sets, turn in 0..D + 3)| {
        algorithms_agree("random", turn, &[a, b, c]);
    });
}
in_all_dimensions!(every_algorithm_agrees_on_random_boxes, algorithms_agree_on_random_boxes);

/// The error of the first invalid box, if there is one.
fn fault<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>]) -> Option<Error> {
    validate(boxes).err().map(Error::Boxes)
}

/// NaN or inverted boxes: the error names the first, no observer is called, and the next
/// step is as if there had been no bad one.
fn refuses<const D: usize, T: Scalar>(turn: usize, good: &[Aabb<D, T>], bad: &[Aabb<D, T>]) {
    let error = fault(bad).unwrap();
    for options in all_options::<D>(turn) {
        let (mut disturbed, mut undisturbed) = (Runner::new(options), Runner::new(options));
        disturbed.step(good, &mut ()).unwrap();
        undisturbed.step(good, &mut ()).unwrap();
        let mut counts = Counts::default();
        assert_eq!(disturbed.step(bad, &mut counts).unwrap_err(), error, "{options:?}");
        assert_eq!(counts, Counts::default(), "{options:?}");
        let (mut counts, mut undisturbed_counts) = (counts, counts);
        let found = disturbed.step(good, &mut counts).unwrap();
        let expected = undisturbed.step(good, &mut undisturbed_counts).unwrap();
        assert_eq!(found.pairs, expected.pairs, "{options:?}");
        assert_eq!(counts, undisturbed_counts, "{options:?}");
    }
}

fn bad_boxes_are_refused<const D: usize, T: Scalar>() {
    let nan = T::from_f64(f64::NAN);
    let [zero, one] = [0.0, 1.0].map(T::from_f64);
    let good = Scene::Reversed.boxes::<D, T>(12, 1).unwrap();
    for index in [0, 5, 11] {
        for axis in 0..D {
            let intervals = [
                (nan, one),
                (zero, nan),
                (nan, nan),
                (one, zero),
                (T::INFINITY, T::NEG_INFINITY),
                (T::INFINITY, one),
            ];
            for (turn, (min, max)) in intervals.into_iter().enumerate() {
                let mut bad = good.clone();
                (bad[index].min[axis], bad[index].max[axis]) = (min, max);
                let [min, max] = [min, max].map(|at| at.to_f64().into());
                let error = BoxError::InvalidBox { set: 0, index, axis, min, max };
                assert_eq!(fault(&bad), Some(Error::Boxes(error)));
                refuses(turn, &good, &bad);
            }
            // A different number of boxes, and a later one that is worse.
            let mut bad = [&good[..], &good[..]].concat();
            bad[index].min[axis] = nan;
            bad[index + 12] = Aabb::new([nan; D], [nan; D]);
            refuses(axis, &good, &bad);
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
    proptest!(ProptestConfig::with_cases(64), |((good, wild) in sets, turn in 0..D + 3)| {
        if fault(&wild).is_some() {
            refuses(turn, &good, &wild);
        }
    });
}
in_all_dimensions!(bad_random_boxes_are_refused_by_name, bad_random_boxes_are_refused);

fn a_missing_axis_is_refused<const D: usize, T: Scalar>() {
    let boxes = Scene::Uniform.boxes::<D, T>(9, 1).unwrap();
    for mut options in all_options::<D>(0) {
        for axis in [D, D + 1, usize::MAX] {
            options.axis = Axis::Fixed(axis);
            let mut counts = Counts::default();
            let error = Error::InvalidAxis { axis, dimensions: D };
            let mut runner = Runner::new(options);
            assert_eq!(runner.step(&boxes, &mut counts).unwrap_err(), error);
            assert_eq!(runner.step(&[] as &[Aabb<D, T>], &mut counts).unwrap_err(), error);
            assert_eq!(counts, Counts::default());
        }
    }
}
in_all_dimensions!(a_missing_axis_is_refused_by_name, a_missing_axis_is_refused);

#[test]
fn messages_say_what_to_do() {
    assert_eq!(
        Error::InvalidAxis { axis: 2, dimensions: 2 }.to_string(),
        "axis 2 does not exist: the boxes have 2 dimensions, and the axis must be less"
    );
    let count = 1 << 33;
    let error = Error::Boxes(BoxError::TooManyBoxes { count });
    assert_eq!(error.to_string(), BoxError::TooManyBoxes { count }.to_string());
}
