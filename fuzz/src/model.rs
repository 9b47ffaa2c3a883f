//! What `BroadPhase` should do, by brute force over a map of bodies.

use std::collections::{BTreeMap, BTreeSet};

use sweep_and_prune::{Aabb, BroadPhase, Cast, Filter, Options, ProxyId, Report, Scalar};

/// Two bodies that overlap, the smaller id first.
pub type Pair = [ProxyId; 2];

/// What the model knows of a body.
#[derive(Clone, Debug)]
pub struct Body<const D: usize, T: Scalar> {
    /// Its box as given.
    pub aabb: Aabb<D, T>,
    /// The box whose overlaps are reported.
    pub reported: Aabb<D, T>,
    /// Its filter.
    pub filter: Filter,
    /// Whether it is enabled.
    pub is_enabled: bool,
    /// What it had at the last update, if that knew it.
    last: Option<AtUpdate<D, T>>,
    /// Where its sweep ends, if it was swept since the last update.
    rest: Option<Aabb<D, T>>,
}

/// What a body had at the last update.
#[derive(Clone, Debug)]
struct AtUpdate<const D: usize, T: Scalar> {
    /// Its box as given, or the one to which it was teleported since.
    from: Aabb<D, T>,
    /// Its box that was reported.
    reported: Aabb<D, T>,
}

/// A broad phase that is too simple to be wrong: it tests each body against each.
#[derive(Clone, Debug)]
pub struct Model<const D: usize, T: Scalar> {
    report: Report<T>,
    /// All bodies by id.
    pub bodies: BTreeMap<ProxyId, Body<D, T>>,
    /// The pairs of the last update, sorted.
    pub pairs: Vec<Pair>,
    /// The excluded pairs of bodies that are there.
    pub excluded: BTreeSet<Pair>,
    /// How far all was shifted since the last update.
    shifted: [T; D],
}

impl<const D: usize, T: Scalar> Model<D, T> {
    /// A model without bodies.
    pub fn new(options: Options<T>) -> Self {
        let shifted = [T::default(); D];
        Self {
            report: options.report,
            bodies: BTreeMap::new(),
            pairs: Vec::new(),
            excluded: BTreeSet::new(),
            shifted,
        }
    }

    /// The model of a world after an update, as the world describes itself.
    pub fn of(world: &BroadPhase<D, T>) -> Self {
        let body = |id| {
            let (aabb, reported) = (world.aabb(id).unwrap(), world.reported_aabb(id).unwrap());
            let filter = world.filter(id).unwrap();
            Body {
                aabb,
                reported,
                filter,
                is_enabled: world.is_enabled(id).unwrap(),
                last: Some(AtUpdate { from: aabb, reported }),
                rest: None,
            }
        };
        let mut model = Self::new(world.options());
        model.bodies = world.ids().map(|id| (id, body(id))).collect();
        model.pairs = world.pairs().collect();
        for (at, a) in world.ids().enumerate() {
            let excluded = world.ids().skip(at + 1).filter(|&b| world.is_excluded(a, b).unwrap());
            model.excluded.extend(excluded.map(|b| [a, b]));
        }
        model
    }

    /// Adds a body, under the id that the world gave it.
    pub fn insert(&mut self, id: ProxyId, aabb: Aabb<D, T>, filter: Filter) {
        let body = Body { aabb, reported: aabb, filter, is_enabled: true, last: None, rest: None };
        assert!(self.bodies.insert(id, body).is_none(), "{id:?} was given out twice");
        self.refatten(id);
    }

    /// Removes a body.
    pub fn remove(&mut self, id: ProxyId) {
        self.bodies.remove(&id).unwrap();
        self.excluded.retain(|pair| !pair.contains(&id));
    }

    fn body(&mut self, id: ProxyId) -> &mut Body<D, T> {
        self.bodies.get_mut(&id).unwrap()
    }

    /// Gives a body the reported box that follows from its box and from the last update.
    fn refatten(&mut self, id: ProxyId) {
        let (report, shifted) = (self.report, self.shifted);
        let body = self.body(id);
        body.reported = match report {
            Report::Fat { margin, prediction } => {
                let from = match &body.last {
                    Some(last) if body.rest.is_none() => last.from,
                    _ => body.aabb,
                };
                let new = fatten([margin, prediction], &from, &body.aabb);
                let had = body.last.as_ref().map(|last| translate(&last.reported, &shifted));
                match had {
                    Some(had) if is_kept(&had, &body.aabb, &new) => had,
                    _ => new,
                }
            }
            _ => body.aabb,
        };
    }

    /// Gives a body its new box.
    pub fn set(&mut self, id: ProxyId, aabb: Aabb<D, T>) {
        let body = self.body(id);
        (body.aabb, body.rest) = (aabb, None);
        self.refatten(id);
    }

    /// Gives a body a box to which it did not move.
    pub fn teleport(&mut self, id: ProxyId, aabb: Aabb<D, T>) {
        if let Some(last) = &mut self.body(id).last {
            last.from = aabb;
        }
        self.set(id, aabb);
    }

    /// Moves a body from one box to another.
    pub fn set_swept(&mut self, id: ProxyId, from: Aabb<D, T>, to: Aabb<D, T>) {
        let least = |a: T, b: T| if a < b { a } else { b };
        let most = |a: T, b: T| if a > b { a } else { b };
        let min = std::array::from_fn(|axis| least(from.min[axis], to.min[axis]));
        let max = std::array::from_fn(|axis| most(from.max[axis], to.max[axis]));
        let body = self.body(id);
        (body.aabb, body.rest) = (Aabb::new(min, max), Some(to));
        self.refatten(id);
    }

    /// Moves everything.
    pub fn shift(&mut self, offset: [T; D]) {
        self.shifted = std::array::from_fn(|axis| self.shifted[axis] + offset[axis]);
        for body in self.bodies.values_mut() {
            let rest = body.rest.as_mut();
            let from = body.last.as_mut().map(|last| &mut last.from);
            for aabb in [Some(&mut body.aabb), from, rest].into_iter().flatten() {
                *aabb = translate(aabb, &offset);
            }
        }
        self.refatten_all();
    }

    fn refatten_all(&mut self) {
        let ids: Vec<_> = self.bodies.keys().copied().collect();
        ids.into_iter().for_each(|id| self.refatten(id));
    }

    /// Gives a body another filter.
    pub fn set_filter(&mut self, id: ProxyId, filter: Filter) {
        self.bodies.get_mut(&id).unwrap().filter = filter;
    }

    /// Enables a body or disables it.
    pub fn set_enabled(&mut self, id: ProxyId, is_enabled: bool) {
        self.body(id).is_enabled = is_enabled;
    }

    /// Excludes a pair of two bodies, or includes it again.
    pub fn set_excluded(&mut self, a: ProxyId, b: ProxyId, is_excluded: bool) {
        let pair = [a.min(b), a.max(b)];
        if is_excluded && a != b {
            self.excluded.insert(pair);
        } else {
            self.excluded.remove(&pair);
        }
    }

    /// The pairs that the reported boxes have now, sorted.
    pub fn overlapping_pairs(&self) -> Vec<Pair> {
        let bodies: Vec<_> = self.bodies.iter().collect();
        let mut pairs = Vec::with_capacity(self.pairs.len());
        for (index, (a, first)) in bodies.iter().enumerate() {
            for (b, second) in &bodies[index + 1..] {
                if first.reported.overlaps(&second.reported)
                    && first.is_enabled
                    && second.is_enabled
                    && first.filter.allows(&second.filter)
                    && !self.excluded.contains(&[**a, **b])
                {
                    pairs.push([**a, **b]);
                }
            }
        }
        pairs
    }

    /// The pairs that began and those that ended since the last update, sorted.
    pub fn update(&mut self) -> (Vec<Pair>, Vec<Pair>) {
        self.refatten_all();
        let now = self.overlapping_pairs();
        let (begun, ended) = (missing(&self.pairs, &now), missing(&now, &self.pairs));
        self.pairs = now;
        self.shifted = [T::default(); D];
        for body in self.bodies.values_mut() {
            body.last = Some(AtUpdate { from: body.aabb, reported: body.reported });
        }
        let swept = self.bodies.iter().filter_map(|(&id, body)| Some((id, body.rest?)));
        for (id, to) in swept.collect::<Vec<_>>() {
            self.teleport(id, to);
        }
        (begun, ended)
    }

    /// The bodies that overlapped one at the last update, sorted.
    pub fn pairs_of(&self, id: ProxyId) -> Vec<ProxyId> {
        let other = |&[a, b]: &Pair| if a == id { Some(b) } else { (b == id).then_some(a) };
        let mut others: Vec<_> = self.pairs.iter().filter_map(other).collect();
        others.sort();
        others
    }

    /// The ids and boxes of the bodies that queries with a filter see.
    fn seen<'a>(
        &'a self,
        filter: &'a Option<Filter>,
    ) -> impl Iterator<Item = (ProxyId, &'a Aabb<D, T>)> + 'a {
        let is_seen = |body: &Body<D, T>| {
            body.is_enabled && filter.is_none_or(|filter| filter.allows(&body.filter))
        };
        let seen = self.bodies.iter().filter(move |(_, body)| is_seen(body));
        seen.map(|(&id, body)| (id, &body.aabb))
    }

    /// The bodies whose boxes overlap an area, sorted.
    pub fn overlapping(&self, area: &Aabb<D, T>, filter: &Option<Filter>) -> Vec<ProxyId> {
        self.seen(filter).filter(|(_, aabb)| aabb.overlaps(area)).map(|(id, _)| id).collect()
    }

    /// The bodies whose boxes are at most `radius` away from a point, sorted.
    pub fn within(&self, center: [T; D], radius: T, filter: &Option<Filter>) -> Vec<ProxyId> {
        let radius = radius.to_f64();
        // Scaled by the power of two that brings the radius near 1, squares neither overflow nor vanish. (The power is made
        // of bits, since `powi` may round; under Miri it does.)
        let exponent = (radius.to_bits() >> 52) as i32 - 1023;
        let power_of_two = |exponent: i32| f64::from_bits(((1023 + exponent) as u64) << 52);
        let scales = [-exponent / 2, exponent / 2 - exponent].map(power_of_two);
        let scale = |length: f64| length * scales[0] * scales[1];
        let is_near = |aabb: &Aabb<D, T>| {
            let gaps: [f64; D] = std::array::from_fn(|axis| gap(&center, aabb, axis));
            let square = |length: f64| scale(length) * scale(length);
            match radius {
                0.0 => gaps.iter().all(|&gap| gap == 0.0),
                f64::INFINITY => true,
                _ => gaps.iter().fold(0.0, |sum, &gap| sum + square(gap)) <= square(radius),
            }
        };
        self.seen(filter).filter(|(_, aabb)| is_near(aabb)).map(|(id, _)| id).collect()
    }

    /// The `k` bodies nearest to a point and at most `max_distance` away, with the squares of their distances, sorted by
    /// distance and then by id.
    pub fn nearest(
        &self,
        point: [T; D],
        k: usize,
        max_distance: f64,
        filter: &Option<Filter>,
    ) -> Vec<(f64, ProxyId)> {
        let square = |aabb: &Aabb<D, T>| {
            (0..D).map(|axis| gap(&point, aabb, axis)).fold(0.0, |sum, gap| sum + gap * gap)
        };
        let mut all: Vec<_> = self.seen(filter).map(|(id, aabb)| (square(aabb), id)).collect();
        all.retain(|&(square, _)| square <= max_distance * max_distance);
        all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        all.truncate(k);
        all
    }

    /// What a cast hits, sorted by t and then by id.
    pub fn hits(&self, cast: &Cast<D, T>, filter: &Option<Filter>) -> Vec<ModelHit<D>> {
        let mut hits = Vec::new();
        for (id, aabb) in self.seen(filter) {
            let axes: [_; D] = std::array::from_fn(|axis| Approach {
                speed: cast.direction[axis].to_f64(),
                until_touch: aabb.min[axis].to_f64() - cast.from.max[axis].to_f64(),
                until_past: aabb.max[axis].to_f64() - cast.from.min[axis].to_f64(),
            });
            let limit = cast.limit.to_f64();
            let (mut first, mut last) = (0.0f64, limit);
            for (from, to) in axes.iter().map(Approach::touching) {
                (first, last) = (first.max(from), last.min(to));
            }
            if first <= last {
                let face = face(&axes);
                let mut normal = [0.0; D];
                face.into_iter().for_each(|(axis, side)| normal[axis] = side);
                let starts_inside = face.is_none();
                let is_entered = is_entered(&axes, limit);
                // 0.0 instead of -0.0, which is the same time.
                hits.push(ModelHit { t: first + 0.0, id, normal, starts_inside, is_entered });
            }
        }
        hits.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.id.cmp(&b.id)));
        hits
    }
}

/// What a cast hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelHit<const D: usize> {
    pub t: f64,
    pub id: ProxyId,
    pub normal: [f64; D],
    pub starts_inside: bool,
    /// Whether a cast that ignores what it touches hits it too.
    pub is_entered: bool,
}

/// How a cast approaches a box on one axis.
struct Approach {
    speed: f64,
    until_touch: f64,
    until_past: f64,
}

impl Approach {
    /// From which t to which the intervals touch; the first is later if they never do.
    fn touching(&self) -> (f64, f64) {
        let never = (f64::INFINITY, f64::NEG_INFINITY);
        match (self.until_touch, self.until_past) {
            (touch, past) if self.speed != 0.0 => {
                let (a, b) = (touch / self.speed, past / self.speed);
                (a.min(b), a.max(b))
            }
            (touch, past) if touch > 0.0 || past < 0.0 => never,
            _ => (never.1, never.0),
        }
    }

    /// Whether the insides meet at all times, on an axis on which the cast does not move.
    fn is_inside(&self) -> bool {
        self.until_touch < 0.0 && self.until_past > 0.0 || self.until_touch == self.until_past
    }
}

/// The axis of the face that is touched first, and the direction in which that face looks; `None` if the insides overlap at the
/// start.
fn face<const D: usize>(axes: &[Approach; D]) -> Option<(usize, f64)> {
    let towards = |axis: &Approach| axis.speed != 0.0 && axis.touching().0 >= 0.0;
    let latest = axes.iter().filter(|axis| towards(axis)).map(|axis| axis.touching().0);
    if let Some(latest) = latest.reduce(f64::max) {
        let is_it = |axis: &Approach| towards(axis) && axis.touching().0 == latest;
        let axis = axes.iter().position(is_it).unwrap();
        return Some((axis, if axes[axis].speed > 0.0 { -1.0 } else { 1.0 }));
    }
    for (at, axis) in axes.iter().enumerate() {
        if axis.until_touch == 0.0 {
            return Some((at, -1.0));
        }
        if axis.until_past == 0.0 {
            return Some((at, 1.0));
        }
    }
    None
}

/// Whether the insides of a cast and a box meet at any t up to a limit, tried at each t at which anything changes and
/// between each two of them. On an axis where both are flat they meet if they touch.
fn is_entered<const D: usize>(axes: &[Approach; D], limit: f64) -> bool {
    let mut times = vec![0.0, limit];
    for axis in axes.iter().filter(|axis| axis.speed != 0.0) {
        let (from, to) = axis.touching();
        times.extend([from, to].map(|time| time + 0.0));
    }
    times.sort_by(f64::total_cmp);
    times.dedup();
    // The even moments are `times`, the odd ones lie between them.
    let moment = |time: f64| 2 * times.iter().position(|&other| other == time).unwrap();
    (moment(0.0)..=moment(limit)).any(|now| {
        axes.iter().all(|axis| {
            let (from, to) = axis.touching();
            match axis {
                Approach { speed: 0.0, .. } => axis.is_inside(),
                // Nothing is entered at infinity.
                _ if axis.until_touch == axis.until_past => {
                    now == moment(from) && from < f64::INFINITY
                }
                _ => moment(from) < now && now < moment(to),
            }
        })
    })
}

/// The items of a sorted list that are not in another.
pub(super) fn missing(from: &[Pair], of: &[Pair]) -> Vec<Pair> {
    let mut from = from.iter().peekable();
    let mut missing = Vec::new();
    for pair in of {
        while from.next_if(|&other| other < pair).is_some() {}
        if from.peek() != Some(&pair) {
            missing.push(*pair);
        }
    }
    missing
}

/// The distance from a point to a box on one axis.
fn gap<const D: usize, T: Scalar>(point: &[T; D], aabb: &Aabb<D, T>, axis: usize) -> f64 {
    let at = point[axis].to_f64();
    (aabb.min[axis].to_f64() - at).max(at - aabb.max[axis].to_f64()).max(0.0)
}

/// Whether a body keeps the fat AABB that it had.
fn is_kept<const D: usize, T: Scalar>(
    had: &Aabb<D, T>,
    aabb: &Aabb<D, T>,
    new: &Aabb<D, T>,
) -> bool {
    let two = T::from_f64(2.0);
    (0..D).all(|axis| had.min[axis] <= aabb.min[axis] && aabb.max[axis] <= had.max[axis])
        && !(0..D).any(|axis| had.max[axis] - had.min[axis] > two * (new.max[axis] - new.min[axis]))
}

fn translate<const D: usize, T: Scalar>(aabb: &Aabb<D, T>, offset: &[T; D]) -> Aabb<D, T> {
    let moved = |corner: [T; D]| std::array::from_fn(|axis| corner[axis] + offset[axis]);
    Aabb::new(moved(aabb.min), moved(aabb.max))
}

/// A new fat AABB of a body that moved from one box to another.
#[expect(clippy::needless_range_loop, reason = "four arrays are read at the axis")]
fn fatten<const D: usize, T: Scalar>(
    [margin, prediction]: [T; 2],
    from: &Aabb<D, T>,
    aabb: &Aabb<D, T>,
) -> Aabb<D, T> {
    let zero = T::default();
    let size = |way: T| if way < zero { zero - way } else { way };
    let sides = (0..D).map(|axis| aabb.max[axis] - aabb.min[axis]);
    let longest = sides.fold(zero, |longest, side| if side > longest { side } else { longest });
    let limit = T::from_f64(4.0) * (longest + margin);
    let ways: [T; D] = std::array::from_fn(|axis| {
        let way = aabb.min[axis] - from.min[axis];
        if way.to_f64().is_finite() { way } else { zero }
    });
    let has_jumped = ways.iter().any(|&way| size(way) > limit);
    let mut fat = *aabb;
    for axis in 0..D {
        fat.min[axis] = aabb.min[axis] - margin;
        fat.max[axis] = aabb.max[axis] + margin;
        let reach = size(ways[axis] * prediction);
        let ahead = match has_jumped {
            true => zero,
            false if reach > limit => limit,
            false => reach,
        };
        if ways[axis] < zero {
            fat.min[axis] = fat.min[axis] - ahead;
        } else {
            fat.max[axis] = fat.max[axis] + ahead;
        }
    }
    fat
}
