//! The mesh arguments of a call. Arrays of floats stay borrowed while the core reads them; indices are
//! copied.

use std::fmt::Display;

use darboux::{Faces, Indices, Mesh};
use numpy::prelude::*;
use numpy::{Element, PyUntypedArray};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::{Rows, array_of, packed, shape_text, wrong_type};

/// The array arguments of a mesh.
pub struct MeshArrays<'py> {
    positions: Rows<'py, 3>,
    normals: Rows<'py, 3>,
    pub uvs: Rows<'py, 2>,
    indices: IndexArray,
    pub faces: FaceSizes,
}

impl<'py> MeshArrays<'py> {
    pub fn new(
        positions: &Bound<'py, PyAny>,
        normals: &Bound<'py, PyAny>,
        uvs: &Bound<'py, PyAny>,
        indices: Option<&Bound<'py, PyAny>>,
        faces: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Self> {
        let positions = Rows::new("positions", "V", positions)?;
        let normals = Rows::new("normals", "V", normals)?;
        let uvs = Rows::new("uvs", "V", uvs)?;
        let indices = IndexArray::new(indices)?;
        let faces = FaceSizes::new(faces, &indices, positions.view()?.len())?;
        Ok(Self { positions, normals, uvs, indices, faces })
    }

    /// The mesh as a view for the core.
    pub fn view(&self) -> PyResult<Mesh<'_>> {
        let (positions, normals, uvs) = (self.positions.view()?, self.normals.view()?, self.uvs.view()?);
        Mesh::with_faces(positions, normals, uvs, self.indices.view(), self.faces.view()).map_err(value_error)
    }
}

/// Converts an error of the core to a ValueError.
pub fn value_error(error: darboux::Error) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// A copy of the indices; `None` if corner i is vertex i.
pub fn owned(indices: Indices<'_>) -> Option<Vec<u32>> {
    match indices {
        Indices::Unindexed => None,
        Indices::U16(list) => Some(list.iter().map(|&index| index.into()).collect()),
        Indices::U32(list) => Some(list.to_vec()),
    }
}

/// A copy of the indices. They are never borrowed: the core checks once that they are in range, and another
/// thread of the program could change numpy's memory after that.
pub struct IndexArray {
    list: IndexList,
    /// Their shape in Python.
    pub shape: Vec<usize>,
}

enum IndexList {
    Absent,
    U16(Vec<u16>),
    U32(Vec<u32>),
}

impl IndexArray {
    /// Indices of shape (C,), (F, 3) or (F, 4), of any integer type; `None` if corner i is vertex i.
    pub fn new(value: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let Some(value) = value else { return Ok(Self { list: IndexList::Absent, shape: Vec::new() }) };
        let array = array_of("indices", value)?;
        let shape = array.shape().to_vec();
        if !matches!(shape[..], [_] | [_, 3 | 4]) {
            let shape = shape_text(&shape);
            return Err(PyValueError::new_err(format!(
                "indices must have shape (C,), (F, 3) or (F, 4), not {shape}"
            )));
        }
        Ok(Self { list: IndexList::new(&array)?, shape })
    }

    /// The number of corners, if there are indices.
    pub fn len(&self) -> Option<usize> {
        (!matches!(self.list, IndexList::Absent)).then(|| self.shape.iter().product())
    }

    pub fn view(&self) -> Indices<'_> {
        match &self.list {
            IndexList::Absent => Indices::Unindexed,
            IndexList::U16(list) => Indices::U16(list),
            IndexList::U32(list) => Indices::U32(list),
        }
    }
}

impl IndexList {
    fn new(array: &Bound<'_, PyUntypedArray>) -> PyResult<Self> {
        let dtype = array.dtype();
        Ok(match (dtype.kind(), dtype.itemsize()) {
            (b'u', 2) => Self::U16(copied(array)?),
            (b'u', 4) => Self::U32(copied(array)?),
            (b'u' | b'i', _) => Self::U32(unsigned("indices", array)?),
            // numpy converts an empty list to floats.
            _ if array.is_empty() => Self::U32(Vec::new()),
            _ => return Err(wrong_type("indices", "integers", array)),
        })
    }
}

/// A copy of the elements.
fn copied<T: Element + Copy + Send + Sync>(array: &Bound<'_, PyUntypedArray>) -> PyResult<Vec<T>> {
    let packed = packed::<T>(array)?;
    let elements = packed.as_slice()?;
    Ok(array.py().detach(|| elements.to_vec()))
}

/// The elements of an array of integers as 32-bit ones.
pub fn unsigned(name: &str, array: &Bound<'_, PyUntypedArray>) -> PyResult<Vec<u32>> {
    let dtype = array.dtype();
    match (dtype.kind(), dtype.itemsize()) {
        (b'u', 8) => narrowed::<u64>(name, array, |number| number),
        (b'u' | b'i', _) => narrowed::<i64>(name, array, |number| number as u64),
        _ => Err(wrong_type(name, "integers", array)),
    }
}

/// Negative numbers become large ones, which the core refuses.
fn narrowed<T: Element + Copy + Display + Sync>(
    name: &str,
    array: &Bound<'_, PyUntypedArray>,
    bits: fn(T) -> u64,
) -> PyResult<Vec<u32>> {
    let array = packed::<T>(array)?;
    let numbers = array.as_slice()?;
    let narrow = || match numbers.iter().position(|&number| bits(number) > u32::MAX.into()) {
        None => Ok(numbers.iter().map(|&number| bits(number) as u32).collect()),
        Some(at) => Err(at),
    };
    match array.py().detach(narrow) {
        Ok(narrowed) => Ok(narrowed),
        Err(at) => Err(PyValueError::new_err(format!(
            "{name} holds {} at place {at}, which is not a 32-bit unsigned number",
            numbers[at]
        ))),
    }
}

/// The corner counts of faces.
pub enum FaceSizes {
    Triangles,
    Quads,
    Mixed(Vec<u32>),
}

impl FaceSizes {
    /// Corner counts as `faces` gives them: 3, 4 or one number per face. Without, indices of shape (F, 4) are
    /// quads and all else triangles.
    pub fn new(
        value: Option<&Bound<'_, PyAny>>,
        indices: &IndexArray,
        vertex_count: usize,
    ) -> PyResult<Self> {
        let Some(value) = value else {
            return Ok(if matches!(indices.shape[..], [_, 4]) { Self::Quads } else { Self::Triangles });
        };
        match value.extract::<u32>() {
            Ok(3) => return Ok(Self::Triangles),
            Ok(4) => return Ok(Self::Quads),
            _ => {}
        }
        let array = array_of("faces", value)?;
        if array.ndim() != 1 {
            return Err(PyValueError::new_err("faces must be 3, 4 or one corner count per face, shape (F,)"));
        }
        if array.is_empty() {
            return Ok(Self::Mixed(Vec::new()));
        }
        let sizes = unsigned("faces", &array)?;
        // The core is faster if all faces have the same size. It also checks that the counts add up.
        let corners = indices.len().unwrap_or(vertex_count);
        let all_are =
            |size: u32| corners == sizes.len() * size as usize && sizes.iter().all(|&it| it == size);
        Ok(if all_are(3) {
            Self::Triangles
        } else if all_are(4) {
            Self::Quads
        } else {
            Self::Mixed(sizes)
        })
    }

    pub fn view(&self) -> Faces<'_> {
        match self {
            Self::Triangles => Faces::Triangles,
            Self::Quads => Faces::Quads,
            Self::Mixed(sizes) => Faces::Mixed(sizes),
        }
    }
}
