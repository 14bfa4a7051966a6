//! `bake` of `darboux/bake`: maps of a low mesh from the detail of a high one, both as arrays.
//!
//! The low mesh lies in the arena as the meshes of other functions do.

use darboux::{Context, Indices, Mesh, Strided, TangentOptions, write_tangents};
use darboux_bake::{Cages, HighSurface, LowSurface, PreparedSurfaces, with_cages};

use crate::arena::{Arena, with_arena};
use crate::bake::{bake_surfaces, put_baked};
use crate::bake_arrays::BakeArrays;
use crate::bake_settings::{Setup, Surfaces, bake_settings, read_options, text};
use crate::inputs::resized;
use crate::mesh_arrays::{Surface, Vertices, rows};

/// The tangents of the low mesh: four floats per corner.
#[unsafe(no_mangle)]
pub extern "C" fn low_tangents(corners: usize) -> *mut f32 {
    with_arena(|arena| resized(arena.bake.low_tangents.get_or_insert_default(), 4 * corners))
}

/// The cage: three floats per vertex of the low mesh.
#[unsafe(no_mangle)]
pub extern "C" fn cage_positions(vertices: usize) -> *mut f32 {
    with_arena(|arena| resized(arena.bake.cage.get_or_insert_default(), 3 * vertices))
}

/// Three floats per vertex of the high mesh.
#[unsafe(no_mangle)]
pub extern "C" fn high_positions(vertices: usize) -> *mut f32 {
    with_arena(|arena| resized(&mut arena.bake.high_positions, 3 * vertices))
}

/// Three floats per vertex of the high mesh.
#[unsafe(no_mangle)]
pub extern "C" fn high_normals(vertices: usize) -> *mut f32 {
    with_arena(|arena| resized(arena.bake.high_normals.get_or_insert_default(), 3 * vertices))
}

/// The vertex of each corner of the high mesh.
#[unsafe(no_mangle)]
pub extern "C" fn high_indices(corners: usize) -> *mut u32 {
    with_arena(|arena| resized(arena.bake.high_indices.get_or_insert_default(), corners))
}

/// Bakes the meshes in the arena. Returns the address of the JSON.
#[unsafe(no_mangle)]
pub extern "C" fn bake_meshes() -> *const u8 {
    with_arena(|arena| {
        let Arena { vertices, surface, bake: arrays, context, .. } = arena;
        let result = with_meshes((vertices, surface), arrays, context, bake_surfaces);
        put_baked(arrays, result)
    })
}

/// Works on the meshes in the arena. Errors: one sentence.
pub fn with_meshes<T>(
    low: (&Vertices, &Surface),
    arrays: &BakeArrays,
    context: &mut Context,
    work: impl FnOnce(Surfaces<'_>, &mut Context) -> Result<T, String>,
) -> Result<(T, Setup), String> {
    let options = read_options(&arrays.options)?;
    with_low_mesh(low, arrays, context, |low, context| {
        let cage = arrays.cage.as_deref();
        let origin =
            cage.map_or_else(|| options.ray_origin(), |_| options.ray_origin_with_cage("low.cage"))?;
        let diagonal = low.diagonal();
        let high = high_surface(arrays)?;
        let prepared = PreparedSurfaces::new(&[low], &[high], None, context).map_err(text)?;
        let cages = match cage {
            Some(given) => {
                Cages { positions: vec![rows(given).to_vec()], distance: origin.distance(diagonal) }
            }
            None => origin.cages(diagonal, &[low], &prepared, context).map_err(text)?,
        };
        let distance = cages.distance;
        let caged = options.straightened(with_cages(&[low], &cages.positions).map_err(text)?)?;
        let settings = bake_settings(&options, distance)?;
        let prepared = &prepared.with_low(&caged, context).map_err(text)?;
        let done = work(Surfaces { prepared, settings: &settings }, context)?;
        let setup =
            Setup { diagonal: low.diagonal(), distance, part_names: vec![String::new()], ..Setup::default() };
        Ok((done, setup))
    })
}

/// Works on the low mesh in the arena. Errors: one sentence.
pub fn with_low_mesh<T>(
    (vertices, surface): (&Vertices, &Surface),
    arrays: &BakeArrays,
    context: &mut Context,
    work: impl FnOnce(LowSurface<'_>, &mut Context) -> Result<T, String>,
) -> Result<T, String> {
    let (normals, uvs) = (rows(&vertices.normals), rows(&surface.uvs));
    let mesh = Mesh::triangles(vertices.positions(), normals, uvs, surface.indices());
    let mesh = mesh.map_err(|error| format!("the low mesh: {error}"))?;
    let tangents = match &arrays.low_tangents {
        Some(given) => rows(given).to_vec(),
        None => generated_tangents(&mesh, context)?,
    };
    work(LowSurface::new(mesh, &tangents).map_err(text)?, context)
}

/// MikkTSpace's tangents, as `generateTangents` gives them without options.
fn generated_tangents(mesh: &Mesh<'_>, context: &mut Context) -> Result<Vec<[f32; 4]>, String> {
    let mut tangents = vec![[0.0; 4]; mesh.corner_count()];
    let written = write_tangents(mesh, &TangentOptions::default(), context, &mut tangents);
    written.map_err(|error| format!("the low mesh: {error}"))?;
    Ok(tangents)
}

fn high_surface(arrays: &BakeArrays) -> Result<HighSurface<'_>, String> {
    let positions = rows(&arrays.high_positions);
    let normals = arrays.high_normals.as_deref().map(|normals| Strided::from(rows(normals)));
    let indices = arrays.high_indices.as_deref().map_or(Indices::Unindexed, Indices::U32);
    HighSurface::new(positions, normals, indices).map_err(|error| format!("the high mesh: {error}"))
}
