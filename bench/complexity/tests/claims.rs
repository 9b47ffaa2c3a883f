//! The slopes that are measured are those that the table claims, here on fewer boxes than in
//! `docs/complexity.md`.

use sweep_and_prune_algorithms::{Method, Sort};
use sweep_and_prune_complexity::{
    Case, Claim, Limits, Report, TOLERANCE, Variant, World, measure, variants,
};

#[test]
fn no_measured_slope_leaves_what_the_table_claims() {
    // The constants of the terms are claimed as well; those of n log n to a factor below two.
    let mut wrong = Vec::new();
    let mut measured = Vec::new();
    for variant in variants() {
        let mut measurements = Vec::new();
        for claim in &variant.claims {
            let measurement = measure(&variant, claim, Limits::QUICK);
            let factor = 0.45..1.8;
            if measurement.residual.abs() > TOLERANCE || !factor.contains(&measurement.ratio) {
                wrong.push(format!("{:?} {claim:?}: {measurement:?}", variant.options));
            }
            measurements.push(measurement);
        }
        measured.push((variant, measurements));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));

    // And the document says what is claimed.
    let report = Report::new(measured);
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/complexity.md");
    let document = std::fs::read_to_string(path).unwrap();
    assert!(document.contains(&report.claims_table()), "regenerate docs/complexity.md");
}

#[test]
fn memory_grows_as_claimed() {
    for variant in variants() {
        for claim in variant.claims.iter().filter(|claim| claim.case == Case::Average) {
            let measurement = measure(&variant, claim, Limits::QUICK);
            if variant.options.method == Method::Pairwise {
                assert!(measurement.bytes.iter().all(|&bytes| bytes == 0));
            } else {
                let held = 0.5..2.2;
                let as_claimed = measurement.space_ratios.iter().all(|ratio| held.contains(ratio));
                assert!(as_claimed, "{:?} {claim:?}: {measurement:?}", variant.options);
            }
        }
    }
}

/// A claim that is wrong by no more than a logarithm is found out.
#[test]
fn false_claims_are_caught() {
    let find = |method: Method, sort: Sort| -> Variant {
        let is_it = |v: &Variant| v.options.method == method && v.options.sort == sort;
        variants().into_iter().find(is_it).unwrap()
    };
    let linear: fn(&sweep_and_prune_complexity::Facts) -> f64 = |f| f.n;
    let at = |world| Claim { case: Case::Best, world, formula: "n", cost: linear };
    // The published "O(n) at best" of sweep and prune with quicksort.
    for (method, sort, world) in [
        (Method::EndpointSweep, Sort::Quicksort, World::Rest),
        (Method::SortedPairwise, Sort::Merge, World::Rest),
        (Method::SortedPairwise, Sort::Timsort, World::CorridorStart),
        // And the sweep's "average O(n + m)" with m taken for the number of collisions.
        (Method::EndpointSweep, Sort::Insertion, World::Square),
        (Method::SwapSweep, Sort::Standard, World::Tower),
    ] {
        let measurement = measure(&find(method, sort), &at(world), Limits::QUICK);
        assert!(measurement.residual > TOLERANCE, "{method:?} {sort:?}: {measurement:?}");
    }
}
