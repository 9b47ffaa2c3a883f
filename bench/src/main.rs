//! Finding all pairs, measured against the other libraries that do it.
//!
//! `measure` runs every library on every scene, checks its pairs before it times it, and keeps
//! the results as JSON; `report` makes the table and the plots from all that were kept.
//!
//! The parts, in the order of the data: `scene` makes the boxes, `libraries` find their pairs and `worlds` track
//! them, `intervals` finds and counts pairs on a line, `worker` runs one library in a process of its own, `remote`
//! talks to it by `protocol`, `comparison` compares the libraries, `roofline` compares this one with the machine,
//! `measure` says what is compared, `record` is what is kept, `report` what is shown.

use std::path::PathBuf;

use anyhow::Result;
use clap::{Parser, Subcommand};

mod comparison;
mod fingerprint;
mod intervals;
mod libraries;
mod machine;
mod measure;
mod protocol;
mod record;
mod remote;
mod report;
mod roofline;
mod scene;
mod worker;
mod worlds;

#[derive(Parser)]
#[command(version, about)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Check and time the libraries, and keep the results.
    Measure(measure::Options),
    /// Make the table and the plots from the results kept.
    Report {
        /// The folder of the results; the table is written beside it, the plots into it.
        #[arg(long, default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/results"))]
        results: PathBuf,
        /// The root of the repository, to also write the table and the chart of its READMEs.
        #[arg(long)]
        readmes: Option<PathBuf>,
    },
    /// List the libraries that were compiled in.
    Libraries,
    /// Run one library on one scene, told what to do through standard input.
    #[command(hide = true)]
    Worker(worker::Options),
}

fn main() -> Result<()> {
    match Cli::parse().command {
        Command::Measure(options) => measure::run(&options),
        Command::Report { results, readmes } => report::write(&results, readmes.as_deref()),
        Command::Libraries => {
            let finders = libraries::all().into_iter().map(|library| library.info());
            let trackers = worlds::all().into_iter().map(|library| library.info());
            let levels = worlds::with_statics().into_iter().map(|library| library.info());
            let lines = intervals::all().into_iter().map(|library| library.info());
            let parts: [(_, Vec<libraries::LibraryInfo>); 4] = [
                ("pairs", finders.collect()),
                ("worlds", trackers.collect()),
                ("static boxes", levels.collect()),
                ("intervals", lines.collect()),
            ];
            for (kind, infos) in parts {
                println!("{kind}:");
                for it in infos {
                    println!("  {} ({}): {}", it.name, it.version, it.how);
                }
            }
            Ok(())
        }
        Command::Worker(options) => worker::run(&options),
    }
}
