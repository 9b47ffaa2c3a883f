//! Finds all overlapping pairs of a set of boxes, or between two sets.
//!
//! ```text
//! boxes -> plan -> placements -> columns -> sort -> sweep -> pairs
//! ```
//!
//! One sweep along one axis tests every box against all that overlap it on that axis: in space, about
//! n^(5/3) tests. So the other axes are cut into columns, small enough for the caches, and each column is
//! swept by itself. `driver.rs` reads like the description of the algorithm; each stage has a file or a
//! folder, and imports only earlier ones.
//!
//! 1. `plan/` draws a sample of at most 256 boxes, and takes the sweep axis and the number of columns for
//!    which a model of the cost is least.
//! 2. `placements.rs` lists the columns that each box touches, as `grid.rs` cuts space, and validates the
//!    boxes. `columns.rs` copies the boxes there: count, prefix sum, scatter. No branch depends on where
//!    a box lies.
//! 3. `sort.rs` sorts a column by left edge and lays it out as a structure of arrays.
//! 4. `sweep.rs` has a kernel test each box against those ahead of it, 1 to 16 at a time, until a left
//!    edge passes its right edge.
//!
//! The column that holds the lower corner of the intersection of two boxes reports the pair. One bit per
//! axis tells whether a box began in an earlier column.
//!
//! # Why it is never slow
//! **Copies.** A box of size s touches 1 + s / w columns of width w on average, so the mean size counts,
//! not the largest. Typical plans make 1.2 to 1.6 copies of each box. The sample estimates the mean. What
//! it missed is found while the copies are listed: at more than 4 copies per box the plan is dropped, and
//! boxes wider than 8 columns are split from the rest.
//!
//! **Sizes** (`sizes.rs`). If no width suits all boxes (one in ten spans the scene), the model looks for a
//! size that splits them. Then the pairs within the small boxes, within the large ones and between both
//! are three searches, each with its own plan.
//!
//! **Clusters** (`crowding.rs`). The model knows how boxes cluster from a histogram of the sample at eleven
//! resolutions. A column that holds far more boxes than expected, or whose sweep would test far more
//! candidates, is planned again by itself. Plans are nested at most 12 deep.
//!
//! **Groups that need different axes** (`plan/overlaps.rs`). The model supposes that boxes are spread evenly
//! in the finest cells of the histogram, and each axis independent of the others. Where boxes are crowded,
//! where a plan seems dear, or where a glance at the sample contradicts the model, the boxes of the sample
//! are compared with each other on each axis. `hard_scenes.rs` has scenes that were 217 times slower than
//! uniform boxes before. A column that a plan has not divided is not cut again by the same means.
//!
//! **Long columns** are also cut along the sweep axis, into slabs that fit the caches.
//!
//! **Two sets on a line** (`lookup.rs`): the smaller one is sorted, and boxes of the larger one look up those that
//! they overlap, unless many of those overlap each other. If the smaller one does not fit a cache, boxes of the larger one
//! are copied to buckets first (`buckets.rs`). The larger one may come in parts (`parts.rs`).
//!
//! **Boxes on a line that come sorted** (`in_order.rs`) are read where they are.
//!
//! **Counts on a line** (`ranks.rs`): how many boxes begin before each one ends, and end before it begins, tells how many
//! pairs there are. No pair is found.
//!
//! **Few boxes against many**: boxes of the larger set are copied only to columns that hold boxes of the
//! smaller one. The number of columns is limited by the number of boxes, since empty ones cost time too.
//!
//! **A set that many searches have in common** (`sorted_set.rs`) is copied to columns and sorted once: for queries of a broad
//! phase whose bodies rest.
//!
//! # Why it is the same everywhere
//! Cells come from one monotone function of a coordinate, so that no box begins after it ends, whatever
//! rounds, overflows or is infinite. Cells decide where a pair is found. Only comparisons of the given
//! coordinates decide whether it is one. The plan depends on the boxes alone, the order in a column is
//! total (left edge, then position), and lanes are reported in order. So the order of the pairs depends
//! on neither processor nor threads. Behind the last box of a column stand NaN edges, which are `<=`
//! nothing: unlike infinite sentinels they also stop the sweep of an infinite box.
//!
//! # Threads
//! Each thread lists and counts a chunk of the boxes, and copies it to its places in one array, in the
//! order in which one thread would. Then each takes the next group of columns. Pairs are stored in chunks,
//! and each chunk is copied to its place as soon as all before it have theirs.
//!
//! # Memory
//! A record is a box, its index and a word: 32 bytes for a 3D `f32` box. With 1.2 to 1.6 copies, their
//! list (8 bytes each), and one sorted column, a finder holds less than four times what the boxes take,
//! beside the pairs and 32 bytes per box. Nested plans hold their own records: 10 times what the boxes
//! take on the test scenes, 34 times for needles that cross in the plane. All of it is kept for the next
//! call. Counting and streaming store no pairs. Where memory runs out, the call ends with
//! [`Error::OutOfMemory`](crate::Error::OutOfMemory) and the buffer of pairs is freed.
//!
//! # Sources
//! Baraff 1992 (sort and sweep); Terdiman 2017, *Box pruning revisited* (structure of arrays, sentinels,
//! vector tests, buckets); Dittrich and Seeger 2000, *Data redundancy and duplicate detection in spatial
//! join processing* (a pair is reported where the lower corner of its intersection lies).

mod brute;
mod buckets;
mod columns;
#[cfg(all(test, feature = "std"))]
mod columns_record;

mod crowding;
mod driver;
mod finder;
mod grid;
#[cfg(all(test, feature = "std"))]
mod hard_scenes;
mod in_order;
mod kernel;
mod lookup;
mod near;
mod one_by_one;
mod parallel;
mod parts;
mod placements;
mod plan;
mod probe;
mod ranks;
mod search;
mod sink;
mod sizes;
mod sort;
mod sorted_set;
mod source;
mod sweep;
mod task;
#[cfg(all(test, feature = "std"))]
pub(crate) mod work;

pub use finder::{PairFinder, count_pairs, find_pairs, find_pairs_between};
pub use kernel::Kernel;
pub use parts::InParts;
pub use search::Search;
pub use sorted_set::SortedSet;
