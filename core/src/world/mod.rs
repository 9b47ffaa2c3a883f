//! The living world: bodies that are inserted, moved and removed, and what begins and ends.

mod anew;
mod candidates;
mod changes;
mod edit;
mod effort;
mod filter;
mod follow;
mod hash;
mod loners;
mod options;
mod predict;
mod proxy;
mod queries;
mod rebuild;
mod seating;
#[cfg(feature = "serde")]
mod serde;
mod sleep;
mod snapshot;
mod sort;
mod tree;
mod update;
mod updater;

use alloc::vec::Vec;

pub use changes::{Changes, Pairs};
pub use filter::Filter;
pub use options::{Options, Report};
pub use proxy::ProxyId;
pub use queries::{Cast, Hit, Lists, Neighbour, Queries};
pub use snapshot::SnapshotInfo;

use crate::{Aabb, Error, Scalar};
use proxy::{Slots, flag};
use updater::Updater;

/// A world of boxes that tells which overlaps began and which ended.
///
/// Bodies are [inserted](Self::insert), [set](Self::set) and [removed](Self::remove) as often as
/// one likes; [`update`](Self::update) then reports the pairs that began and those that ended
/// since the last update, each once, sorted by id. Touching boxes overlap; which bodies may pair
/// at all is their [`Filter`]'s to say. What a body that rests costs is its memory.
///
/// [`queries`](Self::queries) answers what overlaps a box, a point or a sphere, what a ray or a
/// moving box hits, and which bodies are nearest.
///
/// Same calls, same results: bit for bit, on every platform. A refused call changes nothing.
///
/// ```
/// use sweep_and_prune::{Aabb, BroadPhase};
///
/// let mut world = BroadPhase::<2>::new();
/// let hero = world.insert(Aabb::new([0.0, 0.0], [1.0, 2.0]))?;
/// let door = world.insert(Aabb::new([3.0, 0.0], [4.0, 2.0]))?;
/// assert_eq!(world.update().begun().len(), 0);
///
/// world.set(hero, Aabb::new([2.5, 0.0], [3.5, 2.0]))?;
/// for pair in world.update().begun() {
///     assert_eq!(pair, [hero, door]);
/// }
/// assert_eq!(world.pairs(), [[hero, door]]);
///
/// world.remove(door)?;
/// assert_eq!(world.update().ended().next(), Some([hero, door]));
/// # Ok::<(), sweep_and_prune::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct BroadPhase<const D: usize, T: Scalar = f32> {
    options: Options<T>,
    slots: Slots,
    /// By seat, the boxes whose overlaps are reported.
    boxes: Vec<Aabb<D, T>>,
    /// By seat, the boxes as given, where these are not the ones reported; else empty.
    shapes: Vec<Aabb<D, T>>,
    /// By seat.
    filters: Vec<Filter>,
    /// Whether a body ever had another filter than the default: if not, every pair is allowed.
    any_filter: bool,
    /// The seats of [`flag::CHANGED`], at least once each, and those of bodies that left since.
    changed: Vec<u32>,
    /// Whether other bodies' boxes may differ from those of the last update too.
    unlisted: bool,
    /// The seats of [`flag::LEAVING`].
    leaving: Vec<u32>,
    /// By seat, where the bodies of [`flag::SWEPT`] are after the next update; as long as the
    /// last seat of one ever needed.
    rests: Vec<Aabb<D, T>>,
    /// The seats of [`flag::SWEPT`], and others, some twice.
    swept: Vec<u32>,
    updater: Updater<D, T>,
}

impl<const D: usize, T: Scalar> BroadPhase<D, T> {
    /// An empty world that reports the pairs of the exact boxes.
    pub fn new() -> Self {
        Self::from_options(Options::default())
    }

    /// An empty world with margins.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] if the margin or the prediction is negative, infinite or NaN.
    pub fn with_options(options: Options<T>) -> Result<Self, Error> {
        options.check()?;
        Ok(Self::from_options(options))
    }

    fn from_options(options: Options<T>) -> Self {
        Self {
            options,
            slots: Slots::default(),
            boxes: Vec::new(),
            shapes: Vec::new(),
            filters: Vec::new(),
            any_filter: false,
            changed: Vec::new(),
            unlisted: false,
            leaving: Vec::new(),
            rests: Vec::new(),
            swept: Vec::new(),
            updater: Updater::new(),
        }
    }

    /// The same world, which finds candidates on so many threads of rayon's current pool where most
    /// bodies move at once; one if 0 is given. Nothing but the time depends on it. Clones keep it,
    /// snapshots do not.
    #[cfg(feature = "parallel")]
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Self {
        self.updater.set_threads(threads);
        self
    }

    /// The options it was made with.
    pub fn options(&self) -> Options<T> {
        self.options
    }

    /// How many bodies there are.
    pub fn len(&self) -> usize {
        self.slots.live
    }

    /// Whether there is no body.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The ids of all bodies, sorted.
    pub fn ids(&self) -> impl Iterator<Item = ProxyId> + '_ {
        let seats = self.slots.seats.iter();
        seats.filter(|&&seat| self.slots.has(seat, flag::LIVE)).map(|&seat| self.slots.id(seat))
    }

    /// Whether an id names a body that is here. Ids of other worlds are not told apart: two worlds
    /// give out the same ids, so that a restored world takes the ids of the one that was saved.
    pub fn contains(&self, id: ProxyId) -> bool {
        self.slots.find(id).is_some()
    }

    /// The box of a body as last given: for a swept one, until the next update, the whole way.
    ///
    /// # Errors
    /// [`Error::StaleProxy`].
    pub fn aabb(&self, id: ProxyId) -> Result<Aabb<D, T>, Error> {
        Ok(*self.shape(self.slots.check(id, 0)?))
    }

    /// The box of a body whose overlaps are reported: its [`aabb`](Self::aabb), or with
    /// [`Report::Fat`] its fat box.
    ///
    /// # Errors
    /// [`Error::StaleProxy`].
    pub fn reported_aabb(&self, id: ProxyId) -> Result<Aabb<D, T>, Error> {
        Ok(self.boxes[self.slots.check(id, 0)? as usize])
    }

    /// The filter of a body.
    ///
    /// # Errors
    /// [`Error::StaleProxy`].
    pub fn filter(&self, id: ProxyId) -> Result<Filter, Error> {
        Ok(self.filters[self.slots.check(id, 0)? as usize])
    }

    /// The box of a body as given.
    fn shape(&self, seat: u32) -> &Aabb<D, T> {
        match self.options.report {
            Report::Exact => &self.boxes[seat as usize],
            Report::Fat => &self.shapes[seat as usize],
        }
    }
}

impl<const D: usize, T: Scalar> Default for BroadPhase<D, T> {
    fn default() -> Self {
        Self::new()
    }
}
