//! The plugin: a system in place of Avian's, and observers for what the trees do not tell.

use std::marker::PhantomData;

use bevy::ecs::component::ComponentId;
use bevy::ecs::entity_disabling::Disabled;
use bevy::ecs::system::{StaticSystemParam, SystemParamItem};
use bevy::platform::time::Instant;
use bevy::prelude::*;
use bevy::tasks::{ComputeTaskPool, ParallelSlice};

use super::avian::collider_tree::{
    ColliderTreeProxyFlags, ColliderTreeProxyKey, ColliderTrees, MovedProxies,
};
use super::avian::collision::CollisionDiagnostics;
use super::avian::collision::contact_types::{ContactEdge, ContactEdgeFlags, ContactPairFlags};
use super::avian::prelude::{
    BroadPhaseSystems, ColliderDisabled, ColliderOf, CollisionHooks, CollisionLayers, ContactGraph,
    PhysicsSchedule, PhysicsStepSystems, RigidBody, Sensor,
};
use super::joint_graph::JointGraph;
use super::search::{Candidate, PairSearch};
use super::tracked::proxy;
use crate::versions::on;

/// An observer that has the collider of an event read again.
macro_rules! touch_on {
    ($event:ident, $components:ty) => {
        |trigger: on!($event, $components), mut search: ResMut<PairSearch>| {
            search.touch(trigger.event_target());
        }
    };
}

/// An observer of events that may add a collider.
macro_rules! add_on {
    ($event:ident, $components:ty) => {
        |_: on!($event, $components), mut search: ResMut<PairSearch>| search.may_add()
    };
}

/// Finds the pairs of colliders with overlapping boxes by sweep and prune, in place of Avian's
/// `BvhBroadPhasePlugin<H>`, which must be disabled. `H` is the same type of [`CollisionHooks`] as in
/// `PhysicsPlugins::with_collision_hooks::<H>()`.
///
/// It adds the same contact pairs in the same steps. Their order is another, and the same in every run, on any number
/// of threads. A pair has its colliders in the order of their trees (dynamic, kinematic, static), unless only the later
/// one moved.
///
/// With the feature `parallel` the search uses all threads of rayon's pool where most colliders move, unless
/// [`threads`](Self::threads) says otherwise.
pub struct SweepAndPruneBroadPhasePlugin<H: CollisionHooks = ()> {
    #[cfg(feature = "parallel")]
    threads: Option<usize>,
    hooks: PhantomData<H>,
}

impl<H: CollisionHooks> SweepAndPruneBroadPhasePlugin<H> {
    /// Uses at most this many threads; 0 counts as one.
    #[cfg(feature = "parallel")]
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Self {
        self.threads = Some(threads);
        self
    }
}

impl<H: CollisionHooks> Default for SweepAndPruneBroadPhasePlugin<H> {
    fn default() -> Self {
        Self {
            #[cfg(feature = "parallel")]
            threads: None,
            hooks: PhantomData,
        }
    }
}

impl<H: CollisionHooks + 'static> Plugin for SweepAndPruneBroadPhasePlugin<H>
where
    for<'w, 's> SystemParamItem<'w, 's, H>: CollisionHooks,
{
    fn build(&self, app: &mut App) {
        #[cfg(feature = "parallel")]
        app.insert_resource(PairSearch::with_threads(self.threads));
        #[cfg(not(feature = "parallel"))]
        app.init_resource::<PairSearch>();
        app.add_systems(
            PhysicsSchedule,
            (
                collect_collision_pairs::<H>.in_set(BroadPhaseSystems::CollectCollisions),
                end_step.in_set(PhysicsStepSystems::Last),
            ),
        );
        // A collider leaves the trees, or its filter changes there.
        app.add_observer(touch_on!(Remove, ColliderTreeProxyKey))
            .add_observer(touch_on!(Add, ColliderDisabled))
            .add_observer(touch_on!(Add, Disabled))
            .add_observer(touch_on!(Insert, CollisionLayers))
            .add_observer(touch_on!(Add, Sensor))
            .add_observer(touch_on!(Remove, Sensor));
        // A collider is added to a tree.
        app.add_observer(add_on!(Insert, (ColliderTreeProxyKey, ColliderOf, RigidBody)))
            .add_observer(add_on!(Remove, ColliderOf))
            // Also where the component is inserted once more, and so is not removed: Avian adds the collider then, too.
            .add_observer(add_on!(Discard, (ColliderDisabled, Disabled)));
    }

    fn finish(&self, app: &mut App) {
        // What requires a key of Avian's trees is a type of colliders. Each time it is inserted, even in place of a
        // collider, the trees add it.
        let components = app.world().components();
        let key = components.component_id::<ColliderTreeProxyKey>();
        let is_collider = |&id: &ComponentId| {
            let info = components.get_info(id);
            info.is_some_and(|info| info.required_components().iter_ids().any(|it| Some(it) == key))
        };
        let ids = (0..components.len()).map(ComponentId::new);
        let colliders: Vec<_> = ids.filter(is_collider).collect();
        if !colliders.is_empty() {
            let observer = Observer::new(add_on!(Insert, ()));
            app.world_mut().spawn(observer.with_components(colliders));
        }
    }
}

fn end_step(mut search: ResMut<PairSearch>) {
    search.end_step();
}

fn collect_collision_pairs<H: CollisionHooks>(
    mut search: ResMut<PairSearch>,
    (trees, moved): (Res<ColliderTrees>, Res<MovedProxies>),
    hooks: StaticSystemParam<H>,
    par_commands: ParallelCommands,
    mut contacts: ResMut<ContactGraph>,
    joints: Res<JointGraph>,
    mut diagnostics: ResMut<CollisionDiagnostics>,
) where
    for<'w, 's> SystemParamItem<'w, 's, H>: CollisionHooks,
{
    let start = Instant::now();
    let candidates = search.find(&trees, &moved, &contacts, &joints);
    let refused = ask_hooks(&candidates, &search, &hooks.into_inner(), &par_commands);
    let mut left = refused.iter().peekable();
    let mut added = 0;
    for candidate in &candidates {
        if left.next_if(|&&pair| pair == [candidate.first, candidate.second]).is_none() {
            added += usize::from(add_contact(candidate, &search, &trees, &mut contacts));
        }
    }
    search.finish(candidates, added, &refused);
    diagnostics.broad_phase += start.elapsed();
}

/// The candidates that the user's hook refuses, in order. The hook is asked by all threads of Bevy's pool.
fn ask_hooks(
    candidates: &[Candidate],
    search: &PairSearch,
    hooks: &impl CollisionHooks,
    par_commands: &ParallelCommands,
) -> Vec<[u32; 2]> {
    let asking: Vec<_> = candidates.iter().filter(|it| it.asks_hook).copied().collect();
    if asking.is_empty() {
        return Vec::new();
    }
    let refused = asking.par_splat_map(ComputeTaskPool::get(), None, |_, chunk| {
        let mut refused = Vec::new();
        par_commands.command_scope(|mut commands| {
            for &Candidate { first, second, .. } in chunk {
                let [one, other] = [first, second].map(|slot| search.tracked(slot).collider);
                if !hooks.filter_pairs(one, other, &mut commands) {
                    refused.push([first, second]);
                }
            }
        });
        refused
    });
    refused.concat()
}

/// Adds a contact pair with what Avian's own broad phase says about it. Whether there was none.
fn add_contact(
    candidate: &Candidate,
    search: &PairSearch,
    trees: &ColliderTrees,
    contacts: &mut ContactGraph,
) -> bool {
    let keys = [candidate.first, candidate.second].map(|slot| search.tracked(slot).key);
    let [Some(first), Some(second)] = keys.map(|key| proxy(key, trees)) else { return false };
    let mut edge = ContactEdge::new(first.collider, second.collider);
    (edge.body1, edge.body2) = (first.body, second.body);
    let flags = first.flags.union(second.flags);
    let has_events = flags.contains(ColliderTreeProxyFlags::CONTACT_EVENTS);
    edge.flags.set(ContactEdgeFlags::CONTACT_EVENTS, has_events);
    let is_modified = flags.contains(ColliderTreeProxyFlags::MODIFY_CONTACTS);
    let without = ColliderTreeProxyFlags::BODY_DISABLED.union(ColliderTreeProxyFlags::SENSOR);
    let added = contacts.add_edge_with(edge, |pair| {
        (pair.body1, pair.body2) = (first.body, second.body);
        pair.flags.set(ContactPairFlags::MODIFY_CONTACTS, is_modified);
        pair.flags.set(ContactPairFlags::GENERATE_CONSTRAINTS, !flags.intersects(without));
    });
    added.is_some()
}
