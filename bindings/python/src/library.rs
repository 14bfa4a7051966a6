//! Batches: what darboux-cli makes of many files, with the processes left to Python.

use std::path::PathBuf;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::numbers::Threads;
use crate::threads::limited;

/// Models on their way into a folder of outputs: an order per file, and the journal that takes the answers.
///
/// Parameters
/// ----------
/// inputs : list of path-like
///     Files and folders.
/// folder : path-like
///     Of outputs. While the library is open no other run can write there.
/// options : list of str
///     Of `darboux tangents`.
///
/// Raises
/// ------
/// ValueError
///     What the command refuses; another run that writes there.
#[pyclass(frozen, module = "darboux._darboux")]
pub struct Library(darboux_cli::Library);

#[pymethods]
impl Library {
    #[new]
    fn new(inputs: Vec<PathBuf>, folder: PathBuf, options: Vec<String>) -> PyResult<Self> {
        darboux_cli::Library::open(&inputs, &folder, &options).map(Self).map_err(PyValueError::new_err)
    }

    /// An order per file, JSON.
    #[getter]
    fn orders(&self) -> Vec<String> {
        self.0.orders().to_vec()
    }

    /// The reports of places that could not be searched, JSON.
    #[getter]
    fn failed(&self) -> Vec<String> {
        self.0.failed().to_vec()
    }

    /// Note an answer in the journal.
    fn take(&self, answer: &str) -> PyResult<()> {
        self.0.take(answer).map_err(PyValueError::new_err)
    }

    /// Remove what killed workers left half-written, and let other runs write there. No worker may be at work.
    fn close(&self) -> PyResult<()> {
        self.0.close().map_err(PyValueError::new_err)
    }
}

/// Do what an order says with so many threads; return the answer.
#[pyfunction]
pub fn carry_out(py: Python<'_>, order: &str, threads: Threads) -> PyResult<String> {
    limited(py, threads, || darboux_cli::carry_out(order))?.map_err(PyValueError::new_err)
}

/// The answer to an order whose worker was lost for that reason.
#[pyfunction]
pub fn give_up(order: &str, reason: &str) -> PyResult<String> {
    darboux_cli::give_up(order, reason).map_err(PyValueError::new_err)
}
