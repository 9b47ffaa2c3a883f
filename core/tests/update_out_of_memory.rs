//! Updates whose pairs do not fit into memory: an allocator refuses all allocations above a size, which grows until the update
//! succeeds. Each time it fails the world is as before, and the next update finds what it should.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard};

use sweep_and_prune::{Aabb, BroadPhase, Error, Filter, Options, ProxyId, Report};
use sweep_and_prune_scenes::Random;

/// The system's allocator, which refuses what is larger than a limit.
struct Limited;

static LARGEST: AtomicUsize = AtomicUsize::new(usize::MAX);

fn is_refused(size: usize) -> bool {
    size > LARGEST.load(Ordering::Relaxed)
}

// SAFETY: every call is passed on to the system's allocator as it came, or refused as an allocator may.
#[allow(unsafe_code, reason = "an allocator can be replaced in no other way")]
unsafe impl GlobalAlloc for Limited {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if is_refused(layout.size()) {
            return std::ptr::null_mut();
        }
        // SAFETY: as required of our caller.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as required of our caller.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        if is_refused(size) {
            return std::ptr::null_mut();
        }
        // SAFETY: as required of our caller.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Limited = Limited;

/// The limit is that of the process, so one test runs at a time.
fn alone() -> MutexGuard<'static, ()> {
    static ALONE: Mutex<()> = Mutex::new(());
    ALONE.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// Updates without allocations above a size.
fn update_within(world: &mut BroadPhase<2>, bytes: usize) -> Result<(), Error> {
    LARGEST.store(bytes, Ordering::Relaxed);
    let result = world.try_update().map(|_| ());
    LARGEST.store(usize::MAX, Ordering::Relaxed);
    result
}

/// Bodies, more than fit into memory with all their pairs.
const BODIES: usize = 1000;
/// What a list of a few numbers for each body takes at most, and less than the pairs of a crowd.
const LEAST: usize = 1 << 18;

fn at(corner: [f64; 2], size: f32) -> Aabb<2> {
    let min = corner.map(|at| at as f32);
    Aabb::new(min, min.map(|at| at + size))
}

/// Bodies anywhere in a square in which few of them overlap.
fn spread(random: &mut Random, size: f32) -> Vec<Aabb<2>> {
    (0..BODIES).map(|_| at(random.point::<2>().map(|at| 60.0 * at), size)).collect()
}

type Events = [Vec<[ProxyId; 2]>; 2];

fn events(world: &BroadPhase<2>) -> Events {
    let changes = world.changes();
    [changes.begun().collect(), changes.ended().collect()]
}

/// Makes a change whose pairs need more and more memory than there is. Returns at how many sizes the update failed.
fn fails_cleanly(world: &BroadPhase<2>, edit: impl Fn(&mut BroadPhase<2>)) -> usize {
    let edited = || {
        let mut world = world.clone();
        edit(&mut world);
        world
    };
    let mut expected = edited();
    expected.update();
    let move_on = |world: &mut BroadPhase<2>| {
        let mut random = Random::new(9);
        for id in world.ids().collect::<Vec<_>>() {
            world.set(id, at(random.point::<2>().map(|at| 60.0 * at), 1.0)).unwrap();
        }
    };
    let mut apart = edited();
    move_on(&mut apart);
    apart.update();

    let (mut failures, mut bytes) = (0, LEAST);
    loop {
        let mut world = edited();
        let (hash, pairs) = (world.state_hash(), world.pairs().collect::<Vec<_>>());
        let boxes: Vec<_> = world.ids().map(|id| world.reported_aabb(id).unwrap()).collect();
        let result = update_within(&mut world, bytes);
        assert_eq!(world.broken_invariant(), None, "within {bytes} bytes: {result:?}");
        if result.is_ok() {
            assert!(events(&world) == events(&expected), "within {bytes} bytes");
            assert!(world.pairs().eq(expected.pairs()));
            return failures;
        }
        failures += 1;
        assert_eq!(result, Err(Error::OutOfMemory));
        assert_eq!(world.state_hash(), hash, "within {bytes} bytes");
        assert!(world.pairs().eq(pairs) && world.changes().is_empty(), "within {bytes} bytes");
        let reported = world.ids().map(|id| world.reported_aabb(id).unwrap());
        assert!(reported.zip(&boxes).all(|(now, before)| before.contains(&now)));
        // Fails again, and succeeds with enough memory.
        assert!(update_within(&mut world, LEAST).is_err());
        let mut other = world.clone();
        other.update();
        assert!(events(&other) == events(&expected), "after {bytes} bytes");
        assert_eq!(other.state_hash(), expected.state_hash(), "after {bytes} bytes");
        assert_eq!(other.broken_invariant(), None);
        // Or when the crowd is gone.
        move_on(&mut world);
        assert!(update_within(&mut world, LEAST).is_ok());
        assert!(events(&world) == events(&apart), "apart, after {bytes} bytes");
        assert_eq!(world.state_hash(), apart.state_hash());
        bytes += bytes / 3;
    }
}

/// All bodies at one place, and with them one that is new, one that left, and one that has another filter.
fn crowd(world: &mut BroadPhase<2>) {
    let ids: Vec<_> = world.ids().collect();
    for (index, &id) in ids.iter().enumerate() {
        world.set(id, at([0.0, index as f64 / 1e5], 1.0)).unwrap();
    }
    world.remove(ids[3]).unwrap();
    world.set_filter(ids[5], Filter::STATIC).unwrap();
    world.insert(at([0.5, 0.5], 1.0)).unwrap();
}

/// A world in which bodies move as far as `step` in each of some updates.
fn moving(options: Options<f32>, step: f32, updates: usize) -> BroadPhase<2> {
    let mut random = Random::new(3);
    let mut world = BroadPhase::with_options(options).unwrap();
    let ids = world.insert_many(&spread(&mut random, 1.0), Filter::default()).unwrap();
    for _ in 0..updates {
        for &id in &ids {
            let aabb = world.aabb(id).unwrap();
            let offset = random.point::<2>().map(|at| step * (at as f32 - 0.5));
            world.set(id, aabb.translate(offset)).unwrap();
        }
        world.update();
    }
    world
}

#[test]
fn a_crowd_of_new_bodies() {
    let _alone = alone();
    let failures = fails_cleanly(&BroadPhase::new(), |world| {
        world.insert_many(&[at([0.0, 0.0], 1.0); BODIES], Filter::default()).unwrap();
    });
    assert!(failures > 4, "{failures}");
}

/// Found from scratch after fast motion, and by candidates after slow motion.
#[test]
fn a_crowd_of_bodies_that_moved() {
    let _alone = alone();
    for (step, updates) in [(0.1, 12), (60.0, 12), (60.0, 2)] {
        let failures = fails_cleanly(&moving(Options::default(), step, updates), crowd);
        assert!(failures > 4, "{step}: {failures}");
    }
}

#[test]
fn a_crowd_of_fat_aabbs() {
    let _alone = alone();
    let report = Report::Fat { margin: 0.1, prediction: 2.0 };
    for step in [0.1, 10.0] {
        let world = moving(Options::default().report(report), step, 8);
        let failures = fails_cleanly(&world, crowd);
        assert!(failures > 4, "{step}: {failures}");
    }
}

/// With filters bodies are searched in sets, and their pairs are copied.
#[test]
fn a_crowd_with_filters() {
    let _alone = alone();
    let mut world = moving(Options::default(), 0.1, 4);
    for (index, id) in world.ids().collect::<Vec<_>>().into_iter().enumerate() {
        world.set_filter(id, Filter::default().category(1 << (index % 3))).unwrap();
    }
    world.update();
    let failures = fails_cleanly(&world, crowd);
    assert!(failures > 4, "{failures}");
}

#[cfg(feature = "parallel")]
#[test]
fn a_crowd_found_by_threads() {
    let _alone = alone();
    let world = moving(Options::default(), 60.0, 12).threads(4);
    let failures = fails_cleanly(&world, crowd);
    assert!(failures > 4, "{failures}");
}

/// Bodies that come to one place, `at_once` at a time. Where an update fails these go back, and some move a little, then all.
fn grows(at_once: usize) {
    let mut world = moving(Options::default(), 0.1, 12);
    let ids: Vec<_> = world.ids().collect();
    let mut failures = 0;
    for few in ids.chunks(at_once) {
        let mut before = world.clone();
        for &id in few {
            world.set(id, at([90.0, 90.0], 1.0)).unwrap();
        }
        let mut expected = world.clone();
        expected.update();
        if update_within(&mut world, LEAST).is_err() {
            failures += 1;
            for &id in few {
                world.set(id, before.aabb(id).unwrap()).unwrap();
            }
            for step in 0..6 {
                let mut random = Random::new(step);
                for &id in if step < 3 { &ids[..10] } else { &ids } {
                    let offset = random.point::<2>().map(|at| 0.1 * (at as f32 - 0.5));
                    let aabb = before.aabb(id).unwrap().translate(offset);
                    for world in [&mut world, &mut before] {
                        world.set(id, aabb).unwrap();
                    }
                }
                world.update();
                before.update();
                assert!(events(&world) == events(&before));
                assert_eq!(world.broken_invariant(), None);
            }
            world = expected;
        } else {
            assert!(events(&world) == events(&expected));
        }
    }
    assert!(failures > 2, "{failures}");
}

#[test]
fn a_crowd_that_grows() {
    let _alone = alone();
    grows(10);
    grows(100);
}
