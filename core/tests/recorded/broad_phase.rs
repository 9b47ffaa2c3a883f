//! The work of updates: how often a broad phase finds all pairs from scratch, finds all candidates, looks up the bodies
//! that left their fat AABBs, or only tests candidates; how many candidates there are, and how many bodies sleep; and a
//! hash of what it keeps from update to update (fat AABBs, candidates, tree, order in memory, policies).
//! `core/tests/recorded/broad_phase.txt` records these for every motion, so that they only change on purpose.

use std::fmt::Write;
use std::format;
use std::string::String;
use std::vec::Vec;

use super::tracking::{Tracking, TreeState};
use super::{BroadPhase, Filter};
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
    let Tracking { fat, candidates, tree, tree_state, motion, policy, sleep, .. } = &world.tracking;
    let tree = (tree, tree_state, world.tracking.tree_uses);
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
        *match tracking.tree_state {
            _ if tracking.candidates.are_sorted => &mut from_scratch,
            _ if fat == tracking.fat => &mut only_tested,
            TreeState::Fresh { .. } => &mut looked_up,
            _ => &mut rebuilt,
        } += 1;
        candidates += tracking.candidates.pairs.len();
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
    compare_with_record("broad_phase.txt", &report);
}
