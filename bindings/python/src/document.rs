//! glTF and GLB documents, read and written by darboux-io.

use std::borrow::Cow;
use std::path::PathBuf;
use std::sync::mpsc::Sender;

use darboux::{Cancel, Context};
use darboux_io::gltf::{self, AddNormalsOptions, AddTangentsOptions, IndexList, Progress, TangentEncoding};
use darboux_io::{LoadOptions, MemoryLimit, OptionNames, SaveOptions, memory_of_process};
use pyo3::exceptions::{PyIndexError, PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use serde::Serialize;

use crate::arrays::rows_array;
use crate::choices::{named_choice, tangent_options};
use crate::convention::convention;
use crate::normals::normal_options;
use crate::numbers::{Natural, degrees, place};
use crate::results::python_of;
use crate::threads::{check_progress, run_interruptibly};

/// A glTF document in memory: read by load, edited by its methods, written by save. Everything that no method
/// changes stays as it was.
#[pyclass(module = "darboux")]
pub struct Document {
    document: gltf::Document,
    /// True after an edit that failed or was cancelled: the document is incomplete and must not be used.
    is_half_done: bool,
}

/// Read a .glb or .gltf file and its buffers.
///
/// Parameters
/// ----------
/// path : path-like
/// allow_outside : bool
///     Also read files outside the document's folder.
/// memory_limit : int, optional
///     The most memory for decoding the file and computing from it, in MiB. By default 256 MiB plus 64 times
///     the size of the file, and at most what the process may still use by ulimit -v or its control groups.
///
/// Raises
/// ------
/// OSError
///     The file cannot be read.
/// ValueError
///     The file is broken or cannot be processed without loss; the message says where.
#[pyfunction]
#[pyo3(signature = (path, *, allow_outside=false, memory_limit=None))]
pub fn load(
    py: Python<'_>,
    path: PathBuf,
    allow_outside: bool,
    memory_limit: Option<Natural>,
) -> PyResult<Document> {
    let options = load_options(memory_limit).with_allow_outside(allow_outside);
    let document = py.detach(|| gltf::Document::open(&path, &options));
    Ok(Document { document: document.map_err(file_error)?, is_half_done: false })
}

/// Read a document from the bytes of a .glb or .gltf file.
///
/// Parameters
/// ----------
/// data : bytes
/// name : str
///     The name of the file in messages.
/// base : path-like, optional
///     The folder of external files. Without it, buffers must be embedded, and references to images stay as
///     they are.
/// memory_limit : int, optional
///     As in load.
///
/// Raises
/// ------
/// OSError, ValueError
///     As load.
#[pyfunction]
#[pyo3(signature = (data, *, name="<bytes>", base=None, memory_limit=None))]
pub fn loads(
    py: Python<'_>,
    data: Vec<u8>,
    name: &str,
    base: Option<PathBuf>,
    memory_limit: Option<Natural>,
) -> PyResult<Document> {
    let options = load_options(memory_limit);
    let document = py.detach(|| gltf::Document::from_bytes(name, data, base.as_deref(), &options));
    Ok(Document { document: document.map_err(file_error)?, is_half_done: false })
}

/// The options of the reader, with the names of Python's parameters for messages.
pub fn load_options(memory_limit: Option<Natural>) -> LoadOptions {
    let chosen = memory_limit.map(|Natural(mebibytes)| MemoryLimit::bytes(u64::from(mebibytes) << 20));
    // Measured for each call, because arrays of the program come and go.
    let limit = chosen.unwrap_or_else(|| MemoryLimit::of_process(memory_of_process()));
    let names = OptionNames::default()
        .with_memory_limit("memory_limit=")
        .with_allow_outside("allow_outside=True")
        .with_apply_texture_transform("apply_texture_transform=True");
    LoadOptions::default().with_memory_limit(limit).with_option_names(names)
}

/// Return a document as the bytes of a GLB with all its buffers and images, except remote and missing ones.
///
/// Raises
/// ------
/// OSError, ValueError
///     A referenced file cannot be read; the result exceeds 4 GiB.
#[pyfunction]
pub fn dumps<'py>(py: Python<'py>, document: PyRef<'py, Document>) -> PyResult<Bound<'py, PyBytes>> {
    let document = document.whole()?;
    let bytes = py.detach(|| document.to_glb()).map_err(file_error)?;
    Ok(PyBytes::new(py, &bytes))
}

/// Write a document. The extension selects the container: .glb, or .gltf with a .bin beside it.
///
/// Parameters
/// ----------
/// document : Document
/// path : path-like
///     Missing folders are created. The document's own input is refused.
/// force : bool
///     Replace a file that exists.
///
/// Returns
/// -------
/// list of pathlib.Path
///     The files written.
///
/// Raises
/// ------
/// OSError, ValueError
///     Nothing is written after an error.
#[pyfunction]
#[pyo3(signature = (document, path, *, force=false))]
pub fn save(
    py: Python<'_>,
    document: PyRef<'_, Document>,
    path: PathBuf,
    force: bool,
) -> PyResult<Vec<PathBuf>> {
    let document = document.whole()?;
    py.detach(|| document.save(&path, &SaveOptions::default().with_force(force))).map_err(file_error)
}

#[pymethods]
impl Document {
    /// True if the document differs from the file that was read.
    #[getter]
    fn is_changed(&self) -> bool {
        self.document.is_changed()
    }

    /// Warnings, one sentence each, such as missing images.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.document.warnings().to_vec()
    }

    /// The number of primitives of each mesh.
    #[getter]
    fn primitive_counts(&self) -> Vec<usize> {
        self.document.meshes().iter().map(|mesh| mesh.primitives.len()).collect()
    }

    /// Read the vertex data of a primitive.
    ///
    /// Parameters
    /// ----------
    /// mesh, primitive : int
    ///
    /// Returns
    /// -------
    /// dict
    ///     Per attribute, such as 'POSITION', a float32 array with one row per vertex (normalized integers
    ///     are decoded); 'indices', (C,) uint32, if the primitive has indices.
    ///
    /// Raises
    /// ------
    /// IndexError
    ///     No such primitive.
    /// ValueError
    ///     The data of an attribute is missing.
    #[pyo3(signature = (mesh=0, primitive=0))]
    fn arrays<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = place)] mesh: i64,
        #[pyo3(from_py_with = place)] primitive: i64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let meshes = self.whole()?.meshes();
        let found = usize::try_from(mesh).ok().and_then(|mesh| meshes.get(mesh));
        let found = usize::try_from(primitive).ok().and_then(|primitive| found?.primitives.get(primitive));
        let Some(found) = found else {
            let sentence =
                format!("meshes[{mesh}].primitives[{primitive}] does not exist; see primitive_counts");
            return Err(PyIndexError::new_err(sentence));
        };
        let arrays = PyDict::new(py);
        for (name, &accessor) in &found.attributes {
            arrays.set_item(name, self.vectors(py, accessor)?)?;
        }
        if let Some(accessor) = found.indices {
            let indices =
                py.detach(|| self.document.indices(accessor).map(IndexList::into_u32)).map_err(file_error)?;
            arrays.set_item("indices", numpy::PyArray1::from_vec(py, indices))?;
        }
        Ok(arrays)
    }

    /// Report on every primitive, and compute the tangents that it could have without writing them.
    ///
    /// Returns
    /// -------
    /// list of dict
    ///     The same as the reports of `darboux inspect --json`.
    fn inspect<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.whole()?;
        let document = &self.document;
        let infos = run_interruptibly(py, 0, |_| gltf::inspect(document), |(): ()| Ok(()), || ())?;
        python_of(py, &infos.map_err(file_error)?)
    }

    /// Add tangents to every triangle primitive that has positions, normals and UVs. Vertices are split where
    /// their corners need different tangents.
    ///
    /// After Ctrl-C or an error the document is unusable: load it again.
    ///
    /// Parameters
    /// ----------
    /// method, mode, threshold
    ///     As for generate_tangents.
    /// encoding : str
    ///     'f32x4', or 'snorm16x4' and 'snorm8x4', which need KHR_mesh_quantization.
    /// overwrite : bool
    ///     Replace tangents that exist.
    /// only_needed : bool
    ///     Only primitives whose material uses tangents.
    /// strict : bool
    ///     Refuse non-finite vertex data and corners without a usable tangent.
    /// apply_texture_transform : bool
    ///     Transform UVs by KHR_texture_transform first.
    /// progress : callable, optional
    ///     Called after each primitive with the number of processed triangles and their total.
    ///
    /// Returns
    /// -------
    /// dict
    ///     'primitives': one report per primitive; 'warnings'; 'totals'.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     The data of a primitive that needs tangents is broken.
    #[pyo3(signature = (
        *, method="mikktspace", mode="repaired", threshold=180.0, encoding="f32x4", overwrite=false, only_needed=false,
        strict=false, apply_texture_transform=false, progress=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python passes them by name")]
    fn add_tangents<'py>(
        &mut self,
        py: Python<'py>,
        method: &str,
        mode: &str,
        #[pyo3(from_py_with = degrees)] threshold: f32,
        encoding: &str,
        overwrite: bool,
        only_needed: bool,
        strict: bool,
        apply_texture_transform: bool,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let options = AddTangentsOptions::default()
            .with_tangents(tangent_options(method, mode, threshold)?)
            .with_encoding(named_choice::<TangentEncoding>(encoding)?)
            .with_overwrite(overwrite)
            .with_only_needed(only_needed)
            .with_strict(strict)
            .with_apply_texture_transform(apply_texture_transform);
        self.edit(py, progress, |document, context, report| {
            gltf::add_tangents_with(document, &options, context, gltf::Generate::OnCpu, report)
        })
    }

    /// Add normals to every triangle primitive. All primitives of a mesh are shaded as one surface.
    ///
    /// After Ctrl-C or an error the document is unusable: load it again.
    ///
    /// Parameters
    /// ----------
    /// shading, weight, crease, seams
    ///     As for generate_normals.
    /// overwrite : bool
    ///     Replace normals that exist.
    /// progress : callable, optional
    ///     Called with the number of processed triangles and their total.
    ///
    /// Returns
    /// -------
    /// dict
    ///     'primitives': one report per primitive; 'warnings'; 'written'.
    #[pyo3(signature = (
        *, shading="smooth", weight="angle", crease=180.0, seams="ignored", overwrite=false, progress=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "Python passes them by name")]
    fn add_normals<'py>(
        &mut self,
        py: Python<'py>,
        shading: &str,
        weight: &str,
        #[pyo3(from_py_with = degrees)] crease: f32,
        seams: &str,
        overwrite: bool,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let normals = normal_options(shading, weight, crease, seams)?;
        let options = AddNormalsOptions::default().with_normals(normals).with_overwrite(overwrite);
        self.edit(py, progress, |document, context, report| {
            gltf::add_normals_with(document, &options, context, report)
        })
    }

    /// Convert the vertex data of every primitive from one convention to another.
    ///
    /// A correct glTF file is in glTF's convention and needs no conversion. This is for files whose writer
    /// copied the numbers of another convention, and for programs that read the numbers without
    /// converting them. After Ctrl-C or an error the document is unusable: load it again.
    ///
    /// Parameters
    /// ----------
    /// source, target : str
    ///     As in convert.
    /// progress : callable, optional
    ///     Called with the number of processed primitives and their total.
    ///
    /// Returns
    /// -------
    /// dict
    ///     The numbers of changed items.
    #[pyo3(signature = (source, target, *, progress=None))]
    fn convert<'py>(
        &mut self,
        py: Python<'py>,
        source: &str,
        target: &str,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (source, target) = (convention("source", source)?, convention("target", target)?);
        self.edit(py, progress, |document, _, report| {
            gltf::convert_vertices(document, source, target, report)
        })
    }
}

impl Document {
    /// The document. Errors: an earlier edit was interrupted.
    pub fn whole(&self) -> PyResult<&gltf::Document> {
        if self.is_half_done {
            let sentence =
                "the document is half done: a method that changes it was stopped or failed; load it again";
            return Err(PyRuntimeError::new_err(sentence));
        }
        Ok(&self.document)
    }

    /// Changes the document without the GIL. After an error it is half done.
    pub fn change<T: Send>(
        &mut self,
        py: Python<'_>,
        change: impl FnOnce(&mut gltf::Document) -> Result<T, darboux_io::Error> + Send,
    ) -> PyResult<T> {
        self.whole()?;
        self.is_half_done = true;
        let document = &mut self.document;
        let changed = py.detach(|| change(document)).map_err(file_error)?;
        self.is_half_done = false;
        Ok(changed)
    }

    fn vectors<'py>(&self, py: Python<'py>, accessor: usize) -> PyResult<Bound<'py, PyAny>> {
        let components = self.document.accessors().get(accessor).map(|found| found.element_type.components());
        Ok(match components {
            Some(1) => rows_array(py, self.read::<1>(py, accessor)?)?.into_any(),
            Some(2) => rows_array(py, self.read::<2>(py, accessor)?)?.into_any(),
            Some(3) => rows_array(py, self.read::<3>(py, accessor)?)?.into_any(),
            _ => rows_array(py, self.read::<4>(py, accessor)?)?.into_any(),
        })
    }

    fn read<const N: usize>(&self, py: Python<'_>, accessor: usize) -> PyResult<Vec<[f32; N]>> {
        py.detach(|| self.document.vectors(accessor).map(Cow::into_owned)).map_err(file_error)
    }

    /// Edits the document without the GIL and returns the summary as plain Python objects.
    fn edit<'py, S: Serialize + Send>(
        &mut self,
        py: Python<'py>,
        progress: Option<&Bound<'py, PyAny>>,
        edit: impl FnOnce(
            &mut gltf::Document,
            &mut Context,
            &mut dyn FnMut(Progress),
        ) -> Result<S, darboux_io::Error>
        + Send,
    ) -> PyResult<Bound<'py, PyAny>> {
        check_progress(progress)?;
        self.whole()?;
        // An edit that was cancelled or failed leaves some primitives changed, and others not.
        self.is_half_done = true;
        let (document, cancel) = (&mut self.document, &Cancel::new());
        let work = move |sender: &Sender<Progress>| {
            // The receiver lives until the sender is dropped.
            let mut report = |progress| _ = sender.send(progress);
            edit(document, &mut Context::new().with_cancel(cancel), &mut report)
        };
        let receive = |Progress { done, total }| match progress {
            Some(progress) => progress.call1((done, total)).map(drop),
            None => Ok(()),
        };
        let edited = run_interruptibly(py, 0, work, receive, || cancel.cancel())?;
        let summary = edited.map_err(file_error)?;
        self.is_half_done = false;
        python_of(py, &summary)
    }
}

/// Converts an error of darboux-io: an OSError for errors of the operating system, otherwise a ValueError.
pub fn file_error(error: darboux_io::Error) -> PyErr {
    let sentence = error.to_string();
    match error {
        darboux_io::Error::Read { source, .. } | darboux_io::Error::Write { source, .. } => {
            match source.raw_os_error() {
                // Python selects the subclass by errno: FileNotFoundError, PermissionError.
                Some(number) => PyOSError::new_err((number, sentence)),
                None => PyOSError::new_err(sentence),
            }
        }
        _ => PyValueError::new_err(sentence),
    }
}
