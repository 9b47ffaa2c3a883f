//! The work of updates: how often a broad phase finds all pairs from scratch, finds all candidates, looks up the bodies
//! that left their fat AABBs, or only tests candidates; how many candidates there are, and how many bodies sleep; and a
//! hash of what it keeps from update to update (fat AABBs, candidates, tree, order in memory, policies).
//! `work.txt` records these for every motion, so that they only change on purpose.

use std::fmt::Write;
use std::format;
use std::string::String;
use std::vec::Vec;

use super::search_tree::TreeState;
use super::tracking::Tracking;
use super::{BroadPhase, Filter, ProxyId};
use crate::pairs::work::compare_with_record;
use crate::{Aabb, Scalar};
use sweep_and_prune_scenes::{Motion, hash};

/// How many bodies there are, and how many updates.
const BODIES: usize = 1000;
const UPDATES: usize = 120;

/// What happens besides the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Life {
    /// Nothing.
    Moving,
    /// Each frame a body is removed and another takes its slot, and there is a query.
    Edited,
    /// After half of the updates all but ten bodies rest.
    Resting,
}

/// A hash of what decides how long the next updates take.
fn state<const D: usize, T: Scalar>(world: &BroadPhase<D, T>) -> u64 {
    let Tracking { fat, candidates, tree, motion, policy, sleep, .. } = &world.tracking;
    let (tree_state, uses) = tree.state();
    let tree = (tree.tree(), tree_state, uses);
    let slots = (&world.bodies.slots.slot_of, &world.bodies.slots.flags, world.bodies.front);
    hash(
        format!("{fat:?} {candidates:?} {tree:?} {motion:?} {policy:?} {sleep:?} {slots:?}")
            .bytes(),
    )
}

/// Adds a line about the updates of a world: `frame` gives its boxes.
fn updates<const D: usize, T: Scalar>(
    report: &mut String,
    name: &str,
    life: Life,
    mut frame: impl FnMut() -> Vec<Aabb<D, T>>,
) {
    let mut world = BroadPhase::<D, T>::new();
    let mut boxes = frame();
    let mut ids = world.insert_many(&boxes, Filter::default()).expect("the boxes are valid");
    let [mut from_scratch, mut rebuilt, mut looked_up, mut only_tested] = [0; 4];
    let [mut candidates, mut asleep, mut reordered] = [0; 3];
    let mut states = Vec::new();
    for update in 1..=UPDATES {
        let next = frame();
        let moving = if life == Life::Resting && update > UPDATES / 2 { 10 } else { BODIES };
        boxes[..moving].copy_from_slice(&next[..moving]);
        world.set_many(&ids[..moving], &boxes[..moving]).expect("the bodies are there");
        if life == Life::Edited {
            let at = 7 * update % BODIES;
            world.remove(ids[at]).expect("the body is there");
            ids[at] = world.insert(boxes[at]).expect("the box is valid");
            world.queries().overlapping(&boxes[0]).expect("the box is valid");
        }
        world.tracking.refresh_fat(&world.bodies);
        let (fat, order) = (world.tracking.fat.clone(), world.bodies.slots.slot_of.clone());
        world.update();
        let tracking = &world.tracking;
        let is_reordered = order != world.bodies.slots.slot_of;
        *match tracking.tree.state().0 {
            _ if tracking.candidates.is_sorted() => &mut from_scratch,
            _ if fat == tracking.fat => &mut only_tested,
            TreeState::Fresh { .. } => &mut looked_up,
            _ => &mut rebuilt,
        } += 1;
        candidates += tracking.candidates.live().len();
        asleep += tracking.sleep.count;
        reordered += usize::from(is_reordered);
        if update % 40 == 0 {
            states.extend(state(&world).to_le_bytes());
        }
    }
    writeln!(
        report,
        "{name} {life:?} {D}D: from scratch {from_scratch}, rebuilt {rebuilt}, looked up {looked_up}, \
         only tested {only_tested}; candidates {candidates}, asleep {asleep}, reordered {reordered}, \
         state {:016x}",
        hash(states)
    )
    .expect("a string grows");
}

/// Adds a line about a motion.
macro_rules! motion {
    ($report:expr, $motion:expr, $life:expr, $dimensions:literal, $scalar:ty) => {
        let mut moving =
            $motion.start::<$dimensions, $scalar>(BODIES, 1).expect("1 to 3 dimensions");
        updates($report, $motion.name(), $life, || {
            moving.advance();
            // The scenes know this crate as it is compiled without tests.
            moving.boxes().iter().map(|aabb| Aabb::new(aabb.min, aabb.max)).collect()
        });
    };
}

#[test]
fn updates_do_the_work_that_is_recorded() {
    let mut report = String::new();
    for motion in Motion::ALL {
        for life in [Life::Moving, Life::Edited, Life::Resting] {
            motion!(&mut report, motion, life, 1, f64);
            motion!(&mut report, motion, life, 2, f32);
            motion!(&mut report, motion, life, 3, f32);
        }
    }
    compare_with_record("src/world/work.txt", &report);
}

/// A box of size 1; those of neighboring places are ten apart.
fn at(place: usize) -> Aabb<2> {
    let place = 10.0 * place as f32;
    Aabb::new([place, 0.0], [place + 1.0, 1.0])
}

/// A world of bodies at the first places, after an update.
fn world_of(count: usize) -> (BroadPhase<2>, Vec<ProxyId>) {
    let mut world = BroadPhase::<2>::new();
    let boxes: Vec<_> = (0..count).map(at).collect();
    let ids = world.insert_many(&boxes, Filter::default()).expect("the boxes are valid");
    world.update();
    (world, ids)
}

#[test]
fn if_more_than_a_quarter_changes_the_update_finds_out_which() {
    for (moved, is_left_to_the_update) in [(25, false), (26, true)] {
        let (mut world, ids) = world_of(100);
        let boxes: Vec<_> = (0..moved).map(|index| at(index + 1000)).collect();
        world.set_many(&ids[..moved], &boxes).expect("the bodies are there");
        assert_eq!(world.bodies.edits.any_unlisted(), is_left_to_the_update, "{moved}");
        assert_eq!(world.bodies.edits.changed().len(), if is_left_to_the_update { 0 } else { 25 });
    }
}

#[test]
fn a_removed_body_is_not_listed_as_changed() {
    let (mut world, ids) = world_of(100);
    let boxes: Vec<_> = (0..100).map(|index| at(index + 1000)).collect();
    world.set_many(&ids, &boxes).expect("the bodies are there");
    world.remove(ids[3]).expect("the body is there");
    world.queries();
    assert_eq!(world.bodies.edits.changed().len(), 99);
}

#[test]
fn a_new_body_in_a_listed_slot_and_a_body_that_moves_twice_are_listed_once() {
    let (mut world, ids) = world_of(100);
    for place in [100, 200] {
        world.set(ids[0], at(place)).expect("the body is there");
    }
    assert_eq!(world.bodies.edits.changed().len(), 1);
    for _ in 0..3 {
        let id = world.insert(at(300)).expect("the box is valid");
        world.remove(id).expect("the body is there");
    }
    assert_eq!(world.bodies.edits.changed().len(), 2);
}

#[test]
fn the_list_of_changes_is_compacted_when_it_is_twice_as_long_as_the_bodies() {
    let (mut world, ids) = world_of(100);
    let mut longest = 0;
    for call in 0..1000 {
        world.set(ids[call % 100], at(call + 1000)).expect("the body is there");
        world.queries();
        longest = longest.max(world.bodies.edits.changed().len());
    }
    assert_eq!(longest, 200);
}

#[test]
fn the_tree_is_built_again_if_many_of_the_bodies_jumped_and_more_where_it_is_queried() {
    const OLD: TreeState = TreeState::Old;
    const UNBUILT: TreeState = TreeState::Unbuilt;
    for (is_queried, moved, expected) in
        [(true, 12, OLD), (true, 13, UNBUILT), (false, 1, OLD), (false, 2, UNBUILT)]
    {
        let (mut world, ids) = world_of(100);
        world.queries();
        world.tracking.is_queried = is_queried;
        for &id in &ids[..moved] {
            world.set(id, at(1000 + id.slot() as usize)).expect("the body is there");
        }
        world.tracking.note_new_fat(&world.bodies);
        assert_eq!(world.tracking.tree.state().0, expected, "{moved}");
    }
}

#[test]
fn a_way_of_exactly_twice_the_size_is_a_jump() {
    let at = |place: f32| Aabb::new([0.0, place], [1.0, place + 1.0]);
    let mut policy = super::policy::Motion::default();
    let (before, now) = (at(0.0), at(0.5));
    policy.sample(1, |_| (&before, &now));
    for (way, expected) in [(1.75, false), (2.0, true), (2.25, true)] {
        for way in [way, -way] {
            assert_eq!(policy.is_jump(&at(0.0), &at(way)), expected, "{way}");
        }
    }
}

#[test]
fn lists_of_128_pairs_or_more_are_sorted_by_counting() {
    for (count, counts) in [(127, false), (128, true)] {
        let mut pairs: Vec<_> = (0..count).map(|at| [count - at, at]).collect();
        let mut sorter = super::candidates::PairSorter::default();
        let used = allocation_counter::measure(|| sorter.sort(&mut pairs, 1000)).bytes_max;
        // A counter for each of 1024 values.
        assert_eq!(used > 4096, counts, "{count}: {used}");
    }
}

#[test]
fn lists_reserve_what_motion_adds_and_no_more() {
    [Motion::Drift, Motion::MostlyStill].into_iter().for_each(check_reserved);
}

fn check_reserved(motion: Motion) {
    let mut moving = motion.start::<3, f32>(BODIES, 1).expect("1 to 3 dimensions");
    let mut frame = || -> Vec<_> {
        moving.advance();
        moving.boxes().iter().map(|aabb| Aabb::<3>::new(aabb.min, aabb.max)).collect()
    };
    let mut world = BroadPhase::<3>::new();
    let ids = world.insert_many(&frame(), Filter::default()).expect("the boxes are valid");
    for _ in 0..UPDATES {
        world.set_many(&ids, &frame()).expect("the bodies are there");
        world.update();
    }
    let Tracking { candidates, scratch, .. } = &world.tracking;
    let pairs = candidates.capacity();
    let reserved = scratch.dropped.capacity();
    assert!(reserved < pairs + pairs / 2, "{reserved} for {pairs} pairs");
    if motion == Motion::MostlyStill {
        return;
    }
    // What a batch of lookups usually finds: 256 boxes, 4 leaves of 16 bodies each.
    assert!(scratch.found.capacity() >= 256 * 4 * 16 && scratch.leaves.capacity() >= 256 * 4 * 16);
}

#[test]
fn a_snapshot_is_written_to_memory_that_is_reserved_at_once() {
    let (world, _) = world_of(1000);
    let mut bytes = Vec::new();
    let allocations = allocation_counter::measure(|| bytes = world.snapshot());
    assert_eq!(allocations.count_total, 1);
    assert!(bytes.capacity() < bytes.len() + 100, "{} of {}", bytes.len(), bytes.capacity());
}
