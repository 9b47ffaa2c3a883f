//! The door from Python to `sweep-and-prune`: arrays of NumPy in and out, nothing else. The
//! package around it, `sweep_and_prune/`, brings whatever a user passes into the form that is
//! wanted here, C-contiguous rows of the right type, and has the documentation.

mod arrays;
mod errors;
mod finder;
mod run;
mod world;

/// What `sweep_and_prune/_native.pyi` describes.
#[pyo3::pymodule]
mod _native {
    #[pymodule_export]
    use super::finder::Finder;
    #[pymodule_export]
    use super::world::World;
}
