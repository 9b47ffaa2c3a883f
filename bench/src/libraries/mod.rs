//! The libraries that find all pairs of a set of boxes: this repository's and the alternatives to it, each in
//! its own short file, called as its own documentation recommends.

mod one_axis;
mod plain;
pub mod this_crate;

#[cfg(feature = "light")]
mod broccoli;
#[cfg(feature = "cpp")]
pub mod cpp;
#[cfg(feature = "cpp")]
pub mod dynamic_tree;
#[cfg(feature = "light")]
mod geo_index;
mod library;
#[cfg(feature = "light")]
mod obvhs;
#[cfg(feature = "light")]
pub mod packed_spatial_index;
#[cfg(feature = "light")]
mod parry;
#[cfg(feature = "physx")]
pub mod physx;
#[cfg(feature = "light")]
mod rstar;

pub use library::{
    Finder, Library, LibraryInfo, ON_TWO_THREADS, Origin, THIS_CRATE, TWO_AT_ONCE, WITNESSES,
};

/// All libraries that were compiled in, this repository's first.
pub fn all() -> Vec<Library> {
    let mut all =
        vec![this_crate::LIBRARY, this_crate::TWO_THREADS, this_crate::TWICE, this_crate::FRESH];
    all.extend([one_axis::LIBRARY, plain::SWEEP, plain::BRUTE_FORCE]);
    #[cfg(feature = "light")]
    all.extend([
        broccoli::LIBRARY,
        geo_index::LIBRARY,
        obvhs::LIBRARY,
        packed_spatial_index::LIBRARY,
        parry::LIBRARY,
        rstar::LIBRARY,
    ]);
    #[cfg(feature = "cpp")]
    {
        all.extend([dynamic_tree::BOX2D, dynamic_tree::BOX3D]);
        all.extend_from_slice(cpp::LIBRARIES);
    }
    #[cfg(feature = "physx")]
    all.extend([physx::AUTOMATIC, physx::MULTIPLE]);
    all
}
