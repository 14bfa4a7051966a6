//! Converts results to the named tuples of `darboux._results`.

use darboux::Report;
use pyo3::call::PyCallArgs;
use pyo3::prelude::*;

/// A named tuple of type `name` with these fields.
pub fn named<'py>(py: Python<'py>, name: &str, fields: impl PyCallArgs<'py>) -> PyResult<Bound<'py, PyAny>> {
    results_class(py, name)?.call1(fields)
}

/// The class of a named tuple.
pub fn results_class<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
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
