//! Error messages name the argument, its value, the limit that the value broke, and what to do.

use sweep_and_prune::{
    Aabb, BroadPhase, Cast, Error, Lists, Options, Report, SnapshotFault, find_pairs,
};

fn message<T>(result: Result<T, Error>) -> String {
    result.map(|_| ()).unwrap_err().to_string()
}

#[test]
fn a_message_about_a_box_shows_its_interval() {
    let inverted = [Aabb::new([0.0f32, 0.1], [1.0, 0.0])];
    assert_eq!(
        message(find_pairs(&inverted)),
        "box 0 is invalid on axis 1: min is 0.1 and max is 0, but min <= max must hold and neither \
         may be NaN"
    );
    let nan = [Aabb::new([0.0f64], [1.0]), Aabb::new([0.1f64], [f64::NAN])];
    assert!(
        message(find_pairs(&nan))
            .starts_with("box 1 is invalid on axis 0: min is 0.1 and max is NaN")
    );
}

#[test]
fn a_message_about_an_id_shows_the_id_and_its_index() {
    let mut world = BroadPhase::<1>::new();
    let [here, gone] = [0.0, 5.0].map(|at| world.insert(Aabb::new([at], [at])).unwrap());
    world.remove(gone).unwrap();
    assert_eq!(
        message(world.remove_many(&[here, gone])),
        "the id at index 1 (4294967297) is stale: its body was removed, or it never had one in this \
         world; use the ids of bodies that are in it"
    );
    assert_eq!(
        message(world.set_many(&[here], &[])),
        "there are 1 ids but 0 boxes: pass one box for each id"
    );
}

#[test]
fn a_message_about_an_option_names_the_option() {
    let report = Report::Fat { margin: 0.0, prediction: -1.5 };
    let options = Options::default().report(report);
    assert_eq!(
        message(BroadPhase::<2>::with_options(options)),
        "the option `prediction` is -1.5, but it must be finite and 0 or more"
    );
}

#[test]
fn a_message_about_a_query_names_the_argument_at_fault() {
    let mut world = BroadPhase::<1>::new();
    let queries = world.queries();
    let at = |result: Result<_, Error>| message::<()>(result);
    let infinity = f32::INFINITY;
    assert_eq!(
        at(queries.within_many(&[([0.0], 1.0), ([0.0], -2.0)], &mut Lists::new())),
        "`radius` of query 1 is -2, but it must be 0 or more"
    );
    assert_eq!(
        at(queries.within([0.0], -infinity).map(|_| ())),
        "`radius` of query 0 is -inf, but it must be 0 or more"
    );
    assert_eq!(
        at(queries.within([infinity], 1.0).map(|_| ())),
        "`center` of query 0 is inf, but it must be finite"
    );
    assert_eq!(
        at(queries.containing([f32::NAN]).map(|_| ())),
        "`point` of query 0 is NaN, but it may not be NaN"
    );
    assert_eq!(
        at(queries.cast(&Cast::ray([0.0], [f32::NAN], 1.0)).map(|_| ())),
        "`direction` of query 0 is NaN, but it may not be NaN"
    );
    let inverted = Cast::aabb(Aabb::new([2.0], [1.0]), [1.0], 1.0);
    assert_eq!(
        at(queries.cast(&inverted).map(|_| ())),
        "`from` of query 0 is 2, but it must be a box with min <= max"
    );
}

#[test]
fn messages_about_limits_say_what_to_do() {
    let count = usize::try_from(1u64 << 33).unwrap();
    assert_eq!(
        Error::TooManyBoxes { count }.to_string(),
        "8589934592 boxes are too many: one set can hold 4294967295, so split it"
    );
    let other = SnapshotFault::OtherWorld { dimensions: 2, scalar_bytes: 8 };
    assert_eq!(
        Error::InvalidSnapshot(other).to_string(),
        "the snapshot holds a world of 2 dimensions and f64 coordinates: read it as \
         `BroadPhase<2, f64>`"
    );
}

#[test]
fn every_kind_of_cast_checks_its_argument() {
    let mut world = BroadPhase::<1>::new();
    world.insert(Aabb::new([0.0], [1.0])).unwrap();
    let queries = world.queries();
    let good = Cast::ray([0.0f32], [1.0], 1.0);
    let bad = Cast::ray([0.0f32], [f32::NAN], 1.0);
    let expected =
        |index: usize| format!("`direction` of query {index} is NaN, but it may not be NaN");
    assert_eq!(message(queries.cast(&bad)), expected(0));
    let (mut hits, mut lists) = (vec![], Lists::new());
    queries.cast_many(&[good], &mut hits).unwrap();
    queries.cast_all_many(&[good], &mut lists).unwrap();
    let before = (hits.clone(), lists.clone());
    assert_eq!(message(queries.cast_many(&[good, bad], &mut hits)), expected(1));
    assert_eq!(message(queries.cast_all_many(&[good, bad], &mut lists)), expected(1));
    assert_eq!((hits, lists), before, "a query that is refused changes no list");
    assert_eq!(message(queries.cast_all(&bad)), expected(0));
    let visit = |_| unreachable!("a cast that is refused hits nothing");
    assert_eq!(message(queries.cast_with(&bad, visit)), expected(0));
}
