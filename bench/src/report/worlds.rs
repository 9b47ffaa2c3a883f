//! The tables of the worlds.

use std::fmt::Write;

use super::cases::{names, scenes, sorted};
use super::format::{count, significant, time};
use crate::libraries::THIS_CRATE;
use crate::record::{Case, Outcome, Record};
use crate::worlds::FROM_SCRATCH;

/// By motion: the goals of `BroadPhase` over finding all pairs from scratch, at most, and of the fastest
/// alternative over `BroadPhase`, at least.
const GOALS: [(&str, f64, f64); 4] =
    [("mostly-still", 0.2, 3.0), ("drift", 0.5, 2.0), ("fast", 1.3, 2.0), ("teleport", 1.3, 2.0)];

/// All of them.
pub fn section(record: &Record) -> String {
    if record.worlds.is_empty() {
        return String::new();
    }
    let mut text = String::from(
        "\n## Worlds\n\n\
         A world keeps its boxes from frame to frame: in each frame it receives the boxes that \
         moved, and reports which pairs began and which ended. The time is the mean over many \
         frames, so that work done in one frame for the sake of later ones counts. The pairs of \
         every fifth of the first frames are checked, and every event in between.\n\n\
         Most alternatives report the pairs of larger or rounded boxes. Their time ends with that \
         report. The time behind the plus sign is what it takes to test which of those pairs \
         overlap; the time of sweep-and-prune includes this test.\n",
    );
    text += &against(record);
    text += &flat(record);
    text += &everything(record);
    text
}

fn against(record: &Record) -> String {
    let mut text = String::from(
        "\n### Against finding all pairs from scratch, and against the fastest alternative\n\n\
         Goals: the time over that of finding all pairs from scratch is at most 0.2 mostly still, 0.5 in \
         drift and 1.3 otherwise; the fastest alternative takes at least 3 times as long mostly still \
         and 2 times as long otherwise.\n\n\
         | motion | boxes | pairs | sweep-and-prune | over scratch | goal | fastest alternative | ratio | goal | \
         next | ratio |\n|---|--:|--:|--:|--:|--:|---|--:|--:|---|--:|\n",
    );
    for case in sorted(&record.worlds) {
        let Some(own) = case.times(THIS_CRATE) else { continue };
        let scratch = case.times(FROM_SCRATCH).and_then(|times| times.ratio);
        let goal = GOALS.iter().find(|(motion, ..)| *motion == case.scene);
        let ranking = case.ranking();
        let alternative = |at: usize| {
            let (name, times) = ranking.get(at)?;
            let ratio = times.ratio.map_or("-".into(), significant);
            Some((format!("{name} {}", time(times.median_ns)), ratio))
        };
        let [first, next] = [0, 1].map(|at| alternative(at).unwrap_or(("-".into(), "-".into())));
        let _ = writeln!(
            text,
            "| {} {}D | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |",
            case.scene,
            case.dimensions,
            count(case.boxes as u64),
            count(case.pairs),
            time(own.median_ns),
            scratch.map_or("-".into(), |ratio| significant(1.0 / ratio)),
            goal.map_or("-".into(), |(_, goal, _)| goal.to_string()),
            first.0,
            first.1,
            goal.map_or("-".into(), |(_, _, goal)| goal.to_string()),
            next.0,
            next.1,
        );
    }
    text
}

fn flat(record: &Record) -> String {
    let mut text = String::from(
        "\n### Scaling: nanoseconds for each box and frame\n\n\
         Goal: at most 2 times as many with 1,000,000 boxes as with 1,000.\n\n\
         | motion | 1,000 | 10,000 | 100,000 | 1,000,000 | most over least |\n\
         |---|--:|--:|--:|--:|--:|\n",
    );
    for (scene, dimensions) in scenes(&record.worlds) {
        let each = [1_000, 10_000, 100_000, 1_000_000].map(|boxes| {
            let key = (scene.as_str(), dimensions, boxes);
            let case = record.worlds.iter().find(|case| case.key() == key)?;
            Some(case.times(THIS_CRATE)?.median_ns / boxes as f64)
        });
        let known = || each.iter().flatten();
        let (least, most) =
            (known().copied().fold(f64::INFINITY, f64::min), known().copied().fold(0.0, f64::max));
        let _ = write!(text, "| {scene} {dimensions}D |");
        for ns in each {
            let _ = write!(text, " {} |", ns.map_or("-".into(), |ns| format!("{ns:.1}")));
        }
        let growth = if known().count() > 1 { significant(most / least) } else { "-".into() };
        let _ = writeln!(text, " {growth} |");
    }
    text
}

fn everything(record: &Record) -> String {
    let mut text = String::from(
        "\n### Every world\n\n\
         Mean time of a frame; in parentheses the ratio to sweep-and-prune; behind the plus sign the \
         time to test which of the reported pairs overlap.\n",
    );
    for (scene, dimensions) in scenes(&record.worlds) {
        let of = |case: &&Case| case.scene == scene && case.dimensions == dimensions;
        let cases: Vec<_> = sorted(&record.worlds).into_iter().filter(of).collect();
        let _ = write!(text, "\n#### {scene} {dimensions}D, tracked\n\n| boxes |");
        for case in &cases {
            let _ = write!(text, " {} |", count(case.boxes as u64));
        }
        let _ = writeln!(text, "\n|---|{}", "--:|".repeat(cases.len()));
        for name in names(&cases) {
            let _ = write!(text, "| {name} |");
            for case in &cases {
                let entry = case.results.iter().find(|entry| entry.name == name);
                let cell = entry.map_or("-".into(), |entry| match &entry.outcome {
                    Outcome::Timed(times) => {
                        let exact = times.exact_ns.map(|ns| format!(" + {}", time(ns)));
                        let ratio = times.ratio.map(|ratio| format!(" ({})", significant(ratio)));
                        let (exact, ratio) = (exact.unwrap_or_default(), ratio.unwrap_or_default());
                        format!("{}{exact}{ratio}", time(times.median_ns))
                    }
                    Outcome::Untimed { why } => why.clone(),
                });
                let _ = write!(text, " {cell} |");
            }
            text += "\n";
        }
        let references: Vec<_> = cases.iter().map(|case| case.reference.as_str()).collect();
        let _ = writeln!(text, "| *checked against* | {} |", references.join(" | "));
    }
    text
}
