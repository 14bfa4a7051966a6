//! Computes tangents per corner.

use std::sync::Mutex;

use darboux::{Context, Mesh, TangentOptions, generate_compact_frames};
use numpy::prelude::*;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::choices::{is_slow, tangent_options};
use crate::mesh::MeshArrays;
use crate::numbers::{Threads, degrees};
use crate::out::{Target, fresh};
use crate::results::{self, named};
use crate::threads::cancellable;

/// Compute the tangent of every corner: unit xyz and the sign w, bitangent = w * cross(normal, xyz).
///
/// The result is per corner, not per vertex. Corners of one vertex can have different tangents (at mirrored
/// seams they do), so they cannot be written through the mesh's indices: split_vertices returns vertices and
/// new indices. Without indices, corners are vertices.
///
/// Parameters
/// ----------
/// positions, normals : (V, 3) array_like
///     Any real type; computed in float32. Normals should have unit length; they are used as given.
/// uvs : (V, 2) array_like
/// indices : (C,), (F, 3) or (F, 4) array_like of integers, optional
///     The vertex of each corner. Without, every vertex is a corner of its own.
/// faces : 3, 4 or (F,) array_like of integers, optional
///     Corners per face. By default indices of shape (F, 4) are quads and all others triangles. Faces with
///     more corners get tangents from their normals only, and are counted.
/// method : str
///     'mikktspace', which bakers use, or another method that `darboux methods` lists.
/// mode : str
///     For 'mikktspace'. 'reference': the bits of mikktspace.c, its defects included; 'repaired': the same,
///     with unusable tangents replaced; 'corrected': repaired, and the known defects corrected.
/// threshold : float
///     For 'mikktspace', in degrees: faces around a vertex share a tangent if their tangents and bitangents
///     differ by less. Below 180 the faces are compared in pairs: a vertex with 20,000 faces takes about 2 s,
///     one with 100,000 about a minute.
/// full : bool
///     Return Frames instead: tangent, bitangent and magnitude.
/// threads : int, optional
///     The number of threads for large meshes; by default all hardware threads. The result does not depend on
///     it.
/// out : (C, 4) float32 array, optional
///     The result is written here and returned. Calls with `out` reuse their working memory.
/// return_report : bool
///     Return (result, Report). The report counts non-finite and degenerate input and more.
///
/// Returns
/// -------
/// (C, 4) float32 array; with `full` Frames(tangent (C, 4), bitangent (C, 3), magnitude (C, 2))
///
/// Raises
/// ------
/// TypeError
///     An array of another kind of elements.
/// ValueError
///     Wrong shapes, lengths that differ, an index out of range, corners that are not whole faces.
///
/// float32 arrays that are packed, or whose packed rows lie at equal distances in a packed array, are not
/// copied; nor are packed uint16 and uint32 indices.
#[pyfunction]
#[pyo3(signature = (
    positions, normals, uvs, indices=None, *, faces=None, method="mikktspace", mode="repaired", threshold=180.0,
    full=false, threads=None, out=None, return_report=false
))]
#[expect(clippy::too_many_arguments, reason = "Python passes them by name")]
pub fn generate_tangents<'py>(
    py: Python<'py>,
    positions: &Bound<'py, PyAny>,
    normals: &Bound<'py, PyAny>,
    uvs: &Bound<'py, PyAny>,
    indices: Option<&Bound<'py, PyAny>>,
    faces: Option<&Bound<'py, PyAny>>,
    method: &str,
    mode: &str,
    #[pyo3(from_py_with = degrees)] threshold: f32,
    full: bool,
    threads: Option<Threads>,
    out: Option<&Bound<'py, PyAny>>,
    return_report: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let options = tangent_options(method, mode, threshold)?;
    if full && out.is_some() {
        return Err(PyValueError::new_err("out holds tangents alone; leave out either full or out"));
    }
    let arrays = MeshArrays::new(positions, normals, uvs, indices, faces)?;
    let mesh = arrays.view()?;
    let (result, report) = if full {
        frames(py, threads, &mesh, &options)?
    } else {
        let (corners, keeps) = (mesh.corner_count(), out.is_some());
        Target::new(py, out, corners)?.fill(py, |out| {
            let mut context = if keeps { take_context() } else { Context::new() };
            let write = |context: &mut Context| darboux::write_tangents(&mesh, &options, context, out);
            let report = cancellable(py, threads, (corners, is_slow(&options)), &mut context, write);
            if keeps {
                keep_context(context);
            }
            report
        })?
    };
    if return_report {
        (result, results::report(py, &report)?).into_pyobject(py).map(Bound::into_any)
    } else {
        Ok(result)
    }
}

/// The context that calls with `out` reuse, so that repeated calls allocate nothing. A call that runs at the
/// same time as another one makes a context of its own.
static KEPT_CONTEXT: Mutex<Option<Context>> = Mutex::new(None);

fn take_context() -> Context {
    KEPT_CONTEXT.try_lock().ok().and_then(|mut kept| kept.take()).unwrap_or_default()
}

fn keep_context(context: Context) {
    if let Ok(mut kept) = KEPT_CONTEXT.try_lock() {
        *kept = Some(context);
    }
}

/// Whole frames as arrays, and the report.
fn frames<'py>(
    py: Python<'py>,
    threads: Option<Threads>,
    mesh: &Mesh<'_>,
    options: &TangentOptions,
) -> PyResult<(Bound<'py, PyAny>, darboux::Report)> {
    let corners = mesh.corner_count();
    let (tangents, bitangents, magnitudes) =
        (fresh(py, corners, 4)?, fresh(py, corners, 3)?, fresh(py, corners, 2)?);
    let report = {
        let (mut tangents, mut bitangents, mut magnitudes) =
            (tangents.try_readwrite()?, bitangents.try_readwrite()?, magnitudes.try_readwrite()?);
        let tangents = tangents.as_slice_mut()?.as_chunks_mut().0;
        let bitangents = bitangents.as_slice_mut()?.as_chunks_mut().0;
        let magnitudes = magnitudes.as_slice_mut()?.as_chunks_mut().0;
        let write = |context: &mut Context| {
            let frames = generate_compact_frames(mesh, options, context)?;
            frames.read_apart(tangents, bitangents, magnitudes)?;
            Ok(frames.report())
        };
        cancellable(py, threads, (corners, is_slow(options)), &mut Context::new(), write)?
    };
    Ok((named(py, "Frames", (tangents, bitangents, magnitudes))?, report))
}
