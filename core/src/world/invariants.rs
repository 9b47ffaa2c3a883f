//! What is true of a world between two calls: for each flag and list, who sets it, who clears it, and what it implies.
//!
//! | state | set by | cleared by | implies |
//! |---|---|---|---|
//! | `LIVE` | insertion | removal | its slot has an id that is valid |
//! | `LEAVING`, `edits.leaving()` | removal | the next update | not `LIVE`; its pairs end at the next update |
//! | `CHANGED`, `edits.changed()` | every edit of a box, filter or exclusion | the next update | without it the box is that of the last update, unless `edits.any_unlisted()` |
//! | `edits.any_unlisted()` | edits of all boxes at once | the next update or query, which compares all boxes | nothing: boxes may have changed without the flag |
//! | `NEW`, `edits.any_new()` | insertion | the next update | `CHANGED`; in no pair yet; `boxes.previous()` and `fat` are meaningless |
//! | `boxes.previous()` has a table of its own | the first edit of a box | an update that reads all boxes | without it no box changed |
//! | `REFILTERED` | `set_filter` | the next update | `CHANGED`; the filter of the last update is kept beside |
//! | `SWEPT`, `sweeps` | `sweep` | the next update, or another edit of the box | `LIVE` |
//! | `MOVED`, `moved` | edits of the box, where fat AABBs are reported | the next update | nothing without fat AABBs |
//! | `ASLEEP`, `sleep.count` | the end of an update, if the body rested for long | an update in which it changed or left, or in which all wake | not `FLYING`; its box is that of the last update, or it is `CHANGED` |
//! | `FLYING`, `flying` | an update in which it was fast | an update in which it is slow, or queries | the tree is fresh and does not hold it |
//! | `fat` | an update in which it left its own | the same | contains the box of the last update, unless `is_fat_stale` |
//! | `tree` | updates and queries | updates that replace all fat AABBs | unless unbuilt, the tree holds all bodies that are not `NEW` and do not fly |
//! | `sorted` | queries, after calls with very many boxes | such a call that finds it useless, or none for long | nothing: each call compares the boxes |
//! | `candidates.listed()` | updates | updates | pairs of fat AABBs that overlap, at least one body of each awake, with a flag that says whether they are a pair |
//! | `candidates.asleep_pairs()` | the end of an update | updates in which one wakes | they are pairs |
//! | `candidates.sorted()` | updates from scratch | the next other update | all pairs, sorted; none is listed, no body asleep, and indices are slots |
//! | `MARKED`, `is_escaped`, `is_changed` | one call | the same call | nothing between calls |
//!
//! The fuzzer asks [`broken`] after each call, and the tests of the model after each update. It takes O(bodies + candidates)
//! time, so debug builds of users do not ask it.

use alloc::vec;

use super::bodies::{Bodies, Slots, flag};
use super::candidates::are_asleep;
use super::tracking::Tracking;
use crate::Scalar;

/// What is not true of a world though it should be, if anything.
pub fn broken<const D: usize, T: Scalar>(
    bodies: &Bodies<D, T>,
    tracking: &Tracking<D, T>,
) -> Option<&'static str> {
    first_false(&slots(bodies))
        .or_else(|| first_false(&tables(bodies)))
        .or_else(|| first_false(&lists(bodies)))
        .or_else(|| first_false(&rest(bodies, tracking)))
        .or_else(|| first_false(&fat_aabbs(bodies, tracking)))
        .or_else(|| first_false(&pairs(bodies, tracking)))
}

type Claims<const N: usize> = [(&'static str, bool); N];

fn first_false(claims: &[(&'static str, bool)]) -> Option<&'static str> {
    claims.iter().find(|(_, holds)| !holds).map(|&(claim, _)| claim)
}

fn slots<const D: usize, T: Scalar>(bodies: &Bodies<D, T>) -> Claims<4> {
    let slots = &bodies.slots;
    let all = || 0..slots.len() as u32;
    let is_own = |slot: u32| slots.slot_of[slots.index_of[slot as usize] as usize] == slot;
    let is_same = |slot: u32| slots.index_of[slot as usize] == slot;
    let count = |flags| all().filter(|&index| slots.has(index, flags)).count();
    [
        ("each slot has an index of its own", all().all(is_own)),
        (
            "indices are slots unless storage was reordered",
            slots.is_reordered || all().all(is_same),
        ),
        ("as many bodies live as are counted", count(flag::LIVE) == slots.live),
        ("no body is marked", count(flag::MARKED) == 0),
    ]
}

fn tables<const D: usize, T: Scalar>(bodies: &Bodies<D, T>) -> Claims<4> {
    let Bodies { options, slots, boxes, displacements, .. } = bodies;
    let (boxes, previous) = (boxes.now(), boxes.previous());
    let (shapes, origins) = (displacements.shapes(), displacements.origins());
    let has_shapes = options.report.is_fat();
    let shaped = if has_shapes { slots.len() } else { 0 };
    let is_inside = |index: usize| boxes[index].contains(&shapes[index]);
    [
        ("each body has a box", boxes.len() == slots.len()),
        ("each body has a box of the last update", previous.len() == slots.len()),
        (
            "each body has the box that was given, where another one is reported",
            [shapes.len(), origins.len()] == [shaped; 2],
        ),
        (
            "a reported box contains the one that was given",
            living(bodies).all(|index| !has_shapes || is_inside(index as usize)),
        ),
    ]
}

fn lists<const D: usize, T: Scalar>(bodies: &Bodies<D, T>) -> Claims<8> {
    let Bodies { slots, boxes, edits, displacements, sweeps, .. } = bodies;
    let (boxes, previous) = (boxes.now(), boxes.previous());
    let is_leaving =
        |&index: &u32| slots.has(index, flag::LEAVING) && !slots.has(index, flag::LIVE);
    let has = |index, flags| slots.has(index, flags);
    let is_same = |index: u32| boxes[index as usize] == previous[index as usize];
    [
        ("bodies that leave are listed", all_listed(slots, edits.leaving(), flag::LEAVING)),
        ("listed bodies that leave are gone", edits.leaving().iter().all(is_leaving)),
        ("bodies that changed are listed", all_listed(slots, edits.changed(), flag::CHANGED)),
        (
            "new or refiltered bodies changed",
            living(bodies).all(|index| {
                !has(index, flag::NEW | flag::REFILTERED) || has(index, flag::CHANGED)
            }),
        ),
        (
            "a new body is noted",
            edits.any_new() || living(bodies).all(|index| !has(index, flag::NEW)),
        ),
        (
            "a body that did not change is where it was",
            edits.any_unlisted()
                || living(bodies).all(|index| has(index, flag::CHANGED) || is_same(index)),
        ),
        (
            "bodies that were given a box are listed",
            all_listed(slots, displacements.moved(), flag::MOVED),
        ),
        (
            "swept bodies are listed, and have a place to rest",
            all_listed(slots, sweeps.listed(), flag::SWEPT)
                && living(bodies)
                    .all(|index| !has(index, flag::SWEPT) || sweeps.end(index).is_some()),
        ),
    ]
}

fn rest<const D: usize, T: Scalar>(bodies: &Bodies<D, T>, tracking: &Tracking<D, T>) -> Claims<5> {
    let slots = &bodies.slots;
    let Tracking { sleep, flying, tree, .. } = tracking;
    let asleep = || (0..slots.len() as u32).filter(|&index| slots.has(index, flag::ASLEEP));
    let fly = |&index: &u32| slots.has(index, flag::FLYING);
    [
        ("as many bodies sleep as are counted", asleep().count() == sleep.count),
        (
            "no body that sleeps flies or is new",
            asleep().all(|index| !slots.has(index, flag::FLYING | flag::NEW)),
        ),
        ("bodies that fly are listed", all_listed(slots, flying, flag::FLYING)),
        (
            "while bodies fly the tree is fresh",
            !living(bodies).any(|index| fly(&index)) || tracking.tree.is_fresh(),
        ),
        (
            "the tree holds no body that flies",
            !living(bodies).filter(fly).any(|index| tree.tree().holds(index)),
        ),
    ]
}

fn fat_aabbs<const D: usize, T: Scalar>(
    bodies: &Bodies<D, T>,
    tracking: &Tracking<D, T>,
) -> Claims<3> {
    let slots = &bodies.slots;
    let Tracking { fat, is_fat_stale, tree, .. } = tracking;
    let known = || living(bodies).filter(|&index| !slots.has(index, flag::NEW));
    let previous = bodies.boxes.previous();
    let is_inside = |index: u32| fat[index as usize].contains(&previous[index as usize]);
    let is_held = |index| slots.has(index, flag::FLYING) || tree.tree().holds(index);
    [
        (
            "bodies that an update knew have fat AABBs",
            *is_fat_stale || known().all(|index| (index as usize) < fat.len()),
        ),
        ("a fat AABB contains the box of the last update", *is_fat_stale || known().all(is_inside)),
        (
            "a tree holds all bodies that an update knew and that do not fly",
            !tree.is_built() || known().all(is_held),
        ),
    ]
}

fn pairs<const D: usize, T: Scalar>(bodies: &Bodies<D, T>, tracking: &Tracking<D, T>) -> Claims<7> {
    let slots = &bodies.slots;
    let Tracking { candidates, fat, is_fat_stale, sleep, .. } = tracking;
    let (live, sorted) = (candidates.live(), candidates.sorted());
    let pairs = if candidates.is_sorted() { &[][..] } else { candidates.listed() };
    let ascends = |pairs: &[[u32; 2]]| pairs.iter().all(|[a, b]| a < b);
    let is_known = |index: u32| slots.has(index, flag::LIVE | flag::LEAVING);
    let is_near = |&[a, b]: &[u32; 2]| fat[a as usize].overlaps(&fat[b as usize]);
    [
        (
            "pairs are sorted, or listed",
            !candidates.is_sorted()
                || candidates.asleep() == 0 && sleep.count == 0 && !slots.is_reordered,
        ),
        ("sorted pairs ascend", sorted.is_sorted_by(|a, b| a < b)),
        ("in each pair the smaller index is first", ascends(pairs) && ascends(sorted)),
        ("each candidate has a flag", pairs.len() == live.len()),
        (
            "candidates are bodies that an update knew",
            pairs.iter().flatten().all(|&index| is_known(index)),
        ),
        ("one body of each candidate is awake", !pairs.iter().any(|pair| are_asleep(slots, pair))),
        (
            "the fat AABBs of candidates overlap, and their flags are right",
            *is_fat_stale
                || pairs.iter().all(is_near)
                    && pairs
                        .iter()
                        .zip(live)
                        .all(|(&pair, &is_live)| bodies.was_live(pair) == is_live)
                    && candidates.asleep_pairs(slots).all(|pair| bodies.was_live(pair)),
        ),
    ]
}

/// Whether all bodies with one of these flags are in a list.
fn all_listed(slots: &Slots, list: &[u32], flags: u16) -> bool {
    let mut is_listed = vec![false; slots.len()];
    list.iter().for_each(|&index| is_listed[index as usize] = true);
    (0..slots.len() as u32).all(|index| !slots.has(index, flags) || is_listed[index as usize])
}

/// The indices of living bodies.
fn living<const D: usize, T: Scalar>(bodies: &Bodies<D, T>) -> impl Iterator<Item = u32> {
    let flags = bodies.slots.flags.iter().enumerate();
    flags.filter(|(_, flags)| **flags & flag::LIVE != 0).map(|(index, _)| index as u32)
}
