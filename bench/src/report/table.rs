//! The tables, in Markdown.

use std::collections::BTreeSet;
use std::fmt::Write;

use super::cases::{SMALL, advantage, find, is_open, names, scenes, sorted};
use super::format::{count, rounded, significant, time};
use super::{intervals, single, statics, worlds};
use crate::libraries::THIS_CRATE;
use crate::record::{Case, Entry, Outcome, Record, Times};

/// What stands above the results of all machines.
pub const INTRODUCTION: &str = "\
# Results

Made by `bench/report` from the files in `bench/results`; `bench/run` measures again.

Lower times are better. The time to find all pairs starts with raw boxes and ends with pairs stored in memory. It is \
the time of one thread unless the name says otherwise. A library is timed only if its pairs are exactly right, \
of four scenes of a kind or four frames. Each \
round runs every library once. A time is the median over the rounds. A ratio is the median over the rounds of a \
library's time divided by the time of sweep-and-prune in the same round, so that whatever slows the machine in a \
round slows both: a ratio of 2 means twice as slow as sweep-and-prune. Time that a library spends waiting for a \
processor that other programs use is not counted.
";

/// The goals of the geometric mean of (fastest alternative / sweep-and-prune), by number of boxes.
pub const GOALS: [(usize, f64); 3] = [(10_000, 2.0), (100_000, 3.0), (1_000_000, 5.0)];

/// Terdiman's scene: boxes, units of 1,024 cycles that the published best takes, and that sweep-and-prune
/// may take at most.
const CLASSIC: [(usize, f64, f64); 2] =
    [(10_000, 2_413.0, 1_000.0), (100_000, 182_715.0, 50_000.0)];

/// The results of one machine.
pub fn section(record: &Record, plots: &[String]) -> String {
    let mut text = heading(record);
    text += &classic(record);
    text += &fastest(record);
    text += &means(record);
    text += &single::section(record);
    text += "\n### Plots\n\n";
    for plot in plots {
        let name = plot.rsplit('/').next().unwrap_or(plot).trim_end_matches(".svg");
        text += &format!("![{name}]({plot})\n");
    }
    text += &everything(record);
    text += &worlds::section(record);
    text += &statics::section(record);
    text += &intervals::section(record);
    text += &libraries(record);
    text
}

fn heading(record: &Record) -> String {
    let machine = &record.machine;
    let mut text = format!("\n## {}, {}\n\n", machine.cpu, record.date);
    text += &format!("{} cores", machine.cores);
    if let Some(bytes) = machine.memory_bytes {
        text += &format!(", {:.0} GiB", bytes as f64 / (1u64 << 30) as f64);
    }
    if !machine.vectors.is_empty() {
        text += &format!(", {}", machine.vectors.join(" "));
    }
    text += &format!(", {}, {}.", machine.system, record.rustc);
    if let Some(mhz) = machine.tsc_mhz {
        text += &format!(" Time stamp counter {mhz:.0} MHz.");
    }
    text += &format!(
        " One thread copies {:.1} GB/s (read plus written).",
        machine.copy_bytes_per_second / 1e9
    );
    if let Some(load) = machine.load.filter(|&load| load > 0.5) {
        text += &format!(
            " The load was {load} when the run began: other programs were running, so the ratios are \
             more reliable than the times."
        );
    }
    let kinds = [&record.cases, &record.worlds, &record.statics, &record.intervals];
    let revisions: BTreeSet<_> =
        kinds.into_iter().flatten().filter_map(|case| case.revision.as_deref()).collect();
    if !revisions.is_empty() {
        let revisions: Vec<_> = revisions.into_iter().collect();
        text += &format!(" Measured at {}.", revisions.join(", "));
    }
    text + "\n"
}

fn classic(record: &Record) -> String {
    let Some(mhz) = record.machine.tsc_mhz else { return String::new() };
    let mut rows = String::new();
    for (boxes, published, goal) in CLASSIC {
        let Some(case) = find(record, "box-pruning", 3, boxes) else { continue };
        let Some(own) = case.times(THIS_CRATE) else { continue };
        let cycles = |times: &Times| times.median_ns * mhz / 1e3 / 1024.0;
        let alternative = case
            .ranking()
            .first()
            .map_or("-".into(), |(name, times)| format!("{} ({name})", rounded(cycles(times))));
        let _ = writeln!(
            rows,
            "| {} | {} | {} | {} | {alternative} | {} |",
            count(boxes as u64),
            count(case.pairs),
            rounded(cycles(own)),
            rounded(goal),
            rounded(published),
        );
    }
    if rows.is_empty() {
        return rows;
    }
    format!(
        "\n### The classic scene\n\n\
         Pierre Terdiman's scene, in his units of 1,024 cycles of the time stamp counter. The \
         published best (his BoxPruning v17, AVX assembly, one thread; at 100,000 with buckets) \
         counts the pairs without storing them, on another machine.\n\n\
         | boxes | pairs | sweep-and-prune | at most | fastest alternative here | published best |\n\
         |--:|--:|--:|--:|--:|--:|\n{rows}"
    )
}

fn fastest(record: &Record) -> String {
    let mut text = String::from("\n### Against the fastest alternative\n\n");
    text += &ranking(record, is_open);
    let others = |case: &Case| !is_open(case);
    if record.cases.iter().any(others) {
        text += "\n### The other scenes: against a few alternatives\n\n\
                 Scenes on which sweep-and-prune might be slow, against packed_spatial_index and, up to 100,000 boxes, parry and the plain sweep. A scene with more than about 50 million pairs is left out.\n\n";
        text += &ranking(record, others);
    }
    text
}

fn ranking(record: &Record, wanted: impl Fn(&Case) -> bool) -> String {
    let mut text = String::from(
        "| scene | boxes | pairs | sweep-and-prune | fastest alternative | ratio | next | ratio |\n\
         |---|--:|--:|--:|---|--:|---|--:|\n",
    );
    let cases = sorted(&record.cases).into_iter();
    for case in cases.filter(|case| case.boxes > SMALL && wanted(case)) {
        let Some(own) = case.times(THIS_CRATE) else { continue };
        let ranking = case.ranking();
        let alternative = |at: usize| match ranking.get(at) {
            Some((name, times)) => format!(
                "{name} {} | {}",
                time(times.median_ns),
                times.ratio.map_or("-".into(), significant)
            ),
            None => "- | -".into(),
        };
        let _ = writeln!(
            text,
            "| {} {}D | {} | {} | {} | {} | {} |",
            case.scene,
            case.dimensions,
            count(case.boxes as u64),
            count(case.pairs),
            time(own.median_ns),
            alternative(0),
            alternative(1),
        );
    }
    text
}

fn means(record: &Record) -> String {
    let mut text = String::new();
    let open = || record.cases.iter().filter(|case| case.boxes > SMALL && is_open(case));
    for boxes in open().map(|case| case.boxes).collect::<BTreeSet<_>>() {
        let cases = open().filter(|case| case.boxes == boxes);
        let ratios: Vec<_> = cases.filter_map(advantage).collect();
        if ratios.is_empty() {
            continue;
        }
        let mean = (ratios.iter().map(|ratio| ratio.ln()).sum::<f64>() / ratios.len() as f64).exp();
        let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
        let goal = GOALS.iter().find(|(goal, _)| *goal == boxes);
        let goal = goal.map_or("-".into(), |(_, goal)| format!("{goal:.0}"));
        let _ = writeln!(
            text,
            "| {} | {} | {} | {goal} | {} |",
            count(boxes as u64),
            ratios.len(),
            significant(mean),
            significant(least)
        );
    }
    format!(
        "\n### How many times slower the fastest alternative of each scene is\n\n\
         | boxes | scenes | geometric mean | goal | least |\n|--:|--:|--:|--:|--:|\n{text}"
    )
}

fn everything(record: &Record) -> String {
    let mut text = String::from(
        "\n### Every library\n\nMedian time, and in parentheses the ratio to sweep-and-prune.\n",
    );
    for (scene, dimensions) in scenes(&record.cases) {
        let cases: Vec<_> = sorted(&record.cases)
            .into_iter()
            .filter(|case| case.scene == scene && case.dimensions == dimensions)
            .filter(|case| case.boxes > SMALL && is_open(case))
            .collect();
        if cases.is_empty() {
            continue;
        }
        let _ = write!(text, "\n#### {scene} {dimensions}D\n\n| boxes |");
        for case in &cases {
            let _ = write!(text, " {} |", count(case.boxes as u64));
        }
        let _ = write!(text, "\n|---|{}\n| *pairs* |", "--:|".repeat(cases.len()));
        for case in &cases {
            let _ = write!(text, " {} |", count(case.pairs));
        }
        text += "\n";
        for name in names(&cases) {
            let _ = write!(text, "| {name} |");
            for case in &cases {
                let entry = case.results.iter().find(|entry| entry.name == name);
                let _ = write!(text, " {} |", entry.map_or("-".into(), cell));
            }
            text += "\n";
        }
        let _ = write!(text, "| *checked against* |");
        for case in &cases {
            let _ = write!(text, " {} |", case.reference);
        }
        text += "\n";
    }
    text
}

fn cell(entry: &Entry) -> String {
    match &entry.outcome {
        Outcome::Timed(times) => {
            let ratio =
                times.ratio.map_or(String::new(), |times| format!(" ({})", significant(times)));
            format!("{}{ratio}", time(times.median_ns))
        }
        Outcome::Untimed { why } => why.clone(),
    }
}

fn libraries(record: &Record) -> String {
    let mut text = String::from(
        "\n### The libraries\n\n| name | version | how it is called |\n|---|---|---|\n",
    );
    for (name, how) in &record.how {
        let version = record.versions.get(name).map_or("unknown", String::as_str);
        let _ = writeln!(text, "| {name} | {version} | {how} |");
    }
    text
}
