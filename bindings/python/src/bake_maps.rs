//! What belongs to a bake: the error of its map in degrees, maps in another space, cages that are made,
//! tiles.

use darboux::{Cancel, Context, Convention, TexelLayout};
use darboux_bake::{
    AutoCageOptions, BakeOptions, ErrorStatistics, HighSurface, Images, LowSurface, NormalSpace,
    NormalTexture, PreparedSurfaces, SpaceOptions, TexelState, Udim, Verification, auto_cage as make_cage,
    convert_space as convert, udims_of, verify as verify_map,
};
use numpy::prelude::*;
use numpy::{PyArray1, PyArray2, PyReadonlyArray2, PyReadonlyArrayDyn, PyUntypedArray};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::arrays::{Rows, array_of, shape_text};
use crate::bake::{Cage, Skew, bake_error};
use crate::bake_settings::tile;
use crate::choices::{choice, named_choice};
use crate::convention::convention;
use crate::mesh::{IndexArray, MeshArrays};
use crate::numbers::{Natural, Threads};
use crate::results::named;
use crate::threads::run_interruptibly;

const SPACES: &[(&str, NormalSpace)] = &[("tangent", NormalSpace::Tangent), ("object", NormalSpace::Object)];

/// Measure how far the normals that a renderer shows are from those of the high mesh, in degrees.
///
/// The low mesh is shaded with the map as a renderer does it, filtered bilinearly, at one random point per
/// texel. The truth is the normal where the point's own ray hits the high mesh.
///
/// Parameters
/// ----------
/// positions, normals, uvs, indices, tangents, high_positions, high_indices, high_normals
///     As for bake.
/// baked : BakedMaps
///     What bake returned for these meshes and options, with the map 'normal'.
/// written : (H, W, 3) array_like, optional
///     The map as it is in its file: uint8 or uint16 codes, or floats from -1 to 1. Without, the map of
///     `baked`.
/// distance, cage, source, target, bitangent, back_faces, skew, udim, threads
///     As for bake.
///
/// Returns
/// -------
/// Verification
///
/// Raises
/// ------
/// TypeError, ValueError, MemoryError
///     As bake; a map of another size, or none.
#[pyfunction]
#[pyo3(signature = (
    positions, normals, uvs, indices, tangents, high_positions, high_indices=None, high_normals=None, *, baked,
    written=None, distance, cage=None, source="gltf", target="gltf", bitangent="pixel", back_faces=false, skew=None,
    udim=None, threads=None
))]
#[expect(clippy::too_many_arguments, reason = "Python passes them by name")]
pub fn verify<'py>(
    py: Python<'py>,
    positions: &Bound<'py, PyAny>,
    normals: &Bound<'py, PyAny>,
    uvs: &Bound<'py, PyAny>,
    indices: Option<&Bound<'py, PyAny>>,
    tangents: &Bound<'py, PyAny>,
    high_positions: &Bound<'py, PyAny>,
    high_indices: Option<&Bound<'py, PyAny>>,
    high_normals: Option<&Bound<'py, PyAny>>,
    baked: &Bound<'py, PyAny>,
    written: Option<&Bound<'py, PyAny>>,
    distance: (f32, f32),
    cage: Option<&Bound<'py, PyAny>>,
    source: &str,
    target: &str,
    bitangent: &str,
    back_faces: bool,
    skew: Option<&Bound<'py, PyAny>>,
    udim: Option<Natural>,
    threads: Option<Threads>,
) -> PyResult<Bound<'py, PyAny>> {
    let normal = baked.getattr("normal")?;
    if normal.is_none() {
        return Err(PyValueError::new_err("baked has no normal map; bake with 'normal' in maps"));
    }
    let unrounded = Texels::new("baked.normal", &normal)?;
    let conventions: [Convention; 2] = [convention("source", source)?, convention("target", target)?];
    let written =
        written.map_or_else(|| Texels::new("baked.normal", &normal), |map| Texels::new("written", map))?;
    let images = Images::of_normals(unrounded.size, states(baked, unrounded.size)?, &unrounded.vectors);
    let images = images.map_err(bake_error)?;
    let written = NormalTexture::new(written.size, written.vectors, conventions[1], conventions[0]);
    let written = written.map_err(bake_error)?;
    let options = BakeOptions::new(images.size, distance.into())
        .with_surface_convention(conventions[0])
        .with_map_convention(conventions[1])
        .with_bitangent(named_choice(bitangent)?)
        .with_back_faces(back_faces)
        .with_udim(tile(udim)?);
    let low = LowArrays::new(positions, normals, uvs, indices, tangents)?;
    let high = HighArrays::new(high_positions, high_indices, high_normals)?;
    let (surface, high) = (low.surface()?, [high.surface()?]);
    let cage = cage.map(|cage| Cage::new(cage, &surface)).transpose()?;
    let skew = skew.map(Skew::new).transpose()?;
    let surface = Skew::on(skew.as_ref(), Cage::around(cage.as_ref(), surface)?)?;
    let cancel = Cancel::new();
    let mut context = Context::new().with_cancel(&cancel);
    let work = |_: &std::sync::mpsc::Sender<()>| {
        verify_map(&[surface], &high, &images, &written, &options, &mut context, &mut |_| {})
    };
    let verified = run_interruptibly(py, Threads::or_all(threads), work, |()| Ok(()), || cancel.cancel())?;
    verification(py, verified.map_err(bake_error)?)
}

/// Convert a normal map from object space to tangent space or back, without rays.
///
/// Each texel is converted by the frame of the mesh at its centre, as a renderer interpolates it; texels
/// outside the charts are filled from the nearest one.
///
/// Parameters
/// ----------
/// positions, normals, uvs, indices, tangents
///     The mesh, as for bake.
/// texels : (H, W, 3) array_like
///     The map, the top row first: uint8 or uint16 codes, or floats; lengths of vectors do not count.
/// to : str
///     The space of the result, 'tangent' or 'object'; the map is in the other one.
/// mesh, source, target : str
///     The conventions of the mesh, of the map and of the result, each one of CONVENTIONS.
/// bitangent, padding, udim, threads
///     As for bake.
///
/// Returns
/// -------
/// ConvertedSpace
///
/// Raises
/// ------
/// TypeError, ValueError, MemoryError
///     As bake.
#[pyfunction]
#[pyo3(signature = (
    positions, normals, uvs, indices, tangents, texels, *, to, mesh="gltf", source="gltf", target="gltf", bitangent="pixel",
    padding=None, udim=None, threads=None
))]
#[expect(clippy::too_many_arguments, reason = "Python passes them by name")]
pub fn convert_space<'py>(
    py: Python<'py>,
    positions: &Bound<'py, PyAny>,
    normals: &Bound<'py, PyAny>,
    uvs: &Bound<'py, PyAny>,
    indices: Option<&Bound<'py, PyAny>>,
    tangents: &Bound<'py, PyAny>,
    texels: &Bound<'py, PyAny>,
    to: &str,
    mesh: &str,
    source: &str,
    target: &str,
    bitangent: &str,
    padding: Option<Natural>,
    udim: Option<Natural>,
    threads: Option<Threads>,
) -> PyResult<Bound<'py, PyAny>> {
    let Texels { size, vectors } = Texels::new("texels", texels)?;
    let options = SpaceOptions::new(size, choice("to", to, SPACES)?)
        .with_bitangent(named_choice(bitangent)?)
        .with_surface_convention(convention("mesh", mesh)?)
        .with_conventions(convention("source", source)?, convention("target", target)?)
        .with_padding(padding.map(|Natural(texels)| texels))
        .with_udim(tile(udim)?);
    let low = LowArrays::new(positions, normals, uvs, indices, tangents)?;
    let surface = low.surface()?;
    let cancel = Cancel::new();
    let mut context = Context::new().with_cancel(&cancel);
    let work = |_: &std::sync::mpsc::Sender<()>| convert(&[surface], &vectors, &options, &mut context);
    let converted = run_interruptibly(py, Threads::or_all(threads), work, |()| Ok(()), || cancel.cancel())?;
    let converted = converted.map_err(bake_error)?;
    let [width, height] = size.map(|side| side as usize);
    let texels = PyArray1::from_vec(py, converted.texels.into_flattened()).reshape([height, width, 3])?;
    let fields = (texels, converted.charted_texels, converted.overlapping_texels, converted.invalid_texels);
    named(py, "ConvertedSpace", fields)
}

/// Make the closest cage from which rays see all of the high mesh that belongs to the low one.
///
/// Detail that stands on the surface lies inside the cage, and what stands over it behind a gap, such as a
/// handle over a lid, outside.
///
/// Parameters
/// ----------
/// positions, normals, uvs, indices, tangents, high_positions, high_indices, high_normals
///     As for bake.
/// reach : float
///     The largest distance of the cage, in units of the positions.
/// share : float
///     The share of a triangle's rays that may change their hit if they began farther outside.
/// threads : int, optional
///     At most so many threads. The result has the same bits for every number.
///
/// Returns
/// -------
/// AutoCage
///     Pass its `positions` to bake as `cage`, and (0, `inwards`) as `distance`.
///
/// Raises
/// ------
/// TypeError, ValueError, MemoryError
///     As bake.
#[pyfunction]
#[pyo3(signature = (
    positions, normals, uvs, indices, tangents, high_positions, high_indices=None, high_normals=None, *, reach, share=0.001,
    threads=None
))]
#[expect(clippy::too_many_arguments, reason = "Python passes them by name")]
pub fn auto_cage<'py>(
    py: Python<'py>,
    positions: &Bound<'py, PyAny>,
    normals: &Bound<'py, PyAny>,
    uvs: &Bound<'py, PyAny>,
    indices: Option<&Bound<'py, PyAny>>,
    tangents: &Bound<'py, PyAny>,
    high_positions: &Bound<'py, PyAny>,
    high_indices: Option<&Bound<'py, PyAny>>,
    high_normals: Option<&Bound<'py, PyAny>>,
    reach: f32,
    share: f32,
    threads: Option<Threads>,
) -> PyResult<Bound<'py, PyAny>> {
    let low = LowArrays::new(positions, normals, uvs, indices, tangents)?;
    let high = HighArrays::new(high_positions, high_indices, high_normals)?;
    let (surface, high) = (low.surface()?, high.surface()?);
    let cancel = Cancel::new();
    let mut context = Context::new().with_cancel(&cancel);
    let work = |_: &std::sync::mpsc::Sender<()>| {
        let prepared = PreparedSurfaces::new(&[surface], &[high], None, &context)?;
        make_cage(&prepared, &AutoCageOptions::new(share, reach), &mut context)
    };
    let cage = run_interruptibly(py, Threads::or_all(threads), work, |()| Ok(()), || cancel.cancel())?;
    let cage = cage.map_err(bake_error)?;
    let [least, most] = cage.offsets;
    let positions = cage.positions.into_iter().next().unwrap_or_default();
    let positions = PyArray1::from_vec(py, positions.into_flattened());
    let rows = positions.len() / 3;
    named(py, "AutoCage", (positions.reshape([rows, 3])?, least, most, cage.inwards))
}

/// The UDIM numbers of the tiles that the charts of a mesh cover, in order.
///
/// Parameters
/// ----------
/// positions, normals, uvs, indices
///     The mesh, as for bake.
/// source : str
///     Its convention, one of CONVENTIONS: rows of tiles count upwards in the image, where glTF's v points
///     down.
///
/// Raises
/// ------
/// TypeError, ValueError
///     As bake; charts where no tile has a number.
#[pyfunction]
#[pyo3(signature = (positions, normals, uvs, indices=None, *, source="gltf"))]
pub fn udim_tiles(
    positions: &Bound<'_, PyAny>,
    normals: &Bound<'_, PyAny>,
    uvs: &Bound<'_, PyAny>,
    indices: Option<&Bound<'_, PyAny>>,
    source: &str,
) -> PyResult<Vec<u32>> {
    let arrays = MeshArrays::new(positions, normals, uvs, indices, None)?;
    let mesh = arrays.view()?;
    let tangents = vec![[1.0, 0.0, 0.0, 1.0]; mesh.corner_count()];
    let low = LowSurface::new(mesh, &tangents).map_err(bake_error)?;
    let tiles = udims_of(&[low], convention("source", source)?, None).map_err(bake_error)?;
    Ok(tiles.into_iter().map(Udim::number).collect())
}

/// The arrays of a low mesh.
struct LowArrays<'py> {
    mesh: MeshArrays<'py>,
    tangents: Vec<[f32; 4]>,
}

impl<'py> LowArrays<'py> {
    fn new(
        positions: &Bound<'py, PyAny>,
        normals: &Bound<'py, PyAny>,
        uvs: &Bound<'py, PyAny>,
        indices: Option<&Bound<'py, PyAny>>,
        tangents: &Bound<'py, PyAny>,
    ) -> PyResult<Self> {
        let mesh = MeshArrays::new(positions, normals, uvs, indices, None)?;
        let tangents = Rows::<4>::new("tangents", "C", tangents)?.packed()?.to_vec();
        Ok(Self { mesh, tangents })
    }

    fn surface(&self) -> PyResult<LowSurface<'_>> {
        LowSurface::new(self.mesh.view()?, &self.tangents).map_err(bake_error)
    }
}

/// The arrays of a high mesh.
struct HighArrays<'py> {
    positions: Rows<'py, 3>,
    normals: Option<Rows<'py, 3>>,
    indices: IndexArray,
}

impl<'py> HighArrays<'py> {
    fn new(
        positions: &Bound<'py, PyAny>,
        indices: Option<&Bound<'py, PyAny>>,
        normals: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Self> {
        let positions = Rows::new("high_positions", "W", positions)?;
        let normals = normals.map(|normals| Rows::new("high_normals", "W", normals)).transpose()?;
        let indices = IndexArray::new(indices)?;
        if matches!(indices.shape[..], [_, 4]) {
            return Err(PyValueError::new_err(
                "high_indices must be triangles, shape (G, 3); split the quads",
            ));
        }
        Ok(Self { positions, normals, indices })
    }

    fn surface(&self) -> PyResult<HighSurface<'_>> {
        let normals = self.normals.as_ref().map(Rows::view).transpose()?;
        HighSurface::new(self.positions.view()?, normals, self.indices.view()).map_err(bake_error)
    }
}

/// The vectors of an image.
struct Texels {
    /// Texels per row, and rows.
    size: [u32; 2],
    vectors: Vec<[f32; 3]>,
}

impl Texels {
    fn new(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        let array = array_of(name, value)?;
        let &[height, width, 3] = array.shape() else {
            let shape = shape_text(array.shape());
            return Err(PyValueError::new_err(format!("{name} must have shape (H, W, 3), not {shape}")));
        };
        let size = [width, height].map(|side| u32::try_from(side).unwrap_or(u32::MAX));
        let codes = coded::<u8>(&array).or_else(|| coded::<u16>(&array));
        let vectors = match codes {
            Some(vectors) => vectors,
            None => {
                let rows = array.call_method1("reshape", ((height * width, 3),))?;
                Rows::<3>::new(name, "H * W", &rows)?.packed()?.to_vec()
            }
        };
        Ok(Self { size, vectors })
    }
}

/// The vectors of codes; none for arrays of another type.
fn coded<T: numpy::Element + Copy + darboux::Channel>(
    array: &Bound<'_, PyUntypedArray>,
) -> Option<Vec<[f32; 3]>> {
    let codes: PyReadonlyArrayDyn<'_, T> = array.extract().ok()?;
    let codes: Vec<T> = codes.as_array().iter().copied().collect();
    Some(codes.as_chunks::<3>().0.iter().map(|&texel| TexelLayout::RGB.vector(texel)).collect())
}

/// The states of a bake's texels.
fn states(baked: &Bound<'_, PyAny>, [width, height]: [u32; 2]) -> PyResult<Vec<TexelState>> {
    let states: PyReadonlyArray2<'_, u8> = baked.getattr("states")?.extract()?;
    let wrong = || PyValueError::new_err("baked.states does not fit the map; pass what bake returned");
    if states.shape() != [height as usize, width as usize] {
        return Err(wrong());
    }
    let states: Option<Vec<TexelState>> =
        states.as_array().iter().map(|&number| TexelState::from_number(number)).collect();
    states.ok_or_else(wrong)
}

fn verification(py: Python<'_>, verified: Verification) -> PyResult<Bound<'_, PyAny>> {
    let places = verified.places.iter().map(|(_, errors)| errors);
    let mistakes = verified.mistakes.iter().map(|(_, errors)| errors);
    let mut fields = Vec::new();
    for errors in [&verified.all, &verified.rounding].into_iter().chain(places).chain(mistakes) {
        fields.push(statistics(py, errors)?);
    }
    let [width, height] = verified.heat_size.map(|side| side as usize);
    let heat: Bound<'_, PyArray2<f32>> = PyArray1::from_vec(py, verified.heat).reshape([height, width])?;
    fields.push(verified.points_without_hit.into_pyobject(py)?.into_any());
    fields.push(verified.points_without_frame.into_pyobject(py)?.into_any());
    fields.push(heat.into_any());
    named(py, "Verification", PyTuple::new(py, fields)?)
}

fn statistics<'py>(py: Python<'py>, errors: &ErrorStatistics) -> PyResult<Bound<'py, PyAny>> {
    let ErrorStatistics { points, median, mean, p95, p99, worst, .. } = *errors;
    named(py, "ErrorStatistics", (points, median, mean, p95, p99, worst))
}
