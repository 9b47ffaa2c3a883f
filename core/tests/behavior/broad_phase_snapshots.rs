//! Forged snapshots: bytes with a correct checksum that no world wrote. They are refused, or give a world
//! that works.

use std::collections::BTreeSet;

use sweep_and_prune::{Aabb, BroadPhase, Error, Filter, Options, Report, Scalar, SnapshotFault};
use sweep_and_prune_scenes::Random;

const FORGERIES: usize = if cfg!(debug_assertions) { 3000 } else { 100_000 };

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

/// Bytes with their checksum.
fn signed(mut bytes: Vec<u8>) -> Vec<u8> {
    let sum = hash(&bytes);
    bytes.extend(sum.to_le_bytes());
    bytes
}

fn without_checksum(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.truncate(bytes.len() - 8);
    bytes
}

/// A world that has every kind of slot.
fn busy_world<const D: usize, T: Scalar>(
    report: Report<T>,
    random: &mut Random,
) -> BroadPhase<D, T> {
    let mut world = BroadPhase::with_options(Options::default().report(report)).unwrap();
    let mut draw = || {
        let min: [T; D] = std::array::from_fn(|_| T::from_f64(random.below(6) as f64));
        Aabb::new(min, min.map(|at| at + T::from_f64(random.below(3) as f64)))
    };
    let odd = Filter::default().category(2).mask(3).group(-1);
    let ids: Vec<_> = (0..12)
        .map(|index| {
            let filter = [Filter::default(), Filter::STATIC, odd][index % 3];
            world.insert_with(draw(), filter).unwrap()
        })
        .collect();
    world.update();
    world.remove(ids[0]).unwrap();
    world.update();
    world.set(ids[1], draw()).unwrap();
    world.set_swept(ids[2], draw(), draw()).unwrap();
    world.set_filter(ids[3], odd).unwrap();
    world.remove(ids[4]).unwrap();
    world.set(ids[5], draw()).unwrap();
    world.remove(ids[5]).unwrap();
    world.insert(draw()).unwrap();
    world.insert_with(draw(), Filter::STATIC).unwrap();
    world
}

/// Uses a world in every way, and compares what it reports with brute force.
fn use_world<const D: usize, T: Scalar>(mut world: BroadPhase<D, T>) {
    let bytes = world.snapshot();
    assert_eq!(BroadPhase::<D, T>::from_snapshot(&bytes).unwrap().snapshot(), bytes);
    let is_exact = world.options().report == Report::Exact;
    for update in 0..3 {
        let mut live: BTreeSet<_> = world.pairs().collect();
        let ids: Vec<_> = world.ids().collect();
        let mut expected = BTreeSet::new();
        for (at, &a) in ids.iter().enumerate() {
            for &b in &ids[at + 1..] {
                let boxes = [a, b].map(|id| world.reported_aabb(id).unwrap());
                if boxes[0].overlaps(&boxes[1])
                    && [a, b].iter().all(|&id| world.is_enabled(id).unwrap())
                    && !world.is_excluded(a, b).unwrap()
                    && world.filter(a).unwrap().allows(&world.filter(b).unwrap())
                {
                    expected.insert([a, b]);
                }
            }
            let area = world.aabb(a).unwrap();
            let found = world.queries().overlapping(&area).unwrap();
            assert_eq!(found.contains(&a), world.is_enabled(a).unwrap());
        }
        let changes = world.update();
        assert!(changes.ended().all(|pair| live.remove(&pair)));
        assert!(changes.begun().all(|pair| live.insert(pair)));
        // The first two updates may give bodies other fat AABBs.
        if is_exact || update == 2 {
            assert_eq!(live, expected);
        }
    }
    let ids: Vec<_> = world.ids().collect();
    world.remove_many(&ids).unwrap();
    world.update();
    assert_eq!(world.pairs().count(), 0);
    world.insert(Aabb::new([T::default(); D], [T::default(); D])).unwrap();
}

/// Changes some bytes of the snapshots of many worlds. Returns how many were refused and how many taken.
fn forge<const D: usize, T: Scalar>() -> [usize; 2] {
    let mut counts = [0; 2];
    let mut random = Random::new(7);
    for round in 0..FORGERIES {
        let half = T::from_f64(0.5);
        let fat = Report::Fat { margin: half, prediction: half };
        let report = if round % 2 == 0 { Report::Exact } else { fat };
        let mut bytes = without_checksum(busy_world::<D, T>(report, &mut random).snapshot());
        for _ in 0..=random.below(3) {
            let at = 8 + random.below(bytes.len() - 8);
            match random.below(5) {
                0 => bytes[at] = random.below(256) as u8,
                1 => bytes[at] ^= 1 << random.below(8),
                2 => bytes[at] = [0, 1, 0x7f, 0x80, 0xff][random.below(5)],
                3 => _ = bytes.remove(at),
                _ => bytes.insert(at, random.below(256) as u8),
            }
        }
        match BroadPhase::<D, T>::from_snapshot(&signed(bytes)) {
            Ok(world) => {
                counts[1] += 1;
                use_world(world);
            }
            Err(Error::InvalidSnapshot(_)) => counts[0] += 1,
            Err(error) => panic!("{error}"),
        }
    }
    counts
}

#[test]
fn forged_snapshots_are_refused_or_give_a_world_that_works() {
    for counts in [forge::<1, f32>(), forge::<2, f64>(), forge::<3, f32>()] {
        // Both happen often, so the checks behind the checksum are reached.
        assert!(counts.iter().all(|&count| count > FORGERIES / 20), "{counts:?}");
    }
}

#[test]
fn each_contradiction_in_a_forged_snapshot_is_corrupt() {
    let mut world = BroadPhase::<1>::new();
    world.insert(Aabb::new([0.0], [1.0])).unwrap();
    let good = without_checksum(world.snapshot());
    let corrupt = Err(Error::InvalidSnapshot(SnapshotFault::Corrupt));
    let read = |bytes| BroadPhase::<1>::from_snapshot(&signed(bytes)).map(|_| ());
    assert_eq!(read(good.clone()), Ok(()));
    // Header of 8 bytes, count, what the slot holds, generation, box.
    let (count, kind, generation, min) = (8, 9, 10, 11);
    let forged = |at: usize, replaced: &[u8]| {
        let mut bytes = good.clone();
        bytes[at..at + replaced.len()].copy_from_slice(replaced);
        read(bytes)
    };
    assert_eq!(forged(7, &[2]), corrupt, "what is reported");
    assert_eq!(forged(generation, &[0]), corrupt, "generation 0");
    assert_eq!(forged(min, &2f32.to_le_bytes()), corrupt, "an inverted box");
    assert_eq!(forged(min, &f32::NAN.to_le_bytes()), corrupt, "a box with a NaN");
    // A living body (1) that also left (2), a new body (4) with a box at the last update (32), nothing at
    // all with a sweep (8), an unknown bit.
    for kinds in [1 | 2 | 4, 1 | 4 | 32, 8, 1 | 4 | 128] {
        assert_eq!(forged(kind, &[kinds]), corrupt, "{kinds}");
    }
    let with_count = |bytes: &[u8]| [&good[..count], bytes, &good[kind..]].concat();
    assert!(read(with_count(&[0xff, 0xff, 0xff, 0xff, 0x0f])).is_err(), "more slots than bytes");
    let overlong = with_count(&[0xff; 10]);
    assert_eq!(read(overlong), corrupt, "a count beyond 64 bits");
    let trailing = [good.clone(), vec![0]].concat();
    assert!(read(trailing).is_err(), "bytes after the last slot");

    let report = Report::Fat { margin: 0.5, prediction: 0.0 };
    let mut world = BroadPhase::<1>::with_options(Options::default().report(report)).unwrap();
    world.insert(Aabb::new([0.0], [1.0])).unwrap();
    let good = without_checksum(world.snapshot());
    // Header, margin, prediction, offset, count, what the slot holds, generation, box, fat AABB.
    let (margin, kind, min) = (8, 21, 31);
    let forged = |at: usize, replaced: &[u8]| {
        let mut bytes = good.clone();
        bytes[at..at + replaced.len()].copy_from_slice(replaced);
        read(bytes)
    };
    assert_eq!(forged(margin, &0.5f32.to_le_bytes()), Ok(()));
    assert_eq!(forged(margin, &(-1f32).to_le_bytes()), corrupt, "a negative margin");
    assert_eq!(forged(margin, &f32::NAN.to_le_bytes()), corrupt, "a margin that is NaN");
    assert_eq!(forged(kind, &[1 | 4 | 128]), corrupt, "a new body with an origin");
    assert_eq!(forged(min, &0.5f32.to_le_bytes()), corrupt, "a fat AABB without its body");
}

#[test]
fn a_slot_without_a_body_holds_no_more_than_it_can() {
    let mut world = BroadPhase::<1>::new();
    world.insert(Aabb::new([0.0], [1.0])).unwrap();
    let good = without_checksum(world.snapshot());
    // Behind the count: what the slot holds, generation 1, and perhaps the box at the last update.
    let read = |kind: u8, has_box: bool| {
        let aabb = if has_box { &good[11..19] } else { &[] };
        let bytes = [&good[..9], &[kind, 1], aabb].concat();
        BroadPhase::<1>::from_snapshot(&signed(bytes)).map(|_| ())
    };
    for (kind, has_box, what) in
        [(0, false, "free"), (2 | 32, true, "left"), (2 | 4, false, "left while new")]
    {
        assert_eq!(read(kind, has_box), Ok(()), "{what}");
    }
    let corrupt = Err(Error::InvalidSnapshot(SnapshotFault::Corrupt));
    // New (4), swept (8), with a filter (16), with a box or a filter at the last update (32, 64).
    for kind in [4, 8, 16, 32, 64] {
        assert_eq!(read(kind, false), corrupt, "a free slot with {kind}");
        assert_eq!(read(kind, true), corrupt, "a free slot with {kind} and a box");
    }
    for (kind, has_box) in [(2, false), (2 | 32 | 8, true), (2 | 32 | 64, true), (2 | 4 | 32, true)]
    {
        assert_eq!(read(kind, has_box), corrupt, "a slot that was left with {kind}");
    }
}

#[test]
fn a_slot_whose_generations_are_used_up_is_not_given_out_again() {
    let mut world = BroadPhase::<1>::new();
    let aabb = Aabb::new([0.0], [1.0]);
    world.insert(aabb).unwrap();
    let good = without_checksum(world.snapshot());
    // Generation 2^32 - 2 instead of 1, as LEB128.
    let bytes = [&good[..10], &[0xfe, 0xff, 0xff, 0xff, 0x0f], &good[11..]].concat();
    let mut world = BroadPhase::<1>::from_snapshot(&signed(bytes)).unwrap();
    let mut replace = || {
        let old = world.ids().next().unwrap();
        world.remove(old).unwrap();
        world.update();
        let id = world.insert(aabb).unwrap();
        (id.slot(), id.generation())
    };
    assert_eq!(replace(), (0, u32::MAX));
    assert_eq!(replace(), (1, 1));
}

#[test]
fn hashes_are_the_same_everywhere_and_see_every_byte() {
    let world = busy_world::<2, f32>(Report::Exact, &mut Random::new(7));
    let bytes = world.snapshot();
    assert_eq!(world.state_hash(), hash(&bytes));
    assert_eq!(signed(without_checksum(bytes.clone())), bytes);
    assert_eq!(hash(b""), 0xc431_3cd5_ef5c_15ac);
    assert_eq!(hash(b"sweep and prune"), 0x0ae1_0d84_643b_0920);
    let zeros = [0; 64];
    for length in 0..zeros.len() {
        assert_ne!(hash(&zeros[..length]), hash(&zeros[..length + 1]));
    }
}

/// Three bodies are enough for a restored world to keep its pairs in another order.
#[test]
fn pairs_of_a_restored_world_are_in_the_same_order() {
    let mut world = BroadPhase::<1>::new();
    let at = |from: f32, to: f32| Aabb::new([from], [to]);
    let ids = world
        .insert_many(&[at(0.0, 9.0), at(20.0, 21.0), at(5.0, 6.0)], Filter::default())
        .unwrap();
    world.update();
    world.set(ids[1], at(3.0, 30.0)).unwrap();
    world.update();
    let restored = BroadPhase::<1>::from_snapshot(&world.snapshot()).unwrap();
    let pairs = [[0, 1], [0, 2], [1, 2]].map(|pair| pair.map(|body: usize| ids[body]));
    assert!(world.pairs().eq(pairs), "{:?}", world.pairs().collect::<Vec<_>>());
    assert!(restored.pairs().eq(pairs));
    for (body, others) in [(0, [1, 2]), (1, [0, 2]), (2, [0, 1])] {
        let others = others.map(|other: usize| ids[other]);
        assert!(world.pairs_of(ids[body]).unwrap().eq(others));
        assert!(restored.pairs_of(ids[body]).unwrap().eq(others));
    }
}
