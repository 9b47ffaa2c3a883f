//! How a call ended.

/// `simulation.js` has the same list.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Code {
    /// Done.
    Ok = 0,
    /// The handle is not that of a simulation.
    NoSuchSimulation = 1,
    /// An option is NaN, or does not exist.
    InvalidOption = 2,
    /// The balls do not fit without overlap.
    TooCrowded = 3,
    /// More balls, or simulations, than can be held.
    TooMany = 4,
    /// A bug.
    Internal = 5,
}
