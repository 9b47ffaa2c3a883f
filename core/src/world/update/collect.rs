//! What changed since the last update, and which bodies left their fat AABBs.

use alloc::vec::Vec;

use crate::Scalar;
use crate::memory::preload;
use crate::world::bodies::{Bodies, differ, flag};
use crate::world::tracking::{Scratch, Tracking};

/// How many bodies are compared at a time.
const CHUNK: usize = 64;
/// A changed body with one of these flags needs a new fat AABB in any case.
const ESCAPES: u16 = flag::NEW | flag::REFILTERED | flag::ASLEEP;
/// The flags that an update keeps.
const KEPT: u16 = !(flag::CHANGED | flag::IN_TREE);

/// Lists the bodies that need a new fat AABB: those that left theirs, are new, or have another filter.
/// Leaves each living changed body in the list of changes once.
#[inline(never)]
pub fn collect_escaped<const D: usize, T: Scalar>(
    bodies: &mut Bodies<D, T>,
    tracking: &mut Tracking<D, T>,
) {
    tracking.refresh_fat(bodies);
    let Tracking { fat, scratch: Scratch { escaped, .. }, .. } = tracking;
    escaped.clear();
    let read = bodies.rows_to_scan(bodies.edits.changed().len());
    let scans_all = bodies.scans_all(bodies.edits.changed().len());
    let Bodies { slots, boxes, edits, .. } = bodies;
    let (boxes, previous) = (boxes.now(), boxes.previous());
    let scans_all = edits.take_unlisted() || scans_all;
    let changed = edits.changed_mut();
    if scans_all {
        changed.clear();
        for start in (0..slots.len()).step_by(CHUNK) {
            let rows = start..slots.len().min(start + CHUNK);
            let (flags, boxes) = (&mut slots.flags[rows.clone()], &boxes[rows.clone()]);
            let (mut is_changed, mut is_escaped) = ([0; CHUNK], [0; CHUNK]);
            for (is_changed, (aabb, before)) in
                is_changed.iter_mut().zip(boxes.iter().zip(&previous[rows.clone()]))
            {
                *is_changed = u16::from(differ(aabb, before));
            }
            for (is_escaped, (aabb, fat)) in
                is_escaped.iter_mut().zip(boxes.iter().zip(&fat[rows.clone()]))
            {
                *is_escaped = u16::from(!fat.contains(aabb));
            }
            list_chunk(start, flags, &mut is_changed, &mut is_escaped, [changed, escaped]);
        }
        return;
    }
    preload(&boxes[..read]);
    preload(&fat[..read]);
    changed.retain(|&index| {
        let row = index as usize;
        let flags = slots.flags[row];
        slots.flags[row] = flags & KEPT | flag::RECENT;
        let is_first = flags & (flag::CHANGED | flag::LIVE) == flag::CHANGED | flag::LIVE;
        if is_first && (flags & ESCAPES != 0 || !fat[row].contains(&boxes[row])) {
            escaped.push(index);
        }
        is_first
    });
}

/// Lists the changed and the escaped bodies of a chunk, given which boxes differ from those of the last
/// update, and which are not within their fat AABBs.
#[inline(never)]
fn list_chunk(
    start: usize,
    flags: &mut [u16],
    changed: &mut [u16; CHUNK],
    escaped: &mut [u16; CHUNK],
    lists: [&mut Vec<u32>; 2],
) {
    let (mut changes, mut escapes) = (0, 0);
    for (flags, (changed, escaped)) in flags.iter_mut().zip(changed.iter_mut().zip(&mut *escaped)) {
        let is = |flag| u16::from(*flags & flag != 0);
        let any = *changed | is(flag::CHANGED);
        *changed = any & is(flag::LIVE);
        *escaped = *changed & (*escaped | is(ESCAPES));
        *flags = *flags & KEPT | (any * flag::RECENT);
        changes += *changed;
        escapes += *escaped;
    }
    let start = start as u32;
    let [all_changed, all_escaped] = lists;
    for (list, count, is_in) in [(all_changed, changes, changed), (all_escaped, escapes, escaped)] {
        if usize::from(count) == flags.len() {
            list.extend(start..start + u32::from(count));
        } else if count > 0 {
            let indices = (start..).zip(&is_in[..flags.len()]);
            list.extend(indices.filter(|(_, is_in)| **is_in != 0).map(|(index, _)| index));
        }
    }
}
