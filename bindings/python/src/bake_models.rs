//! Bakes the detail of high models into images: files in, arrays out.

use std::path::PathBuf;
use std::sync::mpsc::Sender;

use darboux::{Cancel, Context};
use darboux_bake::{
    BakeOptions, BakeProgress, Baked, Cages, HighModel, HighModelOptions, LowModelOptions, ModelSurfaces,
    Models, ModelsError, PartMatch, PreparedSurfaces, RayOrigin, cage_of, with_cages, with_skew,
};
use darboux_io::gltf::Document;
use darboux_io::{LoadOptions, memory_of_process};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyBytes};

use crate::bake::{Skew, bake_error};
use crate::bake_result::{Setup, baked_maps};
use crate::bake_settings::BakeSettings;
use crate::choices::named_choice;
use crate::document::{file_error, load_options};
use crate::numbers::{Natural, Threads, natural};
use crate::threads::{check_progress, run_interruptibly};

/// Bake the detail of high models into images over the UVs of a low model, as `darboux bake` does, with the
/// same bits.
///
/// From every texel that a triangle of the low model covers, a ray passes from outside through it; the first
/// triangle of a high model that it hits gives the content. Normals are in the frames of the tangents that
/// the low model has, or else of MikkTSpace's.
///
/// Parameters
/// ----------
/// low : path-like or bytes
///     A .glb or .gltf file, an FBX, OBJ, PLY or STL, or the bytes of one. Files beside bytes are not read.
/// high : path-like or bytes, or iterable of these
///     One high model, or several.
/// size : (int, int)
///     Width and height in texels.
/// cage_offset : float, optional
///     Rays begin on a copy of the low model, inflated by this distance, and end as far inside. Without, it
///     is 2 % of the model's diagonal.
/// auto_cage : float, optional
///     Rays begin on a cage that is made for the models: at every vertex as close as all but this share of
///     the rays around allows, such as 0.001. It is at most `cage_offset` away, by default 10 % of the
///     diagonal.
/// cage : path-like or bytes, optional
///     Rays begin on the low model with its vertices moved, a model, and end as far inside as `cage_offset`
///     says.
/// skew : float or (N, M) uint8 array, optional
///     Turns rays to the normals of the low model's triangles: by an amount from 0 to 1, or by an image over
///     its UVs, white where rays follow the triangle's normal.
/// distance : (float, float), optional
///     In place of a cage: how far outside rays begin along the normals, and how far inside they end, in
///     units of the positions.
/// maps, samples, target, bitangent, padding, back_faces, ao_rays, ao_distance, ao_falloff, ao_weights
///     As for bake.
/// thickness_distance, curvature_radius, curvature_unit, world_direction, udim
///     As for bake.
/// material : int, optional
///     The index of the only material of the low model that is baked. Without, all are.
/// uv_set : int, optional
///     The n of TEXCOORD_n. Without, the set that the normal map of each material uses.
/// match : str
///     'nearest', or 'name': the part `crate_low` is baked from `crate_high` and `crate_high_bolts` only.
/// high_maps : bool
///     The normal maps of the high models count.
/// ao_own_part : bool
///     Parts of the high models are occluded by themselves only.
/// id_from : str
///     What the colours of 'id' stand for: 'material', 'mesh', 'part' or 'vertex-color'.
/// texture : str, optional
///     The texture of the map 'texture': its place in the JSON of the high models' materials, such as
///     'occlusionTexture'.
/// allow_outside, memory_limit
///     As in load; for each file.
/// progress : callable, optional
///     Called with the number of finished rows of blocks and their total.
/// threads : int, optional
///     At most so many threads. The result has the same bits for every number.
///
/// Returns
/// -------
/// BakedMaps
///     float32 images, the top row first, with what the colours of maps stand for and what was left out.
///
/// Raises
/// ------
/// OSError
///     A file cannot be read.
/// TypeError, ValueError
///     A file is broken; a low model without normals, UVs or triangles; options out of range.
/// MemoryError
///     Images and models need more memory than there is.
#[pyfunction]
#[pyo3(signature = (
    low, high, *, size=(Natural(1024), Natural(1024)), cage_offset=None, auto_cage=None, cage=None, skew=None, distance=None,
    maps=vec!["normal".to_owned()], samples=1, target="gltf", bitangent="pixel", padding=None, back_faces=false, ao_rays=64,
    ao_distance=f32::INFINITY, ao_falloff="none", ao_weights="cosine", thickness_distance=f32::INFINITY,
    curvature_radius=4.0, curvature_unit="texels", world_direction=(0.0, 1.0, 0.0), udim=None, material=None,
    uv_set=None, r#match="nearest", high_maps=true, ao_own_part=false, id_from="material", texture=None,
    allow_outside=false, memory_limit=None, progress=None, threads=None
))]
#[expect(clippy::too_many_arguments, reason = "Python passes them by name")]
pub fn bake_models<'py>(
    py: Python<'py>,
    low: &Bound<'py, PyAny>,
    high: &Bound<'py, PyAny>,
    size: (Natural, Natural),
    cage_offset: Option<f32>,
    auto_cage: Option<f32>,
    cage: Option<&Bound<'py, PyAny>>,
    skew: Option<&Bound<'py, PyAny>>,
    distance: Option<(f32, f32)>,
    maps: Vec<String>,
    #[pyo3(from_py_with = natural)] samples: u32,
    target: &str,
    bitangent: &str,
    padding: Option<Natural>,
    back_faces: bool,
    #[pyo3(from_py_with = natural)] ao_rays: u32,
    ao_distance: f32,
    ao_falloff: &str,
    ao_weights: &str,
    thickness_distance: f32,
    curvature_radius: f32,
    curvature_unit: &str,
    world_direction: (f32, f32, f32),
    udim: Option<Natural>,
    material: Option<Natural>,
    uv_set: Option<Natural>,
    r#match: &str,
    high_maps: bool,
    ao_own_part: bool,
    id_from: &str,
    texture: Option<String>,
    allow_outside: bool,
    memory_limit: Option<Natural>,
    progress: Option<&Bound<'py, PyAny>>,
    threads: Option<Threads>,
) -> PyResult<Bound<'py, PyAny>> {
    check_progress(progress)?;
    let settings = BakeSettings {
        size,
        maps: &maps,
        samples,
        target,
        bitangent,
        padding,
        back_faces,
        ao_rays,
        ao_distance,
        ao_falloff,
        ao_weights,
        thickness_distance,
        curvature_radius,
        curvature_unit,
        world_direction,
        udim,
    };
    let origin = ray_origin(cage_offset, auto_cage, cage.is_some(), distance)?;
    // Wrong options are told before files are read. The distance is known when the low model is.
    origin.check().map_err(bake_error)?;
    let options = settings
        .options(origin.distance(1.0))?
        .with_own_part_only(ao_own_part)
        .with_id_source(named_choice(id_from)?);
    options.check().and_then(|()| options.check_memory()).map_err(bake_error)?;
    let high_options =
        HighModelOptions::default().with_normal_maps(high_maps).with_maps(options.maps).with_texture(texture);
    high_options.check().map_err(bake_error)?;
    let index = |Natural(number)| number as usize;
    let job = Job {
        low: ModelSource::new("low", low)?,
        cage: cage.map(|cage| ModelSource::new("cage", cage)).transpose()?,
        skew: skew.map(Skew::new).transpose()?,
        highs: ModelSource::several("high", high)?,
        loading: load_options(memory_limit).with_allow_outside(allow_outside),
        low_options: LowModelOptions::default()
            .with_material(material.map(index))
            .with_uv_set(uv_set.map(index)),
        high_options,
        part_match: named_choice(r#match)?,
        origin,
        options,
    };
    let cancel = &Cancel::new();
    let work = move |sender: &Sender<BakeProgress>| {
        // The receiver lives until the sender is dropped.
        let mut tell = |progress| _ = sender.send(progress);
        job.bake(&mut Context::new().with_cancel(cancel), &mut tell)
    };
    let receive = |BakeProgress { done, total }| match progress {
        Some(progress) => progress.call1((done, total)).map(drop),
        None => Ok(()),
    };
    let baked = run_interruptibly(py, Threads::or_all(threads), work, receive, || cancel.cancel())?;
    let (baked, setup) = baked.map_err(models_error)?;
    baked_maps(py, baked, setup)
}

/// Where rays begin. Errors: two options say so.
fn ray_origin(
    cage_offset: Option<f32>,
    auto_cage: Option<f32>,
    has_cage: bool,
    distance: Option<(f32, f32)>,
) -> PyResult<RayOrigin> {
    let (has_distance, has_made) = (distance.is_some(), auto_cage.is_some());
    let both = [
        (has_distance && cage_offset.is_some(), "cage_offset and distance"),
        (has_distance && has_made, "auto_cage and distance"),
        (has_distance && has_cage, "cage and distance"),
        (has_made && has_cage, "cage and auto_cage"),
    ];
    if let Some((_, names)) = both.into_iter().find(|(are_given, _)| *are_given) {
        return Err(PyValueError::new_err(format!(
            "{names} both say where rays begin; leave one of them out"
        )));
    }
    Ok(match (distance, auto_cage) {
        (Some(distance), _) => RayOrigin::Normals(distance.into()),
        (None, Some(share)) => RayOrigin::AutoCage { share, reach: cage_offset },
        (None, None) => RayOrigin::InflatedCage(cage_offset),
    })
}

/// A model that a caller passes.
enum ModelSource {
    Path(PathBuf),
    Bytes(Vec<u8>),
}

impl ModelSource {
    /// `name`: of the argument.
    fn new(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        Self::of(value).ok_or_else(|| {
            PyTypeError::new_err(format!(
                "{name} is {}; give a path or the bytes of a file",
                value.get_type()
            ))
        })
    }

    /// One model, or several.
    fn several(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<Self>> {
        if let Some(source) = Self::of(value) {
            return Ok(vec![source]);
        }
        let Ok(values) = value.try_iter() else { return Self::new(name, value).map(|source| vec![source]) };
        let sources: Vec<Self> = values.map(|value| Self::new(name, &value?)).collect::<PyResult<_>>()?;
        if sources.is_empty() {
            return Err(PyValueError::new_err(format!("{name} is empty; give one model or several")));
        }
        Ok(sources)
    }

    /// The model of a value; none where it is neither a path nor bytes.
    fn of(value: &Bound<'_, PyAny>) -> Option<Self> {
        if value.is_instance_of::<PyBytes>() || value.is_instance_of::<PyByteArray>() {
            return value.extract().ok().map(Self::Bytes);
        }
        value.extract().ok().map(Self::Path)
    }

    /// `name`: of bytes, in messages.
    fn open(self, name: &str, loading: &LoadOptions) -> Result<Document, darboux_io::Error> {
        match self {
            Self::Path(path) => Document::open(&path, loading),
            Self::Bytes(bytes) => Document::from_bytes(name, bytes, None, loading),
        }
    }
}

/// A bake of models.
struct Job {
    low: ModelSource,
    highs: Vec<ModelSource>,
    cage: Option<ModelSource>,
    skew: Option<Skew>,
    loading: LoadOptions,
    low_options: LowModelOptions,
    high_options: HighModelOptions,
    part_match: PartMatch,
    origin: RayOrigin,
    /// But for the distance.
    options: BakeOptions,
}

impl Job {
    /// Reads the models and bakes.
    fn bake(
        self,
        context: &mut Context,
        progress: &mut (dyn FnMut(BakeProgress) + Send),
    ) -> Result<(Baked, Setup), ModelsError> {
        let open_high = |source: ModelSource| source.open("the high model", &self.loading);
        let low = self.low.open("the low model", &self.loading)?;
        let highs = self.highs.into_iter().map(open_high).collect::<Result<Vec<_>, _>>()?;
        let low_corners = low.corners()?;
        let high_corners = highs.iter().map(Document::corners).collect::<Result<Vec<_>, _>>()?;
        let (of_low, of_highs) = ((&low, &low_corners[..]), (&highs[..], &high_corners[..]));
        let models = Models::read(of_low, of_highs, &self.low_options, &self.high_options)?;

        let ModelSurfaces { low: surfaces, highs: high_surfaces, warnings: of_names } =
            models.surfaces(self.part_match)?;
        // What the models take is no longer free.
        let mut options = self.options.with_memory_limit(memory_of_process());
        let prepared = PreparedSurfaces::new(&surfaces, &high_surfaces, options.memory_limit, context)?;
        let diagonal = models.low.diagonal();
        let cages = match self.cage {
            Some(cage) => {
                let positions = cage_of(&cage.open("the cage", &self.loading)?, &surfaces)?;
                Cages { positions, distance: self.origin.distance(diagonal) }
            }
            None => self.origin.cages(diagonal, &surfaces, &prepared, context)?,
        };
        options.distance = cages.distance;
        let mut caged = with_cages(&surfaces, &cages.positions)?;
        if let Some(skew) = &self.skew {
            caged = with_skew(&caged, skew.correction())?;
        }
        let prepared = prepared.with_low(&caged, context)?;
        let baked = prepared.bake(&options, context, progress)?;

        let of_files = highs.iter().chain([&low]).flat_map(Document::warnings).cloned();
        let of_misses = baked.report.warning_of_misses(models.misfit().as_deref());
        let warnings = of_files.chain(models.warnings()).chain(of_names).chain(of_misses);
        let id_names = HighModel::names_of_all(&models.highs, options.id_source);
        let setup = Setup {
            distance: options.distance,
            warnings: warnings.collect(),
            id_names: id_names.into_iter().map(str::to_owned).collect(),
        };
        Ok((baked, setup))
    }
}

/// An OSError for errors of the operating system, a MemoryError for a bake that needs too much, otherwise a
/// ValueError.
fn models_error(error: ModelsError) -> PyErr {
    match error {
        ModelsError::File(error) => file_error(error),
        ModelsError::Bake(error) => bake_error(error),
        error => PyValueError::new_err(error.to_string()),
    }
}
