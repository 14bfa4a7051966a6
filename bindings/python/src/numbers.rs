//! Numbers that a caller may have made up, and in which range they must be.

use pyo3::exceptions::{PyOverflowError, PyTypeError, PyValueError};
use pyo3::prelude::*;

/// Of threads: it must not exhaust the machine.
const MOST_THREADS: i64 = 1024;

/// How many threads work is done on.
#[derive(Clone, Copy)]
pub struct Threads(pub usize);

impl Threads {
    /// Of so many as a caller may have left out: 0 stands for as many as the machine has.
    pub fn or_all(threads: Option<Self>) -> usize {
        threads.map_or(0, |Threads(number)| number)
    }
}

/// How many vertices a mesh has.
#[derive(Clone, Copy)]
pub struct VertexCount(pub usize);

impl<'py> FromPyObject<'_, 'py> for Threads {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        Ok(Self(whole("threads", &value, 1, MOST_THREADS)?))
    }
}

impl<'py> FromPyObject<'_, 'py> for VertexCount {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        Ok(Self(whole("vertex_count", &value, 0, u32::MAX.into())?))
    }
}

/// An angle: infinite where it is larger than any float, which its reader refuses.
pub fn degrees(value: &Bound<'_, PyAny>) -> PyResult<f32> {
    match value.extract::<f64>() {
        Err(error) if error.is_instance_of::<PyOverflowError>(value.py()) => Ok(f32::INFINITY),
        other => other.map(|degrees| degrees as f32),
    }
}

/// A whole number of a range. Errors: a TypeError for what is none, a ValueError for one elsewhere.
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

/// A place in a list: the nearest that can be written where the number is larger than any. Errors: a TypeError for what is no whole number.
pub fn place(value: &Bound<'_, PyAny>) -> PyResult<i64> {
    match value.extract::<i64>() {
        Err(error) if error.is_instance_of::<PyOverflowError>(value.py()) => {
            Ok(if value.lt(0)? { i64::MIN } else { i64::MAX })
        }
        other => other,
    }
}
