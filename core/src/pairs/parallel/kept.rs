//! What a search on one thread has none of.

/// Whether the work of a search may be split among threads.
pub const MAY_SPLIT: bool = cfg!(feature = "parallel");

/// Things that only a search on several threads needs, kept between calls.
#[cfg(feature = "parallel")]
pub type Kept<V> = alloc::vec::Vec<V>;
#[cfg(not(feature = "parallel"))]
pub type Kept<V> = core::marker::PhantomData<V>;
