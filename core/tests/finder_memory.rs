//! What the finder allocates: nothing in a steady state, and no more than it says before.

use std::ops::ControlFlow;

use allocation_counter::measure;
use sweep_and_prune::{Aabb, PairFinder, Scalar};
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
            assert_eq!(finder.count(&boxes), Ok(found));
            let mut streamed = 0;
            let flow = finder.for_each(&boxes, |_| {
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

#[test]
fn the_peak_is_as_documented() {
    for (kind, n) in [(Scene::Uniform, 50_000), (Scene::Clustered, 50_000), (Scene::Mixed, 50_000)]
    {
        let boxes = scene::<3, f32>(kind, n, 1);
        let mut pairs = 0;
        let stored = measure(|| pairs = PairFinder::<3>::new().find(&boxes).unwrap().len());
        let streamed = measure(|| {
            let each = |_| ControlFlow::<()>::Continue(());
            assert!(PairFinder::new().for_each(&boxes, each).is_ok());
        });
        // The documented 100 bytes a box; pairs take 8 bytes, twice while their buffer grows, and
        // it may be half empty.
        assert!(streamed.bytes_max < 100 * n as u64, "{kind:?}: {}", streamed.bytes_max / n as u64);
        let most = streamed.bytes_max + 32 * pairs as u64 + 4096;
        assert!(stored.bytes_max < most, "{kind:?}: {} of {most}", stored.bytes_max);
    }
}

#[test]
fn a_stream_needs_no_memory_for_pairs() {
    let boxes = [Aabb::new([0.0f64], [1.0]); 3000];
    let info = measure(|| assert_eq!(PairFinder::new().count(&boxes), Ok(3000 * 2999 / 2)));
    // Four and a half million pairs.
    assert!(info.bytes_max < 1_000_000, "{}", info.bytes_max);
}
