//! Converts vertex data and normal maps between conventions.

use darboux::{Channel, Convention, Conversion, TexelLayout};
use numpy::prelude::*;
use numpy::{Element, PyArray1, PyUntypedArray};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

use crate::arrays::{Rows, array_of, packed, rows_array, shape_text};
use crate::mesh::{FaceSizes, IndexArray, owned};
use crate::results::named;

/// The convention that a text describes: a preset, and changes after commas. `what` is the argument.
pub fn convention(what: &str, text: &str) -> PyResult<Convention> {
    text.parse().map_err(|error| PyValueError::new_err(format!("{what}: {error}")))
}

/// Convert vertex data from one convention to another. The surface, its texture and its lighting do not
/// change.
///
/// The w of tangents from generate_tangents is MikkTSpace's sign, which is not yet in any program's
/// convention. For these, pass the convention of the mesh as source, and `generated=True`. Even from 'gltf'
/// to 'gltf' this negates w, because v points down in glTF.
///
/// Parameters
/// ----------
/// source, target : str
///     One of CONVENTIONS, optionally with changes: 'gltf,green=down'. The changes are axes=-x/y/z (right,
///     up, front), fronts=ccw or cw, v0=bottom or top, red=right or left, green=up or down, w=n-cross-t or
///     t-cross-n.
/// positions, normals : (V, 3) array_like, optional
///     Vectors; offsets of morph targets are converted in the same way.
/// uvs : (V, 2) array_like, optional
/// indices : (C,), (F, 3) or (F, 4) array_like of integers, optional
///     All corners of a face but the first are reversed if the order of front faces differs.
/// tangents : (V, 4) array_like, optional
///     One per vertex.
/// faces : 3, 4 or (F,) array_like of integers, optional
///     As for generate_tangents.
/// generated : bool
///     True if the tangents come from generate_tangents on a mesh in the source convention.
///
/// Returns
/// -------
/// Converted
///     New arrays, None for missing arguments; and whether the red and green channels of the normal map must
///     be inverted.
///
/// Raises
/// ------
/// TypeError, ValueError
///     As generate_tangents; an unknown convention.
#[pyfunction]
#[pyo3(signature = (
    source, target, *, positions=None, normals=None, uvs=None, indices=None, tangents=None, faces=None, generated=false
))]
#[expect(clippy::too_many_arguments, reason = "Python passes them by name")]
pub fn convert<'py>(
    py: Python<'py>,
    source: &str,
    target: &str,
    positions: Option<&Bound<'py, PyAny>>,
    normals: Option<&Bound<'py, PyAny>>,
    uvs: Option<&Bound<'py, PyAny>>,
    indices: Option<&Bound<'py, PyAny>>,
    tangents: Option<&Bound<'py, PyAny>>,
    faces: Option<&Bound<'py, PyAny>>,
    generated: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let (source, target) = (convention("source", source)?, convention("target", target)?);
    let change = source.to(target);
    let of_tangents = if generated { source.generated().to(target) } else { change };
    let fields = (
        mapped(py, "positions", positions, |vector| change.vector(vector))?,
        mapped(py, "normals", normals, |vector| change.vector(vector))?,
        mapped(py, "uvs", uvs, |uv| change.uv(uv))?,
        indices.map(|indices| converted_indices(py, indices, faces, &change)).transpose()?,
        mapped(py, "tangents", tangents, |tangent| of_tangents.tangent(tangent))?,
        change.inverts_red(),
        change.inverts_green(),
    );
    named(py, "Converted", fields)
}

/// Convert the texels of a normal map from one convention to another: red and green are inverted where the
/// conventions differ.
///
/// The conversion is exact, so that converting back restores the texels. The image is not flipped.
///
/// Parameters
/// ----------
/// texels : (H, W, 2), (H, W, 3) or (H, W, 4) array_like of uint8 or uint16
///     x and y in the first channels. The other channels do not change.
/// source, target : str
///     As in convert.
///
/// Returns
/// -------
/// ndarray
///     A new array of the same shape and type.
///
/// Raises
/// ------
/// TypeError, ValueError
///     Another type or shape, an unknown convention.
#[pyfunction]
pub fn convert_texels<'py>(
    texels: &Bound<'py, PyAny>,
    source: &str,
    target: &str,
) -> PyResult<Bound<'py, PyAny>> {
    let change = convention("source", source)?.to(convention("target", target)?);
    let array = array_of("texels", texels)?;
    if !matches!(array.shape(), [_, _, 2..=4]) {
        let shape = shape_text(array.shape());
        return Err(PyValueError::new_err(format!("texels must have shape (H, W, 2 to 4), not {shape}")));
    }
    match (array.dtype().kind(), array.dtype().itemsize()) {
        (b'u', 1) => converted_texels::<u8>(&array, &change),
        (b'u', 2) => converted_texels::<u16>(&array, &change),
        _ => {
            let kind = array.dtype();
            Err(PyTypeError::new_err(format!("texels must hold uint8 or uint16, not {kind}")))
        }
    }
}

fn converted_texels<'py, C: Channel + Element + Send + Sync>(
    texels: &Bound<'py, PyUntypedArray>,
    change: &Conversion,
) -> PyResult<Bound<'py, PyAny>> {
    let (py, shape) = (texels.py(), texels.shape().to_vec());
    let channels = packed::<C>(texels)?;
    let channels = channels.as_slice()?;
    let converted = py.detach(|| {
        let mut channels = channels.to_vec();
        match shape[2] {
            2 => change.texels(TexelLayout::RG, channels.as_chunks_mut().0),
            3 => change.texels(TexelLayout::RGB, channels.as_chunks_mut().0),
            _ => change.texels(TexelLayout::RGBA, channels.as_chunks_mut().0),
        }
        channels
    });
    Ok(PyArray1::from_vec(py, converted).reshape(shape)?.into_any())
}

fn mapped<'py, const N: usize>(
    py: Python<'py>,
    name: &str,
    rows: Option<&Bound<'py, PyAny>>,
    change: impl Fn([f32; N]) -> [f32; N] + Send,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    let Some(rows) = rows else { return Ok(None) };
    let rows = Rows::<N>::new(name, "V", rows)?;
    let rows = rows.packed()?;
    let converted = py.detach(|| rows.iter().copied().map(change).collect());
    Ok(Some(rows_array(py, converted)?.into_any()))
}

/// Indices grouped by face, in their original shape.
fn converted_indices<'py>(
    py: Python<'py>,
    indices: &Bound<'py, PyAny>,
    faces: Option<&Bound<'py, PyAny>>,
    change: &Conversion,
) -> PyResult<Bound<'py, PyAny>> {
    let indices = IndexArray::new(Some(indices))?;
    let view = indices.view();
    let sizes = FaceSizes::new(faces, &indices, 0)?;
    let converted = py.detach(|| {
        let mut list = owned(view).unwrap_or_default();
        convert_faces(&mut list, &sizes, change).map(|()| list)
    });
    let list = converted.map_err(PyValueError::new_err)?;
    Ok(PyArray1::from_vec(py, list).reshape(indices.shape)?.into_any())
}

/// Groups corners by face. Errors: the face sizes do not add up to the number of corners.
fn convert_faces(list: &mut [u32], sizes: &FaceSizes, change: &Conversion) -> Result<(), String> {
    let corners = list.len();
    let sizes: Box<dyn Iterator<Item = usize> + '_> = match sizes {
        FaceSizes::Triangles => Box::new(std::iter::repeat_n(3, corners.div_ceil(3))),
        FaceSizes::Quads => Box::new(std::iter::repeat_n(4, corners.div_ceil(4))),
        FaceSizes::Mixed(sizes) => Box::new(sizes.iter().map(|&size| size as usize)),
    };
    let mut rest = list;
    for size in sizes {
        let Some((face, others)) = std::mem::take(&mut rest).split_at_mut_checked(size) else {
            return Err(format!("{corners} corners do not make whole faces"));
        };
        change.face(face);
        rest = others;
    }
    match rest.len() {
        0 => Ok(()),
        over => Err(format!("faces leave {over} of {corners} corners over")),
    }
}
