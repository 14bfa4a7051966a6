//! Measures differences between tangents, and how well tangents follow the UVs.

use darboux::{Context, Mesh, Strided};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyList;

use crate::arrays::Rows;
use crate::mesh::{FaceSizes, IndexArray};
use crate::results::named;
use crate::threads::cancellable;

/// Compare two sets of tangents of one mesh, corner by corner (or vertex by vertex).
///
/// Parameters
/// ----------
/// a, b : (C, 4) array_like
///     In the same order and convention.
///
/// Returns
/// -------
/// TangentDifference
///     Angles in degrees; counts.
///
/// Raises
/// ------
/// TypeError, ValueError
///     As for generate_tangents; the number of corners differs.
#[pyfunction]
pub fn measure_tangents<'py>(
    py: Python<'py>,
    a: &Bound<'py, PyAny>,
    b: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let (a, b) = (Rows::new("a", "C", a)?, Rows::new("b", "C", b)?);
    let (a, b) = (a.packed()?, b.packed()?);
    let found = cancellable(py, None, (a.len(), false), &mut Context::new(), |context| {
        darboux::measure_tangents_with(&a, &b, context)
    })?;
    let fields = (
        found.corners,
        found.identical,
        found.sign_flips,
        found.without_angle,
        found.mean,
        found.min,
        found.median,
        found.p95,
        found.max,
        PyArray1::from_slice(py, &found.histogram.map(|count| count as i64)),
        PyList::new(py, found.worst)?,
    );
    named(py, "TangentDifference", fields)
}

/// Measure tangents against the derivatives of the UV map: the angle between the interpolated tangent and
/// dP/du, over the surface.
///
/// Parameters
/// ----------
/// positions : (V, 3) array_like
/// uvs : (V, 2) array_like
/// indices : (C,), (F, 3) or (F, 4) array_like of integers, or None
/// tangents : (C, 4) array_like
///     One per corner.
/// faces : 3, 4 or (F,) array_like of integers, optional
///     As for generate_tangents; quads are split along the diagonal 0-2.
///
/// Returns
/// -------
/// UvFidelity
///     Angles in degrees.
///
/// Raises
/// ------
/// TypeError, ValueError
///     As for generate_tangents; the number of corners differs.
#[pyfunction]
#[pyo3(signature = (positions, uvs, indices, tangents, *, faces=None))]
pub fn measure_uv_fidelity<'py>(
    py: Python<'py>,
    positions: &Bound<'py, PyAny>,
    uvs: &Bound<'py, PyAny>,
    indices: Option<&Bound<'py, PyAny>>,
    tangents: &Bound<'py, PyAny>,
    faces: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let (positions, uvs) = (Rows::<3>::new("positions", "V", positions)?, Rows::<2>::new("uvs", "V", uvs)?);
    let indices = IndexArray::new(indices)?;
    let tangents = Rows::new("tangents", "C", tangents)?;
    let tangents = tangents.packed()?;
    let (positions, uvs, list) = (positions.view()?, uvs.view()?, indices.view());
    let faces = FaceSizes::new(faces, &indices, positions.len())?;
    let found = cancellable(py, None, (tangents.len(), false), &mut Context::new(), |context| {
        let unread = Strided::repeated(&[0.0; 3], positions.len());
        let mesh = Mesh::with_faces(positions, unread, uvs, list, faces.view())?;
        darboux::measure_uv_fidelity_with(&mesh, &tangents, context)
    })?;
    named(py, "UvFidelity", (found.mean, found.root_mean_square, found.area, found.unmeasured_triangles))
}
