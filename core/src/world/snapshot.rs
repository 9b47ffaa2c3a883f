//! Snapshots: the whole state as bytes, for rollback, replay and saved games.
//!
//! ```text
//! "SaPw"  version u8  dimensions u8  scalar bytes u8  report u8   margin  prediction
//! count of slots, then of each slot
//!     what it holds, bits of u8; generation
//!     its box [its fat box, if these are reported]       of a living body
//!     [where its sweep ends]                             of a swept one
//!     [its filter]                                       if not the default
//!     [its box at the last update]                       if another
//!     [its filter at the last update]                    if another
//! hash of all this, u64
//! ```
//! Counts and generations are LEB128, all else is little-endian. Live pairs need not be written:
//! they are those of the boxes and filters of the last update. Equal states give equal bytes.

use alloc::vec::Vec;

use super::edit::check_box;
use super::hash::hash;
use super::options::{Options, Report, contains};
use super::proxy::flag;
use super::{BroadPhase, Filter};
use crate::{Aabb, Error, Scalar, SnapshotFault};

const MAGIC: [u8; 4] = *b"SaPw";
const VERSION: u8 = 1;
const HEADER: usize = 8;

/// What a slot holds.
mod holds {
    /// A living body.
    pub const BODY: u8 = 1;
    /// A body that was removed since the last update.
    pub const LEAVING: u8 = 2;
    /// Its body came since the last update.
    pub const NEW: u8 = 4;
    pub const SWEEP: u8 = 8;
    pub const FILTER: u8 = 16;
    pub const OLD_BOX: u8 = 32;
    pub const OLD_FILTER: u8 = 64;
}

impl<const D: usize, T: Scalar> BroadPhase<D, T> {
    /// The whole state as bytes. A world [restored](Self::from_snapshot) from them gives, for the
    /// same calls, the same ids, events and results, bit for bit.
    ///
    /// O(n) time; about `2 * D * size_of::<T>() + 2` bytes for each body at rest.
    pub fn snapshot(&self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(64 + self.slots.len() * (2 * D * T::BYTES + 2));
        bytes.extend(MAGIC);
        bytes.extend([VERSION, D as u8, T::BYTES as u8, self.options.report as u8]);
        put_scalars(&mut bytes, &[self.options.margin, self.options.prediction]);
        put_number(&mut bytes, self.slots.len() as u64);
        for &seat in &self.slots.seats {
            self.put_slot(&mut bytes, seat);
        }
        let sum = hash(&bytes);
        bytes.extend(sum.to_le_bytes());
        bytes
    }

    fn put_slot(&self, bytes: &mut Vec<u8>, seat: u32) {
        let at = seat as usize;
        let flags = self.slots.flags[at];
        let is_known = flags & (flag::LIVE | flag::LEAVING) != 0 && flags & flag::NEW == 0;
        let old_box = Some(&self.updater.previous[at]).filter(|_| is_known);
        let old_filter = Some(self.old_filter(seat)).filter(|_| is_known);
        // A body that left is only what it was at the last update.
        let is_live = flags & flag::LIVE != 0;
        let (filter, old_box, old_filter) = if is_live {
            let filter = &self.filters[at];
            let old_box = old_box.filter(|&old| *old != self.boxes[at]);
            (Some(filter), old_box, old_filter.filter(|&old| old != filter))
        } else {
            (old_filter, old_box, None)
        };
        let filter = filter.filter(|&filter| *filter != Filter::default());
        let bit = |is_set, bit| if is_set { bit } else { 0 };
        bytes.push(
            bit(is_live, holds::BODY)
                | bit(flags & flag::LEAVING != 0, holds::LEAVING)
                | bit(flags & flag::NEW != 0, holds::NEW)
                | bit(flags & flag::SWEPT != 0, holds::SWEEP)
                | bit(filter.is_some(), holds::FILTER)
                | bit(old_box.is_some(), holds::OLD_BOX)
                | bit(old_filter.is_some(), holds::OLD_FILTER),
        );
        put_number(bytes, u64::from(self.slots.id(seat).generation()));
        if is_live {
            put_box(bytes, self.shape(seat));
            if self.options.report == Report::Fat {
                put_box(bytes, &self.boxes[at]);
            }
            if flags & flag::SWEPT != 0 {
                put_box(bytes, &self.rests[at]);
            }
        }
        filter.into_iter().for_each(|filter| put_filter(bytes, filter));
        old_box.into_iter().for_each(|aabb| put_box(bytes, aabb));
        old_filter.into_iter().for_each(|filter| put_filter(bytes, filter));
    }

    /// The world of a snapshot.
    ///
    /// # Errors
    /// [`Error::InvalidSnapshot`] for bytes that are truncated, changed, of another version, of a
    /// world with other dimensions or coordinates, or no snapshot at all.
    ///
    /// Takes the time of finding all pairs, and memory in proportion to the bytes and the pairs.
    pub fn from_snapshot(bytes: &[u8]) -> Result<Self, Error> {
        read(bytes).map_err(Error::InvalidSnapshot)
    }

    /// Reads the next slot into a world that holds those before it.
    fn read_slot(&mut self, reader: &mut Reader) -> Result<(), SnapshotFault> {
        let [held] = reader.take()?;
        let has = |bits: u8| held & bits != 0;
        let generation = u32::try_from(reader.number()?).map_err(|_| SnapshotFault::Corrupt)?;
        let is_live = has(holds::BODY);
        let is_known = (is_live || has(holds::LEAVING)) && !has(holds::NEW);
        let is_absurd = generation == 0
            || held & 128 != 0
            || is_live && has(holds::LEAVING)
            || !is_live
                && (has(holds::SWEEP | holds::OLD_FILTER) || has(holds::OLD_BOX) != is_known)
            || !is_live && !is_known && has(holds::FILTER)
            || !is_known && has(holds::OLD_BOX | holds::OLD_FILTER)
            || has(holds::NEW) && !is_live && !has(holds::LEAVING);
        if is_absurd {
            return Err(SnapshotFault::Corrupt);
        }
        let nothing = Aabb::new([T::default(); D], [T::default(); D]);
        let (mut shape, mut boxed) = (nothing, nothing);
        let seat = self.slots.add(generation);
        if is_live {
            self.slots.enliven(seat);
            shape = reader.aabb()?;
            boxed = if self.options.report == Report::Fat { reader.aabb()? } else { shape };
            if !contains(&boxed, &shape) {
                return Err(SnapshotFault::Corrupt);
            }
            if has(holds::SWEEP) {
                let to = reader.aabb()?;
                self.sweep_to(seat, to);
            }
        } else if has(holds::LEAVING) {
            self.slots.raise(seat, flag::LEAVING);
            self.leaving.push(seat);
        } else {
            self.slots.release(seat);
        }
        let filter = if has(holds::FILTER) { reader.filter()? } else { Filter::default() };
        let old_box = if has(holds::OLD_BOX) { reader.aabb()? } else { boxed };
        self.boxes.push(boxed);
        self.filters.push(filter);
        self.any_filter |= filter != Filter::default();
        if self.options.report == Report::Fat {
            self.shapes.push(shape);
        }
        self.updater.add_seat(old_box);
        if has(holds::NEW) {
            self.slots.raise(seat, flag::NEW);
            self.updater.any_new = true;
        }
        if has(holds::OLD_FILTER) {
            let old = reader.filter()?;
            self.note_old_filter(seat, old);
        }
        if is_live && has(holds::NEW | holds::OLD_BOX | holds::OLD_FILTER) {
            self.touch(seat);
        }
        Ok(())
    }
}

/// What kind of world a snapshot holds: which [`BroadPhase`] can be restored from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct SnapshotInfo {
    /// The dimensions of its boxes: 1 to 3 in every snapshot that a world wrote.
    pub dimensions: usize,
    /// The size of its coordinates in bytes: 4 for `f32`, 8 for `f64`.
    pub scalar_bytes: usize,
}

impl SnapshotInfo {
    /// Reads the header of a snapshot, and nothing else: the rest may still be damaged.
    ///
    /// # Errors
    /// [`Error::InvalidSnapshot`] if the bytes do not begin as a snapshot does, are of another
    /// version, or end within the header.
    pub fn read(bytes: &[u8]) -> Result<Self, Error> {
        read_header(bytes).map(|(info, ..)| info).map_err(Error::InvalidSnapshot)
    }
}

/// The kind of world, the byte that says what is reported, and what follows the header.
fn read_header(bytes: &[u8]) -> Result<(SnapshotInfo, u8, &[u8]), SnapshotFault> {
    let known = MAGIC.len().min(bytes.len());
    if bytes[..known] != MAGIC[..known] {
        return Err(SnapshotFault::Foreign);
    }
    let Some((&[_, _, _, _, version, dimensions, scalar_bytes, report], body)) =
        bytes.split_first_chunk::<HEADER>()
    else {
        return Err(SnapshotFault::Truncated);
    };
    if version != VERSION {
        return Err(SnapshotFault::Version { found: version });
    }
    let (dimensions, scalar_bytes) = (usize::from(dimensions), usize::from(scalar_bytes));
    Ok((SnapshotInfo { dimensions, scalar_bytes }, report, body))
}

fn read<const D: usize, T: Scalar>(bytes: &[u8]) -> Result<BroadPhase<D, T>, SnapshotFault> {
    let (SnapshotInfo { dimensions, scalar_bytes }, report, body) = read_header(bytes)?;
    if (dimensions, scalar_bytes) != (D, T::BYTES) {
        return Err(SnapshotFault::OtherWorld { dimensions, scalar_bytes });
    }
    let mut reader = Reader { bytes: body };
    let (margin, prediction) = (reader.scalar()?, reader.scalar()?);
    let report = match report {
        0 => Report::Exact,
        1 => Report::Fat,
        _ => return Err(SnapshotFault::Corrupt),
    };
    let options = Options { margin, prediction, report };
    let mut world = BroadPhase::with_options(options).map_err(|_| SnapshotFault::Corrupt)?;
    let count = reader.number()?;
    let count = u32::try_from(count).map_err(|_| SnapshotFault::Corrupt)?;
    for _ in 0..count {
        world.read_slot(&mut reader)?;
    }
    let sum = hash(&bytes[..bytes.len() - reader.bytes.len()]);
    if reader.take()? != sum.to_le_bytes() || !reader.bytes.is_empty() {
        return Err(SnapshotFault::Corrupt);
    }
    world.restore_candidates();
    Ok(world)
}

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

fn put_filter(bytes: &mut Vec<u8>, filter: &Filter) {
    for word in [filter.category, filter.mask, filter.group as u32] {
        bytes.extend(word.to_le_bytes());
    }
    bytes.push(u8::from(filter.is_static));
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

    fn aabb<const D: usize, T: Scalar>(&mut self) -> Result<Aabb<D, T>, SnapshotFault> {
        let mut aabb = Aabb::new([T::default(); D], [T::default(); D]);
        for at in aabb.min.iter_mut().chain(&mut aabb.max) {
            *at = self.scalar()?;
        }
        check_box(&aabb, 0).map_err(|_| SnapshotFault::Corrupt)?;
        Ok(aabb)
    }

    fn filter(&mut self) -> Result<Filter, SnapshotFault> {
        let mut word = || Ok(u32::from_le_bytes(self.take()?));
        let (category, mask, group) = (word()?, word()?, word()? as i32);
        match self.take()? {
            [is_static @ (0 | 1)] => {
                Ok(Filter { category, mask, group, is_static: is_static == 1 })
            }
            _ => Err(SnapshotFault::Corrupt),
        }
    }
}
