//! Gives back the memory of a crowd that is gone.
//!
//! A list keeps its memory from update to update, so that steady motion does not allocate. Once in 64 updates a list is
//! shrunk that has room for more than four times as many pairs as there were bodies and pairs since then.

use alloc::vec::Vec;

use crate::Scalar;
use crate::world::bodies::Bodies;
use crate::world::candidates::{Candidates, PairSorter};
use crate::world::changes::Events;
use crate::world::finder::Finder;
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

/// Shrinks each list that has room for more than so many pairs to half as many, or to what it holds.
fn give_back<const D: usize, T: Scalar>(
    tracking: &mut Tracking<D, T>,
    events: &mut Events,
    enough: usize,
) {
    let Tracking { candidates, finder, scratch, .. } = tracking;
    let Candidates { pairs, live, asleep, sorted, .. } = candidates;
    let Scratch { sorter, before, positions, dropped, added, leaves, found, .. } = scratch;
    let PairSorter { buffer, unsorted, .. } = sorter;
    let Events { begun, ended, .. } = events;
    // What these hold between updates is of no use.
    for list in [&mut *before, buffer, unsorted, leaves, found] {
        list.clear();
    }
    for list in [pairs, asleep, sorted, before, buffer, unsorted, leaves, found, begun, ended] {
        shrink(list, enough);
    }
    shrink(live, enough);
    for list in [positions, dropped] {
        list.clear();
        shrink(list, enough);
    }
    added.clear();
    shrink(added, enough);
    if finder.most_found > enough {
        *finder = Finder::clone(finder);
    }
}

fn shrink<V>(list: &mut Vec<V>, enough: usize) {
    if list.capacity() > enough {
        list.shrink_to(enough / 2);
    }
}
