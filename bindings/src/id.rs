//! The form of ids that a binding gives out.

use sweep_and_prune::ProxyId;

/// An id in the form that a binding gives out.
pub trait Id: Copy {
    /// The form of an id of the core.
    fn from_proxy(id: ProxyId) -> Self;
}

/// The bits of an id, as [`ProxyId::to_bits`].
impl Id for u64 {
    fn from_proxy(id: ProxyId) -> Self {
        id.to_bits()
    }
}
