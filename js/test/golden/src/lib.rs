//! The scenes' golden report computed in WebAssembly, and the boxes behind each of its lines, for
//! `js/test/golden.test.js`. Never shipped.
// SAFETY of the exports: each has a name that no other symbol has, and takes no pointer.
#![allow(unsafe_code)]

use std::sync::OnceLock;

use sweep_and_prune::{Aabb, Scalar};
use sweep_and_prune_scenes::{Motion, Scene, golden_report};

/// As in the report; where they differ from it, the pairs do too, and the test fails.
const N: usize = 150;
const SEED: u64 = 1;
const FRAMES: usize = 20;

/// A name and bytes that JavaScript reads.
struct Section {
    name: String,
    bytes: Vec<u8>,
}

/// The whole report, and then the boxes of each of its lines: rows of little-endian coordinates.
fn parts() -> &'static [Section] {
    static PARTS: OnceLock<Vec<Section>> = OnceLock::new();
    PARTS.get_or_init(|| {
        let mut parts =
            vec![Section { name: "report".into(), bytes: golden_report().into_bytes() }];
        dimension::<1>(&mut parts);
        dimension::<2>(&mut parts);
        dimension::<3>(&mut parts);
        parts
    })
}

fn dimension<const D: usize>(parts: &mut Vec<Section>) {
    for &scene in Scene::ALL {
        add(parts, scene.name(), scene.boxes::<D, f32>(N, SEED), |at| at.to_le_bytes().to_vec());
        add(parts, scene.name(), scene.boxes::<D, f64>(N, SEED), |at| at.to_le_bytes().to_vec());
    }
    for motion in Motion::ALL {
        add(parts, motion.name(), last_frame::<D, f32>(motion), |at| at.to_le_bytes().to_vec());
        add(parts, motion.name(), last_frame::<D, f64>(motion), |at| at.to_le_bytes().to_vec());
    }
}

fn last_frame<const D: usize, T: Scalar>(motion: Motion) -> Option<Vec<Aabb<D, T>>> {
    let mut moving = motion.start(N, SEED)?;
    (0..FRAMES).for_each(|_| moving.advance());
    Some(moving.boxes().to_vec())
}

fn add<const D: usize, T: Scalar>(
    parts: &mut Vec<Section>,
    name: &str,
    boxes: Option<Vec<Aabb<D, T>>>,
    to_bytes: impl Fn(T) -> Vec<u8>,
) {
    let Some(boxes) = boxes else { return };
    let coordinates = boxes.iter().flat_map(|aabb| aabb.min.into_iter().chain(aabb.max));
    let bytes = coordinates.flat_map(to_bytes).collect();
    parts.push(Section { name: format!("{name} {D}d f{}", 8 * size_of::<T>()), bytes });
}

#[unsafe(no_mangle)]
extern "C" fn count() -> usize {
    parts().len()
}

#[unsafe(no_mangle)]
extern "C" fn name(part: usize) -> *const u8 {
    parts()[part].name.as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn name_length(part: usize) -> usize {
    parts()[part].name.len()
}

#[unsafe(no_mangle)]
extern "C" fn bytes(part: usize) -> *const u8 {
    parts()[part].bytes.as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn bytes_length(part: usize) -> usize {
    parts()[part].bytes.len()
}
