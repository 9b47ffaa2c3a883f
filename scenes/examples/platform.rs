//! What must be the same on every platform, as one line for each kernel that this processor has:
//!
//! `kernel  scenes  pairs  events`
//!
//! - `scenes`: the hash of [`golden_report`]: scenes, and their pairs by brute force;
//! - `pairs`: the pairs that the finder gives, in its order, for every scene of 1,500 boxes and between its halves;
//! - `events`: what a `BroadPhase` reports in 30 frames of every motion, with bodies that come and go, and the bytes
//!   of its snapshots (they do not depend on the kernel that the finder is told to use).
//!
//! `scripts/platforms` runs it on each platform that the machine can run, and compares the lines.

use sweep_and_prune::{Aabb, BroadPhase, Error, Kernel, PairFinder, Scalar};
use sweep_and_prune_scenes::{Motion, Scene, golden_report, hash, hash_pairs};

const BOXES: usize = 1500;
const BODIES: usize = 400;

fn main() -> Result<(), Error> {
    let scenes = hash(golden_report().bytes());
    let events = [events::<1, f32>()?, events::<2, f32>()?, events::<3, f64>()?];
    let events = hash_all(events);
    for kernel in Kernel::available() {
        let pairs = [pairs::<1, f32>(kernel)?, pairs::<2, f64>(kernel)?, pairs::<3, f32>(kernel)?];
        let pairs = hash_all(pairs);
        println!("{} {scenes:016x} {pairs:016x} {events:016x}", kernel.name());
    }
    Ok(())
}

/// One hash of several.
fn hash_all<const N: usize>(parts: [Vec<u64>; N]) -> u64 {
    hash(parts.into_iter().flatten().flat_map(u64::to_le_bytes))
}

/// For each scene, the hash of its pairs and the hash of the pairs between its halves.
fn pairs<const D: usize, T: Scalar>(kernel: Kernel) -> Result<Vec<u64>, Error> {
    let mut finder = PairFinder::<D, T>::new().kernel(kernel);
    let mut hashes = Vec::new();
    for boxes in Scene::ALL.iter().filter_map(|scene| scene.boxes::<D, T>(BOXES, 2)) {
        hashes.push(hash_pairs(finder.find(&boxes)?));
        let (first, second) = boxes.split_at(BOXES / 2);
        hashes.push(hash_pairs(finder.find_between(first, second)?));
    }
    Ok(hashes)
}

/// For each motion, the hash of all events, and the hash of the snapshot at the end.
fn events<const D: usize, T: Scalar>() -> Result<Vec<u64>, Error> {
    let mut hashes = Vec::new();
    for mut moving in Motion::ALL.into_iter().filter_map(|motion| motion.start::<D, T>(BODIES, 3)) {
        let mut world = BroadPhase::<D, T>::new();
        let mut ids = Vec::new();
        for &aabb in moving.boxes() {
            ids.push(world.insert(aabb)?);
        }
        let mut events = Vec::new();
        for frame in 0..30 {
            moving.advance();
            world.set_many(&ids, moving.boxes())?;
            // One body leaves each frame, and another one takes its slot.
            let place: Aabb<D, T> = moving.boxes()[frame];
            world.remove(ids[frame])?;
            ids[frame] = world.insert(place)?;
            let changes = world.update();
            for pair in changes.begun().chain(changes.ended()) {
                events.extend(pair.map(|id| id.to_bits()));
            }
            events.push(frame as u64);
        }
        hashes.push(hash(events.into_iter().flat_map(u64::to_le_bytes)));
        hashes.push(hash(world.snapshot()));
    }
    Ok(hashes)
}
