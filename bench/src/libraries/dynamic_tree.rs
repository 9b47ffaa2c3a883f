//! Box2D and Box3D: their dynamic trees.
#![allow(unsafe_code)]

use std::ffi::c_void;

use anyhow::Result;
use box3d_sys as box3d;
use boxdd_sys::ffi as box2d;
use sweep_and_prune::Aabb;

use super::library::{Finder, Library, Origin};

/// In two dimensions only.
pub const BOX2D: Library = Library {
    name: "Box2D",
    origin: Origin::Crate("boxdd-sys"),
    how: "`b2DynamicTree` made from scratch: `b2DynamicTree_CreateProxy` for each box, a full `b2DynamicTree_Rebuild`, \
          `b2DynamicTree_Query` for each box",
    alternative: true,
    two: Some(|| Box::new(Trees::<Box2d>::default())),
    three: None,
};

/// In three dimensions only.
pub const BOX3D: Library = Library {
    name: "Box3D",
    origin: Origin::Crate("box3d-sys"),
    how: "the same with `b3DynamicTree`",
    alternative: true,
    two: None,
    three: Some(|| Box::new(Trees::<Box3d>::default())),
};

/// A tree of boxes, each with a number.
pub trait DynamicTree<const D: usize>: Default {
    /// Adds a box and returns its place in the tree.
    fn insert(&mut self, aabb: &Aabb<D>, id: u32) -> i32;

    /// Replaces the box at a place that [`insert`](Self::insert) returned by one that encloses it.
    fn enlarge(&mut self, place: i32, aabb: &Aabb<D>);

    /// Rebuilds the tree, or only what changed most.
    fn rebuild(&mut self, full: bool);

    /// Calls `visit` with the number of each box that overlaps this one.
    fn query<F: FnMut(u32)>(&self, aabb: &Aabb<D>, visit: F);
}

/// Called by the library for each box that overlaps the one asked for.
///
/// # Safety
/// The context points to an `F` that nothing else uses meanwhile.
unsafe extern "C" fn meet<F: FnMut(u32)>(_place: i32, id: u64, context: *mut c_void) -> bool {
    // SAFETY: as above.
    let visit = unsafe { &mut *context.cast::<F>() };
    visit(id as u32);
    true
}

/// Box3D has the interface of Box2D under other names, so there is one text with two meanings.
macro_rules! dynamic_tree {
    (
        $name:ident, $dimensions:literal, $ffi:ident, $bounds:expr, $tree:ident, $create:ident, $destroy:ident,
        $create_proxy:ident, $enlarge:ident, $rebuild:ident, $query:ident($($all_bits:literal)?)
    ) => {
        #[doc = stringify!($tree)]
        pub struct $name($ffi::$tree);

        impl Default for $name {
            fn default() -> Self {
                // SAFETY: it takes a number; the tree is destroyed in `drop`.
                Self(unsafe { $ffi::$create(16) })
            }
        }

        impl Drop for $name {
            fn drop(&mut self) {
                // SAFETY: made by the library and destroyed only here.
                unsafe { $ffi::$destroy(&mut self.0) }
            }
        }

        impl DynamicTree<$dimensions> for $name {
            fn insert(&mut self, aabb: &Aabb<$dimensions>, id: u32) -> i32 {
                // SAFETY: the tree lives.
                unsafe { $ffi::$create_proxy(&mut self.0, $bounds(aabb), u64::MAX, id.into()) }
            }

            fn enlarge(&mut self, place: i32, aabb: &Aabb<$dimensions>) {
                // SAFETY: the tree lives, and the library checks the place.
                unsafe { $ffi::$enlarge(&mut self.0, place, $bounds(aabb)) }
            }

            fn rebuild(&mut self, full: bool) {
                // SAFETY: the tree lives.
                unsafe { $ffi::$rebuild(&mut self.0, full) };
            }

            fn query<F: FnMut(u32)>(&self, aabb: &Aabb<$dimensions>, mut visit: F) {
                let context = (&raw mut visit).cast();
                // SAFETY: the tree lives; `meet` gets back the function that lies behind the context.
                unsafe {
                    let (tree, bounds) = (&self.0, $bounds(aabb));
                    $ffi::$query(tree, bounds, u64::MAX, $($all_bits,)? Some(meet::<F>), context);
                }
            }
        }
    };
}

dynamic_tree!(
    Box2d,
    2,
    box2d,
    |aabb: &Aabb<2>| {
        let [lower, upper] = [aabb.min, aabb.max].map(|[x, y]| box2d::b2Vec2 { x, y });
        box2d::b2AABB { lowerBound: lower, upperBound: upper }
    },
    b2DynamicTree,
    b2DynamicTree_Create,
    b2DynamicTree_Destroy,
    b2DynamicTree_CreateProxy,
    b2DynamicTree_EnlargeProxy,
    b2DynamicTree_Rebuild,
    b2DynamicTree_Query()
);
dynamic_tree!(
    Box3d,
    3,
    box3d,
    |aabb: &Aabb<3>| {
        let [lower, upper] = [aabb.min, aabb.max].map(|[x, y, z]| box3d::b3Vec3 { x, y, z });
        box3d::b3AABB { lowerBound: lower, upperBound: upper }
    },
    b3DynamicTree,
    b3DynamicTree_Create,
    b3DynamicTree_Destroy,
    b3DynamicTree_CreateProxy,
    b3DynamicTree_EnlargeProxy,
    b3DynamicTree_Rebuild,
    b3DynamicTree_Query(false)
);

/// A tree made from scratch in each call.
#[derive(Default)]
struct Trees<T> {
    tree: T,
    pairs: Vec<[u32; 2]>,
}

impl<const D: usize, T: DynamicTree<D>> Finder<D> for Trees<T> {
    fn find<'a>(&'a mut self, boxes: &'a [Aabb<D>]) -> Result<&'a [[u32; 2]]> {
        let Self { tree, pairs } = self;
        *tree = T::default();
        for (aabb, id) in boxes.iter().zip(0..) {
            tree.insert(aabb, id);
        }
        tree.rebuild(true);
        pairs.clear();
        for (aabb, a) in boxes.iter().zip(0..) {
            tree.query(aabb, |b| {
                if a < b {
                    pairs.push([a, b]);
                }
            });
        }
        Ok(pairs)
    }
}
