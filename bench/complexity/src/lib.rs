//! The complexity of every algorithm: what the table claims, and what counting says.
//!
//! Operations are counted, not seconds: comparisons and swaps of the sort, box tests, overlaps
//! found and ended on an axis, pairs reported. Each claim is a formula in n, in the overlaps on the
//! axis (m) and the inversions (s); these are counted independently of the algorithm that is
//! measured. The operations of a step are counted at every power of two, and two slopes are fitted
//! in the doubly logarithmic plane: of the operations over n, and of their ratio to the claim,
//! which has to be flat.

mod claims;
mod facts;
mod measure;
mod report;
mod worlds;

pub use claims::{Case, Claim, Variant, variants};
pub use facts::Facts;
pub use measure::{Limits, Measurement, measure};
pub use report::{Report, Row, Section, TOLERANCE};
pub use worlds::World;
