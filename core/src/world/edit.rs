//! Inserts, sets and removes bodies: what users tell the broad phase between two updates.

use alloc::vec::Vec;

use super::bodies::{Bodies, Filter, ProxyId, REPLACES_ALL, flag};
use super::broad_phase::BroadPhase;
use crate::memory::{prefetch_item, prefetch_pays, preload};
use crate::{Aabb, Error, Scalar, validate};

/// How many bodies ahead boxes are prefetched. In 3D `set_many` takes 0.9 of the time with it at 10,000 and
/// 100,000 bodies, and 0.6 at 1,000,000 (paired, one core of a virtual AMD EPYC of 2024).
const AHEAD: usize = 32;

impl<const D: usize, T: Scalar> BroadPhase<D, T> {
    /// Adds a body with the default filter.
    ///
    /// # Errors
    /// [`Error::InvalidBox`]; [`Error::TooManyBoxes`] if no slot is left.
    pub fn insert(&mut self, aabb: Aabb<D, T>) -> Result<ProxyId, Error> {
        self.insert_with(aabb, Filter::default())
    }

    /// Adds a body.
    ///
    /// # Errors
    /// As [`insert`](Self::insert).
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn insert_with(&mut self, aabb: Aabb<D, T>, filter: Filter) -> Result<ProxyId, Error> {
        aabb.check(0)?;
        self.bodies.slots.check_capacity(1)?;
        Ok(self.bodies.add(aabb, filter))
    }

    /// Adds bodies with one filter. Their ids are in the order of their boxes.
    ///
    /// # Errors
    /// As [`insert`](Self::insert), with the position of the first bad box; then none was added.
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn insert_many(
        &mut self,
        boxes: &[Aabb<D, T>],
        filter: Filter,
    ) -> Result<Vec<ProxyId>, Error> {
        validate(boxes)?;
        self.bodies.slots.check_capacity(boxes.len())?;
        Ok(boxes.iter().map(|&aabb| self.bodies.add(aabb, filter)).collect())
    }

    /// Gives a body its new box.
    ///
    /// # Errors
    /// [`Error::StaleProxy`], [`Error::InvalidBox`].
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn set(&mut self, id: ProxyId, aabb: Aabb<D, T>) -> Result<(), Error> {
        self.set_many(&[id], &[aabb])
    }

    /// Gives each of many bodies its new box. If an id occurs twice, the last box counts.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`]; [`Error::StaleProxy`] or [`Error::InvalidBox`] with the position of
    /// the first bad id or box. Then no box has changed.
    #[inline(never)]
    pub fn set_many(&mut self, ids: &[ProxyId], boxes: &[Aabb<D, T>]) -> Result<(), Error> {
        let bodies = &mut self.bodies;
        if ids.len() != boxes.len() {
            return Err(Error::LengthMismatch { ids: ids.len(), boxes: boxes.len() });
        }
        let rows = ids.iter().zip(boxes);
        let is_sound =
            |(&id, aabb): (&ProxyId, &Aabb<D, T>)| bodies.slots.is_living(id) & is_valid(aabb);
        let are_all = REPLACES_ALL && bodies.slots.are_all(ids);
        let are_sound = if are_all {
            boxes.iter().map(is_valid).fold(true, |all, each| all & each)
        } else {
            rows.clone().map(is_sound).fold(true, |all, each| all & each)
        };
        if !are_sound {
            for (position, (&id, aabb)) in rows.clone().enumerate() {
                bodies.slots.check(id, position)?;
                aabb.check(position)?;
            }
        }
        if !bodies.sweeps.is_empty() {
            for id in ids {
                bodies.cancel_sweep(bodies.slots.index_of[id.slot() as usize]);
            }
        }
        // Of many boxes the update finds out which differ from those of the last one.
        if bodies.scans_all(ids.len()) && !bodies.options.report.is_fat() {
            bodies.edits.touch_all();
            let Bodies { slots, boxes: table, .. } = bodies;
            if are_all {
                table.replace(boxes, slots.is_reordered.then_some(&slots.slot_of));
                return Ok(());
            }
            let table = table.now_mut();
            let index_of = |id: &ProxyId| slots.index_of[id.slot() as usize] as usize;
            let is_far = slots.is_reordered && prefetch_pays(table);
            for (position, (id, aabb)) in rows.enumerate() {
                if is_far && let Some(later) = ids.get(position + AHEAD) {
                    prefetch_item(table, index_of(later));
                }
                table[index_of(id)] = *aabb;
            }
            return Ok(());
        }
        let index_of =
            |bodies: &Bodies<D, T>, id: &ProxyId| bodies.slots.index_of[id.slot() as usize];
        preload(&bodies.boxes.now()[..bodies.rows_to_scan(ids.len())]);
        bodies.edits.reserve(ids.len());
        let is_far = prefetch_pays(bodies.boxes.now());
        for (position, (id, aabb)) in rows.enumerate() {
            // Rows are in the order of space, ids are not: rows are read all over the tables.
            if is_far && let Some(later) = ids.get(position + AHEAD) {
                let index = index_of(bodies, later) as usize;
                prefetch_item(bodies.boxes.now(), index);
                prefetch_item(&bodies.slots.flags, index);
            }
            bodies.place(index_of(bodies, id), aabb);
        }
        Ok(())
    }

    /// Moves a fast body from one box to another: until the next update its box is the union of both,
    /// then `to`. So it pairs with what it would have jumped over (and, on a diagonal way, with what is
    /// beside it).
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, BroadPhase};
    ///
    /// let mut world = BroadPhase::<1>::new();
    /// let bullet = world.insert(Aabb::new([0.0], [0.1]))?;
    /// let wall = world.insert(Aabb::new([5.0], [5.2]))?;
    /// world.update();
    ///
    /// let (from, to) = (world.aabb(bullet)?, Aabb::new([9.0], [9.1]));
    /// world.set_swept(bullet, from, to)?;
    /// assert!(world.update().begun().eq([[bullet, wall]])); // it went through the wall
    /// assert_eq!(world.aabb(bullet)?, to);
    /// assert!(world.update().ended().eq([[bullet, wall]]));
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::StaleProxy`]; [`Error::InvalidBox`] with index 0 for `from` and 1 for `to`.
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn set_swept(
        &mut self,
        id: ProxyId,
        from: Aabb<D, T>,
        to: Aabb<D, T>,
    ) -> Result<(), Error> {
        let index = self.bodies.slots.check(id, 0)?;
        validate(&[from, to])?;
        self.bodies.sweeps.add(&mut self.bodies.slots, index, to);
        self.bodies.place(index, &from.union(&to));
        Ok(())
    }

    /// Gives a body a new box to which it did not move: it was respawned, or went through a portal. With
    /// [`Report::Fat`](crate::Report::Fat) its fat AABB does not reach ahead, and displacements count from here; otherwise the
    /// same as [`set`](Self::set).
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, BroadPhase, Options, Report};
    ///
    /// let report = Report::Fat { margin: 0.5, prediction: 2.0 };
    /// let mut world = BroadPhase::<1>::with_options(Options::default().report(report))?;
    /// let id = world.insert(Aabb::new([0.0], [1.0]))?;
    /// world.update();
    /// world.teleport(id, Aabb::new([3.0], [4.0]))?;
    /// assert_eq!(world.reported_aabb(id)?, Aabb::new([2.5], [4.5]));
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`set`](Self::set).
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn teleport(&mut self, id: ProxyId, aabb: Aabb<D, T>) -> Result<(), Error> {
        let index = self.bodies.slots.check(id, 0)?;
        aabb.check(0)?;
        self.bodies.cancel_sweep(index);
        self.bodies.teleport(index, &aabb);
        Ok(())
    }

    /// Adds an offset to the boxes of all bodies: for worlds whose origin follows the player. The next update reports no
    /// event because of it, except where rounding makes boxes touch. What swept bodies are set to after the next update
    /// is moved too.
    ///
    /// Takes O(n) time, and the next update the time of finding all pairs.
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, BroadPhase};
    ///
    /// let mut world = BroadPhase::<2>::new();
    /// let ids = world.insert_many(&[Aabb::new([8.0, 0.0], [9.0, 1.0]); 2], Default::default())?;
    /// world.update();
    /// world.shift([-8.0, 0.0])?;
    /// assert_eq!(world.aabb(ids[0])?, Aabb::new([0.0, 0.0], [1.0, 1.0]));
    /// assert!(world.update().is_empty());
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidOffset`] if a coordinate of the offset is not finite.
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn shift(&mut self, offset: [T; D]) -> Result<(), Error> {
        let is_finite = |at: T| at > T::NEG_INFINITY && at < T::INFINITY;
        if let Some(axis) = offset.iter().position(|&at| !is_finite(at)) {
            return Err(Error::InvalidOffset { axis, value: offset[axis].to_f64().into() });
        }
        self.bodies.shift(&offset);
        Ok(())
    }

    /// Changes with which others a body may pair. Its pairs begin or end at the next update.
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, BroadPhase, Filter};
    ///
    /// const HERO: u32 = 1;
    /// const GHOST: u32 = 2;
    ///
    /// let mut world = BroadPhase::<1>::new();
    /// let hero = world.insert_with(Aabb::new([0.0], [1.0]), Filter::default().category(HERO))?;
    /// let ghost = world.insert_with(Aabb::new([0.5], [2.0]), Filter::default().category(GHOST))?;
    /// assert!(world.update().begun().eq([[hero, ghost]]));
    ///
    /// // The hero drinks a potion: ghosts do not touch it any more.
    /// world.set_filter(hero, world.filter(hero)?.mask(!GHOST))?;
    /// assert!(world.update().ended().eq([[hero, ghost]]));
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::StaleProxy`].
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn set_filter(&mut self, id: ProxyId, filter: Filter) -> Result<(), Error> {
        let bodies = &mut self.bodies;
        let index = bodies.slots.check(id, 0)?;
        let is_enabled = bodies.rules.filter_now(index).is_enabled;
        bodies.refilter(index, Filter { is_enabled, ..filter });
        Ok(())
    }

    /// Disables a body, or enables it again. While it is disabled it pairs with no other, and queries do not find it; its
    /// box and its filter can be set. Its pairs end or begin at the next update.
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, BroadPhase};
    ///
    /// let mut world = BroadPhase::<1>::new();
    /// let ids = world.insert_many(&[Aabb::new([0.0], [1.0]); 2], Default::default())?;
    /// world.update();
    /// world.set_enabled(ids[1], false)?;
    /// assert!(world.update().ended().eq([[ids[0], ids[1]]]));
    /// assert_eq!(world.queries().containing([0.5])?, [ids[0]]);
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::StaleProxy`].
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn set_enabled(&mut self, id: ProxyId, is_enabled: bool) -> Result<(), Error> {
        let bodies = &mut self.bodies;
        let index = bodies.slots.check(id, 0)?;
        let filter = *bodies.rules.filter_now(index);
        bodies.refilter(index, Filter { is_enabled, ..filter });
        Ok(())
    }

    /// Excludes a pair, whatever the filters of its bodies allow: those of a joint, say. It ends at the next update if it
    /// was there, and does not begin until it is [included](Self::include_pair) again. Its order does not matter; a body
    /// that is removed is forgotten, and a pair of a body with itself is never there.
    ///
    /// Takes O(1) time, and where pairs are found a search of a hash table for each pair of two bodies that both have an
    /// excluded pair.
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, BroadPhase};
    ///
    /// let mut world = BroadPhase::<1>::new();
    /// let ids = world.insert_many(&[Aabb::new([0.0], [1.0]); 3], Default::default())?;
    /// world.exclude_pair(ids[0], ids[1])?;
    /// assert!(world.update().begun().eq([[ids[0], ids[2]], [ids[1], ids[2]]]));
    /// world.include_pair(ids[0], ids[1])?;
    /// assert!(world.update().begun().eq([[ids[0], ids[1]]]));
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::StaleProxy`] with index 0 for `a` and 1 for `b`.
    pub fn exclude_pair(&mut self, a: ProxyId, b: ProxyId) -> Result<(), Error> {
        self.set_excluded(a, b, true)
    }

    /// Includes a pair that was [excluded](Self::exclude_pair).
    ///
    /// # Errors
    /// As [`exclude_pair`](Self::exclude_pair).
    pub fn include_pair(&mut self, a: ProxyId, b: ProxyId) -> Result<(), Error> {
        self.set_excluded(a, b, false)
    }

    #[inline(never)]
    fn set_excluded(&mut self, a: ProxyId, b: ProxyId, is_excluded: bool) -> Result<(), Error> {
        let pair = [self.bodies.slots.check(a, 0)?, self.bodies.slots.check(b, 1)?];
        if a != b {
            self.bodies.exclude(pair, is_excluded);
        }
        Ok(())
    }

    /// Removes a body. Its id is stale from now on; the next update reports its ended pairs.
    ///
    /// # Errors
    /// [`Error::StaleProxy`].
    pub fn remove(&mut self, id: ProxyId) -> Result<(), Error> {
        self.remove_many(&[id])
    }

    /// Removes many bodies.
    ///
    /// # Errors
    /// [`Error::StaleProxy`] with the position of the first id that is stale or occurs twice. Then none
    /// was removed.
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn remove_many(&mut self, ids: &[ProxyId]) -> Result<(), Error> {
        let Bodies { slots, edits, .. } = &mut self.bodies;
        let bad = ids.iter().position(|&id| match slots.check(id, 0) {
            Ok(index) if !slots.has(index, flag::MARKED) => {
                slots.raise(index, flag::MARKED);
                false
            }
            _ => true,
        });
        for id in &ids[..bad.unwrap_or(ids.len())] {
            slots.lower(slots.index_of[id.slot() as usize], flag::MARKED);
        }
        if let Some(index) = bad {
            return Err(Error::StaleProxy { index, id: ids[index].to_bits() });
        }
        let mut exclude = false;
        for id in ids {
            let index = slots.index_of[id.slot() as usize];
            slots.retire(index);
            if !slots.has(index, flag::NEW) {
                edits.note_leaving(index);
                continue;
            }
            // No update knew it, so none has to report its end, and its slot is free at once: a world
            // that is edited and never updated does not grow.
            self.tracking.tree.tree_mut().remove(index);
            exclude |= slots.has(index, flag::EXCLUDES);
            slots.release(index, flag::LISTED);
        }
        if exclude {
            self.bodies.rules.forget_gone(&self.bodies.slots);
        }
        Ok(())
    }

    /// Removes all bodies. Their ids are stale from now on. The next update reports that their pairs ended.
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, BroadPhase};
    ///
    /// let mut world = BroadPhase::<1>::new();
    /// let ids = world.insert_many(&[Aabb::new([0.0], [1.0]); 2], Default::default())?;
    /// world.update();
    /// world.clear();
    /// assert!(world.is_empty());
    /// assert!(world.update().ended().eq([[ids[0], ids[1]]]));
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn clear(&mut self) {
        let ids: Vec<_> = self.ids().collect();
        let removed = self.remove_many(&ids);
        debug_assert!(removed.is_ok(), "the ids of bodies that are here, each once");
    }
}

/// Whether a box is valid, without a branch.
#[inline]
fn is_valid<const D: usize, T: Scalar>(aabb: &Aabb<D, T>) -> bool {
    (0..D).fold(true, |all, axis| all & (aabb.min[axis] <= aabb.max[axis]))
}
