//! Bakes the detail of high meshes into images.

use std::collections::HashMap;

use darboux::{Cancel, Context};
use darboux_bake::{
    BakeError, ColorTexture, HighSurface, LowSurface, MaterialProperty, SkewCorrection,
    bake as bake_surfaces, inflated_cage,
};
use numpy::{PyReadonlyArray2, PyReadonlyArray3};
use pyo3::exceptions::{PyMemoryError, PyTypeError, PyValueError};
use pyo3::prelude::*;

use crate::arrays::Rows;
use crate::bake_result::{Setup, baked_maps};
use crate::bake_settings::BakeSettings;
use crate::choices::choice;
use crate::convention::convention;
use crate::mesh::{IndexArray, MeshArrays};
use crate::numbers::{Natural, Threads, natural};
use crate::threads::run_interruptibly;

/// The textures of the high mesh, and whether they are in sRGB.
const TEXTURES: &[(&str, (MaterialProperty, bool))] = &[
    ("base-color", (MaterialProperty::BaseColor, true)),
    ("metallic-roughness", (MaterialProperty::MetallicRoughness, false)),
    ("emission", (MaterialProperty::Emission, true)),
    ("texture", (MaterialProperty::Texture, false)),
];

/// Bake the detail of a high mesh into images over the UVs of a low mesh.
///
/// From every texel that a triangle of the low mesh covers, a ray passes from outside through it; the first
/// triangle of the high mesh that it hits gives the content. The first triangle owns texels that several
/// cover. Texels without a hit are filled from around.
///
/// Parameters
/// ----------
/// positions, normals, uvs, indices
///     The low mesh, as for generate_tangents; triangles only.
/// tangents : (C, 4) array_like
///     One per corner, as generate_tangents returns them. The sign w in a glTF file's TANGENT is the opposite
///     of theirs: negate it first.
/// high_positions : (W, 3) array_like
/// high_indices : (D,) or (G, 3) array_like of integers, optional
///     Triangles, counter-clockwise seen from the front. Without indices, every vertex is a corner of its
///     own.
/// high_normals : (W, 3) array_like, optional
///     Without, every triangle is flat.
/// size : (int, int)
///     Width and height in texels.
/// distance : (float, float)
///     How far outside the low mesh rays begin and how far inside they end, in units of the positions.
/// cage : (V, 3) array_like or float, optional
///     Rays begin on the low mesh with its vertices moved to these positions, or outwards by this distance
///     along smooth normals, so that hard edges leave no gaps; they end inside as `distance` says.
/// maps : sequence of str
///     Names of maps: 'normal', 'ao', 'curvature', 'base-color' and so on, as `darboux bake --map` has them.
///     They share rays.
/// samples : int
///     Samples per texel and axis, 1 to 16.
/// source, target : str
///     The conventions of the meshes and of the maps, each one of CONVENTIONS.
/// bitangent : str
///     How the renderer rebuilds it: 'pixel' or 'vertex'.
/// padding : int, optional
///     How far texels outside the charts are filled, in texels. Without, all are.
/// back_faces : bool
///     Rays also hit triangles from behind.
/// ao_rays, ao_distance
///     Rays per sample of occlusion, bent normals and thickness, and how far surfaces occlude each other.
/// ao_falloff, ao_weights : str
///     How occlusion fades up to `ao_distance`: 'none', 'linear' or 'quadratic'; how directions are weighted:
///     'cosine' or 'uniform'.
/// thickness_distance : float
///     How far the other side is looked for. Rays that meet nothing count as this distance; where it is
///     infinite they do not count.
/// curvature_radius : float
///     The radius in which curvature is measured.
/// curvature_unit : str
///     The unit of that radius: 'texels', or 'distance' for units of the positions.
/// world_direction : (float, float, float)
///     The direction of the map 'world-direction', along the axes of the source's convention.
/// skew : float, (F,) array_like or (N, M) uint8 array, optional
///     How far rays turn from the smooth direction (0) to the normal of the triangle (1): everywhere, per
///     triangle, or by a map over the UVs of the image, in which 255 is 1.
/// udim : int, optional
///     The tile of the UV plane that is baked, 1001 + column + 10 * row. Without, all tiles lie over each
///     other.
/// high_colors : (W, 4) array_like, optional
///     Red, green, blue and alpha of the high mesh's vertices, in linear light: the map 'vertex-color', and a
///     factor of 'base-color' and 'opacity'.
/// high_uvs : (W, 2) array_like, optional
///     Where `high_textures` are read; the origin is that of glTF, above left.
/// high_textures : dict of str to (N, M, 4) uint8 array, optional
///     Of 'base-color' and 'emission' (in sRGB), 'metallic-roughness' (green, blue) and 'texture', the top
///     row first.
/// threads : int, optional
///     At most so many threads. The result has the same bits for every number.
///
/// Returns
/// -------
/// BakedMaps
///     float32 images, the top row first.
///
/// Raises
/// ------
/// TypeError, ValueError
///     As generate_tangents; options out of range; meshes without triangles.
/// MemoryError
///     Images and meshes need more memory than there is.
#[pyfunction]
#[pyo3(signature = (
    positions, normals, uvs, indices, tangents, high_positions, high_indices=None, high_normals=None, *, size, distance,
    cage=None, maps=vec!["normal".to_owned()], samples=1, source="gltf", target="gltf", bitangent="pixel",
    padding=None, back_faces=false, ao_rays=64, ao_distance=f32::INFINITY, ao_falloff="none", ao_weights="cosine",
    thickness_distance=f32::INFINITY, curvature_radius=4.0, curvature_unit="texels", world_direction=(0.0, 1.0, 0.0),
    skew=None, udim=None, high_colors=None, high_uvs=None, high_textures=None, threads=None
))]
#[expect(clippy::too_many_arguments, reason = "Python passes them by name")]
pub fn bake<'py>(
    py: Python<'py>,
    positions: &Bound<'py, PyAny>,
    normals: &Bound<'py, PyAny>,
    uvs: &Bound<'py, PyAny>,
    indices: Option<&Bound<'py, PyAny>>,
    tangents: &Bound<'py, PyAny>,
    high_positions: &Bound<'py, PyAny>,
    high_indices: Option<&Bound<'py, PyAny>>,
    high_normals: Option<&Bound<'py, PyAny>>,
    size: (Natural, Natural),
    distance: (f32, f32),
    cage: Option<&Bound<'py, PyAny>>,
    maps: Vec<String>,
    #[pyo3(from_py_with = natural)] samples: u32,
    source: &str,
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
    skew: Option<&Bound<'py, PyAny>>,
    udim: Option<Natural>,
    high_colors: Option<&Bound<'py, PyAny>>,
    high_uvs: Option<&Bound<'py, PyAny>>,
    high_textures: Option<HashMap<String, PyReadonlyArray3<'py, u8>>>,
    threads: Option<Threads>,
) -> PyResult<Bound<'py, PyAny>> {
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
    let options = settings.options(distance.into())?.with_surface_convention(convention("source", source)?);
    let low = MeshArrays::new(positions, normals, uvs, indices, None)?;
    let tangents = Rows::<4>::new("tangents", "C", tangents)?;
    let tangents = tangents.packed()?;
    let high_positions = Rows::<3>::new("high_positions", "W", high_positions)?;
    let high_normals =
        high_normals.map(|normals| Rows::<3>::new("high_normals", "W", normals)).transpose()?;
    let high_indices = IndexArray::new(high_indices)?;
    if matches!(high_indices.shape[..], [_, 4]) {
        return Err(PyValueError::new_err("high_indices must be triangles, shape (G, 3); split the quads"));
    }
    let mesh = low.view()?;
    let surface = LowSurface::new(mesh, &tangents).map_err(bake_error)?;
    let high_normals = high_normals.as_ref().map(Rows::view).transpose()?;
    let high = HighSurface::new(high_positions.view()?, high_normals, high_indices.view());
    let high_colors = high_colors.map(|colors| Rows::<4>::new("high_colors", "W", colors)).transpose()?;
    let high_uvs = high_uvs.map(|uvs| Rows::<2>::new("high_uvs", "W", uvs)).transpose()?;
    let textures = textures(high_textures)?;
    let high = shown(high.map_err(bake_error)?, high_colors.as_ref(), high_uvs.as_ref(), &textures)?;
    let high = [high];
    let cage = cage.map(|cage| Cage::new(cage, &surface)).transpose()?;
    let skew = skew.map(Skew::new).transpose()?;
    let surface = Skew::on(skew.as_ref(), Cage::around(cage.as_ref(), surface)?)?;
    let cancel = Cancel::new();
    let mut context = Context::new().with_cancel(&cancel);
    let work = |_: &std::sync::mpsc::Sender<()>| {
        bake_surfaces(&[surface], &high, &options, &mut context, &mut |_| {})
    };
    let baked = run_interruptibly(py, Threads::or_all(threads), work, |()| Ok(()), || cancel.cancel())?;
    let setup = Setup { distance: options.distance, ..Setup::default() };
    baked_maps(py, baked.map_err(bake_error)?, setup)
}

/// Positions of a cage.
pub enum Cage<'py> {
    Given(Rows<'py, 3>),
    Inflated(Vec<[f32; 3]>),
}

impl<'py> Cage<'py> {
    pub fn new(value: &Bound<'py, PyAny>, surface: &LowSurface<'_>) -> PyResult<Self> {
        match value.extract::<f32>() {
            Ok(offset) => inflated_cage(surface.mesh(), offset).map(Self::Inflated).map_err(bake_error),
            Err(_) => Rows::new("cage", "V", value).map(Self::Given),
        }
    }

    /// The surface with this cage, or as it is without one.
    pub fn around<'a>(cage: Option<&'a Self>, surface: LowSurface<'a>) -> PyResult<LowSurface<'a>> {
        match cage {
            Some(Self::Given(rows)) => surface.with_cage(rows.view()?).map_err(bake_error),
            Some(Self::Inflated(rows)) => surface.with_cage(rows).map_err(bake_error),
            None => Ok(surface),
        }
    }
}

/// The correction that Python passes: an amount, one per triangle, or an image.
pub enum Skew {
    Everywhere(f32),
    PerTriangle(Vec<f32>),
    Map(ColorTexture),
}

impl Skew {
    pub fn new(value: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(amount) = value.extract::<f32>() {
            return Ok(Self::Everywhere(amount));
        }
        let Ok(image) = value.extract::<PyReadonlyArray2<'_, u8>>() else {
            return value.extract().map(Self::PerTriangle).map_err(|_| {
                PyTypeError::new_err(
                    "skew must be a number, one number per triangle, or a uint8 image of shape (N, M)",
                )
            });
        };
        let view = image.as_array();
        let [height, width] = [view.shape()[0], view.shape()[1]];
        let size = [width, height].map(|side| u32::try_from(side).unwrap_or(u32::MAX));
        let texels = view.iter().map(|&grey| [grey, grey, grey, u8::MAX]).collect();
        ColorTexture::new(size, texels, false).map(Self::Map).map_err(bake_error)
    }

    pub fn correction(&self) -> SkewCorrection<'_> {
        match self {
            Self::Everywhere(amount) => SkewCorrection::Everywhere(*amount),
            Self::PerTriangle(amounts) => SkewCorrection::PerTriangle(amounts),
            Self::Map(map) => SkewCorrection::Map(map),
        }
    }

    /// The surface with this correction, or as it is without one.
    pub fn on<'a>(skew: Option<&'a Self>, surface: LowSurface<'a>) -> PyResult<LowSurface<'a>> {
        let Some(skew) = skew else { return Ok(surface) };
        surface.with_skew_correction(skew.correction()).map_err(bake_error)
    }
}

pub fn bake_error(error: BakeError) -> PyErr {
    match error {
        BakeError::Memory { .. } => PyMemoryError::new_err(error.to_string()),
        error => PyValueError::new_err(error.to_string()),
    }
}

/// A texture of the high mesh.
type Texture = (MaterialProperty, ColorTexture);

fn textures(given: Option<HashMap<String, PyReadonlyArray3<'_, u8>>>) -> PyResult<Vec<Texture>> {
    let read = |(name, array): (String, PyReadonlyArray3<'_, u8>)| {
        let (property, is_srgb) = choice("high_textures", &name, TEXTURES)?;
        let view = array.as_array();
        let &[height, width, channels] = view.shape() else {
            return Err(PyValueError::new_err(format!(
                "high_textures['{name}'] must have the shape (N, M, 4)"
            )));
        };
        if channels != 4 {
            let message = format!("high_textures['{name}'] has {channels} channels; it must have 4");
            return Err(PyValueError::new_err(message));
        }
        let texels: Vec<u8> = view.iter().copied().collect();
        let size = [width, height].map(|side| u32::try_from(side).unwrap_or(u32::MAX));
        let texture = ColorTexture::new(size, texels.as_chunks().0.to_vec(), is_srgb);
        Ok((property, texture.map_err(bake_error)?))
    };
    given.into_iter().flatten().map(read).collect()
}

/// The high surface with its colours and textures.
fn shown<'a>(
    mut high: HighSurface<'a>,
    colors: Option<&'a Rows<'_, 4>>,
    uvs: Option<&'a Rows<'_, 2>>,
    textures: &'a [Texture],
) -> PyResult<HighSurface<'a>> {
    if let Some(colors) = colors {
        high = high.with_colors(colors.view()?).map_err(bake_error)?;
    }
    for (property, texture) in textures {
        let uvs = uvs.ok_or_else(|| PyValueError::new_err("high_textures needs high_uvs; pass both"))?;
        high = high.with_property(*property, [1.0; 4], Some((texture, uvs.view()?))).map_err(bake_error)?;
    }
    Ok(high)
}
