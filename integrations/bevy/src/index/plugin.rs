//! The plugin that keeps the index up to date.

use bevy::app::{App, Plugin, PostUpdate};
use bevy::ecs::component::ComponentId;
use bevy::ecs::entity::{Entity, EntityHashSet};
use bevy::ecs::entity_disabling::DefaultQueryFilters;
use bevy::ecs::event::EntityEvent;
use bevy::ecs::intern::Interned;
use bevy::ecs::lifecycle::{Add, Remove};
use bevy::ecs::message::MessageWriter;
use bevy::ecs::observer::Observer;
use bevy::ecs::query::{Changed, Or};
use bevy::ecs::resource::Resource;
use bevy::ecs::schedule::common_conditions::run_once;
use bevy::ecs::schedule::{IntoScheduleConfigs, ScheduleLabel, SystemSet};
use bevy::ecs::system::{Query, ResMut};
use bevy::ecs::world::World;

use super::components::{BoundingBox, IndexFilter};
use super::messages::{OverlapBegan, OverlapEnded};
use super::resource::SpatialIndex;
use crate::versions::on;

/// Entities that may have left the index, or come back, without a change of a component. Not in the index itself, which
/// a user may have taken out of the world while entities are despawned.
#[derive(Resource, Default)]
struct Touched<const D: usize>(Vec<Entity>);

/// An observer that has the entity of an event read again.
macro_rules! touch_on {
    ($event:ident, $components:ty) => {
        |trigger: on!($event, $components), mut touched: ResMut<Touched<D>>| {
            touched.0.push(trigger.event_target());
        }
    };
}

/// Keeps a [`SpatialIndex`] of all entities with a [`BoundingBox`] of `D` dimensions, and writes an
/// [`OverlapBegan`] and an [`OverlapEnded`] message for each pair whose overlap begins or ends.
///
/// It runs in [`PostUpdate`], unless [`in_schedule`](Self::in_schedule) names another schedule, and sees each entity
/// that was changed since it last ran. That takes time in proportion to the entities with a box (to look for changes)
/// and the ones that moved. An app can have one plugin for each kind of box.
///
/// ```
/// use bevy::prelude::*;
/// use bevy_sweep_and_prune::index::{BoundingBox, OverlapBegan, SpatialIndex, SpatialIndexPlugin};
/// use bevy_sweep_and_prune::sweep_and_prune::Aabb;
///
/// let mut app = App::new();
/// app.add_plugins(SpatialIndexPlugin::<2>::default());
/// let hero = app.world_mut().spawn(BoundingBox(Aabb::new([0.0, 0.0], [1.0, 2.0]))).id();
/// let gate = app.world_mut().spawn(BoundingBox(Aabb::new([1.0, 0.0], [2.0, 2.0]))).id();
/// app.update();
/// let index = app.world().resource::<SpatialIndex<2>>();
/// assert!(index.pairs().eq([[hero, gate]]));
/// assert_eq!(index.containing([1.5, 1.0])?, [gate]);
/// # Ok::<(), bevy_sweep_and_prune::sweep_and_prune::Error>(())
/// ```
#[derive(Debug)]
pub struct SpatialIndexPlugin<const D: usize> {
    schedule: Interned<dyn ScheduleLabel>,
}

/// The systems that bring an index up to date. Order yours after it to see what changed in the same run.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SpatialIndexSystems;

impl<const D: usize> SpatialIndexPlugin<D> {
    /// An index that is brought up to date in a schedule, `FixedPostUpdate` for example.
    pub fn in_schedule(schedule: impl ScheduleLabel) -> Self {
        Self { schedule: schedule.intern() }
    }
}

impl<const D: usize> Default for SpatialIndexPlugin<D> {
    fn default() -> Self {
        Self::in_schedule(PostUpdate)
    }
}

impl<const D: usize> Plugin for SpatialIndexPlugin<D> {
    fn build(&self, app: &mut App) {
        let systems = (observe_disabling::<D>.run_if(run_once), update_index::<D>).chain();
        app.init_resource::<SpatialIndex<D>>()
            .init_resource::<Touched<D>>()
            .add_message::<OverlapBegan<D>>()
            .add_message::<OverlapEnded<D>>()
            .add_systems(self.schedule, systems.in_set(SpatialIndexSystems))
            .add_observer(touch_on!(Remove, BoundingBox<D>))
            .add_observer(touch_on!(Remove, IndexFilter));
    }
}

/// Observes the components that take an entity out of queries: [`Disabled`](bevy::ecs::entity_disabling::Disabled) and
/// those that an app has registered, which has to be done before it starts.
fn observe_disabling<const D: usize>(world: &mut World) {
    let filters = world.get_resource::<DefaultQueryFilters>();
    let disabling: Vec<ComponentId> =
        filters.into_iter().flat_map(|all| all.disabling_ids()).collect();
    for component in disabling {
        world.spawn(Observer::new(touch_on!(Add, ())).with_component(component));
        world.spawn(Observer::new(touch_on!(Remove, ())).with_component(component));
    }
}

/// What the index reads of an entity.
type Row<'a, const D: usize> = (&'a BoundingBox<D>, Option<&'a IndexFilter>);

/// An entity that was changed.
type IsChanged<const D: usize> = Or<(Changed<BoundingBox<D>>, Changed<IndexFilter>)>;

fn update_index<const D: usize>(
    mut index: ResMut<SpatialIndex<D>>,
    mut touched: ResMut<Touched<D>>,
    rows: Query<Row<'static, D>>,
    changed: Query<Entity, IsChanged<D>>,
    mut began: MessageWriter<OverlapBegan<D>>,
    mut ended: MessageWriter<OverlapEnded<D>>,
) {
    index.forget_rejected();
    let mut read = |entity| match rows.get(entity) {
        Ok((aabb, filter)) => index.put(entity, aabb.0, filter.copied().unwrap_or_default().0),
        Err(_) => index.remove(entity),
    };
    // Each once: an entity may be touched several times, and changed too.
    let mut seen = EntityHashSet::default();
    for entity in touched.0.drain(..).filter(|&entity| seen.insert(entity)) {
        read(entity);
    }
    for entity in changed.iter().filter(|entity| !seen.contains(entity)) {
        read(entity);
    }
    index.update(
        |pair| {
            began.write(OverlapBegan::new(pair));
        },
        |pair| {
            ended.write(OverlapEnded::new(pair));
        },
    );
}
