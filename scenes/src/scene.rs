//! The table of scenes: name, dimensions, recipe and purpose of each.

use core::ops::RangeInclusive;

use sweep_and_prune::{Aabb, Scalar};

use crate::random::Random;
use crate::recipes::{self, Draw};

/// Makes the enum and its tables from one list, so that a scene is added in one place.
macro_rules! scenes {
    ($($variant:ident, $name:literal, $dimensions:expr, $recipe:ident, $description:literal;)*) => {
        /// A recipe for a set of boxes at rest.
        ///
        /// Most have about as many pairs as boxes, for any number of boxes. In some the number of pairs grows with the square of
        /// `n`, so that thousands of boxes have millions of pairs: `Coincident`, `Nested`, `Giants` and `Infinite`; in 1D
        /// and 2D also `Needles` and `Beams`; in 1D also `Slab`, `Flat` and `NeedlesX`.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Scene {
            $(#[doc = $description] $variant,)*
        }

        impl Scene {
            /// Every scene.
            pub const ALL: &'static [Scene] = &[$(Scene::$variant),*];

            /// The name in reports and on command lines, lower case with hyphens.
            pub const fn name(self) -> &'static str {
                match self { $(Scene::$variant => $name,)* }
            }

            /// One sentence on what the scene is, and what it is hard on.
            pub const fn description(self) -> &'static str {
                match self { $(Scene::$variant => $description,)* }
            }

            /// The dimensions in which the scene exists, within `1..=3`.
            pub const fn dimensions(self) -> RangeInclusive<usize> {
                match self { $(Scene::$variant => $dimensions,)* }
            }

            fn draw<const D: usize>(self, draw: &mut Draw) -> Vec<Aabb<D, f64>> {
                match self { $(Scene::$variant => recipes::$recipe(draw),)* }
            }
        }
    };
}

scenes! {
    Uniform, "uniform", 1..=3, uniform,
        "Equal cubes spread evenly over the unit cube, 1.2 pairs a box: the textbook case.";
    Clustered, "clustered", 1..=3, clustered,
        "Cubes in normal clusters of about 500: dense here and empty there, so no even grid fits.";
    Tower, "tower", 1..=3, tower,
        "One tall stack that only y (x in 1D) separates: a sweep along any other axis tests every pair.";
    Slab, "slab", 1..=3, slab,
        "A thin floor of bodies, hardly spread on the last axis: a sweep along it tests far too many.";
    Mixed, "mixed", 1..=3, mixed,
        "Power-law sizes over one ground box: a grid sized for the mean box suits neither end.";
    Coincident, "coincident", 1..=3, coincident,
        "All boxes equal, so all pairs overlap: every coordinate ties, and no order helps.";
    Nested, "nested", 1..=3, nested,
        "Each box inside the next, so all pairs overlap: defeats scans between a box's own endpoints.";
    BoxPruning, "box-pruning", 3..=3, box_pruning,
        "Pierre Terdiman's BoxPruning scene, the same for every seed: 11,811 pairs of 10,000 boxes and 1,144,045 of 100,000.";
    Grid, "grid", 1..=3, grid,
        "Shuffled unit cubes of a full lattice, as in a voxel world: every face touches a neighbor exactly.";
    Points, "points", 1..=3, points,
        "Boxes without size on few coordinates, zero with either sign: a mean size of zero, and ties.";
    Flat, "flat", 1..=3, flat,
        "Sheets in one plane of the last axis: no extent and no size there, zero divided by zero.";
    Diagonal, "diagonal", 1..=3, diagonal,
        "Cubes along the main diagonal: every axis looks alike, and most cells of a grid are empty.";
    NeedlesX, "needles-x", 1..=3, needles_x,
        "Needles along x, half the scene long: a sweep along x tests half of all pairs.";
    NeedlesY, "needles-y", 2..=3, needles_y,
        "Needles along y, half the scene long: a sweep along y tests half of all pairs.";
    NeedlesZ, "needles-z", 3..=3, needles_z,
        "Needles along z, half the scene long: a sweep along z tests half of all pairs.";
    Needles, "needles", 1..=3, needles,
        "Needles along random axes: on every axis some boxes are long, so no sweep axis is good.";
    Beam, "beam", 1..=3, beam,
        "Uniform, with one box across the whole scene on one axis: it lies in a whole row of cells.";
    Beams, "beams", 1..=3, beams,
        "Uniform, with one box in ten across the whole scene on one axis: copies to cells add up.";
    Giant, "giant", 1..=3, giant,
        "Uniform, with one box around everything: it lies in every cell, and no scan of it ends early.";
    Giants, "giants", 1..=3, giants,
        "Uniform, with one box in ten around everything: as many copies as boxes times cells.";
    OneColumn, "one-column", 1..=3, one_column,
        "Two boxes in far corners, all others in one thin column along the last axis: the extent misleads.";
    TwoFarClusters, "two-far-clusters", 1..=3, two_far_clusters,
        "Two uniform cubes of boxes, 1000 scene widths apart: an even grid has two cells in use.";
    MultiScale, "multi-scale", 1..=3, multi_scale,
        "Eight uniform clusters, each a quarter of the size of the last: no single cell size fits.";
    Outlier, "outlier", 1..=3, outlier,
        "Uniform, with one box a million scene widths away: all the others share a cell of an even grid.";
    Far, "far", 1..=3, far,
        "Uniform, 16384 scene widths from the origin: f32 rounds the boxes onto few coordinates, full of ties.";
    Huge, "huge", 1..=3, huge,
        "Uniform over coordinates up to 1e30: products of two lengths overflow f32.";
    Tiny, "tiny", 1..=3, tiny,
        "Uniform over coordinates up to 1e-30: products of two lengths vanish in f32, and any epsilon is too large.";
    Extreme, "extreme", 1..=3, extreme,
        "Uniform over all finite values of the coordinate type: widths and sums overflow to infinity.";
    Subnormal, "subnormal", 1..=3, subnormal,
        "Coordinates a few of the least positive values above zero: reciprocals overflow to infinity.";
    Infinite, "infinite", 1..=3, infinite,
        "Uniform, with one box in sixteen a half-space, a layer, all of space or a point at infinity: no finite extent, infinity minus infinity.";
    Sorted, "sorted", 1..=3, sorted,
        "Uniform, in order along x: the worst input of a naive quicksort, the best of insertion sort.";
    Reversed, "reversed", 1..=3, reversed,
        "Uniform, in reversed order along x: insertion sort makes a swap for every pair.";
    NearlySorted, "nearly-sorted", 1..=3, nearly_sorted,
        "Uniform, in order along x but for one exchange of neighbors in ten boxes: should cost hardly more than no sort.";
}

impl Scene {
    /// The scene of this [`name`](Self::name).
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|scene| scene.name() == name)
    }

    /// The `n` boxes of the scene for a seed, all valid; `None` if the scene does not exist in
    /// `D` dimensions. O(n log n) time.
    pub fn boxes<const D: usize, T: Scalar>(self, n: usize, seed: u64) -> Option<Vec<Aabb<D, T>>> {
        if !self.dimensions().contains(&D) {
            return None;
        }
        let boxes = self.draw::<D>(&mut Draw::new::<T>(n, Random::new(seed)));
        Some(boxes.iter().map(round).collect())
    }
}

/// A box in another coordinate type: the only place where coordinates are rounded.
pub(crate) fn round<const D: usize, T: Scalar>(aabb: &Aabb<D, f64>) -> Aabb<D, T> {
    Aabb::new(aabb.min.map(T::from_f64), aabb.max.map(T::from_f64))
}
