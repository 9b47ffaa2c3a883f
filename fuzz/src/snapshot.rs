//! Forged snapshots with a valid checksum: they are refused, or give a world that works.

use sweep_and_prune::{BroadPhase, Error, Options, Report, Scalar};

use super::broad_phase::Sequence;
use super::{Input, Model, Space, in_any_dimension, missing};

/// The most bodies of a world.
const MOST: usize = 20;

pub(super) fn target(input: &mut Input) -> u64 {
    in_any_dimension!(input, forge)
}

/// The checksum of a snapshot, as the format defines it.
fn hash(bytes: &[u8]) -> u64 {
    const FIRST: u64 = 0x9e37_79b1_85eb_ca87;
    const SECOND: u64 = 0xc2b2_ae3d_27d4_eb4f;
    let mut hash = FIRST ^ bytes.len() as u64;
    for chunk in bytes.chunks(8) {
        let mut word = [0; 8];
        word[..chunk.len()].copy_from_slice(chunk);
        let mixed = u64::from_le_bytes(word).wrapping_mul(SECOND).rotate_left(31);
        hash = (hash ^ mixed.wrapping_mul(FIRST)).rotate_left(27).wrapping_mul(FIRST);
        hash = hash.wrapping_add(0x85eb_ca77_c2b2_ae63);
    }
    hash = (hash ^ (hash >> 33)).wrapping_mul(SECOND);
    hash = (hash ^ (hash >> 29)).wrapping_mul(FIRST);
    hash ^ (hash >> 32)
}

fn forge<const D: usize, T: Scalar>(input: &mut Input) -> u64 {
    let space = Space::draw::<D, T>(input, MOST);
    let report = match input.below(2) {
        0 => Report::Exact,
        _ => Report::Fat { margin: space.length(0.5), prediction: T::from_f64(0.5) },
    };
    let options = Options::default().report(report);
    let mut sequence =
        Sequence::new(BroadPhase::<D, T>::with_options(options).unwrap(), space, MOST);
    for _ in 0..input.below(16) {
        if input.next_operation() {
            sequence.operation(input);
        }
    }
    let calls = sequence.calls;
    let mut bytes = sequence.into_world().snapshot();
    bytes.truncate(bytes.len() - size_of::<u64>());
    for _ in 0..=input.below(4) {
        let at = input.below(bytes.len());
        match input.below(6) {
            0 => bytes[at] = input.below(256) as u8,
            1 => bytes[at] ^= 1 << input.below(8),
            2 => bytes[at] = input.pick(&[0, 1, 0x7f, 0x80, 0xff]),
            3 if bytes.len() > 1 => _ = bytes.remove(at),
            4 => bytes.truncate(at.max(1)),
            _ => bytes.insert(at, input.below(256) as u8),
        }
    }
    bytes.extend(hash(&bytes).to_le_bytes());
    input.say(|| format!("from_snapshot {bytes:?}"));
    match BroadPhase::<D, T>::from_snapshot(&bytes) {
        Ok(world) => calls + use_world(world, space, input),
        Err(Error::InvalidSnapshot(_)) => calls + 1,
        Err(error) => panic!("{error}"),
    }
}

/// Updates a world and compares what it reports with brute force; then goes on as if it had never been a snapshot.
fn use_world<const D: usize, T: Scalar>(
    mut world: BroadPhase<D, T>,
    space: Space,
    input: &mut Input,
) -> u64 {
    let bytes = world.snapshot();
    assert_eq!(BroadPhase::<D, T>::from_snapshot(&bytes).unwrap().snapshot(), bytes);
    let mut before: Vec<_> = world.pairs().collect();
    let mut expected =
        (world.options().report == Report::Exact).then(|| Model::of(&world).overlapping_pairs());
    // The model does not know where sweeps end, nor what else is pending: it gets that from the world after two updates.
    for _ in 0..2 {
        let changes = world.update();
        let changes: (Vec<_>, Vec<_>) = (changes.begun().collect(), changes.ended().collect());
        let now: Vec<_> = world.pairs().collect();
        assert_eq!(changes, (missing(&before, &now), missing(&now, &before)), "begun and ended");
        if let Some(expected) = expected.take() {
            assert_eq!(now, expected, "left: the world, right: the model");
        }
        before = now;
    }
    let model = Model::of(&world);
    assert_eq!(model.pairs, model.overlapping_pairs(), "left: the world, right: the model");
    let mut sequence = Sequence::new(world, space, MOST);
    sequence.run(input);
    sequence.calls + 3
}
