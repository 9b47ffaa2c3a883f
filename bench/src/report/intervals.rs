//! The table of intervals.

use std::fmt::Write;

use super::cases::{names, sorted};
use super::format::{count, significant, time};
use crate::libraries::THIS_CRATE;
use crate::record::{Outcome, Record};

/// All of it.
pub fn section(record: &Record) -> String {
    if record.intervals.is_empty() {
        return String::new();
    }
    let cases = sorted(&record.intervals);
    let names: Vec<_> = names(&cases).into_iter().filter(|name| name != THIS_CRATE).collect();
    let mut text = String::from(
        "\n## Intervals\n\n\
         Pairs of closed intervals of integers on a line: of two sets, the second a tenth as large as the first, or within \
         one set. The time starts with the intervals in a library's own form, and includes building its index. \
         sweep-and-prune gets coordinates of 64 bits. In parentheses stands the ratio to sweep-and-prune, the median over \
         the rounds. All libraries are compiled for this processor, as the documentation of coitrees asks. With 9,900,000 \
         intervals, nothing is kept from call to call; that case is as large as the pair 8-7 of the AIList data, which is \
         not used itself.\n\n| case | intervals | pairs | sweep-and-prune |",
    );
    for name in &names {
        let _ = write!(text, " {name} |");
    }
    let _ = writeln!(text, "\n|---|--:|--:|--:|{}", "--:|".repeat(names.len()));
    for case in cases {
        let own = case.times(THIS_CRATE).map_or("-".into(), |own| time(own.median_ns));
        let (intervals, pairs) = (count(case.boxes as u64), count(case.pairs));
        let _ = write!(text, "| {} | {intervals} | {pairs} | {own} |", case.scene);
        for name in &names {
            let entry = case.results.iter().find(|entry| entry.name == *name);
            let cell = entry.map_or("-".into(), |entry| match &entry.outcome {
                Outcome::Timed(times) => {
                    let ratio = times.ratio.map(|ratio| format!(" ({})", significant(ratio)));
                    format!("{}{}", time(times.median_ns), ratio.unwrap_or_default())
                }
                Outcome::Untimed { why } => why.clone(),
            });
            let _ = write!(text, " {cell} |");
        }
        text += "\n";
    }
    text
}
