//! The scenes of the page.

use std::sync::LazyLock;

use sweep_and_prune_scenes::Scene;

/// The scenes that can be shown: not the three whose coordinates are too extreme to move.
pub static SCENES: LazyLock<Vec<Scene>> = LazyLock::new(|| {
    let hidden = [Scene::Extreme, Scene::Subnormal, Scene::Infinite];
    Scene::ALL.iter().copied().filter(|scene| !hidden.contains(scene)).collect()
});
