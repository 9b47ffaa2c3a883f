//! Snapshots: the whole state as bytes, for rollback, replay and saved games.
//!
//! ```text
//! "SaPw"  version u8  dimensions u8  scalar bytes u8  report u8   margin  prediction
//! slots: count, then of each      kind bits u8, generation, and of a living body
//!                                 its box [its reported box] [where its sweep ends] [its filter]
//! pairs: count, then of each      a less the a before it, b less the b before it or less a
//! checksum u64
//! ```
//! Counts, generations and differences are LEB128; all else is little-endian. Equal states give
//! equal bytes.

use alloc::vec::Vec;

use super::hash::Mixer;
use super::options::{Options, Report, contains};
use super::proxy::flag;
use super::{BroadPhase, Filter, check_box};
use crate::{Aabb, Error, Scalar, SnapshotFault};

const MAGIC: [u8; 4] = *b"SaPw";
const VERSION: u8 = 1;
const HEADER: usize = 8;

/// What follows a slot's kind.
mod kind {
    pub const LIVE: u8 = 1;
    pub const LEAVING: u8 = 2;
    pub const SWEPT: u8 = 4;
    pub const FILTERED: u8 = 8;
    pub const ALL: u8 = 15;
}

impl<const D: usize, T: Scalar> BroadPhase<D, T> {
    /// The whole state as bytes. A world [restored](Self::from_snapshot) from them gives, for the
    /// same calls, the same ids, events and results, bit for bit.
    ///
    /// O(n + pairs log pairs) time; about `2 * D * size_of::<T>() + 2` bytes a body and 3 a pair.
    pub fn snapshot(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        bytes.extend(MAGIC);
        bytes.extend([VERSION, D as u8, T::BYTES as u8, self.options.report as u8]);
        put_scalars(&mut bytes, &[self.options.margin, self.options.prediction]);
        put_number(&mut bytes, self.slots.len() as u64);
        for slot in 0..self.slots.len() as u32 {
            self.put_slot(&mut bytes, slot);
        }
        let pairs = self.updater.live();
        put_number(&mut bytes, pairs.len() as u64);
        let mut before = [0; 2];
        for &[a, b] in pairs {
            put_number(&mut bytes, u64::from(a - before[0]));
            put_number(&mut bytes, u64::from(b - if a == before[0] { before[1] } else { a }));
            before = [a, b];
        }
        let sum = checksum(&bytes);
        bytes.extend(sum.to_le_bytes());
        bytes
    }

    fn put_slot(&self, bytes: &mut Vec<u8>, slot: u32) {
        let at = slot as usize;
        let is_live = self.slots.has(slot, flag::LIVE);
        let filter = is_live.then(|| self.filters[at]).filter(|&it| it != Filter::default());
        let is_swept = self.slots.has(slot, flag::SWEPT);
        let bit = |is_set, bit| if is_set { bit } else { 0 };
        bytes.push(
            bit(is_live, kind::LIVE)
                | bit(self.slots.has(slot, flag::LEAVING), kind::LEAVING)
                | bit(is_swept, kind::SWEPT)
                | bit(filter.is_some(), kind::FILTERED),
        );
        put_number(bytes, u64::from(self.slots.generations[at]));
        if !is_live {
            return;
        }
        put_box(bytes, self.shape(slot));
        if self.options.report == Report::Fat {
            put_box(bytes, &self.boxes[at]);
        }
        if is_swept {
            put_box(bytes, &self.rests[at]);
        }
        if let Some(filter) = filter {
            for word in [filter.category, filter.mask, filter.group as u32] {
                bytes.extend(word.to_le_bytes());
            }
            bytes.push(u8::from(filter.is_static));
        }
    }

    /// The world of a snapshot.
    ///
    /// # Errors
    /// [`Error::InvalidSnapshot`] for bytes that are truncated, changed, of another version, of a
    /// world with other dimensions or coordinates, or no snapshot at all. O(n + pairs) time, and
    /// memory in proportion to the bytes.
    pub fn from_snapshot(bytes: &[u8]) -> Result<Self, Error> {
        read(bytes).map_err(Error::InvalidSnapshot)
    }
}

fn read<const D: usize, T: Scalar>(bytes: &[u8]) -> Result<BroadPhase<D, T>, SnapshotFault> {
    let known = MAGIC.len().min(bytes.len());
    if bytes[..known] != MAGIC[..known] {
        return Err(SnapshotFault::Foreign);
    }
    let Some((&[_, _, _, _, version, dimensions, scalar_bytes, report], _)) =
        bytes.split_first_chunk::<HEADER>()
    else {
        return Err(SnapshotFault::Truncated);
    };
    if version != VERSION {
        return Err(SnapshotFault::Version { found: version });
    }
    let (dimensions, scalar_bytes) = (usize::from(dimensions), usize::from(scalar_bytes));
    if (dimensions, scalar_bytes) != (D, T::BYTES) {
        return Err(SnapshotFault::OtherWorld { dimensions, scalar_bytes });
    }
    let mut reader = Reader { bytes: &bytes[HEADER..] };
    let margin = reader.scalar()?;
    let prediction = reader.scalar()?;
    let report = match report {
        0 => Report::Exact,
        1 => Report::Fat,
        _ => return Err(SnapshotFault::Corrupt),
    };
    let options = Options { margin, prediction, report };
    let mut world = BroadPhase::with_options(options).map_err(|_| SnapshotFault::Corrupt)?;
    let count = reader.number()?;
    if count > Error::BOX_LIMIT as u64 {
        return Err(SnapshotFault::Corrupt);
    }
    for slot in 0..count as u32 {
        world.read_slot(slot, &mut reader)?;
    }
    let pairs = read_pairs(&mut reader, |slot| {
        slot < count && world.slots.has(slot as u32, flag::LIVE | flag::LEAVING)
    })?;
    let body = &bytes[..bytes.len() - reader.bytes.len()];
    let sum = reader.take::<8>()?;
    if sum != checksum(body).to_le_bytes() || !reader.bytes.is_empty() {
        return Err(SnapshotFault::Corrupt);
    }
    world.updater.restore(pairs);
    Ok(world)
}

impl<const D: usize, T: Scalar> BroadPhase<D, T> {
    /// Reads the next slot into a world that holds those before it.
    fn read_slot(&mut self, slot: u32, reader: &mut Reader) -> Result<(), SnapshotFault> {
        let [kinds] = reader.take::<1>()?;
        let is_live = kinds & kind::LIVE != 0;
        let generation = u32::try_from(reader.number()?).map_err(|_| SnapshotFault::Corrupt)?;
        let makes_sense = generation > 0
            && kinds & !kind::ALL == 0
            && !(is_live && kinds & kind::LEAVING != 0)
            && (is_live || kinds & (kind::SWEPT | kind::FILTERED) == 0);
        if !makes_sense {
            return Err(SnapshotFault::Corrupt);
        }
        self.slots.generations.push(generation);
        self.slots.flags.push(0);
        let nothing = Aabb::new([T::default(); D], [T::default(); D]);
        if !is_live {
            put(&mut self.boxes, &mut self.shapes, self.options.report, nothing, nothing);
            self.filters.push(Filter::default());
            self.updater.add(slot, nothing);
            if kinds & kind::LEAVING != 0 {
                self.slots.raise(slot, flag::LEAVING);
                self.leaving.push(slot);
            } else {
                self.slots.release(slot);
            }
            return Ok(());
        }
        self.slots.raise(slot, flag::LIVE);
        self.slots.live += 1;
        let shape = reader.aabb()?;
        let boxed = match self.options.report {
            Report::Exact => shape,
            Report::Fat => reader.aabb()?,
        };
        if !contains(&boxed, &shape) {
            return Err(SnapshotFault::Corrupt);
        }
        put(&mut self.boxes, &mut self.shapes, self.options.report, boxed, shape);
        if kinds & kind::SWEPT != 0 {
            let to = reader.aabb()?;
            if !contains(&shape, &to) {
                return Err(SnapshotFault::Corrupt);
            }
            self.sweep_to(slot, to);
        }
        let filter = if kinds & kind::FILTERED != 0 { reader.filter()? } else { Filter::default() };
        self.filters.push(filter);
        self.updater.add(slot, boxed);
        self.touch(slot, flag::IRREGULAR);
        return Ok(());

        fn put<B>(boxes: &mut Vec<B>, shapes: &mut Vec<B>, report: Report, boxed: B, shape: B) {
            boxes.push(boxed);
            if report == Report::Fat {
                shapes.push(shape);
            }
        }
    }
}

/// Pairs that are sorted, each once, smaller slot first, of slots that are in use.
fn read_pairs(
    reader: &mut Reader,
    is_used: impl Fn(u64) -> bool,
) -> Result<Vec<[u32; 2]>, SnapshotFault> {
    let count = reader.number()?;
    // A pair takes two bytes at least: no more memory is asked for than the bytes can fill.
    if count > reader.bytes.len() as u64 / 2 {
        return Err(SnapshotFault::Truncated);
    }
    let mut pairs = Vec::with_capacity(count as usize);
    let mut before = [0u64; 2];
    for _ in 0..count {
        let step = reader.number()?;
        let a = before[0].saturating_add(step);
        let from = if step == 0 { before[1].max(a) } else { a };
        let ahead = reader.number()?;
        let b = from.saturating_add(ahead);
        if ahead == 0 || !is_used(a) || !is_used(b) {
            return Err(SnapshotFault::Corrupt);
        }
        pairs.push([a as u32, b as u32]);
        before = [a, b];
    }
    Ok(pairs)
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

fn checksum(bytes: &[u8]) -> u64 {
    let mut mixer = Mixer::new();
    mixer.add(bytes.len() as u64);
    for chunk in bytes.chunks(8) {
        let mut word = [0; 8];
        word[..chunk.len()].copy_from_slice(chunk);
        mixer.add(u64::from_le_bytes(word));
    }
    mixer.finish()
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
