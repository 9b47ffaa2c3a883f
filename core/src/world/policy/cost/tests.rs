//! The costs that the broad phase compares.

use super::*;

const BODIES: usize = 1000;

/// How many of 1000 updates skip tracking, where fat AABBs are larger than bodies or not, and last so
/// many updates, of which each but the first looks up this many bodies.
fn skipped(is_fat: bool, lifetime: usize, escaped: usize) -> usize {
    let (mut policy, mut age) = (Policy::default(), 0);
    let mut skips = || {
        if policy.skips_tracking(BODIES, BODIES) {
            return true;
        }
        let gives_up = age == 0 && policy.note_rebuild(BODIES, is_fat, false);
        if age > 0 {
            policy.note_incremental(escaped, 0);
        }
        age = if gives_up { 0 } else { (age + 1) % lifetime };
        gives_up
    };
    (0..1000).filter(|_| skips()).count()
}

#[test]
fn tracking_is_skipped_where_it_costs_more_and_tried_less_and_less_often() {
    assert_eq!(skipped(true, 12, 1), 0);
    assert!(skipped(false, 1, 0) > 980);
    let tracked = 1000 - skipped(true, 2, BODIES / LOOK_UP);
    assert!((10..50).contains(&tracked), "{tracked}");
}

#[test]
fn a_world_that_comes_to_rest_is_tracked_at_once() {
    let mut policy = Policy::default();
    assert!(policy.note_rebuild(BODIES, false, false));
    assert!(policy.skips_tracking(BODIES, BODIES));
    assert!(!policy.skips_tracking(1, BODIES) && !policy.skips_tracking(BODIES, BODIES));
}

#[test]
fn new_bodies_are_tracked_as_soon_as_they_move() {
    let mut policy = Policy::default();
    assert!(!policy.note_rebuild(BODIES, false, true));
    assert!(!policy.note_rebuild(BODIES, true, false));
}

#[test]
fn where_bodies_touch_more_of_them_are_looked_up_but_not_as_many_as_there_are_pairs() {
    // Each touches ten others, as in a heap of cubes.
    let mut policy = Policy::default();
    let most = |policy: &Policy| policy.most_look_ups(BODIES / 10, BODIES);
    assert_eq!(most(&policy), BODIES / LOOK_UP);
    policy.note_overlaps(10 * BODIES);
    assert!((100..130).contains(&most(&policy)), "{}", most(&policy));
    // Where most bodies move, they are looked up again and again.
    assert_eq!(policy.most_look_ups(BODIES, BODIES), BODIES / LOOK_UP);
}

#[test]
fn bodies_that_fly_among_many_pairs_cost_too_much_before_they_read_as_many() {
    for (reads, may_fly) in [(BODIES, true), (3 * BODIES, false)] {
        let mut policy = Policy::default();
        policy.note_overlaps(10 * BODIES);
        policy.note_reads(reads, 10, 0, BODIES);
        assert_eq!(policy.may_fly(20, BODIES), may_fly, "{reads}");
    }
}

/// How many of these updates, each with these reads and a twentieth of the bodies changed, tracking takes before it is skipped.
fn updates_that_read(reads: impl IntoIterator<Item = usize>) -> (usize, Policy) {
    let mut policy = Policy::default();
    policy.note_overlaps(10 * BODIES);
    for (update, reads) in reads.into_iter().enumerate() {
        policy.note_reads(reads, 0, 0, BODIES);
        if policy.reads_too_much(BODIES / 20, BODIES) {
            return (update + 1, policy);
        }
    }
    (usize::MAX, policy)
}

#[test]
fn where_updates_keep_reading_too_much_tracking_is_skipped() {
    let dear = 2 * BODIES;
    let (updates, mut policy) = updates_that_read([dear; 99]);
    assert_eq!(updates, DEAR_UPDATES);
    assert!(policy.skips_tracking(BODIES / 20, BODIES) && !policy.may_fly(1, BODIES));
    // Fewer bodies change.
    assert!(!policy.skips_tracking(BODIES / 50, BODIES));
    assert!(!policy.skips_tracking(BODIES / 20, BODIES));

    assert_eq!(updates_that_read([BODIES; 99]).0, usize::MAX);
    let falling = (0..99).map(|update| dear * (100 - update) / 50);
    assert_eq!(updates_that_read(falling.take(DEAR_UPDATES)).0, DEAR_UPDATES);
    let falling = (0..99).map(|update| dear * (40_usize.saturating_sub(update)) / 20);
    assert_eq!(updates_that_read(falling).0, usize::MAX);
    let interrupted = (0..99).map(|update| if update % 10 == 9 { 0 } else { dear });
    assert_eq!(updates_that_read(interrupted).0, usize::MAX);
}

#[test]
fn bodies_that_take_off_and_land_in_turn_do_not_fly_for_long() {
    for (turns, may_fly) in [(BODIES / 40, true), (BODIES / 4, false)] {
        let mut policy = Policy::default();
        // All take off once.
        policy.note_reads(0, BODIES / 10, BODIES / 10, BODIES);
        assert!(policy.has_flown());
        policy.note_reads(0, BODIES / 10, turns, BODIES);
        assert_eq!((policy.has_flown(), policy.may_fly(1, BODIES)), (may_fly, may_fly), "{turns}");
    }
}

#[test]
fn where_too_many_would_fly_none_does_for_some_updates() {
    for bodies in [1000, CACHED, 8 * CACHED] {
        let most = bodies / if bodies > CACHED { FLIGHT_ONE_IN } else { FLIGHT };
        for (flights, are_too_many) in [(0, false), (most, false), (most + 1, true)] {
            let mut policy = Policy::default();
            assert_eq!(
                policy.too_many_fly(flights, 0, bodies),
                are_too_many,
                "{flights} of {bodies}"
            );
            assert_eq!(policy.may_fly(1, bodies), !are_too_many);
            let grounded = (0..2 * GROUNDED).filter(|_| !policy.may_fly(1, bodies)).count();
            assert_eq!(grounded, if are_too_many { GROUNDED - 2 } else { 0 });
        }
    }
}

#[test]
fn in_a_large_world_fewer_may_fly_where_others_are_looked_up() {
    for (bodies, are_too_many) in [(1 << 12, false), (1 << 16, true)] {
        let (flights, moves) = (bodies / 32, bodies / 64);
        assert!(!Policy::default().too_many_fly(flights, moves, bodies));
        assert!(!Policy::default().too_many_fly(0, 2 * moves + 1, bodies));
        assert_eq!(Policy::default().too_many_fly(flights, moves + 1, bodies), are_too_many);
    }
}

#[test]
fn fat_aabbs_are_on_trial_until_they_last() {
    let mut policy = Policy::default();
    assert!(policy.is_trial());
    policy.note_rebuild(BODIES, true, false);
    assert!(policy.is_trial());
    policy.note_incremental(1, 0);
    assert!(!policy.is_trial());
}

#[test]
fn searches_for_ever_are_counted_without_overflow() {
    assert!(!refit_pays(2.0, usize::MAX, BODIES));
}
