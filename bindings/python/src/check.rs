//! Checks and repairs files, judges normal maps and recognises recipes.

use std::path::{Path, PathBuf};

use darboux::{Choice, Context, Mode, recognise_recipe_with};
use darboux_check::{
    CheckOptions, Code, FixOptions, MapConvention, ReportedFindings, ReportedJudgement, ReportedRecipe,
    check_document, check_map, fix_document,
};
use darboux_io::{FileKind, LoadOptions, gltf, read_regular};
use numpy::prelude::*;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

use crate::arrays::{Rows, array_of, packed, shape_text};
use crate::choices::{named_choice, tangent_options};
use crate::document::{Document, file_error, load_options};
use crate::mesh::{MeshArrays, value_error};
use crate::numbers::Natural;
use crate::results::result_of;
use crate::threads::cancellable;

/// Say what is wrong with the tangents, normals, UVs and normal maps of a model, or with a normal map.
///
/// Parameters
/// ----------
/// source : path-like or Document
///     A .glb or .gltf file, or an image (.png, .jpg, .webp, .tga), which is checked as a normal map; or
///     a document that load has read.
/// convention : str
///     Where the green of normal maps should point: 'opengl' (up, as in glTF) or 'directx' (down).
/// maps : bool
///     Decode and judge the normal maps of a model. Without it they are taken to be right.
/// assume : str, optional
///     What normal maps are where neither their texels nor the faces decide it: 'opengl', 'directx',
///     'red-inverted' or 'both-inverted'.
/// allow_outside, memory_limit
///     As in load; for files.
///
/// Returns
/// -------
/// Findings
///     A list of Finding, empty for a healthy file. Its `diagnosis` says what happened, what it looks like
///     and what to do.
///
/// Raises
/// ------
/// OSError, ValueError
///     As load. An image that cannot be decoded is a finding.
#[pyfunction]
#[pyo3(signature = (source, *, convention="opengl", maps=true, assume=None, allow_outside=false, memory_limit=None))]
pub fn check<'py>(
    py: Python<'py>,
    source: CheckSource<'py>,
    convention: &str,
    maps: bool,
    assume: Option<&str>,
    allow_outside: bool,
    memory_limit: Option<Natural>,
) -> PyResult<Bound<'py, PyAny>> {
    let options = check_options(convention, maps, assume)?;
    let found = match source {
        CheckSource::Document(document) => {
            let document = document.whole()?;
            py.detach(|| check_model(document, &options))
        }
        CheckSource::Path(path) => {
            let loading = load_options(memory_limit).with_allow_outside(allow_outside);
            py.detach(|| check_path(&path, &loading, &options))
        }
    };
    result_of(py, "findings_of", &found.map_err(file_error)?)
}

/// What `check` checks.
pub enum CheckSource<'py> {
    Document(PyRef<'py, Document>),
    Path(PathBuf),
}

impl<'py> FromPyObject<'_, 'py> for CheckSource<'py> {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(document) = value.cast::<Document>() {
            return Ok(Self::Document(document.try_borrow()?));
        }
        let kind = value.get_type();
        let refused = |_| PyTypeError::new_err(format!("source is {kind}; give a path or a Document"));
        value.extract().map(Self::Path).map_err(refused)
    }
}

fn check_path(
    path: &Path,
    loading: &LoadOptions,
    options: &CheckOptions,
) -> Result<ReportedFindings, darboux_io::Error> {
    if FileKind::of(path).is_some_and(FileKind::is_decoded_image) {
        let checked = check_map(&read_regular(path)?, &options.with_memory_limit(loading.memory_limit));
        Ok(ReportedFindings::new(checked.findings, None, options))
    } else {
        check_model(&gltf::Document::open(path, loading)?, options)
    }
}

fn check_model(
    document: &gltf::Document,
    options: &CheckOptions,
) -> Result<ReportedFindings, darboux_io::Error> {
    Ok(ReportedFindings::new(check_document(document, options)?, Some(document), options))
}

fn check_options(convention: &str, maps: bool, assume: Option<&str>) -> PyResult<CheckOptions> {
    let green = named_choice::<MapConvention>(convention)?.green();
    let assumed = assume.map(named_choice).transpose()?;
    Ok(CheckOptions::default().with_green(green).with_maps(maps).with_assumed_map(assumed))
}

/// Repair what can be repaired without guessing: tangents, normals, and the texels of PNG, JPEG and TGA
/// normal maps, as `darboux check --fix` does.
///
/// Nothing is left to repair in the repaired document, and data that no finding names is kept. After an error
/// the document is unusable: load it again.
///
/// Parameters
/// ----------
/// document : Document
///     Changed in memory; save writes it. Its is_changed is False if nothing was repaired.
/// convention, maps, assume
///     As in check.
/// method : str
///     How tangents are made again: as the normal map was baked, so nearly always 'mikktspace'.
/// only : iterable of str, optional
///     The codes that are repaired. By default all, but tangents of another method than MikkTSpace are left
///     (of no known method unless many point to wrong directions), because the map may have been baked with
///     them: only=['tangent-other-recipe'] or another `method` computes them again.
///
/// Returns
/// -------
/// Findings
///     What check finds, each with `repaired`, and with `left_because` where it is still there.
///
/// Raises
/// ------
/// ValueError
///     The data of the document is broken; an unknown code or choice.
#[pyfunction]
#[pyo3(signature = (document, *, convention="opengl", maps=true, assume=None, method="mikktspace", only=None))]
pub fn fix<'py>(
    py: Python<'py>,
    mut document: PyRefMut<'py, Document>,
    convention: &str,
    maps: bool,
    assume: Option<&str>,
    method: &str,
    only: Option<Vec<String>>,
) -> PyResult<Bound<'py, PyAny>> {
    let tangents = tangent_options(method, Mode::default().name(), 180.0)?;
    let options =
        FixOptions::default().with_check(check_options(convention, maps, assume)?).with_tangents(tangents);
    let codes: Option<Result<Vec<Code>, String>> =
        only.map(|names| names.iter().map(|name| name.parse()).collect());
    let options = match codes.transpose().map_err(PyValueError::new_err)? {
        Some(codes) => options.with_codes(codes),
        None => options,
    };
    let fixed = document.change(py, |document| {
        let findings = check_document(document, &options.check)?;
        let fixed = fix_document(document, findings, &options)?;
        Ok(ReportedFindings::new(fixed.findings, Some(document), &options.check))
    })?;
    result_of(py, "findings_of", &fixed)
}

/// Judge a normal map by its texels: whether green points up (OpenGL) or down (DirectX), and whether they are
/// normals at all.
///
/// Parameters
/// ----------
/// texels : (H, W, 2), (H, W, 3) or (H, W, 4) array_like of uint8 or uint16
///     The top row first; x, y and, if stored, z in the first channels. Alpha is ignored.
///
/// Returns
/// -------
/// MapJudgement
///
/// Raises
/// ------
/// TypeError, ValueError
///     Another type or shape.
#[pyfunction]
pub fn judge_normal_map<'py>(py: Python<'py>, texels: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let array = array_of("texels", texels)?;
    let shape = array.shape().to_vec();
    if !matches!(shape[..], [_, _, 2..=4]) {
        let shape = shape_text(&shape);
        return Err(PyValueError::new_err(format!("texels must have shape (H, W, 2 to 4), not {shape}")));
    }
    let (size, channels) = ([shape[1], shape[0]], shape[2]);
    let judged = match (array.dtype().kind(), array.dtype().itemsize()) {
        (b'u', 1) => {
            let texels = packed::<u8>(&array)?;
            let texels = texels.as_slice()?;
            py.detach(|| ReportedJudgement::of_texels(texels, size, channels))
        }
        (b'u', 2) => {
            let texels = packed::<u16>(&array)?;
            let texels = texels.as_slice()?;
            py.detach(|| ReportedJudgement::of_texels(texels, size, channels))
        }
        _ => {
            let kind = array.dtype();
            return Err(PyTypeError::new_err(format!("texels must hold uint8 or uint16, not {kind}")));
        }
    };
    result_of(py, "judgement_of", &judged.map_err(value_error)?)
}

/// Rank the ways in which the tangents of a mesh could have been computed, the best one first.
///
/// Parameters
/// ----------
/// positions, normals, uvs, indices, faces
///     As for generate_tangents.
/// tangents : (C, 4) array_like
///     One per corner, with the sign that generate_tangents returns.
///
/// Returns
/// -------
/// list of RecipeMatch
///
/// Raises
/// ------
/// TypeError, ValueError
///     As for generate_tangents; the number of corners differs.
#[pyfunction]
#[pyo3(signature = (positions, normals, uvs, indices, tangents, *, faces=None))]
pub fn recognise_recipe<'py>(
    py: Python<'py>,
    positions: &Bound<'py, PyAny>,
    normals: &Bound<'py, PyAny>,
    uvs: &Bound<'py, PyAny>,
    indices: Option<&Bound<'py, PyAny>>,
    tangents: &Bound<'py, PyAny>,
    faces: Option<&Bound<'py, PyAny>>,
) -> PyResult<Vec<Bound<'py, PyAny>>> {
    let arrays = MeshArrays::new(positions, normals, uvs, indices, faces)?;
    let tangents = Rows::new("tangents", "C", tangents)?;
    let (mesh, tangents) = (arrays.view()?, tangents.packed()?);
    let work = |context: &mut Context| recognise_recipe_with(&mesh, &tangents, context);
    let matches = cancellable(py, None, (mesh.corner_count(), false), &mut Context::new(), work)?;
    matches.iter().map(|found| result_of(py, "RecipeMatch", &ReportedRecipe::from(found))).collect()
}
