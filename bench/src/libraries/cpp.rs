//! The alternatives in C++ that Debian packages, behind the functions of `cpp/`.
#![allow(unsafe_code)]

use std::ffi::c_void;

use anyhow::Result;
use sweep_and_prune::Aabb;

use super::library::{Finder, Library, Origin};

/// `Boxes` in `cpp/libraries.h`.
#[repr(C)]
pub struct Boxes {
    rows: *const f32,
    count: usize,
    dimensions: usize,
}

impl<const D: usize> From<&[Aabb<D>]> for Boxes {
    fn from(boxes: &[Aabb<D>]) -> Self {
        // A box is a row of 2 * D floats in memory, as `Aabb` promises.
        Self { rows: boxes.as_ptr().cast(), count: boxes.len(), dimensions: D }
    }
}

/// A library: appends the pairs of the boxes to a C++ vector.
type Find = unsafe extern "C" fn(*const Boxes, *mut c_void);

unsafe extern "C" {
    fn bench_pairs_new() -> *mut c_void;
    fn bench_pairs_delete(pairs: *mut c_void);
    fn bench_pairs_clear(pairs: *mut c_void);
    fn bench_pairs_count(pairs: *const c_void) -> usize;
    fn bench_pairs_data(pairs: *const c_void) -> *const u32;
}

/// A C++ vector of pairs.
pub struct Pairs(*mut c_void);

impl Default for Pairs {
    fn default() -> Self {
        // SAFETY: it takes nothing; the vector is deleted in `drop`.
        Self(unsafe { bench_pairs_new() })
    }
}

impl Drop for Pairs {
    fn drop(&mut self) {
        // SAFETY: made by `bench_pairs_new` and deleted only here.
        unsafe { bench_pairs_delete(self.0) }
    }
}

impl Pairs {
    /// Empties the vector, has `append` append to it, and shows what it holds then.
    pub fn fill(&mut self, append: impl FnOnce(*mut c_void)) -> &[[u32; 2]] {
        // SAFETY: nothing else has the vector; its elements are two u32 each and stay in place until
        // the next call, which needs `self` exclusively.
        unsafe {
            bench_pairs_clear(self.0);
            append(self.0);
            match bench_pairs_count(self.0) {
                0 => &[],
                count => std::slice::from_raw_parts(bench_pairs_data(self.0).cast(), count),
            }
        }
    }
}

/// A library and its pairs.
struct Cpp {
    find: Find,
    pairs: Pairs,
}

impl Cpp {
    fn boxed(find: Find) -> Box<Self> {
        Box::new(Self { find, pairs: Pairs::default() })
    }
}

impl<const D: usize> Finder<D> for Cpp {
    fn find<'a>(&'a mut self, boxes: &'a [Aabb<D>]) -> Result<&'a [[u32; 2]]> {
        let boxes = Boxes::from(boxes);
        // SAFETY: the boxes are valid for the call, and the vector is one of pairs.
        Ok(self.pairs.fill(|pairs| unsafe { (self.find)(&boxes, pairs) }))
    }
}

/// Declares a library and the C++ function behind it.
macro_rules! libraries {
    ($($constant:ident, $function:ident, $name:literal, $package:literal, $how:literal;)*) => {
        unsafe extern "C" {
            $(fn $function(boxes: *const Boxes, pairs: *mut c_void);)*
        }
        $(
            #[doc = $how]
            const $constant: Library = Library {
                name: $name,
                origin: Origin::Debian($package),
                how: $how,
                alternative: true,
                two: Some(|| Cpp::boxed($function)),
                three: Some(|| Cpp::boxed($function)),
            };
        )*
        /// All of them.
        pub const LIBRARIES: &[Library] = &[$($constant),*];
    };
}

libraries! {
    CGAL, bench_cgal, "CGAL", "libcgal-dev",
        "`box_self_intersection_d` over `Box_with_info_d<float>`, closed, default cutoff";
    BOOST, bench_boost, "Boost.Geometry", "libboost-dev",
        "`rtree<rstar<16>>` packed from all boxes, one `intersects` query a box in the tree's order";
    BULLET_TREE, bench_bullet_tree, "Bullet tree", "libbullet-dev",
        "`btDbvt` bare: `insert`, `collideTT` with itself (`optimizeTopDown` in between makes it slower)";
    BULLET_BROADPHASE, bench_bullet_broadphase, "Bullet broadphase", "libbullet-dev",
        "`btDbvtBroadphase` with its pair cache, collision deferred until all boxes are in";
    BULLET_SWEEP, bench_bullet_sweep, "Bullet sweep", "libbullet-dev",
        "`btAxisSweep3` (32 bits from 16,384 boxes), made from scratch; it rounds coordinates, so its pairs are tested once more";
    ODE_SWEEP, bench_ode_sweep, "ODE sweep", "libode-dev",
        "`dSweepAndPruneSpace`, axis of largest variance first, one `dSpaceCollide`";
    ODE_HASH, bench_ode_hash, "ODE hash", "libode-dev",
        "`dHashSpace` with its default levels, one `dSpaceCollide`";
    FCL, bench_fcl, "FCL", "libfcl-dev",
        "`DynamicAABBTreeCollisionManagerd`: `registerObjects`, `setup`, `collide` with itself";
}
