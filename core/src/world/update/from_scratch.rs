//! The update where fat AABBs do not pay: it finds all pairs of the boxes themselves, and compares them
//! with those of the last update.
//!
//! Indices are slots meanwhile: boxes are set in the order of the calls, and the pairs found need no
//! other names. No body sleeps. Fat AABBs are the boxes of the last update, written only when needed.

use crate::Scalar;
use crate::memory::OutOfMemory;
use crate::world::bodies::{Bodies, When, flag};
use crate::world::changes::Events;
use crate::world::tracking::{Scratch, Tracking};

/// Reports what begins and ends, sorted, given the boxes and which bodies left. `keeps_build` says whether a tree that is being
/// built will be needed.
///
/// # Errors
/// [`OutOfMemory`]: then the pairs are as before.
#[inline(never)]
pub fn from_scratch<const D: usize, T: Scalar>(
    bodies: &mut Bodies<D, T>,
    tracking: &mut Tracking<D, T>,
    events: &mut Events,
    keeps_build: bool,
) -> Result<(), OutOfMemory> {
    let Scratch { sorter, sorted, .. } = &mut tracking.scratch;
    tracking.candidates.sort(&bodies.slots, sorter, sorted)?;
    tracking.land_all(bodies);
    tracking.order_by_slot(bodies);
    tracking.wake_all(bodies);
    let has_tree = tracking.tree.is_built();
    if !keeps_build {
        tracking.tree.tree_mut().forget_build();
    }
    let Tracking { candidates, scratch, finder, .. } = &mut *tracking;
    let Scratch { sorter, sorted, .. } = scratch;
    if has_tree {
        bodies.list_changed();
    }
    let all = finder.find(bodies.boxes.now(), bodies, [flag::LIVE, 0], When::Now, usize::MAX)?;
    let pairs = all.unwrap_or_default();
    let before = candidates.sorted();
    sorter.reserve(sorted, pairs.len())?;
    // At least this many begin.
    sorter.reserve(&mut events.begun, pairs.len().saturating_sub(before.len()))?;
    for &index in bodies.edits.changed() {
        bodies.slots.lower(index, flag::CHANGED | flag::IN_TREE);
    }
    sorter.sort_into(pairs, sorted, bodies.slots.len());
    sorter.differences(before, sorted, &mut events.ended, &mut events.begun);
    candidates.swap_sorted(sorted);
    tracking.policy.note_overlaps(tracking.finder.found);
    tracking.is_fat_stale = true;
    if has_tree {
        tracking.fat.clear();
        tracking.fat.extend_from_slice(bodies.boxes.now());
        tracking.note_new_fat(bodies);
    }
    Ok(())
}
