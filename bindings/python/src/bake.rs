//! Bakes the detail of high meshes into images.

use darboux::{Cancel, Context, Convention};
use darboux_bake::{
    BakeError, BakeOptions, BakeReport, Baked, Bitangent, HighSurface, LowSurface, MapKind, MapSet,
    bake as bake_surfaces, inflated_cage,
};
use numpy::PyArray1;
use numpy::prelude::*;
use pyo3::exceptions::{PyMemoryError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::arrays::Rows;
use crate::choices::choice;
use crate::convention::convention;
use crate::mesh::{IndexArray, MeshArrays};
use crate::numbers::{Natural, Threads, natural};
use crate::results::named;
use crate::threads::run_interruptibly;

const MAPS: &[(&str, MapKind)] = &[
    ("normal", MapKind::Normal),
    ("object-normal", MapKind::ObjectNormal),
    ("height", MapKind::Height),
    ("ao", MapKind::Occlusion),
    ("position", MapKind::Position),
];

const BITANGENTS: &[(&str, Bitangent)] = &[("pixel", Bitangent::PerPixel), ("vertex", Bitangent::PerVertex)];

/// Bake the detail of a high mesh into images over the UVs of a low mesh.
///
/// From every texel that a triangle of the low mesh covers, a ray passes from outside through it; the first triangle of the high mesh that it hits gives
/// the content. The first triangle owns texels that several cover. Texels without a hit are filled from around.
///
/// Parameters
/// ----------
/// positions, normals, uvs, indices
///     The low mesh, as for generate_tangents; triangles only.
/// tangents : (C, 4) array_like
///     One per corner, as generate_tangents returns them. The sign w in a glTF file's TANGENT is the opposite of theirs: negate it first.
/// high_positions : (W, 3) array_like
/// high_indices : (D,) or (G, 3) array_like of integers, optional
///     Triangles, counter-clockwise seen from the front. Without indices, every vertex is a corner of its own.
/// high_normals : (W, 3) array_like, optional
///     Without, every triangle is flat.
/// size : (int, int)
///     Width and height in texels.
/// distance : (float, float)
///     How far outside the low mesh rays begin and how far inside they end, in units of the positions.
/// cage : (V, 3) array_like or float, optional
///     Rays begin on the low mesh with its vertices moved to these positions, or outwards by this distance along smooth normals, so that hard edges
///     leave no gaps; they end inside as `distance` says.
/// maps : sequence of str
///     Of 'normal', 'object-normal', 'height', 'ao' and 'position'. They share rays.
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
///     Rays of ambient occlusion per sample, and how far surfaces occlude each other.
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
    padding=None, back_faces=false, ao_rays=64, ao_distance=f32::INFINITY, threads=None
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
    threads: Option<Threads>,
) -> PyResult<Bound<'py, PyAny>> {
    let kinds = maps.iter().map(|name| choice("maps", name, MAPS)).collect::<PyResult<Vec<_>>>()?;
    let conventions: [Convention; 2] = [convention("source", source)?, convention("target", target)?];
    let options = BakeOptions::new([size.0.0, size.1.0], distance.into())
        .with_maps(MapSet::of(&kinds))
        .with_samples_per_axis(samples)
        .with_surface_convention(conventions[0])
        .with_map_convention(conventions[1])
        .with_bitangent(choice("bitangent", bitangent, BITANGENTS)?)
        .with_padding(padding.map(|Natural(texels)| texels))
        .with_back_faces(back_faces)
        .with_occlusion(ao_rays, ao_distance);
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
    let high = [high.map_err(bake_error)?];
    let cage = cage.map(|cage| Cage::new(cage, &surface)).transpose()?;
    let surface = match &cage {
        Some(Cage::Given(rows)) => surface.with_cage(rows.view()?).map_err(bake_error)?,
        Some(Cage::Inflated(rows)) => surface.with_cage(rows).map_err(bake_error)?,
        None => surface,
    };
    let cancel = Cancel::new();
    let mut context = Context::new().with_cancel(&cancel);
    let work = |_: &std::sync::mpsc::Sender<()>| {
        bake_surfaces(&[surface], &high, &options, &mut context, &mut |_| {})
    };
    let baked = run_interruptibly(py, Threads::or_all(threads), work, |()| Ok(()), || cancel.cancel())?;
    result(py, baked.map_err(bake_error)?)
}

/// Positions of a cage.
enum Cage<'py> {
    Given(Rows<'py, 3>),
    Inflated(Vec<[f32; 3]>),
}

impl<'py> Cage<'py> {
    fn new(value: &Bound<'py, PyAny>, surface: &LowSurface<'_>) -> PyResult<Self> {
        match value.extract::<f32>() {
            Ok(offset) => inflated_cage(surface.mesh(), offset).map(Self::Inflated).map_err(bake_error),
            Err(_) => Rows::new("cage", "V", value).map(Self::Given),
        }
    }
}

fn bake_error(error: BakeError) -> PyErr {
    match error {
        BakeError::Memory { .. } => PyMemoryError::new_err(error.to_string()),
        error => PyValueError::new_err(error.to_string()),
    }
}

/// The images as arrays, and the counts.
fn result(py: Python<'_>, baked: Baked) -> PyResult<Bound<'_, PyAny>> {
    let images = baked.images;
    let [width, height] = images.size.map(|side| side as usize);
    let vectors = |image: Option<Vec<[f32; 3]>>| {
        image
            .map(|image| PyArray1::from_vec(py, image.into_flattened()).reshape([height, width, 3]))
            .transpose()
    };
    let numbers = |image: Option<Vec<f32>>| {
        image.map(|image| PyArray1::from_vec(py, image).reshape([height, width])).transpose()
    };
    let states: Vec<u8> = images.states.iter().map(|state| state.number()).collect();
    let fields = (
        vectors(images.normal)?,
        vectors(images.object_normal)?,
        numbers(images.height)?,
        numbers(images.occlusion)?,
        vectors(images.position)?,
        PyArray1::from_vec(py, states).reshape([height, width])?,
        report(py, &baked.report)?,
    );
    named(py, "BakedMaps", fields)
}

fn report<'py>(py: Python<'py>, report: &BakeReport) -> PyResult<Bound<'py, PyAny>> {
    let fields = [
        report.charted_texels,
        report.missed_texels,
        report.back_facing_texels,
        report.overlapping_texels,
        report.chart_area,
        report.inverted_texels,
        report.frameless_texels,
        report.below_horizon_texels,
        report.rays,
        report.degenerate_triangles,
        report.oversized_triangles,
        report.non_finite_low_triangles,
        report.non_finite_triangles,
    ];
    named(py, "BakeReport", PyTuple::new(py, fields)?)
}
