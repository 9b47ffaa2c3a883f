//! The update where fat AABBs do not pay: it finds all pairs of the boxes themselves, and compares them
//! with those of the last update.
//!
//! Indices are slots meanwhile: boxes are set in the order of the calls, and the pairs found need no
//! other names. No body sleeps. Fat AABBs are the boxes of the last update, written only when needed.

use crate::Scalar;
use crate::world::bodies::{Bodies, flag};
use crate::world::candidates::differences;
use crate::world::changes::Events;
use crate::world::tracking::{Scratch, Tracking, TreeState};
use crate::world::update::rebuild::{drop_forbidden, find_candidates, found, is_live};
use crate::world::update::search_tree;

/// Reports what begins and ends, sorted, given the boxes and which bodies left.
#[inline(never)]
pub fn from_scratch<const D: usize, T: Scalar>(
    bodies: &mut Bodies<D, T>,
    tracking: &mut Tracking<D, T>,
    events: &mut Events,
) {
    let slots = bodies.slots.len();
    tracking.candidates.sort(&bodies.slots, &mut tracking.scratch.sorter);
    core::mem::swap(&mut tracking.scratch.before, &mut tracking.candidates.sorted);
    clear_changed(bodies, tracking);
    tracking.wake_all(bodies);

    let is_whole = !bodies.any_filter && bodies.live() == slots;
    if !is_whole {
        find_candidates(bodies, tracking, true, is_live);
        drop_forbidden(bodies, &mut tracking.candidates.pairs);
    }
    let Tracking { candidates, scratch, .. } = tracking;
    let Scratch { finder, sorter, before, .. } = scratch;
    let pairs = if is_whole { found(finder.find(&bodies.boxes)) } else { &candidates.pairs };
    sorter.sort_into(pairs, &mut candidates.sorted, slots);
    candidates.clear();
    differences(before, &candidates.sorted, &mut events.ended, &mut events.begun);
    tracking.is_fat_stale = true;
    if tracking.tree_state != TreeState::Unbuilt {
        tracking.fat.copy_from_slice(&bodies.boxes);
        search_tree::note_new_fat(bodies, tracking);
    }
}

/// Clears the flags of the bodies that changed, and lists them as escaped if a tree is in use.
fn clear_changed<const D: usize, T: Scalar>(
    bodies: &mut Bodies<D, T>,
    tracking: &mut Tracking<D, T>,
) {
    let escaped = &mut tracking.scratch.escaped;
    escaped.clear();
    if tracking.tree_state != TreeState::Unbuilt {
        bodies.list_changed();
        let slots = &bodies.slots;
        escaped.extend(bodies.changed.iter().filter(|&&index| slots.has(index, flag::LIVE)));
    }
    for &index in &bodies.changed {
        bodies.slots.lower(index, flag::CHANGED | flag::IN_TREE);
    }
}
