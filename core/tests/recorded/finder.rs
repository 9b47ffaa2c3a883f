//! The work of searches: how many boxes are sorted (each once for each column that it touches), how many candidates
//! are tested, and in which order pairs are found, which follows from the plan. `core/tests/recorded/finder.txt` records
//! these for every scene, so that a plan only changes on purpose: they depend on neither processor, kernel nor threads.

use std::fmt::Write;
use std::path::Path;
use std::string::String;
use std::vec::Vec;

use super::control::Task;
use super::driver::Driver;
use super::kernel::{Kernel, PairOrder};
use super::sink::Store;
use crate::{Aabb, Scalar};
use sweep_and_prune_scenes::Scene;

/// Scenes with so many pairs that a search of 20,000 boxes takes long.
const MANY_PAIRS: [&str; 9] =
    ["nested", "coincident", "flat", "needles", "needles-x", "giants", "slab", "beams", "infinite"];

/// Compares with what is recorded in `core/tests/recorded/`. With the environment variable `RECORD` set, records it.
#[track_caller]
pub(crate) fn compare_with_record(name: &str, now: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/recorded").join(name);
    if std::env::var_os("RECORD").is_some() {
        std::fs::write(&path, now).expect("the record can be written");
    }
    let record = std::fs::read_to_string(&path).expect("a record");
    let different = now.lines().zip(record.lines()).find(|(now, record)| now != record);
    assert!(
        now == record,
        "other work than recorded in {}, first here: (now, then) {different:#?}\n\
         If this is meant, run the test again with RECORD=1, and say why in the commit.",
        path.display()
    );
}

/// A hash of pairs in the order given.
fn hash(pairs: &[[u32; 2]]) -> u64 {
    pairs.iter().flatten().fold(0, |hash: u64, &id| {
        (hash.rotate_left(5) ^ u64::from(id)).wrapping_mul(0x9e37_79b9_7f4a_7c15)
    })
}

/// Adds a line about a search.
fn search<const D: usize, T: Scalar>(report: &mut String, name: &str, sets: &[&[Aabb<D, T>]]) {
    let mut driver = Driver::new(Kernel::best());
    let order = if sets.len() == 1 { PairOrder::Ascending } else { PairOrder::BySet };
    let mut store = Store::default();
    driver.run(sets, Task::new(order, None), &mut store).expect("the boxes are valid");
    let [sorted, candidates] = driver.work;
    let (pairs, hash) = (store.pairs().len(), hash(store.pairs()));
    let counts = sets.iter().map(|set| set.len()).collect::<Vec<_>>();
    writeln!(
        report,
        "{name} {D}D {counts:?}: {sorted} sorted, {candidates} candidates, {pairs} pairs, order {hash:016x}"
    )
    .expect("a string grows");
}

/// Adds lines about boxes of a scene, split into two sets at some of them: at none, into one set.
macro_rules! searches {
    ($report:expr, $scene:expr, $dimensions:literal, $scalar:ty, $count:expr, $splits:expr) => {
        if let Some(boxes) = $scene.boxes::<$dimensions, $scalar>($count, 1) {
            // The scenes know this crate as it is compiled without tests.
            let boxes = boxes.iter().map(|aabb| Aabb::new(aabb.min, aabb.max)).collect::<Vec<_>>();
            for split in $splits {
                let (first, second) = boxes.split_at(split);
                let sets = if split == 0 { &[second][..] } else { &[first, second] };
                search($report, $scene.name(), sets);
            }
        }
    };
}

#[test]
fn searches_do_the_work_that_is_recorded() {
    let mut report = String::new();
    for &scene in Scene::ALL {
        searches!(&mut report, scene, 1, f32, 1500, [0, 750]);
        searches!(&mut report, scene, 2, f32, 500, [0]);
        searches!(&mut report, scene, 2, f32, 3000, [0, 1500, 2940]);
        searches!(&mut report, scene, 3, f64, 3000, [0, 1500, 60]);
        if !MANY_PAIRS.contains(&scene.name()) {
            searches!(&mut report, scene, 2, f32, 20_000, [0]);
        }
    }
    compare_with_record("finder.txt", &report);
}
