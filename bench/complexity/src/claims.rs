//! The table: what each algorithm costs at best, on average and at worst, in formulas.

use sweep_and_prune_algorithms::{Axis, Method, RunnerOptions, Sort};

use crate::facts::Facts;
use crate::worlds::World;

/// Which column of the table a claim stands in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Case {
    /// The least it can cost.
    Best,
    /// What it costs in a world that moves a little from step to step.
    Average,
    /// The most it can cost. An algorithm may have several worst cases, each for a reason of its
    /// own.
    Worst,
    /// The first step, of the forms that keep what later steps need.
    Start,
}

impl Case {
    /// The word in the table.
    pub const fn name(self) -> &'static str {
        match self {
            Case::Best => "best",
            Case::Average => "average",
            Case::Worst => "worst",
            Case::Start => "first step",
        }
    }
}

/// This many operations in a step of this world.
#[derive(Clone, Copy, Debug)]
pub struct Claim {
    /// The column.
    pub case: Case,
    /// Where it is measured.
    pub world: World,
    /// The formula as it is read.
    pub formula: &'static str,
    /// The formula as it is evaluated, with the constant factors of its terms.
    pub cost: fn(&Facts) -> f64,
}

/// One row: an algorithm, how it sorts, and its claims.
#[derive(Clone, Debug)]
pub struct Variant {
    /// The algorithm as it is run: along x, persistent.
    pub options: RunnerOptions,
    /// The claims, best case first.
    pub claims: Vec<Claim>,
    /// The memory it works with, as it is read.
    pub space: &'static str,
    /// The same in bytes, evaluated; what doubles when it is full may hold twice that.
    pub space_cost: fn(&Facts) -> f64,
}

/// Every row of the table.
pub fn variants() -> Vec<Variant> {
    let mut all = vec![pairwise()];
    all.extend(Sort::ALL.map(sorted_pairwise));
    all.extend(Sort::ALL.map(endpoint_sweep));
    all.extend([Sort::Standard, Sort::Insertion].map(axis_sweeps));
    all.extend([swap_sweep(), axis_swap_sweeps()]);
    all
}

fn options(method: Method, sort: Sort) -> RunnerOptions {
    RunnerOptions::new(method).sort(sort).axis(Axis::Fixed(0)).persistent(true)
}

fn claim(case: Case, world: World, formula: &'static str, cost: fn(&Facts) -> f64) -> Claim {
    Claim { case, world, formula, cost }
}

/// The comparisons of a sort of this many keys, to the first order: the constant differs from sort to sort.
fn n_log_n(keys: f64) -> f64 {
    keys * keys.log2()
}

fn pairwise() -> Variant {
    // One test for each pair of boxes, one report for each overlap on the axis, one for each pair that overlaps.
    let cost: fn(&Facts) -> f64 = |f| f.n * (f.n - 1.0) / 2.0 + f.m + f.p;
    let always = |case, world| claim(case, world, "n²", cost);
    Variant {
        options: options(Method::Pairwise, Sort::Standard),
        claims: vec![
            always(Case::Best, World::Rest),
            always(Case::Average, World::Corridor),
            always(Case::Average, World::Square),
            always(Case::Worst, World::Heap),
        ],
        space: "1",
        space_cost: |_| 0.0,
    }
}

/// Sorts n keys; each overlap on the axis is found and tested.
fn sorted_pairwise(sort: Sort) -> Variant {
    let n_log_n_m: fn(&Facts) -> f64 = |f| n_log_n(f.n) + 2.0 * f.m + f.p;
    let n_s_m: fn(&Facts) -> f64 = |f| f.n + 2.0 * f.s_left + 2.0 * f.m + f.p;
    let mut claims = one_axis_claims(sort, |f| f.n, n_log_n_m, n_s_m);
    if sort == Sort::Quicksort {
        // Two keys less with each pass over what is left.
        let cost: fn(&Facts) -> f64 = |f| f.n * f.n / 4.0;
        claims.push(claim(Case::Worst, World::QuicksortKiller, "n² (sort)", cost));
    }
    let options = options(Method::SortedPairwise, sort);
    Variant { options, claims, space: "n", space_cost: |f| 16.0 * f.n }
}

/// Sorts 2n keys; each overlap on the axis is found and tested.
fn endpoint_sweep(sort: Sort) -> Variant {
    let n_log_n_m: fn(&Facts) -> f64 = |f| n_log_n(2.0 * f.n) + 2.0 * f.m + f.p;
    let n_s_m: fn(&Facts) -> f64 = |f| 2.0 * f.n + 2.0 * f.s + 2.0 * f.m + f.p;
    let claims = one_axis_claims(sort, |f| 2.0 * f.n, n_log_n_m, n_s_m);
    let options = options(Method::EndpointSweep, sort);
    Variant { options, claims, space: "n", space_cost: |f| 36.0 * f.n }
}

/// The claims of the forms that sort in every step and sweep one axis.
fn one_axis_claims(
    sort: Sort,
    n: fn(&Facts) -> f64,
    n_log_n_m: fn(&Facts) -> f64,
    n_s_m: fn(&Facts) -> f64,
) -> Vec<Claim> {
    // These sorts need one pass over an array that is in order: s = 0.
    let is_adaptive = matches!(sort, Sort::Standard | Sort::Timsort | Sort::Insertion);
    let best = if is_adaptive { ("n", n) } else { ("n log n", n_log_n_m) };
    let (average, average_cost) = match sort {
        Sort::Insertion => ("n + s + m", n_s_m),
        _ => ("n log n + m", n_log_n_m),
    };
    let at_rest = if is_adaptive { n_s_m } else { n_log_n_m };
    // The worst order for the sort.
    let (order, by_sort) = match sort {
        Sort::Insertion => (World::Mirror, "n² (s)"),
        _ => (World::CorridorStart, "n log n + m (sort)"),
    };
    vec![
        claim(Case::Best, World::Rest, best.0, best.1),
        claim(Case::Average, World::Corridor, average, average_cost),
        claim(Case::Average, World::Square, average, average_cost),
        claim(Case::Worst, World::Heap, "n² (m)", at_rest),
        claim(Case::Worst, World::Tower, "n² (m)", at_rest),
        claim(Case::Worst, order, by_sort, average_cost),
    ]
}

/// Sorts 2n keys an axis; each overlap on each axis is found.
fn axis_sweeps(sort: Sort) -> Variant {
    let (formula, cost): (_, fn(&Facts) -> f64) = match sort {
        Sort::Insertion => ("n + S + M", |f| 4.0 * f.n + 2.0 * f.s_all + f.m_all + f.p),
        _ => ("n log n + M", |f| 2.0 * n_log_n(2.0 * f.n) + f.m_all + f.p),
    };
    // Both sorts need one pass over an array that is in order.
    let at_rest: fn(&Facts) -> f64 = |f| 4.0 * f.n + f.m_all + f.p;
    let mut claims = vec![
        claim(Case::Best, World::Rest, "n", at_rest),
        claim(Case::Average, World::Square, formula, cost),
        claim(Case::Worst, World::Corridor, "n² (M)", cost),
        claim(Case::Worst, World::Heap, "n² (M)", at_rest),
        claim(Case::Worst, World::Tower, "n² (M)", at_rest),
    ];
    if sort == Sort::Insertion {
        claims.push(claim(Case::Worst, World::Mirror, "n² (S)", cost));
    }
    let options = options(Method::AxisSweeps, sort);
    // An endpoint is 16 bytes, the place of a box among those touched 4; a flag with its slots in
    // the table is about 48.
    Variant { options, claims, space: "n + m", space_cost: |f| 68.0 * f.n + 48.0 * f.m }
}

/// Carries 2n keys to their places; each overlap on the axis is tested in every step, and found or
/// ended when a swap says so.
fn swap_sweep() -> Variant {
    let cost: fn(&Facts) -> f64 = |f| 2.0 * f.n + 2.0 * f.s + f.m + f.p;
    let start: fn(&Facts) -> f64 = |f| n_log_n(2.0 * f.n) + 2.0 * f.m + f.p;
    Variant {
        options: options(Method::SwapSweep, Sort::Standard),
        claims: vec![
            claim(Case::Best, World::Rest, "n", |f| 2.0 * f.n),
            claim(Case::Average, World::Corridor, "n + s + m", cost),
            claim(Case::Average, World::Square, "n + s + m", cost),
            claim(Case::Worst, World::Heap, "n² (m)", cost),
            claim(Case::Worst, World::Tower, "n² (m)", cost),
            claim(Case::Worst, World::Mirror, "n² (s)", cost),
            claim(Case::Start, World::CorridorStart, "n log n + m", start),
        ],
        space: "n + m",
        space_cost: |f| 36.0 * f.n + 48.0 * f.m,
    }
}

/// Carries 2n keys an axis to their places; an overlap costs nothing while it lasts.
fn axis_swap_sweeps() -> Variant {
    let cost: fn(&Facts) -> f64 = |f| 4.0 * f.n + 2.0 * f.s_all + f.p;
    let start: fn(&Facts) -> f64 = |f| 2.0 * n_log_n(2.0 * f.n) + f.m_all + f.p;
    Variant {
        options: options(Method::AxisSwapSweeps, Sort::Standard),
        claims: vec![
            claim(Case::Best, World::Rest, "n", |f| 4.0 * f.n),
            claim(Case::Best, World::Tower, "n", |f| 4.0 * f.n),
            claim(Case::Average, World::Square, "n + S + p", cost),
            claim(Case::Worst, World::Heap, "n² (p)", cost),
            claim(Case::Worst, World::Mirror, "n² (S)", cost),
            claim(Case::Start, World::SquareStart, "n log n + M", start),
        ],
        space: "n + M",
        space_cost: |f| 68.0 * f.n + 48.0 * f.m_all,
    }
}
