//! Runs targets with random inputs.
//!
//! ```text
//! fuzz [TARGET...] [--seconds N | --calls N] [--seed N] [--threads N]    random inputs: all targets, 10 seconds each
//! fuzz TARGET --replay FILE                                              one input, and what it does
//! ```
//! The same seed gives the same inputs. Where a target panics, its input is shortened, printed and written to
//! `fuzz/corpus/TARGET/found-SEED-NUMBER`. Where the process is ended instead, its input is left in the folder for
//! temporary files, as `fuzz-TARGET-PROCESS-THREAD`.

use std::fs::File;
use std::io::{Seek, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use sweep_and_prune_fuzz::{TARGETS, Target, random_input, run, shorten};

/// An input that takes longer is reported.
const SLOW: Duration = Duration::from_secs(20);

struct Options {
    targets: Vec<&'static Target>,
    replay: Option<PathBuf>,
    seconds: u64,
    calls: u64,
    seed: u64,
    threads: usize,
}

fn options() -> Result<Options, String> {
    let mut options = Options {
        targets: vec![],
        replay: None,
        seconds: 10,
        calls: u64::MAX,
        seed: 1,
        threads: thread::available_parallelism().map_or(1, usize::from),
    };
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        if let Some(target) = TARGETS.iter().find(|target| target.name == argument) {
            options.targets.push(target);
            continue;
        }
        let value =
            arguments.next().ok_or(format!("'{argument}' is no target and has no value"))?;
        let number = || value.parse().map_err(|_| format!("'{value}' is no number"));
        match argument.as_str() {
            "--seconds" => options.seconds = number()?,
            "--calls" => (options.calls, options.seconds) = (number()?, u64::MAX),
            "--seed" => options.seed = number()?,
            "--threads" => options.threads = number()?.max(1) as usize,
            "--replay" => options.replay = Some(value.into()),
            _ => return Err(format!("'{argument}' is neither a target nor an option")),
        }
    }
    if options.targets.is_empty() {
        options.targets.extend(&TARGETS);
    }
    Ok(options)
}

fn main() -> ExitCode {
    let options = match options() {
        Ok(options) => options,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::from(2);
        }
    };
    for target in &options.targets {
        let is_right = match &options.replay {
            Some(file) => replay(target, &std::fs::read(file).expect("the input can be read")),
            None => fuzz(target, &options),
        };
        if !is_right {
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

/// Runs one input and prints what it does. Returns whether it passed.
fn replay(target: &Target, bytes: &[u8]) -> bool {
    match run(target, bytes, true) {
        Ok(calls) => println!("{}: {calls} calls, as they should be", target.name),
        Err(failure) => {
            println!("{}", failure.message);
            return false;
        }
    }
    true
}

/// What one thread does.
struct Worker {
    /// Its input is kept here while it runs.
    file: PathBuf,
    /// The number of its input, and when it began, in milliseconds.
    input: AtomicU64,
    begun: AtomicU64,
}

/// Replaces what is in a file.
fn keep(file: &mut File, bytes: &[u8]) -> std::io::Result<()> {
    file.rewind()?;
    file.write_all(bytes)?;
    file.set_len(bytes.len() as u64)
}

/// Runs random inputs. Returns whether all passed.
fn fuzz(target: &Target, options: &Options) -> bool {
    let (next, calls) = (AtomicU64::new(0), AtomicU64::new(0));
    let (end, failed) = (AtomicBool::new(false), AtomicBool::new(false));
    let begun = Instant::now();
    let file = |thread| format!("fuzz-{}-{}-{thread}", target.name, std::process::id());
    let worker = |thread| Worker {
        file: std::env::temp_dir().join(file(thread)),
        input: AtomicU64::new(0),
        begun: AtomicU64::new(0),
    };
    let workers: Vec<_> = (0..options.threads).map(worker).collect();
    let busy = AtomicU64::new(options.threads as u64);
    thread::scope(|scope| {
        for worker in &workers {
            scope.spawn(|| {
                // The file stays open: emptying one for each input would take longer than running the input.
                let mut kept = File::create(&worker.file).ok();
                while !end.load(Ordering::Relaxed) {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    worker.input.store(number, Ordering::Relaxed);
                    worker.begun.store(begun.elapsed().as_millis() as u64, Ordering::Relaxed);
                    let bytes = random_input(target, options.seed, number);
                    // If the process ends here, for example by an access to invalid memory, the file has its input.
                    _ = kept.as_mut().map(|file| keep(file, &bytes));
                    match run(target, &bytes, false) {
                        Ok(made) => {
                            let all = calls.fetch_add(made, Ordering::Relaxed) + made;
                            if all >= options.calls {
                                end.store(true, Ordering::Relaxed);
                            }
                        }
                        Err(_) if failed.swap(true, Ordering::Relaxed) => {}
                        Err(failure) => {
                            end.store(true, Ordering::Relaxed);
                            let calls = calls.load(Ordering::Relaxed);
                            println!(
                                "{}, seed {}, input {number}, after {calls} calls:",
                                target.name, options.seed
                            );
                            println!("{}", failure.message);
                            report(target, options.seed, number, &bytes);
                        }
                    }
                }
                _ = std::fs::remove_file(&worker.file);
                busy.fetch_sub(1, Ordering::Relaxed);
            });
        }
        while busy.load(Ordering::Relaxed) > 0 {
            thread::sleep(Duration::from_millis(20));
            let now = begun.elapsed();
            if now.as_secs() >= options.seconds {
                end.store(true, Ordering::Relaxed);
            }
            for worker in &workers {
                let since = worker.begun.load(Ordering::Relaxed);
                if now.as_millis() as u64 > since + SLOW.as_millis() as u64
                    && !failed.load(Ordering::Relaxed)
                {
                    let input = worker.input.load(Ordering::Relaxed);
                    println!("{}, seed {}: input {input} takes long", target.name, options.seed);
                    worker.begun.store(u64::MAX / 2, Ordering::Relaxed);
                }
            }
        }
    });
    println!(
        "{}: {} calls, {} inputs, seed {}, {} s on {} threads",
        target.name,
        calls.load(Ordering::Relaxed),
        next.load(Ordering::Relaxed),
        options.seed,
        begun.elapsed().as_secs(),
        options.threads
    );
    !failed.load(Ordering::Relaxed)
}

/// Shortens an input that fails, prints what it does, and keeps it.
fn report(target: &Target, seed: u64, number: u64, bytes: &[u8]) {
    let shorter = shorten(target, bytes);
    println!("{} bytes, shortened to {}:", bytes.len(), shorter.len());
    replay(target, &shorter);
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("corpus").join(target.name);
    let file = folder.join(format!("found-{seed}-{number}"));
    match std::fs::create_dir_all(&folder).and_then(|()| std::fs::write(&file, &shorter)) {
        Ok(()) => println!("kept as {}", file.display()),
        Err(error) => println!("{}: {error}; its bytes are {shorter:?}", file.display()),
    }
}
