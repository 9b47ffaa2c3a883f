//! Sequences of calls of `BroadPhase`, each compared with the model.

use std::fmt::Debug;
use std::ops::ControlFlow;

use sweep_and_prune::{
    Aabb, BroadPhase, Cast, Error, Filter, Hit, Lists, Options, ProxyId, Queries, Report, Scalar,
};
use sweep_and_prune_scenes::Random;

use super::{Input, Model, Pair, Space, in_any_dimension};

/// The most bodies of a world: few, since brute force tests every pair. In a world with at least 64, a body that leaves its
/// fat AABB is looked up in the tree.
const MOST: [usize; 6] = [12, 5, 12, 24, 72, 110];

pub(super) fn target(input: &mut Input) -> u64 {
    in_any_dimension!(input, sequence)
}

fn sequence<const D: usize, T: Scalar>(input: &mut Input) -> u64 {
    let most = input.pick(&MOST);
    let space = Space::draw::<D, T>(input, most);
    let lengths = [0.0, 0.0, 0.5, 1.0, 2.5];
    let margin = space.length(input.pick(&lengths));
    let prediction = T::from_f64(input.pick(&lengths));
    let report = match input.below(3) {
        1 => Report::Fat { margin, prediction },
        _ => Report::Exact,
    };
    let options = Options::default().report(report);
    let world = BroadPhase::<D, T>::with_options(options).unwrap();
    input.say(|| format!("{D}D, {} bytes, {space:?}, {options:?}", T::BYTES));
    let mut sequence = Sequence::new(world, space, most);
    sequence.run(input);
    sequence.calls
}

/// A world and its model under the same calls.
pub(super) struct Sequence<const D: usize, T: Scalar> {
    world: BroadPhase<D, T>,
    /// What the world was when it was cloned last.
    saved: BroadPhase<D, T>,
    model: Model<D, T>,
    /// What the last update found.
    changes: (Vec<Pair>, Vec<Pair>),
    /// The last body that was removed.
    stale: Option<ProxyId>,
    /// Boxes that were used before: bodies return to them.
    known: [Aabb<D, T>; 4],
    space: Space,
    /// The most bodies.
    most: usize,
    /// How many calls of the world were made.
    pub calls: u64,
}

fn sorted<V: Ord>(values: impl Iterator<Item = V>) -> Vec<V> {
    let mut values: Vec<_> = values.collect();
    values.sort_unstable();
    values
}

impl<const D: usize, T: Scalar> Sequence<D, T> {
    /// A world after an update, without swept bodies.
    pub fn new(world: BroadPhase<D, T>, space: Space, most: usize) -> Self {
        let model = Model::of(&world);
        let changes = (world.changes().begun().collect(), world.changes().ended().collect());
        let known = [Aabb::new([T::default(); D], [T::default(); D]); 4];
        let saved = BroadPhase::new();
        Self { world, saved, model, changes, stale: None, known, space, most, calls: 0 }
    }

    pub fn into_world(self) -> BroadPhase<D, T> {
        self.world
    }

    /// Carries out operations until the input ends.
    pub fn run(&mut self, input: &mut Input) {
        while input.next_operation() {
            self.operation(input);
        }
        self.update();
        self.check_state();
    }

    pub fn operation(&mut self, input: &mut Input) {
        self.call(input);
        assert_eq!(self.world.broken_invariant(), None);
    }

    fn call(&mut self, input: &mut Input) {
        self.calls += 1;
        match input.below(48) {
            0..=5 => {
                input.say(|| "update".into());
                self.update();
            }
            6..=8 => self.insert(input),
            9 => self.insert_many(input),
            10..=11 => self.remove(input),
            12..=16 => self.set(input),
            17..=19 => self.set_many(input),
            20..=24 => self.drift(input),
            25..=28 => self.drift_all(input),
            29..=30 => self.rest(input),
            31..=32 => self.sweep(input),
            33 => self.teleport(input),
            34 => self.refilter(input),
            35..=37 => self.find(input),
            38 => self.shift(input),
            39..=41 => self.cast(input),
            42 => self.query_many(input),
            43 => self.pairs_of(input),
            44 => self.restore(input),
            45 => self.clone_world(input),
            46 => self.misuse(input),
            _ => self.check_state(),
        }
    }

    /// A new box, or one that was used before.
    fn aabb(&mut self, input: &mut Input) -> Aabb<D, T> {
        let which = input.below(12);
        if let Some(known) = self.known.get(which) {
            return *known;
        }
        let aabb = self.space.aabb(input);
        if let Some(known) = self.known.get_mut(which - 4) {
            *known = aabb;
        }
        aabb
    }

    fn filter(&self, input: &mut Input) -> Filter {
        match input.below(8) {
            0..=3 => Filter::default(),
            4 => Filter::STATIC,
            5 => Filter::default().mask(input.below(4) as u32),
            6 => Filter::default().group(input.below(5) as i32 - 2).is_static(input.chance(4)),
            _ => Filter::default().category(2).mask(u32::MAX << input.below(3)),
        }
    }

    fn id(&self, input: &mut Input) -> Option<ProxyId> {
        let which = input.below(self.model.bodies.len().min(256));
        self.model.bodies.keys().nth(which).copied()
    }

    /// One in this many bodies, from the first, second or another one on.
    fn ids(&self, input: &mut Input) -> Vec<ProxyId> {
        let step = input.pick(&[1, 1, 2, 3, 7, 20, 100]);
        self.model.bodies.keys().skip(input.below(step)).step_by(step).copied().collect()
    }

    fn update(&mut self) {
        // It has none of the buffers of earlier updates, on which no order may depend.
        let clone = self.calls.is_multiple_of(8).then(|| self.world.clone());
        let changes = self.world.update();
        self.changes = (changes.begun().collect(), changes.ended().collect());
        let expected = self.model.update();
        assert_eq!(self.changes, expected, "begun and ended; left: the world, right: the model");
        assert!(self.world.pairs().eq(self.model.pairs.iter().copied()));
        assert_eq!(sorted(self.world.pairs_unsorted()), self.model.pairs);
        if let Some(mut clone) = clone {
            clone.update();
            assert!(clone.pairs_unsorted().eq(self.world.pairs_unsorted()), "in another order");
        }
    }

    fn insert(&mut self, input: &mut Input) {
        if self.model.bodies.len() >= self.most {
            return self.update();
        }
        let (aabb, filter) = (self.aabb(input), self.filter(input));
        let id = self.world.insert_with(aabb, filter).unwrap();
        input.say(|| format!("insert {aabb:?} {filter:?} -> {id:?}"));
        self.model.insert(id, aabb, filter);
    }

    /// Inserts 2 to 90 bodies. With the larger numbers, some are looked up one by one in the tree.
    fn insert_many(&mut self, input: &mut Input) {
        let count = input.pick(&[2, 5, 20, 70, 90]);
        let (filter, seed) = (self.filter(input), input.below(256));
        let count = count.min(self.most.saturating_sub(self.model.bodies.len()));
        // One byte is the seed of the bytes from which the boxes are made.
        let mut random = Random::new(seed as u64);
        let bytes: Vec<u8> = (0..count * D * 6).map(|_| random.bits() as u8).collect();
        let mut drawn = Input::new(&bytes);
        let boxes: Vec<_> = (0..count).map(|_| self.space.aabb(&mut drawn)).collect();
        input.say(|| format!("insert_many {boxes:?} {filter:?}"));
        let ids = self.world.insert_many(&boxes, filter).unwrap();
        assert_eq!(ids.len(), boxes.len());
        for (&id, &aabb) in ids.iter().zip(&boxes) {
            self.model.insert(id, aabb, filter);
        }
    }

    fn remove(&mut self, input: &mut Input) {
        let ids = match input.chance(6) {
            true => self.ids(input),
            false => self.id(input).into_iter().collect(),
        };
        if ids.len() > 1 && ids.len() == self.world.len() {
            input.say(|| "clear".to_string());
            self.world.clear();
        } else {
            input.say(|| format!("remove_many {ids:?}"));
            self.world.remove_many(&ids).unwrap();
        }
        ids.iter().for_each(|&id| self.model.remove(id));
        self.stale = ids.last().copied().or(self.stale);
    }

    fn set(&mut self, input: &mut Input) {
        if let Some(id) = self.id(input) {
            let aabb = self.aabb(input);
            input.say(|| format!("set {id:?} {aabb:?}"));
            self.world.set(id, aabb).unwrap();
            self.model.set(id, aabb);
        }
    }

    /// Gives some bodies boxes anywhere; one of them twice.
    fn set_many(&mut self, input: &mut Input) {
        let mut ids = self.ids(input);
        ids.truncate(1 + input.below(12));
        if input.chance(4) {
            ids.extend(ids.first().copied());
        }
        let boxes: Vec<_> = ids.iter().map(|_| self.aabb(input)).collect();
        self.set_all(input, &ids, &boxes);
    }

    fn set_all(&mut self, input: &Input, ids: &[ProxyId], boxes: &[Aabb<D, T>]) {
        input.say(|| format!("set_many {ids:?} {boxes:?}"));
        self.world.set_many(ids, boxes).unwrap();
        ids.iter().zip(boxes).for_each(|(&id, &aabb)| self.model.set(id, aabb));
    }

    /// The box of a body that moved by this many units on each axis.
    fn moved(&self, id: ProxyId, way: [f64; D]) -> Aabb<D, T> {
        let mut aabb = self.model.bodies[&id].aabb;
        for (axis, &way) in way.iter().enumerate() {
            let way = self.space.length(way);
            (aabb.min[axis], aabb.max[axis]) = (aabb.min[axis] + way, aabb.max[axis] + way);
        }
        aabb
    }

    fn step(input: &mut Input) -> f64 {
        input.pick(&[0.1, 0.0, -0.1, 0.01, 0.5, -0.5, 1.0, -1.0, 3.0])
    }

    /// Moves some bodies by the same small step.
    fn drift(&mut self, input: &mut Input) {
        let ids = match input.chance(2) {
            true => self.ids(input),
            false => self.id(input).into_iter().collect(),
        };
        let step = std::array::from_fn(|_| Self::step(input));
        for id in ids {
            let aabb = self.moved(id, step);
            input.say(|| format!("set {id:?} {aabb:?}"));
            self.world.set(id, aabb).unwrap();
            self.model.set(id, aabb);
        }
    }

    /// Moves all bodies, each with a velocity of its own, for some updates.
    fn drift_all(&mut self, input: &mut Input) {
        let (scale, updates) = (Self::step(input), input.below(4));
        let turn = |id: ProxyId, axis: usize| (id.slot() as usize * 7 + axis * 3) % 9;
        let ids: Vec<_> = self.model.bodies.keys().copied().collect();
        for _ in 0..=updates {
            let way = |id| std::array::from_fn(|axis| scale * (turn(id, axis) as f64 * 0.25 - 1.0));
            let boxes: Vec<_> = ids.iter().map(|&id| self.moved(id, way(id))).collect();
            self.set_all(input, &ids, &boxes);
            if updates > 0 {
                input.say(|| "update".into());
                self.update();
                self.calls += 2;
            }
        }
    }

    /// Moves one or two bodies for enough updates that others may fall asleep.
    fn rest(&mut self, input: &mut Input) {
        let (first, last) = (self.id(input), self.id(input));
        let way = std::array::from_fn(|_| Self::step(input));
        for turn in 0..input.pick(&[2, 5, 9, 20]) {
            for id in [first, last].into_iter().flatten() {
                let way = if turn % 2 == 0 { way } else { way.map(|way| -way) };
                let aabb = self.moved(id, way);
                input.say(|| format!("set {id:?} {aabb:?}"));
                self.world.set(id, aabb).unwrap();
                self.model.set(id, aabb);
            }
            input.say(|| "update".into());
            self.update();
            self.calls += 3;
        }
    }

    fn teleport(&mut self, input: &mut Input) {
        if let Some(id) = self.id(input) {
            let aabb = self.aabb(input);
            input.say(|| format!("teleport {id:?} {aabb:?}"));
            self.world.teleport(id, aabb).unwrap();
            self.model.teleport(id, aabb);
        }
    }

    fn shift(&mut self, input: &mut Input) {
        let offset = std::array::from_fn(|_| self.space.length(Self::step(input)));
        input.say(|| format!("shift {offset:?}"));
        self.world.shift(offset).unwrap();
        self.model.shift(offset);
    }

    fn sweep(&mut self, input: &mut Input) {
        if let Some(id) = self.id(input) {
            let (from, to) = (self.aabb(input), self.aabb(input));
            input.say(|| format!("set_swept {id:?} {from:?} {to:?}"));
            self.world.set_swept(id, from, to).unwrap();
            self.model.set_swept(id, from, to);
        }
    }

    fn refilter(&mut self, input: &mut Input) {
        if let Some(id) = self.id(input) {
            let filter = self.filter(input);
            input.say(|| format!("set_filter {id:?} {filter:?}"));
            self.world.set_filter(id, filter).unwrap();
            self.model.set_filter(id, filter);
            self.toggle(input);
        }
    }

    /// Disables or enables a body, or excludes or includes a pair. Which ones, the number of calls says, so that it takes no
    /// byte of the input.
    fn toggle(&mut self, input: &mut Input) {
        let nth = |step: usize| {
            let which = self.calls as usize * step % self.model.bodies.len().min(64);
            self.model.bodies.keys().nth(which).copied().unwrap()
        };
        let (a, b) = (nth(1), nth(5));
        if self.calls.is_multiple_of(3) {
            let is_enabled = !self.model.bodies[&a].is_enabled;
            input.say(|| format!("set_enabled {a:?} {is_enabled}"));
            self.world.set_enabled(a, is_enabled).unwrap();
            self.model.set_enabled(a, is_enabled);
        } else if self.calls.is_multiple_of(4) {
            input.say(|| format!("include_pair {a:?} {b:?}"));
            self.world.include_pair(a, b).unwrap();
            self.model.set_excluded(a, b, false);
        } else {
            input.say(|| format!("exclude_pair {a:?} {b:?}"));
            self.world.exclude_pair(a, b).unwrap();
            self.model.set_excluded(a, b, true);
        }
        let is_excluded = self.model.excluded.contains(&[a.min(b), a.max(b)]);
        assert_eq!(self.world.is_excluded(a, b).unwrap(), is_excluded);
        assert_eq!(self.world.is_excluded(b, a).unwrap(), is_excluded);
    }

    /// The filter of a query, if it has one.
    fn query_filter(&self, input: &mut Input) -> Option<Filter> {
        if input.chance(3) { Some(self.filter(input)) } else { None }
    }

    fn queries<'a>(world: &'a mut BroadPhase<D, T>, filter: &Option<Filter>) -> Queries<'a, D, T> {
        // Both ways, as the number of bodies says, so that it takes no byte of the input.
        let queries = if world.len().is_multiple_of(2) {
            world.queries()
        } else {
            world.prepare_queries();
            world.prepared_queries().expect("nothing changed since it was prepared")
        };
        filter.map_or(queries, |filter| queries.with_filter(filter))
    }

    fn point(&self, input: &mut Input) -> [T; D] {
        std::array::from_fn(|_| self.space.plain(input))
    }

    /// A query for a region, or for what is nearest.
    fn find(&mut self, input: &mut Input) {
        let filter = self.query_filter(input);
        let (world, model) = (&mut self.world, &self.model);
        match input.below(5) {
            0 | 1 => {
                let area = self.aabb(input);
                input.say(|| format!("overlapping {area:?} {filter:?}"));
                let found = Self::queries(&mut self.world, &filter).overlapping(&area).unwrap();
                assert_eq!(found, self.model.overlapping(&area, &filter));
                self.visit(&area, input.below(6), &filter);
            }
            2 => {
                let point = self.space.aabb::<D, T>(input).min;
                input.say(|| format!("containing {point:?} {filter:?}"));
                let found = Self::queries(world, &filter).containing(point).unwrap();
                assert_eq!(found, model.overlapping(&Aabb::new(point, point), &filter));
            }
            3 => {
                let point: [T; D] = std::array::from_fn(|_| self.space.plain(input));
                let radius = self.space.length(input.pick(&[0.0, 1.0, 2.0, 0.5, 9.0, f64::MAX]));
                input.say(|| format!("within {point:?} {radius:?} {filter:?}"));
                let found = Self::queries(world, &filter).within(point, radius).unwrap();
                assert_eq!(found, model.within(point, radius, &filter));
            }
            _ => {
                let point: [T; D] = std::array::from_fn(|_| self.space.plain(input));
                let all = f64::INFINITY;
                let (k, far) = input.pick(&[(0, 1.0), (1, all), (2, 3.0), (5, 2.0), (300, all)]);
                input.say(|| format!("nearest {point:?} {k} {far} {filter:?}"));
                let found = Self::queries(world, &filter).nearest(point, k, far).unwrap();
                let found: Vec<_> = found.iter().map(|it| (it.distance_squared, it.id)).collect();
                assert_eq!(found, model.nearest(point, k, far, &filter));
            }
        }
    }

    /// A visitor that stops a search is not called again.
    fn visit(&mut self, area: &Aabb<D, T>, most: usize, filter: &Option<Filter>) {
        let mut found = vec![];
        let visit = |id| {
            found.push(id);
            if found.len() == most { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        Self::queries(&mut self.world, filter).visit_overlapping(area, visit).unwrap();
        let all = self.model.overlapping(area, filter);
        assert!(found.iter().all(|id| all.binary_search(id).is_ok()));
        assert_eq!(found.len(), if most == 0 { all.len() } else { all.len().min(most) });
    }

    fn cast(&mut self, input: &mut Input) {
        let filter = self.query_filter(input);
        let from = self.point(input);
        let side = self.space.length(input.pick(&[0.0, 0.0, 1.0, 2.0]));
        let from = Aabb::new(from, from.map(|at| at + side));
        if from.max.iter().any(|at| at.to_f64().is_infinite()) {
            return;
        }
        let direction = std::array::from_fn(|_| {
            let way = input.pick(&[0.0, 1.0, -1.0, 2.0, -2.0, 0.3]);
            if input.chance(8) { T::from_f64(way) } else { self.space.length(way) }
        });
        let limit = T::from_f64(input.pick(&[f64::INFINITY, 0.0, 0.5, 1.0, 3.0, 100.0]));
        let cast = Cast::aabb(from, direction, limit);
        input.say(|| format!("cast {cast:?} {filter:?}"));
        let hits = self.model.hits(&cast, &filter);
        let entered: Vec<_> = hits.iter().copied().filter(|hit| hit.is_entered).collect();
        let most = input.below(4);
        for (cast, expected) in [(cast, &hits), (cast.ignore_touching(), &entered)] {
            let queries = Self::queries(&mut self.world, &filter);
            let found = |hit: &Hit<D, T>| {
                let normal = hit.normal.map(Scalar::to_f64);
                (hit.t, hit.id, normal, hit.starts_inside)
            };
            let expected: Vec<_> =
                expected.iter().map(|hit| (hit.t, hit.id, hit.normal, hit.starts_inside)).collect();
            let all: Vec<_> = queries.cast_all(&cast).unwrap().iter().map(found).collect();
            assert_eq!(all, expected);
            assert!(all.iter().all(|hit| hit.0.is_sign_positive()), "a hit at -0.0");
            let first = queries.cast(&cast).unwrap();
            assert_eq!(first.as_ref().map(found), expected.first().copied());
            // The same cast past its first hits.
            let excluded: Vec<_> = expected.iter().take(most).map(|hit| hit.1).collect();
            let next = queries.with_predicate(&|id| !excluded.contains(&id)).cast(&cast).unwrap();
            assert_eq!(next.as_ref().map(found), expected.get(most).copied());
            let mut seen = vec![];
            let visit = |hit: Hit<D, T>| {
                seen.push(found(&hit));
                if seen.len() == most {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(f64::INFINITY)
                }
            };
            queries.cast_with(&cast, visit).unwrap();
            assert!(seen.iter().all(|hit| expected.contains(hit)));
            let len = expected.len();
            assert_eq!(seen.len(), if most == 0 { len } else { len.min(most) });
        }
    }

    /// A query for many gives for each the list that the query for one gives.
    fn query_many(&mut self, input: &mut Input) {
        // The lists are used before, so that what they held would be seen.
        fn lists<V: Clone>(ask: impl Fn(&mut Lists<V>) -> Result<(), Error>) -> Vec<Vec<V>> {
            let mut lists = Lists::new();
            (0..2).for_each(|_| ask(&mut lists).unwrap());
            lists.iter().map(<[V]>::to_vec).collect()
        }
        fn each<Q, V>(queries: &[Q], one: impl Fn(&Q) -> V) -> Vec<V> {
            queries.iter().map(one).collect()
        }
        let filter = self.query_filter(input);
        let count = input.below(4);
        let areas: Vec<_> = (0..count).map(|_| self.aabb(input)).collect();
        let points: Vec<_> = (0..count).map(|_| self.point(input)).collect();
        let radius = self.space.length(1.0);
        let spheres: Vec<_> = points.iter().map(|&point| (point, radius)).collect();
        let way = [self.space.length(1.0); D];
        let casts: Vec<_> =
            points.iter().map(|&point| Cast::ray(point, way, T::from_f64(9.0))).collect();
        input.say(|| format!("queries for many {areas:?} {points:?} {radius:?} {filter:?}"));
        let queries = Self::queries(&mut self.world, &filter);
        let model = &self.model;
        assert_eq!(
            lists(|lists| queries.overlapping_many(&areas, lists)),
            each(&areas, |area| model.overlapping(area, &filter))
        );
        assert_eq!(
            lists(|lists| queries.containing_many(&points, lists)),
            each(&points, |&point| model.overlapping(&Aabb::new(point, point), &filter))
        );
        assert_eq!(
            lists(|lists| queries.within_many(&spheres, lists)),
            each(&spheres, |&(point, radius)| model.within(point, radius, &filter))
        );
        let nearest = lists(|lists| queries.nearest_many(&points, 2, 3.0, lists));
        assert_eq!(
            each(&nearest, |list| each(list, |it| (it.distance_squared, it.id))),
            each(&points, |&point| model.nearest(point, 2, 3.0, &filter))
        );
        let mut first = vec![None; 7];
        queries.cast_many(&casts, &mut first).unwrap();
        assert_eq!(
            each(&first, |hit| hit.map(|hit| (hit.t, hit.id))),
            each(&casts, |cast| model.hits(cast, &filter).first().map(|hit| (hit.t, hit.id)))
        );
        let all = lists(|lists| queries.cast_all_many(&casts, lists));
        assert_eq!(
            each(&all, |hits| each(hits, |hit| (hit.t, hit.id))),
            each(&casts, |cast| each(&model.hits(cast, &filter), |hit| (hit.t, hit.id)))
        );
    }

    fn pairs_of(&mut self, input: &mut Input) {
        if let Some(id) = self.id(input) {
            input.say(|| format!("pairs_of {id:?}"));
            let others = self.model.pairs_of(id);
            assert_eq!(self.world.pairs_by_body()[id.slot() as usize], others);
            assert!(self.world.pairs_of(id).unwrap().eq(others));
        }
    }

    /// Goes on with a restored world, or with both side by side for a while.
    fn restore(&mut self, input: &mut Input) {
        let bytes = self.world.snapshot();
        let mut restored = BroadPhase::<D, T>::from_snapshot(&bytes).unwrap();
        assert_eq!(restored.snapshot(), bytes);
        assert_eq!(restored.state_hash(), self.world.state_hash());
        assert!(restored.pairs().eq(self.model.pairs.iter().copied()));
        if input.chance(2) {
            input.say(|| "snapshot, and the same calls in a restored world".into());
            let aabb = self.aabb(input);
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
            input.say(|| "world = from_snapshot(snapshot)".into());
            self.world = restored;
            self.changes = Default::default();
        }
        // Any truncation and any flipped bit is noticed.
        let cut = input.below(bytes.len());
        assert!(BroadPhase::<D, T>::from_snapshot(&bytes[..cut]).is_err());
        let mut damaged = bytes;
        damaged[cut] ^= 1 << input.below(8);
        assert!(BroadPhase::<D, T>::from_snapshot(&damaged).is_err());
    }

    fn clone_world(&mut self, input: &mut Input) {
        input.say(|| "world = world.clone()".into());
        // Both ways, as the number of bodies says, so that it takes no byte of the input.
        let clone = if self.world.len().is_multiple_of(2) {
            self.world.clone()
        } else {
            // Into a world that had other bodies, as rollback does.
            self.saved.clone_from(&self.world);
            std::mem::replace(&mut self.saved, self.world.clone())
        };
        #[cfg(feature = "parallel")]
        let clone = if input.chance(2) { clone.threads(input.below(4)) } else { clone };
        self.world = clone;
    }

    /// Checks what holds at any time.
    fn check_state(&mut self) {
        assert!(self.world.ids().eq(self.model.bodies.keys().copied()));
        if let Some(queries) = self.world.prepared_queries() {
            for body in self.model.bodies.values() {
                let found = queries.overlapping(&body.aabb).unwrap();
                assert_eq!(found, self.model.overlapping(&body.aabb, &None));
            }
        }
        assert_eq!(self.world.len(), self.model.bodies.len());
        assert!(self.world.changes().begun().eq(self.changes.0.iter().copied()));
        assert!(self.world.changes().ended().eq(self.changes.1.iter().copied()));
        assert!(self.stale.is_none_or(|stale| !self.world.contains(stale)));
        for (&id, body) in &self.model.bodies {
            assert_eq!(self.world.aabb(id).unwrap(), body.aabb);
            assert_eq!(self.world.reported_aabb(id).unwrap(), body.reported);
            assert_eq!(self.world.filter(id).unwrap(), body.filter);
            assert_eq!(self.world.is_enabled(id).unwrap(), body.is_enabled);
        }
    }

    /// Makes calls that are refused; nothing changes by them.
    fn misuse(&mut self, input: &mut Input) {
        input.say(|| "calls that are refused".into());
        let before = self.world.snapshot();
        let good = self.space.aabb(input);
        let (mut bad, mut inverted) = (good, good);
        let axis = input.below(D);
        bad.min[axis] = T::from_f64(f64::NAN);
        (inverted.min[axis], inverted.max[axis]) = (T::INFINITY, T::NEG_INFINITY);
        let invalid = |index, aabb: Aabb<D, T>| {
            let [min, max] = [aabb.min, aabb.max].map(|corner| corner[axis].to_f64().into());
            Error::InvalidBox { set: 0, index, axis, min, max }
        };
        let world = &mut self.world;
        refused(world.insert(bad), invalid(0, bad));
        refused(world.insert_many(&[good, inverted], Filter::ALL), invalid(1, inverted));
        refused(world.queries().overlapping(&bad), invalid(0, bad));
        let mut offset = good.min.map(|_| T::default());
        offset[axis] = input.pick(&[T::INFINITY, T::NEG_INFINITY, bad.min[axis]]);
        let value = offset[axis].to_f64().into();
        refused(world.shift(offset), Error::InvalidOffset { axis, value });
        if let Some(gone) = self.stale {
            let stale = Error::StaleProxy { index: 0, id: gone.to_bits() };
            refused(world.set(gone, good), stale);
            refused(world.set_swept(gone, good, good), stale);
            refused(world.teleport(gone, good), stale);
            refused(world.set_filter(gone, Filter::ALL), stale);
            refused(world.set_enabled(gone, false), stale);
            refused(world.exclude_pair(gone, gone), stale);
            refused(world.remove(gone), stale);
            refused(world.aabb(gone), stale);
            assert!(world.pairs_of(gone).is_err() && !world.contains(gone));
        }
        if let Some(id) = self.model.bodies.keys().last().copied() {
            let foreign = ProxyId::from_bits(id.to_bits() + (1 << 32));
            let stale = |id: ProxyId| Error::StaleProxy { index: 1, id: id.to_bits() };
            refused(world.exclude_pair(id, foreign), stale(foreign));
            refused(world.include_pair(id, foreign), stale(foreign));
            refused(world.set_swept(id, good, inverted), invalid(1, inverted));
            refused(world.teleport(id, bad), invalid(0, bad));
            refused(world.set_many(&[id, id], &[good, bad]), invalid(1, bad));
            refused(world.set_many(&[id, foreign], &[good; 2]), stale(foreign));
            refused(world.set_many(&[id], &[]), Error::LengthMismatch { ids: 1, boxes: 0 });
            refused(world.remove_many(&[id, id]), stale(id));
            refused(world.remove_many(&[id, foreign]), stale(foreign));
        }
        assert_eq!(world.snapshot(), before);
    }
}

fn refused<V: Debug>(result: Result<V, Error>, expected: Error) {
    assert_eq!(result.unwrap_err(), expected);
}
