//! Memory that runs out at any point of any call: an allocator refuses the first, second, third ... allocation of a call and
//! all after it.
//!
//! A finder on one thread and queries return an error each time, and the next search or query is right. Other calls end the
//! program as Rust's collections do, so each of them is made in a process of its own.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::fmt::Debug;
use std::ops::ControlFlow;
use std::process::Command;

use sweep_and_prune::{
    Aabb, BroadPhase, Cast, Error, Filter, Lists, PairFinder, ProxyId, count_pairs, find_pairs,
    find_pairs_between,
};
use sweep_and_prune_scenes::{Random, Scene, brute_force};

/// The system's allocator, which gives the current thread as many allocations as it has left.
struct Limited;

thread_local! {
    /// Not of the process: the thread that waits for the test allocates, too, and on a busy processor it may do so at any time.
    static LEFT: Cell<isize> = const { Cell::new(isize::MAX) };
}

fn is_refused() -> bool {
    // A thread that is ending has no limit any more, and no test.
    let left = LEFT.try_with(Cell::get).unwrap_or(isize::MAX);
    if left != isize::MAX {
        LEFT.set(left - 1);
    }
    left <= 0
}

// SAFETY: every call is passed on to the system's allocator as it came, or refused as an allocator may.
#[allow(unsafe_code, reason = "an allocator can be replaced in no other way")]
unsafe impl GlobalAlloc for Limited {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if is_refused() {
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
        if is_refused() {
            return std::ptr::null_mut();
        }
        // SAFETY: as required of our caller.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Limited = Limited;

/// Makes a call that gets this many allocations. Returns also whether one was refused.
fn with_allocations<R>(count: usize, call: impl FnOnce() -> R) -> (R, bool) {
    LEFT.set(count as isize);
    let result = call();
    (result, LEFT.replace(isize::MAX) < 0)
}

/// Scenes that are cut into columns, split by size, planned again by themselves, or few.
fn scenes() -> Vec<Vec<Aabb<3>>> {
    [
        (Scene::Uniform, 3),
        (Scene::Uniform, 100),
        (Scene::Uniform, 3000),
        (Scene::Clustered, 6000),
        (Scene::Mixed, 3000),
        (Scene::Needles, 2000),
        (Scene::Coincident, 300),
    ]
    .map(|(scene, n)| scene.boxes(n, 1).unwrap())
    .to_vec()
}

/// Makes a call of a new finder with 0, 1, 2 ... allocations until that are enough. Each time it returns the error (or goes on
/// without what it cannot keep), and then the finder finds what it should. Returns how many allocations were enough.
fn fails_cleanly<V: PartialEq + Debug>(
    boxes: &[Aabb<3>],
    call: impl Fn(&mut PairFinder<3>) -> Result<V, Error>,
) -> usize {
    let expected = find_pairs(boxes).unwrap();
    let result = call(&mut PairFinder::new()).unwrap();
    for allocations in 0.. {
        let mut finder = PairFinder::new();
        let (found, is_refused) = with_allocations(allocations, || call(&mut finder));
        match found {
            Ok(found) => assert_eq!(found, result),
            Err(error) => assert!(is_refused && error == Error::OutOfMemory, "{error}"),
        }
        if !is_refused {
            return allocations;
        }
        assert!(finder.find(boxes).unwrap() == expected, "after {allocations} allocations");
    }
    unreachable!()
}

#[test]
fn a_search_without_memory_returns_an_error_and_the_next_one_is_right() {
    let mut allocations = 0;
    for boxes in scenes() {
        let (first, second) = boxes.split_at(boxes.len() / 2);
        // What is returned must not allocate.
        allocations += fails_cleanly(&boxes, |finder| finder.find(&boxes).map(<[_]>::len));
        allocations +=
            fails_cleanly(&boxes, |finder| finder.find_between(first, second).map(<[_]>::len));
        allocations += fails_cleanly(&boxes, |finder| finder.search(&boxes).count());
        let go_on = |_done: f64| ControlFlow::Continue(());
        allocations += fails_cleanly(&boxes, |finder| {
            finder.search(&boxes).against(second).progress(&go_on).count()
        });
        allocations += fails_cleanly(&boxes, |finder| {
            let mut count = 0;
            let each = |pairs: &[[u32; 2]]| {
                count += pairs.len();
                ControlFlow::<()>::Continue(())
            };
            finder.search(&boxes).for_each_chunk(each).map(|_| count)
        });
        allocations += fails_cleanly(&boxes, |_| find_pairs(&boxes).map(|pairs| pairs.len()));
        allocations +=
            fails_cleanly(&boxes, |_| find_pairs_between(first, second).map(|pairs| pairs.len()));
        allocations += fails_cleanly(&boxes, |_| count_pairs(&boxes));
    }
    assert!(allocations > 300, "{allocations}");
}

/// A world with bodies of all kinds, and the id of one.
fn world() -> (BroadPhase<2>, Vec<ProxyId>, Random) {
    let mut random = Random::new(1);
    let mut world = BroadPhase::new();
    let boxes: Vec<_> = (0..100).map(|_| draw(&mut random)).collect();
    let ids = world.insert_many(&boxes, Filter::default()).unwrap();
    world.update();
    for &id in &ids[..3] {
        world.set(id, draw(&mut random)).unwrap();
    }
    world.remove(ids[99]).unwrap();
    world.insert(draw(&mut random)).unwrap();
    (world, ids, random)
}

fn draw(random: &mut Random) -> Aabb<2> {
    let at: [f64; 2] = random.point();
    Aabb::new(at.map(|at| at as f32), at.map(|at| at as f32 + 0.1))
}

/// Asks with 0, 1, 2 ... allocations until that are enough. Where the answer does not fit, there are no lists, and the same
/// query is answered right with memory. Returns how many allocations were enough.
fn answers_or_fails_cleanly<V: Clone + Debug + PartialEq>(
    ask: impl Fn(&mut Lists<V>) -> Result<(), Error>,
) -> usize {
    let mut expected = Lists::new();
    ask(&mut expected).unwrap();
    assert!(!expected.values().is_empty());
    // Also lists that were filled before.
    let counts = (0..).flat_map(|count| [(Lists::new(), count), (expected.clone(), count)]);
    for (mut lists, allocations) in counts {
        let is_new = lists.is_empty();
        let (end, is_refused) = with_allocations(allocations, || ask(&mut lists));
        match end {
            Ok(()) => assert!(lists == expected, "{allocations} allocations"),
            Err(error) => {
                assert!(is_refused && error == Error::OutOfMemory, "{error}");
                assert!(lists.is_empty() && lists.values().is_empty());
            }
        }
        if is_new && !is_refused {
            return allocations;
        }
        ask(&mut lists).unwrap();
        assert!(lists == expected, "after {allocations} allocations");
    }
    unreachable!()
}

#[test]
fn a_query_without_memory_returns_an_error_and_the_next_one_is_right() {
    let (mut world, _, mut random) = world();
    let queries = world.queries();
    let areas: Vec<_> = (0..30).map(|_| draw(&mut random)).collect();
    let points: Vec<_> = areas.iter().map(|area| area.min).collect();
    let spheres: Vec<_> = points.iter().map(|&center| (center, 0.2)).collect();
    let casts: Vec<_> = points.iter().map(|&from| Cast::ray(from, [1.0, 0.5], 9.0)).collect();
    let mut allocations = [
        answers_or_fails_cleanly(|lists| queries.overlapping_many(&areas, lists)),
        answers_or_fails_cleanly(|lists| queries.containing_many(&points, lists)),
        answers_or_fails_cleanly(|lists| queries.within_many(&spheres, lists)),
        answers_or_fails_cleanly(|lists| queries.nearest_many(&points, 20, 9.0, lists)),
        answers_or_fails_cleanly(|lists| queries.cast_all_many(&casts, lists)),
    ]
    .to_vec();
    for count in 0.. {
        let ask = || queries.cast_many(&casts, &mut Vec::new());
        let (end, is_refused) = with_allocations(count, ask);
        assert_eq!(end, if is_refused { Err(Error::OutOfMemory) } else { Ok(()) });
        if !is_refused {
            break;
        }
    }

    // All at once: found from scratch, among sorted boxes, and after some have changed.
    let boxes: Vec<_> = (0..33_000).map(|_| draw_small(&mut random)).collect();
    let areas: Vec<_> = (0..8_400).map(|_| draw_small(&mut random)).collect();
    let points: Vec<_> = areas.iter().map(|area| area.min).collect();
    let mut world = BroadPhase::new();
    let ids = world.insert_many(&boxes, Filter::ALL).unwrap();
    for _ in 0..3 {
        let queries = world.queries();
        allocations.push(answers_or_fails_cleanly(|lists| queries.overlapping_many(&areas, lists)));
        allocations.push(answers_or_fails_cleanly(|lists| queries.containing_many(&points, lists)));
        world.queries().overlapping_many(&areas, &mut Lists::new()).unwrap();
        world.set_many(&ids[..50], &areas[..50]).unwrap();
    }
    assert!(allocations.iter().all(|&count| count > 1), "{allocations:?}");
}

fn draw_small(random: &mut Random) -> Aabb<2> {
    let min = random.point::<2>().map(|at| at as f32);
    Aabb::new(min, min.map(|at| at + 0.01))
}

/// A call by its name, and whether its result is right.
fn call(name: &str, allocations: usize) -> bool {
    let (mut world, ids, mut random) = world();
    let area = draw(&mut random);
    let boxes: Vec<_> = (0..90).map(|_| draw(&mut random)).collect();
    let bytes = world.snapshot();
    let mut copy = None;
    let mut found = 0;
    with_allocations(allocations, || match name {
        "update" => found = world.update().begun().len(),
        "rebuild" => {
            world.set_many(&ids[..90], &boxes).unwrap();
            found = world.update().begun().len();
        }
        "insert" => _ = world.insert(area).unwrap(),
        "insert_many" => _ = world.insert_many(&boxes, Filter::STATIC).unwrap(),
        "set_swept" => world.set_swept(ids[0], area, area).unwrap(),
        "set_filter" => world.set_filter(ids[0], Filter::STATIC).unwrap(),
        "remove_many" => world.remove_many(&ids[5..80]).unwrap(),
        "queries" => world.prepare_queries(),
        "snapshot" => found = world.snapshot().len(),
        "from_snapshot" => copy = Some(BroadPhase::<2>::from_snapshot(&bytes).unwrap()),
        "clone" => copy = Some(world.clone()),
        _ => unreachable!(),
    });
    let _ = found;
    let mut world = copy.unwrap_or(world);
    world.update();
    let boxes: Vec<_> = world.ids().map(|id| world.aabb(id).unwrap()).collect();
    let filters: Vec<_> = world.ids().map(|id| world.filter(id).unwrap()).collect();
    let overlaps = brute_force(&boxes).unwrap();
    let allowed = |&&[a, b]: &&[u32; 2]| filters[a as usize].allows(&filters[b as usize]);
    world.pairs().count() == overlaps.iter().filter(allowed).count()
}

const CALLS: [&str; 11] = [
    "update",
    "rebuild",
    "insert",
    "insert_many",
    "set_swept",
    "set_filter",
    "remove_many",
    "queries",
    "snapshot",
    "from_snapshot",
    "clone",
];

#[test]
#[ignore = "run by the test below, in a process of its own"]
fn one_call() {
    let [name, allocations] = ["CALL", "ALLOCATIONS"].map(|name| std::env::var(name).unwrap());
    assert!(call(&name, allocations.parse().unwrap()));
    println!("the call passed");
}

/// Runs the test above in a process of its own: whether it passed, and what it printed.
fn run(environment: &[(&str, String)]) -> (std::process::Output, String) {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["--ignored", "--exact", "--nocapture", "--test-threads=1", "one_call"]);
    let out = command.envs(environment.iter().cloned()).output().unwrap();
    let said = [&out.stdout[..], &out.stderr[..]].concat();
    (out, String::from_utf8_lossy(&said).into_owned())
}

#[test]
fn a_broad_phase_without_memory_ends_the_program_as_collections_do() {
    for name in CALLS {
        let mut refused = 0;
        loop {
            let environment = [("CALL", name.into()), ("ALLOCATIONS", refused.to_string())];
            let (out, said) = run(&environment);
            if out.status.success() {
                assert!(said.contains("the call passed"), "{name}: {said}");
                break;
            }
            assert!(said.contains("memory allocation of "), "{name}, {refused}: {said}");
            refused += 1;
        }
        println!("{name}: {refused} points");
    }
}
