//! The measured table, as Markdown for people and as JSON for the site.

use std::fmt::Write;

use serde::Serialize;

use crate::claims::{Case, Variant};
use crate::measure::Measurement;
use crate::worlds::World;

/// How far the fitted slope of (operations / claim) may be from flat.
pub const TOLERANCE: f64 = 0.06;

/// One claim and what was counted.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// best, average, worst or first step.
    pub case: &'static str,
    /// The world it was measured in.
    pub world: &'static str,
    /// The formula.
    pub claim: &'static str,
    /// What was counted.
    #[serde(flatten)]
    pub measurement: Measurement,
}

/// One algorithm with its claims.
#[derive(Clone, Debug, Serialize)]
pub struct Section {
    /// The name of the algorithm.
    pub method: &'static str,
    /// The name of the sort; `null` where none is chosen.
    pub sort: Option<&'static str>,
    /// The claims in one line a column: best, average, worst.
    pub best: String,
    /// See `best`.
    pub average: String,
    /// See `best`.
    pub worst: String,
    /// The memory it works with.
    pub space: &'static str,
    /// Each claim with its measurement.
    pub rows: Vec<Row>,
}

/// A world by name.
#[derive(Clone, Debug, Serialize)]
struct WorldText {
    name: &'static str,
    description: &'static str,
}

/// The whole table.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    worlds: Vec<WorldText>,
    tolerance: f64,
    variants: Vec<Section>,
}

impl Report {
    /// The table of these variants, each with one measurement a claim.
    pub fn new(measured: Vec<(Variant, Vec<Measurement>)>) -> Self {
        let text =
            |world: &World| WorldText { name: world.name(), description: world.description() };
        Self {
            worlds: World::ALL.iter().map(text).collect(),
            tolerance: TOLERANCE,
            variants: measured.into_iter().map(|(variant, rows)| section(&variant, rows)).collect(),
        }
    }

    /// As JSON, for programs.
    pub fn json(&self) -> String {
        serde_json::to_string(self).expect("a report has no maps and no NaN") + "\n"
    }

    /// The table of claims in `markdown`.
    pub fn claims_table(&self) -> String {
        claims_table(&self.variants)
    }

    /// As Markdown, for people.
    pub fn markdown(&self) -> String {
        let mut text = HEAD.to_string();
        text += &claims_table(&self.variants);
        text += NOTES;
        text += "\n## Measured\n\n";
        for world in &self.worlds {
            writeln!(text, "- **{}**: {}.", world.name, world.description).expect("a string");
        }
        text += MEASURED_HEAD;
        for section in &self.variants {
            for row in &section.rows {
                let Measurement { n, operations, slope, claimed_slope, residual, ratio, .. } =
                    &row.measurement;
                let (first, last) = (n[0].ilog2(), n[n.len() - 1].ilog2());
                let count = operations[operations.len() - 1];
                writeln!(
                    text,
                    "| {} | {} | {} | {} | 2^{first}..2^{last} | {count} | {claimed_slope:.2} | \
                     {slope:.2} | {residual:+.2} | {ratio:.2} |",
                    name(section),
                    row.case,
                    row.world,
                    row.claim,
                )
                .expect("a string");
            }
        }
        text
    }
}

fn section(variant: &Variant, measurements: Vec<Measurement>) -> Section {
    let column = |case| {
        let mut formulas: Vec<&str> = Vec::new();
        for claim in variant.claims.iter().filter(|claim| claim.case == case) {
            let formula = claim.formula.split(" (").next().unwrap_or_default();
            // If there are several worst cases, the column has the worst of them.
            let is_lesser = case == Case::Worst && !formula.contains('²');
            if !formulas.contains(&formula) && !is_lesser {
                formulas.push(formula);
            }
        }
        formulas.join(", ")
    };
    let options = variant.options;
    let rows = variant.claims.iter().zip(measurements).map(|(claim, measurement)| Row {
        case: claim.case.name(),
        world: claim.world.name(),
        claim: claim.formula,
        measurement,
    });
    Section {
        method: options.method.name(),
        sort: (variant.options.method.sorts() && !options.method.name().contains("swap"))
            .then_some(options.sort.name()),
        best: column(Case::Best),
        average: column(Case::Average),
        worst: column(Case::Worst),
        space: variant.space,
        rows: rows.collect(),
    }
}

fn name(section: &Section) -> String {
    match section.sort {
        Some(sort) => format!("{}, {sort}", section.method),
        None => section.method.to_string(),
    }
}

/// The table of claims alone, which needs no measurement.
fn claims_table(sections: &[Section]) -> String {
    let mut text =
        String::from("| algorithm | best | average | worst | space |\n|---|---|---|---|---|\n");
    for section in sections {
        let Section { best, average, worst, space, .. } = section;
        writeln!(text, "| {} | {best} | {average} | {worst} | {space} |", name(section))
            .expect("a string");
    }
    text
}

const HEAD: &str = "\
# What each algorithm costs, claimed and measured

<!-- Written by `cargo run --release -p sweep-and-prune-complexity`; do not edit. -->

Operations in one step: comparisons and swaps of the sort, box tests, overlaps that begin or end \
on an axis, and reported pairs. Every entry is O(...).

- n: boxes.
- m: pairs that overlap **on the sweep axis**, whether or not the boxes overlap; M: the same, \
summed over every axis.
- s: inversions, the pairs of endpoints whose order changed since the last step; S: the same, \
summed over every axis.
- p: pairs, boxes that overlap on every axis.

*Average* means a world that moves a little from step to step, with the order of the last step \
kept. m and s range from 0 to about 2n², M and S to that for each axis; p ≤ m ≤ n(n-1)/2.

";

const NOTES: &str = "
What to know about the table:

- No algorithm can be faster than its output: if all boxes overlap, there are n(n-1)/2 pairs to \
report.
- m is not the number of collisions. In a tower swept from the side, every pair overlaps on the \
axis and none collides. Even a square of constant density has m near n√n. Only in a long level \
does m grow as n, and only there does the one-axis sweep take O(n log n).
- Sweeping every axis is only as good as the worst axis: in the same long level, nearly half of \
all pairs overlap on y. Its gain is in its best cases. The swap-driven form on every axis \
compares all 2n endpoints on each axis, and beyond that it pays only for swaps and for reported \
pairs. A tower at rest costs it O(n) comparisons, where the others make n²/2 tests.
- Insertion sort is O(n + s): no swap in a world at rest, and 2n(n-1) at worst, when every box \
moves past every other. A first step in random order takes half as many, n(n-1): use another \
sort for it.
- Quicksort is never O(n), even on sorted input, and O(n²) at worst. The standard library's sort \
and Timsort are O(n) on sorted input. After a few exchanges they are O(n log n) again, but with \
fewer operations in practice.
- No algorithm that sorts takes O(1) space: it sorts an array of its own and leaves the caller's \
as it is. Quicksort needs O(log n) more for its stack, merge sort and Timsort O(n) for merging.
- The forms that keep overlaps keep them in a hash table. A change of it is O(1) in expectation, \
not in the worst case.
";

const MEASURED_HEAD: &str = "
The operations of one step, counted at every power of two in the range. A claim is evaluated on \
n, m and s, which are counted without the algorithm. *Claimed* and *measured* are slopes of \
log(operations) over log n; *off* is the slope of log(operations / claim), which is 0 if the \
growth is exactly as claimed, 0.12 or so if it should have had a factor log n more, and has to \
stay within ±0.06. *Factor* is (operations / claim) at the largest n; the claim is evaluated \
with the constants of its terms (a test and an overlap for each m, a comparison and a swap for \
each s), so where nothing but these is counted it is 1. A range ends at 2^16, or where a step \
would cost more than 2^28 operations or hold more than 2^22 pairs: what is quadratic stays \
quadratic, and takes minutes.

| algorithm | case | world | claim | n | operations | claimed | measured | off | factor |
|---|---|---|---|---|---:|---:|---:|---:|---:|
";
