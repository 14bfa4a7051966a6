//! Splits vertices, so that values per corner become values per vertex of an indexed mesh.

use darboux::{CornerNormalsRef, CornerTangentsRef, Faces, Mesh, Strided};
use numpy::PyArray1;
use numpy::prelude::*;
use pyo3::exceptions::{PyMemoryError, PyValueError};
use pyo3::prelude::*;

use crate::arrays::{Rows, rows_array};
use crate::mesh::{IndexArray, value_error};
use crate::numbers::VertexCount;
use crate::results::named;

/// Split the vertices whose corners need different tangents, into as few vertices as possible.
///
/// One vertex per distinct pair of old vertex and tangent (all four floats compared as bits; NaN equals NaN).
/// Old vertices keep their number, new ones come after them. Copy all other attributes with the source table:
/// new = old[split.source_of_vertex].
///
/// Parameters
/// ----------
/// indices : (C,), (F, 3) or (F, 4) array_like of integers
///     The vertex of each corner.
/// tangents : (C, 4) array_like
///     One per corner, from generate_tangents.
/// vertex_count : int
///     V, the number of vertices, including unused ones.
///
/// Returns
/// -------
/// VertexSplit(tangent_of_vertex (W, 4) float32, indices uint32 of the old shape, source_of_vertex (W,)
/// uint32); vertices that no corner uses get (1, 0, 0, 1)
///
/// Raises
/// ------
/// TypeError, ValueError
///     As for generate_tangents; the number of tangents differs from the number of corners.
#[pyfunction]
pub fn split_vertices<'py>(
    py: Python<'py>,
    indices: &Bound<'py, PyAny>,
    tangents: &Bound<'py, PyAny>,
    vertex_count: VertexCount,
) -> PyResult<Bound<'py, PyAny>> {
    let VertexCount(vertex_count) = vertex_count;
    let indices = IndexArray::new(Some(indices))?;
    let tangents = Rows::new("tangents", "C", tangents)?;
    let tangents = tangents.packed()?;
    check_corners(&indices, "tangents", tangents.len())?;
    check_vertex_count(vertex_count, tangents.len())?;
    let list = indices.view();
    let split = py.detach(|| {
        // Splitting needs only the vertex count and the corners, here as one large face.
        let (nothing, uvs) =
            (Strided::repeated(&[0.0; 3], vertex_count), Strided::repeated(&[0.0; 2], vertex_count));
        let size = [tangents.len() as u32];
        let mesh = Mesh::with_faces(nothing, nothing, uvs, list, Faces::Mixed(&size))?;
        darboux::split_vertices(&mesh, CornerTangentsRef::from_per_corner(&tangents))
    });
    let split = split.map_err(value_error)?;
    let fields = (
        rows_array(py, split.tangent_of_vertex)?,
        PyArray1::from_vec(py, split.indices).reshape(indices.shape)?,
        PyArray1::from_vec(py, split.source_of_vertex),
    );
    named(py, "VertexSplit", fields)
}

/// Split the vertices whose corners have different normals, as split_vertices does for tangents.
///
/// Parameters
/// ----------
/// indices : (C,), (F, 3) or (F, 4) array_like of integers
///     The vertex of each corner.
/// normals : (C, 3) array_like
///     One per corner, from generate_normals.
/// vertex_count : int
///     V, the number of vertices, including unused ones.
///
/// Returns
/// -------
/// NormalSplit(normal_of_vertex (W, 3) float32, indices uint32 of the old shape, source_of_vertex (W,)
/// uint32); vertices that no corner uses get (0, 0, 1)
///
/// Raises
/// ------
/// TypeError, ValueError
///     As for generate_tangents; the number of normals differs from the number of corners.
#[pyfunction]
pub fn split_normals<'py>(
    py: Python<'py>,
    indices: &Bound<'py, PyAny>,
    normals: &Bound<'py, PyAny>,
    vertex_count: VertexCount,
) -> PyResult<Bound<'py, PyAny>> {
    let VertexCount(vertex_count) = vertex_count;
    let indices = IndexArray::new(Some(indices))?;
    let normals = Rows::new("normals", "C", normals)?;
    let normals = normals.packed()?;
    check_corners(&indices, "normals", normals.len())?;
    check_vertex_count(vertex_count, normals.len())?;
    let list = indices.view();
    let split = py
        .detach(|| darboux::split_normals(vertex_count, list, CornerNormalsRef::from_per_corner(&normals)))
        .map_err(value_error)?;
    let fields = (
        rows_array(py, split.normal_of_vertex)?,
        PyArray1::from_vec(py, split.indices).reshape(indices.shape)?,
        PyArray1::from_vec(py, split.source_of_vertex),
    );
    named(py, "NormalSplit", fields)
}

/// Vertex buffers up to this size may belong to any number of corners.
const MAX_UNUSED_VERTICES: usize = 1 << 24;

/// The largest number of vertices per corner beyond that: results have one row per vertex, and a wrong count
/// must not take all memory.
const MAX_VERTICES_PER_CORNER: usize = 64;

/// Errors: far more vertices than the corners could use, or more than there is memory for.
fn check_vertex_count(vertex_count: usize, corners: usize) -> PyResult<()> {
    if vertex_count > MAX_UNUSED_VERTICES.max(corners.saturating_mul(MAX_VERTICES_PER_CORNER)) {
        return Err(PyValueError::new_err(format!(
            "vertex_count is {vertex_count}, more than {MAX_VERTICES_PER_CORNER} times the {corners} \
             corners; pass the number of vertices of this mesh"
        )));
    }
    // Bytes per vertex: a tangent, its source and a link.
    if Vec::<[u32; 6]>::new().try_reserve_exact(vertex_count).is_ok() {
        return Ok(());
    }
    Err(PyMemoryError::new_err(format!("vertex_count is {vertex_count}; there is not enough memory")))
}

/// Errors: the number of values differs from the number of corners.
fn check_corners(indices: &IndexArray, what: &'static str, found: usize) -> PyResult<()> {
    match indices.len() {
        Some(expected) if expected != found => {
            Err(value_error(darboux::Error::InputLength { what, expected, found }))
        }
        _ => Ok(()),
    }
}
