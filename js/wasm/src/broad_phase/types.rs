//! The types of box that a file has.
//!
//! Each type adds to the download, so there are at most three. 1D boxes are stored as 2D, and 1D and 2D
//! boxes in double precision as 3D: they are flat on the axes that are added. The small files, for
//! events only, have one type each.

use alloc::boxed::Box;

use sweep_and_prune::Report;
use sweep_and_prune_bindings::TypedBroadPhase;

use super::handle::World;

/// An empty broad phase for boxes of 1 to 3 dimensions; `None` for those that the file does not have, or
/// for a bad margin or prediction.
pub(super) fn broad_phase(dimensions: u32, is_double: bool, report: Report<f64>) -> Option<World> {
    match (dimensions, is_double) {
        #[cfg(any(feature = "broad-phase", feature = "events-2d"))]
        (1 | 2, false) => Some(Box::new(TypedBroadPhase::<2, f32>::new(report).ok()?)),
        #[cfg(any(feature = "broad-phase", feature = "events-3d"))]
        (3, false) => Some(Box::new(TypedBroadPhase::<3, f32>::new(report).ok()?)),
        #[cfg(feature = "broad-phase")]
        (1..=3, true) => Some(Box::new(TypedBroadPhase::<3, f64>::new(report).ok()?)),
        _ => None,
    }
}
