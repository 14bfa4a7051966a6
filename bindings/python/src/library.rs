//! Batches of files: darboux-cli plans and records the work, and Python runs the worker processes.

use std::path::PathBuf;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::numbers::Threads;
use crate::threads::limited;

/// A batch of models with one output folder: one order per file, and the journal that records the answers.
///
/// Parameters
/// ----------
/// inputs : list of path-like
///     Files and folders.
/// folder : path-like
///     The output folder. No other run can write there while the library is open.
/// options : list of str
///     Options of `darboux tangents`.
///
/// Raises
/// ------
/// ValueError
///     The command refuses the options; another run uses the folder.
#[pyclass(frozen, module = "darboux._darboux")]
pub struct Library(darboux_cli::Library);

#[pymethods]
impl Library {
    #[new]
    fn new(inputs: Vec<PathBuf>, folder: PathBuf, options: Vec<String>) -> PyResult<Self> {
        darboux_cli::Library::open(&inputs, &folder, &options).map(Self).map_err(PyValueError::new_err)
    }

    /// One order per file, as JSON.
    #[getter]
    fn orders(&self) -> Vec<String> {
        self.0.orders().to_vec()
    }

    /// Reports of folders that could not be searched, as JSON.
    #[getter]
    fn failed(&self) -> Vec<String> {
        self.0.failed().to_vec()
    }

    /// Record an answer in the journal.
    fn take(&self, answer: &str) -> PyResult<()> {
        self.0.take(answer).map_err(PyValueError::new_err)
    }

    /// Remove unfinished files of killed workers and release the folder. No worker may be running.
    fn close(&self) -> PyResult<()> {
        self.0.close().map_err(PyValueError::new_err)
    }
}

/// Process an order with this number of threads; return the answer.
#[pyfunction]
pub fn carry_out(py: Python<'_>, order: &str, threads: Threads) -> PyResult<String> {
    limited(py, threads, || darboux_cli::carry_out(order))?.map_err(PyValueError::new_err)
}

/// The answer for an order whose worker was lost for the given reason.
#[pyfunction]
pub fn give_up(order: &str, reason: &str) -> PyResult<String> {
    darboux_cli::give_up(order, reason).map_err(PyValueError::new_err)
}
