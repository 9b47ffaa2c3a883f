//! The update when few bodies left their fat AABBs: it tests the candidates, and looks these few up in
//! the tree.
//!
//! Where most bodies move, the fat AABB of a body that left it is extended: its candidates stay, and
//! some are added. Where few move it gets a new one, and its candidates are replaced: that takes a scan
//! of the list, but extended again and again a fat AABB would grow for ever.

use alloc::vec::Vec;
use core::hint::black_box;
use core::slice::Iter;

use super::search_tree;
use crate::memory::{prefetch_item, prefetch_pays, preload};
use crate::world::bodies::{Bodies, RANDOM_READ, flag};
use crate::world::candidates::{Candidates, push_wanted};
use crate::world::changes::Events;
use crate::world::layout::{self, Reorder};
use crate::world::policy::{LOOK_UP, Work};
use crate::world::tracking::{Scratch, Tracking};
use crate::world::tree::{BATCH, TOGETHER};
use crate::{Aabb, Scalar};

/// How many candidates ahead boxes are prefetched.
const AHEAD: usize = 24;
/// Finding the candidates of a body in the list takes as long as testing this many in order.
const SELECT: usize = 12;

/// Reports what begins and ends, given which bodies changed, escaped and left. Returns how to reorder
/// storage.
#[inline(never)]
pub fn incremental<const D: usize, T: Scalar>(
    bodies: &mut Bodies<D, T>,
    tracking: &mut Tracking<D, T>,
    events: &mut Events,
) -> Reorder {
    let changed = bodies.changed.len() + bodies.leaving.len();
    let escaped = tracking.scratch.escaped.len();
    let sleepers = looked_up(bodies, &tracking.scratch.escaped)
        .filter(|&index| bodies.slots.has(index, flag::ASLEEP))
        .count();
    if escaped > 0 || sleepers > 0 {
        tracking.tree_uses += escaped;
        search_tree::ready(bodies, tracking);
    }
    let extends = sleepers == 0 && can_extend(bodies, tracking);
    mark(bodies, &mut tracking.scratch, true);
    if sleepers > 0 {
        wake(bodies, tracking, &mut events.ended);
    }
    let tests = if changed > 0 { test_candidates(bodies, tracking, events, !extends) } else { 0 };
    let jumped = move_in_tree(bodies, tracking, extends);
    layout::note_jumps(&mut tracking.locality_decay, jumped);
    add_candidates(bodies, tracking, &mut events.begun, extends);
    mark(bodies, &mut tracking.scratch, false);
    let work = Work { bodies: bodies.live(), changed, tests, escaped, jumped };
    if tracking.policy.note_incremental(&work) { Reorder::BySlot } else { Reorder::No }
}

/// The bodies that escaped or left.
fn looked_up<'a, const D: usize, T: Scalar>(
    bodies: &'a Bodies<D, T>,
    escaped: &'a [u32],
) -> impl Iterator<Item = u32> + 'a {
    escaped.iter().chain(&bodies.leaving).copied()
}

/// Marks the bodies that escaped or left, or clears the marks.
fn mark<const D: usize, T: Scalar>(
    bodies: &Bodies<D, T>,
    scratch: &mut Scratch<D, T>,
    is_marked: bool,
) {
    let Scratch { is_escaped, escaped, .. } = scratch;
    is_escaped.resize(bodies.slots.len(), false);
    looked_up(bodies, escaped).for_each(|index| is_escaped[index as usize] = is_marked);
}

/// Whether the fat AABBs of the bodies that left theirs can be extended, so that candidates are only
/// added: if most bodies move, and none of these went far.
fn can_extend<const D: usize, T: Scalar>(bodies: &Bodies<D, T>, tracking: &Tracking<D, T>) -> bool {
    bodies.changed.len() * 2 > bodies.live()
        && bodies.leaving.is_empty()
        && tracking.scratch.escaped.iter().all(|&index| {
            let row = index as usize;
            !bodies.slots.has(index, flag::NEW | flag::REFILTERED)
                && !tracking.motion.is_jump(&bodies.previous[row], &bodies.boxes[row])
        })
}

/// Wakes the marked bodies, and lists what ends between one of them and a body that was asleep too: such
/// pairs are not among the candidates.
#[inline(never)]
fn wake<const D: usize, T: Scalar>(
    bodies: &mut Bodies<D, T>,
    tracking: &mut Tracking<D, T>,
    ended: &mut Vec<[u32; 2]>,
) {
    let Tracking { tree, scratch, sleep, .. } = tracking;
    let Scratch { queries, leaves, found, is_escaped, escaped, .. } = scratch;
    let sleepers = looked_up(bodies, escaped).filter(|&it| bodies.slots.has(it, flag::ASLEEP));
    queries.clear();
    queries.extend(sleepers.map(|index| (index, bodies.previous[index as usize])));
    for batch in queries.chunks(BATCH) {
        tree.overlapping_many(batch, leaves, found);
        let pairs = found.iter().map(|&[query, other]| [batch[query as usize].0, other]);
        ended.extend(pairs.filter(|&[index, other]| {
            let boxes = [index, other].map(|it| &bodies.previous[it as usize]);
            bodies.slots.has(other, flag::ASLEEP)
                && (index < other || index != other && !is_escaped[other as usize])
                && bodies.was_live([index, other], boxes)
                && !bodies.is_live([index, other])
        }));
    }
    sleep.count -= queries.len();
    sleep.woke += queries.len();
    for &index in escaped.iter().chain(&bodies.leaving) {
        bodies.slots.lower(index, flag::ASLEEP);
    }
}

/// Tests the candidates of the bodies that changed, and if `drops` lists the positions of those of marked
/// bodies instead. Returns how many were tested.
#[inline(never)]
fn test_candidates<const D: usize, T: Scalar>(
    bodies: &Bodies<D, T>,
    tracking: &mut Tracking<D, T>,
    events: &mut Events,
    drops: bool,
) -> usize {
    let Tracking { candidates, scratch, .. } = tracking;
    let tests = match (bodies.changed.len() * SELECT > candidates.pairs.len(), drops) {
        (true, true) => list_flips::<D, T, true>(bodies, candidates, scratch),
        (true, false) => list_flips::<D, T, false>(bodies, candidates, scratch),
        (false, _) => list_changed(bodies, candidates, scratch),
    };
    let Scratch { is_escaped, positions, dropped, .. } = scratch;
    dropped.reserve(candidates.pairs.capacity() / 4);
    for &at in &*positions {
        let [a, b] = candidates.pairs[at];
        if drops && is_escaped[a as usize] | is_escaped[b as usize] {
            dropped.push(at);
            continue;
        }
        let is_live = bodies.boxes[a as usize].overlaps_branch_free(&bodies.boxes[b as usize]);
        if candidates.live[at] != is_live {
            candidates.live[at] = is_live;
            if is_live { &mut events.begun } else { &mut events.ended }.push([a, b]);
        }
    }
    for &at in &*dropped {
        let pair = candidates.pairs[at];
        if candidates.live[at] && !bodies.is_live(pair) {
            events.ended.push(pair);
        }
    }
    tests
}

/// Lists the positions of the candidates of bodies that changed or left. Returns how many.
fn list_changed<const D: usize, T: Scalar>(
    bodies: &Bodies<D, T>,
    candidates: &Candidates,
    scratch: &mut Scratch<D, T>,
) -> usize {
    let Scratch { is_changed, positions, .. } = scratch;
    let changed = || bodies.changed.iter().chain(&bodies.leaving);
    is_changed.resize(bodies.slots.len(), false);
    changed().for_each(|&index| is_changed[index as usize] = true);
    positions.clear();
    positions.reserve(candidates.pairs.capacity() / 4);
    push_wanted(positions, &candidates.pairs, |at, [a, b]| {
        (at, is_changed[a as usize] | is_changed[b as usize])
    });
    changed().for_each(|&index| is_changed[index as usize] = false);
    positions.len()
}

/// Tests all candidates, and lists the positions of those that begin or end and, if `DROPS`, of those of
/// marked bodies. Returns how many were tested.
fn list_flips<const D: usize, T: Scalar, const DROPS: bool>(
    bodies: &Bodies<D, T>,
    candidates: &Candidates,
    scratch: &mut Scratch<D, T>,
) -> usize {
    let boxes = &bodies.boxes;
    if candidates.pairs.len() * RANDOM_READ > boxes.len() {
        preload(boxes);
    }
    let is_far = prefetch_pays(boxes);
    let Scratch { is_escaped, positions, .. } = scratch;
    positions.clear();
    positions.reserve(candidates.pairs.capacity() / 4);
    push_wanted(positions, &candidates.pairs, |at, [a, b]| {
        if is_far && let Some(&[_, later]) = candidates.pairs.get(at + AHEAD) {
            // The first bodies of neighbors in the list are near each other in memory.
            prefetch_item(boxes, later as usize);
        }
        let is_live = boxes[a as usize].overlaps_branch_free(&boxes[b as usize]);
        let is_dropped = DROPS && is_escaped[a as usize] | is_escaped[b as usize];
        (at, (is_live != candidates.live[at]) | is_dropped)
    });
    candidates.pairs.len()
}

/// Removes bodies that left from the tree, and gives it the new fat AABBs of those that left theirs,
/// which are to be looked up. Returns how many jumped.
#[inline(never)]
fn move_in_tree<const D: usize, T: Scalar>(
    bodies: &Bodies<D, T>,
    tracking: &mut Tracking<D, T>,
    extends: bool,
) -> usize {
    let mut jumped = 0;
    let Tracking { tree, fat, motion, scratch: Scratch { escaped, queries, .. }, .. } = tracking;
    for &index in &bodies.leaving {
        tree.remove(index);
    }
    queries.clear();
    queries.reserve(bodies.live() / LOOK_UP + 1);
    for chunk in escaped.chunks(TOGETHER) {
        chunk.iter().for_each(|&index| tree.prefetch_leaf_of(index));
        for &index in chunk {
            let row = index as usize;
            let is_new = bodies.slots.has(index, flag::NEW);
            let before = if is_new { &bodies.boxes[row] } else { &bodies.previous[row] };
            jumped += usize::from(motion.is_jump(before, &bodies.boxes[row]));
            let ahead = motion.alone(index, before, &bodies.boxes[row], &bodies.options);
            let aabb = if extends { fat[row].union(&ahead) } else { ahead };
            queries.push((index, aabb));
            tree.set(index, &aabb);
        }
    }
    jumped
}

/// Gives the bodies that are looked up their new fat AABBs, and adds their candidates: if `extends`,
/// those that are not candidates yet.
fn add_candidates<const D: usize, T: Scalar>(
    bodies: &Bodies<D, T>,
    tracking: &mut Tracking<D, T>,
    begun: &mut Vec<[u32; 2]>,
    extends: bool,
) {
    let Tracking { tree, fat, candidates, scratch, .. } = tracking;
    let Scratch { queries, leaves, found, is_escaped, dropped, .. } = scratch;
    candidates.reserve();
    let mut free = dropped.iter();
    for batch in queries.chunks(BATCH) {
        tree.overlapping_many(batch, leaves, found);
        let lookup = Lookup { bodies, fat, is_escaped, batch, extends };
        lookup.add(found, candidates, &mut free, begun);
    }
    candidates.remove(free.as_slice());
    dropped.clear();
    for (index, aabb) in &*queries {
        fat[*index as usize] = *aabb;
    }
}

/// A batch of bodies that were looked up.
struct Lookup<'a, const D: usize, T: Scalar> {
    bodies: &'a Bodies<D, T>,
    fat: &'a [Aabb<D, T>],
    is_escaped: &'a [bool],
    /// Their indices and new fat AABBs.
    batch: &'a [(u32, Aabb<D, T>)],
    extends: bool,
}

impl<const D: usize, T: Scalar> Lookup<'_, D, T> {
    /// Adds the candidates among what the tree found, at the free positions as long as there are any.
    #[inline(never)]
    fn add(
        &self,
        found: &[[u32; 2]],
        candidates: &mut Candidates,
        free: &mut Iter<usize>,
        begun: &mut Vec<[u32; 2]>,
    ) {
        let Self { bodies, fat, is_escaped, batch, extends } = *self;
        for found in found.chunks(TOGETHER) {
            for &[_, other] in found {
                black_box(fat[other as usize].min[0]);
                if !bodies.slots.has(other, flag::ASLEEP) {
                    black_box(bodies.boxes[other as usize].min[0]);
                }
            }
            for &[query, other] in found {
                let (index, aabb) = &batch[query as usize];
                let (first, second) = (*index as usize, other as usize);
                // The tree holds the new fat AABBs of marked bodies, and larger boxes of some others.
                let is_near = if is_escaped[second] {
                    *index < other
                } else {
                    aabb.overlaps_branch_free(&fat[second])
                };
                let is_candidate = is_near
                    && !(extends && fat[first].overlaps_branch_free(&fat[second]))
                    && bodies.allows([*index, other]);
                if is_candidate {
                    let pair = [other.min(*index), other.max(*index)];
                    let is_live =
                        bodies.boxes[first].overlaps_branch_free(self.cached(other, &bodies.boxes));
                    candidates.put(free.next(), pair, is_live);
                    let boxes = [&bodies.previous[first], self.cached(other, &bodies.previous)];
                    if is_live && !bodies.was_live([*index, other], boxes) {
                        begun.push(pair);
                    }
                }
            }
        }
    }

    /// The box of a body in a table. A sleeping body has the same box in all tables, and its fat AABB was
    /// read just before.
    #[inline]
    fn cached<'b>(&'b self, index: u32, table: &'b [Aabb<D, T>]) -> &'b Aabb<D, T> {
        let sleeps = self.bodies.slots.has(index, flag::ASLEEP);
        let table = if sleeps { self.fat } else { table };
        &table[index as usize]
    }
}
