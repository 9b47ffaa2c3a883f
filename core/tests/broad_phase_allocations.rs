//! A living world in a steady state does not allocate.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use sweep_and_prune::{BroadPhase, Filter, ProxyId};
use sweep_and_prune_scenes::Motion;

/// The system's allocator, which counts what the current thread asks of it.
struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

fn count() {
    // A thread that is ending has no counter any more, and no test.
    let _ = ALLOCATIONS.try_with(|count| count.set(count.get() + 1));
}

// SAFETY: every call is passed on to the system's allocator as it came; counting neither
// allocates nor unwinds.
#[allow(unsafe_code, reason = "an allocator can be replaced in no other way")]
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: as required of our caller.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as required of our caller.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
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
