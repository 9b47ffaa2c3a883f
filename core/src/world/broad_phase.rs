//! The persistent broad phase: its public interface.

use alloc::alloc::{Layout, handle_alloc_error};
use alloc::vec::Vec;

use super::bodies::{Bodies, Filter, ProxyId, When, flag};
use super::changes::{Changes, Events};
#[cfg(feature = "parallel")]
use super::finder::Finder;
use super::invariants;
use super::options::Options;
use super::queries::{Lists, Queries};
use super::snapshot;
use super::tracking::Tracking;
use super::update::{restore, update};
use crate::cloning::clone_fields;
use crate::{Aabb, Error, Scalar};

/// A set of bodies, each with a box, that reports which overlaps begin and which end.
///
/// Bodies are [inserted](Self::insert), [set](Self::set) and [removed](Self::remove) in any order;
/// [`update`](Self::update) then reports the pairs that began and those that ended since the last
/// update, each once, sorted by id. Touching boxes overlap. The [`Filter`] of each body says with which
/// others it may pair. You don't have to track which bodies moved, and a resting body costs only memory.
///
/// [`queries`](Self::queries) finds what overlaps a box, a point or a sphere, what a ray or a moving box
/// hits, and which bodies are nearest.
///
/// To go back to an earlier frame, keep clones: `saved.clone_from(&world)` and `world.clone_from(&saved)` copy into memory
/// that is there. A new [`clone`](Clone::clone) allocates, and a [`snapshot`](Self::snapshot) takes longer to restore.
///
/// The same calls give the same results, bit for bit, on every platform
/// (but for the order of [`pairs_unsorted`](Self::pairs_unsorted) in WebAssembly). A call that returns an error
/// changes nothing. Where memory runs out the program ends, as it does when a collection cannot grow; but an update that finds
/// more pairs than fit into memory is survived by [`try_update`](Self::try_update), and a query whose answer does not fit
/// returns [`Error::OutOfMemory`].
///
/// ```
/// use sweep_and_prune::{Aabb, BroadPhase};
///
/// let mut world = BroadPhase::<2>::new();
/// let hero = world.insert(Aabb::new([0.0, 0.0], [1.0, 2.0]))?;
/// let door = world.insert(Aabb::new([3.0, 0.0], [4.0, 2.0]))?;
/// assert!(world.update().is_empty());
///
/// world.set(hero, Aabb::new([2.5, 0.0], [3.5, 2.0]))?;
/// world.update();
/// for [a, b] in world.changes().begun() {
///     println!("{:?} touches {:?}", world.aabb(a)?, world.aabb(b)?);
/// }
/// assert!(world.pairs().eq([[hero, door]]));
///
/// world.remove(door)?;
/// assert_eq!(world.update().ended().next(), Some([hero, door]));
/// # Ok::<(), sweep_and_prune::Error>(())
/// ```
#[derive(Debug)]
pub struct BroadPhase<const D: usize, T: Scalar = f32> {
    pub(super) bodies: Bodies<D, T>,
    pub(super) tracking: Tracking<D, T>,
    events: Events,
}

clone_fields! {
    [const D: usize, T: Scalar] BroadPhase<D, T> {
        bodies, tracking, events,
    }
}

impl<const D: usize, T: Scalar> BroadPhase<D, T> {
    /// An empty broad phase that reports the pairs of the exact boxes.
    pub fn new() -> Self {
        Self::from_options(Options::default())
    }

    /// An empty broad phase with margins.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] if the margin or the prediction is negative, infinite or NaN.
    pub fn with_options(options: Options<T>) -> Result<Self, Error> {
        options.check()?;
        Ok(Self::from_options(options))
    }

    fn from_options(options: Options<T>) -> Self {
        Self {
            bodies: Bodies { options, ..Bodies::default() },
            tracking: Tracking::default(),
            events: Events::default(),
        }
    }

    /// Uses this many threads of rayon's current pool in updates in which most bodies move; 0 counts as
    /// one. Results do not depend on it. Clones keep it, snapshots do not.
    #[cfg(feature = "parallel")]
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Self {
        self.tracking.finder = Finder::with_threads(threads);
        self
    }

    /// Uses all threads of rayon's current pool, which has one for each processor unless you made it: see
    /// [`threads`](Self::threads).
    #[cfg(feature = "parallel")]
    #[must_use]
    pub fn all_threads(self) -> Self {
        self.threads(rayon::current_num_threads())
    }

    /// The options that it was made with.
    pub fn options(&self) -> Options<T> {
        self.bodies.options
    }

    /// How many bodies there are.
    pub fn len(&self) -> usize {
        self.bodies.slots.live
    }

    /// Whether there is no body.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The ids of all bodies, sorted.
    pub fn ids(&self) -> impl Iterator<Item = ProxyId> + '_ {
        let slots = &self.bodies.slots;
        let live = slots.index_of.iter().filter(|&&index| slots.has(index, flag::LIVE));
        live.map(|&index| slots.id(index))
    }

    /// Whether an id names a body that is here. Ids of other worlds are not told apart: two worlds
    /// give out the same ids, so that a restored world takes the ids of the one that was saved.
    pub fn contains(&self, id: ProxyId) -> bool {
        self.bodies.slots.is_living(id)
    }

    /// The box of a body as last set. That of a swept body is, until the next update, the union of the
    /// boxes where the sweep begins and ends.
    ///
    /// # Errors
    /// [`Error::StaleProxy`].
    pub fn aabb(&self, id: ProxyId) -> Result<Aabb<D, T>, Error> {
        Ok(*self.bodies.shape(self.bodies.slots.check(id, 0)?))
    }

    /// The box of a body whose overlaps are reported: its [`aabb`](Self::aabb), or with
    /// [`Report::Fat`](crate::Report::Fat) its fat AABB.
    ///
    /// # Errors
    /// [`Error::StaleProxy`].
    pub fn reported_aabb(&self, id: ProxyId) -> Result<Aabb<D, T>, Error> {
        Ok(self.bodies.boxes.now()[self.bodies.slots.check(id, 0)? as usize])
    }

    /// The filter of a body.
    ///
    /// # Errors
    /// [`Error::StaleProxy`].
    pub fn filter(&self, id: ProxyId) -> Result<Filter, Error> {
        Ok(Filter { is_enabled: true, ..self.own_filter(id)? })
    }

    /// Whether a body is enabled, as it is until [`set_enabled`](Self::set_enabled) says otherwise.
    ///
    /// # Errors
    /// [`Error::StaleProxy`].
    pub fn is_enabled(&self, id: ProxyId) -> Result<bool, Error> {
        Ok(self.own_filter(id)?.is_enabled)
    }

    fn own_filter(&self, id: ProxyId) -> Result<Filter, Error> {
        Ok(*self.bodies.rules.filter_now(self.bodies.slots.check(id, 0)?))
    }

    /// Whether a pair is [excluded](Self::exclude_pair).
    ///
    /// # Errors
    /// As [`exclude_pair`](Self::exclude_pair).
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn is_excluded(&self, a: ProxyId, b: ProxyId) -> Result<bool, Error> {
        let pair = [self.bodies.slots.check(a, 0)?, self.bodies.slots.check(b, 1)?];
        Ok(self.bodies.rules.excludes(&self.bodies.slots, pair, When::Now))
    }

    /// Finds the pairs that began and ended since the last update.
    ///
    /// Takes time in proportion to the bodies that changed and their neighbors. If all bodies fly, or some
    /// jump anywhere, it takes 1.2 to 2.3 times as long as finding all pairs (10,000 to 1,000,000 bodies). After a level
    /// was loaded, if most bodies are new and static, the next update takes 2 to 3 times as long as finding all pairs,
    /// so that no later one is late.
    /// The result borrows the world mutably; [`changes`](Self::changes) gives the same by a shared borrow.
    ///
    /// If the pairs do not fit into memory the program ends: see [`try_update`](Self::try_update).
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn update(&mut self) -> Changes<'_> {
        if self.try_update().is_err() {
            handle_alloc_error(Layout::new::<[u32; 2]>());
        }
        self.changes()
    }

    /// Updates as [`update`](Self::update) does, with an error where that ends the program: if the pairs of a crowd do not fit
    /// into memory.
    ///
    /// After the error the world is as before, but that there are no [`changes`](Self::changes), its buffers are freed, and fat
    /// AABBs that were much too wide are narrower already. Once the crowd is apart, removed or filtered, the next call finds what
    /// changed since the last update that succeeded.
    ///
    /// Memory for what is already there, the bodies and the pairs of the last update, is taken as collections take it:
    /// without that the program ends.
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, BroadPhase, Filter};
    ///
    /// let mut world = BroadPhase::<2>::new();
    /// let place = Aabb::new([0.0, 0.0], [1.0, 1.0]);
    /// let ids = world.insert_many(&[place; 100], Filter::default())?;
    /// if world.try_update().is_err() {
    ///     // Too many at one place: half of them go.
    ///     world.remove_many(&ids[50..])?;
    ///     world.try_update()?;
    /// }
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn try_update(&mut self) -> Result<Changes<'_>, Error> {
        update(&mut self.bodies, &mut self.tracking, &mut self.events)?;
        Ok(self.changes())
    }

    /// What the last [`update`](Self::update) found. Edits since do not change it; a restored world or
    /// a world that was never updated has no changes.
    pub fn changes(&self) -> Changes<'_> {
        Changes { slots: &self.bodies.slots, events: &self.events }
    }

    /// The pairs that overlapped at the last update, each once, its smaller id first, sorted. A restored
    /// world gives the same.
    ///
    /// Takes O(pairs) time and memory; [`pairs_unsorted`](Self::pairs_unsorted) takes less.
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, BroadPhase};
    ///
    /// let mut world = BroadPhase::<1>::new();
    /// let ids = world.insert_many(&[Aabb::new([0.0], [1.0]); 3], Default::default())?;
    /// world.update();
    /// assert!(world.pairs().eq([[ids[0], ids[1]], [ids[0], ids[2]], [ids[1], ids[2]]]));
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn pairs(&self) -> impl ExactSizeIterator<Item = [ProxyId; 2]> + '_ {
        self.tracking.candidates.sorted_ids(&self.bodies.slots)
    }

    /// The pairs of [`pairs`](Self::pairs) in an order that is the same for the same calls, but not
    /// specified: a restored world may give another, and so does WebAssembly. Takes O(pairs) time and does not allocate.
    pub fn pairs_unsorted(&self) -> impl Iterator<Item = [ProxyId; 2]> + '_ {
        self.tracking.candidates.ids(&self.bodies.slots)
    }

    /// Which of the conditions that hold between calls does not, if any: for tests of this crate. Takes O(bodies + candidates)
    /// time.
    #[doc(hidden)]
    pub fn broken_invariant(&self) -> Option<&'static str> {
        invariants::broken(&self.bodies, &self.tracking)
    }

    /// The pairs of [`pairs`](Self::pairs) by body: the list of each slot ([`ProxyId::slot`]) has the bodies that pair with
    /// the body there, sorted. Slots without one have empty lists.
    ///
    /// Takes O(pairs + slots) time and memory, where [`pairs_of`](Self::pairs_of) for each body takes much more.
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, BroadPhase};
    ///
    /// let mut world = BroadPhase::<1>::new();
    /// let ids = world.insert_many(&[Aabb::new([0.0], [1.0]); 3], Default::default())?;
    /// world.update();
    /// let touching = world.pairs_by_body();
    /// assert_eq!(&touching[ids[1].slot() as usize], [ids[0], ids[2]]);
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn pairs_by_body(&self) -> Lists<ProxyId> {
        let (ends, others) = self.tracking.candidates.by_slot(&self.bodies.slots);
        Lists::from_parts(ends, others)
    }

    /// The bodies that overlapped this one at the last update, sorted.
    ///
    /// Takes O(log n) time and that of its neighbors if the tree is up to date, as it is after
    /// [`queries`](Self::queries) until the next update; otherwise O(pairs) time. For many bodies take
    /// [`pairs_by_body`](Self::pairs_by_body) once.
    ///
    /// # Errors
    /// [`Error::StaleProxy`].
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn pairs_of(&self, id: ProxyId) -> Result<impl ExactSizeIterator<Item = ProxyId>, Error> {
        let Self { bodies, tracking, .. } = self;
        let slots = &bodies.slots;
        let index = slots.check(id, 0)?;
        let mut others = Vec::new();
        if slots.has(index, flag::NEW) {
            // No update knew it.
        } else if tracking.tree.is_fresh() && tracking.flying.is_empty() {
            let near = tracking.tree.tree().overlapping(bodies.boxes.previous()[index as usize]);
            others.extend(near.filter(|&other| {
                other != index
                    && slots.has(other, flag::LIVE | flag::LEAVING)
                    && bodies.was_live([index, other])
            }));
        } else {
            tracking.candidates.list_others(slots, index, &mut others);
        }
        Ok(slots.sorted_ids(&others).into_iter())
    }

    /// Prepares for queries, which takes time if bodies changed since it last did, and answers them.
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, BroadPhase, Cast};
    ///
    /// let mut world = BroadPhase::<2>::new();
    /// let wall = world.insert(Aabb::new([5.0, 0.0], [6.0, 9.0]))?;
    /// let tree = world.insert(Aabb::new([8.0, 0.0], [9.0, 9.0]))?;
    ///
    /// let queries = world.queries();
    /// assert_eq!(queries.overlapping(&Aabb::new([0.0, 0.0], [5.0, 1.0]))?, [wall]);
    /// let hit = queries.cast(&Cast::ray([1.0, 1.0], [1.0, 0.0], 100.0))?.unwrap();
    /// assert_eq!((hit.id, hit.t), (wall, 4.0));
    /// assert_eq!(queries.nearest([10.0, 1.0], 1, f64::INFINITY)?[0].id, tree);
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn queries(&mut self) -> Queries<'_, D, T> {
        self.prepare_queries();
        self.all_queries()
    }

    /// Prepares for queries, as [`queries`](Self::queries) does. Then, until the next change,
    /// [`prepared_queries`](Self::prepared_queries) answers them by a shared borrow.
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn prepare_queries(&mut self) {
        self.tracking.ready_for_queries(&mut self.bodies);
    }

    /// Answers queries by a shared borrow, so that threads can ask at the same time, and boxes, filters and pairs can be
    /// read beside. `None` if the world is not prepared, which is certain only from
    /// [`prepare_queries`](Self::prepare_queries) or [`queries`](Self::queries) until a body is inserted or changed, or the
    /// next update.
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, BroadPhase};
    ///
    /// let mut world = BroadPhase::<2>::new();
    /// let wall = world.insert(Aabb::new([5.0, 0.0], [6.0, 9.0]))?;
    /// assert!(world.prepared_queries().is_none());
    /// world.prepare_queries();
    /// let area = world.aabb(wall)?;
    /// let queries = world.prepared_queries().expect("nothing changed since");
    /// std::thread::scope(|scope| {
    ///     let half = scope.spawn(|| queries.overlapping(&area));
    ///     assert_eq!(queries.containing([5.5, 1.0])?, [wall]);
    ///     assert_eq!(half.join().expect("it does not panic")?, [wall]);
    ///     Ok::<(), sweep_and_prune::Error>(())
    /// })
    /// # ?; Ok::<(), sweep_and_prune::Error>(())
    /// ```
    pub fn prepared_queries(&self) -> Option<Queries<'_, D, T>> {
        self.tracking.is_ready_for_queries(&self.bodies).then(|| self.all_queries())
    }

    fn all_queries(&self) -> Queries<'_, D, T> {
        let Self { bodies, tracking, .. } = self;
        Queries {
            bodies,
            tree: tracking.tree.tree(),
            sorted: &tracking.sorted,
            filter: None,
            predicate: None,
            is_sorted: true,
        }
    }

    /// The whole state as bytes. A world [restored](Self::from_snapshot) from them gives, for the
    /// same calls, the same ids, events and results, bit for bit.
    ///
    /// Takes O(n) time; about `2 * D * size_of::<T>() + 2` bytes for each body at rest, and nearly twice as many with
    /// [`Report::Fat`](crate::Report::Fat), which adds its fat AABB. To go back a few frames, as
    /// rollback does, a clone is faster: see [`BroadPhase`]. Snapshots are for files and for other machines.
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, BroadPhase};
    ///
    /// let mut world = BroadPhase::<2>::new();
    /// let hero = world.insert(Aabb::new([0.0, 0.0], [1.0, 1.0]))?;
    /// world.update();
    /// let saved: Vec<u8> = world.snapshot(); // write it to a file, or send it
    ///
    /// let mut other = BroadPhase::<2>::from_snapshot(&saved)?;
    /// assert_eq!(other.state_hash(), world.state_hash());
    /// for world in [&mut world, &mut other] {
    ///     world.set(hero, Aabb::new([2.0, 0.0], [3.0, 1.0]))?; // the ids are the same
    ///     world.update();
    /// }
    /// assert_eq!(other.state_hash(), world.state_hash());
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn snapshot(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        self.snapshot_into(&mut bytes);
        bytes
    }

    /// Replaces bytes by those of a [`snapshot`](Self::snapshot). Does not allocate if they have the capacity, as those of
    /// an earlier snapshot of as many bodies most often do.
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, BroadPhase};
    ///
    /// let mut world = BroadPhase::<2>::new();
    /// let mut saved = Vec::new();
    /// for at in [0.0, 1.0] {
    ///     world.insert(Aabb::new([at, at], [at + 1.0, at + 1.0]))?;
    ///     world.snapshot_into(&mut saved);
    ///     assert_eq!(saved, world.snapshot());
    /// }
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn snapshot_into(&self, bytes: &mut Vec<u8>) {
        bytes.clear();
        snapshot::write(&self.bodies, bytes);
    }

    /// The world of a snapshot. Any bytes give a world or an error.
    ///
    /// Takes the time of finding all pairs, and memory in proportion to the bytes and the pairs.
    ///
    /// # Errors
    /// [`Error::InvalidSnapshot`] for bytes that are truncated, changed, of another version, of a
    /// world with other dimensions or coordinates, or no snapshot at all. [`Error::OutOfMemory`] if the pairs do not fit.
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn from_snapshot(bytes: &[u8]) -> Result<Self, Error> {
        let bodies = snapshot::read(bytes).map_err(Error::InvalidSnapshot)?;
        let tracking = restore(&bodies)?;
        Ok(Self { bodies, tracking, events: Events::default() })
    }

    /// Gives back memory that is not needed now, and changes no result. Updates give back the memory of a crowd by
    /// themselves, at most 128 updates after it is gone. Not given back is what the world keeps for as many bodies as it once had
    /// at the same time, which an update of most bodies looks through: after a much larger level, begin a new world.
    ///
    /// Takes O(n + pairs) time, and meanwhile as much memory again as the world needs.
    pub fn shrink_to_fit(&mut self) {
        // Buffers are not cloned, and lists without spare capacity.
        *self = self.clone();
    }

    /// A hash of the whole state, that of its [`snapshot`](Self::snapshot): boxes, filters, the
    /// ids given out, and what the next update has to report. Equal for equal states, on every
    /// platform: it shows whether two machines that run the same simulation diverged. It is no
    /// protection against forgery.
    ///
    /// Takes O(n) time and memory.
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn state_hash(&self) -> u64 {
        snapshot::hash(&self.snapshot())
    }
}

impl<const D: usize, T: Scalar> Default for BroadPhase<D, T> {
    fn default() -> Self {
        Self::new()
    }
}
