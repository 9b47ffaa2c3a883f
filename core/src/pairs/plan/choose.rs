//! The choice of a plan: the cheapest cut of space, or a split of the boxes by size if that costs less.

use super::cost::{
    COLUMN_NS, Cut, PLAN_NS, PlannedSearch, RECORD_NS, Shape, TEST_NS, UNPLACED_NS, chance,
    chance_to_share, cost,
};
use super::distribution::Distribution;
use super::overlaps::{NO_LIMITS, Overlaps, chance_to_overlap, is_unexpected};
use super::sample::{AXES, Sample};
use crate::float::{greater, greatest, lesser, whole};

// Which plan is taken decides the order of the pairs, so these limits do not depend on the machine. They were
// chosen on the scenes of the benchmark, 1,000 to 1,000,000 boxes, on one core of an AMD EPYC (Zen 5).

/// A plan is cheaper than another if it costs less than this share of it. The difference keeps noise in the sample from
/// changing the plan from call to call.
const CHEAPER_COST_SHARE: f64 = 0.95;
/// A split by size must cost less than this share of the best plan so far.
const SPLIT_COST_SHARE: f64 = 0.8;
/// It is tried only if that plan costs more than this many times the placing and sorting of the boxes.
const DEAR_COST_RATIO: f64 = 3.0;
/// With fewer boxes, no glance at the sample checks a plan: it takes half a microsecond an axis.
const MIN_BOXES_TO_GLANCE: f64 = 2048.0;
/// The most columns for each box of the smaller of two sets, and for each box of the larger. A column
/// costs 15 to 100 nanoseconds even if it is empty, which the model leaves out. With points, which fit
/// into columns of any width, it would choose 2^24 columns. (1,000 against 4,000 points in space took 60 to 690 ms on a
/// loaded machine, and take less than 2 ms with this limit.)
const MOST_COLUMNS_PER_BOX: [f64; 2] = [8.0, 0.125];
/// The most columns, nearly: with a last step and with slabs still less than 2^29.
const MOST_COLUMNS: f64 = (1 << 24) as f64;
/// Records in a slab: they, their keys and the sorted boxes fit the second-level cache.
const RECORDS_PER_SLAB: f64 = 4096.0;
/// Fewer boxes that are not cut on other axes are not cut into slabs either, which would copy them once more. (Slab in the
/// plane, tower in the plane and in space: 0.73 to 0.81 of the time with 10,000 to 100,000 boxes, 0.95 with 200,000. But
/// threads share slabs, and not the sort of one column.)
const LEAST_UNCUT_TO_SLAB: f64 = 131_072.0;

/// Which plans are considered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Among {
    /// All. If boxes are known to be crowded, the sample gets a closer look at once.
    All { is_crowded: bool },
    /// Cuts, since plans are nested too deep to split any further.
    Cuts,
    /// To sweep crowded boxes at once, on any axis, since the last plan did not divide them.
    Sweeps,
}

/// A split of the boxes of one set (0 or 1) by their size on an axis.
#[derive(Clone, Copy, Debug)]
pub struct SizeSplit {
    pub set: usize,
    pub axis: usize,
    pub size: f64,
}

/// A plan, in the units of the distribution.
#[derive(Clone, Copy)]
pub enum Choice {
    Cut(Cut),
    SplitBySize(SizeSplit),
}

/// The cheapest plan, and its cost. If boxes are crowded or the plan seems dear, it follows from a closer look.
pub fn cheapest(distribution: &Distribution, samples: &[&Sample], among: Among) -> (Choice, f64) {
    let shapes = [
        Shape::new(samples[0], distribution),
        Shape::new(samples[samples.len() - 1], distribution),
    ];
    let all = &shapes[..samples.len()];
    let boxes: f64 = all.iter().map(|shape| shape.count).sum();
    let is_dear = |cost| cost > DEAR_COST_RATIO * RECORD_NS * boxes;
    if matches!(among, Among::All { is_crowded: false } | Among::Cuts) {
        let search = PlannedSearch { distribution, shapes: all, limits: [NO_LIMITS; AXES] };
        let (cut, cost) = cheapest_cut(&search);
        // The chance to overlap on the sweep axis, and on the others to share a column.
        let expected = |axis| match axis == cut.sweep {
            true => (3 - all.len()) as f64 * chance(&search, axis),
            false => chance_to_share(distribution, &shapes, &cut, axis),
        };
        let is_unexpected = |axis| is_unexpected(samples, axis, expected(axis));
        let is_expected =
            boxes < MIN_BOXES_TO_GLANCE || !(0..distribution.dimensions).any(is_unexpected);
        if is_expected && !is_dear(cost) {
            return (Choice::Cut(cut), cost);
        }
    }
    let overlaps = Overlaps::new(samples);
    let search = closer(distribution, all, &overlaps);
    let (cut, cost) =
        if among == Among::Sweeps { cheapest_sweep(&search) } else { cheapest_cut(&search) };
    let mut best = (Choice::Cut(cut), cost);
    let may_split = match among {
        Among::All { is_crowded } => is_crowded || is_dear(cost),
        Among::Cuts | Among::Sweeps => false,
    };
    if !may_split {
        return best;
    }
    for set in 0..samples.len() {
        for axis in 0..distribution.dimensions {
            for size in samples[set].quantiles(axis) {
                let [small, large] = Shape::split(samples[set], distribution, axis, size);
                if small.count == 0.0 || large.count == 0.0 {
                    continue;
                }
                let limit = SPLIT_COST_SHARE * best.1;
                let cost = if samples.len() == 1 {
                    let searches: [&[_]; 3] = [&[small], &[large], &[small, large]];
                    cost_up_to(limit, distribution, &overlaps, &searches)
                } else {
                    let [mut with_small, mut with_large] = [shapes; 2];
                    (with_small[set], with_large[set]) = (small, large);
                    cost_up_to(limit, distribution, &overlaps, &[&with_small, &with_large])
                };
                if cost < limit {
                    best = (Choice::SplitBySize(SizeSplit { set, axis, size }), cost);
                }
            }
        }
    }
    best
}

/// The axis on which to sweep few boxes at once, and the cost, if no cut is cheaper.
pub fn sweep_of_few(samples: &[&Sample], among: Among) -> Option<(usize, f64)> {
    let boxes: f64 = samples.iter().map(|sample| sample.count).sum();
    let is_crowded = matches!(among, Among::All { is_crowded: true } | Among::Sweeps);
    if boxes >= MIN_BOXES_TO_GLANCE || is_crowded {
        return None;
    }
    let pairs = match samples {
        [one] => 0.5 * one.count * one.count,
        _ => samples[0].count * samples[1].count,
    };
    let dimensions = samples[0].dimensions;
    let (mut axis, mut least) = (0, f64::INFINITY);
    for next in 0..dimensions {
        let chance = chance_to_overlap(samples, next);
        if chance < CHEAPER_COST_SHARE * least {
            (axis, least) = (next, chance);
        }
    }
    let tests = pairs * least * TEST_NS;
    let unplaced = UNPLACED_NS[dimensions - 1] * boxes;
    // k columns cost at least those columns and a k-th of the tests: least if both are equal.
    let saved = tests - unplaced - PLAN_NS;
    let may_pay = saved > 0.0 && saved * saved > 4.0 * COLUMN_NS * tests;
    (!may_pay).then_some((axis, RECORD_NS * boxes - unplaced + tests))
}

/// A search of some shapes, after a closer look.
fn closer<'a>(
    distribution: &'a Distribution,
    shapes: &'a [Shape],
    overlaps: &Overlaps,
) -> PlannedSearch<'a> {
    let [first, last] = [&shapes[0], &shapes[shapes.len() - 1]];
    let limits = overlaps.limits(first.members, last.members, shapes.len() == 1);
    PlannedSearch { distribution, shapes, limits }
}

/// The cost of several searches, or something not below the limit.
fn cost_up_to(
    limit: f64,
    distribution: &Distribution,
    overlaps: &Overlaps,
    searches: &[&[Shape]],
) -> f64 {
    let mut cost = 0.0;
    for shapes in searches {
        cost += cheapest_cut(&closer(distribution, shapes, overlaps)).1;
        if cost >= limit {
            break;
        }
    }
    cost
}

/// The cheapest axis to sweep on without a cut, and the cost.
fn cheapest_sweep(search: &PlannedSearch<'_>) -> (Cut, f64) {
    let sweeps =
        (0..search.distribution.dimensions).map(Cut::uncut).map(|cut| (cut, cost(search, &cut)));
    sweeps.reduce(|best, next| if next.1 < best.1 { next } else { best }).expect("there are axes")
}

/// The cheapest cut, and its cost.
fn cheapest_cut(search: &PlannedSearch<'_>) -> (Cut, f64) {
    let PlannedSearch { distribution, shapes, .. } = *search;
    let boxes: f64 = shapes.iter().map(|shape| shape.count).sum();
    let unplaced = UNPLACED_NS[distribution.dimensions - 1] * boxes;
    let mut best = (Cut::uncut(0), f64::INFINITY);
    for sweep in 0..distribution.dimensions {
        let uncut = Cut::uncut(sweep);
        let uncut_cost = cost(search, &uncut) - unplaced;
        let (mut cut, mut cost) = refined(search, uncut);
        if uncut_cost < cost {
            (cut, cost) = (uncut, uncut_cost);
        }
        if cost < CHEAPER_COST_SHARE * best.1 {
            best = (cut, cost);
        }
    }
    let (cut, _) = &mut best;
    let records: f64 = shapes.iter().map(|shape| shape.records(distribution, cut)).sum();
    let slabs = whole(records / cut.len() / RECORDS_PER_SLAB);
    let pays = cut.len() > 1.0 || records >= LEAST_UNCUT_TO_SLAB;
    // Only if few boxes reach from slab to slab.
    let largest = greatest(shapes.iter().map(|shape| shape.mean[cut.sweep]));
    if pays && slabs > 1.0 && largest * slabs < 0.25 * distribution.extent(cut.sweep) {
        cut.columns[cut.sweep] = slabs;
    }
    best
}

/// A cut made finer step by step, as long as that pays, and its cost.
fn refined(search: &PlannedSearch<'_>, mut cut: Cut) -> (Cut, f64) {
    let PlannedSearch { distribution, shapes, .. } = *search;
    let mut most_columns = MOST_COLUMNS;
    if let [first, second] = shapes {
        let fewer = lesser(first.count, second.count);
        let more = greater(first.count, second.count);
        let [for_fewer, for_more] = MOST_COLUMNS_PER_BOX;
        most_columns = lesser(for_fewer * fewer + for_more * more, most_columns);
    }
    let mut cut_cost = cost(search, &cut);
    while cut.len() < most_columns {
        let mut next = (cut, cut_cost);
        for axis in (0..distribution.dimensions)
            .filter(|&axis| axis != cut.sweep && distribution.extent(axis) > 0.0)
        {
            let mut finer = cut;
            finer.columns[axis] = whole(cut.columns[axis] * 1.25) + 1.0;
            let finer_cost = cost(search, &finer);
            let limit = if next.1 < cut_cost { CHEAPER_COST_SHARE * next.1 } else { cut_cost };
            if finer_cost < limit {
                next = (finer, finer_cost);
            }
        }
        if next.1 >= cut_cost {
            break;
        }
        (cut, cut_cost) = next;
    }
    (cut, cut_cost)
}
