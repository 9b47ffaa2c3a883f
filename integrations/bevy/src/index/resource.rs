//! The index itself, and its queries.

use bevy::ecs::entity::{Entity, EntityHashMap};
use bevy::ecs::resource::Resource;
use sweep_and_prune::{Aabb, BroadPhase, Cast, Error, Filter, ProxyId, Queries};

/// All entities with a [`BoundingBox<D>`](super::BoundingBox), as they were when the systems of
/// [`SpatialIndexSystems`](super::SpatialIndexSystems) last ran.
///
/// Queries take a shared borrow, so systems that ask run in parallel. Lists are in the order in which entities came into
/// the index; the place of one that left goes to a later one. That order depends on no entity number.
///
/// [`world`](Self::world) has the queries that are not here, which name bodies by [`ProxyId`]; [`id`](Self::id) and
/// [`entity`](Self::entity) translate.
#[derive(Resource, Debug)]
pub struct SpatialIndex<const D: usize> {
    world: BroadPhase<D>,
    /// By [slot](ProxyId::slot).
    entities: Vec<Entity>,
    ids: EntityHashMap<ProxyId>,
    rejected: Vec<(Entity, Error)>,
    /// Buffers: bodies that move, and their boxes.
    moving: Vec<ProxyId>,
    boxes: Vec<Aabb<D>>,
}

/// What a ray or a moving box hits.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct IndexHit<const D: usize> {
    /// The entity whose box is hit.
    pub entity: Entity,
    /// Where, as a multiple of the direction of the cast.
    pub t: f64,
    /// The direction of the side that is hit; 0 on each axis if the cast starts inside.
    pub normal: [f32; D],
    /// Whether the cast starts inside.
    pub starts_inside: bool,
}

/// An entity near a point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct IndexNeighbor {
    /// The entity.
    pub entity: Entity,
    /// The square of the distance between the point and the box of the entity: 0 inside.
    pub distance_squared: f64,
}

impl<const D: usize> Default for SpatialIndex<D> {
    fn default() -> Self {
        let mut world = BroadPhase::new();
        world.prepare_queries();
        let (entities, ids, rejected) = Default::default();
        Self { world, entities, ids, rejected, moving: Vec::new(), boxes: Vec::new() }
    }
}

impl<const D: usize> SpatialIndex<D> {
    /// How many entities are in the index.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether no entity is in the index.
    pub fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }

    /// Whether an entity is in the index.
    pub fn contains(&self, entity: Entity) -> bool {
        self.ids.contains_key(&entity)
    }

    /// The entities whose new boxes were not valid when the index was last brought up to date, with the reasons. They are not in
    /// the index until their boxes change again.
    pub fn rejected(&self) -> &[(Entity, Error)] {
        &self.rejected
    }

    /// The bodies of the entities.
    pub fn world(&self) -> &BroadPhase<D> {
        &self.world
    }

    /// The body of an entity that is in the index.
    pub fn id(&self, entity: Entity) -> Option<ProxyId> {
        self.ids.get(&entity).copied()
    }

    /// The entity of a body.
    pub fn entity(&self, id: ProxyId) -> Option<Entity> {
        self.world.contains(id).then(|| self.of(id))
    }

    /// The pairs of entities whose boxes overlap and whose filters allow it, each once. Takes O(pairs) time.
    pub fn pairs(&self) -> impl Iterator<Item = [Entity; 2]> + '_ {
        self.world.pairs_unsorted().map(|pair| pair.map(|id| self.of(id)))
    }

    /// The entities that overlap one and may pair with it; empty if it is not in the index.
    pub fn pairs_of(&self, entity: Entity) -> Vec<Entity> {
        let found = self.id(entity).and_then(|id| self.world.pairs_of(id).ok());
        found.map(|ids| ids.map(|id| self.of(id)).collect()).unwrap_or_default()
    }

    /// The entities whose boxes overlap a box. Touching boxes overlap.
    ///
    /// # Errors
    /// [`Error::InvalidBox`].
    pub fn overlapping(&self, area: &Aabb<D>) -> Result<Vec<Entity>, Error> {
        self.list(|queries| queries.overlapping(area))
    }

    /// The entities whose boxes contain a point.
    ///
    /// # Errors
    /// As [`Queries::containing`].
    pub fn containing(&self, point: [f32; D]) -> Result<Vec<Entity>, Error> {
        self.list(|queries| queries.containing(point))
    }

    /// The entities whose boxes are no further from a point than a radius.
    ///
    /// # Errors
    /// As [`Queries::within`].
    pub fn within(&self, center: [f32; D], radius: f32) -> Result<Vec<Entity>, Error> {
        self.list(|queries| queries.within(center, radius))
    }

    /// What a ray or a moving box hits first.
    ///
    /// # Errors
    /// As [`Queries::cast`].
    pub fn cast(&self, cast: &Cast<D>) -> Result<Option<IndexHit<D>>, Error> {
        let Some(queries) = self.queries() else { return Ok(None) };
        Ok(queries.cast(cast)?.map(|hit| IndexHit {
            entity: self.of(hit.id),
            t: hit.t,
            normal: hit.normal,
            starts_inside: hit.starts_inside,
        }))
    }

    /// The entities nearest to a point, at most `count`, none further than `limit`; the nearest first.
    ///
    /// # Errors
    /// As [`Queries::nearest`].
    pub fn nearest(
        &self,
        point: [f32; D],
        count: usize,
        limit: f64,
    ) -> Result<Vec<IndexNeighbor>, Error> {
        let Some(queries) = self.queries() else { return Ok(Vec::new()) };
        let found = queries.nearest(point, count, limit)?.into_iter().map(|near| IndexNeighbor {
            entity: self.of(near.id),
            distance_squared: near.distance_squared,
        });
        Ok(found.collect())
    }

    fn list(
        &self,
        query: impl FnOnce(&Queries<D>) -> Result<Vec<ProxyId>, Error>,
    ) -> Result<Vec<Entity>, Error> {
        let Some(queries) = self.queries() else { return Ok(Vec::new()) };
        Ok(query(&queries)?.into_iter().map(|id| self.of(id)).collect())
    }

    fn queries(&self) -> Option<Queries<'_, D>> {
        let queries = self.world.prepared_queries();
        debug_assert!(queries.is_some(), "each update ends with preparing for queries");
        queries
    }

    fn of(&self, id: ProxyId) -> Entity {
        self.entities[id.slot() as usize]
    }

    /// Takes an entity out of the index if it is there.
    pub(super) fn remove(&mut self, entity: Entity) {
        if let Some(id) = self.ids.remove(&entity) {
            let removed = self.world.remove(id);
            debug_assert!(removed.is_ok(), "the id of a body that is here");
        }
    }

    /// Puts an entity into the index, or gives it a new box and filter.
    pub(super) fn put(&mut self, entity: Entity, aabb: Aabb<D>, filter: Filter) {
        if let Err(error) = sweep_and_prune::validate(&[aabb]) {
            self.remove(entity);
            self.rejected.push((entity, error));
            return;
        }
        if let Some(id) = self.id(entity) {
            let changed = self.world.set_filter(id, filter);
            debug_assert!(changed.is_ok(), "the id of a body that is here");
            self.moving.push(id);
            self.boxes.push(aabb);
            return;
        }
        match self.world.insert_with(aabb, filter) {
            Ok(id) => {
                let slot = id.slot() as usize;
                if slot >= self.entities.len() {
                    self.entities.resize(slot + 1, entity);
                }
                self.entities[slot] = entity;
                self.ids.insert(entity, id);
            }
            Err(error) => self.rejected.push((entity, error)),
        }
    }

    /// Forgets which boxes were rejected.
    pub(super) fn forget_rejected(&mut self) {
        self.rejected.clear();
    }

    /// Finds the overlaps that began and ended since the last update, and prepares for queries.
    pub(super) fn update(
        &mut self,
        mut begin: impl FnMut([Entity; 2]),
        mut end: impl FnMut([Entity; 2]),
    ) {
        let Self { world, entities, moving, boxes, .. } = self;
        let set = world.set_many(moving, boxes);
        debug_assert!(set.is_ok(), "valid boxes of bodies that are here");
        moving.clear();
        boxes.clear();
        // The entities of bodies that were removed keep their slots until now.
        let of = |pair: &[u32; 2]| pair.map(|slot| entities[slot as usize]);
        let changes = world.update();
        changes.ended().slots().iter().for_each(|pair| end(of(pair)));
        changes.begun().slots().iter().for_each(|pair| begin(of(pair)));
        world.prepare_queries();
    }
}
