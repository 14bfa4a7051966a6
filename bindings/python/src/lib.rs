//! The Python package: numpy arrays in, numpy arrays out, the GIL released in between.
//!
//! What is here becomes `darboux._darboux`; `python/darboux` gives it to users, with the named tuples that results are made of
//! and the adapters to other packages. Doc comments of functions are their Python docstrings.

mod arrays;
mod choices;
mod mesh;
mod results;
mod split;
mod tangents;
mod threads;

#[pyo3::pymodule]
mod _darboux {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::split::{split_normals, split_vertices};
    #[pymodule_export]
    use crate::tangents::generate_tangents;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
