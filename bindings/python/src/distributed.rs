//! Batches of files: darboux-cli plans and records the work, and Python runs the worker processes.

use std::path::PathBuf;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::numbers::Threads;
use crate::threads::limited;

/// A batch of models with one output folder: one task per file, and the journal that records the results.
///
/// Parameters
/// ----------
/// inputs : list of path-like
///     Files and folders.
/// folder : path-like
///     The output folder. No other run can write there while the batch is open.
/// options : list of str
///     Options of `darboux tangents`.
///
/// Raises
/// ------
/// ValueError
///     The command refuses the options; another run uses the folder.
#[pyclass(frozen, module = "darboux._darboux")]
pub struct DistributedBatch(darboux_cli::DistributedBatch);

#[pymethods]
impl DistributedBatch {
    #[new]
    fn new(inputs: Vec<PathBuf>, folder: PathBuf, options: Vec<String>) -> PyResult<Self> {
        let batch = darboux_cli::DistributedBatch::open(&inputs, &folder, &options);
        batch.map(Self).map_err(PyValueError::new_err)
    }

    /// One task per file, as JSON.
    #[getter]
    fn tasks(&self) -> Vec<String> {
        self.0.tasks().to_vec()
    }

    /// Reports of folders that could not be searched, as JSON.
    #[getter]
    fn failed(&self) -> Vec<String> {
        self.0.failed().to_vec()
    }

    /// Add the result of a task to the journal.
    fn record(&self, result: &str) -> PyResult<()> {
        self.0.record(result).map_err(PyValueError::new_err)
    }

    /// Remove unfinished files of killed workers and release the folder. No worker may be running.
    fn close(&self) -> PyResult<()> {
        self.0.close().map_err(PyValueError::new_err)
    }
}

/// A job of bakes: one task per entry, and the journal in the job's folder.
///
/// Parameters
/// ----------
/// job : path-like
///     The TOML file, or a folder with the option '--suffixes'. No other run can work on it while it is open.
/// options : list of str
///     Options of `darboux bake`.
///
/// Raises
/// ------
/// ValueError
///     The command refuses the job; another run works on it.
#[pyclass(frozen, module = "darboux._darboux")]
pub struct DistributedJob(darboux_cli::DistributedJob);

#[pymethods]
impl DistributedJob {
    #[new]
    fn new(job: PathBuf, options: Vec<String>) -> PyResult<Self> {
        darboux_cli::DistributedJob::open(&job, &options).map(Self).map_err(PyValueError::new_err)
    }

    /// One task per entry, as JSON.
    #[getter]
    fn tasks(&self) -> Vec<String> {
        self.0.tasks().to_vec()
    }

    /// Add the result of a task to the journal.
    fn record(&self, result: &str) -> PyResult<()> {
        self.0.record(result).map_err(PyValueError::new_err)
    }

    /// Remove unfinished files of killed workers and release the job. No worker may be running.
    fn close(&self) -> PyResult<()> {
        self.0.close().map_err(PyValueError::new_err)
    }
}

/// Process a task with this number of threads; return its result.
#[pyfunction]
pub fn run_task(py: Python<'_>, task: &str, threads: Threads) -> PyResult<String> {
    limited(py, threads, || darboux_cli::run_task(task))?.map_err(PyValueError::new_err)
}

/// The result of a task that could not be run for the given reason.
#[pyfunction]
pub fn failed_task(task: &str, reason: &str) -> PyResult<String> {
    darboux_cli::failed_task(task, reason).map_err(PyValueError::new_err)
}
