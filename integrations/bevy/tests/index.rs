//! The spatial index against brute force: its pairs, messages and queries after random changes.

#[cfg(feature = "bevy-0.19")]
extern crate bevy_0_19 as bevy;

use std::collections::BTreeSet;

use bevy::ecs::entity_disabling::Disabled;
use bevy::prelude::*;
use bevy_sweep_and_prune::index::{
    BoundingBox, IndexFilter, OverlapBegan, OverlapEnded, SpatialIndex, SpatialIndexPlugin,
};
use bevy_sweep_and_prune::sweep_and_prune::{Aabb, Cast, Error, Filter};

type Pairs = BTreeSet<[Entity; 2]>;

/// A generator of random numbers: the same in each run.
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(0x1405_7B7E_F767_814F);
        (self.0 >> 33) as usize % end
    }

    /// Whole coordinates, so that boxes often touch.
    fn aabb<const D: usize>(&mut self) -> Aabb<D> {
        let min: [f32; D] = std::array::from_fn(|_| self.below(15 / D) as f32);
        let max = min.map(|at| at + self.below(3) as f32);
        Aabb::new(min, max)
    }
}

fn sorted([a, b]: [Entity; 2]) -> [Entity; 2] {
    if a < b { [a, b] } else { [b, a] }
}

fn is_valid<const D: usize>(aabb: &Aabb<D>) -> bool {
    (0..D).all(|axis| aabb.min[axis] <= aabb.max[axis])
}

fn overlap<const D: usize>(a: &Aabb<D>, b: &Aabb<D>) -> bool {
    (0..D).all(|axis| a.min[axis] <= b.max[axis] && b.min[axis] <= a.max[axis])
}

/// All entities that the index has to have, with their boxes and filters.
fn rows<const D: usize>(world: &mut World) -> Vec<(Entity, Aabb<D>, Filter)> {
    let mut query = world.query::<(Entity, &BoundingBox<D>, Option<&IndexFilter>)>();
    let rows = query.iter(world).filter(|(_, aabb, _)| is_valid(&aabb.0));
    rows.map(|(entity, aabb, filter)| (entity, aabb.0, filter.copied().unwrap_or_default().0))
        .collect()
}

fn pairs_of<const D: usize>(rows: &[(Entity, Aabb<D>, Filter)]) -> Pairs {
    let mut pairs = Pairs::new();
    for (at, (one, aabb, filter)) in rows.iter().enumerate() {
        for (other, other_aabb, other_filter) in &rows[..at] {
            if overlap(aabb, other_aabb) && filter.allows(other_filter) {
                pairs.insert(sorted([*one, *other]));
            }
        }
    }
    pairs
}

fn change<const D: usize>(world: &mut World, random: &mut Random, entities: &mut Vec<Entity>) {
    let index = random.below(entities.len());
    let target = entities[index];
    let mut entity = world.entity_mut(target);
    match random.below(12) {
        0 => {
            world.despawn(target);
            entities.swap_remove(index);
        }
        1 => drop(entity.remove::<BoundingBox<D>>()),
        2 => drop(entity.insert(Disabled)),
        3 => drop(entity.remove::<Disabled>()),
        4 => drop(entity.insert(IndexFilter(Filter::default().category(2).mask(1)))),
        5 => drop(entity.remove::<IndexFilter>()),
        6 => drop(entity.insert(BoundingBox(Aabb::new([f32::NAN; D], [0.0; D])))),
        7 => entities.push(world.spawn(BoundingBox(random.aabb::<D>())).id()),
        8 => {
            // It moves and leaves in one step.
            entity.insert(BoundingBox(random.aabb::<D>())).insert(Disabled);
        }
        _ => drop(entity.insert(BoundingBox(random.aabb::<D>()))),
    }
}

fn drain<M: Message>(world: &mut World) -> Vec<M> {
    world.resource_mut::<Messages<M>>().drain().collect()
}

fn is_as_brute_force<const D: usize>(seed: u64) {
    let mut random = Random(seed);
    let mut app = App::new();
    app.add_plugins(SpatialIndexPlugin::<D>::default());
    let mut entities: Vec<_> =
        (0..40).map(|_| app.world_mut().spawn(BoundingBox(random.aabb::<D>())).id()).collect();
    let mut before = Pairs::new();
    let mut seen = 0;
    for _ in 0..150 {
        for _ in 0..random.below(4) {
            change::<D>(app.world_mut(), &mut random, &mut entities);
        }
        app.update();
        let rows = rows::<D>(app.world_mut());
        let pairs = pairs_of(&rows);
        let began = drain::<OverlapBegan<D>>(app.world_mut());
        let ended = drain::<OverlapEnded<D>>(app.world_mut());
        seen += began.len() + ended.len();
        let began: Vec<_> = began.iter().map(|it| sorted(it.entities)).collect();
        let ended: Vec<_> = ended.iter().map(|it| sorted(it.entities)).collect();
        let expected = [&pairs - &before, &before - &pairs];
        assert_eq!([began.len(), ended.len()], expected.each_ref().map(BTreeSet::len));
        assert_eq!([began, ended].map(BTreeSet::from_iter), expected);
        let index = app.world().resource::<SpatialIndex<D>>();
        assert_eq!(index.pairs().map(sorted).collect::<Pairs>(), pairs);
        assert_eq!(index.len(), rows.len());
        let area = random.aabb::<D>();
        let found: BTreeSet<_> =
            index.overlapping(&area).expect("a valid box").into_iter().collect();
        let near = |row: &&(Entity, Aabb<D>, Filter)| overlap(&row.1, &area);
        assert_eq!(found, rows.iter().filter(near).map(|row| row.0).collect());
        let at = area.min;
        let contains = |row: &&(Entity, Aabb<D>, Filter)| overlap(&row.1, &Aabb::new(at, at));
        let containing = index.containing(at).expect("a valid point");
        assert_eq!(
            containing.into_iter().collect::<BTreeSet<_>>(),
            rows.iter().filter(contains).map(|row| row.0).collect()
        );
        for &(entity, ..) in &rows {
            let of = index.pairs_of(entity).into_iter().map(|other| sorted([entity, other]));
            let expected = pairs.iter().copied().filter(|pair| pair.contains(&entity));
            assert_eq!(of.collect::<Pairs>(), expected.collect());
            assert_eq!(index.id(entity).and_then(|id| index.entity(id)), Some(entity));
        }
        before = pairs;
    }
    assert!(seen > 100);
}

#[test]
fn pairs_messages_and_queries_are_as_brute_force_finds_them() {
    for seed in 0..5 {
        is_as_brute_force::<2>(seed);
        is_as_brute_force::<3>(seed);
    }
}

#[test]
fn boxes_of_two_dimensions_and_of_one_do_not_meet() {
    let mut app = App::new();
    app.add_plugins((SpatialIndexPlugin::<1>::default(), SpatialIndexPlugin::<2>::default()));
    let line = BoundingBox(Aabb::new([0.0], [1.0]));
    let area = BoundingBox(Aabb::new([0.0, 0.0], [1.0, 1.0]));
    let both = [app.world_mut().spawn((line, area)).id(), app.world_mut().spawn(line).id()];
    app.update();
    assert!(app.world().resource::<SpatialIndex<1>>().pairs().eq([both]));
    let index = app.world().resource::<SpatialIndex<2>>();
    assert_eq!((index.len(), index.pairs().count()), (1, 0));
    assert_eq!(drain::<OverlapBegan<1>>(app.world_mut()).len(), 1);
    assert_eq!(drain::<OverlapBegan<2>>(app.world_mut()).len(), 0);
}

#[test]
fn an_invalid_box_is_named_and_stays_out_until_it_is_valid() {
    let mut app = App::new();
    app.add_plugins(SpatialIndexPlugin::<1>::in_schedule(Update));
    let entity = app.world_mut().spawn(BoundingBox(Aabb::new([1.0], [0.0]))).id();
    app.update();
    let index = app.world().resource::<SpatialIndex<1>>();
    assert!(
        matches!(index.rejected(), [(rejected, Error::InvalidBox { .. })] if *rejected == entity)
    );
    assert!(!index.contains(entity));
    app.world_mut().entity_mut(entity).insert(BoundingBox(Aabb::new([0.0], [1.0])));
    app.update();
    let index = app.world().resource::<SpatialIndex<1>>();
    assert!(index.rejected().is_empty() && index.contains(entity));
}

/// An app's own component that disables entities.
#[derive(Component)]
struct Asleep;

#[test]
fn an_entity_that_a_component_of_the_app_disables_leaves_the_index_until_it_is_enabled() {
    let mut app = App::new();
    app.add_plugins(SpatialIndexPlugin::<1>::default());
    app.world_mut().register_disabling_component::<Asleep>();
    let aabb = BoundingBox(Aabb::new([0.0], [1.0]));
    let [entity, asleep] =
        [app.world_mut().spawn(aabb).id(), app.world_mut().spawn((aabb, Asleep)).id()];
    app.update();
    assert_eq!(app.world().resource::<SpatialIndex<1>>().pairs().count(), 0);
    app.world_mut().entity_mut(asleep).remove::<Asleep>();
    app.update();
    assert!(app.world().resource::<SpatialIndex<1>>().pairs().eq([[entity, asleep]]));
    app.world_mut().entity_mut(entity).insert(Asleep);
    app.update();
    let index = app.world().resource::<SpatialIndex<1>>();
    assert!(!index.contains(entity) && index.contains(asleep));
    assert_eq!(drain::<OverlapEnded<1>>(app.world_mut()).len(), 1);
}

/// An app that was updated, with one entity in its index.
fn app_with_entity() -> (App, Entity) {
    let mut app = App::new();
    app.add_plugins(SpatialIndexPlugin::<1>::default());
    let entity = app.world_mut().spawn(BoundingBox(Aabb::new([0.0], [1.0]))).id();
    app.update();
    (app, entity)
}

#[test]
fn entities_can_be_despawned_while_a_user_has_the_index() {
    let (mut app, entity) = app_with_entity();
    app.world_mut().resource_scope(|world, index: Mut<SpatialIndex<1>>| {
        for found in index.containing([0.5]).expect("a valid point") {
            world.despawn(found);
        }
    });
    app.update();
    assert!(!app.world().resource::<SpatialIndex<1>>().contains(entity));
}

#[test]
fn an_entity_is_rejected_once_however_much_of_it_has_changed() {
    let (mut app, entity) = app_with_entity();
    let mut changed = app.world_mut().entity_mut(entity);
    changed.insert(Disabled).remove::<Disabled>().insert(BoundingBox(Aabb::new([1.0], [0.0])));
    app.update();
    assert_eq!(app.world().resource::<SpatialIndex<1>>().rejected().len(), 1);
}

#[test]
fn rays_hit_entities_and_points_have_nearest_ones() {
    let mut app = App::new();
    app.add_plugins(SpatialIndexPlugin::<2>::default());
    let mut spawn =
        |min: [f32; 2], max| app.world_mut().spawn(BoundingBox(Aabb::new(min, max))).id();
    let wall = spawn([5.0, 0.0], [6.0, 9.0]);
    let tree = spawn([8.0, 0.0], [9.0, 9.0]);
    app.update();
    let index = app.world().resource::<SpatialIndex<2>>();
    let hit = index.cast(&Cast::ray([1.0, 1.0], [1.0, 0.0], 100.0)).expect("a valid ray");
    let hit = hit.expect("the wall");
    assert_eq!((hit.entity, hit.t, hit.normal, hit.starts_inside), (wall, 4.0, [-1.0, 0.0], false));
    let near = index.nearest([10.0, 1.0], 2, f64::INFINITY).expect("a valid point");
    assert_eq!(near.iter().map(|it| it.entity).collect::<Vec<_>>(), [tree, wall]);
    assert_eq!(near[0].distance_squared, 1.0);
    assert_eq!(index.within([10.0, 1.0], 1.0).expect("a valid sphere"), [tree]);
    assert!(index.containing([f32::NAN, 0.0]).is_err());
}
