//! In a debug build of a game that optimizes its dependencies, the functions that take time are compiled with this crate, and
//! so optimized: `src/compiled.rs` says how.
//!
//! This program is compiled once more, without optimizations, beside the optimized library. Of the library's functions that
//! were compiled with it, all are short.

use std::ops::ControlFlow;
use std::process::Command;

use sweep_and_prune::{
    Aabb, BroadPhase, Cast, Error, Filter, Lists, PairFinder, Scalar, count_pairs, find_pairs,
    find_pairs_between, validate,
};

/// Calls what takes time.
fn call_all<const D: usize, T: Scalar>() -> Result<(), Error> {
    let at = |at: f64| [T::from_f64(at); D];
    let one = T::from_f64(1.0);
    let boxes = [Aabb::new(at(0.0), at(1.0)), Aabb::new(at(1.0), at(2.0))];
    validate(&boxes)?;
    assert_eq!(find_pairs(&boxes)?, [[0, 1]]);
    assert_eq!(find_pairs_between(&boxes, &boxes)?.len() as u64, 2 + 2 * count_pairs(&boxes)?);
    let mut finder = PairFinder::new();
    assert_eq!(finder.find(&boxes)?.len(), 1);
    assert_eq!(finder.find_between(&boxes, &boxes)?.len(), 4);
    assert_eq!(finder.search(&boxes).count()?, 1);
    assert_eq!(finder.search(&boxes).counts()?, [1, 1]);
    assert_eq!(finder.search(&boxes).against(&boxes).pairs()?.len(), 4);
    let go_on = |_: f64| ControlFlow::Continue(());
    let mut chunks = 0;
    let _ = finder.search(&boxes).progress(&go_on).for_each_chunk(|_| {
        chunks += 1;
        ControlFlow::<()>::Continue(())
    })?;
    assert_eq!((chunks, finder.take_pairs().len()), (1, 4));

    let mut world = BroadPhase::<D, T>::new();
    let id = world.insert(boxes[0])?;
    world.insert_with(boxes[1], Filter::STATIC)?;
    let ids = world.insert_many(&boxes, Filter::ALL)?;
    world.set(id, boxes[1])?;
    world.set_many(&ids, &boxes)?;
    world.set_swept(id, boxes[0], boxes[1])?;
    world.teleport(id, boxes[0])?;
    world.set_filter(id, Filter::ALL)?;
    world.set_enabled(id, true)?;
    world.exclude_pair(id, ids[0])?;
    world.include_pair(id, ids[0])?;
    assert!(!world.is_excluded(id, ids[0])?);
    world.shift(at(1.0))?;
    assert!(world.update().ended().len() == 0 && world.changes().begun().len() > 0);
    let saved = world.clone();
    world.clone_from(&saved);
    world = BroadPhase::from_snapshot(&world.snapshot())?;
    assert_eq!(world.state_hash(), saved.state_hash());
    world.snapshot_into(&mut vec![]);
    world.prepare_queries();
    assert!(world.prepared_queries().is_some());
    assert_eq!(world.pairs().len(), world.pairs_unsorted().count());
    assert!(world.pairs_of(id)?.len() > 0);
    assert!(!world.pairs_by_body().is_empty());

    let cast = Cast::ray(at(-1.0), at(1.0), T::from_f64(9.0));
    let (mut lists, mut hit) = (Lists::new(), vec![]);
    let queries = world.queries().with_filter(Filter::ALL).with_predicate(&|_| true);
    queries.overlapping(&boxes[0])?;
    queries.overlapping_many(&boxes, &mut lists)?;
    queries.visit_overlapping(&boxes[0], |_| ControlFlow::Continue(()))?;
    queries.containing(at(0.5))?;
    queries.containing_many(&[at(0.5)], &mut lists)?;
    queries.within(at(0.5), one)?;
    queries.within_many(&[(at(0.5), one)], &mut lists)?;
    queries.nearest(at(0.5), 2, 9.0)?;
    queries.nearest_many(&[at(0.5)], 2, 9.0, &mut Lists::new())?;
    queries.cast(&cast)?;
    queries.cast_many(&[cast], &mut hit)?;
    queries.cast_all(&cast)?;
    queries.cast_all_many(&[cast], &mut Lists::new())?;
    queries.cast_with(&cast, |_| ControlFlow::Continue(9.0))?;

    world.remove(id)?;
    world.remove_many(&ids[..1])?;
    world.clear();
    world.shrink_to_fit();
    assert!(world.update().begun().len() == 0);
    Ok(())
}

#[test]
fn every_call_succeeds() {
    call_all::<1, f64>().unwrap();
    call_all::<2, f32>().unwrap();
    call_all::<3, f32>().unwrap();
}

/// Where the library spends its time: a function that names one of these should be compiled with the library. What only
/// makes or frees memory does not count.
const TAKES_TIME: [&str; 18] = [
    "::pairs::columns",
    "::pairs::driver",
    "::pairs::kernel",
    "::pairs::plan",
    "::pairs::ranks",
    "::pairs::sort",
    "::pairs::sweep",
    "::world::finder",
    "::world::layout",
    "::world::policy",
    "::world::sets",
    "::world::snapshot",
    "::world::tree",
    "::world::update",
    "as core::clone::Clone",
    "::run_cast",
    "::by_slot",
    ">>::counts",
];

fn only_makes_or_frees(name: &str) -> bool {
    let is_drop = name.starts_with("core::ptr::drop_in_place") || name.ends_with("Drop>::drop");
    is_drop || name.ends_with("Default>::default") || name.ends_with("::new")
}

/// The functions of the library in a program's code, and those of the standard library over its types.
fn functions_of_the_library(code: &str) -> Vec<String> {
    let defined = code.lines().filter(|line| line.starts_with("define "));
    let names = defined.filter_map(|line| line.split_once('@')?.1.split_once('('));
    let names = names.map(|(name, _)| format!("{:#}", rustc_demangle::demangle(name)));
    names.filter(|name| name.contains("sweep_and_prune::")).collect()
}

#[test]
fn what_takes_time_is_compiled_with_the_library() {
    let code = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("debug_builds.ll");
    let emit = format!("--emit=llvm-ir={}", code.display());
    let build = Command::new(env!("CARGO"))
        .args(["rustc", "--quiet", "--package", "sweep-and-prune", "--test", "debug_builds"])
        .args(["--profile", "checked", "--all-features", "--", "-Copt-level=0"])
        .args(["-Ccodegen-units=1", "-Csymbol-mangling-version=v0", &emit])
        .status()
        .unwrap();
    assert!(build.success());
    let functions = functions_of_the_library(&std::fs::read_to_string(&code).unwrap());
    // It is the right code: `changes` is so short that it is compiled with the caller.
    assert!(functions.iter().any(|name| name.ends_with("BroadPhase<3>>::changes")));
    let slow = functions.iter().filter(|name| {
        !only_makes_or_frees(name) && TAKES_TIME.iter().any(|place| name.contains(place))
    });
    let slow: Vec<_> = slow.collect();
    assert!(slow.is_empty(), "not optimized in debug builds of users: {slow:#?}");
}
