//! Gives back the memory of a crowd that is gone.
//!
//! A list keeps its memory from update to update, so that steady motion does not allocate. Once in 64 updates a list is
//! shrunk that has capacity for more than four times as many pairs as there were bodies and pairs since then.

use alloc::vec::Vec;

use crate::Scalar;
use crate::world::bodies::Bodies;
use crate::world::candidates::PairSorter;
use crate::world::changes::Events;
use crate::world::tracking::{Scratch, Tracking};

/// Notes what the last update needed, before its events are cleared, and gives back what is far more than that.
#[inline(never)]
pub fn note_usage<const D: usize, T: Scalar>(
    bodies: &Bodies<D, T>,
    tracking: &mut Tracking<D, T>,
    events: &mut Events,
) {
    let listed = tracking.candidates.len() + events.begun.len() + events.ended.len();
    let enough = tracking.usage.note(bodies.slots.len(), listed.max(tracking.finder.found));
    if let Some(enough) = enough {
        give_back(tracking, events, enough);
    }
}

/// Frees each buffer that has capacity for more than this many pairs, and shrinks such lists to what they hold.
fn give_back<const D: usize, T: Scalar>(
    tracking: &mut Tracking<D, T>,
    events: &mut Events,
    enough: usize,
) {
    tracking.sorted.give_back();
    tracking.candidates.shrink(enough);
    free_buffers(tracking, events, enough);
}

/// Frees each buffer that has capacity for more than this many pairs. Events of the last update are of no use any more.
#[inline(never)]
pub fn free_buffers<const D: usize, T: Scalar>(
    tracking: &mut Tracking<D, T>,
    events: &mut Events,
    enough: usize,
) {
    let Tracking { finder, scratch, .. } = tracking;
    let Scratch { sorter, sorted, leaves, found, dropped, added, .. } = scratch;
    let PairSorter { buffer, unsorted, .. } = sorter;
    let Events { begun, ended, .. } = events;
    for buffer in [sorted, leaves, found, buffer, unsorted, begun, ended] {
        free(buffer, enough);
    }
    free(added, enough);
    free(dropped, enough);
    if finder.capacity() > enough {
        finder.forget();
    }
}

/// Frees a buffer that has capacity for more than this many items.
#[inline(never)]
fn free<T>(buffer: &mut Vec<T>, enough: usize) {
    if buffer.capacity() > enough {
        *buffer = Vec::new();
    }
}
