//! The tables of the level: 2,000 boxes that move among many static ones.

use std::fmt::Write;

use super::cases::{names, scenes, sorted};
use super::format::{count, significant, time};
use crate::record::{Case, Outcome, Record, Times};

/// All of them.
pub fn section(record: &Record) -> String {
    if record.statics.is_empty() {
        return String::new();
    }
    let mut text = String::from(
        "\n## Many static boxes\n\n\
         The scene of issue 1081 of Jolt Physics, with boxes: static boxes lie on a plane, four units apart, and 2,000 \
         boxes fly in the middle of the plane, above 10,000 of them. An update should take as long among 2 million static \
         boxes as among 10,000. The first 16 frames are not part of its time: sweep-and-prune builds its tree in these, \
         and among 2 million static boxes in some more, so their longest update is listed too. Memory is the most in use \
         from the insertion of all boxes to the third update. Two static boxes never form a pair. The pairs of each library are checked in the first \
         frames, except for Jolt: its C interface neither updates the broad phase alone nor tells its pairs, so whole \
         steps are timed, of bodies that collide with nothing.\n",
    );
    for (scene, dimensions) in scenes(&record.statics) {
        let of = |case: &&Case| case.scene == scene && case.dimensions == dimensions;
        let cases: Vec<_> = sorted(&record.statics).into_iter().filter(of).collect();
        text += &table(
            &format!(
                "Time of an update, {dimensions}D; in parentheses the ratio to sweep-and-prune"
            ),
            &cases,
            |times, _| {
                let ratio = times.ratio.map(|ratio| format!(" ({})", significant(ratio)));
                format!("{}{}", time(times.median_ns), ratio.unwrap_or_default())
            },
        );
        text += &table(
            &format!("Time to insert all boxes and find the first pairs, {dimensions}D"),
            &cases,
            |times, _| times.start_ns.map_or("-".into(), time),
        );
        text += &table(
            &format!("The longest of the first 15 updates after that, {dimensions}D"),
            &cases,
            |times, _| times.longest_ns.map_or("-".into(), time),
        );
        text += &table(
            &format!("Memory in bytes for each static box, {dimensions}D"),
            &cases,
            |times, boxes| {
                let each = |peak| significant(peak as f64 / boxes as f64);
                times.peak_bytes.map_or("-".into(), each)
            },
        );
    }
    text
}

/// One row for each library, one column for each number of static boxes.
fn table(heading: &str, cases: &[&Case], cell: impl Fn(&Times, usize) -> String) -> String {
    let mut text = format!("\n### {heading}\n\n| static boxes |");
    for case in cases {
        let _ = write!(text, " {} |", count(case.boxes as u64));
    }
    let _ = write!(text, "\n|---|{}\n| *pairs* |", "--:|".repeat(cases.len()));
    for case in cases {
        let _ = write!(text, " {} |", count(case.pairs));
    }
    text += "\n";
    for name in names(cases) {
        let _ = write!(text, "| {name} |");
        for case in cases {
            let entry = case.results.iter().find(|entry| entry.name == name);
            let cell = entry.map_or("-".into(), |entry| match &entry.outcome {
                Outcome::Timed(times) => cell(times, case.boxes),
                Outcome::Untimed { why } => why.clone(),
            });
            let _ = write!(text, " {cell} |");
        }
        text += "\n";
    }
    text
}
