//! The Python binding of `sweep-and-prune`: NumPy arrays in, NumPy arrays out, and nothing else. The
//! package around it, `sweep_and_prune/`, converts and checks what users pass, and has the
//! documentation.

mod arrays;
mod collected;
mod errors;
mod exit;
mod finder;
mod lines;
mod order;
mod parts;
mod ranks;
mod run;
mod search;
mod whole;
mod world;

/// What `sweep_and_prune/_native.pyi` describes.
#[pyo3::pymodule]
mod _native {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::exit::stop_threads;
    #[pymodule_export]
    use super::finder::Finder;
    #[pymodule_export]
    use super::lines::{read_cells, read_ends_of_variants, read_lines, read_names, read_numbers};
    #[pymodule_export]
    use super::order::{in_order, nearest_of_rows};
    #[pymodule_export]
    use super::ranks::ranks;
    #[pymodule_export]
    use super::run::processors;
    #[pymodule_export]
    use super::whole::take_ends;
    #[pymodule_export]
    use super::world::World;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        // Loads NumPy's functions now: a signal that comes while they are loaded by the first search is a panic.
        drop(numpy::dtype::<f64>(module.py()));
        super::exit::register(module)
    }
}
