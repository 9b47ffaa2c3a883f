//! Takes an update back that had not enough memory for the pairs that it found.
//!
//! Whatever grows with the pairs that an update finds is reserved before anything is changed that cannot be taken back. What
//! grows with the bodies is not, nor what a few of the pairs of the last update take: without memory for that the program ends.

use super::give_back::free_buffers;
use crate::Scalar;
use crate::world::bodies::{Bodies, flag};
use crate::world::changes::Events;
use crate::world::tracking::Tracking;

/// Makes the next update find what this one should have, by what does not allocate: only the pairs of the last update are kept
/// as candidates, and the boxes of then as fat AABBs.
#[inline(never)]
pub fn take_back<const D: usize, T: Scalar>(
    bodies: &mut Bodies<D, T>,
    tracking: &mut Tracking<D, T>,
    events: &mut Events,
) {
    free_buffers(tracking, events, 0);
    for &index in bodies.edits.changed() {
        if bodies.slots.has(index, flag::LIVE) {
            bodies.slots.raise(index, flag::CHANGED);
        }
    }
    tracking.land_all(bodies);
    tracking.candidates.keep_live();
    tracking.is_fat_stale = true;
    tracking.tree.abandon();
}
