//! The boxes that are measured on: a scene or a motion of the crate `scenes`, or a file of raw
//! boxes.

use std::path::Path;

use anyhow::{Context, Error, Result, bail, ensure};
use sweep_and_prune::Aabb;
use sweep_and_prune_scenes::{Motion, Moving, Random, Scene};

use crate::fingerprint::Fingerprint;

/// The scenes measured unless others are named.
pub const DEFAULT: [&str; 6] = ["uniform", "clustered", "mixed", "slab", "tower", "box-pruning"];

/// The seed of every scene, or of the first of several, so that two runs measure the same boxes.
pub const SEED: u64 = 1;

/// Up to this many boxes, several scenes of a kind are measured. A branch predictor learns the hits of one small scene
/// that is found again and again, even with its boxes in another order.
pub const MOST_VARIED: usize = 10_000;
/// The scenes of a kind have about this many boxes together, within the limits of [`SCENES`].
const VARIED_BOXES: usize = 200_000;
/// The smallest and the largest number of scenes of a kind.
const SCENES: (usize, usize) = (100, 2000);
/// How many further scenes are found before those that are timed.
pub const WARM_UP: usize = 20;

/// How many frames of boxes in motion, or scenes of a kind, are checked.
const FRAMES_CHECKED: usize = 4;

/// The name that stands for every scene at rest.
pub const ALL: &str = "all";

/// Whether a scene exists in these dimensions.
pub fn exists(name: &str, dimensions: usize) -> Result<bool> {
    if is_file(name) || moves(name) {
        return Ok(true);
    }
    let scene = Scene::from_name(name).with_context(|| format!("there is no scene '{name}'"))?;
    Ok(scene.dimensions().contains(&dimensions))
}

/// Whether a name is that of a motion.
pub fn moves(name: &str) -> bool {
    Motion::from_name(name).is_some()
}

/// How many frames of a scene, or scenes of a kind, are checked.
pub fn frames_checked(name: &str, n: usize) -> usize {
    let varied = n <= MOST_VARIED && !is_file(name);
    if varied || moves(name) { FRAMES_CHECKED } else { 1 }
}

/// How many scenes of a kind, or frames of a motion, are timed in a round: each once. `None` above [`MOST_VARIED`]
/// boxes and for a file. `seeds` replaces the default number.
pub fn varied(name: &str, n: usize, seeds: Option<usize>) -> Option<usize> {
    let scenes = (VARIED_BOXES / n.max(1)).clamp(SCENES.0, SCENES.1);
    let scenes = seeds.map_or(scenes, |seeds| seeds.max(FRAMES_CHECKED));
    (n <= MOST_VARIED && !is_file(name)).then_some(scenes)
}

/// The scenes of these names, with [`ALL`] replaced by all names.
pub fn named(names: &[String]) -> Vec<String> {
    let mut named = Vec::new();
    for name in names {
        match name.as_str() {
            ALL => named.extend(Scene::ALL.iter().map(|scene| scene.name().to_owned())),
            _ => named.push(name.clone()),
        }
    }
    named
}

/// Every scene that is not among [`DEFAULT`].
pub fn others() -> Vec<String> {
    let all = Scene::ALL.iter().map(|scene| scene.name());
    all.filter(|name| !DEFAULT.contains(name)).map(str::to_owned).collect()
}

/// Whether a scene's name is a path: a file that ends in `.f32` holds rows of 2 × D little-endian
/// f32, the minimum corner and then the maximum corner of a box.
fn is_file(name: &str) -> bool {
    name.ends_with(".f32")
}

/// The boxes of a scene, which may move.
pub enum Boxes<const D: usize> {
    /// Several scenes of a kind, which differ by their seeds.
    Varied {
        /// Those that are timed, and [`WARM_UP`] more.
        scenes: Vec<Vec<Aabb<D>>>,
        /// The scene that is found next.
        next: usize,
        /// A copy of the scene that is found: made just before, as a program has just written its boxes.
        current: Vec<Aabb<D>>,
    },
    /// Boxes at rest, in two orders.
    AtRest {
        /// As the scene gives them.
        boxes: Vec<Aabb<D>>,
        /// The same in a random order.
        shuffled: Vec<Aabb<D>>,
    },
    /// Boxes that move a little from frame to frame.
    InMotion(Moving<D, f32>),
}

impl<const D: usize> Boxes<D> {
    /// The `n` boxes of a scene, or the first `n` of a file, to be timed.
    pub fn new(name: &str, n: usize, seeds: Option<usize>) -> Result<Self> {
        Self::with(name, n, varied(name, n, seeds).map_or(0, |scenes| scenes + WARM_UP))
    }

    /// The same with this many scenes of a kind where several are drawn.
    fn with(name: &str, n: usize, scenes: usize) -> Result<Self> {
        if let Some(motion) = Motion::from_name(name) {
            let moving = motion.start(n, SEED);
            return Ok(Self::InMotion(moving.context("motion needs 1 to 3 dimensions")?));
        }
        let boxes = if is_file(name) {
            read(Path::new(name), n)?
        } else {
            let scene = Scene::from_name(name);
            let scene = scene.with_context(|| format!("there is no scene '{name}'"))?;
            let draw = |seed| {
                let boxes = scene.boxes(n, seed);
                boxes.with_context(|| format!("'{name}' does not exist in {D} dimensions"))
            };
            if varied(name, n, None).is_some() {
                return Ok(Self::varied((SEED..).take(scenes).map(draw).collect::<Result<_>>()?));
            }
            draw(SEED)?
        };
        let mut shuffled = boxes.clone();
        Random::new(SEED).shuffle(&mut shuffled);
        Ok(Self::AtRest { boxes, shuffled })
    }

    fn varied(mut scenes: Vec<Vec<Aabb<D>>>) -> Self {
        // Some kinds have the same boxes for every seed. Only their order can vary.
        if scenes.first() == scenes.get(1) {
            for (scene, seed) in scenes.iter_mut().zip(SEED..) {
                Random::new(seed).shuffle(scene);
            }
        }
        Self::Varied { scenes, next: 0, current: Vec::new() }
    }

    /// The frames that pairs are checked on, one after another: each is given to `check`.
    pub fn frames(&mut self, mut check: impl FnMut(&[Aabb<D>]) -> Result<()>) -> Result<()> {
        match self {
            Self::Varied { scenes, .. } => {
                scenes.iter().take(FRAMES_CHECKED).try_for_each(|boxes| check(boxes))
            }
            Self::AtRest { boxes, .. } => check(boxes),
            Self::InMotion(moving) => {
                for _ in 0..FRAMES_CHECKED {
                    check(moving.boxes())?;
                    moving.advance();
                }
                Ok(())
            }
        }
    }
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

/// About how many pairs a scene has, extrapolated from small versions of it. So a scene whose pairs grow with the square
/// of its boxes is left out before it fills the memory.
pub fn estimated_pairs<const D: usize>(name: &str, n: usize) -> Result<f64> {
    const SMALL: usize = 500;
    const LARGE: usize = 2000;
    if n <= LARGE {
        return Ok(0.5 * (n as f64).powi(2));
    }
    let frames = frames_checked(name, LARGE) as f64;
    let pairs = |n| Ok::<_, Error>(oracle::<D>(name, n)?.pairs as f64 / frames);
    let (small, large) = (pairs(SMALL)?, pairs(LARGE)?);
    let growth = f64::log2(large.max(1.0) / small.max(1.0)) / f64::log2((LARGE / SMALL) as f64);
    Ok(large * (n as f64 / LARGE as f64).powf(growth.max(1.0)))
}

/// The right pairs of all frames that are checked, by brute force.
pub fn oracle<const D: usize>(name: &str, n: usize) -> Result<Fingerprint> {
    let mut sum = Fingerprint::default();
    Boxes::<D>::with(name, n, FRAMES_CHECKED)?.frames(|boxes| {
        sum = sum + Fingerprint::of(&sweep_and_prune_scenes::brute_force(boxes)?);
        Ok(())
    })?;
    Ok(sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scenes_of_a_kind_differ_even_where_seeds_do_not_change_the_boxes() {
        for name in ["uniform", "box-pruning", "grid"] {
            let Boxes::Varied { scenes, .. } = Boxes::<3>::new(name, 1000, None).unwrap() else {
                panic!("one scene of {name}");
            };
            assert!(scenes.len() >= 100 + WARM_UP);
            for (at, scene) in scenes.iter().enumerate() {
                assert_eq!(scene.len(), 1000);
                assert!(!scenes[..at].contains(scene), "{name}: scene {at} is repeated");
            }
        }
        let many = Boxes::<3>::new("uniform", MOST_VARIED + 1, None).unwrap();
        assert!(matches!(many, Boxes::AtRest { .. }));
    }
}
