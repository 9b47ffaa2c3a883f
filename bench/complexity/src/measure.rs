//! Counts the operations of one step at growing sizes, and fits slopes.

use serde::Serialize;
use sweep_and_prune_algorithms::{Counts, Method, Runner};

use crate::claims::{Claim, Variant};
use crate::facts::Facts;
use crate::worlds::World;

/// How far to go.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// n goes from two to this power ...
    pub least: u32,
    /// ... up to two to this one, ...
    pub most: u32,
    /// ... unless a step would cost more operations than this, by the claim ...
    pub operations: f64,
    /// ... or hold more pairs at once.
    pub pairs: f64,
}

impl Limits {
    /// For the table.
    pub const FULL: Self =
        Self { least: 8, most: 16, operations: (1u64 << 28) as f64, pairs: (1u64 << 22) as f64 };
    /// For a test, in seconds even without optimization.
    pub const QUICK: Self =
        Self { least: 7, most: 11, operations: (1u64 << 18) as f64, pairs: (1u64 << 17) as f64 };
}

/// One claim, counted at growing n.
#[derive(Clone, Debug, Serialize)]
pub struct Measurement {
    /// The numbers of boxes, powers of two.
    pub n: Vec<usize>,
    /// The operations of the step at each.
    pub operations: Vec<u64>,
    /// The overlaps on the sweep axis at each.
    pub overlaps: Vec<u64>,
    /// The inversions at each.
    pub inversions: Vec<u64>,
    /// The bytes that the algorithm holds after the step at each.
    pub bytes: Vec<usize>,
    /// The slope of log(operations) over log n.
    pub slope: f64,
    /// The slope that the claim's formula has there.
    pub claimed_slope: f64,
    /// The slope of log(operations / claim): 0 if the operations grow exactly as is claimed.
    pub residual: f64,
    /// Operations for each that the claim expects, at the largest n.
    pub ratio: f64,
    /// Bytes for each that the claim expects, at each n; without meaning where none are claimed.
    #[serde(skip)]
    pub space_ratios: Vec<f64>,
}

/// How many pairs are in memory at once.
fn pairs_held(variant: &Variant, claim: &Claim, facts: &Facts) -> f64 {
    let reported = if claim.world == World::Heap { facts.m } else { 0.0 };
    let kept = match variant.options.method {
        Method::AxisSweeps | Method::SwapSweep => facts.m,
        Method::AxisSwapSweeps => facts.m_all,
        _ => 0.0,
    };
    reported.max(kept)
}

/// Counts the step that the claim is about at every power of two within the limits, and at no
/// fewer than three.
pub fn measure(variant: &Variant, claim: &Claim, limits: Limits) -> Measurement {
    let mut result = Measurement {
        n: Vec::new(),
        operations: Vec::new(),
        overlaps: Vec::new(),
        inversions: Vec::new(),
        bytes: Vec::new(),
        slope: 0.0,
        claimed_slope: 0.0,
        ratio: 0.0,
        residual: 0.0,
        space_ratios: Vec::new(),
    };
    let mut costs = Vec::new();
    for n in (limits.least..=limits.most).map(|log| 1 << log) {
        let (before, now) = claim.world.steps(n);
        let facts = Facts::of(claim.world, before.as_ref(), &now);
        let cost = (claim.cost)(&facts);
        let too_far = cost > limits.operations || pairs_held(variant, claim, &facts) > limits.pairs;
        if too_far && costs.len() >= 3 {
            break;
        }
        let mut runner = Runner::new(variant.options);
        if let Some(before) = before {
            runner.step(&before, &mut ()).expect("valid boxes");
        }
        let mut counts = Counts::default();
        runner.step(&now, &mut counts).expect("valid boxes");
        costs.push(cost);
        result.space_ratios.push(runner.bytes() as f64 / (variant.space_cost)(&facts));
        result.n.push(n);
        result.operations.push(counts.operations());
        result.overlaps.push(facts.m as u64);
        result.inversions.push(facts.s as u64);
        result.bytes.push(runner.bytes());
    }
    let operations: Vec<f64> = result.operations.iter().map(|&count| count as f64).collect();
    let ratios: Vec<f64> = operations.iter().zip(&costs).map(|(a, b)| a / b).collect();
    result.slope = slope(&result.n, &operations);
    result.claimed_slope = slope(&result.n, &costs);
    result.ratio = round(ratios[ratios.len() - 1]);
    result.residual = slope(&result.n, &ratios);
    result
}

/// Rounds to four decimals, so that the last bit of a logarithm does not change the report.
fn round(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

/// The slope of the line of least squares through (log n, log value).
fn slope(n: &[usize], values: &[f64]) -> f64 {
    let x: Vec<f64> = n.iter().map(|&n| (n as f64).ln()).collect();
    let y: Vec<f64> = values.iter().map(|value| value.max(1.0e-9).ln()).collect();
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (mean_x, mean_y) = (mean(&x), mean(&y));
    let covariance: f64 = x.iter().zip(&y).map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    let slope = covariance / x.iter().map(|x| (x - mean_x) * (x - mean_x)).sum::<f64>();
    round(slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_has_its_exponent_as_slope() {
        let n = [256, 512, 1024, 2048];
        let values = n.map(|n: usize| 3.0 * (n as f64).powf(1.5));
        assert_eq!(slope(&n, &values), 1.5);
    }
}
