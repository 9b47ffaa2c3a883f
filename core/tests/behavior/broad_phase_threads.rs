//! The broad phase on several threads: the same events, pairs and state as on one.

use sweep_and_prune::{BroadPhase, Filter, PairFinder, ProxyId};
use sweep_and_prune_scenes::Motion;

/// Enough bodies for the finder to split the work among threads.
const BODIES: usize = 12_000;

/// One in this many bodies is static, so that two sets are searched too.
const STATIC: usize = 8;

#[test]
fn any_number_of_threads_gives_the_same_changes() {
    for motion in Motion::ALL {
        check::<2>(motion);
        check::<3>(motion);
    }
}

fn check<const D: usize>(motion: Motion) {
    for some_are_static in [false, true] {
        let mut moving = motion.start::<D, f32>(BODIES, 5).unwrap();
        let fixed = BODIES / STATIC;
        let mut worlds = [1, 2, 4, 0].map(|threads| BroadPhase::<D>::new().threads(threads));
        let mut ids: Vec<ProxyId> = vec![];
        for world in &mut worlds {
            let filter = if some_are_static { Filter::STATIC } else { Filter::default() };
            ids = world.insert_many(&moving.boxes()[..fixed], filter).unwrap();
            ids.extend(world.insert_many(&moving.boxes()[fixed..], Filter::default()).unwrap());
        }
        for step in 0..12 {
            let [first, others @ ..] = &mut worlds;
            let expected = first.update();
            let expected = [expected.begun(), expected.ended()].map(Vec::from_iter);
            assert!(motion == Motion::MostlyStill || !expected[0].is_empty());
            for world in others.iter_mut() {
                let changes = world.update();
                let reported = [changes.begun(), changes.ended()].map(Vec::from_iter);
                assert_eq!(reported, expected, "{motion:?} {D} {step}");
                assert!(world.pairs().eq(first.pairs()));
                assert_eq!(world.state_hash(), first.state_hash());
            }
            if !some_are_static {
                let count = PairFinder::new().search(moving.boxes()).count().unwrap();
                assert_eq!(first.pairs().count() as u64, count);
            }
            // A clone keeps its threads.
            worlds[2] = worlds[2].clone();
            moving.advance();
            for world in &mut worlds {
                world.set_many(&ids, moving.boxes()).unwrap();
            }
        }
    }
}
