//! parry: the bounding volume hierarchy that rapier uses as its broad phase.

use anyhow::Result;
use sweep_and_prune::Aabb;

use super::library::{Finder, Library, Origin};

/// The tree traversed against itself.
pub const LIBRARY: Library = Library {
    name: "parry",
    origin: Origin::Crate("parry3d"),
    how: "`Bvh::from_iter` with the default (binned) strategy, `traverse_bvtt_single_tree`, \
          parry2d or parry3d",
    alternative: true,
    two: Some(|| Box::new(two::Parry::default())),
    three: Some(|| Box::new(three::Parry::default())),
};

/// parry is two crates with one interface, so its library is one text with two meanings.
macro_rules! parry {
    ($module:ident, $parry:ident, $dimensions:literal) => {
        mod $module {
            use $parry::bounding_volume::Aabb as Bounds;
            use $parry::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};

            use super::{Aabb, Finder, Result};

            #[derive(Default)]
            pub struct Parry {
                workspace: BvhWorkspace,
                pairs: Vec<[u32; 2]>,
            }

            impl Finder<$dimensions> for Parry {
                fn find<'a>(
                    &'a mut self,
                    boxes: &'a [Aabb<$dimensions>],
                ) -> Result<&'a [[u32; 2]]> {
                    let leaf =
                        |aabb: &Aabb<$dimensions>| Bounds::new(aabb.min.into(), aabb.max.into());
                    let leaves = boxes.iter().map(leaf).enumerate();
                    let tree = Bvh::from_iter(BvhBuildStrategy::default(), leaves);
                    self.pairs.clear();
                    tree.traverse_bvtt_single_tree::<false>(&mut self.workspace, &mut |a, b| {
                        self.pairs.push([a, b])
                    });
                    Ok(&self.pairs)
                }
            }
        }
    };
}

parry!(two, parry2d, 2);
parry!(three, parry3d, 3);
