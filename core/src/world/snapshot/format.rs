//! The format of snapshots: the whole state as bytes.
//!
//! ```text
//! "SaPw"  version u8  dimensions u8  scalar bytes u8  bits of `world` u8
//! [margin  prediction  how far all was shifted since the last update]    if fat AABBs are reported
//! count of slots, then of each slot
//!     what it holds, bits of u8; generation
//!     its box [its fat AABB, if these are reported]       if it lives
//!     [from where its next displacement counts]          if that is another box
//!     [where its sweep ends]                             if it is swept
//!     [its filter]                                       if not the default
//!     [its box at the last update]                       if another
//!     [its filter at the last update]                    if another
//! [count of excluded pairs, then of each: its slots, when]     if there are any
//! hash of all this, u64
//! ```
//! Counts and generations are LEB128, all else is little-endian. Live pairs need not be written:
//! they are those of the boxes and filters of the last update. Equal states give equal bytes.

use crate::{Error, SnapshotFault};

/// What snapshots begin with.
pub const MAGIC: [u8; 4] = *b"SaPw";
pub const VERSION: u8 = 1;
const HEADER: usize = 8;

/// What a world reports and holds, in the header.
pub mod world {
    /// Fat AABBs are reported.
    pub const FAT: u8 = 1;
    /// There are excluded pairs.
    pub const EXCLUSIONS: u8 = 2;
}

/// Bits of the last byte of a filter.
pub mod filter {
    pub const STATIC: u8 = 1;
    pub const DISABLED: u8 = 2;
}

/// What a slot holds.
pub mod holds {
    /// A living body.
    pub const BODY: u8 = 1;
    /// A body that was removed since the last update.
    pub const LEAVING: u8 = 2;
    /// Its body was inserted since the last update.
    pub const NEW: u8 = 4;
    /// Its box is swept.
    pub const SWEEP: u8 = 8;
    /// Its filter is not the default.
    pub const FILTER: u8 = 16;
    /// It had another box at the last update.
    pub const OLD_BOX: u8 = 32;
    /// It had another filter at the last update.
    pub const OLD_FILTER: u8 = 64;
    /// Its next displacement does not count from its box.
    pub const ORIGIN: u8 = 128;
}

/// What kind of world a snapshot holds: which [`BroadPhase`](crate::BroadPhase) can be restored from it.
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

/// The kind of world, the bits of [`world`], and what follows the header.
pub fn read_header(bytes: &[u8]) -> Result<(SnapshotInfo, u8, &[u8]), SnapshotFault> {
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
