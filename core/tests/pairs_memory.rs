//! What the finder and many queries allocate: the finder nothing in a steady state, and before no more than documented.

use std::ops::ControlFlow;

use allocation_counter::measure;
use sweep_and_prune::{Aabb, BroadPhase, Error, Filter, Lists, PairFinder, Scalar};
use sweep_and_prune_scenes::Scene;

fn scene<const D: usize, T: Scalar>(scene: Scene, n: usize, seed: u64) -> Vec<Aabb<D, T>> {
    scene.boxes(n, seed).unwrap()
}

#[test]
fn a_steady_state_allocates_nothing() {
    let mut finder = PairFinder::<3>::new();
    for kind in [Scene::Uniform, Scene::Clustered, Scene::Mixed, Scene::Tower, Scene::Slab] {
        let boxes = scene::<3, f32>(kind, 5000, 1);
        let half = boxes.len() / 2;
        let mut all = || {
            let found = finder.find(&boxes).unwrap().len() as u64;
            assert_eq!(finder.search(&boxes).count(), Ok(found));
            let mut streamed = 0;
            let flow = finder.search(&boxes).for_each(|_| {
                streamed += 1;
                ControlFlow::<()>::Continue(())
            });
            assert!(flow.is_ok() && streamed == found);
            finder.find_between(&boxes[..half], &boxes[half..]).unwrap();
        };
        all();
        assert_eq!(measure(all).count_total, 0, "{kind:?}");
    }
}

/// The most bytes in use while the pairs are counted, for each box.
fn peak<const D: usize, T: Scalar>(kind: Scene, n: usize) -> Option<u64> {
    let boxes = kind.boxes::<D, T>(n, 1)?;
    let counted = measure(|| assert!(PairFinder::new().search(&boxes).count().is_ok()));
    Some(counted.bytes_max / n as u64)
}

/// Of coincident boxes there are nearly two billion pairs to count.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow where nothing is optimized")]
fn peak_memory_is_as_documented() {
    for &kind in Scene::ALL {
        for n in [3_000, 60_000] {
            // As the finder's documentation says: this many times what the boxes take, and a little
            // that is the same for any number of them.
            let times = match kind {
                Scene::Uniform | Scene::Clustered | Scene::Tower | Scene::Slab => 4,
                Scene::Needles => 34,
                _ => 10,
            };
            for (peak, bytes) in [
                (peak::<1, f32>(kind, n), 8),
                (peak::<2, f32>(kind, n), 16),
                (peak::<3, f32>(kind, n), 24),
                (peak::<3, f64>(kind, n), 48),
            ] {
                let most = times * bytes + 32 + 200_000 / n as u64;
                assert!(peak.is_none_or(|peak| peak < most), "{kind:?} {n} {bytes}: {peak:?}");
            }
        }
    }
}

#[test]
fn storing_pairs_takes_only_their_buffer() {
    let boxes = scene::<3, f32>(Scene::BoxPruning, 30_000, 1);
    let mut pairs = 0;
    let stored = measure(|| pairs = PairFinder::<3>::new().find(&boxes).unwrap().len() as u64);
    let counted = measure(|| assert_eq!(PairFinder::new().search(&boxes).count(), Ok(pairs)));
    // 8 bytes each, twice while their buffer grows, and it may be half empty.
    let most = counted.bytes_max + 32 * pairs;
    assert!(stored.bytes_max < most, "{} of {most}", stored.bytes_max);
}

#[test]
fn a_stream_needs_no_memory_for_pairs() {
    let boxes = [Aabb::new([0.0f64], [1.0]); 3000];
    let info =
        measure(|| assert_eq!(PairFinder::new().search(&boxes).count(), Ok(3000 * 2999 / 2)));
    // Four and a half million pairs.
    assert!(info.bytes_max < 1_000_000, "{}", info.bytes_max);
}

/// What the next test runs with limited memory.
#[test]
#[ignore = "run by the next test, in a process of its own"]
fn with_little_memory() {
    let many = vec![Aabb::new([0.0f32; 3], [1.0; 3]); 50_000];
    let few = scene::<3, f32>(Scene::Uniform, 5000, 1);
    let finders = [
        PairFinder::new(),
        #[cfg(feature = "parallel")]
        PairFinder::new().threads(2),
    ];
    for mut finder in finders {
        let found = finder.find(&few).unwrap().to_vec();
        assert_eq!(finder.find(&many), Err(Error::OutOfMemory)); // ten gigabytes of pairs
        assert_eq!(finder.find_between(&many, &many), Err(Error::OutOfMemory));
        assert_eq!(finder.find(&few), Ok(&found[..]));
        assert_eq!(finder.search(&many).count(), Ok(50_000 * 49_999 / 2));
    }
    println!("went on");
}

#[cfg(target_os = "linux")]
#[test]
fn too_little_memory_is_an_error() {
    let this = std::env::current_exe().unwrap();
    let limited =
        r#"ulimit -v 1000000 && exec "$0" --ignored --exact --nocapture with_little_memory"#;
    let out = std::process::Command::new("sh").arg("-c").arg(limited).arg(this).output().unwrap();
    let said = String::from_utf8_lossy(&out.stdout);
    assert!(out.status.success() && said.contains("went on"), "{said}{out:?}");
}

#[test]
fn many_queries_take_no_memory_for_bodies_that_they_do_not_see() {
    let crowd = vec![Aabb::new([0.0; 2], [1.0; 2]); 33_000];
    let mut world = BroadPhase::<2>::new();
    let ids = world.insert_many(&crowd, Filter::default()).unwrap();
    for &id in &ids {
        world.set_enabled(id, false).unwrap();
    }
    world.update();
    world.prepare_queries();
    let areas = &crowd[..8_250];
    let asked = measure(|| {
        let mut lists = Lists::new();
        world.queries().overlapping_many(areas, &mut lists).unwrap();
        assert!((0..lists.len()).all(|query| lists[query].is_empty()));
    });
    // All pairs would take 2 GB.
    assert!(asked.bytes_max < 100 << 20, "{} bytes", asked.bytes_max);
}
