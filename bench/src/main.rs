//! Finding all pairs, measured against the other libraries that do it.
//!
//! `measure` runs every contender on every scene, checks its pairs before it times it, and keeps
//! the results as JSON; `report` makes the table and the plots from all that were kept.
//!
//! The parts, in the order of the data: `scene` makes the boxes, `peers` find the pairs and
//! `worlds` follow them, `worker` runs one peer in a process of its own, `remote` talks to it,
//! `contest` compares them, `roofline` compares ours with the machine, `measure` says what is compared, `record` is what is kept, `report`
//! what is shown.

use std::path::PathBuf;

use anyhow::Result;
use clap::{Parser, Subcommand};

mod contest;
mod fingerprint;
mod machine;
mod measure;
mod peers;
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
    /// Check and time the contenders, and keep the results.
    Measure(measure::Options),
    /// Make the table and the plots from the results kept.
    Report {
        /// The folder of the results; the table is written beside it, the plots into it.
        #[arg(long, default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/results"))]
        results: PathBuf,
    },
    /// List the contenders that were compiled in.
    Peers,
    /// Run one contender on one scene, told what to do through standard input.
    #[command(hide = true)]
    Worker(worker::Options),
}

fn main() -> Result<()> {
    match Cli::parse().command {
        Command::Measure(options) => measure::run(&options),
        Command::Report { results } => report::write(&results),
        Command::Peers => {
            let finders = peers::all().into_iter().map(|peer| peer.entrant());
            let followers = worlds::all().into_iter().map(|peer| peer.entrant());
            for (kind, entrants) in [("pairs", finders.collect()), ("worlds", followers.collect())]
            {
                let entrants: Vec<peers::Entrant> = entrants;
                println!("{kind}:");
                for it in entrants {
                    println!("  {} ({}): {}", it.name, it.version, it.how);
                }
            }
            Ok(())
        }
        Command::Worker(options) => worker::run(&options),
    }
}
