//! The update when many bodies left their fat AABBs: it makes new ones and finds all candidates.

use alloc::alloc::{Layout, handle_alloc_error};
use alloc::vec::Vec;

use crate::memory::{preload, reserve};
use crate::world::bodies::{Bodies, flag};
use crate::world::candidates::push_wanted;
use crate::world::changes::Events;
use crate::world::layout::{self, Reorder};
use crate::world::tracking::{Scratch, Tracking};
use crate::world::update::{collect, search_tree};
use crate::{Error, Scalar};

/// Below this share of changed bodies, one in so many, each gets a fat AABB of its own.
const FEW: usize = 4;

/// Reports what begins and ends, given which bodies changed, escaped and left. Returns how to reorder
/// storage.
#[inline(never)]
pub fn rebuild<const D: usize, T: Scalar>(
    bodies: &mut Bodies<D, T>,
    tracking: &mut Tracking<D, T>,
    events: &mut Events,
) -> Reorder {
    let escaped = &tracking.scratch.escaped;
    let moved = escaped.len();
    let is_new = |&&index: &&u32| bodies.slots.has(index, flag::NEW);
    let new = if bodies.any_new { escaped.iter().filter(is_new).count() } else { 0 };
    // Else what begins and ends follows from the boxes alone.
    let has_same_bodies = bodies.leaving.is_empty() && !bodies.any_refiltered;

    list_ended(bodies, tracking, has_same_bodies, &mut events.ended);
    tracking.wake_all(bodies);
    let is_fat = fatten_all(bodies, tracking);
    find_candidates(bodies, tracking, false, is_live);
    drop_forbidden(bodies, &mut tracking.candidates.pairs);
    list_begun(bodies, tracking, is_fat, has_same_bodies && new == 0, &mut events.begun);
    search_tree::note_new_fat(bodies, tracking);

    let live = bodies.live();
    let is_decayed = layout::note_rebuild(&mut tracking.locality_decay, moved, new, live);
    if tracking.policy.note_rebuild(live, is_fat, (moved - new) * 2 < live) {
        Reorder::BySlot
    } else if is_decayed {
        Reorder::BySpace
    } else {
        Reorder::No
    }
}

/// Lists the live pairs that end.
fn list_ended<const D: usize, T: Scalar>(
    bodies: &Bodies<D, T>,
    tracking: &Tracking<D, T>,
    has_same_bodies: bool,
    ended: &mut Vec<[u32; 2]>,
) {
    let (candidates, boxes) = (&tracking.candidates, &bodies.boxes);
    let is_apart = |[a, b]: [u32; 2]| !boxes[a as usize].overlaps_branch_free(&boxes[b as usize]);
    if has_same_bodies {
        push_wanted(ended, &candidates.pairs, |at, pair| {
            (pair, candidates.live[at] & is_apart(pair))
        });
        ended.extend(candidates.asleep_pairs(&bodies.slots).filter(|&pair| is_apart(pair)));
    } else {
        ended.extend(candidates.live_pairs(&bodies.slots).filter(|&pair| !bodies.is_live(pair)));
    }
}

/// Lists the live ones of the new candidates that begin, and flags all live ones.
fn list_begun<const D: usize, T: Scalar>(
    bodies: &Bodies<D, T>,
    tracking: &mut Tracking<D, T>,
    is_fat: bool,
    has_same_bodies: bool,
    begun: &mut Vec<[u32; 2]>,
) {
    let (boxes, previous, candidates) = (&bodies.boxes, &bodies.previous, &mut tracking.candidates);
    preload(boxes);
    preload(previous);
    let (pairs, live) = (&candidates.pairs, &mut candidates.live);
    live.resize(pairs.len(), true);
    if is_fat {
        push_wanted(begun, pairs, |at, [a, b]| {
            let (first, second) = (a as usize, b as usize);
            live[at] = boxes[first].overlaps_branch_free(&boxes[second]);
            ([a, b], live[at] & !previous[first].overlaps_branch_free(&previous[second]))
        });
    } else {
        push_wanted(begun, pairs, |_, [a, b]| {
            ([a, b], !previous[a as usize].overlaps_branch_free(&previous[b as usize]))
        });
    }
    if !has_same_bodies {
        begun.clear();
        let live = candidates.live_pairs(&bodies.slots);
        begun.extend(
            live.filter(|&pair| {
                !bodies.was_live(pair, pair.map(|index| &previous[index as usize]))
            }),
        );
    }
}

/// Drops the pairs whose filters do not allow them.
pub fn drop_forbidden<const D: usize, T: Scalar>(bodies: &Bodies<D, T>, pairs: &mut Vec<[u32; 2]>) {
    if bodies.any_filter {
        pairs.retain(|&pair| bodies.allows(pair));
    }
}

/// Gives all bodies new fat AABBs; that of a body that rests is its box. Returns whether any is larger.
#[inline(never)]
fn fatten_all<const D: usize, T: Scalar>(
    bodies: &Bodies<D, T>,
    tracking: &mut Tracking<D, T>,
) -> bool {
    collect::sample_motion(bodies, tracking);
    let Tracking { fat, motion, .. } = tracking;
    let Bodies { boxes, previous, options, changed, .. } = bodies;
    fat.copy_from_slice(boxes);
    // Where few bodies move they should not all leave their fat AABBs at once.
    let are_few = changed.len() * FEW < bodies.live();
    let is_fat = are_few || motion.reaches() || options.margin > T::default();
    if is_fat {
        for &index in changed {
            let row = index as usize;
            let (before, now) = (&previous[row], &boxes[row]);
            if !bodies.slots.has(index, flag::NEW) {
                fat[row] = if are_few {
                    motion.alone(index, before, now, options)
                } else {
                    motion.together(before, now, options)
                };
            }
        }
    }
    is_fat
}

/// Replaces the candidates by the pairs of fat AABBs, or of the boxes if `exact`, of the bodies whose flags
/// say so. Pairs of two bodies that are and were static are not even searched.
#[inline(never)]
pub fn find_candidates<const D: usize, T: Scalar>(
    bodies: &Bodies<D, T>,
    tracking: &mut Tracking<D, T>,
    exact: bool,
    takes_part: impl Fn(u16) -> bool,
) {
    let Tracking { fat, candidates, scratch, .. } = tracking;
    let Scratch { finder, boxes, indices, .. } = scratch;
    let flags = &bodies.slots.flags;
    let table = if exact { &bodies.boxes } else { &*fat };
    candidates.clear();
    let pairs = &mut candidates.pairs;
    // Boxes were checked when they came, and fat AABBs are valid as well.
    if !bodies.any_filter && flags.iter().all(|&flags| takes_part(flags)) {
        let found = found(finder.find(table));
        reserve(pairs, found.len());
        pairs.extend_from_slice(found);
        return;
    }
    let all = || (0..flags.len() as u32).filter(|&index| takes_part(flags[index as usize]));
    let is_static = |&index: &u32| {
        bodies.filters[index as usize].is_static && bodies.old_filter(index).is_static
    };
    indices.clear();
    indices.extend(all().filter(|index| !is_static(index)));
    let movable = indices.len();
    indices.extend(all().filter(is_static));
    boxes.clear();
    boxes.extend(indices.iter().map(|&index| table[index as usize]));
    let (movable_boxes, static_boxes) = boxes.split_at(movable);
    let (movable, fixed) = indices.split_at(movable);
    let found_pairs = found(finder.find(movable_boxes));
    pairs.extend(found_pairs.iter().map(|pair| pair.map(|at| movable[at as usize])));
    let found_pairs = found(finder.find_between(movable_boxes, static_boxes));
    pairs.extend(found_pairs.iter().map(|&[a, b]| {
        let (a, b) = (movable[a as usize], fixed[b as usize]);
        [a.min(b), a.max(b)]
    }));
}

/// The tracking state of bodies that were read from a snapshot.
pub fn restore<const D: usize, T: Scalar>(bodies: &Bodies<D, T>) -> Tracking<D, T> {
    let mut tracking = Tracking::new();
    let rows = bodies.slots.flags.iter().zip(bodies.previous.iter().zip(&bodies.boxes));
    tracking.fat.extend(rows.map(
        |(&flags, (previous, aabb))| {
            if is_live(flags) { previous.union(aabb) } else { *previous }
        },
    ));
    find_candidates(bodies, &mut tracking, false, |flags| {
        flags & (flag::LIVE | flag::LEAVING) != 0 && flags & flag::NEW == 0
    });
    let candidates = &mut tracking.candidates;
    candidates.pairs.retain(|&[a, b]| {
        bodies.allows([a, b]) || bodies.old_filter(a).allows(bodies.old_filter(b))
    });
    candidates.live.extend(
        candidates
            .pairs
            .iter()
            .map(|&pair| bodies.was_live(pair, pair.map(|index| &bodies.previous[index as usize]))),
    );
    tracking
}

/// Whether a body is there.
pub fn is_live(flags: u16) -> bool {
    flags & flag::LIVE != 0
}

/// What the finder found. Its boxes are valid, so it fails only if memory is exhausted. A broad phase
/// that lacks pairs would be wrong, so then the program ends, as when a collection cannot grow.
pub fn found(result: Result<&[[u32; 2]], Error>) -> &[[u32; 2]] {
    result.unwrap_or_else(|_| handle_alloc_error(Layout::new::<[u32; 2]>()))
}
