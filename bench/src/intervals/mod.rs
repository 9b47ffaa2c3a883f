//! The libraries that find or count the pairs of intervals: this repository's and the alternatives to it, each in its
//! own short file, called as its own documentation recommends.

mod draw;
mod finding;
mod library;
mod this_crate;

#[cfg(feature = "intervals")]
mod coitrees;
#[cfg(feature = "intervals")]
mod superintervals;

pub use draw::{AILIST, AILIST_READS, names};
pub use finding::{Finding, oracle};
pub use library::IntervalLibrary;

/// All libraries that were compiled in, this repository's first.
#[allow(unused_mut, reason = "without the features there are no alternatives to add")]
pub fn all() -> Vec<IntervalLibrary> {
    let mut all = vec![this_crate::LIBRARY];
    #[cfg(feature = "intervals")]
    all.extend([coitrees::LIBRARY, superintervals::LIBRARY]);
    all
}
