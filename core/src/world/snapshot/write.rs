//! Writes snapshots.

use alloc::vec::Vec;

use super::format::{MAGIC, VERSION, filter as bits, holds, world};
use super::hash::hash;
use crate::world::bodies::{Bodies, Filter, When, differ, flag};
use crate::world::options::Report;
use crate::{Aabb, Scalar};

/// Writes the snapshot of a world to bytes, of which there are none.
pub fn write<const D: usize, T: Scalar>(bodies: &Bodies<D, T>, bytes: &mut Vec<u8>) {
    let report = bodies.options.report;
    let boxes = 1 + usize::from(report.is_fat());
    bytes.reserve_exact(64 + bodies.slots.len() * (boxes * 2 * D * T::BYTES + 2));
    bytes.extend(MAGIC);
    let excluded = bodies.rules.excluded(&bodies.slots);
    let held = bit(report.is_fat(), world::FAT) | bit(!excluded.is_empty(), world::EXCLUSIONS);
    bytes.extend([VERSION, D as u8, T::BYTES as u8, held]);
    if let Report::Fat { margin, prediction } = report {
        put_scalars(bytes, &[margin, prediction]);
        put_scalars(bytes, &bodies.displacements.shifted().unwrap_or([T::default(); D]));
    }
    put_number(bytes, bodies.slots.len() as u64);
    for &index in &bodies.slots.index_of {
        put_slot(bytes, bodies, index);
    }
    finish(bytes, &excluded);
}

/// Writes the excluded pairs, if there are any, and the hash.
#[inline(never)]
fn finish(bytes: &mut Vec<u8>, excluded: &[([u32; 2], u8)]) {
    if !excluded.is_empty() {
        put_number(bytes, excluded.len() as u64);
        for (pair, when) in excluded {
            pair.iter().for_each(|&slot| put_number(bytes, u64::from(slot)));
            bytes.push(*when);
        }
    }
    let sum = hash(bytes);
    bytes.extend(sum.to_le_bytes());
}

fn put_slot<const D: usize, T: Scalar>(bytes: &mut Vec<u8>, bodies: &Bodies<D, T>, index: u32) {
    let row = index as usize;
    let flags = bodies.slots.flags[row];
    let is_known = flags & (flag::LIVE | flag::LEAVING) != 0 && flags & flag::NEW == 0;
    let old_box = Some(&bodies.boxes.previous()[row]).filter(|_| is_known);
    let old_filter =
        Some(bodies.rules.filter(&bodies.slots, index, When::LastUpdate)).filter(|_| is_known);
    // A body that left is only what it was at the last update.
    let is_live = flags & flag::LIVE != 0;
    let (filter, old_box, old_filter) = if is_live {
        let filter = bodies.rules.filter_now(index);
        let old_box = old_box.filter(|&old| differ(old, &bodies.boxes.now()[row]));
        (Some(filter), old_box, old_filter.filter(|&old| old != filter))
    } else {
        (old_filter, old_box, None)
    };
    let filter = filter.filter(|&filter| *filter != Filter::default());
    let origin = bodies
        .displacements
        .origins()
        .get(row)
        .filter(|&origin| is_live && is_known && differ(origin, bodies.shape(index)));
    bytes.push(
        bit(is_live, holds::BODY)
            | bit(flags & flag::LEAVING != 0, holds::LEAVING)
            | bit(flags & flag::NEW != 0, holds::NEW)
            | bit(flags & flag::SWEPT != 0, holds::SWEEP)
            | bit(filter.is_some(), holds::FILTER)
            | bit(old_box.is_some(), holds::OLD_BOX)
            | bit(old_filter.is_some(), holds::OLD_FILTER)
            | bit(origin.is_some(), holds::ORIGIN),
    );
    put_number(bytes, u64::from(bodies.slots.id(index).generation()));
    if is_live {
        put_box(bytes, bodies.shape(index));
        if bodies.options.report.is_fat() {
            put_box(bytes, &bodies.boxes.now()[row]);
        }
        origin.into_iter().for_each(|origin| put_box(bytes, origin));
        let end = bodies.sweeps.end(index).filter(|_| flags & flag::SWEPT != 0);
        end.into_iter().for_each(|end| put_box(bytes, end));
    }
    filter.into_iter().for_each(|filter| put_filter(bytes, filter));
    old_box.into_iter().for_each(|aabb| put_box(bytes, aabb));
    old_filter.into_iter().for_each(|filter| put_filter(bytes, filter));
}

/// A bit of a byte, or 0.
const fn bit(is_set: bool, bit: u8) -> u8 {
    if is_set { bit } else { 0 }
}

#[inline(never)]
fn put_number(bytes: &mut Vec<u8>, mut number: u64) {
    while number >= 0x80 {
        bytes.push(number as u8 | 0x80);
        number >>= 7;
    }
    bytes.push(number as u8);
}

fn put_scalars<T: Scalar>(bytes: &mut Vec<u8>, scalars: &[T]) {
    for at in scalars {
        bytes.extend_from_slice(&at.to_raw().to_le_bytes()[..T::BYTES]);
    }
}

fn put_box<const D: usize, T: Scalar>(bytes: &mut Vec<u8>, aabb: &Aabb<D, T>) {
    put_scalars(bytes, &aabb.min);
    put_scalars(bytes, &aabb.max);
}

#[inline(never)]
fn put_filter(bytes: &mut Vec<u8>, filter: &Filter) {
    for word in [filter.category, filter.mask, filter.group as u32] {
        bytes.extend(word.to_le_bytes());
    }
    bytes.push(bit(filter.is_static, bits::STATIC) | bit(!filter.is_enabled, bits::DISABLED));
}
