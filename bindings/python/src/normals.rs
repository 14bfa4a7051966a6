//! Computes normals per corner.

use darboux::{Context, NormalOptions};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::{Rows, rows_array};
use crate::choices::named_choice;
use crate::mesh::{FaceSizes, IndexArray};
use crate::numbers::degrees;
use crate::results::named;
use crate::threads::cancellable;

/// The options of the core. Errors: unknown names; a crease that is not a number of degrees.
pub fn normal_options(shading: &str, weight: &str, crease: f32, seams: &str) -> PyResult<NormalOptions> {
    if !crease.is_finite() {
        return Err(PyValueError::new_err(format!("crease is {crease}; it must be a number of degrees")));
    }
    Ok(NormalOptions::new()
        .with_shading(named_choice(shading)?)
        .with_weight(named_choice(weight)?)
        .with_crease(crease)
        .with_seams(named_choice(seams)?))
}

/// Compute a unit normal for every corner.
///
/// The result is per corner, not per vertex: split_normals returns vertices and new indices. Faces are
/// counter-clockwise seen from the side to which their normal points.
///
/// Parameters
/// ----------
/// positions : (V, 3) array_like
/// indices : (C,), (F, 3) or (F, 4) array_like of integers, optional
///     The vertex of each corner. Without indices, every vertex is a corner of its own.
/// faces : 3, 4 or (F,) array_like of integers, optional
///     Corners per face, of any size from 3 on. Without, indices of shape (F, 4) are quads, all else
///     triangles.
/// shading : str
///     'smooth', or 'flat': every corner has its face's normal.
/// weight : str
///     How much each face counts at a vertex: 'angle', 'area', or 'angle-area', which keeps wide faces flat
///     beside bevels.
/// crease : float
///     Degrees: smooth shading stops at edges whose faces' normals differ by more.
/// seams : str
///     'ignored': vertices at equal positions share normals; 'respected': only vertices of the index list do.
/// return_report : bool
///     Return (normals, NormalReport).
///
/// Returns
/// -------
/// (C, 3) float32 array
///
/// Raises
/// ------
/// TypeError, ValueError
///     As for generate_tangents.
#[pyfunction]
#[pyo3(signature = (
    positions, indices=None, *, faces=None, shading="smooth", weight="angle", crease=180.0, seams="ignored",
    return_report=false
))]
#[expect(clippy::too_many_arguments, reason = "Python passes them by name")]
pub fn generate_normals<'py>(
    py: Python<'py>,
    positions: &Bound<'py, PyAny>,
    indices: Option<&Bound<'py, PyAny>>,
    faces: Option<&Bound<'py, PyAny>>,
    shading: &str,
    weight: &str,
    #[pyo3(from_py_with = degrees)] crease: f32,
    seams: &str,
    return_report: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let options = normal_options(shading, weight, crease, seams)?;
    let positions = Rows::<3>::new("positions", "V", positions)?;
    let indices = IndexArray::new(indices)?;
    let (positions, list) = (positions.view()?, indices.view());
    let faces = FaceSizes::new(faces, &indices, positions.len())?;
    let size = (indices.len().unwrap_or(positions.len()), false);
    let generate = |context: &mut Context| {
        darboux::generate_normals_with(positions, list, faces.view(), &options, context)
    };
    let darboux::Normals { corners, report } = cancellable(py, None, size, &mut Context::new(), generate)?;
    let normals = rows_array(py, corners.into_per_corner())?.into_any();
    if !return_report {
        return Ok(normals);
    }
    let fields = (report.faces, report.degenerate_faces, report.repaired_corners, report.creased_edges);
    (normals, named(py, "NormalReport", fields)?).into_pyobject(py).map(Bound::into_any)
}
