//! Output arrays: the caller's or new ones.

use numpy::prelude::*;
use numpy::{PyArray2, PyReadwriteArray2, PyUntypedArray};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

use crate::arrays::{shape_text, wrong_type};

/// The destination of the tangents, one per corner.
pub enum Target<'py> {
    /// Written in place.
    Direct(PyReadwriteArray2<'py, f32>),
    /// Written into a new array first and copied, because the caller's array is not packed or overlaps the
    /// input.
    Copied { to: Bound<'py, PyUntypedArray>, from: Bound<'py, PyArray2<f32>> },
}

impl<'py> Target<'py> {
    /// The caller's array, or a new one. Errors: not an array of float32, not of shape (corners, 4),
    /// read-only.
    pub fn new(py: Python<'py>, out: Option<&Bound<'py, PyAny>>, corners: usize) -> PyResult<Self> {
        let Some(out) = out else { return Ok(Self::Direct(fresh(py, corners, 4)?.try_readwrite()?)) };
        let Ok(array) = out.cast::<PyUntypedArray>() else {
            let kind = out.get_type().name()?;
            return Err(PyTypeError::new_err(format!("out must be a numpy array, not {kind}")));
        };
        if !array.dtype().is_equiv_to(&numpy::dtype::<f32>(py)) {
            return Err(wrong_type("out", "float32", array));
        }
        if array.shape() != [corners, 4] {
            let shape = shape_text(array.shape());
            return Err(PyValueError::new_err(format!("out must have shape ({corners}, 4), not {shape}")));
        }
        // Fails where the array is read-only, too. Python's own flags take several times as long to ask for.
        if let Ok(floats) = array.cast::<PyArray2<f32>>()
            && floats.is_c_contiguous()
            && floats.is_aligned()
            && let Ok(writable) = floats.try_readwrite()
        {
            return Ok(Self::Direct(writable));
        }
        if !array.getattr("flags")?.getattr("writeable")?.extract::<bool>()? {
            return Err(PyValueError::new_err("out is read-only; give an array that may be written"));
        }
        Ok(Self::Copied { to: array.clone(), from: fresh(py, corners, 4)? })
    }

    /// Calls `write` with a slice of one tangent per corner, and returns the caller's array or the new one.
    pub fn fill<R>(
        self,
        py: Python<'py>,
        write: impl FnOnce(&mut [[f32; 4]]) -> PyResult<R>,
    ) -> PyResult<(Bound<'py, PyAny>, R)> {
        match self {
            Self::Direct(mut array) => {
                let written = write(array.as_slice_mut()?.as_chunks_mut().0)?;
                Ok(((**array).clone().into_any(), written))
            }
            Self::Copied { to, from } => {
                let written = write(from.try_readwrite()?.as_slice_mut()?.as_chunks_mut().0)?;
                py.import("numpy")?.call_method1("copyto", (&to, from))?;
                Ok((to.into_any(), written))
            }
        }
    }
}

/// A new array of shape (rows, columns). numpy requests large pages from the system, which is faster than
/// many small ones.
pub fn fresh(py: Python<'_>, rows: usize, columns: usize) -> PyResult<Bound<'_, PyArray2<f32>>> {
    let made = py.import("numpy")?.call_method1("empty", ((rows, columns), numpy::dtype::<f32>(py)))?;
    Ok(made.cast_into()?)
}
