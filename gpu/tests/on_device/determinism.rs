//! The order of the pairs: the same in every run and on every device, as `golden.txt` has it.

use std::fmt::Write;

use crate::support::{device, upload};
use sweep_and_prune_gpu::PairFinder;
use sweep_and_prune_scenes::{Scene, hash_pairs};

/// As in `scenes/golden.txt`, whose boxes the test in JavaScript has.
const BOXES: usize = 150;
const SEED: u64 = 1;

fn report<const D: usize>(report: &mut String) {
    let (device, queue) = device();
    let mut finder = PairFinder::<D>::new(device, queue).unwrap();
    for &scene in Scene::ALL {
        let Some(boxes) = scene.boxes::<D, f32>(BOXES, SEED) else { continue };
        let pairs = finder.find(&upload(&boxes)).unwrap().read().unwrap();
        writeln!(report, "{} {D}d f32 {} {:016x}", scene.name(), pairs.len(), hash_pairs(&pairs))
            .unwrap();
    }
}

/// With `GPU_WRITE_GOLDEN=1` the file is written instead.
#[test]
fn the_order_is_that_of_the_golden_file() {
    let mut found =
        "# scene, type, pairs, hash of the pairs in the order in which they are found\n"
            .to_string();
    report::<2>(&mut found);
    report::<3>(&mut found);
    if std::env::var_os("GPU_WRITE_GOLDEN").is_some() {
        std::fs::write("golden.txt", &found).unwrap();
    }
    assert_eq!(found, std::fs::read_to_string("golden.txt").unwrap());
}

#[test]
fn two_runs_have_one_order() {
    let boxes = Scene::Mixed.boxes::<3, f32>(20_000, 9).unwrap();
    let (device, queue) = device();
    let mut finder = PairFinder::<3>::new(device, queue).unwrap();
    let first = finder.find(&upload(&boxes)).unwrap().read().unwrap();
    let again = finder.find(&upload(&boxes)).unwrap().read().unwrap();
    let mut other = PairFinder::<3>::new(device, queue).unwrap();
    assert!(first == again);
    assert!(first == other.find(&upload(&boxes)).unwrap().read().unwrap());
    assert!(!first.is_sorted());
}
