//! What is shown of the results kept: one Markdown file for all machines, and plots.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use crate::record::Record;

mod cases;
mod format;
mod intervals;
mod plot;
mod readme;
mod single;
mod statics;
mod table;
mod worlds;

pub use format::time;

/// Reads every record in the folder and writes `RESULTS.md` beside it and the plots into it. Of
/// each machine only the newest record is shown. With the root of the repository, also writes what its
/// READMEs show, of the machine on which most was measured.
pub fn write(results: &Path, readmes: Option<&Path>) -> Result<()> {
    let newest = newest(results)?;
    anyhow::ensure!(!newest.is_empty(), "there are no results in {}", results.display());
    let mut text = String::from(table::INTRODUCTION);
    for (path, record) in &newest {
        let stem = path.file_stem().context("a file without a name")?.to_string_lossy();
        let folder = results.join(&*stem);
        std::fs::create_dir_all(&folder)?;
        remove_plots(&folder)?;
        let plots = plot::write(record, &folder)?;
        let links = plots.iter().map(|plot| format!("results/{stem}/{plot}")).collect::<Vec<_>>();
        text += &table::section(record, &links);
    }
    let report = results.parent().unwrap_or(results).join("RESULTS.md");
    std::fs::write(&report, text).with_context(|| format!("writing {}", report.display()))?;
    if let (Some(record), Some(root)) = (fullest(&newest), readmes) {
        readme::write(record, root)?;
    }
    println!("Written: {} and the plots in {}", report.display(), results.display());
    Ok(())
}

/// The record that has most cases, of these the newest. The benchmark page begins with it, too.
fn fullest(records: &[(PathBuf, Record)]) -> Option<&Record> {
    let records = records.iter().map(|(_, record)| record);
    records.max_by_key(|record| (record.cases.len(), &record.date))
}

/// Removes the plots of earlier reports.
fn remove_plots(folder: &Path) -> Result<()> {
    for file in std::fs::read_dir(folder)? {
        let path = file?.path();
        if path.extension().is_some_and(|extension| extension == "svg") {
            std::fs::remove_file(path)?;
        }
    }
    Ok(())
}

/// The newest record of each machine, by file name in order of the machines' names.
fn newest(results: &Path) -> Result<Vec<(PathBuf, Record)>> {
    let mut newest = BTreeMap::<String, (PathBuf, Record)>::new();
    let files = std::fs::read_dir(results).with_context(|| results.display().to_string())?;
    for file in files {
        let path = file?.path();
        if path.extension().is_none_or(|extension| extension != "json") {
            continue;
        }
        let record = Record::read(&path)?;
        let kept = newest.get(&record.machine.cpu);
        if kept.is_none_or(|(_, kept)| kept.date < record.date) {
            newest.insert(record.machine.cpu.clone(), (path, record));
        }
    }
    Ok(newest.into_values().collect())
}
