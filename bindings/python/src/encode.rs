//! `darboux.encode`: encodes tangents and normals in fewer bytes, and decodes them.

use darboux::encode;
use numpy::prelude::*;
use numpy::{Element, PyArray1, PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::{Rows, array_of, packed, rows_array, shape_text, wrong_type};

/// `N` integers per row, of exactly the encoding's type.
struct Codes<'py, T: Element, const N: usize>(PyReadonlyArrayDyn<'py, T>);

impl<T: Element, const N: usize> Codes<'_, T, N> {
    fn packed(&self) -> PyResult<&[[T; N]]> {
        Ok(self.0.as_slice()?.as_chunks().0)
    }
}

fn codes<'py, T: Element, const N: usize>(value: &Bound<'py, PyAny>) -> PyResult<Codes<'py, T, N>> {
    let array = array_of("codes", value)?;
    if array.cast::<PyArrayDyn<T>>().is_err() {
        return Err(wrong_type("codes", &numpy::dtype::<T>(value.py()).to_string(), &array));
    }
    let is_shaped = match (N, array.shape()) {
        (1, shape) => shape.len() == 1,
        (_, [_, columns]) => *columns == N,
        _ => false,
    };
    if !is_shaped {
        let (wanted, shape) = (if N == 1 { "(C,)".into() } else { format!("(C, {N})") }, array.shape());
        return Err(PyValueError::new_err(format!(
            "codes must have shape {wanted}, not {}",
            shape_text(shape)
        )));
    }
    Ok(Codes(packed(&array)?))
}

fn rows<'py, const N: usize>(name: &str, value: &Bound<'py, PyAny>) -> PyResult<Rows<'py, N>> {
    Rows::new(name, "C", value)
}

/// Applies `change` to each row, without the GIL.
fn mapped<A: Copy + Sync, B: Send>(py: Python<'_>, rows: &[A], change: impl Fn(A) -> B + Sync) -> Vec<B> {
    py.detach(|| rows.iter().map(|&row| change(row)).collect())
}

/// Applies `change` to each normal and its partner row, without the GIL. Errors: the arrays differ in length.
fn mapped_pairs<A: Copy + Sync, B: Send>(
    py: Python<'_>,
    normals: &[[f32; 3]],
    (name, others): (&str, &[A]),
    change: impl Fn([f32; 3], A) -> B + Sync,
) -> PyResult<Vec<B>> {
    if normals.len() != others.len() {
        let (expected, found) = (normals.len(), others.len());
        return Err(PyValueError::new_err(format!(
            "{name} has {found} elements but there are {expected} normals"
        )));
    }
    Ok(py.detach(|| normals.iter().zip(others).map(|(&normal, &other)| change(normal, other)).collect()))
}

macro_rules! encodings {
    ($($(#[$doc:meta])* fn $name:ident($argument:ident: [$from:ident; $columns:literal]) -> [$to:ty; $width:tt];)*) => {$(
        $(#[$doc])*
        #[pyfunction]
        pub fn $name<'py>(py: Python<'py>, $argument: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
            let rows = encodings!(@read $from, $columns, $argument);
            encodings!(@write $width, $to, py, mapped(py, &rows.packed()?, encode::$name))
        }
    )*};
    (@read f32, $columns:literal, $argument:ident) => { rows::<$columns>(stringify!($argument), $argument)? };
    (@read $from:ident, $columns:literal, $argument:ident) => { codes::<$from, $columns>($argument)? };
    (@write 1, $to:ty, $py:ident, $rows:expr) => { Ok(PyArray1::<$to>::from_vec($py, $rows).into_any()) };
    (@write $width:literal, $to:ty, $py:ident, $rows:expr) => {
        Ok(rows_array::<$to, $width>($py, $rows)?.into_any())
    };
}

encodings! {
    /// (C, 4) float32 to (C, 4) int8; error up to 0.40 degrees.
    fn tangent_to_snorm8(tangents: [f32; 4]) -> [i8; 4];
    /// (C, 4) int8 to (C, 4) float32, not normalised.
    fn tangent_from_snorm8(codes: [i8; 4]) -> [f32; 4];
    /// (C, 4) float32 to (C, 4) int16; error up to 0.0016 degrees.
    fn tangent_to_snorm16(tangents: [f32; 4]) -> [i16; 4];
    /// (C, 4) int16 to (C, 4) float32, not normalised.
    fn tangent_from_snorm16(codes: [i16; 4]) -> [f32; 4];
    /// (C, 4) float32 to (C,) uint32, A2B10G10R10_SNORM; error up to 0.098 degrees.
    fn tangent_to_snorm10(tangents: [f32; 4]) -> [u32; 1];
    /// (C, 4) float32 to (C, 2) int16, the sign in the lowest bit of y; error up to 0.0057 degrees.
    fn tangent_to_octahedral(tangents: [f32; 4]) -> [i16; 2];
    /// (C, 2) int16 to (C, 4) float32.
    fn tangent_from_octahedral(codes: [i16; 2]) -> [f32; 4];
    /// (C, 3) float32 to (C, 2) int16; error up to 0.0038 degrees.
    fn normal_to_octahedral(normals: [f32; 3]) -> [i16; 2];
    /// (C, 2) int16 to (C, 3) float32.
    fn normal_from_octahedral(codes: [i16; 2]) -> [f32; 3];
}

/// (C,) uint32 to (C, 4) float32, not normalised.
#[pyfunction]
pub fn tangent_from_snorm10<'py>(py: Python<'py>, codes: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let codes = self::codes::<u32, 1>(codes)?;
    let tangents = mapped(py, codes.packed()?, |[code]| encode::tangent_from_snorm10(code));
    Ok(rows_array(py, tangents)?.into_any())
}

/// (C, 3) and (C, 4) float32 to (C,) uint16: the angle around the normal. The decoder must get exactly the
/// same normal.
///
/// The error is up to 0.0071 degrees.
#[pyfunction]
pub fn tangent_to_diamond<'py>(
    py: Python<'py>,
    normals: &Bound<'py, PyAny>,
    tangents: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let (normals, tangents) = (rows("normals", normals)?, rows("tangents", tangents)?);
    let tangents = ("tangents", &*tangents.packed()?);
    let codes = mapped_pairs(py, &normals.packed()?, tangents, encode::tangent_to_diamond)?;
    Ok(PyArray1::from_vec(py, codes).into_any())
}

/// (C, 3) float32, exactly the normals given to the encoder, and (C,) uint16 to (C, 4) float32.
#[pyfunction]
pub fn tangent_from_diamond<'py>(
    py: Python<'py>,
    normals: &Bound<'py, PyAny>,
    codes: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let (normals, codes) = (rows("normals", normals)?, self::codes(codes)?);
    let decode = |normal, [code]: [u16; 1]| encode::tangent_from_diamond(normal, code);
    let tangents = mapped_pairs(py, &normals.packed()?, ("codes", codes.packed()?), decode)?;
    Ok(rows_array(py, tangents)?.into_any())
}

/// (C, 3) and (C, 4) float32 to (C, 4) int16: the whole frame as a quaternion; error up to 0.0047 degrees.
#[pyfunction]
pub fn frame_to_quaternion<'py>(
    py: Python<'py>,
    normals: &Bound<'py, PyAny>,
    tangents: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let (normals, tangents) = (rows("normals", normals)?, rows("tangents", tangents)?);
    let tangents = ("tangents", &*tangents.packed()?);
    let codes = mapped_pairs(py, &normals.packed()?, tangents, encode::frame_to_quaternion)?;
    Ok(rows_array(py, codes)?.into_any())
}

/// (C, 4) int16 to normals (C, 3) and tangents (C, 4), float32.
#[pyfunction]
pub fn frame_from_quaternion<'py>(py: Python<'py>, codes: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let codes = self::codes(codes)?;
    let codes = codes.packed()?;
    let (normals, tangents) = py.detach(|| codes.iter().copied().map(encode::frame_from_quaternion).unzip());
    (rows_array(py, normals)?, rows_array(py, tangents)?).into_pyobject(py).map(Bound::into_any)
}
