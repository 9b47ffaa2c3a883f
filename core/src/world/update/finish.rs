//! The end of an update: the world of now becomes that of the last update, and resting bodies fall
//! asleep.

use crate::Scalar;
use crate::world::bodies::{Bodies, ProxyId, flag};
use crate::world::changes::Events;
use crate::world::tracking::Tracking;

/// A body with one of these flags does not fall asleep. One that flies is not in the tree, which is to find the pairs of
/// bodies asleep when they wake.
const AWAKE: u16 = flag::RECENT | flag::ASLEEP | flag::FLYING;

/// Ends an update; where a level is new, its static bodies fall asleep at once. Returns whether the awake bodies are
/// scattered in memory.
#[inline(never)]
pub fn finish<const D: usize, T: Scalar>(
    bodies: &mut Bodies<D, T>,
    tracking: &mut Tracking<D, T>,
    events: &mut Events,
    is_level_new: bool,
) -> bool {
    // Boxes of bodies that did not change are the same or meaningless.
    let read = bodies.rows_to_scan(bodies.edits.changed().len());
    let Bodies { boxes, edits, .. } = bodies;
    let read = if edits.take_unlisted() { boxes.len() } else { read };
    boxes.end_update(read, edits.changed());
    if bodies.rules.finish() | bodies.edits.any_new() {
        for &index in bodies.edits.changed() {
            let rests = is_level_new && bodies.is_static(index);
            let recent = if rests { flag::RECENT } else { 0 };
            bodies.slots.lower(index, flag::NEW | flag::REFILTERED | recent);
        }
    }
    let moved = bodies.edits.changed().len();
    bodies.edits.forget_changed();
    tracking.tree.forget_changes();
    // After an update from scratch no body falls asleep.
    let is_scattered =
        !tracking.candidates.is_sorted() && tracking.fall_asleep(bodies, moved, is_level_new);
    let removed = bodies.edits.leaving().iter().map(|&index| bodies.slots.id(index).to_key());
    let sorted = tracking.scratch.sorter.sort_keys(removed);
    events.removed.clear();
    events.removed.extend(sorted.map(ProxyId::from_key));
    let exclude =
        bodies.edits.leaving().iter().any(|&index| bodies.slots.has(index, flag::EXCLUDES));
    bodies.edits.release_leaving(&mut bodies.slots);
    if exclude {
        bodies.rules.forget_gone(&bodies.slots);
    }
    bodies.reset_origins();
    bodies.settle();
    is_scattered
}

impl<const D: usize, T: Scalar> Tracking<D, T> {
    /// Lets bodies that rested for long fall asleep, if it is time or `is_forced`, after an update in which `moved`
    /// bodies moved. Returns whether the awake bodies are scattered in memory.
    #[inline(never)]
    fn fall_asleep(&mut self, bodies: &mut Bodies<D, T>, moved: usize, is_forced: bool) -> bool {
        let Self { sleep, candidates, fat, .. } = self;
        let Bodies { slots, boxes, front, .. } = bodies;
        let awake = slots.live - sleep.count;
        let is_time = moved > 0 && sleep.note(awake, moved, candidates.asleep());
        if !is_time && !is_forced {
            return false;
        }
        candidates.forget_awake(slots);
        if candidates.reserve_asleep(slots, AWAKE).is_err() {
            return false;
        }
        for (row, flags) in slots.flags.iter_mut().enumerate() {
            let rests = *flags & (flag::LIVE | AWAKE) == flag::LIVE;
            if rests {
                *flags |= flag::ASLEEP;
                fat[row] = boxes.now()[row];
                sleep.count += 1;
            }
            *flags &= !flag::RECENT;
        }
        candidates
            .put_to_sleep(slots, |[a, b]| fat[a as usize].overlaps_branch_free(&fat[b as usize]));
        sleep.scatters(slots.live - sleep.count, *front, slots.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Aabb, BroadPhase, Filter};

    #[test]
    fn a_body_that_flies_does_not_fall_asleep() {
        let mut world = BroadPhase::<1>::new();
        world.insert_many(&[Aabb::new([0.0], [1.0]); 4], Filter::default()).unwrap();
        world.update();
        let (bodies, tracking) = (&mut world.bodies, &mut world.tracking);
        bodies.slots.raise(0, flag::FLYING);
        for _ in 0..100 {
            tracking.fall_asleep(bodies, 1, false);
        }
        assert!(bodies.slots.has(1, flag::ASLEEP) && !bodies.slots.has(0, flag::ASLEEP));
    }
}
