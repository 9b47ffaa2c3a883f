//! Makes an object of any of the six types of box.
//!
//! What uses these functions compiles the core for all six types. A binding that has fewer (a WebAssembly file, to which
//! each adds its share) names the types that it has by [`TypedPairFinder`] and [`TypedBroadPhase`].

use alloc::boxed::Box;

use sweep_and_prune::{Error, Report};

use crate::broad_phase::{ArrayBroadPhase, TypedBroadPhase};
use crate::id::Id;
use crate::kind::Kind;
use crate::pair_finder::{ArrayPairFinder, TypedPairFinder};

impl Kind {
    /// A finder that uses at most `threads` threads; `None` unless there are 1 to 3 dimensions.
    // Inline, so that this crate holds no code for six types: WebAssembly files would take theirs
    // from it in an order that compresses 14 % worse.
    #[inline]
    pub fn pair_finder(self, threads: usize) -> Option<Box<dyn ArrayPairFinder>> {
        Some(match (self.dimensions, self.is_double) {
            (1, false) => Box::new(TypedPairFinder::<1, f32>::new(threads)),
            (2, false) => Box::new(TypedPairFinder::<2, f32>::new(threads)),
            (3, false) => Box::new(TypedPairFinder::<3, f32>::new(threads)),
            (1, true) => Box::new(TypedPairFinder::<1, f64>::new(threads)),
            (2, true) => Box::new(TypedPairFinder::<2, f64>::new(threads)),
            (3, true) => Box::new(TypedPairFinder::<3, f64>::new(threads)),
            _ => return None,
        })
    }

    /// An empty broad phase; `None` unless there are 1 to 3 dimensions.
    ///
    /// # Errors
    /// [`Error::InvalidOption`].
    pub fn broad_phase<I: Id>(
        self,
        report: Report<f64>,
    ) -> Option<Result<Box<dyn ArrayBroadPhase<I>>, Error>> {
        Some(match (self.dimensions, self.is_double) {
            (1, false) => TypedBroadPhase::<1, f32>::new(report).map(|world| Box::new(world) as _),
            (2, false) => TypedBroadPhase::<2, f32>::new(report).map(|world| Box::new(world) as _),
            (3, false) => TypedBroadPhase::<3, f32>::new(report).map(|world| Box::new(world) as _),
            (1, true) => TypedBroadPhase::<1, f64>::new(report).map(|world| Box::new(world) as _),
            (2, true) => TypedBroadPhase::<2, f64>::new(report).map(|world| Box::new(world) as _),
            (3, true) => TypedBroadPhase::<3, f64>::new(report).map(|world| Box::new(world) as _),
            _ => return None,
        })
    }
}
