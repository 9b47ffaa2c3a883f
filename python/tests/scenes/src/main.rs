//! Writes the boxes behind each line of `scenes/golden.txt` to a folder, one file each, named as
//! the line begins: rows of little-endian coordinates. For `python/tests/conftest.py`. A second argument is the
//! number of boxes of each scene; then no motions are written.

use std::env::args_os;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use sweep_and_prune::{Aabb, Scalar};
use sweep_and_prune_scenes::{Motion, Scene};

/// As in the report; where they differ from it, the pairs do too, and the test fails.
const N: usize = 150;
const SEED: u64 = 1;
const FRAMES: usize = 20;

fn main() -> io::Result<()> {
    let folder = PathBuf::from(args_os().nth(1).unwrap_or(".".into()));
    let count = args_os().nth(2).and_then(|count| count.to_str()?.parse().ok());
    dimension::<1>(&folder, count)?;
    dimension::<2>(&folder, count)?;
    dimension::<3>(&folder, count)
}

fn dimension<const D: usize>(folder: &Path, count: Option<usize>) -> io::Result<()> {
    let n = count.unwrap_or(N);
    for &scene in Scene::ALL {
        write(folder, scene.name(), scene.boxes::<D, f32>(n, SEED))?;
        write(folder, scene.name(), scene.boxes::<D, f64>(n, SEED))?;
    }
    if count.is_some() {
        return Ok(());
    }
    for motion in Motion::ALL {
        write(folder, motion.name(), last_frame::<D, f32>(motion))?;
        write(folder, motion.name(), last_frame::<D, f64>(motion))?;
    }
    Ok(())
}

fn last_frame<const D: usize, T: Scalar>(motion: Motion) -> Option<Vec<Aabb<D, T>>> {
    let mut moving = motion.start(N, SEED)?;
    (0..FRAMES).for_each(|_| moving.advance());
    Some(moving.boxes().to_vec())
}

fn write<const D: usize, T: Scalar>(
    folder: &Path,
    name: &str,
    boxes: Option<Vec<Aabb<D, T>>>,
) -> io::Result<()> {
    let Some(boxes) = boxes else { return Ok(()) };
    let coordinates = boxes.iter().flat_map(|aabb| aabb.min.into_iter().chain(aabb.max));
    let bytes = coordinates.flat_map(|at| at.to_raw().to_le_bytes().into_iter().take(T::BYTES));
    let name = format!("{name} {D}d f{}", 8 * T::BYTES);
    fs::write(folder.join(name), bytes.collect::<Vec<u8>>())
}
