//! What an update may cost, whatever moves how: candidates are counted, and events compared with all pairs.

use alloc::vec::Vec;
use std::collections::BTreeSet;

use crate::world::bodies::flag;
use crate::world::policy::LOOK_UP;
use crate::{Aabb, BroadPhase, Filter, ProxyId, find_pairs, find_pairs_between};

/// A world, its bodies, and the pairs of the last update.
struct World<const D: usize> {
    world: BroadPhase<D, f32>,
    ids: Vec<ProxyId>,
    boxes: Vec<Aabb<D, f32>>,
    pairs: BTreeSet<[u32; 2]>,
}

impl<const D: usize> World<D> {
    fn new(boxes: Vec<Aabb<D, f32>>) -> Self {
        let mut world = BroadPhase::new();
        let ids = boxes.iter().map(|&aabb| world.insert(aabb).unwrap()).collect();
        let mut world = Self { world, ids, boxes, pairs: BTreeSet::new() };
        world.update();
        world
    }

    /// Moves each body by what `way` says of its position in the list, and updates. Returns the number of
    /// candidates.
    fn step(&mut self, way: impl Fn(usize) -> [f32; D]) -> usize {
        for (at, (aabb, &id)) in self.boxes.iter_mut().zip(&self.ids).enumerate() {
            let way = way(at);
            if way != [0.0; D] {
                for (axis, way) in way.into_iter().enumerate() {
                    aabb.min[axis] += way;
                    aabb.max[axis] += way;
                }
                self.world.set(id, *aabb).unwrap();
            }
        }
        self.update()
    }

    /// Updates, and checks the events. Returns the number of candidates.
    fn update(&mut self) -> usize {
        let changes = self.world.update();
        let found = find_pairs(&self.boxes).unwrap().into_iter();
        let pairs: BTreeSet<_> = found.map(|[a, b]| [a.min(b), a.max(b)]).collect();
        assert!(changes.begun().slots().iter().eq(pairs.difference(&self.pairs)));
        assert!(changes.ended().slots().iter().eq(self.pairs.difference(&pairs)));
        self.pairs = pairs;
        self.world.tracking.candidates.live().len()
    }
}

/// A number from 0 to 1 that looks random.
fn noise(at: usize) -> f32 {
    (at.wrapping_mul(0x9E37_79B9) as u32 >> 8) as f32 / (1 << 24) as f32
}

/// A box of these sides somewhere in a square or cube of this side.
fn somewhere<const D: usize>(at: usize, within: f32, sides: [f32; D]) -> Aabb<D, f32> {
    let min = core::array::from_fn(|axis| within * noise(7 + at * D + axis));
    Aabb::new(min, core::array::from_fn(|axis| min[axis] + sides[axis]))
}

#[test]
fn one_huge_body_that_moves_does_not_enlarge_the_others() {
    let count = 2_000;
    let mut boxes: Vec<_> =
        (0..count).map(|at| 2.0 * at as f32).map(|at| Aabb::new([at], [at + 1.0])).collect();
    boxes.push(Aabb::new([20_000.0], [30_000.0]));
    let mut world = World::new(boxes);
    for _ in 0..12 {
        let candidates = world.step(|_| [0.125]);
        assert!(candidates <= count, "{candidates}");
    }
    assert!(!world.world.tracking.policy.is_tight());

    let mut boxes: Vec<_> = (0..count).map(|at| somewhere(at, 15.0, [1.0; 3])).collect();
    boxes.push(Aabb::new([1e3; 3], [1e6; 3]));
    let mut world = World::new(boxes);
    for frame in 0..12 {
        let candidates = world.step(|at| [0.1 * (noise(at) - 0.5), 0.05, 0.0]);
        assert!(candidates <= 4 * (count + world.pairs.len()), "{frame}: {candidates}");
    }
    assert!(!world.world.tracking.policy.is_tight());
}

#[test]
fn a_restored_world_whose_bodies_jumped_has_the_candidates_of_its_last_update() {
    let count = 3_000;
    let mut world = World::new((0..count).map(|at| somewhere(at, 100.0, [1.0; 2])).collect());
    for (at, (aabb, &id)) in world.boxes.iter_mut().zip(&world.ids).enumerate() {
        *aabb = somewhere(count + at, 100.0, [1.0; 2]);
        world.world.set(id, *aabb).unwrap();
    }
    world.world = BroadPhase::from_snapshot(&world.world.snapshot()).unwrap();
    assert_eq!(world.world.tracking.candidates.live().len(), world.pairs.len());
    world.update();
}

#[test]
fn fat_aabbs_that_would_overlap_everything_are_not_made() {
    // Long and thin, and slow for their length: fat AABBs that last would be 600 times as thick.
    let count = 2_000;
    let thin = |at| somewhere(at, 10.0, [1.0, 0.001]);
    let mut world = World::new((0..count).map(thin).collect());
    let mut most = 0;
    for _ in 0..24 {
        most = most.max(world.step(|at| [0.0, 0.02 * noise(at)]));
    }
    assert!(world.world.tracking.policy.is_tight());
    assert!(most <= 2 * count, "{most}");
}

#[test]
fn a_few_bodies_that_would_have_too_many_candidates_cost_no_more_than_a_new_search() {
    // All rest but ten, and each of these is given a fat AABB that half of the others overlap.
    let count = 2_000;
    let mut boxes: Vec<_> = (0..count).map(|at| somewhere(at, 10.0, [0.001; 2])).collect();
    boxes.extend((0..10).map(|at| somewhere(count + at, 1.0, [20.0, 0.0001])));
    let mut world = World::new(boxes);
    let mut was_tight = false;
    for frame in 0..24 {
        let way = if frame % 2 == 0 { 0.5 } else { 0.6 };
        let candidates = world.step(|at| [0.0, if at < count { 0.0 } else { way }]);
        let tracking = &world.world.tracking;
        let gave_up = tracking.policy.is_tight() && !was_tight;
        was_tight |= gave_up;
        // What is done twice takes long enough: no tree is built as well.
        assert!(!gave_up || !tracking.tree.tree().is_being_built(), "{frame}");
        assert!(candidates <= 2 * count + 4 * world.pairs.len(), "{frame}: {candidates}");
    }
    assert!(was_tight);
}

#[test]
fn a_tree_is_built_over_several_updates_while_bodies_come_go_and_move() {
    let count = 2_000;
    let place = |at| somewhere(at, 50.0, [1.0; 2]);
    let mut world = World::new((0..count).map(place).collect());
    let mut unbuilt = 0;
    for frame in 0..24 {
        // One body jumps; another one goes, a third one takes its slot, and a fourth one comes.
        let jumping = 10 + frame;
        world.boxes[jumping] = place(2 * count + frame);
        world.world.set(world.ids[jumping], world.boxes[jumping]).unwrap();
        if frame % 2 == 0 {
            world.world.remove(world.ids[0]).unwrap();
            world.boxes[0] = Aabb::new([-9.0; 2], [-9.0; 2]);
        } else {
            world.boxes[0] = place(3 * count + frame);
            world.ids[0] = world.world.insert(world.boxes[0]).unwrap();
            world.boxes.push(place(4 * count + frame));
            world.ids.push(world.world.insert(*world.boxes.last().unwrap()).unwrap());
        }
        world.update();
        unbuilt += usize::from(!world.world.tracking.tree.is_built());
    }
    // The first one lists the bodies and cuts them once, the next three three times each: 2,000 go into 167 leaves.
    assert_eq!(unbuilt, 4);
    let tree = world.world.tracking.tree.tree();
    assert_eq!(tree.count, world.world.len());
    assert!((0..world.boxes.len() as u32).all(|body| tree.holds(body)));
}

#[test]
fn bodies_that_may_not_meet_are_not_searched_among_themselves() {
    // A fountain of bullets, some enemies, and a pool of bodies that are switched off at one place.
    let (bullets, enemies, pool) = (2_000, 50, 500);
    let bullet = Filter::default().category(2).mask(4);
    let mut world = BroadPhase::<2>::new();
    let at = |index: usize, frame: usize| {
        let way = if index.is_multiple_of(4) { 0.0 } else { 0.4 * frame as f32 };
        let place = [noise(index), noise(index * index)].map(|part| (part - 0.5) * way);
        Aabb::new(place, place.map(|at| at + 0.1))
    };
    let mut boxes: Vec<_> = (0..bullets).map(|index| at(index, 0)).collect();
    let ids = world.insert_many(&boxes, bullet).unwrap();
    let targets: Vec<_> = (0..enemies).map(|index| somewhere(index, 4.0, [0.1; 2])).collect();
    world.insert_many(&targets, Filter::default().category(4).mask(2)).unwrap();
    let off = world.insert_many(&boxes[..pool], Filter::default().mask(0)).unwrap();
    let mut known = BTreeSet::new();
    for frame in 0..40 {
        let moving = if frame < 20 { bullets } else { 20 };
        for (index, aabb) in boxes.iter_mut().enumerate().take(moving) {
            *aabb = at(index, frame);
        }
        world.set_many(&ids[..moving], &boxes[..moving]).unwrap();
        let parked = if frame < 30 { pool } else { 5 };
        world.set_many(&off[..parked], &std::vec![at(4 * frame, frame); parked]).unwrap();
        let changes = world.update();
        let found = find_pairs_between(&boxes, &targets).unwrap();
        let pairs: BTreeSet<_> = found.into_iter().map(|[a, b]| [a, b + bullets as u32]).collect();
        assert!(changes.begun().slots().iter().eq(pairs.difference(&known)));
        assert!(changes.ended().slots().iter().eq(known.difference(&pairs)));
        known = pairs;
        let tracking = &world.tracking;
        let most = 2 * (enemies + known.len());
        assert!(tracking.finder.found <= most, "{frame}: {} found", tracking.finder.found);
        assert!(tracking.candidates.live().len() <= most, "{frame}");
        // What a tree lists it lists before filters, but an update reads no more of it than there are bodies.
        assert!(tracking.scratch.found.len() <= world.len() + known.len(), "{frame}");
    }
    assert!(known.len() > 20, "{} pairs prove little", known.len());
}

#[test]
fn few_fast_bodies_among_many_at_rest_are_not_in_the_tree() {
    let (rest, fast) = (3_000, 100);
    let place = |at| somewhere(at, 90.0, [1.0; 2]);
    let mut world = World::new((0..rest + fast).map(place).collect());
    // To and fro, by more than a box at a time, and each at a speed of its own.
    let step = |frame: usize| {
        move |at: usize| {
            let way = if frame % 8 < 4 { 1.0 + noise(at) } else { -1.0 - noise(at) };
            if at < rest { [0.0; 2] } else { [way, way * (noise(at * at) - 0.5)] }
        }
    };
    for frame in 0..40 {
        world.step(step(frame));
    }
    let tracking = &world.world.tracking;
    assert_eq!((tracking.flying.len(), tracking.tree.tree().count), (fast, rest));
    let flies = |&index: &u32| world.world.bodies.slots.has(index, flag::FLYING);
    assert!(tracking.candidates.listed().iter().all(|pair| pair.iter().any(flies)));

    // A query finds all, and where queries are asked in each frame, bodies stay in the tree.
    for frame in 40..44 {
        let found = world.world.queries().overlapping(&Aabb::new([-999.0; 2], [999.0; 2])).unwrap();
        assert_eq!(found.len(), rest + fast);
        assert_eq!(world.world.tracking.flying.len(), 0);
        world.step(step(frame));
    }
    for frame in 44..48 {
        world.step(step(frame));
    }
    assert_eq!(world.world.tracking.flying.len(), fast);
    // Who leaves, and who rests, lands. One moves on, so that there is something to do.
    world.world.remove(world.ids[rest + 1]).unwrap();
    world.boxes[rest + 1] = Aabb::new([-9.0; 2], [-9.0; 2]);
    for frame in 48..56 {
        let way = step(frame)(rest + 2);
        world.step(|at| if at == rest + 2 { way } else { [0.0; 2] });
    }
    let tracking = &world.world.tracking;
    assert_eq!((tracking.flying.len(), tracking.tree.tree().count), (1, rest + fast - 2));
}

#[test]
fn bodies_that_flew_land_where_they_rest_whatever_else_is_looked_up() {
    // Some are fast, and then rest. As many others are slow as may be looked up in an update.
    let (side, fast, slow) = (40, 200, 25);
    let place = |at: usize| [at % side, at / side].map(|at| 1.5 * at as f32);
    let boxed = |at: usize| Aabb::new(place(at), place(at).map(|at| at + 1.0));
    let mut world = World::new((0..side * side).map(boxed).collect());
    let mut flying = Vec::new();
    for frame in 0..60 {
        let turn = if frame % 2 == 0 { 1.0 } else { -1.0 };
        world.step(|at| match at / 5 {
            nth if at % 5 == 0 && nth < fast && frame < 18 => [0.6 * turn, 0.6 * turn],
            nth if at % 5 == 2 && nth < slow => [0.28 * turn, 0.0],
            _ => [0.0; 2],
        });
        let all = |flags: &&u16| **flags & flag::FLYING != 0;
        flying.push(world.world.bodies.slots.flags.iter().filter(all).count());
    }
    assert!(flying[15] >= fast && flying[59] == 0, "{flying:?}");
    assert!(world.world.tracking.sleep.count > side * side / 2);
}

#[test]
fn where_some_fly_slow_bodies_fly_too_and_land_a_few_at_a_time() {
    // Of 5,500 bodies 500 move. Every other one of these is fast, and the others together leave fat AABBs that last four updates.
    let (side, count, moving) = (80, 5_500, 500);
    let place = |at: usize| [at % side, at / side].map(|at| 1.5 * at as f32);
    let boxed = |at: usize| Aabb::new(place(at), place(at).map(|at| at + 1.0));
    let mut world = World::new((0..count).map(boxed).collect());
    let mut most_flying = 0;
    for frame in 0..60 {
        let turn = if frame % 20 < 10 { 1.0 } else { -1.0 };
        let way = |at| if at % 22 == 0 { 0.5 } else { 0.25 + 0.01 * noise(at) };
        world.step(|at| if at % 11 == 0 { [turn * way(at), 0.0] } else { [0.0; 2] });
        let tracking = &world.world.tracking;
        if frame > 16 {
            // The finder never finds all candidates: then no body would fly, and the tree would have to be built again.
            assert!(tracking.tree.is_built(), "{frame}");
            let flags = world.world.bodies.slots.flags.iter();
            let flying = flags.filter(|&flags| flags & flag::FLYING != 0).count();
            let looked_up = tracking.scratch.queries.len() - flying;
            assert!(looked_up <= count / LOOK_UP, "{frame}: {looked_up}");
        }
        most_flying = most_flying.max(tracking.flying.len());
    }
    assert!((3 * moving / 4..=moving).contains(&most_flying), "{most_flying}");
}

#[test]
fn slow_bodies_that_move_in_turn_are_soon_tracked() {
    // Of 11,000 bodies 1,000 move, a quarter of them in each update: more leave their fat AABBs at first than are looked up.
    let (side, count) = (105, 11_000);
    let place = |at: usize| [at % side, at / side].map(|at| 1.5 * at as f32);
    let boxed = |at: usize| Aabb::new(place(at), place(at).map(|at| at + 1.0));
    let mut world = World::new((0..count).map(boxed).collect());
    for frame in 0..60 {
        let turn = if frame % 32 < 16 { 0.1 } else { -0.1 };
        let moves = |at: usize| at % 44 == 11 * (frame % 4);
        world.step(|at| if moves(at) { [turn, 0.0] } else { [0.0; 2] });
        let tracking = &world.world.tracking;
        assert!(frame < 30 || tracking.tree.is_fresh(), "{frame}");
        assert!(frame < 30 || !tracking.candidates.is_sorted(), "{frame}");
    }
}

#[test]
fn a_level_that_is_loaded_is_at_rest_in_the_next_update() {
    let statics = 6_000;
    let boxes: Vec<_> = (0..statics).map(|at| somewhere(at, 50.0, [1.0; 3])).collect();
    let mut world = BroadPhase::<3>::new();
    world.insert_many(&boxes, Filter::STATIC).unwrap();
    let movers: Vec<_> = (0..5_000).map(|at| somewhere(statics + at, 50.0, [1.0; 3])).collect();
    world.insert_many(&movers, Filter::default()).unwrap();
    assert!(world.update().begun().len() > 0);
    let tracking = &world.tracking;
    assert_eq!(tracking.sleep.count, statics);
    assert!(tracking.tree.is_fresh());
    let front = world.bodies.front;
    assert!(front < statics, "{front} bodies are read to find those that move");

    // Where fewer are static, the tree may not be needed.
    let mut world = BroadPhase::<3>::new();
    world.insert_many(&boxes[..statics / 2], Filter::STATIC).unwrap();
    world.insert_many(&movers, Filter::default()).unwrap();
    world.update();
    assert_eq!(world.tracking.sleep.count, 0);
    assert!(!world.tracking.tree.is_fresh());
}

#[test]
fn after_a_crowd_has_parted_fewer_bodies_are_looked_up() {
    // Forty crowds, each at one place, until some bodies in each update go where they are alone.
    let count = 2_000;
    let crowded = |at: usize| Aabb::new([(at % 40) as f32; 2], [(at % 40) as f32 + 0.5; 2]);
    let mut world = World::new((0..count).map(crowded).collect());
    let most = |world: &World<2>| world.world.tracking.policy.most_look_ups(0, count);
    assert!(most(&world) > 4 * (count / LOOK_UP));
    for frame in 0..100 {
        let goes = |at: usize| at / 20 == frame;
        world.step(|at| if goes(at) { [100.0 + at as f32, 0.0] } else { [0.0; 2] });
    }
    assert_eq!((world.pairs.len(), most(&world)), (0, count / LOOK_UP));
}
