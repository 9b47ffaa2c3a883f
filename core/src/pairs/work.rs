//! The work of searches: how many boxes are copied to columns and sorted (once for each column), how many pairs of boxes
//! are tested, and in which order pairs are found, which follows from the plan. `work.txt` records these
//! for every scene, so that a plan only changes on purpose: they depend on neither processor, kernel nor threads.

use std::fmt::Write;
use std::format;
use std::path::Path;
use std::string::String;
use std::vec::Vec;

use super::crowding::count_tests;
use super::driver::Driver;
use super::grid::{Cells, Grid};
use super::hard_scenes::boxes;
#[cfg(feature = "parallel")]
use super::kernel::{Cursor, PairOrder};
use super::kernel::{Kernel, PAD, SortedBoxes};
use super::near::Near;
use super::placements::Placements;
use super::probe::Probe;
use super::search::run;
use super::sink::Store;
use super::sizes::wide_boxes;
use super::sort::Sorter;
use crate::{Aabb, Scalar};
use sweep_and_prune_scenes::Scene;

/// Scenes that have many pairs: a search of 20,000 boxes takes long.
const MANY_PAIRS: [&str; 9] =
    ["nested", "coincident", "flat", "needles", "needles-x", "giants", "slab", "beams", "infinite"];

/// The work of a thread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Work {
    /// How many copies of boxes it has made.
    pub copied: u64,
    /// How many boxes it has sorted.
    pub sorted: u64,
    /// About how many pairs of boxes it has tested.
    pub tests: u64,
}

impl Probe for Work {
    fn copied(&mut self, copies: usize) {
        self.copied += copies as u64;
    }

    fn sorted(&mut self, boxes: usize) {
        self.sorted += boxes as u64;
    }

    fn swept<T: Scalar>(&mut self, sorted: &[SortedBoxes<T>]) {
        self.tests += count_tests(sorted, 512);
    }
}

/// Compares with what is recorded in a file of this crate. With the environment variable `RECORD` set, records it.
#[track_caller]
pub(crate) fn compare_with_record(path: &str, now: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
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
    let mut driver = Driver::<_, _, Work>::new(Kernel::best());
    let mut store = Store::default();
    run(&mut driver, Some(&mut Near::default()), sets, None, &mut store)
        .expect("the boxes are valid");
    let Work { copied, sorted, tests } = driver.probe;
    let (pairs, hash) = (store.pairs().len(), hash(store.pairs()));
    let counts = sets.iter().map(|set| set.len()).collect::<Vec<_>>();
    writeln!(
        report,
        "{name} {D}D {counts:?}: {copied} copied, {sorted} sorted, {tests} tests, {pairs} pairs, \
         order {hash:016x}"
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
    // As many boxes as are tested by brute force, and one more.
    searches!(&mut report, Scene::Uniform, 2, f32, 128, [0]);
    searches!(&mut report, Scene::Uniform, 2, f32, 129, [0]);
    searches!(&mut report, Scene::Uniform, 2, f32, 3000, [32, 33]);
    // More than fit a cache.
    searches!(&mut report, Scene::Uniform, 1, f64, 1_400_000, [270_000]);
    groups(&mut report);
    compare_with_record("src/pairs/work.txt", &report);
}

/// Adds lines about uniform boxes with groups of others, each somewhere, so large and so far apart as it happens: a sample
/// misses much of them.
fn groups(report: &mut String) {
    let mut state = 1u64;
    let mut random = || {
        state = state.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(1);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    for number in 0..80 {
        // The smallest number of boxes of which a sample gets a glance, or many more.
        let mut left = if number < 40 { 2048 } else { 12_000 };
        let mut groups = Vec::new();
        while left > 0 {
            let count = left.min((random() * random() * 6000.0) as usize + 200);
            left -= count;
            let mut length = || if random() < 0.2 { 0.0 } else { 10f64.powf(-4.0 * random()) };
            let mut lengths = |most: f64| [length(), length(), length()].map(|each| most * each);
            let (spread, size) = match groups.is_empty() {
                true => ([1.0; 3], [0.02; 3]),
                false => (lengths(1.0), lengths(0.1)),
            };
            let low = [random(), random(), random()];
            let second = if number % 4 == 0 { count / 3 } else { 0 };
            groups.push((count - second, 0, low, spread, size));
            groups.push((second, 1, low, spread, size));
        }
        let sets = boxes::<3, f32>(&groups);
        let used: Vec<_> = sets.iter().map(|set| &set[..]).filter(|set| !set.is_empty()).collect();
        search(report, &format!("groups {number}"), &used);
    }
}

/// The sizes at which the finder does something else: one box more or less makes the difference.
#[test]
fn boxes_are_wide_from_eight_columns_on() {
    let grid = Grid::new(0, &[Cells::one(0), Cells::new(1, 1.0f32, 0.0, 100.0, 10)]);
    let boxes = [70.0, 90.0].map(|size| Aabb::new([0.0, 0.0], [1.0, size]));
    let split = wide_boxes(&[&boxes[..]], &grid).expect("one of them is wide");
    assert_eq!((split.set, split.axis, split.size.round()), (0, 1, 80.0));
}

#[test]
fn a_list_of_placements_that_are_exactly_as_many_as_fit_does_not_grow() {
    let grid = Grid::new(0, &[Cells::one(0), Cells::new(1, 1.0f32, 0.0, 2000.0, 2000)]);
    let boxes = [Aabb::new([0.0, 0.0], [1.0, 1023.5])];
    let mut placements = Placements::default();
    let list = || assert_eq!(placements.list(&boxes, 0..1, &grid, 5000).ok(), Some(1024));
    // The list begins with space for 1024.
    assert_eq!(allocation_counter::measure(list).count_total, 1);
}

/// Some boxes of a scene, sorted on the first axis.
fn sorted(count: usize, seed: u64) -> SortedBoxes<f32> {
    let boxes = Scene::Uniform.boxes::<3, f32>(count, seed).expect("a scene in 3D");
    let boxes = boxes.iter().map(|aabb| Aabb::new(aabb.min, aabb.max)).collect::<Vec<_>>();
    let mut sorted = SortedBoxes::default();
    Sorter::default().sort(&boxes, 0, &mut sorted).expect("memory");
    sorted
}

#[test]
fn boxes_are_ready_for_a_sweep_only_if_every_array_is_long_enough() {
    let cuts: [fn(&mut SortedBoxes<f32>); 7] = [
        |boxes| boxes.left.truncate(PAD + 2),
        |boxes| boxes.right.truncate(PAD + 2),
        |boxes| boxes.id.truncate(PAD + 2),
        |boxes| boxes.dedup.truncate(PAD + 2),
        |boxes| boxes.min[1].truncate(PAD + 2),
        |boxes| boxes.max[1].truncate(PAD + 2),
        |boxes| boxes.left[3] = 0.0,
    ];
    assert!(sorted(3, 1).is_ready(2));
    for (number, cut) in cuts.iter().enumerate() {
        let mut boxes = sorted(3, 1);
        cut(&mut boxes);
        assert!(!boxes.is_ready(2), "{number}");
    }
}

#[cfg(feature = "parallel")]
#[test]
fn chunks_of_a_sweep_of_two_sets_hold_all_pairs() {
    let sets = [sorted(400, 1), sorted(700, 2)];
    let mut out = std::vec![[0; 2]; 10_000];
    let mut sweep = |sets: &[SortedBoxes<f32>], mut cursor: Cursor| {
        let count =
            Kernel::best().sweep::<2, _>(sets, true, PairOrder::BySet, &mut cursor, &mut out);
        out[..count].to_vec()
    };
    let all = sweep(&sets, Cursor::default());
    assert!(!all.is_empty());
    for probes in [1, 7, 64, 2000] {
        let starts = (0..1100).step_by(probes);
        let chunks = starts.map(|start| Cursor::of(&sets, start..start + probes));
        let found = chunks.flat_map(|cursor| sweep(&sets, cursor)).collect::<Vec<_>>();
        assert_eq!(found, all, "{probes}");
    }
    // Where a set has ended, nothing of either is read.
    let short = [sorted(3, 3), sorted(700, 2)];
    for probe in 600..1100 {
        assert!(sweep(&short, Cursor::of(&sets, probe..probe + 1)).is_empty());
    }
}

#[cfg(feature = "parallel")]
mod on_threads {
    use super::*;
    use crate::pairs::parallel::{Chunk, Gather, Receiver, Schedule};
    use crate::pairs::sink::Sink;
    use crate::pairs::task::Stop;

    fn uniform(count: usize) -> Vec<Aabb<2>> {
        let boxes = Scene::Uniform.boxes::<2, f32>(count, 1).expect("a scene in 2D");
        boxes.iter().map(|aabb| Aabb::new(aabb.min, aabb.max)).collect()
    }

    /// The pairs and the work of a search with this many helpers, and whether the first of them placed boxes.
    fn search(sets: &[&[Aabb<2>]], helpers: usize) -> (Vec<[u32; 2]>, Work, bool) {
        let mut driver = Driver::<_, _, Work>::new(Kernel::best());
        driver.helpers.resize(helpers, || Driver::new(Kernel::best()));
        let mut store = Store::default();
        run(&mut driver, Some(&mut Near::default()), sets, None, &mut store)
            .expect("the boxes are valid");
        let unused = format!("{:?}", Placements::default());
        let helper = driver.helpers.all().first();
        let placed = helper.is_some_and(|helper| format!("{:?}", helper.placements) != unused);
        let work = driver.helpers.all().iter().fold(driver.probe, |sum, helper| Work {
            copied: sum.copied + helper.probe.copied,
            sorted: sum.sorted + helper.probe.sorted,
            tests: sum.tests + helper.probe.tests,
        });
        (store.pairs().to_vec(), work, placed)
    }

    #[test]
    fn threads_place_boxes_from_4096_on_and_do_the_work_of_one() {
        for count in [4095, 4096, 20_000] {
            let boxes = uniform(count);
            // The other set is in half of the columns: to the rest nothing is copied.
            let middle = boxes.iter().map(|aabb| aabb.min[0]).sum::<f32>() / count as f32;
            let (near, rest) = boxes.split_at(count / 2);
            let near: Vec<_> = near.iter().copied().filter(|aabb| aabb.min[0] < middle).collect();
            for sets in [&[&boxes[..]][..], &[&near, rest]] {
                let expected = sets.iter().map(|set| set.len()).sum::<usize>() >= 4096;
                let (pairs, work, _) = search(sets, 0);
                let (same, shared, placed) = search(sets, 2);
                assert!(pairs == same && placed == expected, "{count} boxes: {placed}");
                assert_eq!(work, shared, "{count} boxes in {} sets", sets.len());
            }
        }
    }

    #[test]
    fn only_columns_of_more_than_half_a_share_are_searched_by_all_threads_together() {
        // A thread's share is 2000 records of 8000.
        let records = [1200, 900].into_iter().chain([59; 100]);
        let schedule = Schedule::new(records, 4, 0);
        let columns = |&group: &usize| schedule.columns(group);
        assert_eq!(schedule.huge.iter().flat_map(columns).collect::<Vec<_>>(), [0]);
    }

    /// Takes pairs as a sweep does.
    fn fill(sink: &mut impl Sink, pairs: usize) -> Result<(), Stop> {
        let (mut left, mut first) = (pairs, 0);
        while left > 0 {
            let space = sink.spare()?;
            let count = left.min(space.len());
            space[..count].iter_mut().for_each(|pair| {
                *pair = [first, first + 1];
                first += 1;
            });
            sink.take(count)?;
            left -= count;
        }
        Ok(())
    }

    #[test]
    fn a_chunk_is_full_if_it_has_grown_and_a_vector_of_pairs_may_not_fit() {
        let is_full = |size, pairs| {
            let mut store = Store::default();
            assert!(store.put(size, |_| pairs));
            store.is_full()
        };
        assert!(is_full(1 << 14, (1 << 14) - PAD + 1));
        assert!(!is_full(1 << 14, (1 << 14) - PAD));
        assert!(!is_full(1000, 1000), "a chunk grows first");
    }

    #[test]
    fn pairs_go_to_their_places_at_once_if_there_is_space_for_exactly_all() {
        let mut store = Store::default();
        assert!(store.put(300, |_| 0));
        let gather = Gather::new(&mut store, 2);
        gather.job(0, |pairs| fill(pairs, 100));
        gather.job(1, |pairs| fill(pairs, 200));
        let found = gather.end().expect("no job failed");
        assert_eq!((found.written, found.waiting.len()), (300, 0));
        assert_eq!(found.spare.len(), 1, "the second job had the first one's chunk");
    }

    #[test]
    fn chunks_that_a_nested_search_takes_count_as_used() {
        let mut store = Store::default();
        for jobs in [8, 2] {
            let gather = Gather::new(&mut store, jobs);
            (0..jobs).for_each(|job| gather.job(job, |pairs| fill(pairs, 100)));
            let found = gather.end().expect("no job failed");
            store.join(found).expect("memory");
            store.clear();
        }
        let gather = Gather::new(&mut store, 1);
        gather.job(0, |pairs| {
            assert!(pairs.spare_chunks().len() > 1);
            fill(pairs, 100)
        });
        assert_eq!(gather.end().expect("no job failed").unused, 0);
    }
}
