//! Every scene against the core, and its work against that of uniform boxes.

use crate::support::{core_pairs, core_pairs_between, finder, setting, upload};
use sweep_and_prune_gpu::{Error, PairFinder};
use sweep_and_prune_scenes::Scene;

/// Boxes of a scene: enough for several tiles of the sort and several levels of the tree. `GPU_BOXES` sets another number.
fn boxes() -> usize {
    setting("GPU_BOXES", 3000)
}

/// Every scene. In software a million boxes take half a minute, so of that many only the scenes that differ most.
fn scenes() -> Vec<Scene> {
    use Scene::{Clustered, Diagonal, Grid, Mixed, MultiScale, Tower, Uniform};
    let few = [Uniform, Clustered, Mixed, Tower, Grid, Diagonal, MultiScale];
    if boxes() < 500_000 { Scene::ALL.to_vec() } else { few.to_vec() }
}

/// Boxes of a scene whose pairs grow with the square of the number of boxes.
fn boxes_of<const D: usize>(scene: Scene) -> usize {
    let is_dense =
        matches!(scene, Scene::Coincident | Scene::Nested | Scene::Giants | Scene::Infinite)
            || D == 2 && matches!(scene, Scene::Needles | Scene::Beams);
    if is_dense { (boxes() / 16).min(1000) } else { boxes() }
}

fn check_scenes<const D: usize>() {
    let mut finder = finder::<D>();
    for scene in scenes() {
        let count = boxes_of::<D>(scene);
        let Some(boxes) = scene.boxes::<D, f32>(count, 7) else { continue };
        let (pairs, most) = (sweep_and_prune::count_pairs(&boxes).unwrap(), finder.most_pairs());
        if pairs > most {
            let error = finder.find(&upload(&boxes)).unwrap_err();
            assert_eq!(
                error,
                Error::TooManyPairs { count: pairs, most },
                "{} in {D}D",
                scene.name()
            );
            continue;
        }
        let expected = core_pairs(&boxes);
        let found = finder.find(&upload(&boxes)).unwrap();
        assert_eq!(found.summary().invalid, 0, "{} in {D}D", scene.name());
        assert!(found.read().unwrap() == expected, "{} in {D}D", scene.name());
        let (first, second) = boxes.split_at(count / 3);
        let expected = core_pairs_between(first, second);
        let found = finder.find_between(&upload(first), &upload(second)).unwrap();
        assert!(found.read().unwrap() == expected, "{} in {D}D, two sets", scene.name());
    }
}

#[test]
fn scenes_in_2d_have_the_pairs_of_the_core() {
    check_scenes::<2>();
}

#[test]
fn scenes_in_3d_have_the_pairs_of_the_core() {
    check_scenes::<3>();
}

/// How many nodes and boxes a scene tests for each box and pair, and the most that one thread tests.
fn work<const D: usize>(
    finder: &mut PairFinder<D>,
    scene: Scene,
    count: usize,
) -> Option<(f64, u32)> {
    let boxes = scene.boxes::<D, f32>(count, 3)?;
    let tests = finder.count_tests(&[&upload(&boxes)]).unwrap();
    let pairs = sweep_and_prune::count_pairs(&boxes).unwrap() as usize;
    let sum: u64 = tests.iter().copied().map(u64::from).sum();
    Some((sum as f64 / (count + pairs) as f64, tests.into_iter().max().unwrap_or(0)))
}

/// No scene takes more than ten times the tests of uniform boxes for each box and pair.
fn check_work<const D: usize>() {
    let mut finder = finder::<D>().sorted(false);
    let (uniform, _) = work(&mut finder, Scene::Uniform, boxes()).unwrap();
    // 22 and 29 for 3000 boxes, 31 and 75 for 200,000.
    assert!(uniform < 10.0 * (D * D) as f64, "uniform boxes in {D}D take {uniform} tests");
    for scene in scenes() {
        let count = boxes_of::<D>(scene);
        let Some((tests, most)) = work(&mut finder, scene, count) else { continue };
        let times = tests / uniform;
        println!(
            "{D}D {count} {}: {tests:.1}, {times:.2} times uniform, most {most}",
            scene.name()
        );
        assert!(
            times < 10.0,
            "{} in {D}D: {tests} tests, {uniform} of uniform boxes",
            scene.name()
        );
    }
}

#[test]
fn scenes_in_2d_take_at_most_ten_times_the_work_of_uniform_boxes() {
    check_work::<2>();
}

#[test]
fn scenes_in_3d_take_at_most_ten_times_the_work_of_uniform_boxes() {
    check_work::<3>();
}
