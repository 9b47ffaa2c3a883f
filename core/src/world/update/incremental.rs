//! The update when few bodies left their fat AABBs: it tests the candidates, and looks these few up in
//! the tree.
//!
//! Where most bodies move, the fat AABB of a body that left it is extended: its candidates stay, and
//! some are added; replacing them too takes 1.07 to 1.14 of the time where all drift (1,000 and 10,000
//! bodies, paired). Where few move it gets a new one, and its candidates are replaced: that takes a scan of
//! the list, but extended again and again a fat AABB would grow for ever.

use alloc::vec::Vec;
use core::hint::black_box;
use core::ops::Range;

use crate::memory::{OutOfMemory, prefetch_item, prefetch_pays, preload, reserve_for};
use crate::sampling::positions;
use crate::world::bodies::{Bodies, RANDOM_READ, When, flag};
use crate::world::candidates::{CHUNK, Candidates, write_wanted};
use crate::world::changes::Events;
use crate::world::layout;
use crate::world::policy::{Policy, TRIES_SAMPLES};
use crate::world::tracking::{Scratch, Tracking};
use crate::world::tree::{BATCH, TOGETHER};
use crate::{Aabb, Scalar};

/// How many candidates ahead boxes are prefetched: measured on drift and mostly-still in 3D at 1,000,000.
const AHEAD: usize = 24;
/// Finding the candidates of a body in the list takes as long as testing this many in order. Measured on
/// drift at 10,000 and 100,000 where only a share of the bodies moves. If others move in each frame (0.05
/// to 1 %), always testing all takes 1.17 to 1.73 of the time; if the same ones move (up to 10 %), never
/// doing so takes 1.0 to 1.33. Half as much is the same within 2 %.
const SELECT: usize = 12;

/// How many of the bodies that are looked up are tried first, and from how many on.
const SAMPLE: usize = 64;
const SAMPLED_FROM: usize = 16 * SAMPLE;

/// Reports what begins and ends, given which bodies changed, escaped and left. Returns false, with nothing reported
/// and the candidates as before, where there would be too many of them, or too much of the tree to read.
#[inline(never)]
pub fn incremental<const D: usize, T: Scalar>(
    bodies: &mut Bodies<D, T>,
    tracking: &mut Tracking<D, T>,
    events: &mut Events,
    flights: usize,
    is_tree_advanced: bool,
) -> bool {
    let Scratch { escaped, woken, .. } = &mut tracking.scratch;
    let lost = escaped.iter().chain(bodies.edits.leaving());
    woken.clear();
    woken.extend(lost.filter(|&&index| bodies.slots.has(index, flag::ASLEEP)));
    let (escaped, wakes) = (escaped.len(), !woken.is_empty());
    let has_tree = if escaped > 0 || wakes {
        tracking.tree.note_uses(escaped);
        if is_tree_advanced {
            tracking.tree.is_fresh()
        } else if tracking.tree.is_built() {
            tracking.advance_tree(bodies)
        } else {
            // This update does without: to build it, and then to read too much of it, took four times as long as finding all pairs.
            tracking.is_tree_due = true;
            false
        }
    } else {
        tracking.tree.is_built()
    };
    let extends = !wakes && flights == 0 && tracking.can_extend(bodies);
    let mut most = tracking.policy.most_reads(bodies.slots.live);
    if !has_tree {
        // What the finder finds is stored, all of it.
        most = most.min(bodies.slots.live);
    }
    if bodies.rules.allow_all() {
        // As many as are kept overlap at most: once a crowd has parted, finding all pairs takes less time than in it.
        tracking.policy.note_candidates(tracking.candidates.len());
    }
    tracking.policy.note_incremental(escaped - flights, flights);
    tracking.scratch.mark(bodies, true);
    let mut is_right = !wakes || tracking.wake(bodies, &mut events.ended, &mut most, has_tree);
    if is_right {
        let [jumped, count] = tracking.list_queries(bodies, extends);
        layout::note_jumps(&mut tracking.locality_decay, jumped);
        // The finder leaves out what lies near none of them.
        let by_tree = has_tree && Policy::tree_pays(count, bodies.slots.live);
        let look_ups = LookUps { count, extends, has_tree: by_tree };
        if !by_tree {
            most = most.min(bodies.slots.live);
        }
        let before = most;
        let tries = TRIES_SAMPLES && by_tree && !tracking.policy.has_flown();
        is_right = !tries || tracking.are_few_reads(count, most);
        let turns = if has_tree && is_right { tracking.move_in_tree(bodies) } else { 0 };
        is_right = is_right
            && tracking.find_added(bodies, &mut events.begun, look_ups, &mut most)
            && tracking.find_among_flying(bodies, &mut events.begun, !by_tree, most)
            && tracking.scratch.reserve(&mut tracking.candidates, &mut events.begun).is_ok();
        tracking.policy.note_reads(before - most, flights, turns, bodies.slots.live);
    }
    if is_right {
        if !bodies.edits.changed().is_empty() || !bodies.edits.leaving().is_empty() {
            tracking.test_candidates(bodies, events, !extends);
        }
        tracking.add_candidates();
    } else {
        tracking.give_up(bodies, events, flights);
    }
    tracking.scratch.mark(bodies, false);
    is_right
}

/// How candidates are looked up.
struct LookUps {
    /// Of how many bodies.
    count: usize,
    /// Whether only those are wanted that are not candidates yet.
    extends: bool,
    /// Whether in the tree.
    has_tree: bool,
}

impl<const D: usize, T: Scalar> Tracking<D, T> {
    /// Whether the fat AABBs of the bodies that left theirs can be extended, so that candidates are only
    /// added: if most bodies move, and none of these went far.
    fn can_extend(&self, bodies: &Bodies<D, T>) -> bool {
        let (boxes, previous) = (bodies.boxes.now(), bodies.boxes.previous());
        bodies.edits.changed().len() * 2 > bodies.slots.live
            && bodies.edits.leaving().is_empty()
            && self.scratch.escaped.iter().all(|&index| {
                let row = index as usize;
                !bodies.slots.has(index, flag::NEW | flag::REFILTERED)
                    && !self.motion.is_jump(&previous[row], &boxes[row])
            })
    }

    /// Wakes the marked bodies, and lists what ends between one of them and a body that was asleep too: such pairs are
    /// not among the candidates. Returns false, with no body awake, if they are not found in `most` steps.
    #[inline(never)]
    fn wake(
        &mut self,
        bodies: &mut Bodies<D, T>,
        ended: &mut Vec<[u32; 2]>,
        most: &mut usize,
        has_tree: bool,
    ) -> bool {
        let Self { tree, fat, finder, scratch, .. } = self;
        let Scratch { queries, woken, leaves, found, is_escaped, .. } = scratch;
        queries.clear();
        let may_pair = |index: &&u32| {
            !bodies.rules.filter(&bodies.slots, **index, When::LastUpdate).allows_none()
        };
        let woken_boxes = woken.iter().filter(may_pair);
        let previous = bodies.boxes.previous();
        queries.extend(woken_boxes.map(|&index| (index, previous[index as usize])));
        let are_asleep = |index| bodies.slots.has(index, flag::ASLEEP);
        for batch in queries.chunks(if has_tree { BATCH } else { usize::MAX }) {
            let is_found = if has_tree {
                tree.tree().overlapping_many(batch, leaves, found, most)
            } else {
                finder.find_near(batch, fat, &are_asleep, found, most)
            };
            // All that are found, since one body may have many neighbors.
            if !is_found || reserve_for(ended, ended.len() + found.len()).is_err() {
                woken.clear();
                return false;
            }
            let pairs = found.iter().map(|&[query, other]| [batch[query as usize].0, other]);
            ended.extend(pairs.filter(|&[index, other]| {
                are_asleep(other)
                    && (index < other || index != other && !is_escaped[other as usize])
                    && bodies.was_live([index, other])
                    && !bodies.is_live([index, other])
            }));
        }
        self.sleep.count -= woken.len();
        self.sleep.woke += woken.len();
        woken.iter().for_each(|&index| bodies.slots.lower(index, flag::ASLEEP));
        true
    }

    /// Lets the bodies sleep on that were woken, and forgets what would have been reported.
    fn give_up(&mut self, bodies: &mut Bodies<D, T>, events: &mut Events, flights: usize) {
        events.begun.clear();
        events.ended.clear();
        let Self { sleep, scratch: Scratch { woken, .. }, tree, is_tree_due, policy, .. } = self;
        sleep.count += woken.len();
        sleep.woke -= woken.len();
        woken.iter().for_each(|&index| bodies.slots.raise(index, flag::ASLEEP));
        // It holds some of the fat AABBs that were not made.
        tree.abandon();
        // All candidates are found now, which takes long enough without a part of the tree.
        *is_tree_due = false;
        policy.note_excess(flights);
    }

    /// Tests the candidates of the bodies that changed, and if `drops` lists the positions of those of
    /// marked bodies instead.
    #[inline(never)]
    fn test_candidates(&mut self, bodies: &Bodies<D, T>, events: &mut Events, drops: bool) {
        let Self { candidates, scratch, .. } = self;
        let boxes = bodies.boxes.now();
        let count = candidates.listed().len();
        let are_few = bodies.edits.changed().len() * SELECT <= count;
        if are_few {
            scratch.flag_changed(bodies, true);
        } else if count * RANDOM_READ > boxes.len() {
            preload(boxes);
        }
        let (mut overlap, mut listed) = ([false; CHUNK], [0; CHUNK]);
        for start in (0..count).step_by(CHUNK) {
            let some = start..count.min(start + CHUNK);
            if !are_few {
                test(boxes, candidates.listed(), some.clone(), &mut overlap);
            }
            let found = match (are_few, drops) {
                (true, _) => scratch.list_changed(candidates, some, &mut listed),
                (_, true) => scratch.list_flips::<true>(candidates, some, &overlap, &mut listed),
                (_, false) => scratch.list_flips::<false>(candidates, some, &overlap, &mut listed),
            };
            let Scratch { is_escaped, dropped, .. } = &mut *scratch;
            for at in listed[..found].iter().map(|&at| start + usize::from(at)) {
                let [a, b] = candidates.listed()[at];
                if drops && is_escaped[a as usize] | is_escaped[b as usize] {
                    dropped.push(at);
                    continue;
                }
                let is_live = boxes[a as usize].overlaps_branch_free(&boxes[b as usize]);
                if candidates.live()[at] != is_live {
                    candidates.set_live(at, is_live);
                    if is_live { &mut events.begun } else { &mut events.ended }.push([a, b]);
                }
            }
        }
        if are_few {
            scratch.flag_changed(bodies, false);
        }
        for &at in &scratch.dropped {
            let pair = candidates.listed()[at];
            if candidates.live()[at] && !bodies.is_live(pair) {
                events.ended.push(pair);
            }
        }
    }

    /// Lists the new fat AABBs of the bodies that left theirs: first of those that are to be looked up, then of those whose
    /// filters allow no pair. Returns how many jumped, and how many are to be looked up.
    #[inline(never)]
    fn list_queries(&mut self, bodies: &Bodies<D, T>, extends: bool) -> [usize; 2] {
        let mut jumped = 0;
        let Self { fat, motion, policy, scratch: Scratch { escaped, queries, .. }, .. } = self;
        let (boxes, previous) = (bodies.boxes.now(), bodies.boxes.previous());
        queries.clear();
        // Spare capacity, as the other list has: steady motion must not allocate.
        queries.reserve(escaped.capacity());
        queries.extend(escaped.iter().map(|&index| {
            let row = index as usize;
            let is_new = bodies.slots.has(index, flag::NEW);
            let before = if is_new { &boxes[row] } else { &previous[row] };
            jumped += usize::from(motion.is_jump(before, &boxes[row]));
            let ahead = if policy.is_tight() || bodies.slots.has(index, flag::FLYING) {
                boxes[row]
            } else {
                motion.alone(index, before, &boxes[row])
            };
            (index, if extends { fat[row].union(&ahead) } else { ahead })
        }));
        if bodies.rules.allow_all() {
            return [jumped, queries.len()];
        }
        let mut count = 0;
        for at in 0..queries.len() {
            if !bodies.rules.filter_now(queries[at].0).allows_none() {
                queries.swap(count, at);
                count += 1;
            }
        }
        [jumped, count]
    }

    /// Whether looking bodies up seems to take at most as many reads as it may, by a sample: where it does not, most of them are
    /// moved in the tree and looked up in vain.
    #[inline(never)]
    fn are_few_reads(&mut self, count: usize, most: usize) -> bool {
        let Self { tree, scratch: Scratch { queries, sampled, leaves, found, .. }, .. } = self;
        if count < SAMPLED_FROM {
            return true;
        }
        sampled.clear();
        sampled.extend(positions(count, SAMPLE).map(|at| queries[at]));
        let may_read = most.saturating_mul(SAMPLE) / count;
        tree.tree().overlapping_many(sampled, leaves, found, &mut may_read.clone())
    }

    /// Removes bodies that left or fly from the tree, and gives it the new fat AABBs. Returns how many
    /// took off or landed.
    #[inline(never)]
    fn move_in_tree(&mut self, bodies: &Bodies<D, T>) -> usize {
        let mut turns = 0;
        let Self { tree, scratch: Scratch { queries, .. }, .. } = self;
        let tree = tree.tree_mut();
        for &index in bodies.edits.leaving() {
            tree.remove(index);
        }
        for chunk in queries.chunks(TOGETHER) {
            chunk.iter().for_each(|&(index, _)| tree.prefetch_leaf_of(index));
            for (index, aabb) in chunk {
                let flies = bodies.slots.has(*index, flag::FLYING);
                turns += usize::from(flies == tree.holds(*index));
                if flies {
                    tree.remove(*index);
                } else {
                    tree.set(*index, aabb);
                }
            }
        }
        turns
    }

    /// Finds the candidates of the bodies that are looked up. Returns false if there are too many, also for the memory, or if
    /// they are not found in `most` steps.
    #[inline(never)]
    fn find_added(
        &mut self,
        bodies: &Bodies<D, T>,
        begun: &mut Vec<[u32; 2]>,
        LookUps { count, extends, has_tree }: LookUps,
        most: &mut usize,
    ) -> bool {
        let limit = self.policy.most_candidates(bodies.slots.live);
        let (boxes, previous) = (bodies.boxes.now(), bodies.boxes.previous());
        let Self { tree, fat, candidates, finder, scratch, .. } = self;
        let Scratch { queries, leaves, found, is_escaped, added, .. } = scratch;
        added.clear();
        if reserve_for(added, candidates.capacity() / 4).is_err() {
            return false;
        }
        for batch in queries[..count].chunks(if has_tree { BATCH } else { usize::MAX }) {
            let is_found = if has_tree {
                tree.tree().overlapping_many(batch, leaves, found, most)
            } else {
                let has_fat =
                    |index: u32| bodies.slots.has(index, flag::LIVE) && !is_escaped[index as usize];
                finder.find_near(batch, fat, &has_fat, found, most)
                    && finder.find_among(batch, found, most)
            };
            let is_found = is_found
                && candidates.listed().len() + added.len() <= limit
                && reserve_for(added, added.len() + found.len()).is_ok();
            if !is_found {
                return false;
            }
            for found in found.chunks(TOGETHER) {
                for &[_, other] in found {
                    black_box(fat[other as usize].min[0]);
                    if !bodies.slots.has(other, flag::ASLEEP) {
                        black_box(boxes[other as usize].min[0]);
                    }
                }
                for &[query, other] in found {
                    let (index, aabb) = batch[query as usize];
                    let (first, second) = (index as usize, other as usize);
                    // The tree holds the new fat AABBs of marked bodies, and larger boxes of some others.
                    let is_near = if is_escaped[second] {
                        // The tree has no body that flies, so those are not found twice.
                        index < other || bodies.slots.has(index, flag::FLYING)
                    } else {
                        aabb.overlaps_branch_free(&fat[second])
                    };
                    let is_candidate = is_near
                        && !(extends && fat[first].overlaps_branch_free(&fat[second]))
                        && bodies.allows([index, other]);
                    if !is_candidate {
                        continue;
                    }
                    // A sleeping body has the same box in all tables, and its fat AABB was just read.
                    let [now, before] = if bodies.slots.has(other, flag::ASLEEP) {
                        [&fat[second]; 2]
                    } else {
                        [&boxes[second], &previous[second]]
                    };
                    let pair = [other.min(index), other.max(index)];
                    let is_live = boxes[first].overlaps_branch_free(now);
                    added.push((pair, is_live));
                    let was_near = || previous[first].overlaps_branch_free(before);
                    if is_live && !(was_near() && bodies.was_allowed(pair)) {
                        let count = begun.len() + 1;
                        if reserve_for(begun, count).is_err() {
                            return false;
                        }
                        begun.push(pair);
                    }
                }
            }
        }
        true
    }

    /// Adds the candidates that were found, in place of dropped ones first, and gives the bodies that were looked up
    /// their new fat AABBs.
    #[inline(never)]
    fn add_candidates(&mut self) {
        let Self { fat, candidates, scratch: Scratch { queries, dropped, added, .. }, .. } = self;
        let mut free = dropped.iter();
        added.drain(..).for_each(|(pair, is_live)| candidates.put(free.next(), pair, is_live));
        candidates.remove(free.as_slice());
        dropped.clear();
        for (index, aabb) in &*queries {
            fat[*index as usize] = *aabb;
        }
    }
}

impl<const D: usize, T: Scalar> Scratch<D, T> {
    /// Reserves memory for the candidates that were found, for testing all, and for sorting what begins with those found.
    fn reserve(
        &mut self,
        candidates: &mut Candidates,
        begun: &mut Vec<[u32; 2]>,
    ) -> Result<(), OutOfMemory> {
        self.sorter.reserve(begun, begun.len())?;
        candidates.reserve(self.added.len(), &mut self.dropped)
    }

    /// Sets whether the bodies that escaped or left are marked.
    fn mark(&mut self, bodies: &Bodies<D, T>, is_marked: bool) {
        self.is_escaped.resize(bodies.slots.len(), false);
        for &index in self.escaped.iter().chain(bodies.edits.leaving()) {
            self.is_escaped[index as usize] = is_marked;
        }
    }

    /// Sets whether the bodies that changed or left are flagged as changed.
    fn flag_changed(&mut self, bodies: &Bodies<D, T>, is_changed: bool) {
        self.is_changed.resize(bodies.slots.len(), false);
        for &index in bodies.edits.changed().iter().chain(bodies.edits.leaving()) {
            self.is_changed[index as usize] = is_changed;
        }
    }

    /// Lists which of some candidates, by position among them, are of bodies that are flagged as changed. Returns how many.
    fn list_changed(
        &self,
        candidates: &Candidates,
        some: Range<usize>,
        listed: &mut [u8; CHUNK],
    ) -> usize {
        write_wanted(listed, &candidates.listed()[some], |at, [a, b]| {
            (at as u8, self.is_changed[a as usize] | self.is_changed[b as usize])
        })
    }

    /// Lists which of some candidates, by position among them, begin or end, given which overlap, or if `DROPS` are of
    /// marked bodies. Returns how many.
    fn list_flips<const DROPS: bool>(
        &self,
        candidates: &Candidates,
        some: Range<usize>,
        overlap: &[bool; CHUNK],
        listed: &mut [u8; CHUNK],
    ) -> usize {
        let (is_escaped, live) = (&self.is_escaped, &candidates.live()[some.clone()]);
        write_wanted(listed, &candidates.listed()[some], |at, [a, b]| {
            let is_dropped = DROPS && is_escaped[a as usize] | is_escaped[b as usize];
            (at as u8, (overlap[at % CHUNK] != live[at]) | is_dropped)
        })
    }
}

/// Tests which of some pairs overlap. In a loop of its own, compilers vectorize the test of a pair: drift in 2D takes 0.9 of the time.
fn test<const D: usize, T: Scalar>(
    boxes: &[Aabb<D, T>],
    pairs: &[[u32; 2]],
    some: Range<usize>,
    overlap: &mut [bool; CHUNK],
) {
    let is_far = prefetch_pays(boxes);
    for (at, (overlap, &[a, b])) in overlap.iter_mut().zip(&pairs[some.clone()]).enumerate() {
        if is_far && let Some(&[_, later]) = pairs.get(some.start + at + AHEAD) {
            // The first bodies of neighbors in the list are near each other in memory.
            prefetch_item(boxes, later as usize);
        }
        *overlap = boxes[a as usize].overlaps_branch_free(&boxes[b as usize]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Aabb, BroadPhase, Filter};

    #[test]
    fn a_sample_tells_whether_the_tree_would_be_read_too_much() {
        let count = 2 * SAMPLED_FROM;
        let boxed = |at: usize, size: f32| Aabb::new([at as f32], [at as f32 + size]);
        let all: Vec<_> = (0..count).map(|at| boxed(at, 0.5)).collect();
        let mut world = BroadPhase::<1>::new();
        world.insert_many(&all, Filter::default()).unwrap();
        world.queries();
        let tracking = &mut world.tracking;
        for (size, expected) in [(0.5, true), (100.0, false)] {
            let queries = (0..count).map(|at| (at as u32, boxed(at, size)));
            tracking.scratch.queries = queries.collect();
            assert_eq!(tracking.are_few_reads(count, 8 * count), expected, "{size}");
            // A few are looked up at once.
            assert!(tracking.are_few_reads(SAMPLED_FROM - 1, 8));
        }
    }
}
