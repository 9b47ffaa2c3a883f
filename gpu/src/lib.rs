#![doc = include_str!("../README.md")]
#![cfg_attr(docsrs, feature(doc_cfg))]

mod buffers;
mod device;
mod error;
mod finder;
mod input;
mod kernels;
mod sort;
mod steps;
mod summary;
mod tree;

pub use device::open_device;
pub use error::Error;
pub use finder::{Found, PairFinder};
pub use input::{Boxes, upload_numbers};
pub use summary::Summary;
