//! What the harness and its workers say to each other: one line of JSON for each request and reply.

use anyhow::Result;
use serde::{Deserialize, Serialize};

use crate::fingerprint::Fingerprint;

/// What the libraries do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, clap::ValueEnum)]
pub enum Kind {
    /// They find all pairs of a set of boxes.
    Pairs,
    /// They track pairs from frame to frame.
    Worlds,
    /// They track the pairs of the boxes that move among many static ones.
    Statics,
    /// They find the pairs of intervals, or count them.
    Intervals,
}

impl Kind {
    /// Whether the libraries keep their boxes from frame to frame.
    pub fn tracks(self) -> bool {
        matches!(self, Self::Worlds | Self::Statics)
    }
}

/// What the harness asks of a worker.
#[derive(Serialize, Deserialize)]
pub enum Request {
    /// Find the pairs once, or track them for a while, and report what they are.
    Check,
    /// Find the pairs, or go on to the next frame, this many times, and report how long each call took.
    Time {
        /// How many times.
        repeats: usize,
        /// How many calls to find are timed together, where one alone is too short for the clock.
        batch: usize,
    },
}

/// What a worker answers.
#[derive(Serialize, Deserialize)]
pub enum Reply {
    /// The boxes are there, the library is made.
    Ready,
    /// The answer to [`Request::Check`].
    Checked {
        /// The pairs; `None` if the library does not tell them.
        fingerprint: Option<Fingerprint>,
        /// How long the longest of these first calls took.
        nanoseconds: u64,
        /// The most memory in use during the call, less what was in use before; `None` where
        /// the system does not tell.
        peak_bytes: Option<u64>,
        /// Of a world, how long it takes to insert all boxes and to find their first pairs.
        start_ns: Option<u64>,
        /// Of a world that reports the pairs of larger boxes, how long it takes to test them for overlap.
        exact_ns: Option<u64>,
    },
    /// The answer to [`Request::Time`].
    Timed {
        /// How long each call took: the mean of its batch.
        nanoseconds: Vec<f64>,
    },
    /// The library returned an error.
    Failed {
        /// The error.
        message: String,
    },
}

/// Marks the lines of the protocol; a library may print what it likes on others.
pub const MARK: &str = "@reply ";

/// What a worker can do.
pub trait Job {
    /// The answer to [`Request::Check`].
    fn check(&mut self) -> Result<Reply>;

    /// The answer to [`Request::Time`].
    fn time(&mut self, repeats: usize, batch: usize) -> Result<Reply>;
}
