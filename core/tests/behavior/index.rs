//! The static index finds what brute force finds, with every kernel, whatever its bytes are.

use std::ops::ControlFlow;

use crate::common::{coordinate, valid_box, valid_boxes};
use proptest::prelude::*;
use sweep_and_prune::{
    Aabb, Cast, Error, Hit, Index, IndexFault, IndexInfo, Kernel, Neighbor, Scalar, SearchBuffer,
};
use sweep_and_prune_scenes::{Scene, hash};

type Bytes<'a, const D: usize, T> = Index<D, T, &'a [u8]>;

fn sorted(mut indices: Vec<u32>) -> Vec<u32> {
    indices.sort_unstable();
    indices
}

/// Brute force: the indices of boxes that overlap an area.
fn overlapping<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>], area: &Aabb<D, T>) -> Vec<u32> {
    (0..).zip(boxes).filter(|(_, aabb)| aabb.overlaps(area)).map(|(index, _)| index).collect()
}

/// Brute force: all boxes that have a distance, by it and then by index.
fn by_distance<const D: usize, T: Scalar>(
    boxes: &[Aabb<D, T>],
    distance: impl Fn(&Aabb<D, T>) -> Option<f64>,
) -> Vec<(u32, f64)> {
    let mut all: Vec<_> =
        (0..).zip(boxes).filter_map(|(index, aabb)| Some((index, distance(aabb)?))).collect();
    all.sort_by(|a, b| a.1.partial_cmp(&b.1).unwrap().then(a.0.cmp(&b.0)));
    all
}

fn distance_squared<const D: usize, T: Scalar>(point: [T; D], aabb: &Aabb<D, T>) -> f64 {
    let mut sum = 0.0;
    for (axis, at) in point.into_iter().enumerate() {
        let [at, min, max] = [at, aabb.min[axis], aabb.max[axis]].map(T::to_f64);
        let gap = if at < min {
            min - at
        } else if at > max {
            at - max
        } else {
            0.0
        };
        sum += gap * gap;
    }
    sum
}

/// When a box at `from + t * speed` first touches another, by what each axis allows.
fn contact<const D: usize, T: Scalar>(
    from: &Aabb<D, T>,
    speed: [f64; D],
    limit: f64,
    other: &Aabb<D, T>,
) -> Option<f64> {
    let (mut enters, mut leaves) = (vec![0.0], vec![limit]);
    for (axis, speed) in speed.into_iter().enumerate() {
        let [min, max] = [other.min[axis], other.max[axis]].map(T::to_f64);
        let [own_min, own_max] = [from.min[axis], from.max[axis]].map(T::to_f64);
        if speed == 0.0 {
            if own_max < min || max < own_min {
                return None;
            }
        } else {
            let mut times = [(min - own_max) / speed, (max - own_min) / speed];
            times.sort_by(f64::total_cmp);
            enters.push(times[0]);
            leaves.push(times[1]);
        }
    }
    let enter = enters.into_iter().fold(f64::NEG_INFINITY, f64::max);
    let leave = leaves.into_iter().fold(f64::INFINITY, f64::min);
    (enter <= leave).then_some(enter)
}

fn pairs_of_neighbors(neighbors: &[Neighbor<u32>]) -> Vec<(u32, f64)> {
    neighbors.iter().map(|it| (it.id, it.distance_squared)).collect()
}

fn pairs_of_hits(hits: &[Hit<u32>]) -> Vec<(u32, f64)> {
    hits.iter().map(|it| (it.id, it.t)).collect()
}

/// Each search of an area finds what brute force finds, in one order with every kernel.
fn areas_agree<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>], areas: &[Aabb<D, T>]) {
    let index = Index::new(boxes).unwrap();
    Bytes::<D, T>::from_bytes(index.as_bytes()).unwrap();
    assert_eq!((index.len(), index.is_empty()), (boxes.len(), boxes.is_empty()));
    let scalar = index.clone().kernel(Kernel::SCALAR);
    let mut buffer = SearchBuffer::new();
    let many = index.search_many(areas).unwrap();
    assert_eq!(many.len(), areas.len());
    for (at, area) in areas.iter().enumerate() {
        let expected = overlapping(boxes, area);
        let found = scalar.search(area).unwrap();
        assert_eq!(sorted(found.clone()), expected, "{boxes:?} in {area:?}");
        let mut visited = Vec::new();
        let _ = scalar
            .visit(area, |index| {
                visited.push(index);
                ControlFlow::<()>::Continue(())
            })
            .unwrap();
        assert_eq!(sorted(visited.clone()), expected, "{boxes:?} in {area:?}");
        for kernel in Kernel::available() {
            let index = index.clone().kernel(kernel);
            assert_eq!(index.search_into(area, &mut buffer).unwrap(), found, "{}", kernel.name());
            let mut rest = visited.iter();
            let end = index.visit(area, |index| {
                assert_eq!(rest.next(), Some(&index), "{}", kernel.name());
                ControlFlow::<()>::Continue(())
            });
            assert!(end.unwrap().is_continue() && rest.next().is_none());
        }
        assert_eq!(many[at], found);
        // A visitor that stops is not called again.
        let mut seen = Vec::new();
        let end = index.visit(area, |index| {
            seen.push(index);
            if 2 * seen.len() >= visited.len() {
                ControlFlow::Break(index)
            } else {
                ControlFlow::Continue(())
            }
        });
        assert_eq!(end.unwrap().break_value(), seen.last().copied());
        assert_eq!(seen, visited[..visited.len().div_ceil(2)]);
    }
}

/// The nearest boxes are those of brute force, in its order, with every kernel.
fn neighbors_agree<const D: usize, T: Scalar>(
    boxes: &[Aabb<D, T>],
    points: &[[T; D]],
    k: usize,
    max_distance: f64,
) {
    let index = Index::new(boxes).unwrap();
    let many = index.neighbors_many(points, k, max_distance).unwrap();
    for (&point, many) in points.iter().zip(many.iter()) {
        let limit = max_distance * max_distance;
        let mut expected = by_distance(boxes, |aabb| {
            Some(distance_squared(point, aabb)).filter(|&distance| distance <= limit)
        });
        let mut all = Vec::new();
        let _ = index
            .visit_neighbors(point, max_distance, |neighbor| {
                all.push(neighbor);
                ControlFlow::<()>::Continue(())
            })
            .unwrap();
        assert_eq!(pairs_of_neighbors(&all), expected);
        expected.truncate(k);
        for kernel in Kernel::available() {
            let found = index.clone().kernel(kernel).neighbors(point, k, max_distance).unwrap();
            assert_eq!(pairs_of_neighbors(&found), expected, "{} {point:?}", kernel.name());
        }
        assert_eq!(pairs_of_neighbors(many), expected);
    }
}

fn casts_agree<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>], casts: &[Cast<D, T>]) {
    let index = Index::new(boxes).unwrap();
    let firsts = index.cast_many(casts).unwrap();
    for (cast, first) in casts.iter().zip(firsts) {
        let speed = cast.direction.map(T::to_f64);
        let expected =
            by_distance(boxes, |aabb| contact(&cast.from, speed, cast.limit.to_f64(), aabb));
        for kernel in Kernel::available() {
            let found = index.clone().kernel(kernel).cast_all(cast).unwrap();
            assert_eq!(pairs_of_hits(&found), expected, "{} {cast:?}", kernel.name());
        }
        assert_eq!(first.map(|hit| (hit.id, hit.t)), expected.first().copied());
        assert_eq!(index.cast(cast).unwrap(), first);
        let visited = index.visit_cast(cast, ControlFlow::Break).unwrap().break_value();
        assert_eq!(visited, first);
    }
}

/// A coordinate that is finite in either type.
fn finite<T: Scalar>() -> impl Strategy<Value = T> {
    coordinate().prop_map(|at: T| {
        if at < T::INFINITY && at > T::NEG_INFINITY { at } else { T::from_f64(0.5) }
    })
}

/// Boxes for up to four levels, seldom so many.
fn some_boxes<const D: usize, T: Scalar>() -> impl Strategy<Value = Vec<Aabb<D, T>>> {
    prop_oneof![
        3 => valid_boxes::<D, T>(40),
        1 => prop::collection::vec(valid_box(), 200..=600),
    ]
}

fn areas_agree_on_random_boxes<const D: usize, T: Scalar>() {
    let areas = prop::collection::vec(valid_box::<D, T>(), 1..6);
    proptest!(ProptestConfig::with_cases(128), |(boxes in some_boxes(), areas in areas)| {
        areas_agree(&boxes, &areas);
    });
}
in_all_dimensions!(areas_agree_with_brute_force, areas_agree_on_random_boxes);

fn neighbors_agree_on_random_boxes<const D: usize, T: Scalar>() {
    let points = prop::collection::vec(prop::array::uniform::<_, D>(finite::<T>()), 1..4);
    let limit = prop::sample::select(vec![0.0, 1e-45, 1.0, 1.5, 3.0, 1e200, f64::INFINITY]);
    proptest!(ProptestConfig::with_cases(128), |(
        boxes in some_boxes(), points in points, k in 0..20usize, limit in limit,
    )| {
        neighbors_agree(&boxes, &points, k, limit);
    });
}
in_all_dimensions!(neighbors_agree_with_brute_force, neighbors_agree_on_random_boxes);

/// Small whole numbers: then all times are exact enough to tie often.
fn small<T: Scalar>() -> impl Strategy<Value = T> {
    (-4..9i32).prop_map(|at| T::from_f64(at.into()))
}

fn casts_agree_on_random_boxes<const D: usize, T: Scalar>() {
    let corner = || prop::array::uniform::<_, D>(small::<T>());
    let cast = (corner(), corner(), prop::bool::ANY, small::<T>()).prop_map(
        |(from, direction, is_box, limit)| {
            let limit = if limit < T::default() { T::INFINITY } else { limit };
            let larger = from.map(|at| at + T::from_f64(1.0));
            if is_box {
                Cast::aabb(Aabb::new(from, larger), direction, limit)
            } else {
                Cast::ray(from, direction, limit)
            }
        },
    );
    let casts = prop::collection::vec(cast, 1..4);
    proptest!(ProptestConfig::with_cases(128), |(boxes in some_boxes(), casts in casts)| {
        casts_agree(&boxes, &casts);
    });
}
in_all_dimensions!(casts_agree_with_brute_force, casts_agree_on_random_boxes);

fn segments_agree_on_random_boxes<const D: usize, T: Scalar>() {
    let point = || {
        prop::array::uniform::<_, D>(prop_oneof![small::<T>(), (-1.0..4.0).prop_map(T::from_f64)])
    };
    proptest!(ProptestConfig::with_cases(128), |(boxes in some_boxes(), a in point(), b in point())| {
        // Boxes that end exactly where the segment does are met.
        let boxes = [boxes, vec![Aabb::new(b, b), Aabb::new(a, a)]].concat();
        let speed = std::array::from_fn(|axis| b[axis].to_f64() - a[axis].to_f64());
        let expected = by_distance(&boxes, |aabb| contact(&Aabb::new(a, a), speed, 1.0, aabb));
        let found = Index::new(&boxes).unwrap().segment(a, b).unwrap();
        prop_assert_eq!(pairs_of_hits(&found), expected);
        let end = boxes.len() as u32 - 2;
        prop_assert!(found.iter().any(|hit| hit.id == end && (hit.t == 1.0 || a == b)));
    });
}
in_all_dimensions!(segments_agree_with_brute_force, segments_agree_on_random_boxes);

/// Every scene, with more levels than random boxes have; areas from points to all.
fn all_agree_on_scenes<const D: usize, T: Scalar>() {
    for scene in Scene::ALL.iter().filter(|scene| scene.dimensions().contains(&D)) {
        for (len, seed) in [(0, 1), (1, 1), (16, 1), (17, 1), (256, 2), (257, 2), (4200, 3)] {
            let boxes = scene.boxes::<D, T>(len, seed).unwrap();
            let areas = scene.boxes::<D, T>(8, seed + 1).unwrap();
            let all = Aabb::new([T::NEG_INFINITY; D], [T::INFINITY; D]);
            let half = |area: &Aabb<D, T>| Aabb::new(area.min, [T::INFINITY; D]);
            let halves = areas.iter().map(half);
            let areas: Vec<_> = areas.iter().copied().chain(halves).chain([all]).collect();
            areas_agree(&boxes, &areas);
            let is_finite = |at: &T| *at < T::INFINITY && *at > T::NEG_INFINITY;
            let points: Vec<_> =
                areas.iter().map(|area| area.min).filter(|it| it.iter().all(is_finite)).collect();
            neighbors_agree(&boxes, &points, 5, f64::INFINITY);
        }
    }
}
in_all_dimensions!(the_index_agrees_on_every_scene, all_agree_on_scenes);

/// Bytes that were changed, at any place, give other results at worst.
fn any_bytes_are_safe<const D: usize, T: Scalar>() {
    let changes = prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..40);
    let input = (some_boxes::<D, T>(), changes, prop::bool::ANY, valid_box::<D, T>());
    proptest!(ProptestConfig::with_cases(256), |((boxes, changes, all, area) in input)| {
        let index = Index::new(&boxes).unwrap();
        let mut bytes = index.as_bytes().to_vec();
        if all {
            // Every lane overlaps everything, those without a box as well, and all indices are wrong.
            bytes[64..].fill(0xff);
            for word in bytes[64..].chunks_exact_mut(2 * 16 * T::BYTES) {
                let (min, max) = word.split_at_mut(16 * T::BYTES);
                for (column, at) in [(min, T::NEG_INFINITY), (max, T::INFINITY)] {
                    for lane in column.chunks_exact_mut(T::BYTES) {
                        lane.copy_from_slice(&at.to_raw().to_le_bytes()[..T::BYTES]);
                    }
                }
            }
        }
        for (at, byte) in &changes {
            let at = at.index(bytes.len());
            bytes[at] = *byte;
        }
        let Ok(index) = Bytes::<D, T>::from_bytes(&bytes[..]) else { return Ok(()) };
        let len = index.len();
        for kernel in Kernel::available() {
            let index = Bytes::<D, T>::from_bytes(&bytes[..]).unwrap().kernel(kernel);
            let found = index.search(&area).unwrap();
            // Unused lanes of the last leaf may hold boxes now.
            prop_assert!(found.len() <= 16 * len && found.iter().all(|&id| (id as usize) < len));
            let mut visited = 0;
            let _ = index.visit(&area, |id| {
                visited += 1;
                assert!((id as usize) < len && visited <= 16 * len);
                ControlFlow::<()>::Continue(())
            }).unwrap();
            let near = index.neighbors([T::default(); D], usize::MAX, f64::INFINITY).unwrap();
            prop_assert!(near.len() <= len && near.iter().all(|it| (it.id as usize) < len));
            let cast = Cast::ray([T::default(); D], [T::from_f64(1.0); D], T::INFINITY);
            let hits = index.cast_all(&cast).unwrap();
            prop_assert!(hits.len() <= len && hits.iter().all(|hit| (hit.id as usize) < len));
        }
    });
}
in_all_dimensions!(any_bytes_are_harmless, any_bytes_are_safe);

#[test]
fn bytes_that_are_no_such_index_are_refused() {
    let index = Index::new(&Scene::Uniform.boxes::<2, f32>(300, 1).unwrap()).unwrap();
    let bytes = index.as_bytes();
    let fault = |bytes: &[u8]| match Bytes::<2, f32>::from_bytes(bytes) {
        Err(Error::InvalidIndex(fault)) => Some(fault),
        Err(other) => panic!("{other}"),
        Ok(_) => None,
    };
    assert_eq!(fault(bytes), None);
    assert_eq!(fault(b"PNG and more"), Some(IndexFault::Foreign));
    for cut in [0, 3, 10, 63] {
        assert_eq!(fault(&bytes[..cut]), Some(IndexFault::Truncated));
    }
    for length in [64, bytes.len() - 1] {
        let expected = IndexFault::Length { found: length, boxes: 300 };
        assert_eq!(fault(&bytes[..length]), Some(expected));
    }
    let longer = [bytes, &[0]].concat();
    let expected = IndexFault::Length { found: longer.len(), boxes: 300 };
    assert_eq!(fault(&longer), Some(expected));
    assert_eq!(
        Error::InvalidIndex(expected).to_string(),
        format!(
            "an index of 300 boxes does not have {} bytes: some are missing, or there are too many",
            longer.len()
        )
    );
    let with = |at: usize, value: u8| {
        let mut changed = bytes.to_vec();
        changed[at] = value;
        fault(&changed)
    };
    assert_eq!(with(4, 9), Some(IndexFault::Version { found: 9 }));
    assert_eq!(with(5, 3), Some(IndexFault::OtherIndex { dimensions: 3, scalar_bytes: 4 }));
    assert_eq!(with(6, 8), Some(IndexFault::OtherIndex { dimensions: 2, scalar_bytes: 8 }));
    // Counts that overflow every size that is computed from them.
    for at in 8..16 {
        assert!(matches!(with(at, 0xff), Some(IndexFault::Length { .. })), "byte {at}");
    }
    let mut changed = bytes.to_vec();
    changed[8..16].fill(0xff);
    let expected = IndexFault::Length { found: bytes.len(), boxes: u64::MAX };
    assert_eq!(fault(&changed), Some(expected));
    assert_eq!(
        Error::InvalidIndex(IndexFault::OtherIndex { dimensions: 3, scalar_bytes: 8 }).to_string(),
        "this is an index of 3 dimensions and f64 coordinates: read it as `Index<3, f64>`"
    );
    let info = IndexInfo::read(bytes).unwrap();
    assert_eq!((info.dimensions, info.scalar_bytes, info.len), (2, 4, 300));
}

#[test]
fn bytes_at_any_address_are_an_index_and_the_own_ones_are_aligned() {
    let boxes = Scene::Clustered.boxes::<3, f64>(1000, 1).unwrap();
    let index = Index::new(&boxes).unwrap();
    assert_eq!(index.as_bytes().as_ptr().addr() % 64, 0);
    let area = boxes[500];
    let expected = index.search(&area).unwrap();
    let mut shifted = vec![0];
    for _ in 0..8 {
        let start = shifted.len();
        let bytes = [&shifted[..], index.as_bytes()].concat();
        let other = Bytes::<3, f64>::from_bytes(&bytes[start..]).unwrap();
        assert_eq!(other.search(&area).unwrap(), expected);
        let copy = Index::<3, f64>::copy_from_bytes(&bytes[start..]).unwrap();
        assert_eq!(copy.as_bytes().as_ptr().addr() % 64, 0);
        assert_eq!(copy.as_bytes(), index.as_bytes());
        assert_eq!(copy.clone().as_bytes(), index.as_bytes());
        shifted.push(0);
    }
}

/// The same bytes in every build and on every machine. A change of the format or of the order changes
/// them, and takes a new version where old bytes would be read wrongly.
#[test]
fn the_bytes_are_the_same_on_every_machine() {
    fn of<const D: usize, T: Scalar>(scene: Scene, len: usize) -> u64 {
        let index = Index::new(&scene.boxes::<D, T>(len, 5).unwrap()).unwrap();
        hash(index.as_bytes().iter().copied())
    }
    let hashes = [
        of::<1, f32>(Scene::Uniform, 1000),
        of::<2, f32>(Scene::Uniform, 20_000),
        of::<2, f32>(Scene::Clustered, 5000),
        of::<2, f64>(Scene::Clustered, 5000),
        of::<3, f32>(Scene::Uniform, 5000),
        of::<3, f64>(Scene::Clustered, 20_000),
        of::<2, f32>(Scene::Extreme, 1000),
        of::<3, f64>(Scene::Extreme, 1000),
        of::<2, f32>(Scene::Uniform, 0),
    ];
    let expected = [
        0x4a35_3cd5_4012_f25d,
        0x7a20_a774_4150_84d4,
        0x2c06_7c28_fc87_b682,
        0xefe1_3740_7588_496e,
        0x77ac_1551_d36b_27ed,
        0xf18d_f6e4_8222_0c3d,
        0xda04_8837_5cb5_178c,
        0x7421_2d18_f404_74cb,
        0x7c2f_db24_eea4_ea69,
    ];
    assert_eq!(hashes, expected, "{hashes:#x?}");
}

/// Boxes by a formula of whole numbers, which the tests of JavaScript and Python have too.
#[test]
fn the_bytes_are_those_of_javascript_and_python() {
    let mut state = 1u32;
    let mut next = |shift: u32| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> shift) / 65_536.0
    };
    let boxes: Vec<_> = (0..5000)
        .map(|_| {
            let [x, y, width, height] = [next(8), next(8), next(16), next(16)];
            Aabb::new([x as f32, y as f32], [(x + width) as f32, (y + height) as f32])
        })
        .collect();
    let index = Index::new(&boxes).unwrap();
    assert_eq!(hash(index.as_bytes().iter().copied()), 0x1ee4_20eb_2337_ff0b);
}

#[test]
fn an_invalid_box_area_point_or_cast_is_refused_by_name() {
    let good = Aabb::new([0.0, 0.0], [1.0, 1.0]);
    let inverted = Aabb::new([0.0, 2.0], [1.0, 1.0]);
    let error =
        |index| Error::InvalidBox { set: 0, index, axis: 1, min: 2.0.into(), max: 1.0.into() };
    assert_eq!(Index::new(&[good, good, inverted]).unwrap_err(), error(2));
    let index = Index::<2, f64>::new(&[good]).unwrap();
    assert_eq!(index.search(&inverted), Err(error(0)));
    assert_eq!(index.search_many(&[good, inverted]).unwrap_err(), error(1));
    assert_eq!(index.visit(&inverted, |_| ControlFlow::Break(())), Err(error(0)));
    let nan = f64::NAN;
    let message = |error: Error| error.to_string();
    assert_eq!(
        message(index.neighbors([0.0, nan], 1, 1.0).unwrap_err()),
        "`point` of query 0 is NaN, but it may not be NaN"
    );
    assert_eq!(
        message(index.neighbors_many(&[[0.0; 2], [f64::INFINITY, 0.0]], 1, 1.0).unwrap_err()),
        "`point` of query 1 is inf, but it must be finite"
    );
    assert_eq!(
        message(index.neighbors([0.0, 0.0], 1, -1.0).unwrap_err()),
        "`max_distance` of query 0 is -1, but it must be 0 or more"
    );
    let bad = Cast::ray([0.0, 0.0], [1.0, nan], 1.0);
    assert_eq!(
        message(index.cast_many(&[Cast::ray([0.0; 2], [1.0; 2], 1.0), bad]).unwrap_err()),
        "`direction` of query 1 is NaN, but it may not be NaN"
    );
    assert_eq!(
        message(index.segment([f64::MIN, 0.0], [f64::MAX, 0.0]).unwrap_err()),
        "`to` of query 0 is inf, but it must be finite"
    );
}

/// Equal boxes, and boxes on a line: the cuts must end, and take no more than a moment.
#[test]
fn equal_boxes_and_far_outliers_are_no_trouble() {
    let mut boxes = vec![Aabb::new([1.0f32, 1.0], [2.0, 2.0]); 50_000];
    boxes[7] = Aabb::new([f32::NEG_INFINITY; 2], [f32::INFINITY; 2]);
    boxes[49_000] = Aabb::new([1e30; 2], [1e38; 2]);
    let index = Index::new(&boxes).unwrap();
    let found = index.search(&Aabb::new([1.5; 2], [1.5; 2])).unwrap();
    assert_eq!(found.len(), 49_999);
    assert_eq!(sorted(index.search(&Aabb::new([1e31; 2], [1e31; 2])).unwrap()), [7, 49_000]);
}

#[cfg(feature = "parallel")]
#[test]
fn threads_change_nothing() {
    let boxes = Scene::Clustered.boxes::<2, f32>(20_000, 1).unwrap();
    let (one, three) = (Index::new(&boxes).unwrap(), Index::new(&boxes).unwrap().threads(3));
    assert_eq!(one.search_many(&boxes).unwrap(), three.search_many(&boxes).unwrap());
    let points: Vec<_> = boxes.iter().map(|aabb| aabb.max).collect();
    let near = |index: &Index<2>| index.neighbors_many(&points, 3, f64::INFINITY).unwrap();
    assert_eq!(near(&one), near(&three));
    let casts: Vec<_> =
        points.iter().map(|&point| Cast::ray(point, [1.0, 0.5], f32::INFINITY)).collect();
    assert_eq!(one.cast_many(&casts).unwrap(), three.cast_many(&casts).unwrap());
    assert!(three.search_many(&[]).unwrap().is_empty());
}
