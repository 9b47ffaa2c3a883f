//! Which of the six types of box an object has, chosen at run time.

use alloc::boxed::Box;

use sweep_and_prune::{Error, Report, SnapshotFault, SnapshotInfo};

use crate::{ArrayBroadPhase, ArrayPairFinder, Id, TypedBroadPhase, TypedPairFinder};

/// The dimensions and the precision of boxes.
///
/// Its methods compile the core for all six types. A binding that has fewer (a WebAssembly file,
/// to which each adds its share) names the types that it has by [`TypedPairFinder`] and
/// [`TypedBroadPhase`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    /// 1, 2 or 3.
    pub dimensions: usize,
    /// Whether coordinates are `f64`, and not `f32`.
    pub is_double: bool,
}

/// How a broad phase treats its boxes: [`Options`](sweep_and_prune::Options) of any precision.
#[derive(Clone, Copy, Debug, Default)]
pub struct Settings {
    /// What a fat AABB has around the body's own, in units of length.
    pub margin: f64,
    /// How many displacements a fat AABB reaches ahead.
    pub prediction: f64,
    /// Which pairs are reported.
    pub report: Report,
}

impl Kind {
    /// The type of the boxes in a snapshot. The rest of the bytes may still be damaged.
    ///
    /// # Errors
    /// [`Error::InvalidSnapshot`] if the bytes do not begin as a snapshot does.
    pub fn of_snapshot(bytes: &[u8]) -> Result<Self, Error> {
        let SnapshotInfo { dimensions, scalar_bytes, .. } = SnapshotInfo::read(bytes)?;
        match (dimensions, scalar_bytes) {
            (1..=3, 4 | 8) => Ok(Self { dimensions, is_double: scalar_bytes == 8 }),
            _ => Err(Error::InvalidSnapshot(SnapshotFault::Corrupt)),
        }
    }

    /// A finder that uses at most so many threads; `None` unless there are 1 to 3 dimensions.
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
        settings: Settings,
    ) -> Option<Result<Box<dyn ArrayBroadPhase<I>>, Error>> {
        Some(match (self.dimensions, self.is_double) {
            (1, false) => {
                TypedBroadPhase::<1, f32>::new(settings).map(|world| Box::new(world) as _)
            }
            (2, false) => {
                TypedBroadPhase::<2, f32>::new(settings).map(|world| Box::new(world) as _)
            }
            (3, false) => {
                TypedBroadPhase::<3, f32>::new(settings).map(|world| Box::new(world) as _)
            }
            (1, true) => TypedBroadPhase::<1, f64>::new(settings).map(|world| Box::new(world) as _),
            (2, true) => TypedBroadPhase::<2, f64>::new(settings).map(|world| Box::new(world) as _),
            (3, true) => TypedBroadPhase::<3, f64>::new(settings).map(|world| Box::new(world) as _),
            _ => return None,
        })
    }
}
