//! The types of box that the file has, and the bytes of a snapshot of boxes stored otherwise than
//! the user gives them.
//!
//! Each type adds to the download, so there are three. 1D boxes are stored as 2D, and 1D and 2D
//! boxes in double precision as 3D: they are flat on the axes that are added. The bytes of such a
//! broad phase do not tell its dimensions, so its snapshot has them in front of these bytes.

use alloc::boxed::Box;
use alloc::vec::Vec;

use sweep_and_prune::{Error, SnapshotFault};
use sweep_and_prune_bindings::{Kind, Settings, TypedBroadPhase};

use super::handle::World;

/// The first bytes of a snapshot that has the user's dimensions next, and then the core's bytes. The
/// last of those, a byte of their checksum, is XORed with the dimensions: so the checksum covers these too.
const FLAT: [u8; 4] = *b"SaPf";

/// In which type boxes are stored.
fn stored(dimensions: u32, is_double: bool) -> Kind {
    Kind { dimensions: if is_double { 3 } else { dimensions.max(2) as usize }, is_double }
}

/// An empty broad phase for boxes of 1 to 3 dimensions; `None` for other ones or bad settings.
pub(super) fn broad_phase(dimensions: u32, is_double: bool, settings: Settings) -> Option<World> {
    match (dimensions, is_double) {
        (1 | 2, false) => Some(Box::new(TypedBroadPhase::<2, f32>::new(settings).ok()?)),
        (3, false) => Some(Box::new(TypedBroadPhase::<3, f32>::new(settings).ok()?)),
        (1..=3, true) => Some(Box::new(TypedBroadPhase::<3, f64>::new(settings).ok()?)),
        _ => None,
    }
}

/// The snapshot of a broad phase whose boxes have so many dimensions for the user.
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

/// The broad phase of a snapshot, if its boxes have so many dimensions for the user.
///
/// # Errors
/// [`Error::InvalidSnapshot`]; for other dimensions, [`SnapshotFault::OtherWorld`] with those of
/// the user.
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
        broad_phase(dimensions, kind.is_double, Settings::default()).ok_or(Error::OutOfMemory)?;
    world.restore(bytes)?;
    Ok(world)
}
