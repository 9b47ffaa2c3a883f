//! Measures every claim and writes `docs/complexity.md` and `docs/complexity.json`.
//!
//! `cargo run --release -p sweep-and-prune-complexity [folder]`, a few minutes.

use std::path::PathBuf;
use std::process::ExitCode;

use indicatif::{ProgressBar, ProgressStyle};
use sweep_and_prune_complexity::{Limits, Report, measure, variants};

fn main() -> ExitCode {
    let docs = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs");
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| docs.to_string()));
    let variants = variants();
    let claims = variants.iter().map(|variant| variant.claims.len() as u64).sum();
    let style = ProgressStyle::with_template("{bar:30} {pos}/{len} {msg}").expect("a template");
    let progress = ProgressBar::new(claims).with_style(style);
    let mut measured = Vec::new();
    for variant in variants {
        let mut measurements = Vec::new();
        for claim in &variant.claims {
            let (method, world) = (variant.options.method.name(), claim.world.name());
            progress.set_message(format!("{method}: {world}"));
            measurements.push(measure(&variant, claim, Limits::FULL));
            progress.inc(1);
        }
        measured.push((variant, measurements));
    }
    progress.finish_and_clear();
    let report = Report::new(measured);
    for (name, text) in [("complexity.md", report.markdown()), ("complexity.json", report.json())] {
        let path = folder.join(name);
        if let Err(error) =
            std::fs::create_dir_all(&folder).and_then(|()| std::fs::write(&path, text))
        {
            eprintln!("cannot write {}: {error}", path.display());
            return ExitCode::FAILURE;
        }
        println!("wrote {}", path.display());
    }
    ExitCode::SUCCESS
}
