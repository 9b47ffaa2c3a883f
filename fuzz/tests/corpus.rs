//! The kept inputs pass, and so do as many random ones as take some seconds.

use std::fs;
use std::path::Path;

use sweep_and_prune_fuzz::{TARGETS, Target, random_input, run};

fn target(name: &str) -> &'static Target {
    TARGETS.iter().find(|target| target.name == name).unwrap()
}

#[test]
fn every_kept_input_passes() {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus");
    let mut inputs = 0;
    for target in &TARGETS {
        for file in fs::read_dir(corpus.join(target.name)).unwrap() {
            let path = file.unwrap().path();
            if let Err(failure) = run(target, &fs::read(&path).unwrap(), false) {
                panic!("{}:\n{}", path.display(), failure.message);
            }
            inputs += 1;
        }
    }
    assert!(inputs > 20, "the corpus has only {inputs} inputs");
}

/// Runs random inputs until they have made this many calls.
fn check(name: &str, calls: u64) {
    let (target, seed) = (target(name), 0);
    let calls = if cfg!(debug_assertions) { calls / 50 } else { calls };
    let (mut made, mut number) = (0, 0);
    while made < calls {
        match run(target, &random_input(target, seed, number), false) {
            Ok(more) => made += more,
            Err(failure) => panic!("{name}, seed {seed}, input {number}:\n{}", failure.message),
        }
        number += 1;
    }
}

#[test]
fn random_sequences_of_the_broad_phase_pass() {
    check("broad_phase", 2_000_000);
}

#[test]
fn random_searches_pass() {
    check("finder", 20_000);
}

#[test]
fn forged_snapshots_are_refused_or_give_a_world_that_works() {
    check("snapshot", 1_000_000);
}

/// Panics at the third operation whose first byte is 7.
fn broken(input: &mut sweep_and_prune_fuzz::Input) -> u64 {
    let mut sevens = 0;
    while input.next_operation() {
        let kind = input.below(10);
        let size = input.below(100);
        sevens += u64::from(kind == 7 && size > 4);
        assert!(sevens < 3, "the third seven");
    }
    sevens
}

#[test]
fn an_input_that_fails_is_shortened_to_the_operations_that_matter() {
    let broken = Target { name: "broken", lengths: [1000, 1000], run: broken };
    let failing = (0..).map(|number| random_input(&broken, 1, number));
    let bytes = failing.into_iter().find(|bytes| run(&broken, bytes, false).is_err()).unwrap();
    assert!(bytes.len() > 100);
    let shorter = sweep_and_prune_fuzz::shorten(&broken, &bytes);
    assert_eq!(shorter, [7, 5, 7, 5, 7, 5]);
    assert!(run(&broken, &shorter, false).unwrap_err().message.contains("the third seven"));
}
