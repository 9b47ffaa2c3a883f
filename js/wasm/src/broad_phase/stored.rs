//! The bytes of a snapshot of boxes that are stored in more dimensions than the user gives them. They
//! do not tell the user's dimensions, so these stand in front of them.

use alloc::vec::Vec;

use sweep_and_prune::{Error, Report, SnapshotFault};
use sweep_and_prune_bindings::Kind;

use super::handle::World;
use super::types::broad_phase;

/// The first bytes of a snapshot that has the user's dimensions next, and then the core's bytes. The
/// last of those, a byte of their checksum, is XORed with the dimensions: so the checksum covers these too.
const FLAT: [u8; 4] = *b"SaPf";

/// In which type boxes are stored.
fn stored(dimensions: u32, is_double: bool) -> Kind {
    Kind { dimensions: if is_double { 3 } else { dimensions.max(2) as usize }, is_double }
}

/// The snapshot of a broad phase whose boxes have this many dimensions for the user.
pub(super) fn snapshot(world: &World, dimensions: u32) -> Vec<u8> {
    let mut bytes = world.snapshot();
    if world.kind().dimensions != dimensions as usize {
        cover(&mut bytes, dimensions as u8);
        bytes.splice(0..0, FLAT.into_iter().chain([dimensions as u8]));
    }
    bytes
}

/// Brings the dimensions into the checksum at the end, or takes them out.
fn cover(bytes: &mut [u8], dimensions: u8) {
    if let Some(last) = bytes.last_mut() {
        *last ^= dimensions;
    }
}

/// The broad phase of a snapshot, if its boxes have this many dimensions for the user.
///
/// # Errors
/// [`Error::InvalidSnapshot`]. If the dimensions differ, [`SnapshotFault::OtherWorld`] with the dimensions in the snapshot.
pub(super) fn restore(bytes: &mut [u8], dimensions: u32) -> Result<World, Error> {
    let (flat, bytes) = if bytes.starts_with(&FLAT) {
        let Some((&mut flat, bytes)) = bytes[FLAT.len()..].split_first_mut() else {
            return Err(Error::InvalidSnapshot(SnapshotFault::Truncated));
        };
        cover(bytes, flat);
        (Some(flat), bytes)
    } else {
        (None, bytes)
    };
    let kind = Kind::of_snapshot(bytes)?;
    let given = flat.map_or(kind.dimensions, usize::from);
    if given != dimensions as usize || kind != stored(dimensions, kind.is_double) {
        let scalar_bytes = if kind.is_double { 8 } else { 4 };
        let fault = SnapshotFault::OtherWorld { dimensions: given, scalar_bytes };
        return Err(Error::InvalidSnapshot(fault));
    }
    let mut world =
        broad_phase(dimensions, kind.is_double, Report::Exact).ok_or(Error::OutOfMemory)?;
    world.restore(bytes)?;
    Ok(world)
}
