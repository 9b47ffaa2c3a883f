//! The tables about sweep-and-prune alone: threads, small inputs, how flat it is, memory, and how
//! close it comes to what the machine can do.

use std::collections::BTreeSet;
use std::fmt::Write;

use super::cases::{SMALL, find, names, scenes, sorted};
use super::format::{count, significant, time};

use crate::libraries::{ON_TWO_THREADS, THIS_CRATE, TWO_AT_ONCE};
use crate::record::{Case, Record, Roofline};

/// The least number of boxes for which threads and the speed of memory are reported.
const MANY: usize = 100_000;

/// All of them.
pub fn section(record: &Record) -> String {
    let mut text = threads(record);
    text += &small(record);
    text += &flat(record);
    text += &memory(record);
    text += &least_traffic(record);
    text += &record.roofline.as_ref().map_or(String::new(), roofline);
    text
}

/// A table under a heading; nothing if it has no rows.
fn table(heading: &str, text: &str, columns: &str, rows: &str) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let rule = columns.matches('|').count() - 2;
    format!("\n### {heading}\n\n{text}\n\n{columns}\n|---|{}\n{rows}", "--:|".repeat(rule))
}

fn threads(record: &Record) -> String {
    let mut rows = String::new();
    for case in sorted(&record.cases).into_iter().filter(|case| case.boxes >= MANY) {
        let (Some(one), Some(two)) = (case.times(THIS_CRATE), case.times(ON_TWO_THREADS)) else {
            continue;
        };
        let Some(share) = two.ratio else { continue };
        let _ = writeln!(
            rows,
            "| {} {}D | {} | {} | {} | {} | {} |",
            case.scene,
            case.dimensions,
            count(case.boxes as u64),
            time(one.median_ns),
            time(two.median_ns),
            significant(1.0 / share),
            case.times(TWO_AT_ONCE)
                .and_then(|both| both.ratio)
                .map_or("-".into(), |ratio| significant(2.0 / ratio)),
        );
    }
    table(
        "Two threads",
        "Goal: at least 1.7 times as fast as one thread. The last column is what two independent finders \
         gain, each on a thread of its own: the most that this machine offers.",
        "| scene | boxes | one thread | two threads | gain | gain of two independent finders |",
        &rows,
    )
}

fn small(record: &Record) -> String {
    let mut rows = String::new();
    for boxes in sizes(&record.cases).into_iter().filter(|&boxes| boxes <= SMALL) {
        let cases = record.cases.iter().filter(|case| case.boxes == boxes);
        let mut slowdowns: Vec<_> = cases
            .filter_map(|case| {
                let slowdown = 1.0 / case.times("brute force")?.ratio?;
                Some((slowdown, case.times(THIS_CRATE)?.median_ns, case))
            })
            .collect();
        slowdowns.sort_by(|(a, ..), (b, ..)| a.total_cmp(b));
        let Some((worst, _, case)) = slowdowns.last() else { continue };
        let (middle, ns, _) = slowdowns[slowdowns.len() / 2];
        let _ = writeln!(
            rows,
            "| {boxes} | {} | {} | {} | {} {}D |",
            time(ns),
            significant(middle),
            significant(*worst),
            case.scene,
            case.dimensions,
        );
    }
    table(
        "Small inputs: sweep-and-prune over brute force",
        "Goal: at most 1.33 times as slow on any scene.",
        "| boxes | time, median scene | ratio, median scene | ratio, worst scene | which |",
        &rows,
    )
}

fn flat(record: &Record) -> String {
    let sizes = sizes(&record.cases).into_iter().filter(|&boxes| boxes > SMALL);
    let sizes: Vec<_> = sizes.collect();
    let mut columns = String::from("| scene |");
    for boxes in &sizes {
        let _ = write!(columns, " {} |", count(*boxes as u64));
    }
    columns += " over uniform at 100,000 | 1,000,000 over 10,000 |";
    let mut rows = String::new();
    for (scene, dimensions) in scenes(&record.cases) {
        let at = |boxes| find(record, &scene, dimensions, boxes).and_then(each);
        if sizes.iter().all(|&boxes| at(boxes).is_none()) {
            continue;
        }
        let _ = write!(rows, "| {scene} {dimensions}D |");
        for &boxes in &sizes {
            let _ = write!(rows, " {} |", at(boxes).map_or("-".into(), |ns| format!("{ns:.1}")));
        }
        let uniform = find(record, "uniform", dimensions, 100_000).and_then(each);
        let over = at(100_000).zip(uniform).map(|(ns, uniform)| ns / uniform);
        let growth = at(1_000_000).zip(at(10_000)).map(|(large, small)| large / small);
        let [over, growth] = [over, growth].map(|it| it.map_or("-".into(), significant));
        let _ = writeln!(rows, " {over} | {growth} |");
    }
    table(
        "Scaling: nanoseconds for each box and each pair",
        "Goals: at 100,000 boxes at most 4 times those of uniform on any scene; from 10,000 to \
         1,000,000 at most 2 times as many on any scene. A scene with more than about 50 million \
         pairs is left out.",
        &columns,
        &rows,
    )
}

/// Nanoseconds for each box and each pair.
pub fn each(case: &Case) -> Option<f64> {
    Some(case.times(THIS_CRATE)?.median_ns / (case.boxes as f64 + case.pairs as f64))
}

fn memory(record: &Record) -> String {
    let mut rows = String::new();
    let cases = |kind: &[Case], scene: &str, boxes: usize| {
        [2, 3].map(|dimensions| {
            let key = (scene, dimensions, boxes);
            kind.iter().find(|case| case.key() == key).cloned()
        })
    };
    let pairs = cases(&record.cases, "uniform", MANY);
    let worlds = cases(&record.worlds, "drift", MANY);
    let columns = [&pairs[0], &pairs[1], &worlds[0], &worlds[1]];
    let known: Vec<&Case> = columns.iter().copied().flatten().collect();
    for name in names(&known) {
        let cells = columns.map(|case| {
            let peak = case.as_ref().and_then(|case| case.times(&name)?.peak_bytes);
            peak.map_or("-".into(), |peak| significant(peak as f64 / MANY as f64))
        });
        if cells.iter().any(|cell| cell != "-") {
            let _ = writeln!(rows, "| {name} | {} |", cells.join(" | "));
        }
    }
    table(
        "Memory",
        "The most in use during the first call, or in a world's first frames, beyond the boxes, in \
         bytes for each of 100,000 boxes: of uniform for the pairs, of drift for the worlds. Pairs \
         are 8 bytes each in all that find pairs, 1.2 a box here.",
        "| library | pairs 2D | pairs 3D | world 2D | world 3D |",
        &rows,
    )
}

fn least_traffic(record: &Record) -> String {
    let mut rows = String::new();
    for case in sorted(&record.cases).into_iter().filter(|case| case.boxes >= MANY) {
        let Some(own) = case.times(THIS_CRATE) else { continue };
        let bytes = least_bytes(case);
        let least_ns = bytes / record.machine.copy_bytes_per_second * 1e9;
        let peak = own.peak_bytes.map(|peak| peak as f64 / case.boxes as f64);
        let _ = writeln!(
            rows,
            "| {} {}D | {} | {:.1} MB | {} | {} | {:.0} % | {} |",
            case.scene,
            case.dimensions,
            count(case.boxes as u64),
            bytes / 1e6,
            time(least_ns),
            time(own.median_ns),
            100.0 * least_ns / own.median_ns,
            peak.map_or("-".into(), |peak| format!("{peak:.0}")),
        );
    }
    table(
        "Close to the machine: the least traffic",
        "What no method can avoid: to read every box once and to write every pair once, at the \
         rate at which one thread copies. The last column is the most memory in use beyond the \
         boxes, in bytes a box.",
        "| scene | boxes | least traffic | its time | sweep-and-prune | share | memory |",
        &rows,
    )
}

/// The bytes of a search that reads every box once and writes every pair once.
fn least_bytes(case: &Case) -> f64 {
    (case.boxes * 2 * case.dimensions * size_of::<f32>()) as f64
        + case.pairs as f64 * size_of::<[u32; 2]>() as f64
}

fn roofline(roofline: &Roofline) -> String {
    let mut rows = String::new();
    for stage in &roofline.stages {
        let _ = writeln!(
            rows,
            "| {} {}D | {} | {} | {} | {:.1} MB | {} | {} | {:.0} % |",
            stage.scene,
            stage.dimensions,
            count(stage.boxes as u64),
            stage.stage,
            time(stage.ns),
            stage.bytes / 1e6,
            count(stage.tests as u64),
            time(stage.limit_ns),
            100.0 * stage.share,
        );
    }
    let peaks: Vec<_> = roofline
        .kernel_tests_per_second
        .iter()
        .map(|(dimensions, rate)| {
            format!("{:.2} billion boxes a second in {dimensions}D", rate / 1e9)
        })
        .collect();
    table(
        "Close to the machine: stage by stage",
        &format!(
            "The kernel tests at most {}, when all that it needs is in the nearest cache. The limit of \
             a stage is the longer of two times: that of the bytes that it has to read and write, at the rate at which one thread copies as many \
             ({:.1} GB/s if they are far more than the caches hold), and that of its tests. It has \
             to read each box and write it to one column, to read it there, to test each pair \
             once, and to write the pairs. The rest of the time goes to further copies, the \
             sort and the ordered columns, which stay in the caches, candidates that are not pairs, \
             and waiting. Where the \
             output is said to reach 100 %, the writes are hidden behind the sweep.",
            peaks.join(" and "),
            roofline.copy_bytes_per_second / 1e9,
        ),
        "| scene | boxes | stage | time | bytes | tests | limit | share |",
        &rows,
    )
}

fn sizes(cases: &[Case]) -> BTreeSet<usize> {
    cases.iter().map(|case| case.boxes).collect()
}
