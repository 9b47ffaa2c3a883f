//! The update when many bodies left their fat AABBs: it makes new ones and finds all candidates.

use alloc::vec::Vec;

use crate::float::greater;
use crate::memory::{OutOfMemory, preload};
use crate::sampling::positions;
use crate::world::bodies::{Bodies, When, flag};
use crate::world::candidates::push_wanted;
use crate::world::changes::Events;
use crate::world::finder::Finder;
use crate::world::layout::{self, Reorder};
use crate::world::policy::{Policy, TRIES_SAMPLES, longest_side};
use crate::world::tracking::Tracking;
use crate::{Aabb, Scalar};

/// A sample is to have about as many pairs as this, if there are as many as there may be.
const SAMPLED_PAIRS: usize = 100;
/// No sample is looked at that has more than one of this many bodies.
const LEAST_GAIN: usize = 4;

/// Reports what begins and ends, given which bodies changed, escaped and left. Returns how to reorder
/// storage.
///
/// # Errors
/// [`OutOfMemory`]: then the candidates are as before, but not the fat AABBs.
#[inline(never)]
pub fn rebuild<const D: usize, T: Scalar>(
    bodies: &mut Bodies<D, T>,
    tracking: &mut Tracking<D, T>,
    events: &mut Events,
) -> Result<Reorder, OutOfMemory> {
    tracking.land_all(bodies);
    let escaped = &tracking.scratch.escaped;
    let moved = escaped.len();
    let is_new = |&&index: &&u32| bodies.slots.has(index, flag::NEW);
    let new = if bodies.edits.any_new() { escaped.iter().filter(is_new).count() } else { 0 };
    let are_same = bodies.edits.leaving().is_empty() && !bodies.rules.any_changed();

    tracking.list_ended(bodies, are_same, &mut events.ended);
    let is_fat = tracking.fatten_all(bodies);
    let is_fat = tracking.find_candidates(bodies, is_fat, &mut events.begun)?;
    tracking.wake_all(bodies);
    tracking.list_begun(bodies, are_same && new == 0, &mut events.begun);
    tracking.note_new_fat(bodies);

    let live = bodies.slots.live;
    let counts = [live, tracking.candidates.listed().len()];
    let [is_overdue, is_due] =
        layout::note_rebuild(&mut tracking.locality_decay, [moved, new], counts);
    tracking.is_order_due = is_due;
    Ok(if tracking.policy.note_rebuild(live, is_fat, (moved - new) * 2 < live) {
        Reorder::Later
    } else if is_overdue {
        Reorder::BySpace
    } else {
        Reorder::No
    })
}

impl<const D: usize, T: Scalar> Tracking<D, T> {
    /// Lists the live pairs that end. Where the bodies and filters are the same this follows from the
    /// boxes alone.
    fn list_ended(&self, bodies: &Bodies<D, T>, are_same: bool, ended: &mut Vec<[u32; 2]>) {
        let (candidates, boxes) = (&self.candidates, bodies.boxes.now());
        let is_apart =
            |[a, b]: [u32; 2]| !boxes[a as usize].overlaps_branch_free(&boxes[b as usize]);
        if are_same {
            let live = candidates.live();
            push_wanted(ended, candidates.listed(), |at, pair| (pair, live[at] & is_apart(pair)));
            ended.extend(candidates.asleep_pairs(&bodies.slots).filter(|&pair| is_apart(pair)));
        } else {
            candidates.for_each_live(&bodies.slots, &mut |pair| {
                if !bodies.is_live(pair) {
                    ended.push(pair);
                }
            });
        }
    }

    /// Lists the live ones of the new candidates that begin, and flags all live ones.
    fn list_begun(&mut self, bodies: &Bodies<D, T>, are_same: bool, begun: &mut Vec<[u32; 2]>) {
        let (boxes, previous) = (bodies.boxes.now(), bodies.boxes.previous());
        preload(boxes);
        preload(previous);
        self.candidates.flag_all(begun, |pair| {
            let [a, b] = pair.map(|index| index as usize);
            let is_live = boxes[a].overlaps_branch_free(&boxes[b]);
            [is_live, is_live & !previous[a].overlaps_branch_free(&previous[b])]
        });
        if !are_same {
            begun.clear();
            self.candidates.for_each_live(&bodies.slots, &mut |pair| {
                if !bodies.was_live(pair) {
                    begun.push(pair);
                }
            });
        }
    }

    /// Gives all bodies new fat AABBs, unless none would be larger than its body; that of a body that rests is
    /// its box. Returns whether it did.
    #[inline(never)]
    fn fatten_all(&mut self, bodies: &Bodies<D, T>) -> bool {
        let Self { fat, motion, policy, .. } = self;
        let Bodies { slots, boxes, edits, .. } = bodies;
        let (boxes, previous) = (boxes.now(), boxes.previous());
        let changed = edits.changed();
        motion.sample(changed.len(), |at| {
            let index = changed[at];
            // What had the slot of a new body before does not count as motion.
            let before = if slots.has(index, flag::NEW) { boxes } else { previous };
            (&before[index as usize], &boxes[index as usize])
        });
        // Where few bodies move they should not all leave their fat AABBs at once.
        let are_few = !bodies.scans_all(changed.len());
        let is_fat = !policy.is_tight() && (are_few || motion.lifetime >= 2.0);
        if is_fat {
            fat.copy_from_slice(boxes);
            for &index in changed.iter().filter(|&&index| !slots.has(index, flag::NEW)) {
                let (before, now) = (&previous[index as usize], &boxes[index as usize]);
                fat[index as usize] = if are_few {
                    motion.alone(index, before, now)
                } else {
                    motion.together(before, now)
                };
            }
        }
        is_fat
    }

    /// Replaces the candidates by the pairs of fat AABBs, or by those of the boxes if the fat AABBs are to be no larger or would
    /// have too many. Reserves memory for what begins. Returns whether the fat AABBs are larger.
    fn find_candidates(
        &mut self,
        bodies: &mut Bodies<D, T>,
        mut is_fat: bool,
        begun: &mut Vec<[u32; 2]>,
    ) -> Result<bool, OutOfMemory> {
        let Self { fat, candidates, finder, policy, scratch, .. } = self;
        if TRIES_SAMPLES
            && is_fat
            && policy.is_trial()
            && have_too_many(fat, finder, policy, bodies)?
        {
            policy.note_excess(0);
            is_fat = false;
        }
        loop {
            if !is_fat {
                fat.copy_from_slice(bodies.boxes.now());
            }
            // A sample may be wrong by a quarter: then all that was found is not given up.
            let most = policy.most_candidates(bodies.slots.live);
            let most = if is_fat { most + most / 4 } else { usize::MAX };
            if let Some(pairs) = finder.find(fat, bodies, [flag::LIVE, 0], When::Now, most)? {
                let mut most_begun = pairs.len().saturating_sub(candidates.len());
                // Of fat AABBs far more overlap than of boxes: memory for all of them would not be used.
                if is_fat && most_begun > begun.capacity() {
                    most_begun = pairs.iter().filter(|&&pair| bodies.is_live(pair)).count();
                }
                scratch.sorter.reserve(begun, most_begun)?;
                candidates.replace(pairs)?;
                break;
            }
            policy.note_excess(0);
            is_fat = false;
        }
        if is_fat {
            policy.note_candidates(finder.found);
        } else {
            policy.note_overlaps(finder.found);
        }
        Ok(is_fat)
    }
}

/// Whether fat AABBs seem to have too many candidates, by those of a sample among themselves: where that is so, finding all of
/// them in vain would take as long as an update. A sample misses a few large boxes, which may have most of the candidates, so
/// all that are larger than any of it are added. O(sqrt(n)) boxes are searched.
#[inline(never)]
fn have_too_many<const D: usize, T: Scalar>(
    fat: &[Aabb<D, T>],
    finder: &mut Finder<D, T>,
    policy: &Policy,
    bodies: &mut Bodies<D, T>,
) -> Result<bool, OutOfMemory> {
    let most = policy.most_candidates(bodies.slots.live);
    // One in n bodies has one in n * n of the pairs.
    let n: usize = 1 << (((most / SAMPLED_PAIRS) | 1).ilog2() / 2);
    if n < LEAST_GAIN {
        return Ok(false);
    }
    let flags = &mut bodies.slots.flags;
    let mut largest = 0.0;
    for index in positions(flags.len(), flags.len() / n) {
        if flags[index] & flag::LIVE != 0 {
            flags[index] |= flag::MARKED;
            largest = greater(longest_side(&fat[index]), largest);
        }
    }
    let is_large = |index: usize| longest_side(&fat[index]) > largest;
    for (index, flags) in flags.iter_mut().enumerate() {
        if *flags & flag::LIVE != 0 && is_large(index) {
            *flags |= flag::MARKED;
        }
    }
    // Nearly all pairs stand for n, or for n * n.
    let found = finder.find(fat, bodies, [flag::MARKED, 0], When::Now, most / n);
    let stands_for = |index: u32| if is_large(index as usize) { 1 } else { n };
    let is_excess = found.map(|pairs| {
        pairs.is_none_or(|pairs| {
            pairs.iter().map(|&[a, b]| stands_for(a) * stands_for(b)).sum::<usize>() > most
        })
    });
    bodies.slots.flags.iter_mut().for_each(|flags| *flags &= !flag::MARKED);
    is_excess
}

/// The tracking state of bodies that were read from a snapshot: the candidates are the pairs of the last update, and the
/// fat AABBs the boxes that bodies had then.
///
/// # Errors
/// [`OutOfMemory`].
pub fn restore<const D: usize, T: Scalar>(
    bodies: &Bodies<D, T>,
) -> Result<Tracking<D, T>, OutOfMemory> {
    let mut tracking = Tracking { fat: bodies.boxes.previous().to_vec(), ..Tracking::default() };
    let Tracking { fat, candidates, finder, policy, .. } = &mut tracking;
    let known = [flag::LIVE | flag::LEAVING, flag::NEW];
    let pairs = finder.find(fat, bodies, known, When::LastUpdate, usize::MAX)?;
    candidates.replace(pairs.unwrap_or_default())?;
    candidates.flag_all_live();
    policy.note_overlaps(finder.found);
    Ok(tracking)
}

#[cfg(test)]
mod tests {
    use std::mem::replace;

    use super::*;
    use crate::{BroadPhase, Filter};

    #[test]
    fn a_sample_tells_whether_fat_aabbs_have_too_many_candidates() {
        // A grid of boxes apart from each other, and fat AABBs that each overlap a few others, or dozens.
        let side = 90;
        let place = |at: usize| [at % side, at / side].map(|at| 2.0 * at as f32);
        let boxed = |at: usize, more: f32| {
            Aabb::new(place(at).map(|at| at - more), place(at).map(|at| at + 1.0 + more))
        };
        let mut world = BroadPhase::<2>::new();
        let all: Vec<_> = (0..side * side).map(|at| boxed(at, 0.0)).collect();
        world.insert_many(&all, Filter::default()).unwrap();
        world.update();
        let BroadPhase { bodies, tracking, .. } = &mut world;
        for (more, expected) in [(0.0, false), (0.4, false), (2.6, true)] {
            let fat: Vec<_> = (0..side * side).map(|at| boxed(at, more)).collect();
            let found = have_too_many(&fat, &mut tracking.finder, &tracking.policy, bodies);
            assert_eq!(found.ok(), Some(expected), "{more}");
            let few = side * side / 4;
            assert!(tracking.finder.found < few, "{} found", tracking.finder.found);
        }
        assert!(bodies.slots.flags.iter().all(|flags| flags & flag::MARKED == 0));
    }

    #[test]
    fn a_sample_does_not_miss_one_large_fat_aabb_with_most_of_the_candidates() {
        let side = 90;
        let place = |at: usize| [at % side, at / side].map(|at| 2.0 * at as f32);
        let boxed = |at: usize| Aabb::new(place(at), place(at).map(|at| at + 1.0));
        let mut all: Vec<_> = (0..side * side).map(boxed).collect();
        let mut world = BroadPhase::<2>::new();
        world.insert_many(&all, Filter::default()).unwrap();
        world.update();
        let BroadPhase { bodies, tracking, .. } = &mut world;
        let Tracking { finder, policy, .. } = tracking;
        for large in (0..all.len()).step_by(997) {
            for (reach, expected) in [(0.2, false), (1.0, true)] {
                let reach = reach * (2 * side) as f32;
                let before = replace(&mut all[large], Aabb::new([0.0; 2], [reach; 2]));
                let found = have_too_many(&all, finder, policy, bodies);
                assert_eq!(found.ok(), Some(expected), "{large} {reach}");
                all[large] = before;
            }
        }
    }

    #[test]
    fn no_memory_is_reserved_to_report_candidates_that_do_not_overlap() {
        // Two by two, bodies that do not touch, but their fat AABBs do.
        let boxed = |at: usize, more: f32| {
            let left = (12 * (at / 2)) as f32 + 1.2 * (at % 2) as f32;
            Aabb::new([left - more], [left + 1.0 + more])
        };
        let all: Vec<_> = (0..2_000).map(|at| boxed(at, 0.0)).collect();
        let mut world = BroadPhase::<1>::new();
        world.insert_many(&all, Filter::default()).unwrap();
        world.update();
        let BroadPhase { bodies, tracking, .. } = &mut world;
        tracking.fat = (0..2_000).map(|at| boxed(at, 0.2)).collect();
        let mut begun = Vec::new();
        assert!(tracking.find_candidates(bodies, true, &mut begun).is_ok_and(|is_fat| is_fat));
        assert_eq!((tracking.candidates.len(), begun.capacity()), (1_000, 0));
    }

    #[test]
    fn a_sample_in_one_column_has_too_many_candidates_though_they_fit_a_buffer() {
        let boxed = |at: usize, more: f32| {
            Aabb::new([2.0 * at as f32 - more], [2.0 * at as f32 + 1.0 + more])
        };
        let fat_by = |more| (0..8_000).map(|at| boxed(at, more)).collect::<Vec<_>>();
        let mut world = BroadPhase::<1>::new();
        world.insert_many(&fat_by(0.0), Filter::default()).unwrap();
        world.update();
        let BroadPhase { bodies, tracking, .. } = &mut world;
        let Tracking { finder, policy, .. } = tracking;
        // Buffers of an earlier search.
        assert!(finder.find(&fat_by(5.0), bodies, [!0, 0], When::Now, usize::MAX).is_ok());
        for (more, expected) in [(0.2, false), (5.0, true)] {
            let is_excess = have_too_many(&fat_by(more), finder, policy, bodies);
            assert_eq!(is_excess.ok(), Some(expected), "{more}");
        }
    }
}
