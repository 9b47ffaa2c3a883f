//! Hashes of scenes and of their pairs, which compare platforms and builds.

use core::fmt::Write;

use sweep_and_prune::{Aabb, Scalar};

use crate::brute_force::brute_force;
use crate::motion::Motion;
use crate::scene::Scene;

/// The 64-bit FNV-1a hash (Fowler, Noll and Vo; RFC 9923): for each byte, xor, then multiply by
/// the prime. Good enough to tell results apart, short enough to write again in any language.
pub fn hash(bytes: impl IntoIterator<Item = u8>) -> u64 {
    bytes.into_iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// The [`hash`] of boxes: box by box, the minimum corner and then the maximum corner, each
/// coordinate as a little-endian `f64`. It tells `-0.0` from `0.0`.
pub fn hash_boxes<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>]) -> u64 {
    let coordinates = boxes.iter().flat_map(|aabb| aabb.min.into_iter().chain(aabb.max));
    hash(coordinates.flat_map(|at| at.to_f64().to_le_bytes()))
}

/// The [`hash`] of pairs in the order given: `a`, then `b`, each as a little-endian `u32`.
pub fn hash_pairs(pairs: &[[u32; 2]]) -> u64 {
    hash(pairs.iter().flatten().flat_map(|id| id.to_le_bytes()))
}

/// The number of boxes in each line of the report.
const N: usize = 150;
/// The seed of each line.
const SEED: u64 = 1;
/// How many frames a motion runs. The last one is reported.
const FRAMES: usize = 20;

/// Computes what `golden.txt` holds: for every scene and motion, in every dimension and
/// coordinate type, the hash of its boxes, the number of its pairs by brute force and their
/// hash. The same text on every platform, in every build.
///
/// For a motion, this is the twentieth frame after the first.
pub fn golden_report() -> String {
    let mut report =
        format!("# n = {N}, seed = {SEED}; scene, type, boxes, pairs, hash of pairs\n");
    dimension::<1>(&mut report);
    dimension::<2>(&mut report);
    dimension::<3>(&mut report);
    report
}

fn dimension<const D: usize>(report: &mut String) {
    for &scene in Scene::ALL {
        line(report, scene.name(), scene.boxes::<D, f32>(N, SEED).as_deref());
        line(report, scene.name(), scene.boxes::<D, f64>(N, SEED).as_deref());
    }
    for motion in Motion::ALL {
        line(report, motion.name(), last_frame::<D, f32>(motion).as_deref());
        line(report, motion.name(), last_frame::<D, f64>(motion).as_deref());
    }
}

fn last_frame<const D: usize, T: Scalar>(motion: Motion) -> Option<Vec<Aabb<D, T>>> {
    let mut moving = motion.start(N, SEED)?;
    (0..FRAMES).for_each(|_| moving.advance());
    Some(moving.boxes().to_vec())
}

/// One line of the report, where the scene exists.
fn line<const D: usize, T: Scalar>(report: &mut String, name: &str, boxes: Option<&[Aabb<D, T>]>) {
    let Some(boxes) = boxes else { return };
    let bits = 8 * size_of::<T>();
    let hash = hash_boxes(boxes);
    let found = match brute_force(boxes) {
        Ok(pairs) => format!("{} {:016x}", pairs.len(), hash_pairs(&pairs)),
        Err(error) => error.to_string(),
    };
    // Writing to a String cannot fail.
    let _ = writeln!(report, "{name} {D}d f{bits} {hash:016x} {found}");
}
