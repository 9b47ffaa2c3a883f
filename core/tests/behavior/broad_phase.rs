//! The persistent broad phase against brute force, and what it promises case by case. (Random sequences of every operation
//! are a target of `fuzz/`.)

use std::collections::BTreeSet;
use std::ops::Range;

use sweep_and_prune::{
    Aabb, BroadPhase, Cast, Error, Filter, Hit, Lists, Options, PairFinder, ProxyId, Queries,
    Report, SnapshotFault, SnapshotInfo,
};
use sweep_and_prune_fuzz::{Model, Pair};
use sweep_and_prune_scenes::{Motion, Random, Scene};

fn sorted<V: Ord>(values: impl Iterator<Item = V>) -> Vec<V> {
    let mut values: Vec<_> = values.collect();
    values.sort_unstable();
    values
}

/// Larger worlds, in which trees have levels and storage is reordered: the pairs after each update
/// are those of the finder, and the events what changed.
fn check_motion<const D: usize>(scene: Scene, seed: u64, steps: usize) {
    let count = if matches!(scene, Scene::Coincident | Scene::Nested) { 200 } else { 1500 };
    let mut random = Random::new(seed);
    let mut boxes = scene.boxes::<D, f64>(count, seed).unwrap();
    let mut world = BroadPhase::<D, f64>::new();
    let ids = world.insert_many(&boxes, Filter::default()).unwrap();
    let mut finder = PairFinder::<D, f64>::new();
    let mut live: Vec<Pair> = vec![];
    for step in 0..steps {
        // All drift, some jump, few or none move, everything is elsewhere.
        let (share, jumps) =
            [(1.0, 0.0), (1.0, 0.02), (0.02, 0.5), (0.1, 0.0), (0.0, 0.0), (1.0, 1.0)]
                [if step % 7 == 6 { 5 } else { step / 8 % 5 }];
        for aabb in &mut boxes {
            if random.unit() < share {
                let jump = if random.unit() < jumps { 1.0 } else { 0.002 };
                for axis in 0..D {
                    let way = jump * (random.unit() - 0.5);
                    aabb.min[axis] += way;
                    aabb.max[axis] = (aabb.max[axis] + way).max(aabb.min[axis]);
                }
            }
        }
        world.set_many(&ids, &boxes).unwrap();
        let changes = world.update();
        let (begun, ended): (Vec<Pair>, Vec<Pair>) =
            (changes.begun().collect(), changes.ended().collect());
        let pairs = finder.find(&boxes).unwrap();
        let mut now: Vec<Pair> = pairs.iter().map(|p| p.map(|index| ids[index as usize])).collect();
        now.sort_unstable();
        let missing = |from: &[Pair], of: &[Pair]| -> Vec<Pair> {
            of.iter().filter(|pair| from.binary_search(pair).is_err()).copied().collect()
        };
        assert_eq!(begun, missing(&live, &now), "{scene:?} {step}");
        assert_eq!(ended, missing(&now, &live), "{scene:?} {step}");
        assert_eq!(sorted(world.pairs()), now);
        live = now;
        let area = boxes[step % count];
        let found = world.queries().overlapping(&area).unwrap();
        let expected = ids.iter().zip(&boxes).filter(|(_, aabb)| aabb.overlaps(&area));
        assert!(expected.map(|(&id, _)| id).eq(found));
    }
}

#[test]
fn large_worlds_report_the_changes_of_any_motion() {
    let steps = if cfg!(debug_assertions) { 42 } else { 210 };
    for scene in [
        Scene::Uniform,
        Scene::Clustered,
        Scene::Tower,
        Scene::Slab,
        Scene::Mixed,
        Scene::Coincident,
        Scene::Nested,
    ] {
        check_motion::<2>(scene, 1, steps);
        check_motion::<3>(scene, 2, steps);
    }
}

/// Tables of more than 1 MiB, of which rows are prefetched.
#[test]
fn tables_larger_than_the_cache_give_the_same_changes() {
    for motion in Motion::ALL {
        let mut moving = motion.start::<3, f64>(25_000, 3).unwrap();
        let mut world = BroadPhase::<3, f64>::new();
        let ids = world.insert_many(moving.boxes(), Filter::default()).unwrap();
        let mut finder = PairFinder::<3, f64>::new();
        let mut live: BTreeSet<Pair> = BTreeSet::new();
        for frame in 0..6 {
            let changes = world.update();
            for pair in changes.ended() {
                assert!(live.remove(&pair), "{motion:?} {frame}");
            }
            for pair in changes.begun() {
                assert!(live.insert(pair), "{motion:?} {frame}");
            }
            let pairs = finder.find(moving.boxes()).unwrap();
            assert_eq!(live.len(), pairs.len(), "{motion:?} {frame}");
            assert!(pairs.iter().all(|pair| live.contains(&pair.map(|index| ids[index as usize]))));
            let before = moving.boxes().to_vec();
            moving.advance();
            let moved = (0..ids.len()).filter(|&index| before[index] != moving.boxes()[index]);
            let (ids, boxes): (Vec<_>, Vec<_>) =
                moved.map(|index| (ids[index], moving.boxes()[index])).unzip();
            world.set_many(&ids, &boxes).unwrap();
        }
    }
}

#[test]
fn a_sleeping_body_wakes_with_all_its_pairs_whatever_changes() {
    let mut random = Random::new(11);
    let mut world = BroadPhase::<2, f64>::new();
    let mut model = Model::new(Options::default());
    let mut ids = vec![];
    let draw = |random: &mut Random| {
        let at: [f64; 2] = random.point();
        Aabb::new(at, at.map(|at| at + 0.06))
    };
    let still = Filter::STATIC;
    let odd = Filter::default().category(2).mask(1);
    let filters = [Filter::default(), Filter::default(), Filter::default(), still, odd];
    for _ in 0..400 {
        let (aabb, filter) = (draw(&mut random), filters[random.below(filters.len())]);
        let id = world.insert_with(aabb, filter).unwrap();
        model.insert(id, aabb, filter);
        ids.push(id);
    }
    for step in 0..700 {
        let mut shove = |which: usize, most: f64, random: &mut Random| {
            let mut aabb = model.bodies[&ids[which]].aabb;
            for axis in 0..2 {
                let way = most * (random.unit() - 0.5);
                aabb.min[axis] += way;
                aabb.max[axis] += way;
            }
            world.set(ids[which], aabb).unwrap();
            model.set(ids[which], aabb);
        };
        // The same few bodies move all the time; now and then another one, none for a while, or all.
        let movers = if step % 230 == 229 { ids.len() } else { 20 };
        if step / 20 % 10 != 9 {
            (0..movers).for_each(|which| shove(which, 0.01, &mut random));
        }
        let any = random.below(ids.len());
        match random.below(10) {
            0 => shove(any, 0.01, &mut random),
            1 => shove(any, 2.0, &mut random),
            2 => {
                let filter = filters[random.below(filters.len())];
                world.set_filter(ids[any], filter).unwrap();
                model.set_filter(ids[any], filter);
            }
            3 => {
                world.remove(ids[any]).unwrap();
                model.remove(ids[any]);
                let aabb = draw(&mut random);
                ids[any] = world.insert(aabb).unwrap();
                model.insert(ids[any], aabb, Filter::default());
            }
            5 => {
                let is_enabled = !model.bodies[&ids[any]].is_enabled;
                world.set_enabled(ids[any], is_enabled).unwrap();
                model.set_enabled(ids[any], is_enabled);
            }
            6 | 7 => {
                // Two bodies that touch, or any two.
                let near = model.pairs_of(ids[any]);
                let other = near.first().copied().unwrap_or(ids[random.below(ids.len())]);
                if ids.contains(&other) {
                    world.exclude_pair(ids[any], other).unwrap();
                    model.set_excluded(ids[any], other, true);
                }
            }
            8 => {
                if let Some(&[a, b]) = model.excluded.first() {
                    world.include_pair(b, a).unwrap();
                    model.set_excluded(a, b, false);
                }
            }
            4 if step % 50 == 0 => world = BroadPhase::from_snapshot(&world.snapshot()).unwrap(),
            _ => {}
        }
        assert_eq!(sorted(world.pairs_of(ids[any]).unwrap()), model.pairs_of(ids[any]), "{step}");
        let changes = world.update();
        let (begun, ended) = model.update();
        assert!(changes.begun().eq(begun), "{step}");
        assert!(changes.ended().eq(ended), "{step}");
        assert_eq!(sorted(world.pairs()), model.pairs, "{step}");
        let any = ids[random.below(ids.len())];
        assert_eq!(sorted(world.pairs_of(any).unwrap()), model.pairs_of(any), "{step}");
        assert_eq!(world.broken_invariant(), None, "{step}");
        let by_body = world.pairs_by_body();
        assert_eq!(by_body.values().len(), 2 * model.pairs.len(), "{step}");
        for &id in &ids {
            assert_eq!(by_body[id.slot() as usize], model.pairs_of(id), "{step}");
        }
    }
}

#[test]
fn sizes_may_differ_by_a_million_and_more() {
    let mut world = BroadPhase::<3>::new();
    let mut random = Random::new(5);
    let mut boxes = vec![];
    for index in 0..600 {
        let half = 10f32.powi(index % 12 - 9);
        let at: [f64; 3] = random.point();
        let at = at.map(|at| at as f32);
        boxes.push(Aabb::new(at.map(|at| at - half), at.map(|at| at + half)));
    }
    let ids = world.insert_many(&boxes, Filter::default()).unwrap();
    for _ in 0..40 {
        for aabb in boxes.iter_mut().step_by(13) {
            let way = (random.unit() as f32 - 0.5) * 0.01;
            for axis in 0..3 {
                aabb.min[axis] += way;
                aabb.max[axis] += way;
            }
        }
        world.set_many(&ids, &boxes).unwrap();
        world.update();
        let pairs = sweep_and_prune_scenes::brute_force(&boxes).unwrap();
        let expected = pairs.iter().map(|pair| pair.map(|index| ids[index as usize]));
        assert!(sorted(world.pairs()).into_iter().eq(expected));
    }
}

#[test]
fn a_heap_of_static_bodies_costs_no_pairs() {
    // 100,000 in one place would be five billion pairs.
    let heap = vec![Aabb::new([0.0, 0.0], [1.0, 1.0]); 100_000];
    let mut world = BroadPhase::<2>::new();
    world.insert_many(&heap, Filter::STATIC).unwrap();
    world.insert(Aabb::new([0.5, 0.5], [0.5, 0.5])).unwrap();
    assert_eq!(world.update().begun().len(), heap.len());
    let bytes = world.snapshot();
    assert_eq!(BroadPhase::<2>::from_snapshot(&bytes).unwrap().pairs().count(), heap.len());
}

#[test]
fn a_body_in_a_reused_slot_is_found_where_the_removed_body_was() {
    let mut world = BroadPhase::<2>::new();
    let [here, there] = [0.0, 5.0].map(|at| Aabb::new([at; 2], [at + 1.0; 2]));
    let first = world.insert(here).unwrap();
    world.update();
    world.remove(first).unwrap();
    world.update();
    let second = world.insert(there).unwrap();
    assert_eq!(world.queries().overlapping(&there).unwrap(), [second]);
    world.set_many(&[second], &[here]).unwrap();
    assert_eq!(world.queries().overlapping(&here).unwrap(), [second]);
    assert_eq!(world.queries().overlapping(&there).unwrap(), []);
}

#[test]
fn a_point_at_infinity_pairs_beside_bodies_of_the_largest_size() {
    let mut world = BroadPhase::<1, f64>::new();
    let wide = |shift: f64| Aabb::new([-8e307 + shift], [8e307 + shift]);
    let endless = world.insert(Aabb::new([0.0], [f64::INFINITY])).unwrap();
    let large: Vec<_> = (0..2).map(|_| world.insert(wide(0.0)).unwrap()).collect();
    let small: Vec<_> = (0..60)
        .map(|index| world.insert(Aabb::new([-f64::from(index) - 2.0], [-f64::from(index) - 1.5])))
        .map(Result::unwrap)
        .collect();
    world.update();
    for step in 1..4 {
        for &id in &large {
            world.set(id, wide(1e306 * f64::from(step))).unwrap();
        }
        for &id in &small {
            let Aabb { min: [min], max: [max] } = world.aabb(id).unwrap();
            world.set(id, Aabb::new([min - 0.01], [max - 0.01])).unwrap();
        }
        world.update();
    }
    let point = world.insert(Aabb::new([f64::INFINITY], [f64::INFINITY])).unwrap();
    assert!(world.update().begun().eq([[endless, point]]));
}

#[test]
fn queries_without_a_filter_find_bodies_that_pair_with_nothing() {
    let mut world = BroadPhase::<2>::new();
    let aabb = Aabb::new([0.0, 0.0], [1.0, 1.0]);
    let maskless = Filter::default().mask(0);
    let nameless = Filter::default().category(0);
    let ids = [maskless, nameless].map(|filter| world.insert_with(aabb, filter).unwrap());
    let queries = world.queries();
    assert_eq!(queries.overlapping(&aabb).unwrap(), ids);
    assert_eq!(queries.containing([0.5, 0.5]).unwrap(), ids);
    assert_eq!(queries.nearest([9.0, 9.0], 2, f64::INFINITY).unwrap().len(), 2);
    let ray = Cast::ray([-1.0, 0.5], [1.0, 0.0], 9.0);
    assert_eq!(queries.cast_all(&ray).unwrap().len(), 2);
    assert_eq!(queries.with_filter(Filter::ALL).overlapping(&aabb).unwrap(), []);
}

#[test]
fn the_header_of_a_snapshot_says_what_world_it_holds() {
    let info = SnapshotInfo::read(&BroadPhase::<3, f64>::new().snapshot()).unwrap();
    assert_eq!((info.dimensions, info.scalar_bytes), (3, 8));
    let truncated = Error::InvalidSnapshot(SnapshotFault::Truncated);
    assert_eq!(SnapshotInfo::read(b"SaP"), Err(truncated));
    let foreign = Error::InvalidSnapshot(SnapshotFault::Foreign);
    assert_eq!(SnapshotInfo::read(b"neither"), Err(foreign));
}

#[test]
fn negative_infinite_and_nan_margins_are_refused() {
    for bad in [-1.0, f32::INFINITY, f32::NAN] {
        let margin = Report::Fat { margin: bad, prediction: 0.0 };
        let prediction = Report::Fat { margin: 0.0, prediction: bad };
        for (option, report) in [("margin", margin), ("prediction", prediction)] {
            let world = BroadPhase::<2>::with_options(Options::default().report(report));
            let value = f64::from(bad).into();
            assert_eq!(world.map(|_| ()), Err(Error::InvalidOption { option, value }));
        }
    }
}

#[test]
fn a_fat_aabb_reaches_ahead_and_contains_its_body_at_the_edge_of_the_range() {
    let moved = |from, to| {
        let mut world = fat_world(1.0f32, 2.0);
        let id = world.insert(from).unwrap();
        world.update();
        world.set(id, to).unwrap();
        world.reported_aabb(id).unwrap()
    };
    let fat = moved(Aabb::new([-3.0, 3.0], [-2.0, 4.0]), Aabb::new([0.0, 0.0], [1.0, 1.0]));
    assert_eq!(fat, Aabb::new([-1.0, -7.0], [8.0, 2.0]));
    // By no more than 4 times the longest side and the margin together; further is a jump.
    let far = moved(Aabb::new([-8.0, 3.0], [-7.0, 4.0]), Aabb::new([0.0, 0.0], [1.0, 1.0]));
    assert_eq!(far, Aabb::new([-1.0, -7.0], [10.0, 2.0]));
    let jump = moved(Aabb::new([-8.5, 3.0], [-7.5, 4.0]), Aabb::new([0.0, 0.0], [1.0, 1.0]));
    assert_eq!(jump, Aabb::new([-1.0, -1.0], [2.0, 2.0]));

    let inf = f32::INFINITY;
    let far = Aabb::new([f32::MIN, inf], [f32::MAX, inf]);
    let fat = moved(Aabb::new([f32::MAX, -inf], [f32::MAX, inf]), far);
    assert!(fat.is_valid() && fat.contains(&far));
}

#[test]
fn queries_are_answered_by_a_shared_borrow_until_something_changes() {
    type Change = fn(&mut BroadPhase<2>, ProxyId);
    let place = Aabb::new([5.0, 5.0], [6.0, 6.0]);
    let changes: [Change; 6] = [
        |world, _| _ = world.insert(Aabb::new([5.0, 5.0], [6.0, 6.0])).unwrap(),
        |world, id| world.set(id, Aabb::new([5.0, 5.0], [6.0, 6.0])).unwrap(),
        |world, id| world.teleport(id, Aabb::new([5.0, 5.0], [6.0, 6.0])).unwrap(),
        |world, id| world.set_filter(id, Filter::STATIC).unwrap(),
        |world, id| {
            let aabb = world.aabb(id).unwrap();
            world.set_swept(id, aabb, Aabb::new([5.0, 5.0], [6.0, 6.0])).unwrap();
        },
        |world, _| world.shift([5.0, 5.0]).unwrap(),
    ];
    for change in changes {
        let mut world = BroadPhase::<2>::new();
        let ids = world.insert_many(&row(20), Filter::default()).unwrap();
        world.update();
        world.prepare_queries();
        assert!(world.prepared_queries().unwrap().containing([0.5, 0.5]).unwrap() == [ids[0]]);
        change(&mut world, ids[0]);
        assert!(world.prepared_queries().is_none());
        world.prepare_queries();
        let found = world.prepared_queries().unwrap().overlapping(&place).unwrap();
        assert_eq!(found, world.queries().overlapping(&place).unwrap());
        // Of a body that left nothing has to be prepared.
        world.remove(ids[0]).unwrap();
        let queries = world.prepared_queries().unwrap();
        assert!(!queries.overlapping(&row(1)[0]).unwrap().contains(&ids[0]));
    }
}

/// A world that reports the pairs of fat AABBs.
fn fat_world<const D: usize, T: sweep_and_prune::Scalar>(
    margin: T,
    prediction: T,
) -> BroadPhase<D, T> {
    let report = Report::Fat { margin, prediction };
    BroadPhase::with_options(Options::default().report(report)).unwrap()
}

/// Boxes of side 1 in a row, ten apart.
fn row(count: usize) -> Vec<Aabb<2>> {
    let at = |index: usize| 10.0 * index as f32;
    (0..count).map(|index| Aabb::new([at(index), 0.0], [at(index) + 1.0, 1.0])).collect()
}

#[test]
fn a_body_that_jumps_over_others_begins_no_pair_with_them() {
    for teleports in [false, true] {
        let mut world = fat_world(0.1, 2.0);
        let mut boxes = row(222);
        boxes[0] = Aabb::new([0.0, 0.0], [1.0, 1.0]);
        let ids = world.insert_many(&boxes, Filter::default()).unwrap();
        world.update();
        let next_to_the_last = Aabb::new([1109.5, 0.0], [1110.5, 1.0]);
        match teleports {
            false => world.set(ids[0], next_to_the_last).unwrap(),
            true => world.teleport(ids[0], next_to_the_last).unwrap(),
        }
        let changes = world.update();
        assert_eq!((changes.begun().len(), changes.ended().len()), (1, 0));
    }
}

#[test]
fn the_joints_of_a_chain_of_ten_thousand_are_excluded_included_and_forgotten() {
    let link = |at: usize| Aabb::new([at as f32, 0.0], [at as f32 + 1.0, 1.0]);
    let boxes: Vec<_> = (0..10_001).map(link).collect();
    let mut world = BroadPhase::<2>::new();
    let ids = world.insert_many(&boxes, Filter::default()).unwrap();
    for pair in ids.windows(2) {
        world.exclude_pair(pair[1], pair[0]).unwrap();
    }
    assert!(world.update().is_empty());
    for pair in ids.windows(2).step_by(2) {
        world.include_pair(pair[0], pair[1]).unwrap();
    }
    let restored = BroadPhase::<2>::from_snapshot(&world.snapshot()).unwrap();
    for mut world in [world, restored] {
        assert!(
            world.update().begun().eq(ids.windows(2).step_by(2).map(|pair| [pair[0], pair[1]]))
        );
        // All are forgotten with their bodies.
        world.clear();
        world.update();
        let new = world.insert_many(&boxes, Filter::default()).unwrap();
        assert_eq!(world.update().begun().count(), 10_000);
        assert!(!world.is_excluded(new[0], new[1]).unwrap());
        assert_eq!(world.exclude_pair(ids[0], new[1]).unwrap_err(), stale(0, ids[0]));
        assert_eq!(world.is_excluded(new[0], ids[1]).unwrap_err(), stale(1, ids[1]));
    }
}

fn stale(index: usize, id: ProxyId) -> Error {
    Error::StaleProxy { index, id: id.to_bits() }
}

#[test]
fn a_fat_aabb_is_replaced_if_its_body_stops_or_shrinks() {
    let mut world = fat_world::<1, f32>(0.1, 2.0);
    let id = world.insert(Aabb::new([0.0], [1.0])).unwrap();
    let wall = world.insert(Aabb::new([7.0], [8.0])).unwrap();
    world.update();
    world.set(id, Aabb::new([3.0], [4.0])).unwrap();
    assert!(world.update().begun().eq([[id, wall]]), "it reaches ahead");
    assert!(world.update().ended().eq([[id, wall]]), "it has stopped");
    assert_eq!(world.reported_aabb(id).unwrap(), Aabb::new([2.9], [4.1]));

    world.set(id, Aabb::new([-100.0], [100.0])).unwrap();
    assert_eq!(world.update().begun().len(), 1);
    world.set(id, Aabb::new([-1.0], [1.0])).unwrap();
    assert_eq!(world.update().ended().len(), 1);
    assert!(world.reported_aabb(id).unwrap().extents()[0] < 300.0);
}

#[test]
fn a_fat_aabb_depends_on_the_boxes_at_updates_alone() {
    let mut world = fat_world::<2, f32>(0.1, 2.0);
    let boxes = row(20);
    let ids = world.insert_many(&boxes, Filter::default()).unwrap();
    world.update();
    let fat = world.reported_aabb(ids[0]).unwrap();
    // A move that is taken back.
    world.set(ids[0], boxes[7]).unwrap();
    world.set(ids[0], boxes[0]).unwrap();
    assert_eq!(world.reported_aabb(ids[0]).unwrap(), fat);
    assert!(world.update().is_empty());
    // A move in one step, in two, and in two with a snapshot in between.
    let way = |by| Aabb::new([by, 0.0], [by + 1.0, 1.0]);
    let mut worlds = [world.clone(), world.clone(), world];
    worlds[0].set(ids[0], way(3.0)).unwrap();
    for (world, is_saved) in worlds[1..].iter_mut().zip([false, true]) {
        world.set(ids[0], way(1.5)).unwrap();
        if is_saved {
            *world = BroadPhase::from_snapshot(&world.snapshot()).unwrap();
        }
        world.set(ids[0], way(3.0)).unwrap();
    }
    let hashes = worlds.each_mut().map(|world| {
        world.update();
        world.state_hash()
    });
    assert_eq!(hashes, [hashes[0]; 3]);
}

#[test]
fn a_shift_of_the_origin_reports_nothing() {
    for report in [Report::Exact, Report::Fat { margin: 0.25, prediction: 2.0 }] {
        let mut world = BroadPhase::with_options(Options::default().report(report)).unwrap();
        let mut boxes = row(20_000);
        boxes[1] = boxes[0];
        let ids = world.insert_many(&boxes, Filter::default()).unwrap();
        let swept = world.insert(boxes[7]).unwrap();
        world.update();
        // Powers of two, so that nothing is rounded.
        for offset in [[-65536.0, 512.0], [-1024.0, 0.0]] {
            world.shift(offset).unwrap();
        }
        let here = world.aabb(ids[7]).unwrap();
        world.set_swept(swept, here, here).unwrap();
        world.shift([66560.0, -512.0]).unwrap();
        world.shift([-4096.0, 0.0]).unwrap();
        let changes = world.update();
        assert_eq!((changes.begun().len(), changes.ended().len()), (0, 0), "{report:?}");
        assert_eq!(world.aabb(ids[0]).unwrap(), Aabb::new([-4096.0, 0.0], [-4095.0, 1.0]));
        let [fat, aabb] = [world.reported_aabb(ids[9]), world.aabb(ids[9])].map(Result::unwrap);
        let margin = if report == Report::Exact { 0.0 } else { 0.25 };
        assert_eq!(aabb.min[0] - fat.min[0], margin);
        assert_eq!(world.aabb(swept).unwrap().min[0], 70.0 - 4096.0);
        assert_eq!(world.queries().containing([-4095.5, 0.5]).unwrap(), [ids[0], ids[1]]);
    }
}

#[test]
fn a_pair_that_begins_and_ends_between_two_updates_is_not_reported() {
    let mut world = BroadPhase::<1>::new();
    let a = world.insert(Aabb::new([0.0], [1.0])).unwrap();
    let b = world.insert(Aabb::new([5.0], [6.0])).unwrap();
    world.update();
    world.set(b, Aabb::new([0.0], [1.0])).unwrap();
    world.set(b, Aabb::new([5.0], [6.0])).unwrap();
    assert!(world.update().is_empty());
    let c = world.insert(Aabb::new([0.0], [1.0])).unwrap();
    world.remove(c).unwrap();
    assert!(world.update().is_empty());
    assert!(world.pairs_of(a).unwrap().next().is_none());
}

#[test]
fn changes_keep_the_ids_of_removed_bodies_when_their_slots_are_reused() {
    let mut world = BroadPhase::<1>::new();
    let ids = [0.0, 0.5].map(|at| world.insert(Aabb::new([at], [at + 1.0])).unwrap());
    world.update();
    world.remove(ids[0]).unwrap();
    world.update();
    let new = world.insert(Aabb::new([0.0], [1.0])).unwrap();
    assert_eq!(new.slot(), ids[0].slot());
    assert!(world.changes().ended().eq([ids]));
    assert_eq!(world.changes().begun().len(), 0);
}

#[test]
fn a_slot_is_not_reused_until_its_ended_pairs_were_reported() {
    let mut world = BroadPhase::<1>::new();
    let a = world.insert(Aabb::new([0.0], [1.0])).unwrap();
    let b = world.insert(Aabb::new([0.0], [1.0])).unwrap();
    world.update();
    world.remove(b).unwrap();
    let c = world.insert(Aabb::new([0.0], [1.0])).unwrap();
    assert_ne!(c.slot(), b.slot());
    let changes = world.update();
    assert!(changes.ended().eq([[a, b]]) && changes.begun().eq([[a, c]]));
    let d = world.insert(Aabb::new([9.0], [9.0])).unwrap();
    assert_eq!((d.slot(), d.generation()), (b.slot(), b.generation() + 1));
    assert!(!world.contains(b));
}

#[test]
fn snapshots_of_other_worlds_and_other_files_are_refused_with_the_reason() {
    let mut world = BroadPhase::<2>::new();
    world.insert(Aabb::new([0.0, 0.0], [1.0, 1.0])).unwrap();
    let bytes = world.snapshot();
    let fault = |bytes: &[u8]| match BroadPhase::<2>::from_snapshot(bytes) {
        Err(Error::InvalidSnapshot(fault)) => fault,
        other => panic!("{other:?}"),
    };
    assert_eq!(fault(b"PNG and more"), SnapshotFault::Foreign);
    assert_eq!(fault(&[]), SnapshotFault::Truncated);
    let mut newer = bytes.clone();
    newer[4] = 9;
    assert_eq!(fault(&newer), SnapshotFault::Version { found: 9 });
    for cut in 0..bytes.len() {
        assert_eq!(fault(&bytes[..cut]), SnapshotFault::Truncated, "cut to {cut}");
    }
    let longer: Vec<u8> = bytes.iter().copied().chain([0]).collect();
    assert_eq!(fault(&longer), SnapshotFault::Corrupt);
    let other =
        Err(Error::InvalidSnapshot(SnapshotFault::OtherWorld { dimensions: 2, scalar_bytes: 4 }));
    assert_eq!(BroadPhase::<3>::from_snapshot(&bytes).map(|_| ()), other);
    assert_eq!(BroadPhase::<2, f64>::from_snapshot(&bytes).map(|_| ()), other);
}

#[test]
fn swept_boxes_find_what_a_jump_passes_over() {
    let mut world = BroadPhase::<1>::new();
    let wall = world.insert(Aabb::new([5.0], [5.5])).unwrap();
    let bullet = world.insert(Aabb::new([0.0], [0.25])).unwrap();
    world.update();
    let (from, to) = (Aabb::new([0.0], [0.25]), Aabb::new([9.0], [9.25]));
    world.set_swept(bullet, from, to).unwrap();
    assert_eq!(world.aabb(bullet).unwrap(), Aabb::new([0.0], [9.25]));
    assert!(world.update().begun().eq([[wall, bullet]]));
    assert_eq!(world.aabb(bullet).unwrap(), to);
    assert!(world.update().ended().eq([[wall, bullet]]));
}

#[test]
fn groups_decide_over_masks_and_static_over_groups() {
    let none = Filter::default().mask(0);
    let joined = none.group(3);
    let apart = Filter::default().group(-3);
    assert!(!none.allows(&none));
    assert!(joined.allows(&joined));
    assert!(!apart.allows(&apart));
    assert!(apart.allows(&Filter::default()));
    let fixed = joined.is_static(true);
    assert!(!fixed.allows(&fixed) && fixed.allows(&joined));
}

#[test]
fn an_id_survives_conversion_to_a_number_and_back() {
    let bits = u64::from(u32::MAX) << 32 | 7;
    let id = ProxyId::from_bits(bits);
    assert_eq!((id.to_bits(), id.slot()), (bits, 7));
}

/// Found by `fuzz/` (seed 2001): the tree that queries use held the body, with the box that it had before.
#[test]
fn a_new_body_that_is_queried_moved_and_removed_begins_no_pair() {
    let mut world = BroadPhase::<1>::new();
    let row: Vec<_> =
        (0..200).map(|i| Aabb::new([i as f32 * 3.0], [i as f32 * 3.0 + 1.0])).collect();
    let ids = world.insert_many(&row, Filter::default()).unwrap();
    world.update();
    let new = world.insert(Aabb::new([1000.0], [1001.0])).unwrap();
    let place = Aabb::new([999.0], [1004.0]);
    assert_eq!(world.queries().overlapping(&place).unwrap(), [new]);
    world.set(new, Aabb::new([1002.0], [1003.0])).unwrap();
    world.remove(new).unwrap();
    world.update();
    world.set(ids[0], place).unwrap();
    assert_eq!(world.update().begun().count(), 0);
}

/// Far more bodies than in the sequences of `fuzz/`, each added to the tree by itself: its inner nodes split and shrink.
#[test]
fn thousands_of_bodies_that_come_and_go_between_queries_are_found() {
    let mut random = Random::new(8);
    let mut draw = || {
        let at: [f64; 2] = random.point();
        let at = at.map(|at| at as f32);
        (Aabb::new(at, at.map(|at| at + 0.02)), random.below(1 << 30))
    };
    let (mut world, mut bodies) = (BroadPhase::<2>::new(), vec![]);
    for step in 0..6000 {
        let (aabb, number) = draw();
        // They become many, and few again.
        let inserts = if step < 4000 { 6 } else { 1 };
        match number % 10 {
            kind if bodies.is_empty() || kind < inserts => {
                bodies.push((world.insert(aabb).unwrap(), aabb));
            }
            6 | 7 => {
                let which = number % bodies.len();
                world.set(bodies[which].0, aabb).unwrap();
                bodies[which].1 = aabb;
            }
            _ => world.remove(bodies.swap_remove(number % bodies.len()).0).unwrap(),
        }
        if step == 5000 {
            world.update();
        }
        // The tree learns of each change by itself.
        let found = world.queries().overlapping(&aabb).unwrap();
        if step % 20 == 0 {
            let expected = bodies.iter().filter(|(_, other)| other.overlaps(&aabb));
            assert_eq!(found, sorted(expected.map(|&(id, _)| id)), "{step}");
        }
    }
}

/// One query for every fourth body is answered at once, a few hundred are answered one by one. After two such calls the bodies are
/// sorted.
#[test]
fn thousands_of_queries_at_once_find_what_each_finds_alone() {
    for report in [Report::Exact, Report::Fat { margin: 0.01, prediction: 1.0 }] {
        let mut world = BroadPhase::<2>::with_options(Options::default().report(report)).unwrap();
        let mut random = Random::new(9);
        let mut draw = |size: f64| {
            // On a lattice, so that many touch.
            let min: [f64; 2] = random.point().map(|at: f64| (at * 256.0).floor() / 256.0);
            let max = min.map(|at| at + (random.unit() * size * 4.0).floor() / 1024.0);
            Aabb::new(min.map(|at| at as f32), max.map(|at| at as f32))
        };
        let boxes: Vec<_> = (0..40_000).map(|_| draw(4.0)).collect();
        let filter = |at: usize| Filter::default().category(1 << (at % 3));
        let mut bodies: Vec<_> = (0..boxes.len())
            .map(|at| (world.insert_with(boxes[at], filter(at)).unwrap(), boxes[at], at))
            .collect();
        world.update();
        // Free slots, slots with a new body, and bodies that moved.
        for at in (0..1000).map(|at| at * 7) {
            world.remove(bodies[at].0).unwrap();
        }
        bodies.retain(|&(.., at)| at % 7 != 0 || at >= 7000);
        world.update();
        for at in 0..500 {
            let aabb = draw(4.0);
            bodies.push((world.insert_with(aabb, filter(at)).unwrap(), aabb, at));
            bodies[at].1 = draw(50.0);
            world.set(bodies[at].0, bodies[at].1).unwrap();
        }
        let areas: Vec<_> = (0..10_500).map(|_| draw(8.0)).collect();
        for round in 0..3 {
            if round == 2 {
                // Few enough that what is sorted is still of use: some leave, some come, some move.
                for _ in 0..300 {
                    world.remove(bodies.pop().unwrap().0).unwrap();
                }
                for at in 0..600 {
                    let aabb = draw(20.0);
                    bodies.push((world.insert_with(aabb, filter(at)).unwrap(), aabb, at));
                    bodies[at * 7].1 = draw(20.0);
                    world.set(bodies[at * 7].0, bodies[at * 7].1).unwrap();
                }
            }
            check_queries_at_once(&world.queries(), &bodies, &areas);
        }
    }
}

/// Bodies: id, box, and a number that says the category.
fn check_queries_at_once(
    queries: &Queries<'_, 2, f32>,
    bodies: &[(ProxyId, Aabb<2>, usize)],
    areas: &[Aabb<2>],
) {
    let points: Vec<_> = areas.iter().map(|area| area.min).collect();
    let asked = Filter::default().mask(0b11);
    let is_odd = |id: ProxyId| id.slot() % 2 == 1;
    let kinds = [*queries, queries.unsorted(), queries.with_filter(asked).with_predicate(&is_odd)];
    for (kind, queries) in kinds.into_iter().enumerate() {
        let (mut all, mut some) = (Lists::new(), Lists::new());
        for are_points in [false, true] {
            let ask = |range: Range<usize>, lists: &mut Lists<ProxyId>| {
                if are_points {
                    queries.containing_many(&points[range], lists).unwrap();
                } else {
                    queries.overlapping_many(&areas[range], lists).unwrap();
                }
            };
            ask(0..areas.len(), &mut all);
            assert_eq!(all.len(), areas.len());
            for start in (0..areas.len()).step_by(500) {
                ask(start..start + 500, &mut some);
                for (at, list) in some.iter().enumerate() {
                    let found = &all[start + at];
                    if kind == 1 {
                        assert_eq!(sorted(found.iter()), sorted(list.iter()));
                    } else {
                        assert_eq!(found, list);
                    }
                }
            }
            for at in (0..areas.len()).step_by(150) {
                let area = if are_points { Aabb::new(points[at], points[at]) } else { areas[at] };
                let expected = bodies.iter().filter(|&&(id, aabb, at)| {
                    aabb.overlaps(&area) && (kind < 2 || at % 3 < 2 && is_odd(id))
                });
                let expected = sorted(expected.map(|&(id, ..)| id));
                let found = sorted(all[at].iter().copied());
                assert_eq!(found, expected, "{kind} {are_points} {at}");
            }
        }
    }
}

/// Four bodies for each box that is asked about, of which one may be hidden in each way.
#[test]
fn queries_at_once_find_no_body_that_is_hidden() {
    const COUNT: usize = 1 << 15;
    let boxes: Vec<_> = (0..COUNT).map(|at| Aabb::new([at as f32], [at as f32 + 0.5])).collect();
    let areas: Vec<_> =
        (0..COUNT / 4).map(|at| Aabb::new([at as f32 * 4.0], [at as f32 * 4.0 + 3.0])).collect();
    let only = Filter::default().mask(1);
    let is_other = |id: ProxyId| id.slot() != 9;
    let without = |world: &mut BroadPhase<1>, id| world.remove(id).unwrap();
    let refiltered = |world: &mut BroadPhase<1>, id| {
        world.set_filter(id, Filter::default().category(2)).unwrap()
    };
    let disabled = |world: &mut BroadPhase<1>, id| world.set_enabled(id, false).unwrap();
    let nothing = |_: &mut BroadPhase<1>, _| ();
    for (way, hide) in [
        ("none", nothing as fn(&mut BroadPhase<1>, ProxyId)),
        ("removed", without),
        ("another filter", refiltered),
        ("disabled", disabled),
        ("not wanted", nothing),
        ("all filtered out", nothing),
    ] {
        let mut world = BroadPhase::<1>::new();
        let ids = world.insert_many(&boxes, Filter::default()).unwrap();
        world.update();
        hide(&mut world, ids[9]);
        let queries = match way {
            "not wanted" => world.queries().with_predicate(&is_other),
            "all filtered out" => world.queries().with_filter(Filter::default().mask(2)),
            _ => world.queries().with_filter(only),
        };
        let mut lists = Lists::new();
        queries.overlapping_many(&areas, &mut lists).unwrap();
        for (at, list) in lists.iter().enumerate() {
            let near = ids[4 * at..4 * at + 4].iter().copied();
            let is_found = |id: &ProxyId| match way {
                "none" => true,
                "all filtered out" => false,
                _ => *id != ids[9],
            };
            assert!(list.iter().copied().eq(near.filter(is_found)), "{way}: {at}");
        }
    }
}

#[test]
fn changes_are_empty_only_if_nothing_began_and_nothing_ended() {
    let mut world = BroadPhase::<1>::new();
    let [a, _] = [0.0, 5.0].map(|at| world.insert(Aabb::new([at], [at + 1.0])).unwrap());
    assert!(world.update().is_empty());
    world.set(a, Aabb::new([5.0], [6.0])).unwrap();
    assert!(!world.update().is_empty(), "a pair began");
    assert!(world.update().is_empty());
    world.set(a, Aabb::new([0.0], [1.0])).unwrap();
    assert!(!world.update().is_empty(), "a pair ended");
}

#[test]
fn a_hit_at_the_start_is_at_zero_and_not_at_minus_zero() {
    let mut world = BroadPhase::<1>::new();
    world.insert(Aabb::new([0.0], [1.0])).unwrap();
    let back = Cast::ray([1.0f32], [-1.0], 9.0);
    let hit = world.queries().cast(&back).unwrap().unwrap();
    assert_eq!(hit.t.to_bits(), 0.0f64.to_bits());
}

/// A character stands on a floor of tiles beside a wall.
#[test]
fn a_cast_that_ignores_what_it_touches_walks_jumps_and_falls() {
    let mut world = BroadPhase::<2>::new();
    let tiles: Vec<_> =
        (0..9).map(|at| Aabb::new([at as f32, -1.0], [at as f32 + 1.0, 0.0])).collect();
    let tiles = world.insert_many(&tiles, Filter::default()).unwrap();
    let wall = world.insert(Aabb::new([6.0, 0.0], [7.0, 9.0])).unwrap();
    let hero = Aabb::new([2.25, 0.0], [3.0, 2.0]);
    let queries = world.queries();
    let hit = |way| queries.cast(&Cast::aabb(hero, way, 100.0).ignore_touching()).unwrap();
    let touched = |way| queries.cast(&Cast::aabb(hero, way, 100.0)).unwrap().unwrap();

    for way in [[0.0, 1.0], [1.0, 0.0], [-1.0, 0.0], [0.0, -1.0], [0.3, 0.2]] {
        let Hit { id, t, normal, starts_inside, .. } = touched(way);
        assert_eq!((id, t, normal, starts_inside), (tiles[2], 0.0, [0.0, 1.0], false), "{way:?}");
    }
    assert_eq!(hit([0.0, 1.0]), None);
    assert_eq!(hit([-1.0, 0.0]), None);
    let walks = hit([0.5, 0.0]).unwrap();
    assert_eq!((walks.id, walks.t, walks.normal), (wall, 6.0, [-1.0, 0.0]));
    let falls = hit([0.0, -1.0]).unwrap();
    assert_eq!((falls.id, falls.t, falls.normal), (tiles[2], 0.0, [0.0, 1.0]));
    // Up to the wall and no further: it touches the wall, and does not enter it.
    let up_to = |limit| queries.cast(&Cast::aabb(hero, [1.0, 0.0], limit).ignore_touching());
    assert_eq!(up_to(3.0).unwrap(), None);
    assert_eq!(up_to(3.1).unwrap().map(|hit| hit.id), Some(wall));
    // Inside a body it is hit at once, with no face.
    let stuck = Cast::aabb(Aabb::new([5.5, 1.0], [6.5, 2.0]), [0.0, 1.0], 100.0).ignore_touching();
    let stuck = queries.cast(&stuck).unwrap().unwrap();
    assert_eq!(
        (stuck.id, stuck.t, stuck.normal, stuck.starts_inside),
        (wall, 0.0, [0.0, 0.0], true)
    );
}

/// A wall without thickness stops a ray all the same.
#[test]
fn a_ray_that_ignores_what_it_touches_is_stopped_by_a_flat_wall() {
    let mut world = BroadPhase::<2>::new();
    let flat = world.insert(Aabb::new([5.0, 0.0], [5.0, 9.0])).unwrap();
    let queries = world.queries();
    let hit = |origin, way| queries.cast(&Cast::ray(origin, way, 100.0).ignore_touching()).unwrap();
    let stopped = hit([1.0, 1.0], [1.0, 0.0]).unwrap();
    assert_eq!((stopped.id, stopped.t, stopped.normal), (flat, 4.0, [-1.0, 0.0]));
    let back = hit([9.0, 1.0], [-2.0, 0.0]).unwrap();
    assert_eq!((back.t, back.normal), (2.0, [1.0, 0.0]));
    // It grazes the end of the wall.
    assert_eq!(hit([1.0, 9.0], [1.0, 0.0]), None);
}

#[test]
fn queries_find_only_what_their_predicate_accepts() {
    let mut world = BroadPhase::<1>::new();
    let boxes: Vec<_> = (0..4).map(|at| Aabb::new([at as f32], [at as f32 + 1.0])).collect();
    let ids = world.insert_many(&boxes, Filter::default()).unwrap();
    let stale = ids[3];
    world.remove(stale).unwrap();
    let reused = world.insert(boxes[3]).unwrap();
    let without = [ids[0], ids[2], stale];
    let is_wanted = |id| !without.contains(&id);
    let queries = world.queries().with_predicate(&is_wanted);
    assert_eq!(queries.overlapping(&Aabb::new([-9.0], [9.0])).unwrap(), [ids[1], reused]);
    assert_eq!(queries.nearest([0.0], 1, f64::INFINITY).unwrap()[0].id, ids[1]);
    let hits = queries.cast_all(&Cast::ray([0.5], [1.0], 9.0)).unwrap();
    assert_eq!(hits.iter().map(|hit| hit.id).collect::<Vec<_>>(), [ids[1], reused]);
    assert_eq!(queries.containing([1.0]).unwrap(), [ids[1]]);
    assert_eq!(queries.within([0.0], 1.0).unwrap(), [ids[1]]);
    let mut seen = vec![];
    let visit = |id| {
        seen.push(id);
        std::ops::ControlFlow::Continue(())
    };
    queries.visit_overlapping(&Aabb::new([0.0], [1.0]), visit).unwrap();
    assert_eq!(seen, [ids[1]]);
    // The last predicate counts, and none is asked about a body that the filter hides.
    let panics = |_| unreachable!("the filter hides all bodies");
    let hidden = queries.with_predicate(&panics).with_filter(Filter::ALL.mask(0));
    assert_eq!(hidden.overlapping(&Aabb::new([-9.0], [9.0])).unwrap(), []);
}

#[test]
fn ids_print_as_slot_and_generation() {
    let mut world = BroadPhase::<1>::new();
    let aabb = Aabb::new([0.0], [1.0]);
    let ids = [world.insert(aabb).unwrap(), world.insert(aabb).unwrap()];
    world.remove(ids[1]).unwrap();
    world.update();
    let again = world.insert(aabb).unwrap();
    assert_eq!(format!("{} {} {again}", ids[0], ids[1]), "0v1 1v1 1v2");
}
