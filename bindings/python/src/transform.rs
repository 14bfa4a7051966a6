//! Frames under the matrix of a node and under the bones of a skin.

use darboux::Transform;
use numpy::prelude::*;
use numpy::{PyArray2, PyReadonlyArrayDyn, PyUntypedArray};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::{Rows, array_of, packed, rows_array, shape_text, wrong_type};
use crate::mesh::unsigned;
use crate::results::named;

/// The images of the x, y and z directions.
type Columns = [[f32; 3]; 3];

/// Transform normals and tangents by a node's matrix, which may mirror or scale non-uniformly.
///
/// Tangents transform by the matrix, normals by its inverse transpose, and w changes its sign where the
/// matrix mirrors. A normal that the matrix maps to zero does not change; a tangent that it maps to zero
/// becomes a perpendicular of the normal.
///
/// Parameters
/// ----------
/// matrix : (3, 3), (3, 4) or (4, 4) array_like
///     For column vectors: new = matrix @ old. Only the upper left 3 by 3 is read. The matrices of glTF are
///     stored by columns: transpose them.
/// normals : (V, 3) array_like
///     Unit length.
/// tangents : (V, 4) array_like
///     Unit xyz and the sign w, one per normal.
///
/// Returns
/// -------
/// TransformedFrames
///     Unit normals, unit tangents perpendicular to them, and the orientation.
///
/// Raises
/// ------
/// TypeError, ValueError
///     Another type or shape; another number of tangents than normals.
#[pyfunction]
pub fn transform_frames<'py>(
    py: Python<'py>,
    matrix: &Bound<'py, PyAny>,
    normals: &Bound<'py, PyAny>,
    tangents: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let matrices = matrices("matrix", matrix, 0)?;
    let transform = Transform::new(matrices.first().copied().unwrap_or_default());
    let frames = FrameArrays::new(normals, tangents)?;
    let (normals, tangents) = frames.map(py, |_, normal, tangent| transform.frame(normal, tangent))?;
    named(py, "TransformedFrames", (normals, tangents, transform.orientation()))
}

/// Transform normals and tangents by a skin: each by the weighted mean of its bones' matrices.
///
/// The change of the weights over the surface is ignored, as is common practice, so normals of strongly bent
/// skins are approximate. Source: B. Merry et al., "Normal Transformations for Articulated Models", SIGGRAPH
/// Sketches 2006.
///
/// Parameters
/// ----------
/// bones : (B, 3, 3), (B, 3, 4) or (B, 4, 4) array_like
///     The matrix of each bone, from the pose of the given frames to the current pose, for column vectors as
///     in transform_frames.
/// joints : (V, K) array_like of integers
///     The bones of each vertex.
/// weights : (V, K) array_like
///     The weight of each of these bones.
/// normals, tangents
///     As in transform_frames.
///
/// Returns
/// -------
/// tuple of (V, 3) and (V, 4) ndarray
///     Unit normals, and unit tangents perpendicular to them.
///
/// Raises
/// ------
/// TypeError, ValueError
///     As transform_frames; a joint that is not below the number of bones.
#[pyfunction]
pub fn skin_frames<'py>(
    py: Python<'py>,
    bones: &Bound<'py, PyAny>,
    joints: &Bound<'py, PyAny>,
    weights: &Bound<'py, PyAny>,
    normals: &Bound<'py, PyAny>,
    tangents: &Bound<'py, PyAny>,
) -> PyResult<FramesOut<'py>> {
    let bones = matrices("bones", bones, 1)?;
    let frames = FrameArrays::new(normals, tangents)?;
    let Influences { joints, weights, width } = Influences::new(joints, weights, frames.len()?, bones.len())?;
    let skin = Skin { bones, joints: &joints, weights: weights.as_slice()?, width };
    frames.map(py, |vertex, normal, tangent| skin.transform(vertex).frame(normal, tangent))
}

/// The upper left 3 by 3 of every matrix, by columns. `stacked`: the number of dimensions before those of a
/// matrix.
fn matrices(name: &str, value: &Bound<'_, PyAny>, stacked: usize) -> PyResult<Vec<Columns>> {
    let array = array_of(name, value)?;
    let shape = array.shape().to_vec();
    let (width, height) = match shape.get(stacked..) {
        Some(&[height @ (3 | 4), width @ (3 | 4)]) if height <= width => (width, height),
        _ => {
            let stack = if stacked == 0 { "" } else { "B, " };
            let shape = shape_text(&shape);
            return Err(PyValueError::new_err(format!(
                "{name} must have shape ({stack}3, 3), ({stack}3, 4) or ({stack}4, 4), not {shape}"
            )));
        }
    };
    let floats = real_numbers(name, &array)?;
    let matrices = floats.as_slice()?.chunks_exact(width * height);
    Ok(matrices.map(|rows| [0, 1, 2].map(|column| [0, 1, 2].map(|row| rows[row * width + column]))).collect())
}

/// The array as packed floats. Errors: its elements are not real numbers.
fn real_numbers<'py>(
    name: &str,
    array: &Bound<'py, PyUntypedArray>,
) -> PyResult<PyReadonlyArrayDyn<'py, f32>> {
    match array.dtype().kind() {
        b'f' | b'i' | b'u' => packed(array),
        _ => Err(wrong_type(name, "real numbers", array)),
    }
}

/// The bones and weights of all vertices.
struct Influences<'py> {
    joints: Vec<u32>,
    weights: PyReadonlyArrayDyn<'py, f32>,
    /// The number of bones per vertex.
    width: usize,
}

impl<'py> Influences<'py> {
    /// Errors: shapes that differ, a joint that is not below the number of bones.
    fn new(
        joints: &Bound<'py, PyAny>,
        weights: &Bound<'py, PyAny>,
        vertices: usize,
        bones: usize,
    ) -> PyResult<Self> {
        let (joints, weights) = (array_of("joints", joints)?, array_of("weights", weights)?);
        for (name, array) in [("joints", &joints), ("weights", &weights)] {
            let shape = array.shape();
            if shape.len() != 2 || shape[0] != vertices || shape != joints.shape() {
                let (shape, other) = (shape_text(shape), shape_text(joints.shape()));
                return Err(PyValueError::new_err(format!(
                    "{name} has shape {shape} beside {vertices} normals and joints of shape {other}; both \
                     must be (V, K)"
                )));
            }
        }
        let width = joints.shape()[1];
        let (joints, weights) = (unsigned("joints", &joints)?, real_numbers("weights", &weights)?);
        match joints.iter().position(|&joint| joint as usize >= bones) {
            None => Ok(Self { joints, weights, width }),
            Some(at) => Err(PyValueError::new_err(format!(
                "joint {} of vertex {} is out of range: there are {bones} bones",
                joints[at],
                at / width
            ))),
        }
    }
}

/// What a thread without the GIL needs of a skin.
struct Skin<'a> {
    bones: Vec<Columns>,
    joints: &'a [u32],
    weights: &'a [f32],
    width: usize,
}

impl Skin<'_> {
    fn transform(&self, vertex: usize) -> Transform {
        let row = vertex * self.width..(vertex + 1) * self.width;
        let bones = self.joints[row.clone()].iter().map(|&joint| self.bones[joint as usize]);
        Transform::blended(bones.zip(self.weights[row].iter().copied()))
    }
}

/// Unit normals and tangents of the same vertices.
struct FrameArrays<'py> {
    normals: Rows<'py, 3>,
    tangents: Rows<'py, 4>,
}

/// Arrays of shape (V, 3) and (V, 4).
type FramesOut<'py> = (Bound<'py, PyArray2<f32>>, Bound<'py, PyArray2<f32>>);

impl<'py> FrameArrays<'py> {
    fn new(normals: &Bound<'py, PyAny>, tangents: &Bound<'py, PyAny>) -> PyResult<Self> {
        let arrays = Self {
            normals: Rows::new("normals", "V", normals)?,
            tangents: Rows::new("tangents", "V", tangents)?,
        };
        let (normals, tangents) = (arrays.len()?, arrays.tangents.view()?.len());
        if normals != tangents {
            return Err(PyValueError::new_err(format!(
                "tangents has {tangents} elements but there are {normals} normals"
            )));
        }
        Ok(arrays)
    }

    fn len(&self) -> PyResult<usize> {
        Ok(self.normals.view()?.len())
    }

    /// Applies `moved` to the number, normal and tangent of each vertex, without the GIL.
    fn map(
        &self,
        py: Python<'py>,
        moved: impl Fn(usize, [f32; 3], [f32; 4]) -> ([f32; 3], [f32; 4]) + Sync,
    ) -> PyResult<FramesOut<'py>> {
        let (normals, tangents) = (self.normals.packed()?, self.tangents.packed()?);
        let pairs = normals.iter().zip(tangents.iter()).enumerate();
        let (normals, tangents): (Vec<_>, Vec<_>) =
            py.detach(|| pairs.map(|(vertex, (&normal, &tangent))| moved(vertex, normal, tangent)).unzip());
        Ok((rows_array(py, normals)?, rows_array(py, tangents)?))
    }
}
