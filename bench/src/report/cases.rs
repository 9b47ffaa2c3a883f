//! Which cases a table or a plot shows, and in which order.

use crate::libraries::WITNESSES;
use crate::record::{Case, Record};

/// Up to this number of boxes, a case belongs to the small inputs, which are compared with brute force only.
pub const SMALL: usize = 100;

/// Whether more alternatives than [`WITNESSES`] were measured.
pub fn is_open(case: &Case) -> bool {
    case.results.iter().any(|entry| entry.alternative && !WITNESSES.contains(&entry.name.as_str()))
}

/// How many times as long as sweep-and-prune the fastest alternative takes.
pub fn advantage(case: &Case) -> Option<f64> {
    case.ranking().first()?.1.ratio
}

/// The cases by scene in order of first appearance, then dimensions, then boxes.
pub fn sorted(cases: &[Case]) -> Vec<&Case> {
    let order = scenes(cases);
    let mut cases: Vec<_> = cases.iter().collect();
    cases.sort_by_key(|case| {
        let scene = (case.scene.clone(), case.dimensions);
        (order.iter().position(|one| *one == scene), case.boxes)
    });
    cases
}

/// The scenes and dimensions, the scenes in order of first appearance.
pub fn scenes(cases: &[Case]) -> Vec<(String, usize)> {
    let mut scenes: Vec<&str> = Vec::new();
    for case in cases {
        if !scenes.contains(&case.scene.as_str()) {
            scenes.push(&case.scene);
        }
    }
    let all = scenes.iter().flat_map(|&scene| [1, 2, 3].map(|dimensions| (scene, dimensions)));
    let exists = |(scene, dimensions): &(&str, usize)| {
        cases.iter().any(|case| case.scene == *scene && case.dimensions == *dimensions)
    };
    all.filter(exists).map(|(scene, dimensions)| (scene.to_owned(), dimensions)).collect()
}

/// The libraries of some cases, in order of first appearance.
pub fn names(cases: &[&Case]) -> Vec<String> {
    let mut names = Vec::new();
    for entry in cases.iter().flat_map(|case| &case.results) {
        if !names.contains(&entry.name) {
            names.push(entry.name.clone());
        }
    }
    names
}

/// The case of these boxes.
pub fn find<'a>(
    record: &'a Record,
    scene: &str,
    dimensions: usize,
    boxes: usize,
) -> Option<&'a Case> {
    let wanted =
        |case: &&Case| case.scene == scene && case.dimensions == dimensions && case.boxes == boxes;
    record.cases.iter().find(wanted)
}
