//! What is called through the erased traits gives what the core gives, for every type of box.

use std::ops::ControlFlow;

use sweep_and_prune::{
    Aabb, BroadPhase, Cast, Error, Filter, Hit, Lists, PairFinder, ProxyId, Report, Scalar,
    find_pairs_between,
};
use sweep_and_prune_bindings::{Answer, Coordinates, Kind, Query};
use sweep_and_prune_scenes::Scene;

const GO_ON: &(dyn Fn(f64) -> ControlFlow<()> + Sync) = &|_| ControlFlow::Continue(());

fn kind<const D: usize, T: Scalar>() -> Kind {
    Kind { dimensions: D, is_double: size_of::<T>() == 8 }
}

fn boxes<const D: usize, T: Scalar>(seed: u64) -> Vec<Aabb<D, T>> {
    Scene::Uniform.boxes(700, seed).unwrap()
}

fn numbers<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>]) -> Vec<f64> {
    let corners = |aabb: &Aabb<D, T>| aabb.min.into_iter().chain(aabb.max);
    boxes.iter().flat_map(corners).map(|at| at.to_f64()).collect()
}

fn finder_gives_what_the_core_gives<const D: usize, T: Scalar>() {
    let (a, b) = (boxes::<D, T>(1), boxes::<D, T>(2));
    let mut erased = kind::<D, T>().pair_finder(1).unwrap();
    let [of_a, of_b] = [numbers(&a), numbers(&b)];
    let a_count = erased.write_rows(0, Coordinates::Double(&of_a)).unwrap();
    let b_count = erased.write_rows(1, Coordinates::Double(&of_b)).unwrap();
    assert_eq!((a_count, b_count), (a.len(), b.len()));
    let within = PairFinder::new().find(&a).unwrap().to_vec();
    let between = find_pairs_between(&a, &b).unwrap();
    assert!(!within.is_empty() && !between.is_empty());
    for (b, expected) in [(None, &within), (Some(b_count), &between)] {
        assert_eq!(erased.find(a_count, b, GO_ON).unwrap().unwrap(), expected);
        assert_eq!(erased.count(a_count, b, GO_ON).unwrap(), Some(expected.len() as u64));
        let mut found = Vec::new();
        let end = erased.for_each_chunk(a_count, b, &mut |pairs| {
            found.extend_from_slice(pairs);
            ControlFlow::Continue(())
        });
        assert_eq!((end, &found), (Ok(ControlFlow::Continue(())), expected));
        let end = erased.for_each_chunk(a_count, b, &mut |_| ControlFlow::Break(()));
        assert_eq!(end, Ok(ControlFlow::Break(())));
        assert_eq!(erased.find(a_count, b, &|_| ControlFlow::Break(())), Ok(None));
    }
    // Fewer rows than were written are fewer boxes.
    assert_eq!(erased.find(1, None, GO_ON), Ok(Some(&[][..])));
    assert!(erased.rows(2, 1).is_none());
    erased.reset();
    assert_eq!(erased.find(a_count, None, GO_ON).unwrap().unwrap(), within);
}

#[test]
fn an_erased_finder_gives_what_the_core_gives() {
    finder_gives_what_the_core_gives::<1, f32>();
    finder_gives_what_the_core_gives::<2, f32>();
    finder_gives_what_the_core_gives::<3, f32>();
    finder_gives_what_the_core_gives::<1, f64>();
    finder_gives_what_the_core_gives::<2, f64>();
    finder_gives_what_the_core_gives::<3, f64>();
}

fn bits(ids: impl IntoIterator<Item = ProxyId>) -> Vec<u64> {
    ids.into_iter().map(ProxyId::to_bits).collect()
}

fn broad_phase_gives_what_the_core_gives<const D: usize, T: Scalar>() {
    let kind = kind::<D, T>();
    let mut core = BroadPhase::<D, T>::new();
    let mut erased = kind.broad_phase::<u64>(Report::Exact).unwrap().unwrap();
    assert_eq!(erased.kind(), kind);
    let (start, end) = (boxes::<D, T>(3), boxes::<D, T>(4));
    let filter = Filter::default().category(2);

    let count = erased.write_rows(Coordinates::Double(&numbers(&start))).unwrap();
    assert_eq!(erased.validate(count), Ok(()));
    let ids = erased.insert_many(count, filter).unwrap();
    assert_eq!(ids, core.insert_many(&start, filter).unwrap());
    let mut events = Vec::new();
    let begun = erased.update(false, &mut events).unwrap();
    assert_eq!(begun, events.len());
    let expected = core.update();
    assert_eq!(events, bits(expected.begun().flatten()));

    // Some are set together, one moves by itself, one is swept, some are removed.
    erased.write_rows(Coordinates::Double(&numbers(&end))).unwrap();
    erased.set_many(&ids[..300]).unwrap();
    core.set_many(&ids[..300], &end[..300]).unwrap();
    erased.set(ids[300], &numbers(&end[300..301])).unwrap();
    core.set(ids[300], end[300]).unwrap();
    erased.set_swept(ids[301], &numbers(&start[301..302]), &numbers(&end[301..302])).unwrap();
    core.set_swept(ids[301], start[301], end[301]).unwrap();
    erased.remove_many(&ids[302..350]).unwrap();
    core.remove_many(&ids[302..350]).unwrap();
    assert!(erased.contains(ids[0]) && !erased.contains(ids[310]));
    assert_eq!(erased.len(), core.len());
    let added = erased.insert(&numbers(&end[..1])).unwrap();
    assert_eq!(added, core.insert(end[0]).unwrap());
    erased.set_filter(added, filter).unwrap();
    core.set_filter(added, filter).unwrap();
    assert_eq!(erased.filter(added), Ok((filter, true)));
    erased.set_enabled(added, false).unwrap();
    assert_eq!(erased.filter(added), Ok((filter, false)));
    erased.set_enabled(added, true).unwrap();

    events.clear();
    let begun = erased.update(false, &mut events).unwrap();
    let expected = core.update();
    assert_eq!(events[..begun], bits(expected.begun().flatten()));
    assert_eq!(events[begun..], bits(expected.ended().flatten()));
    assert!(0 < begun && begun < events.len());
    // The same once more for a caller that could not take them. Where there are none, it updates.
    let mut again = Vec::new();
    assert_eq!(erased.update(true, &mut again), Ok(begun));
    assert_eq!(again, events);
    // Swept bodies come to rest.
    for updates in 0..2 {
        again.clear();
        let begun = erased.update(false, &mut again).unwrap();
        assert_eq!(again[..begun], bits(core.update().begun().flatten()));
        assert!(updates == 0 || again.is_empty());
    }
    let paired = core.pairs().next().unwrap()[0];
    erased.remove_many(&[paired]).unwrap();
    core.remove_many(&[paired]).unwrap();
    assert_eq!(erased.update(true, &mut again), Ok(0));
    assert_eq!(again, bits(core.update().ended().flatten()));
    assert!(!again.is_empty());

    let mut corners = vec![0.0; 2 * D];
    erased.corners(ids[5], false, &mut corners).unwrap();
    assert_eq!(corners, numbers(&end[5..6]));
    let mut found = Vec::new();
    erased.pairs(&mut found);
    let mut expected: Vec<_> = core.pairs().collect();
    expected.sort_unstable();
    assert_eq!(found, bits(expected.into_iter().flatten()));
    let partner = found[0];
    found.clear();
    erased.pairs_of(ProxyId::from_bits(partner), &mut found).unwrap();
    let mut expected: Vec<_> = core.pairs_of(ProxyId::from_bits(partner)).unwrap().collect();
    expected.sort_unstable();
    assert_eq!(found, bits(expected));
    let mut all = Vec::new();
    erased.for_each_id(&mut |id| all.push(id));
    assert_eq!(all, core.ids().collect::<Vec<_>>());

    let bytes = erased.snapshot();
    assert_eq!(bytes, core.snapshot());
    assert_eq!(erased.state_hash(), core.state_hash());
    let mut restored = kind.broad_phase::<u64>(Report::Exact).unwrap().unwrap();
    restored.restore(&bytes).unwrap();
    assert_eq!(restored.state_hash(), core.state_hash());
    restored.reset();
    assert_eq!(restored.len(), 0);

    queries_give_what_the_core_gives(&mut core, &mut |query, numbers| {
        let mut answer = Answer { values: vec![7.0], ..Answer::default() };
        erased
            .query(query, numbers, None, &[], true, &mut answer)
            .map(|()| Answer { found: Lists::new(), ..answer })
    });
    let stale = [added, ids[310]];
    assert_eq!(
        erased.remove_many(&stale),
        Err(Error::StaleProxy { index: 1, id: stale[1].to_bits() })
    );
}

type Ask<'a> = &'a mut dyn FnMut(Query, &[f64]) -> Result<Answer<u64>, Error>;

fn queries_give_what_the_core_gives<const D: usize, T: Scalar>(
    core: &mut BroadPhase<D, T>,
    ask: Ask<'_>,
) {
    let areas = boxes::<D, T>(9);
    let areas = &areas[..40];
    let queries = core.queries();
    fn lists<V>(ask: impl Fn(&mut Lists<V>) -> Result<(), Error>) -> Lists<V> {
        let mut lists = Lists::new();
        ask(&mut lists).unwrap();
        lists
    }
    let of = |ask: &dyn Fn(&mut Lists<ProxyId>) -> Result<(), Error>| {
        let lists = lists(ask);
        let ids = bits(lists.values().iter().copied());
        Answer { ids, ends: lists.ends().to_vec(), ..Answer::default() }
    };
    assert_eq!(
        ask(Query::Overlapping, &numbers(areas)).unwrap(),
        of(&|lists| queries.overlapping_many(areas, lists))
    );

    let points: Vec<[T; D]> = areas.iter().map(|aabb| aabb.min).collect();
    let flat: Vec<f64> = points.iter().flatten().map(|at| at.to_f64()).collect();
    assert_eq!(
        ask(Query::Containing, &flat).unwrap(),
        of(&|lists| queries.containing_many(&points, lists))
    );
    // So far that the third neighbor of the first point is beyond.
    let all = lists(|lists| queries.nearest_many(&points, 3, f64::INFINITY, lists));
    let max_distance = 0.9 * all[0][2].distance_squared.sqrt();
    let nearest = lists(|lists| queries.nearest_many(&points, 3, max_distance, lists));
    assert!(nearest.values().len() < all.values().len(), "the distance limits nothing");
    let answer = ask(Query::Nearest { k: 3, max_distance }, &flat).unwrap();
    assert_eq!(answer.ids, bits(nearest.values().iter().map(|near| near.id)));
    assert!(answer.values.iter().zip(nearest.values()).all(|(a, b)| *a == b.distance_squared));
    assert_eq!(answer.ends, nearest.ends());

    let radius = T::from_f64(0.5);
    let spheres: Vec<([T; D], T)> = points.iter().map(|&point| (point, radius)).collect();
    let flat: Vec<f64> = spheres
        .iter()
        .flat_map(|(point, radius)| point.iter().chain([radius]).map(|at| at.to_f64()))
        .collect();
    assert_eq!(
        ask(Query::Within, &flat).unwrap(),
        of(&|lists| queries.within_many(&spheres, lists))
    );

    let casts: Vec<Cast<D, T>> = areas
        .iter()
        .map(|&from| Cast::aabb(from, [T::from_f64(0.25); D], T::from_f64(40.0)))
        .collect();
    let row = |cast: &Cast<D, T>| {
        let mut row = numbers(&[cast.from]);
        row.extend(cast.direction.iter().chain([&cast.limit]).map(|at| at.to_f64()));
        row
    };
    let mut flat: Vec<f64> = casts.iter().flat_map(row).collect();
    let first = ask(Query::Cast, &flat).unwrap();
    let mut hits = Vec::new();
    queries.cast_many(&casts, &mut hits).unwrap();
    let hits: Vec<_> = hits.into_iter().flatten().collect();
    assert_eq!(first.ids, bits(hits.iter().map(|hit| hit.id)));
    let all = ask(Query::CastAll, &flat).unwrap();
    let expected: Vec<_> = casts.iter().map(|cast| queries.cast_all(cast).unwrap()).collect();
    assert_eq!(all.ids, bits(expected.iter().flatten().map(|hit| hit.id)));
    assert!(all.ids.len() > first.ids.len());
    let face_of = |hit: &Hit<D, T>| {
        let axis = hit.normal.iter().position(|at| at.to_f64() != 0.0);
        axis.map_or(0, |axis| 2 * axis as u8 + 1 + u8::from(hit.normal[axis].to_f64() > 0.0))
    };
    assert_eq!(first.faces, hits.iter().map(face_of).collect::<Vec<_>>());
    assert_eq!(all.faces, expected.iter().flatten().map(face_of).collect::<Vec<_>>());
    let entering = ask(Query::CastAllEntering, &flat).unwrap();
    let entered = casts.iter().flat_map(|cast| queries.cast_all(&cast.ignore_touching()).unwrap());
    assert_eq!(entering.ids, bits(entered.map(|hit| hit.id)));
    let mut end = 0;
    for (list, &found) in expected.iter().zip(&all.ends) {
        end += list.len();
        assert_eq!(found, end);
    }

    let width = 3 * D + 1;
    flat[2 * width - 1] = -1.0; // the limit of the second cast
    let casts_all = [Query::Cast, Query::CastAll, Query::CastEntering, Query::CastAllEntering];
    for query in casts_all {
        let value = (-1.0).into();
        let error = Error::InvalidQuery { index: 1, argument: "limit", value };
        assert_eq!(ask(query, &flat), Err(error));
    }
}

#[test]
fn an_erased_broad_phase_gives_what_the_core_gives() {
    broad_phase_gives_what_the_core_gives::<1, f32>();
    broad_phase_gives_what_the_core_gives::<2, f32>();
    broad_phase_gives_what_the_core_gives::<3, f32>();
    broad_phase_gives_what_the_core_gives::<1, f64>();
    broad_phase_gives_what_the_core_gives::<2, f64>();
    broad_phase_gives_what_the_core_gives::<3, f64>();
}

#[test]
fn there_is_nothing_of_0_or_4_dimensions() {
    for dimensions in [0, 4] {
        let kind = Kind { dimensions, is_double: false };
        assert!(kind.pair_finder(1).is_none());
        assert!(kind.broad_phase::<u64>(Report::Exact).is_none());
    }
}

#[test]
fn a_bad_margin_is_refused() {
    let kind = Kind { dimensions: 2, is_double: false };
    let report = Report::Fat { margin: -1.0, prediction: 0.0 };
    let refused = kind.broad_phase::<u64>(report).unwrap().map(|_| ());
    let value = (-1.0).into();
    assert_eq!(refused, Err(Error::InvalidOption { option: "margin", value }));
}

#[test]
fn queries_without_a_filter_find_bodies_that_pair_with_nothing() {
    let mut world = kind::<2, f64>().broad_phase::<u64>(Report::Exact).unwrap().unwrap();
    let aabb = [0.0, 0.0, 1.0, 1.0];
    let id = world.insert(&aabb).unwrap();
    world.set_filter(id, Filter::default().mask(0)).unwrap();
    let mut found = |filter| {
        let mut answer = Answer::default();
        world.query(Query::Overlapping, &aabb, filter, &[], true, &mut answer).map(|()| answer.ids)
    };
    assert_eq!(found(None), Ok(vec![id.to_bits()]));
    assert_eq!(found(Some(Filter::ALL)), Ok(vec![]));
}

#[test]
fn queries_have_names_and_numbers() {
    let names = ["overlapping", "containing", "within", "cast", "cast_all"];
    let queries =
        [Query::Overlapping, Query::Containing, Query::Within, Query::Cast, Query::CastAll];
    for (number, (name, query)) in (0..).zip(names.into_iter().zip(queries)) {
        assert_eq!(Query::numbered(number, 0, 0.0), Some(query));
        assert_eq!(Query::named(name, 0, 0.0), Some(query));
    }
    // A body at a distance whose rounded root is the greatest distance is found.
    let nearest = Query::Nearest { k: 3, max_distance: 2f64.sqrt().next_up() };
    assert_eq!(Query::numbered(5, 3, 2f64.sqrt()), Some(nearest));
    assert_eq!(Query::named("nearest", 3, 2f64.sqrt()), Some(nearest));
    let entering = [Query::CastEntering, Query::CastAllEntering];
    assert_eq!([6, 7].map(|number| Query::numbered(number, 0, 0.0)), entering.map(Some));
    let named = ["cast_entering", "cast_all_entering"].map(|name| Query::named(name, 0, 0.0));
    assert_eq!(named, entering.map(Some));
    assert_eq!((Query::numbered(8, 0, 0.0), Query::named("", 0, 0.0)), (None, None));
}
