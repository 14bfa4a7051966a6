//! Runs the command line program from Python.

use std::ffi::OsString;

use pyo3::prelude::*;

/// Run the darboux command on the process's standard streams; return its exit code.
///
/// Parameters
/// ----------
/// arguments : list of str
///     The first element is the program's name.
#[pyfunction]
pub fn run(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| darboux_cli::run(arguments))
}
