//! Why a call was rejected.

use core::fmt;

/// Why a call was rejected. After an error the finder can be used again, unless the device is lost.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// No adapter: this machine has no GPU that a compiled interface of wgpu can use.
    NoAdapter {
        /// What wgpu says.
        message: String,
    },
    /// The adapter refused to open a device.
    NoDevice {
        /// What wgpu says.
        message: String,
    },
    /// The device was lost or destroyed. Open a new one and make a new finder.
    DeviceLost,
    /// The device grants less than every WebGPU device does.
    Limit {
        /// The name of the limit in WebGPU.
        limit: &'static str,
        /// What is needed.
        needed: u64,
        /// What the device grants.
        granted: u64,
    },
    /// More boxes than the device's limits allow: see [`PairFinder::most_boxes`](crate::PairFinder::most_boxes).
    TooManyBoxes {
        /// How many boxes there are, of both sets.
        count: u64,
        /// The most that this device can search.
        most: u64,
    },
    /// More pairs than a buffer of this device holds. None was written.
    TooManyPairs {
        /// The exact number of pairs.
        count: u64,
        /// The most that fit.
        most: u64,
    },
    /// A buffer that was passed has fewer bytes than the call needs.
    BufferTooSmall {
        /// Which buffer: `boxes`, `filters`, `worlds`, `pairs` or `summary`.
        buffer: &'static str,
        /// How many bytes it needs.
        needed: u64,
        /// How many it has.
        size: u64,
    },
    /// A buffer that was passed lacks a usage.
    BufferUsage {
        /// Which buffer: `boxes`, `filters`, `worlds`, `pairs` or `summary`.
        buffer: &'static str,
        /// The usage that it lacks.
        missing: wgpu::BufferUsages,
    },
    /// The device has not enough memory.
    OutOfMemory,
    /// The device rejected a command, which is a fault of this crate or of the driver.
    Device {
        /// What wgpu says.
        message: String,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoAdapter { message } => write!(
                f,
                "no GPU was found: {message}; install a driver, or find the pairs on the processor with sweep_and_prune"
            ),
            Self::NoDevice { message } => write!(f, "the GPU could not be opened: {message}"),
            Self::DeviceLost => {
                f.write_str("the GPU was lost: open a device again and make a new finder")
            }
            Self::Limit { limit, needed, granted } => write!(
                f,
                "the device grants {granted} for {limit}, but {needed} are needed: request it with wgpu::Limits::default() or more"
            ),
            Self::TooManyBoxes { count, most } => write!(
                f,
                "{count} boxes are too many: this device can search {most}; request a larger max_storage_buffer_binding_size and max_buffer_size"
            ),
            Self::TooManyPairs { count, most } => write!(
                f,
                "there are {count} pairs, but a buffer of this device holds {most}: find them in smaller groups of boxes"
            ),
            Self::BufferTooSmall { buffer, needed, size } => {
                write!(f, "the buffer `{buffer}` has {size} bytes, but {needed} are needed")
            }
            Self::BufferUsage { buffer, missing } => {
                write!(f, "the buffer `{buffer}` was made without the usage {missing:?}")
            }
            Self::OutOfMemory => f.write_str("the memory of the GPU is not enough"),
            Self::Device { message } => write!(f, "the GPU rejected a command: {message}"),
        }
    }
}

impl core::error::Error for Error {}
