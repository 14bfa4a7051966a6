//! Converts results to the named tuples of `darboux._results`.

use darboux::Report;
use pyo3::call::PyCallArgs;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde::Serialize;

/// A named tuple of type `name` with these fields.
pub fn named<'py>(py: Python<'py>, name: &str, fields: impl PyCallArgs<'py>) -> PyResult<Bound<'py, PyAny>> {
    attribute(py, name)?.call1(fields)
}

/// What the function or class `name` makes of the fields of a serialisable value.
pub fn result_of<'py>(py: Python<'py>, name: &str, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let fields = python_of(py, value)?;
    attribute(py, name)?.call((), Some(fields.cast()?))
}

/// A serialisable value as plain Python objects.
pub fn python_of<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value).map_err(|error| PyValueError::new_err(error.to_string()))?;
    py.import("json")?.call_method1("loads", (text,))
}

fn attribute<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("darboux._results")?.getattr(name)
}

/// The report as a named tuple.
pub fn report<'py>(py: Python<'py>, report: &Report) -> PyResult<Bound<'py, PyAny>> {
    let fields = (
        report.triangles,
        report.unsupported_faces,
        report.degenerate_triangles,
        report.uv_degenerate_triangles,
        report.non_finite_corners,
        report.repaired_corners,
        report.mixed_sign_faces,
        report.mirrored_edges,
        report.split_vertices,
        report.merged_vertices,
    );
    named(py, "Report", fields)
}
