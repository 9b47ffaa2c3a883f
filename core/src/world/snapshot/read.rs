//! Reads snapshots: any bytes give a world or an error.

use alloc::vec::Vec;

use super::format::{SnapshotInfo, filter as bits, holds, read_header, world};
use super::hash::hash;
use crate::world::bodies::{BEFORE, Bodies, Filter, NOW, Rules, Slots, flag};
use crate::world::options::{Options, Report};
use crate::{Aabb, Scalar, SnapshotFault};

/// The bodies of a snapshot.
pub fn read<const D: usize, T: Scalar>(bytes: &[u8]) -> Result<Bodies<D, T>, SnapshotFault> {
    let (SnapshotInfo { dimensions, scalar_bytes }, held, body) = read_header(bytes)?;
    if (dimensions, scalar_bytes) != (D, T::BYTES) {
        return Err(SnapshotFault::OtherWorld { dimensions, scalar_bytes });
    }
    let mut reader = Reader { bytes: body };
    let mut bodies = Bodies::<D, T>::default();
    if held > world::FAT | world::EXCLUSIONS {
        return Err(SnapshotFault::Corrupt);
    }
    if held & world::FAT != 0 {
        let (margin, prediction) = (reader.scalar()?, reader.scalar()?);
        bodies.options = Options::default().report(Report::Fat { margin, prediction });
        bodies.options.check().map_err(|_| SnapshotFault::Corrupt)?;
        bodies.displacements.put_shift(reader.corner()?);
    }
    let count = u32::try_from(reader.number()?).map_err(|_| SnapshotFault::Corrupt)?;
    for _ in 0..count {
        read_slot(&mut reader, &mut bodies)?;
    }
    if held & world::EXCLUSIONS != 0 {
        let Bodies { slots, rules, .. } = &mut bodies;
        for index in read_exclusions(&mut reader, slots, rules)? {
            if bodies.slots.has(index, flag::LIVE) {
                bodies.touch(index);
            }
        }
    }
    let sum = hash(&bytes[..bytes.len() - reader.bytes.len()]);
    if reader.take()? != sum.to_le_bytes() || !reader.bytes.is_empty() {
        return Err(SnapshotFault::Corrupt);
    }
    Ok(bodies)
}

/// Reads one slot.
fn read_slot<const D: usize, T: Scalar>(
    reader: &mut Reader<'_>,
    bodies: &mut Bodies<D, T>,
) -> Result<(), SnapshotFault> {
    let [held] = reader.take()?;
    let has = |bits: u8| held & bits != 0;
    let generation = u32::try_from(reader.number()?).map_err(|_| SnapshotFault::Corrupt)?;
    let is_live = has(holds::BODY);
    let is_known = (is_live || has(holds::LEAVING)) && !has(holds::NEW);
    let is_absurd = generation == 0
        || has(holds::ORIGIN) && !(is_live && is_known && bodies.options.report.is_fat())
        || is_live && has(holds::LEAVING)
        || !is_live && (has(holds::SWEEP | holds::OLD_FILTER) || has(holds::OLD_BOX) != is_known)
        || !is_live && !is_known && has(holds::FILTER)
        || !is_known && has(holds::OLD_BOX | holds::OLD_FILTER)
        || has(holds::NEW) && !is_live && !has(holds::LEAVING);
    if is_absurd {
        return Err(SnapshotFault::Corrupt);
    }
    let nothing = Aabb::new([T::default(); D], [T::default(); D]);
    let (mut shape, mut boxed, mut origin) = (nothing, nothing, nothing);
    let index = bodies.slots.add(generation);
    if is_live {
        bodies.slots.activate(index);
        shape = reader.aabb()?;
        boxed = if bodies.options.report.is_fat() { reader.aabb()? } else { shape };
        if !boxed.contains(&shape) {
            return Err(SnapshotFault::Corrupt);
        }
        if has(holds::ORIGIN) {
            origin = reader.aabb()?;
        }
        if has(holds::SWEEP) {
            let to = reader.aabb()?;
            bodies.sweeps.add(&mut bodies.slots, index, to);
        }
    } else if has(holds::LEAVING) {
        bodies.slots.raise(index, flag::LEAVING);
        bodies.edits.note_leaving(index);
    } else {
        bodies.slots.release(index, 0);
    }
    let filter = if has(holds::FILTER) { reader.filter()? } else { Filter::default() };
    let old_box = if has(holds::OLD_BOX) { reader.aabb()? } else { boxed };
    bodies.put(index, shape, boxed, filter);
    bodies.boxes.put_previous(index, old_box);
    if has(holds::ORIGIN) {
        bodies.displacements.put_origin(&mut bodies.slots, index, origin);
    }
    if has(holds::NEW) {
        bodies.edits.note_new(&mut bodies.slots, index);
    }
    if has(holds::OLD_FILTER) {
        let old = reader.filter()?;
        bodies.rules.keep_old(&mut bodies.slots, index, old);
    }
    if is_live && has(holds::NEW | holds::OLD_BOX | holds::OLD_FILTER) {
        bodies.touch(index);
    }
    if is_live && bodies.options.report.is_fat() && bodies.is_too_wide(index) {
        if has(holds::NEW) {
            return Err(SnapshotFault::Corrupt);
        }
        bodies.displacements.note_too_wide(index);
    }
    Ok(())
}

/// Reads the excluded pairs, which are sorted, at least one. Returns the bodies whose pairs have to be looked at again.
#[inline(never)]
fn read_exclusions(
    reader: &mut Reader<'_>,
    slots: &mut Slots,
    rules: &mut Rules,
) -> Result<Vec<u32>, SnapshotFault> {
    let mut last = 0;
    let mut edited = Vec::new();
    for _ in 0..reader.number()? {
        let [a, b] = [reader.number()?, reader.number()?];
        let [when] = reader.take()?;
        let is_sound = a < b && b < slots.len() as u64 && (NOW..=NOW | BEFORE).contains(&when);
        let pair = [a, b].map(|slot| slot as u32);
        if !is_sound || a << 32 | b <= last || !rules.restore_exclusion(slots, pair, when) {
            return Err(SnapshotFault::Corrupt);
        }
        last = a << 32 | b;
        if when != NOW | BEFORE {
            edited.extend(pair);
        }
    }
    if last == 0 { Err(SnapshotFault::Corrupt) } else { Ok(edited) }
}

/// Takes bytes from the front, as long as there are any.
struct Reader<'a> {
    bytes: &'a [u8],
}

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], SnapshotFault> {
        let (taken, rest) = self.bytes.split_first_chunk().ok_or(SnapshotFault::Truncated)?;
        self.bytes = rest;
        Ok(*taken)
    }

    #[inline(never)]
    fn number(&mut self) -> Result<u64, SnapshotFault> {
        let mut number = 0;
        for shift in (0..64).step_by(7) {
            let [byte] = self.take()?;
            let bits = u64::from(byte & 0x7f);
            if bits << shift >> shift != bits {
                return Err(SnapshotFault::Corrupt);
            }
            number |= bits << shift;
            if byte < 0x80 {
                return Ok(number);
            }
        }
        Err(SnapshotFault::Corrupt)
    }

    fn scalar<T: Scalar>(&mut self) -> Result<T, SnapshotFault> {
        let mut word = [0; 8];
        for byte in &mut word[..T::BYTES] {
            [*byte] = self.take()?;
        }
        Ok(T::from_raw(u64::from_le_bytes(word)))
    }

    fn corner<const D: usize, T: Scalar>(&mut self) -> Result<[T; D], SnapshotFault> {
        let mut corner = [T::default(); D];
        for at in &mut corner {
            *at = self.scalar()?;
        }
        Ok(corner)
    }

    fn aabb<const D: usize, T: Scalar>(&mut self) -> Result<Aabb<D, T>, SnapshotFault> {
        let aabb = Aabb::new(self.corner()?, self.corner()?);
        aabb.check(0).map_err(|_| SnapshotFault::Corrupt)?;
        Ok(aabb)
    }

    #[inline(never)]
    fn filter(&mut self) -> Result<Filter, SnapshotFault> {
        let mut word = || Ok(u32::from_le_bytes(self.take()?));
        let (category, mask, group) = (word()?, word()?, word()? as i32);
        match self.take()? {
            [held] if held <= bits::STATIC | bits::DISABLED => {
                let is_static = held & bits::STATIC != 0;
                let is_enabled = held & bits::DISABLED == 0;
                Ok(Filter { category, mask, group, is_static, is_enabled })
            }
            _ => Err(SnapshotFault::Corrupt),
        }
    }
}
