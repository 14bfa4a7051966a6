//! Converts numpy arrays for the core: borrows the memory if type and layout allow it, copies it otherwise.

use std::borrow::Cow;

use darboux::Strided;
use numpy::prelude::*;
use numpy::{Element, PyArray1, PyArray2, PyArrayDyn, PyReadonlyArrayDyn, PyUntypedArray};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

/// Rows of `N` floats, in numpy's memory or copied.
pub enum Rows<'py, const N: usize> {
    /// float32, packed.
    Packed(PyReadonlyArrayDyn<'py, f32>),
    /// float32 rows with a stride, in a packed array of any type.
    Within { bytes: PyReadonlyArrayDyn<'py, u8>, offset: usize, stride: usize, len: usize },
    /// Copied, because type or layout differed.
    Copied(Vec<f32>),
}

impl<'py, const N: usize> Rows<'py, N> {
    /// The rows of `value`, shape (V, N), any real numbers. `name` is its name in messages.
    pub fn new(name: &str, letter: &str, value: &Bound<'py, PyAny>) -> PyResult<Self> {
        let array = array_of(name, value)?;
        if array.ndim() != 2 || array.shape()[1] != N {
            let shape = shape_text(array.shape());
            return Err(PyValueError::new_err(format!(
                "{name} must have shape ({letter}, {N}), not {shape}"
            )));
        }
        match array.dtype().kind() {
            b'f' | b'i' | b'u' => {}
            _ => return Err(wrong_type(name, "real numbers", &array)),
        }
        if let Ok(floats) = array.cast::<PyArrayDyn<f32>>() {
            if is_packed(floats) {
                return Ok(Self::Packed(floats.try_readonly()?));
            }
            if let Some(within) = Self::within(floats)? {
                return Ok(within);
            }
        } else if array.dtype().itemsize() == 8 && array.dtype().kind() == b'f' {
            // numpy would warn about values that become infinite.
            let doubles = packed::<f64>(&array)?;
            let doubles = doubles.as_slice()?;
            return Ok(Self::Copied(value.py().detach(|| doubles.iter().map(|&x| x as f32).collect())));
        }
        Ok(Self::Packed(packed(&array)?))
    }

    /// Rows with a constant stride in the packed array that owns the memory; `None` for other layouts.
    fn within(rows: &Bound<'py, PyArrayDyn<f32>>) -> PyResult<Option<Self>> {
        let &[stride, step] = rows.strides() else { return Ok(None) };
        let Ok(stride) = usize::try_from(stride) else { return Ok(None) };
        if step != size_of::<f32>() as isize || stride < N * size_of::<f32>() {
            return Ok(None);
        }
        let Some(bytes) = owner_bytes(rows.as_untyped())? else { return Ok(None) };
        let offset = (rows.data() as usize).checked_sub(bytes.data() as usize);
        let Some(offset) = offset else { return Ok(None) };
        let len = rows.shape()[0];
        let steps = len.saturating_sub(1).checked_mul(stride);
        let end = steps.and_then(|steps| steps.checked_add(offset)?.checked_add(N * size_of::<f32>()));
        let lies_within = end.is_some_and(|end| end <= bytes.len());
        Ok(lies_within.then_some(Self::Within { bytes: bytes.try_readonly()?, offset, stride, len }))
    }

    /// The rows as a strided slice for the core.
    pub fn view(&self) -> PyResult<Strided<'_, N>> {
        let strided = match self {
            Self::Packed(array) => Strided::from_floats(array.as_slice()?, N, 0),
            Self::Copied(floats) => Strided::from_floats(floats, N, 0),
            Self::Within { bytes, offset, stride, len } => {
                let end = offset + len.saturating_sub(1) * stride + N * size_of::<f32>();
                Strided::from_bytes(&bytes.as_slice()?[..end], *stride, *offset)
            }
        };
        strided.map_err(|error| PyValueError::new_err(error.to_string()))
    }

    /// The rows packed; copied only if they are not packed already.
    pub fn packed(&self) -> PyResult<Cow<'_, [[f32; N]]>> {
        Ok(match self {
            Self::Packed(array) => Cow::Borrowed(array.as_slice()?.as_chunks().0),
            Self::Copied(floats) => Cow::Borrowed(floats.as_chunks().0),
            Self::Within { bytes, .. } => {
                let view = self.view()?;
                Cow::Owned(bytes.py().detach(|| (0..view.len()).map(|row| view.get(row)).collect()))
            }
        })
    }
}

/// The bytes of the array that owns the memory (the end of the chain of `base`), if that array is packed and
/// readable as bytes.
fn owner_bytes<'py>(array: &Bound<'py, PyUntypedArray>) -> PyResult<Option<Bound<'py, PyArrayDyn<u8>>>> {
    let mut owner = array.clone();
    while let Ok(base) = owner.getattr("base")?.cast_into::<PyUntypedArray>() {
        owner = base;
    }
    if !owner.is_c_contiguous() || owner.dtype().has_object() {
        return Ok(None);
    }
    let Ok(bytes) = owner.call_method1("view", ("u1",)) else { return Ok(None) };
    Ok(bytes.cast_into().ok())
}

/// `value` as an array, converted by numpy.asarray if it is not one.
pub fn array_of<'py>(name: &str, value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyUntypedArray>> {
    if let Ok(array) = value.cast::<PyUntypedArray>() {
        return Ok(array.clone());
    }
    let py = value.py();
    let made = py.import("numpy")?.call_method1("asarray", (value,));
    let made = made.map_err(|error| {
        let said = error.value(py).to_string();
        let sentence = said.lines().next().unwrap_or_default();
        PyValueError::new_err(format!("{name} cannot be made an array: {sentence}"))
    })?;
    Ok(made.cast_into()?)
}

/// The array with native elements of `T`, aligned and packed: itself, or a copy.
pub fn packed<'py, T: Element>(array: &Bound<'py, PyUntypedArray>) -> PyResult<PyReadonlyArrayDyn<'py, T>> {
    if let Ok(typed) = array.cast::<PyArrayDyn<T>>()
        && is_packed(typed)
    {
        return Ok(typed.try_readonly()?);
    }
    let py = array.py();
    let made = py.import("numpy")?.call_method1("require", (array, numpy::dtype::<T>(py), "CA"))?;
    Ok(made.cast_into::<PyArrayDyn<T>>()?.try_readonly()?)
}

fn is_packed<T: Element>(array: &Bound<'_, PyArrayDyn<T>>) -> bool {
    array.is_c_contiguous() && array.is_aligned()
}

/// Formats a shape as numpy does.
pub fn shape_text(shape: &[usize]) -> String {
    match shape {
        [one] => format!("({one},)"),
        _ => format!("({})", shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    }
}

/// The error for an argument `name` that does not hold `what`.
pub fn wrong_type(name: &str, what: &str, array: &Bound<'_, PyUntypedArray>) -> PyErr {
    PyTypeError::new_err(format!("{name} must hold {what}, not {}", array.dtype()))
}

/// A new array of shape (rows, N) over the memory of `rows`.
pub fn rows_array<T: Element + Copy, const N: usize>(
    py: Python<'_>,
    rows: Vec<[T; N]>,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let len = rows.len();
    PyArray1::from_vec(py, rows.into_flattened()).reshape([len, N])
}
