//! What `BroadPhase` should do, by brute force over a map of bodies.

use std::collections::{BTreeMap, BTreeSet};

use sweep_and_prune::algorithms::pairwise;
use sweep_and_prune::{Aabb, Cast, Filter, Options, ProxyId, Report, Scalar};

pub type Pair = [ProxyId; 2];

#[derive(Clone, Debug)]
pub struct Body<const D: usize, T> {
    pub aabb: Aabb<D, T>,
    pub reported: Aabb<D, T>,
    pub filter: Filter,
    rest: Option<Aabb<D, T>>,
}

#[derive(Clone, Debug)]
pub struct Model<const D: usize, T> {
    options: Options<T>,
    pub bodies: BTreeMap<ProxyId, Body<D, T>>,
    live: BTreeSet<Pair>,
}

impl<const D: usize, T: Scalar> Model<D, T> {
    pub fn new(options: Options<T>) -> Self {
        Self { options, bodies: BTreeMap::new(), live: BTreeSet::new() }
    }

    pub fn insert(&mut self, id: ProxyId, aabb: Aabb<D, T>, filter: Filter) {
        let reported = self.reported(&aabb, [T::default(); D]);
        let body = Body { aabb, reported, filter, rest: None };
        assert!(self.bodies.insert(id, body).is_none(), "{id:?} was given out twice");
    }

    pub fn remove(&mut self, id: ProxyId) {
        self.bodies.remove(&id).unwrap();
    }

    pub fn set(&mut self, id: ProxyId, aabb: Aabb<D, T>) {
        let old = self.bodies[&id].clone();
        let holds = |axis: usize| {
            old.reported.min[axis] <= aabb.min[axis] && aabb.max[axis] <= old.reported.max[axis]
        };
        let reported = if self.options.report == Report::Fat && (0..D).all(holds) {
            old.reported
        } else {
            let way = std::array::from_fn(|axis| {
                let way = aabb.min[axis] - old.aabb.min[axis];
                if way.to_f64().is_finite() { way } else { T::default() }
            });
            self.reported(&aabb, way)
        };
        self.bodies.insert(id, Body { aabb, reported, rest: None, ..old });
    }

    pub fn set_swept(&mut self, id: ProxyId, from: Aabb<D, T>, to: Aabb<D, T>) {
        let least = |a: T, b: T| if a < b { a } else { b };
        let most = |a: T, b: T| if a > b { a } else { b };
        let min = std::array::from_fn(|axis| least(from.min[axis], to.min[axis]));
        let max = std::array::from_fn(|axis| most(from.max[axis], to.max[axis]));
        self.set(id, Aabb::new(min, max));
        self.bodies.get_mut(&id).unwrap().rest = Some(to);
    }

    pub fn set_filter(&mut self, id: ProxyId, filter: Filter) {
        self.bodies.get_mut(&id).unwrap().filter = filter;
    }

    #[expect(clippy::needless_range_loop, reason = "four arrays are read at the axis")]
    fn reported(&self, aabb: &Aabb<D, T>, way: [T; D]) -> Aabb<D, T> {
        let mut fat = *aabb;
        if self.options.report == Report::Fat {
            for axis in 0..D {
                let ahead = way[axis] * self.options.prediction;
                fat.min[axis] = aabb.min[axis] - self.options.margin;
                fat.max[axis] = aabb.max[axis] + self.options.margin;
                if ahead < T::default() {
                    fat.min[axis] = fat.min[axis] + ahead;
                } else {
                    fat.max[axis] = fat.max[axis] + ahead;
                }
            }
        }
        fat
    }

    /// Begun and ended.
    pub fn update(&mut self) -> (Vec<Pair>, Vec<Pair>) {
        let ids: Vec<_> = self.bodies.keys().copied().collect();
        let boxes: Vec<_> = self.bodies.values().map(|body| body.reported).collect();
        let overlaps = pairwise(&boxes).unwrap();
        let pairs = overlaps.iter().map(|pair| pair.map(|index| ids[index as usize]));
        let allowed = |pair: &Pair| {
            let [a, b] = pair.map(|id| self.bodies[&id].filter);
            a.allows(&b)
        };
        let now: BTreeSet<Pair> = pairs.filter(allowed).collect();
        let begun = now.difference(&self.live).copied().collect();
        let ended = self.live.difference(&now).copied().collect();
        self.live = now;
        let rests: Vec<_> =
            self.bodies.iter().filter_map(|(&id, body)| Some((id, body.rest?))).collect();
        for (id, to) in rests {
            let reported = self.reported(&to, [T::default(); D]);
            let body = self.bodies.get_mut(&id).unwrap();
            (body.aabb, body.reported, body.rest) = (to, reported, None);
        }
        (begun, ended)
    }

    pub fn pairs(&self) -> Vec<Pair> {
        self.live.iter().copied().collect()
    }

    pub fn pairs_of(&self, id: ProxyId) -> Vec<ProxyId> {
        let other = |&[a, b]: &Pair| if a == id { Some(b) } else { (b == id).then_some(a) };
        let mut others: Vec<_> = self.live.iter().filter_map(other).collect();
        others.sort();
        others
    }

    fn seen<'a>(
        &'a self,
        filter: &'a Option<Filter>,
    ) -> impl Iterator<Item = (ProxyId, Aabb<D, T>)> + 'a {
        let allowed = self
            .bodies
            .iter()
            .filter(|(_, body)| filter.is_none_or(|filter| filter.allows(&body.filter)));
        allowed.map(|(&id, body)| (id, body.aabb))
    }

    pub fn overlapping(&self, area: &Aabb<D, T>, filter: &Option<Filter>) -> Vec<ProxyId> {
        self.seen(filter).filter(|(_, aabb)| aabb.overlaps(area)).map(|(id, _)| id).collect()
    }

    fn distance_squared(point: [T; D], aabb: &Aabb<D, T>, unit: f64) -> f64 {
        let gaps = (0..D).map(|axis| {
            let at = point[axis].to_f64();
            (aabb.min[axis].to_f64() - at).max(at - aabb.max[axis].to_f64()).max(0.0) * unit
        });
        gaps.fold(0.0, |sum, gap| sum + gap * gap)
    }

    pub fn within(&self, center: [T; D], radius: T, filter: &Option<Filter>) -> Vec<ProxyId> {
        let radius = radius.to_f64();
        let is_near =
            |aabb: &Aabb<D, T>| Self::distance_squared(center, aabb, 1.0) <= radius * radius;
        self.seen(filter).filter(|(_, aabb)| is_near(aabb)).map(|(id, _)| id).collect()
    }

    pub fn nearest(&self, point: [T; D], k: usize, filter: &Option<Filter>) -> Vec<(f64, ProxyId)> {
        let far = |(id, aabb)| (Self::distance_squared(point, &aabb, 1.0), id);
        let mut all: Vec<_> = self.seen(filter).map(far).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        all.truncate(k);
        all
    }

    /// When a cast first touches each body, sorted.
    pub fn hits(&self, cast: &Cast<D, T>, filter: &Option<Filter>) -> Vec<(f64, ProxyId)> {
        let hit = |(id, aabb): (ProxyId, Aabb<D, T>)| {
            // The times at which the intervals overlap, axis by axis.
            let mut times = (0.0f64, cast.limit.to_f64());
            for axis in 0..D {
                let speed = cast.direction[axis].to_f64();
                let until_touch = aabb.min[axis].to_f64() - cast.from.max[axis].to_f64();
                let until_past = aabb.max[axis].to_f64() - cast.from.min[axis].to_f64();
                if speed != 0.0 {
                    let (a, b) = (until_touch / speed, until_past / speed);
                    times = (times.0.max(a.min(b)), times.1.min(a.max(b)));
                } else if until_touch > 0.0 || until_past < 0.0 {
                    return None;
                }
            }
            (times.0 <= times.1).then_some((times.0, id))
        };
        let mut hits: Vec<_> = self.seen(filter).filter_map(hit).collect();
        hits.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        hits
    }
}
