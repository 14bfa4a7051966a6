//! Checks the ranges of numbers that callers pass.

use pyo3::exceptions::{PyOverflowError, PyTypeError, PyValueError};
use pyo3::prelude::*;

/// The largest number of threads; more could exhaust the machine.
const MAX_THREADS: i64 = 1024;

/// A number of threads.
#[derive(Clone, Copy)]
pub struct Threads(pub usize);

impl Threads {
    /// From an optional argument; 0 stands for the number of hardware threads.
    pub fn or_all(threads: Option<Self>) -> usize {
        threads.map_or(0, |Threads(number)| number)
    }
}

/// A number of vertices.
#[derive(Clone, Copy)]
pub struct VertexCount(pub usize);

impl<'py> FromPyObject<'_, 'py> for Threads {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        Ok(Self(whole("threads", &value, 1, MAX_THREADS)?))
    }
}

impl<'py> FromPyObject<'_, 'py> for VertexCount {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        Ok(Self(whole("vertex_count", &value, 0, u32::MAX.into())?))
    }
}

/// A number that is not negative.
#[derive(Clone, Copy)]
pub struct Natural(pub u32);

impl<'py> FromPyObject<'_, 'py> for Natural {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        natural(&value).map(Self)
    }
}

/// As [`Natural`], for arguments with a default.
pub fn natural(value: &Bound<'_, PyAny>) -> PyResult<u32> {
    whole("a number", value, 0, u32::MAX.into()).map(|number| number as u32)
}

/// An angle. Numbers beyond the range of floats become infinite, which later checks refuse.
pub fn degrees(value: &Bound<'_, PyAny>) -> PyResult<f32> {
    match value.extract::<f64>() {
        Err(error) if error.is_instance_of::<PyOverflowError>(value.py()) => Ok(f32::INFINITY),
        other => other.map(|degrees| degrees as f32),
    }
}

/// An integer in a range. Errors: TypeError if it is not an integer, ValueError if it is out of range.
fn whole(name: &str, value: &Bound<'_, PyAny>, least: i64, most: i64) -> PyResult<usize> {
    match value.extract::<i64>() {
        Ok(number) if (least..=most).contains(&number) => return Ok(number as usize),
        Err(error) if !error.is_instance_of::<PyOverflowError>(value.py()) => {
            let kind = value.get_type().name()?;
            return Err(PyTypeError::new_err(format!("{name} must be a whole number, not {kind}")));
        }
        _ => {}
    }
    Err(PyValueError::new_err(format!("{name} is {value}; it must be from {least} to {most}")))
}

/// An index into a list, clamped to the range of the type. Errors: TypeError if it is not an integer.
pub fn place(value: &Bound<'_, PyAny>) -> PyResult<i64> {
    match value.extract::<i64>() {
        Err(error) if error.is_instance_of::<PyOverflowError>(value.py()) => {
            Ok(if value.lt(0)? { i64::MIN } else { i64::MAX })
        }
        other => other,
    }
}
