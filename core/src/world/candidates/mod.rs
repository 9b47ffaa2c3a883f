//! The candidates, which are the pairs of fat AABBs that overlap, and how lists of pairs are sorted and
//! compared.

mod list;
mod sort;

pub use list::{CHUNK, Candidates, are_asleep, push_wanted, write_wanted};
pub use sort::PairSorter;
