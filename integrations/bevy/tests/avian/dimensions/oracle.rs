//! Runs both broad phases in each step and compares what they add.

use std::collections::BTreeMap;
use std::time::Duration;

use bevy::app::PluginGroupBuilder;
use bevy::ecs::system::SystemParamItem;
use bevy::prelude::*;
use bevy::time::TimeUpdateStrategy;

use super::avian::collider_tree::ColliderTreeSystems;
use super::avian::collision::contact_types::{ContactEdgeFlags, ContactPairFlags};
use super::avian::dynamics::solver::islands::{IslandPlugin, IslandSleepingPlugin};
use super::avian::prelude::*;
use super::plugin::{PairSearch, SweepAndPruneBroadPhasePlugin};

/// What a contact pair says: its bodies in the order of its colliders, and its flags.
type Contact = (Option<Entity>, Option<Entity>, ContactEdgeFlags, ContactPairFlags);

/// Contact pairs by their colliders, the smaller one first.
type Contacts = BTreeMap<[Entity; 2], Contact>;

/// What both broad phases did so far.
#[derive(Resource, Default)]
struct Oracle {
    schedule: Option<Schedule>,
    before: Contacts,
    expected: Contacts,
    steps: usize,
    pairs: usize,
}

/// An app with both broad phases, one step of physics for each update.
pub struct Both {
    pub app: App,
}

impl Both {
    pub fn new<H: CollisionHooks + 'static>() -> Self
    where
        for<'w, 's> SystemParamItem<'w, 's, H>: CollisionHooks,
    {
        Self::with::<H>(PhysicsPlugins::default().with_collision_hooks::<H>().build())
    }

    /// For a world that changes at random. There Avian 0.7 fails assertions of its own, whichever broad phase it has, unless it
    /// is without islands of bodies, and so without bodies that sleep.
    pub fn for_random_changes<H: CollisionHooks + 'static>() -> Self
    where
        for<'w, 's> SystemParamItem<'w, 's, H>: CollisionHooks,
    {
        let mut physics = PhysicsPlugins::default().with_collision_hooks::<H>().build();
        if cfg!(feature = "bevy-0.19") {
            physics = physics.disable::<IslandPlugin>().disable::<IslandSleepingPlugin>();
        }
        Self::with::<H>(physics)
    }

    fn with<H: CollisionHooks + 'static>(physics: PluginGroupBuilder) -> Self
    where
        for<'w, 's> SystemParamItem<'w, 's, H>: CollisionHooks,
    {
        let mut app = App::new();
        app.add_plugins((
            MinimalPlugins,
            TransformPlugin,
            physics
                .disable::<BvhBroadPhasePlugin<H>>()
                .add(SweepAndPruneBroadPhasePlugin::<H>::default()),
        ));
        let step = Duration::from_secs_f64(1.0 / 64.0);
        app.insert_resource(TimeUpdateStrategy::ManualDuration(step));
        // Avian's own broad phase, in a schedule of its own.
        let mut other = App::new();
        other.init_schedule(PhysicsSchedule);
        other.add_plugins(BvhBroadPhasePlugin::<H>::default());
        let schedule = other.world_mut().resource_mut::<Schedules>().remove(PhysicsSchedule);
        app.insert_resource(Oracle { schedule, ..default() });
        app.add_systems(
            PhysicsSchedule,
            (
                run_avian
                    .after(ColliderTreeSystems::UpdateAabbs)
                    .before(BroadPhaseSystems::CollectCollisions)
                    .ambiguous_with_all(),
                compare.after(BroadPhaseSystems::CollectCollisions).before(BroadPhaseSystems::Last),
            ),
        );
        app.finish();
        app.cleanup();
        Self { app }
    }

    pub fn world(&mut self) -> &mut World {
        self.app.world_mut()
    }

    pub fn step(&mut self) {
        self.app.update();
    }

    /// How many steps ran, and how many contact pairs they added.
    pub fn done(&self) -> (usize, usize) {
        let oracle = self.app.world().resource::<Oracle>();
        (oracle.steps, oracle.pairs)
    }

    pub fn search(&self) -> &PairSearch {
        self.app.world().resource()
    }
}

/// Has Avian's own broad phase add its pairs, and takes them away again.
fn run_avian(world: &mut World) {
    let before = world.resource::<ContactGraph>().clone();
    let mut schedule = world.resource_mut::<Oracle>().schedule.take().expect("it was put back");
    schedule.run(world);
    let found = contacts(world.resource());
    *world.resource_mut::<ContactGraph>() = before;
    let before = contacts(world.resource());
    let mut oracle = world.resource_mut::<Oracle>();
    oracle.schedule = Some(schedule);
    oracle.expected = added(&before, found);
    oracle.before = before;
}

/// Compares what this broad phase added.
fn compare(contact_graph: Res<ContactGraph>, mut oracle: ResMut<Oracle>) {
    let found = added(&oracle.before, contacts(&contact_graph));
    assert_eq!(found, oracle.expected, "step {}", oracle.steps);
    oracle.steps += 1;
    oracle.pairs += found.len();
}

fn added(before: &Contacts, mut after: Contacts) -> Contacts {
    after.retain(|pair, _| !before.contains_key(pair));
    after
}

fn contacts(graph: &ContactGraph) -> Contacts {
    let pairs = graph.iter_active().chain(graph.iter_sleeping());
    let rows = pairs.map(|pair| {
        let edge = graph.get_edge_by_id(pair.contact_id).expect("an edge for each pair");
        assert_eq!((edge.body1, edge.body2), (pair.body1, pair.body2));
        assert_eq!((edge.collider1, edge.collider2), (pair.collider1, pair.collider2));
        let (one, other) = (pair.collider1, pair.collider2);
        if one < other {
            ([one, other], (pair.body1, pair.body2, edge.flags, pair.flags))
        } else {
            ([other, one], (pair.body2, pair.body1, edge.flags, pair.flags))
        }
    });
    rows.collect()
}
