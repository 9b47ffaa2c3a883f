//! A broad phase in a steady state does not allocate, and one that is never updated does not grow.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use sweep_and_prune::{Aabb, BroadPhase, Cast, Filter, Lists, ProxyId};
use sweep_and_prune_scenes::Motion;

/// The system's allocator, which counts the calls and bytes of the current thread.
struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
    static BYTES: Cell<isize> = const { Cell::new(0) };
}

fn count(allocations: usize, freed: usize, allocated: usize) {
    // A thread that is ending has no counter any more, and no test.
    let _ = ALLOCATIONS.try_with(|count| count.set(count.get() + allocations));
    let _ = BYTES.try_with(|bytes| bytes.set(bytes.get() + allocated as isize - freed as isize));
}

// SAFETY: every call is passed on to the system's allocator as it came; counting neither
// allocates nor unwinds.
#[allow(unsafe_code, reason = "an allocator can be replaced in no other way")]
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(1, 0, layout.size());
        // SAFETY: as required of our caller.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count(0, layout.size(), 0);
        // SAFETY: as required of our caller.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(1, layout.size(), size);
        // SAFETY: as required of our caller.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

const BODIES: usize = 10_000;
const UPDATES: usize = if cfg!(debug_assertions) { 300 } else { 1000 };
const WARM_UP: usize = 100;

/// The number of the last update that allocated, calls that move bodies counted in.
fn last_allocation(motion: Motion) -> usize {
    let mut moving = motion.start::<3, f32>(BODIES, 1).unwrap();
    let mut world = BroadPhase::<3>::new();
    let ids: Vec<ProxyId> = world.insert_many(moving.boxes(), Filter::default()).unwrap();
    let mut last = 0;
    for update in 1..=UPDATES {
        moving.advance();
        let before = ALLOCATIONS.get();
        world.set_many(&ids, moving.boxes()).unwrap();
        let changes = world.update();
        assert!(update == 1 || changes.begun().len() + changes.ended().len() > 0);
        if ALLOCATIONS.get() > before {
            last = update;
        }
    }
    last
}

#[test]
fn drifting_bodies_cost_no_allocation_after_the_first_hundred_updates() {
    let last = last_allocation(Motion::Drift);
    assert!(last <= WARM_UP, "update {last} allocated");
}

#[test]
fn flying_bodies_cost_no_allocation_after_the_first_hundred_updates() {
    let last = last_allocation(Motion::Fast);
    assert!(last <= WARM_UP, "update {last} allocated");
}

#[test]
fn mostly_still_bodies_cost_no_allocation_after_the_first_hundred_updates() {
    let last = last_allocation(Motion::MostlyStill);
    assert!(last <= WARM_UP, "update {last} allocated");
}

#[test]
fn teleporting_bodies_cost_no_allocation_after_the_first_hundred_updates() {
    let last = last_allocation(Motion::Teleport);
    assert!(last <= WARM_UP, "update {last} allocated");
}

/// How many bytes 20,000 calls of `edit` add to the memory of a world of 100 bodies, after 1,000 calls.
fn growth(mut edit: impl FnMut(&mut BroadPhase<2>, &[ProxyId], usize)) -> isize {
    let mut world = BroadPhase::<2>::new();
    let boxes: Vec<_> = (0..100).map(|index| aabb(index as f32)).collect();
    let ids = world.insert_many(&boxes, Filter::default()).unwrap();
    world.update();
    (0..1000).for_each(|call| edit(&mut world, &ids, call));
    let before = BYTES.get();
    (1000..21_000).for_each(|call| edit(&mut world, &ids, call));
    BYTES.get() - before
}

fn aabb(at: f32) -> Aabb<2> {
    Aabb::new([at, at], [at + 1.0, at + 1.0])
}

const FEW_BYTES: isize = 4096;

#[test]
fn inserting_and_removing_without_updates_takes_no_memory() {
    let grown = growth(|world, _, call| {
        let id = world.insert(aabb(call as f32)).unwrap();
        if call % 3 == 0 {
            assert!(!world.queries().overlapping(&aabb(call as f32)).unwrap().is_empty());
        }
        world.remove(id).unwrap();
        assert!(!world.contains(id));
    });
    assert!(grown < FEW_BYTES, "{grown}");
}

#[test]
fn moving_and_querying_without_updates_takes_no_memory() {
    let grown = growth(|world, ids, call| {
        let (id, area) = (ids[call % ids.len()], aabb((call * 7 % 1000) as f32));
        world.set(id, area).unwrap();
        assert!(world.queries().overlapping(&area).unwrap().contains(&id));
    });
    assert!(grown < FEW_BYTES, "{grown}");
}

#[test]
fn sweeping_without_updates_takes_no_memory() {
    let grown = growth(|world, ids, call| {
        let id = ids[call % ids.len()];
        world.set_swept(id, aabb(0.0), aabb(call as f32)).unwrap();
        world.set(id, aabb(1.0)).unwrap();
    });
    assert!(grown < FEW_BYTES, "{grown}");
}

#[test]
fn saving_and_restoring_by_clone_from_allocates_nothing_and_continues_bit_for_bit() {
    for motion in Motion::ALL {
        let mut moving = motion.start::<3, f32>(2_000, 1).unwrap();
        let mut world = BroadPhase::<3>::new();
        let filter = Filter::default();
        let ids: Vec<ProxyId> = world.insert_many(moving.boxes(), filter).unwrap();
        let mut step = |world: &mut BroadPhase<3>| {
            moving.advance();
            world.set_many(&ids, moving.boxes()).unwrap();
            world.update();
            moving.boxes().to_vec()
        };
        (0..80).for_each(|_| _ = step(&mut world));
        // Of all states that a world goes through: with a tree, without one, while one is built.
        world.prepare_queries();
        world.update();
        let (mut saved, mut other) = (world.clone(), BroadPhase::new());
        saved.clone_from(&world);
        let before = ALLOCATIONS.get();
        saved.clone_from(&world);
        assert_eq!(ALLOCATIONS.get(), before, "{}", motion.name());
        let frames: Vec<_> = (0..20).map(|_| step(&mut world)).collect();
        let expected = world.state_hash();
        world.clone_from(&saved);
        other.clone_from(&saved);
        for mut again in [world, other] {
            assert_eq!(again.state_hash(), saved.state_hash());
            assert!(again.pairs().eq(saved.pairs()));
            for frame in &frames {
                again.set_many(&ids, frame).unwrap();
                again.update();
            }
            assert_eq!(again.state_hash(), expected, "{}", motion.name());
        }
    }
}

#[test]
fn queries_to_lists_that_are_kept_allocate_nothing() {
    let mut world = BroadPhase::<2>::new();
    let boxes: Vec<_> = (0..100).map(|index| aabb(index as f32)).collect();
    world.insert_many(&boxes, Filter::default()).unwrap();
    let (mut ids, mut near) = (Lists::new(), Lists::new());
    let (mut hit, mut hits) = (vec![], Lists::new());
    let casts = [Cast::ray([-1.0, -1.0], [1.0, 1.0], 200.0), Cast::ray([-1.0; 2], [1.0; 2], 60.0)];
    let queries = world.queries();
    for frame in 0..3 {
        let before = ALLOCATIONS.get();
        queries.overlapping_many(&boxes[..50], &mut ids).unwrap();
        queries.containing_many(&[[1.0, 1.0], [0.5, 0.5]], &mut ids).unwrap();
        queries.within_many(&[([50.0, 50.0], 40.0)], &mut ids).unwrap();
        queries.nearest_many(&[[50.0, 50.0], [0.0, 9.0]], 30, 100.0, &mut near).unwrap();
        queries.cast_many(&casts, &mut hit).unwrap();
        queries.cast_all_many(&casts, &mut hits).unwrap();
        assert!(ids.values().len() > 40 && near.values().len() == 60);
        assert_eq!((hits[0].len(), hits[1].len()), (100, 60));
        assert!(frame == 0 || ALLOCATIONS.get() == before, "frame {frame} allocated");
    }
}

/// How many bytes a world takes before a crowd, at the update after all its bodies were at one place, and `later` updates
/// after that.
fn crowd(
    each: impl Fn(usize, usize) -> Aabb<2>,
    moving: usize,
    later: usize,
) -> ([isize; 3], BroadPhase<2>) {
    let count = 1_500;
    let at = |frame: usize| (0..count).map(|index| each(index, frame)).collect::<Vec<_>>();
    let begin = BYTES.get();
    let mut world = BroadPhase::<2>::new();
    let ids = world.insert_many(&at(0), Filter::default()).unwrap();
    let mut held = [0; 3];
    for frame in 0..20 + later {
        let boxes = at(frame);
        let moving = if frame < 20 { count } else { moving };
        world.set_many(&ids[..moving], &boxes[..moving]).unwrap();
        world.update();
        let taken =
            BYTES.get() - begin - size_of_val(&boxes[..]) as isize - size_of_val(&ids[..]) as isize;
        held[usize::from(frame > 8) + usize::from(frame > 20)] = taken;
    }
    (held, world)
}

#[test]
fn the_memory_of_a_crowd_is_given_back() {
    let apart = |index: usize| (2 * index) as f32;
    // All jump to one place and back; all come slowly and go; either way some move on, or none.
    let jump = |index: usize, frame: usize| {
        aabb(if (9..15).contains(&frame) { 0.0 } else { apart(index) })
    };
    let walk = |index: usize, frame: usize| {
        let way =
            [1.0, 0.5, 0.25, 0.1, 0.01, 0.001, 0.0][(12_usize.abs_diff(frame.min(18))).min(6)];
        aabb(apart(index) * if frame < 20 { 1.0 - way } else { 1.0 } + 0.1 * (frame % 3) as f32)
    };
    for moving in [0, 10, 1_500] {
        for (name, held) in
            [("jump", crowd(jump, moving, 130).0), ("walk", crowd(walk, moving, 130).0)]
        {
            let [before, spike, after] = held;
            assert!(spike > 10_000_000, "{name}: {spike} bytes prove little");
            // No list of 16,384 pairs is shrunk.
            assert!(
                after < before + 1_000_000,
                "{name}, {moving} move: {before}, {spike}, {after}"
            );
        }
    }
}

#[test]
fn shrinking_to_fit_gives_back_all_that_is_spare() {
    let jump = |index: usize, frame: usize| aabb(if frame < 20 { 0.0 } else { (2 * index) as f32 });
    let ([.., held], mut world) = crowd(jump, 1_500, 2);
    let (hash, before) = (world.state_hash(), BYTES.get());
    world.shrink_to_fit();
    let held_now = held - (before - BYTES.get());
    assert!(held > 10_000_000 && held_now < 200 * 1_500, "{held}, {held_now}");
    assert_eq!(world.state_hash(), hash);
    assert!(world.update().is_empty() && world.pairs().len() == 0);
}
