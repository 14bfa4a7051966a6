//! What belongs to a bake: the error of its map in degrees, maps in another space, tiles.

use std::mem::take;

use darboux::Context;
use darboux_bake::{
    ConvertedSpace, Images, LowSurface, NormalSpace, NormalTexture, SpaceOptions, TexelState, Udim,
    Verification, convert_space, udims_of,
};
use serde::Serialize;

use crate::arena::{Arena, with_arena};
use crate::bake::{Outcome, tell, with_models};
use crate::bake_arrays::{BakeArrays, GivenMap};
use crate::bake_meshes::{with_low_mesh, with_meshes};
use crate::bake_settings::{Options, Setup, Surfaces, read_options, text};
use crate::inputs::resized;
use crate::prepared_models::with_low_model;

/// The normal map of a bake: three floats per texel.
#[unsafe(no_mangle)]
pub extern "C" fn given_normals(texels: usize) -> *mut f32 {
    with_arena(|arena| resized(&mut arena.bake.given_normals, 3 * texels))
}

/// The states of its texels.
#[unsafe(no_mangle)]
pub extern "C" fn given_states(texels: usize) -> *mut u8 {
    with_arena(|arena| resized(&mut arena.bake.given_states, texels))
}

/// A normal map: three floats per texel.
#[unsafe(no_mangle)]
pub extern "C" fn map_floats(texels: usize) -> *mut f32 {
    let mut floats = Vec::new();
    let address = resized(&mut floats, 3 * texels);
    with_arena(|arena| arena.bake.given_map = GivenMap::Floats(floats));
    address
}

/// A normal map: three codes of 8 bits per texel.
#[unsafe(no_mangle)]
pub extern "C" fn map_bytes(texels: usize) -> *mut u8 {
    let mut codes = Vec::new();
    let address = resized(&mut codes, 3 * texels);
    with_arena(|arena| arena.bake.given_map = GivenMap::Bytes(codes));
    address
}

/// A normal map: three codes of 16 bits per texel.
#[unsafe(no_mangle)]
pub extern "C" fn map_words(texels: usize) -> *mut u16 {
    let mut codes = Vec::new();
    let address = resized(&mut codes, 3 * texels);
    with_arena(|arena| arena.bake.given_map = GivenMap::Words(codes));
    address
}

/// The address of the errors of a verification, one float per texel of its picture.
#[unsafe(no_mangle)]
pub extern "C" fn verified_heat() -> *const f32 {
    with_arena(|arena| arena.bake.heat.as_ptr())
}

/// The address of the texels of a conversion, three floats each.
#[unsafe(no_mangle)]
pub extern "C" fn converted_texels() -> *const [f32; 3] {
    with_arena(|arena| arena.bake.converted.as_ptr())
}

/// Verifies the map of a bake of models. Returns the address of the JSON.
#[unsafe(no_mangle)]
pub extern "C" fn verify_models() -> *const u8 {
    with_arena(|arena| {
        let arrays = &mut arena.bake;
        let files = take(&mut arrays.files);
        let work = |surfaces: Surfaces<'_>, context: &mut Context| verified(arrays, &surfaces, context);
        let result = with_models(files, &arrays.options, &mut arena.context, work);
        put_verified(arrays, result)
    })
}

/// Verifies the map of a bake of meshes. Returns the address of the JSON.
#[unsafe(no_mangle)]
pub extern "C" fn verify_meshes() -> *const u8 {
    with_arena(|arena| {
        let Arena { vertices, surface, bake: arrays, context, .. } = arena;
        let work = |surfaces: Surfaces<'_>, context: &mut Context| verified(arrays, &surfaces, context);
        let result = with_meshes((vertices, surface), arrays, context, work);
        put_verified(arrays, result)
    })
}

fn verified(
    arrays: &BakeArrays,
    surfaces: &Surfaces<'_>,
    context: &mut Context,
) -> Result<Verification, String> {
    let Surfaces { prepared, settings } = surfaces;
    let states = arrays.given_states.iter().map(|&number| TexelState::from_number(number));
    let states: Option<Vec<_>> = states.collect();
    let states = states.ok_or("baked.states has numbers that no state has; pass what bake returned")?;
    let normals = arrays.given_normals.as_chunks().0;
    let images = Images::of_normals(settings.size, states, normals).map_err(text)?;
    let map = arrays.given_map.vectors();
    let written =
        NormalTexture::new(settings.size, map, settings.map_convention, settings.surface_convention);
    prepared.verify(&images, &written.map_err(text)?, settings, context, &mut tell).map_err(text)
}

/// What a verification reports beside the picture of its errors.
#[derive(Serialize)]
struct VerificationReport<'a> {
    #[serde(flatten)]
    verification: &'a Verification,
    parts: Vec<PartErrors<'a>>,
}

/// The errors of a part of the low model.
#[derive(Serialize)]
struct PartErrors<'a> {
    name: &'a str,
    #[serde(flatten)]
    errors: &'a darboux_bake::ErrorStatistics,
}

fn put_verified(arrays: &mut BakeArrays, result: Result<(Verification, Setup), String>) -> *const u8 {
    let (mut verification, setup) = match result {
        Ok(verified) => verified,
        Err(sentence) => return arrays.put_json(&Outcome::<()>::Error(sentence)),
    };
    arrays.heat = std::mem::take(&mut verification.heat);
    let parts = setup.part_names.iter().zip(&verification.surfaces);
    let parts = parts.map(|(name, errors)| PartErrors { name, errors }).collect();
    arrays.put_json(&Outcome::Report(VerificationReport { verification: &verification, parts }))
}

/// Converts a map of a model into another space. Returns the address of the JSON.
#[unsafe(no_mangle)]
pub extern "C" fn convert_space_of_model() -> *const u8 {
    with_arena(|arena| {
        let Arena { bake: arrays, context, .. } = arena;
        let file = arrays.files.pop().unwrap_or_default();
        let result = read_options(&arrays.options).and_then(|options| {
            with_low_model(file, &options, |low| converted(arrays, &options, low, context))
        });
        put_converted(arrays, result)
    })
}

/// Converts a map of a mesh into another space. Returns the address of the JSON.
#[unsafe(no_mangle)]
pub extern "C" fn convert_space_of_mesh() -> *const u8 {
    with_arena(|arena| {
        let Arena { vertices, surface, bake: arrays, context, .. } = arena;
        let result = read_options(&arrays.options).and_then(|options| {
            let work =
                |low: LowSurface<'_>, context: &mut Context| converted(arrays, &options, &[low], context);
            with_low_mesh((vertices, surface), arrays, context, work)
        });
        put_converted(arrays, result)
    })
}

fn converted(
    arrays: &BakeArrays,
    options: &Options,
    low: &[LowSurface<'_>],
    context: &mut Context,
) -> Result<ConvertedSpace, String> {
    let to = if options.to_object { NormalSpace::Object } else { NormalSpace::Tangent };
    let settings = SpaceOptions::new(options.size, to)
        .with_bitangent(options.bitangent.0)
        .with_surface_convention(options.mesh_convention()?)
        .with_conventions(options.source_convention()?, options.convention()?)
        .with_padding(options.padding)
        .with_udim(options.udim()?);
    convert_space(low, &arrays.given_map.vectors(), &settings, context).map_err(text)
}

fn put_converted(arrays: &mut BakeArrays, result: Result<ConvertedSpace, String>) -> *const u8 {
    let outcome = match result {
        Ok(mut converted) => {
            arrays.converted = std::mem::take(&mut converted.texels);
            Outcome::Report(converted)
        }
        Err(sentence) => Outcome::Error(sentence),
    };
    arrays.put_json(&outcome)
}

/// The tiles that the charts of a model cover. Returns the address of the JSON.
#[unsafe(no_mangle)]
pub extern "C" fn tiles_of_model() -> *const u8 {
    with_arena(|arena| {
        let arrays = &mut arena.bake;
        let file = arrays.files.pop().unwrap_or_default();
        let result = read_options(&arrays.options)
            .and_then(|options| with_low_model(file, &options, |low| tiles(&options, low)));
        put_tiles(arrays, result)
    })
}

/// The tiles that the charts of a mesh cover. Returns the address of the JSON.
#[unsafe(no_mangle)]
pub extern "C" fn tiles_of_mesh() -> *const u8 {
    with_arena(|arena| {
        let Arena { vertices, surface, bake: arrays, context, .. } = arena;
        let result = read_options(&arrays.options).and_then(|options| {
            with_low_mesh((vertices, surface), arrays, context, |low, _| tiles(&options, &[low]))
        });
        put_tiles(arrays, result)
    })
}

fn tiles(options: &Options, low: &[LowSurface<'_>]) -> Result<Vec<u32>, String> {
    let tiles = udims_of(low, options.mesh_convention()?, None).map_err(text)?;
    Ok(tiles.into_iter().map(Udim::number).collect())
}

fn put_tiles(arrays: &mut BakeArrays, result: Result<Vec<u32>, String>) -> *const u8 {
    arrays.put_json(&match result {
        Ok(tiles) => Outcome::Report(tiles),
        Err(sentence) => Outcome::Error(sentence),
    })
}
