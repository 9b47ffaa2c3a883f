//! Which of the six types of box an object has, chosen at run time.

use sweep_and_prune::{Error, SnapshotFault, SnapshotInfo};

/// The dimensions and the precision of boxes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    /// 1, 2 or 3.
    pub dimensions: usize,
    /// Whether coordinates are `f64`, and not `f32`.
    pub is_double: bool,
}

impl Kind {
    /// The type of the boxes in a snapshot. The rest of the bytes may still be damaged.
    ///
    /// # Errors
    /// [`Error::InvalidSnapshot`] if the bytes do not begin as a snapshot does.
    pub fn of_snapshot(bytes: &[u8]) -> Result<Self, Error> {
        let SnapshotInfo { dimensions, scalar_bytes, .. } = SnapshotInfo::read(bytes)?;
        match (dimensions, scalar_bytes) {
            (1..=3, 4 | 8) => Ok(Self { dimensions, is_double: scalar_bytes == 8 }),
            _ => Err(Error::InvalidSnapshot(SnapshotFault::Corrupt)),
        }
    }
}
