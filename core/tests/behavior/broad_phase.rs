//! The persistent broad phase against brute force: random sequences of every operation, with coordinates so
//! few that ties are common, in 1D to 3D, `f32` and `f64`.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use crate::broad_phase_model::{Model, Pair};
use sweep_and_prune::{
    Aabb, BroadPhase, Cast, Error, Filter, Hit, Options, PairFinder, ProxyId, Report, Scalar,
    SnapshotFault, SnapshotInfo,
};
use sweep_and_prune_scenes::{Motion, Random, Scene};

const STEPS: usize = 200;

/// How many sequences are run of each dimension and precision: with `./test --long` 10,000 in all.
fn sequences() -> core::ops::Range<u64> {
    let is_long = std::env::var_os("TEST_LONG").is_some();
    0..match (cfg!(debug_assertions), is_long) {
        (true, _) => 20,
        (false, false) => 150,
        (false, true) => 1667,
    }
}

#[test]
fn random_sequences_in_1d_agree_with_the_oracle() {
    sequences().for_each(Sequence::<1, f32>::run);
    sequences().for_each(Sequence::<1, f64>::run);
}

#[test]
fn random_sequences_in_2d_agree_with_the_oracle() {
    sequences().for_each(Sequence::<2, f32>::run);
    sequences().for_each(Sequence::<2, f64>::run);
}

#[test]
fn random_sequences_in_3d_agree_with_the_oracle() {
    sequences().for_each(Sequence::<3, f32>::run);
    sequences().for_each(Sequence::<3, f64>::run);
}

fn sorted<V: Ord>(values: impl Iterator<Item = V>) -> Vec<V> {
    let mut values: Vec<_> = values.collect();
    values.sort_unstable();
    values
}

/// A world and its model under the same random calls.
struct Sequence<const D: usize, T: Scalar> {
    random: Random,
    world: BroadPhase<D, T>,
    model: Model<D, T>,
    /// What the last update found.
    changes: (Vec<Pair>, Vec<Pair>),
    /// Ids of bodies that are gone.
    stale: Vec<ProxyId>,
    /// Size and place of the world.
    unit: f64,
    origin: f64,
    /// About how many bodies.
    crowd: usize,
}

impl<const D: usize, T: Scalar> Sequence<D, T> {
    fn run(seed: u64) {
        let mut random = Random::new(seed * 3 + D as u64);
        let pick = |random: &mut Random, of: &[f64]| of[random.below(of.len())];
        let report = if random.below(3) == 0 { Report::Fat } else { Report::Exact };
        let margin = T::from_f64(pick(&mut random, &[0.0, 0.0, 0.5, 1.0]));
        let prediction = T::from_f64(pick(&mut random, &[0.0, 0.0, 1.0, 2.5]));
        let options = Options::default().margin(margin).prediction(prediction).report(report);
        let unit = pick(&mut random, &[1.0, 1.0, 1.0, 0.25, 1e30, 1e-30]);
        let origin = if unit == 1.0 { pick(&mut random, &[0.0, 0.0, 1e7, -3e7]) } else { 0.0 };
        let crowd = if random.below(16) == 0 { 150 } else { 2 + random.below(14) };
        let world = BroadPhase::with_options(options).unwrap();
        let model = Model::new(options);
        let mut sequence = Self {
            random,
            world,
            model,
            changes: Default::default(),
            stale: vec![],
            unit,
            origin,
            crowd,
        };
        for step in 0..STEPS {
            sequence.step();
            sequence.check_state();
            if std::env::var_os("TRACE").is_some() {
                eprintln!("seed {seed} step {step}");
            }
        }
    }

    fn step(&mut self) {
        match self.random.below(24) {
            0..=3 => self.insert(),
            4..=5 => self.remove(),
            6..=8 => self.set_some(),
            9..=11 => self.drift(),
            12 => self.sweep(),
            13 => self.refilter(),
            14 => self.snapshot(),
            15 => self.query(),
            16 => self.misuse(),
            _ => self.update(),
        }
    }

    fn chance(&mut self, one_in: usize) -> bool {
        self.random.below(one_in) == 0
    }

    fn coordinate(&mut self) -> f64 {
        self.random.below(8) as f64
    }

    fn scale(&self, at: f64) -> T {
        T::from_f64(at * self.unit + self.origin)
    }

    fn aabb(&mut self) -> Aabb<D, T> {
        let is_special = self.chance(20);
        let kind = self.random.below(4);
        let mut aabb = Aabb::new([T::default(); D], [T::default(); D]);
        for axis in 0..D {
            let low = self.coordinate();
            let high = low + self.random.below(3) as f64;
            (aabb.min[axis], aabb.max[axis]) = (self.scale(low), self.scale(high));
            if is_special {
                match kind {
                    0 => aabb.min[axis] = T::NEG_INFINITY,
                    1 => aabb.max[axis] = T::INFINITY,
                    2 => (aabb.min[axis], aabb.max[axis]) = (T::INFINITY, T::INFINITY),
                    _ => {
                        aabb.min[axis] = self.scale(-1e6);
                        aabb.max[axis] = self.scale(1e6);
                    }
                }
            }
        }
        aabb
    }

    fn new_filter(&mut self) -> Filter {
        if self.chance(2) {
            return Filter::default();
        }
        Filter::default()
            .category(1 << self.random.below(2))
            .mask(if self.chance(8) { 0 } else { self.random.below(4) as u32 | u32::MAX << 2 })
            .group(self.random.below(5) as i32 - 2)
            .is_static(self.chance(3))
    }

    fn some_ids(&mut self) -> Vec<ProxyId> {
        let part = 1 + self.random.below(8);
        let ids: Vec<_> = self.world.ids().collect();
        ids.into_iter().filter(|_| self.random.below(part) == 0).collect()
    }

    fn some_id(&mut self) -> Option<ProxyId> {
        let ids: Vec<_> = self.world.ids().collect();
        (!ids.is_empty()).then(|| ids[self.random.below(ids.len())])
    }

    fn insert(&mut self) {
        if self.model.bodies.len() >= 2 * self.crowd {
            return;
        }
        let filter = self.new_filter();
        if self.chance(3) {
            let boxes: Vec<_> = (0..self.crowd / 2).map(|_| self.aabb()).collect();
            let ids = self.world.insert_many(&boxes, filter).unwrap();
            for (&id, &aabb) in ids.iter().zip(&boxes) {
                self.model.insert(id, aabb, filter);
            }
        } else {
            let aabb = self.aabb();
            let id = self.world.insert_with(aabb, filter).unwrap();
            self.model.insert(id, aabb, filter);
        }
    }

    fn remove(&mut self) {
        let ids =
            if self.chance(6) { self.some_ids() } else { self.some_id().into_iter().collect() };
        self.world.remove_many(&ids).unwrap();
        for &id in &ids {
            self.model.remove(id);
        }
        self.stale.extend(ids);
    }

    /// Gives some bodies boxes anywhere.
    fn set_some(&mut self) {
        let ids = self.some_ids();
        let boxes: Vec<_> = ids.iter().map(|_| self.aabb()).collect();
        self.world.set_many(&ids, &boxes).unwrap();
        for (&id, &aabb) in ids.iter().zip(&boxes) {
            self.model.set(id, aabb);
        }
    }

    /// Moves some bodies by a little, or by the same step as all others.
    fn drift(&mut self) {
        let ids = self.some_ids();
        let step = self.random.below(3) as f64 * 0.5 - 0.5;
        for id in ids {
            let mut aabb = self.world.aabb(id).unwrap();
            for axis in 0..D {
                let way = T::from_f64(step * self.unit);
                aabb.min[axis] = aabb.min[axis] + way;
                aabb.max[axis] = aabb.max[axis] + way;
            }
            self.world.set(id, aabb).unwrap();
            self.model.set(id, aabb);
        }
    }

    fn sweep(&mut self) {
        if let Some(id) = self.some_id() {
            let (from, to) = (self.aabb(), self.aabb());
            self.world.set_swept(id, from, to).unwrap();
            self.model.set_swept(id, from, to);
        }
    }

    fn refilter(&mut self) {
        if let Some(id) = self.some_id() {
            let filter = self.new_filter();
            self.world.set_filter(id, filter).unwrap();
            self.model.set_filter(id, filter);
        }
    }

    fn update(&mut self) {
        let changes = self.world.update();
        self.changes = (changes.begun().collect(), changes.ended().collect());
        assert_eq!(self.changes, self.model.update());
        assert_eq!(sorted(self.world.pairs()), self.model.pairs());
    }

    /// What has to be so at any time.
    fn check_state(&mut self) {
        assert!(self.world.ids().eq(self.model.bodies.keys().copied()));
        assert_eq!(self.world.len(), self.model.bodies.len());
        assert!(self.world.changes().begun().eq(self.changes.0.iter().copied()));
        assert!(self.world.changes().ended().eq(self.changes.1.iter().copied()));
        if let Some(id) = self.some_id() {
            let body = &self.model.bodies[&id];
            assert_eq!(self.world.aabb(id).unwrap(), body.aabb);
            assert_eq!(self.world.reported_aabb(id).unwrap(), body.reported);
            assert_eq!(self.world.filter(id).unwrap(), body.filter);
            assert_eq!(sorted(self.world.pairs_of(id).unwrap()), self.model.pairs_of(id));
        }
    }

    /// Goes on with a restored world, or with both side by side for a while.
    fn snapshot(&mut self) {
        let bytes = self.world.snapshot();
        let mut restored = BroadPhase::<D, T>::from_snapshot(&bytes).unwrap();
        assert_eq!(restored.snapshot(), bytes);
        assert_eq!(restored.state_hash(), self.world.state_hash());
        assert_eq!(sorted(restored.pairs()), sorted(self.world.pairs()));
        if self.chance(2) {
            // Same calls, same ids, same events.
            let aabb = self.aabb();
            let mut other = self.world.clone();
            for world in [&mut restored, &mut other] {
                world.insert(aabb).unwrap();
                world.update();
                world.insert(aabb).unwrap();
            }
            let events = |world: &mut BroadPhase<D, T>| {
                let changes = world.update();
                (changes.begun().collect::<Vec<_>>(), changes.ended().collect::<Vec<_>>())
            };
            assert_eq!(events(&mut restored), events(&mut other));
            assert_eq!(restored.snapshot(), other.snapshot());
        } else {
            self.world = restored;
            self.changes = Default::default();
        }
        // Any truncation and any flipped bit is noticed.
        let cut = self.random.below(bytes.len());
        assert!(BroadPhase::<D, T>::from_snapshot(&bytes[..cut]).is_err());
        let mut damaged = bytes;
        damaged[cut] ^= 1 << self.random.below(8);
        assert!(BroadPhase::<D, T>::from_snapshot(&damaged).is_err());
    }

    fn query(&mut self) {
        let filter = if self.chance(2) { None } else { Some(self.new_filter()) };
        let area = self.aabb();
        let point: [T; D] = std::array::from_fn(|_| {
            let at = self.coordinate();
            self.scale(at)
        });
        let radius = T::from_f64(self.random.below(5) as f64 * self.unit);
        let direction: [T; D] =
            std::array::from_fn(|_| T::from_f64((self.random.below(5) as f64 - 2.0) * self.unit));
        let limit = T::from_f64([0.0, 0.5, 1.0, 3.0, f64::INFINITY][self.random.below(5)]);
        let k = self.random.below(6);
        let corner = Aabb::new(point, point);
        let from = if self.chance(2) {
            corner
        } else {
            Aabb::new(point, point.map(|at| at + T::from_f64(self.unit)))
        };
        let cast = Cast::aabb(from, direction, limit);

        let queries = self.world.queries();
        let queries = filter.map_or(queries, |filter| queries.with_filter(filter));
        let model = &self.model;
        assert_eq!(queries.overlapping(&area).unwrap(), model.overlapping(&area, &filter));
        assert_eq!(queries.containing(point).unwrap(), model.overlapping(&corner, &filter));
        assert_eq!(queries.within(point, radius).unwrap(), model.within(point, radius, &filter));
        let hits = model.hits(&cast, &filter);
        let pairs = |hits: Vec<Hit>| hits.iter().map(|hit| (hit.t, hit.id)).collect::<Vec<_>>();
        assert_eq!(pairs(queries.cast_all(&cast).unwrap()), hits);
        let first = queries.cast(&cast).unwrap();
        assert_eq!(first.map(|hit| (hit.t, hit.id)), hits.first().copied());
        let nearest = queries.nearest(point, k).unwrap();
        let nearest: Vec<_> = nearest.iter().map(|it| (it.distance_squared, it.id)).collect();
        assert_eq!(nearest, model.nearest(point, k, &filter));

        // A visitor that stops the search is not called again.
        let mut left = k;
        let mut count = 0;
        queries
            .visit_overlapping(&area, |_| {
                count += 1;
                left = left.saturating_sub(1);
                if left == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            })
            .unwrap();
        assert_eq!(count, model.overlapping(&area, &filter).len().min(k.max(1)));
        let mut seen = vec![];
        queries
            .cast_with(&cast, |hit| {
                seen.push((hit.t, hit.id));
                if seen.len() == k {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(f64::INFINITY)
                }
            })
            .unwrap();
        assert!(seen.iter().all(|hit| hits.contains(hit)));
        assert_eq!(seen.len(), if k == 0 { hits.len() } else { hits.len().min(k) });
    }

    /// Calls that are refused, after which nothing has changed.
    fn misuse(&mut self) {
        let before = self.world.snapshot();
        let good = self.aabb();
        let mut bad = good;
        let axis = self.random.below(D);
        bad.min[axis] = T::from_f64(f64::NAN);
        let mut inverted = good;
        (inverted.min[axis], inverted.max[axis]) = (T::INFINITY, T::NEG_INFINITY);
        let invalid = |index, aabb: Aabb<D, T>| {
            let [min, max] = [aabb.min, aabb.max].map(|corner| corner[axis].to_f64().into());
            Error::InvalidBox { set: 0, index, axis, min, max }
        };
        let stale = |index, id: ProxyId| Error::StaleProxy { index, id: id.to_bits() };
        let world = &mut self.world;
        assert_eq!(world.insert(bad), Err(invalid(0, bad)));
        let refused = Err(invalid(1, inverted));
        assert_eq!(world.insert_many(&[good, inverted], Filter::default()), refused);
        if let Some(&gone) = self.stale.last() {
            let refused = Err(stale(0, gone));
            assert_eq!(world.set(gone, good), refused);
            assert_eq!(world.set_swept(gone, good, good), refused);
            assert_eq!(world.set_filter(gone, Filter::ALL), refused);
            assert_eq!(world.remove(gone), refused);
            assert_eq!(world.aabb(gone), Err(stale(0, gone)));
            assert!(world.pairs_of(gone).is_err() && !world.contains(gone));
        }
        let alive: Option<ProxyId> = world.ids().last();
        if let Some(id) = alive {
            assert_eq!(world.set(id, bad), Err(invalid(0, bad)));
            assert_eq!(world.set_swept(id, good, inverted), Err(invalid(1, inverted)));
            assert_eq!(world.set_many(&[id, id], &[good, bad]), Err(invalid(1, bad)));
            let mismatch = Error::LengthMismatch { ids: 1, boxes: 2 };
            assert_eq!(world.set_many(&[id], &[good, good]), Err(mismatch));
            assert_eq!(world.remove_many(&[id, id]), Err(stale(1, id)));
            let foreign = ProxyId::from_bits(id.to_bits() + (1 << 32));
            assert_eq!(world.set_many(&[id, foreign], &[good; 2]), Err(stale(1, foreign)));
            assert_eq!(world.remove_many(&[id, foreign]), Err(stale(1, foreign)));
        }
        let nan = [T::from_f64(f64::NAN); D];
        let zero = [T::default(); D];
        let queries = world.queries();
        let refused =
            |argument, value: f64| Error::InvalidQuery { index: 0, argument, value: value.into() };
        assert_eq!(queries.overlapping(&bad), Err(invalid(0, bad)));
        assert_eq!(queries.containing(nan), Err(refused("point", f64::NAN)));
        assert_eq!(queries.within(zero, T::from_f64(-1.0)), Err(refused("radius", -1.0)));
        let endless = [T::INFINITY; D];
        let error = Err(refused("center", f64::INFINITY));
        assert_eq!(queries.within(endless, T::default()), error);
        assert_eq!(queries.nearest(nan, 3), Err(refused("point", f64::NAN)));
        let error = Err(refused("direction", f64::NAN));
        assert_eq!(queries.cast(&Cast::ray(zero, nan, T::INFINITY)), error);
        let error = Err(refused("limit", -1.0));
        assert_eq!(queries.cast(&Cast::ray(zero, zero, T::from_f64(-1.0))), error);
        assert_eq!(world.snapshot(), before);
    }
}

/// Larger worlds, in which trees have levels and storage is reordered: the pairs after each update
/// are those of the finder, and the events what changed.
fn check_motion<const D: usize>(scene: Scene, seed: u64, steps: usize) {
    let count = if matches!(scene, Scene::Coincident | Scene::Nested) { 200 } else { 1500 };
    let mut random = Random::new(seed);
    let mut boxes = scene.boxes::<D, f64>(count, seed).unwrap();
    let mut world = BroadPhase::<D, f64>::new();
    let ids = world.insert_many(&boxes, Filter::default()).unwrap();
    let mut finder = PairFinder::<D, f64>::new();
    let mut live: Vec<Pair> = vec![];
    for step in 0..steps {
        // All drift, some jump, few or none move, everything is elsewhere.
        let (share, jumps) =
            [(1.0, 0.0), (1.0, 0.02), (0.02, 0.5), (0.1, 0.0), (0.0, 0.0), (1.0, 1.0)]
                [if step % 7 == 6 { 5 } else { step / 8 % 5 }];
        for aabb in &mut boxes {
            if random.unit() < share {
                let jump = if random.unit() < jumps { 1.0 } else { 0.002 };
                for axis in 0..D {
                    let way = jump * (random.unit() - 0.5);
                    aabb.min[axis] += way;
                    aabb.max[axis] = (aabb.max[axis] + way).max(aabb.min[axis]);
                }
            }
        }
        world.set_many(&ids, &boxes).unwrap();
        let changes = world.update();
        let (begun, ended): (Vec<Pair>, Vec<Pair>) =
            (changes.begun().collect(), changes.ended().collect());
        let pairs = finder.find(&boxes).unwrap();
        let mut now: Vec<Pair> = pairs.iter().map(|p| p.map(|index| ids[index as usize])).collect();
        now.sort_unstable();
        let missing = |from: &[Pair], of: &[Pair]| -> Vec<Pair> {
            of.iter().filter(|pair| from.binary_search(pair).is_err()).copied().collect()
        };
        assert_eq!(begun, missing(&live, &now), "{scene:?} {step}");
        assert_eq!(ended, missing(&now, &live), "{scene:?} {step}");
        assert_eq!(sorted(world.pairs()), now);
        live = now;
        let area = boxes[step % count];
        let found = world.queries().overlapping(&area).unwrap();
        let expected = ids.iter().zip(&boxes).filter(|(_, aabb)| aabb.overlaps(&area));
        assert!(expected.map(|(&id, _)| id).eq(found));
    }
}

#[test]
fn large_worlds_report_the_changes_of_any_motion() {
    let steps = if cfg!(debug_assertions) { 42 } else { 210 };
    for scene in [
        Scene::Uniform,
        Scene::Clustered,
        Scene::Tower,
        Scene::Slab,
        Scene::Mixed,
        Scene::Coincident,
        Scene::Nested,
    ] {
        check_motion::<2>(scene, 1, steps);
        check_motion::<3>(scene, 2, steps);
    }
}

/// Tables of more than 1 MiB, of which rows are prefetched.
#[test]
fn tables_larger_than_the_cache_give_the_same_changes() {
    for motion in Motion::ALL {
        let mut moving = motion.start::<3, f64>(25_000, 3).unwrap();
        let mut world = BroadPhase::<3, f64>::new();
        let ids = world.insert_many(moving.boxes(), Filter::default()).unwrap();
        let mut finder = PairFinder::<3, f64>::new();
        let mut live: BTreeSet<Pair> = BTreeSet::new();
        for frame in 0..6 {
            let changes = world.update();
            for pair in changes.ended() {
                assert!(live.remove(&pair), "{motion:?} {frame}");
            }
            for pair in changes.begun() {
                assert!(live.insert(pair), "{motion:?} {frame}");
            }
            let pairs = finder.find(moving.boxes()).unwrap();
            assert_eq!(live.len(), pairs.len(), "{motion:?} {frame}");
            assert!(pairs.iter().all(|pair| live.contains(&pair.map(|index| ids[index as usize]))));
            let before = moving.boxes().to_vec();
            moving.advance();
            let moved = (0..ids.len()).filter(|&index| before[index] != moving.boxes()[index]);
            let (ids, boxes): (Vec<_>, Vec<_>) =
                moved.map(|index| (ids[index], moving.boxes()[index])).unzip();
            world.set_many(&ids, &boxes).unwrap();
        }
    }
}

#[test]
fn a_sleeping_body_wakes_with_all_its_pairs() {
    let mut random = Random::new(11);
    let mut world = BroadPhase::<2, f64>::new();
    let mut model = Model::new(Options::default());
    let mut ids = vec![];
    let draw = |random: &mut Random| {
        let at: [f64; 2] = random.point();
        Aabb::new(at, at.map(|at| at + 0.06))
    };
    let still = Filter::STATIC;
    let odd = Filter::default().category(2).mask(1);
    let filters = [Filter::default(), Filter::default(), Filter::default(), still, odd];
    for _ in 0..400 {
        let (aabb, filter) = (draw(&mut random), filters[random.below(filters.len())]);
        let id = world.insert_with(aabb, filter).unwrap();
        model.insert(id, aabb, filter);
        ids.push(id);
    }
    for step in 0..700 {
        let mut shove = |which: usize, most: f64, random: &mut Random| {
            let mut aabb = model.bodies[&ids[which]].aabb;
            for axis in 0..2 {
                let way = most * (random.unit() - 0.5);
                aabb.min[axis] += way;
                aabb.max[axis] += way;
            }
            world.set(ids[which], aabb).unwrap();
            model.set(ids[which], aabb);
        };
        // The same few bodies move all the time; now and then another one, none for a while, or all.
        let movers = if step % 230 == 229 { ids.len() } else { 20 };
        if step / 20 % 10 != 9 {
            (0..movers).for_each(|which| shove(which, 0.01, &mut random));
        }
        let any = random.below(ids.len());
        match random.below(10) {
            0 => shove(any, 0.01, &mut random),
            1 => shove(any, 2.0, &mut random),
            2 => {
                let filter = filters[random.below(filters.len())];
                world.set_filter(ids[any], filter).unwrap();
                model.set_filter(ids[any], filter);
            }
            3 => {
                world.remove(ids[any]).unwrap();
                model.remove(ids[any]);
                let aabb = draw(&mut random);
                ids[any] = world.insert(aabb).unwrap();
                model.insert(ids[any], aabb, Filter::default());
            }
            4 if step % 50 == 0 => world = BroadPhase::from_snapshot(&world.snapshot()).unwrap(),
            _ => {}
        }
        assert_eq!(sorted(world.pairs_of(ids[any]).unwrap()), model.pairs_of(ids[any]), "{step}");
        let changes = world.update();
        let (begun, ended) = model.update();
        assert!(changes.begun().eq(begun), "{step}");
        assert!(changes.ended().eq(ended), "{step}");
        assert_eq!(sorted(world.pairs()), model.pairs(), "{step}");
        let any = ids[random.below(ids.len())];
        assert_eq!(sorted(world.pairs_of(any).unwrap()), model.pairs_of(any), "{step}");
    }
}

#[test]
fn sizes_may_differ_by_a_million_and_more() {
    let mut world = BroadPhase::<3>::new();
    let mut random = Random::new(5);
    let mut boxes = vec![];
    for index in 0..600 {
        let half = 10f32.powi(index % 12 - 9);
        let at: [f64; 3] = random.point();
        let at = at.map(|at| at as f32);
        boxes.push(Aabb::new(at.map(|at| at - half), at.map(|at| at + half)));
    }
    let ids = world.insert_many(&boxes, Filter::default()).unwrap();
    for _ in 0..40 {
        for aabb in boxes.iter_mut().step_by(13) {
            let way = (random.unit() as f32 - 0.5) * 0.01;
            for axis in 0..3 {
                aabb.min[axis] += way;
                aabb.max[axis] += way;
            }
        }
        world.set_many(&ids, &boxes).unwrap();
        world.update();
        let pairs = sweep_and_prune::algorithms::pairwise(&boxes).unwrap();
        let expected = pairs.iter().map(|pair| pair.map(|index| ids[index as usize]));
        assert!(sorted(world.pairs()).into_iter().eq(expected));
    }
}

#[test]
fn a_heap_of_static_bodies_costs_no_pairs() {
    // 100,000 in one place would be five billion pairs.
    let heap = vec![Aabb::new([0.0, 0.0], [1.0, 1.0]); 100_000];
    let mut world = BroadPhase::<2>::new();
    world.insert_many(&heap, Filter::STATIC).unwrap();
    world.insert(Aabb::new([0.5, 0.5], [0.5, 0.5])).unwrap();
    assert_eq!(world.update().begun().len(), heap.len());
    let bytes = world.snapshot();
    assert_eq!(BroadPhase::<2>::from_snapshot(&bytes).unwrap().pairs().count(), heap.len());
}

#[test]
fn a_body_in_a_reused_slot_is_found_where_the_removed_body_was() {
    let mut world = BroadPhase::<2>::new();
    let [here, there] = [0.0, 5.0].map(|at| Aabb::new([at; 2], [at + 1.0; 2]));
    let first = world.insert(here).unwrap();
    world.update();
    world.remove(first).unwrap();
    world.update();
    let second = world.insert(there).unwrap();
    assert_eq!(world.queries().overlapping(&there).unwrap(), [second]);
    world.set_many(&[second], &[here]).unwrap();
    assert_eq!(world.queries().overlapping(&here).unwrap(), [second]);
    assert_eq!(world.queries().overlapping(&there).unwrap(), []);
}

#[test]
fn a_point_at_infinity_pairs_beside_bodies_of_the_largest_size() {
    let mut world = BroadPhase::<1, f64>::new();
    let wide = |shift: f64| Aabb::new([-8e307 + shift], [8e307 + shift]);
    let endless = world.insert(Aabb::new([0.0], [f64::INFINITY])).unwrap();
    let large: Vec<_> = (0..2).map(|_| world.insert(wide(0.0)).unwrap()).collect();
    let small: Vec<_> = (0..60)
        .map(|index| world.insert(Aabb::new([-f64::from(index) - 2.0], [-f64::from(index) - 1.5])))
        .map(Result::unwrap)
        .collect();
    world.update();
    for step in 1..4 {
        for &id in &large {
            world.set(id, wide(1e306 * f64::from(step))).unwrap();
        }
        for &id in &small {
            let Aabb { min: [min], max: [max] } = world.aabb(id).unwrap();
            world.set(id, Aabb::new([min - 0.01], [max - 0.01])).unwrap();
        }
        world.update();
    }
    let point = world.insert(Aabb::new([f64::INFINITY], [f64::INFINITY])).unwrap();
    assert!(world.update().begun().eq([[endless, point]]));
}

#[test]
fn queries_without_a_filter_find_bodies_that_pair_with_nothing() {
    let mut world = BroadPhase::<2>::new();
    let aabb = Aabb::new([0.0, 0.0], [1.0, 1.0]);
    let maskless = Filter::default().mask(0);
    let nameless = Filter::default().category(0);
    let ids = [maskless, nameless].map(|filter| world.insert_with(aabb, filter).unwrap());
    let queries = world.queries();
    assert_eq!(queries.overlapping(&aabb).unwrap(), ids);
    assert_eq!(queries.containing([0.5, 0.5]).unwrap(), ids);
    assert_eq!(queries.nearest([9.0, 9.0], 2).unwrap().len(), 2);
    let ray = Cast::ray([-1.0, 0.5], [1.0, 0.0], 9.0);
    assert_eq!(queries.cast_all(&ray).unwrap().len(), 2);
    assert_eq!(queries.with_filter(Filter::ALL).overlapping(&aabb).unwrap(), []);
}

#[test]
fn the_header_of_a_snapshot_says_what_world_it_holds() {
    let info = SnapshotInfo::read(&BroadPhase::<3, f64>::new().snapshot()).unwrap();
    assert_eq!((info.dimensions, info.scalar_bytes), (3, 8));
    let truncated = Error::InvalidSnapshot(SnapshotFault::Truncated);
    assert_eq!(SnapshotInfo::read(b"SaP"), Err(truncated));
    let foreign = Error::InvalidSnapshot(SnapshotFault::Foreign);
    assert_eq!(SnapshotInfo::read(b"neither"), Err(foreign));
}

#[test]
fn negative_infinite_and_nan_margins_are_refused() {
    for bad in [-1.0, f32::INFINITY, f32::NAN] {
        let margin = Options::default().margin(bad);
        let prediction = Options::default().prediction(bad);
        for (option, options) in [("margin", margin), ("prediction", prediction)] {
            let world = BroadPhase::<2>::with_options(options);
            let value = f64::from(bad).into();
            assert_eq!(world.map(|_| ()), Err(Error::InvalidOption { option, value }));
        }
    }
}

#[test]
fn a_pair_that_begins_and_ends_between_two_updates_is_not_reported() {
    let mut world = BroadPhase::<1>::new();
    let a = world.insert(Aabb::new([0.0], [1.0])).unwrap();
    let b = world.insert(Aabb::new([5.0], [6.0])).unwrap();
    world.update();
    world.set(b, Aabb::new([0.0], [1.0])).unwrap();
    world.set(b, Aabb::new([5.0], [6.0])).unwrap();
    assert!(world.update().is_empty());
    let c = world.insert(Aabb::new([0.0], [1.0])).unwrap();
    world.remove(c).unwrap();
    assert!(world.update().is_empty());
    assert!(world.pairs_of(a).unwrap().next().is_none());
}

#[test]
fn changes_keep_the_ids_of_removed_bodies_when_their_slots_are_reused() {
    let mut world = BroadPhase::<1>::new();
    let ids = [0.0, 0.5].map(|at| world.insert(Aabb::new([at], [at + 1.0])).unwrap());
    world.update();
    world.remove(ids[0]).unwrap();
    world.update();
    let new = world.insert(Aabb::new([0.0], [1.0])).unwrap();
    assert_eq!(new.slot(), ids[0].slot());
    assert!(world.changes().ended().eq([ids]));
    assert_eq!(world.changes().begun().len(), 0);
}

#[test]
fn a_slot_is_not_reused_until_its_ended_pairs_were_reported() {
    let mut world = BroadPhase::<1>::new();
    let a = world.insert(Aabb::new([0.0], [1.0])).unwrap();
    let b = world.insert(Aabb::new([0.0], [1.0])).unwrap();
    world.update();
    world.remove(b).unwrap();
    let c = world.insert(Aabb::new([0.0], [1.0])).unwrap();
    assert_ne!(c.slot(), b.slot());
    let changes = world.update();
    assert!(changes.ended().eq([[a, b]]) && changes.begun().eq([[a, c]]));
    let d = world.insert(Aabb::new([9.0], [9.0])).unwrap();
    assert_eq!((d.slot(), d.generation()), (b.slot(), b.generation() + 1));
    assert!(!world.contains(b));
}

#[test]
fn snapshots_of_other_worlds_and_other_files_are_refused_with_the_reason() {
    let mut world = BroadPhase::<2>::new();
    world.insert(Aabb::new([0.0, 0.0], [1.0, 1.0])).unwrap();
    let bytes = world.snapshot();
    let fault = |bytes: &[u8]| match BroadPhase::<2>::from_snapshot(bytes) {
        Err(Error::InvalidSnapshot(fault)) => fault,
        other => panic!("{other:?}"),
    };
    assert_eq!(fault(b"PNG and more"), SnapshotFault::Foreign);
    assert_eq!(fault(&[]), SnapshotFault::Truncated);
    let mut newer = bytes.clone();
    newer[4] = 9;
    assert_eq!(fault(&newer), SnapshotFault::Version { found: 9 });
    for cut in 0..bytes.len() {
        assert_eq!(fault(&bytes[..cut]), SnapshotFault::Truncated, "cut to {cut}");
    }
    let longer: Vec<u8> = bytes.iter().copied().chain([0]).collect();
    assert_eq!(fault(&longer), SnapshotFault::Corrupt);
    let other =
        Err(Error::InvalidSnapshot(SnapshotFault::OtherWorld { dimensions: 2, scalar_bytes: 4 }));
    assert_eq!(BroadPhase::<3>::from_snapshot(&bytes).map(|_| ()), other);
    assert_eq!(BroadPhase::<2, f64>::from_snapshot(&bytes).map(|_| ()), other);
}

#[test]
fn swept_boxes_find_what_a_jump_passes_over() {
    let mut world = BroadPhase::<1>::new();
    let wall = world.insert(Aabb::new([5.0], [5.5])).unwrap();
    let bullet = world.insert(Aabb::new([0.0], [0.25])).unwrap();
    world.update();
    let (from, to) = (Aabb::new([0.0], [0.25]), Aabb::new([9.0], [9.25]));
    world.set_swept(bullet, from, to).unwrap();
    assert_eq!(world.aabb(bullet).unwrap(), Aabb::new([0.0], [9.25]));
    assert!(world.update().begun().eq([[wall, bullet]]));
    assert_eq!(world.aabb(bullet).unwrap(), to);
    assert!(world.update().ended().eq([[wall, bullet]]));
}

#[test]
fn groups_decide_over_masks_and_static_over_groups() {
    let none = Filter::default().mask(0);
    let joined = none.group(3);
    let apart = Filter::default().group(-3);
    assert!(!none.allows(&none));
    assert!(joined.allows(&joined));
    assert!(!apart.allows(&apart));
    assert!(apart.allows(&Filter::default()));
    let fixed = joined.is_static(true);
    assert!(!fixed.allows(&fixed) && fixed.allows(&joined));
}

#[test]
fn an_id_survives_conversion_to_a_number_and_back() {
    let bits = u64::from(u32::MAX) << 32 | 7;
    let id = ProxyId::from_bits(bits);
    assert_eq!((id.to_bits(), id.slot()), (bits, 7));
}
