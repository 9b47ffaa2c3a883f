//! The boxes that are measured on: a scene of the crate `scenes`, or a file of raw boxes.

use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use sweep_and_prune::Aabb;
use sweep_and_prune_scenes::{Random, Scene};

/// The scenes measured unless others are named.
pub const DEFAULT: [&str; 6] = ["uniform", "clustered", "mixed", "slab", "tower", "box-pruning"];

/// The seed of every scene, so that two runs measure the same boxes.
const SEED: u64 = 1;

/// Whether a scene exists in so many dimensions.
pub fn exists(name: &str, dimensions: usize) -> Result<bool> {
    if is_file(name) {
        return Ok(true);
    }
    let scene = Scene::from_name(name).with_context(|| format!("there is no scene '{name}'"))?;
    Ok(scene.dimensions().contains(&dimensions))
}

/// Whether a scene's name is a path: a file that ends in `.f32` holds rows of 2 × D little-endian
/// f32, the minimum corner and then the maximum corner of a box.
pub fn is_file(name: &str) -> bool {
    name.ends_with(".f32")
}

/// The `n` boxes of a scene, or the first `n` of a file.
pub fn boxes<const D: usize>(name: &str, n: usize) -> Result<Vec<Aabb<D>>> {
    if is_file(name) {
        return read(Path::new(name), n);
    }
    let scene = Scene::from_name(name).with_context(|| format!("there is no scene '{name}'"))?;
    scene.boxes(n, SEED).with_context(|| format!("'{name}' does not exist in {D} dimensions"))
}

fn read<const D: usize>(path: &Path, n: usize) -> Result<Vec<Aabb<D>>> {
    let bytes = std::fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
    let (numbers, rest) = bytes.as_chunks::<4>();
    let numbers: Vec<f32> = numbers.iter().map(|&bytes| f32::from_le_bytes(bytes)).collect();
    ensure!(
        rest.is_empty() && numbers.len().is_multiple_of(2 * D),
        "{} does not hold rows of {} f32",
        path.display(),
        2 * D
    );
    let corner = |row: &[f32]| std::array::from_fn(|axis| row[axis]);
    let rows = numbers.chunks_exact(2 * D).take(n);
    let boxes: Vec<_> = rows.map(|row| Aabb::new(corner(&row[..D]), corner(&row[D..]))).collect();
    if boxes.len() < n {
        bail!("{} holds {} boxes, not {n}", path.display(), boxes.len());
    }
    Ok(boxes)
}

/// The same boxes in a random order.
pub fn shuffled<const D: usize>(boxes: &[Aabb<D>]) -> Vec<Aabb<D>> {
    let mut shuffled = boxes.to_vec();
    Random::new(SEED).shuffle(&mut shuffled);
    shuffled
}

/// About how many pairs a scene has, from small versions of it: a scene whose pairs grow with
/// the square of its boxes is worth knowing of before memory is full.
pub fn estimated_pairs<const D: usize>(name: &str, n: usize) -> Result<f64> {
    const SMALL: usize = 500;
    const LARGE: usize = 2000;
    if n <= LARGE {
        return Ok(0.5 * (n as f64).powi(2));
    }
    let pairs = |n| -> Result<f64> {
        let pairs = sweep_and_prune::algorithms::pairwise(&boxes::<D>(name, n)?)?;
        Ok(pairs.len() as f64)
    };
    let (small, large) = (pairs(SMALL)?, pairs(LARGE)?);
    let growth = f64::log2(large.max(1.0) / small.max(1.0)) / f64::log2((LARGE / SMALL) as f64);
    Ok(large * (n as f64 / LARGE as f64).powf(growth.max(1.0)))
}
