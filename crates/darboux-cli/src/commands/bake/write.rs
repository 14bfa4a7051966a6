//! Encodes the images as PNG files and writes them.

use std::path::{Path, PathBuf};

use darboux::{Channel, Convention, TexelLayout};
use darboux_bake::{BakeOptions, Images};

use darboux_io::image::{PngImage, Sample};
use darboux_io::{Outputs, SaveOptions};
use serde::Serialize;

use super::arguments::{BakeArguments, MapChoice};
use crate::interrupt;
use crate::paths::{is_png, refuse_missing_folder};

/// A map that was written.
#[derive(Debug, Serialize)]
pub struct WrittenMap {
    pub map: String,
    pub file: String,
    pub bits: u8,
    /// The values that black and white mean, one pair per channel; none where the map is a direction.
    pub range: Vec<[f32; 2]>,
}

/// The maps that were written.
#[derive(Debug, Default)]
pub struct WrittenMaps {
    pub maps: Vec<WrittenMap>,
    /// The normal map, if it was chosen.
    pub normal: Option<PngImage>,
}

/// The chosen maps, each once, with their files.
fn maps_of(arguments: &BakeArguments) -> Vec<(MapChoice, PathBuf)> {
    let mut maps: Vec<MapChoice> = Vec::new();
    for &map in &arguments.map {
        if !maps.contains(&map) {
            maps.push(map);
        }
    }
    let output = &arguments.output;
    match maps[..] {
        [map] => vec![(map, output.clone())],
        _ => maps.iter().map(|&map| (map, output.with_extension(format!("{}.png", map.name())))).collect(),
    }
}

/// Refuses outputs that are not PNGs, exist, or lie in no folder.
pub fn refuse_outputs(arguments: &BakeArguments) -> Result<(), String> {
    refuse_missing_folder(&arguments.output)?;
    if !is_png(&arguments.output) {
        let shown = arguments.output.display();
        return Err(format!("{shown}: the map is a PNG; its name must end in .png"));
    }
    refuse_other_results(arguments)?;
    for path in all_outputs(arguments) {
        if path.is_dir() {
            return Err(format!("{} is a folder; choose a file in it", path.display()));
        }
        if path.exists() && !arguments.force {
            return Err(format!(
                "{}: exists; use --force to replace it, or choose another name",
                path.display()
            ));
        }
    }
    Ok(())
}

/// Refuses a model and a heat map that cannot be what was asked for.
fn refuse_other_results(arguments: &BakeArguments) -> Result<(), String> {
    let BakeArguments { map, write_model, heat_map, heat_model, verify, .. } = arguments;
    let needs_normals = [(write_model.is_some(), "--write-model"), (*verify, "--verify")];
    if let Some((_, option)) = needs_normals.iter().find(|(is_set, _)| *is_set)
        && !map.contains(&MapChoice::Normal)
    {
        return Err(format!("{option} needs a normal map; add normal to --map"));
    }
    for model in write_model.iter().chain(heat_model) {
        refuse_missing_folder(model)?;
        if !model.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("glb")) {
            return Err(format!("{}: the model is a GLB; its name must end in .glb", model.display()));
        }
    }
    if write_model.is_some() {
        let conversion = arguments.map_convention().to(Convention::GLTF);
        if conversion.inverts_red() || conversion.inverts_green() {
            return Err(
                "--write-model needs a map in glTF's convention; leave --convention out, or convert the map afterwards"
                    .to_owned(),
            );
        }
    }
    if let Some(picture) = heat_map {
        refuse_missing_folder(picture)?;
        if !is_png(picture) {
            return Err(format!("{}: the heat map is a PNG; its name must end in .png", picture.display()));
        }
    }
    let all = all_outputs(arguments);
    match (1..all.len()).find(|&i| all[..i].contains(&all[i])) {
        Some(twice) => Err(format!("{}: is named twice; choose another name", all[twice].display())),
        None => Ok(()),
    }
}

/// Every file that the arguments name for writing.
pub fn all_outputs(arguments: &BakeArguments) -> Vec<PathBuf> {
    let maps = maps_of(arguments).into_iter().map(|(_, path)| path);
    let BakeArguments { write_model, heat_map, heat_model, .. } = arguments;
    let scale = heat_model.as_deref().map(scale_of);
    maps.chain([write_model, heat_map, heat_model].into_iter().flatten().cloned()).chain(scale).collect()
}

/// The picture of the scale beside a painted model.
pub fn scale_of(heat_model: &Path) -> PathBuf {
    heat_model.with_extension("scale.png")
}

/// Stages an image and returns its path. Errors are one sentence each.
pub fn stage(image: &PngImage, path: &Path, force: bool, outputs: &mut Outputs) -> Result<String, String> {
    let options = SaveOptions::default().with_force(force);
    image.stage(path, &options, outputs).map_err(|error| error.to_string())?;
    Ok(path.display().to_string())
}

/// Gives all outputs their names. Errors are one sentence each.
pub fn commit(outputs: Outputs) -> Result<(), String> {
    let _guard = interrupt::writing();
    outputs.commit().map(drop).map_err(|error| error.to_string())
}

/// Stages all maps. Errors are one sentence each.
pub fn stage_maps(
    arguments: &BakeArguments,
    images: &Images,
    options: &BakeOptions,
    outputs: &mut Outputs,
) -> Result<WrittenMaps, String> {
    let mut written = WrittenMaps::default();
    for (map, path) in maps_of(arguments) {
        let bits = arguments.bits.unwrap_or_else(|| map.default_bits());
        let range = range(map, images, options);
        let image = match bits {
            8 => encode::<u8>(map, images, &range, &path)?,
            _ => encode::<u16>(map, images, &range, &path)?,
        };
        let file = stage(&image, &path, arguments.force, outputs)?;
        written.maps.push(WrittenMap { map: map.name(), file, bits, range });
        if map == MapChoice::Normal {
            written.normal = Some(image);
        }
    }
    Ok(written)
}

/// What black and white mean: heights from as far inside to as far outside as rays can reach, positions the box around all of them.
fn range(map: MapChoice, images: &Images, options: &BakeOptions) -> Vec<[f32; 2]> {
    match map {
        MapChoice::Normal | MapChoice::ObjectNormal => Vec::new(),
        MapChoice::Ao => vec![[0.0, 1.0]],
        MapChoice::Height => {
            let heights = images.height.iter().flatten();
            let largest = heights.fold(0f32, |largest, height| largest.max(height.abs()));
            let reach = options.distance[0].max(options.distance[1]).max(largest);
            vec![[-reach, reach]]
        }
        MapChoice::Position => (0..3)
            .map(|axis| {
                let places = || images.position.iter().flatten().map(move |position| position[axis]);
                let (least, greatest) =
                    (places().fold(f32::INFINITY, f32::min), places().fold(f32::NEG_INFINITY, f32::max));
                [least, greatest]
            })
            .collect(),
    }
}

fn encode<C: Channel + Sample>(
    map: MapChoice,
    images: &Images,
    range: &[[f32; 2]],
    path: &Path,
) -> Result<PngImage, String> {
    let vector = |vector: &[f32; 3]| TexelLayout::<3>::RGB.texel::<C>(*vector);
    // From the range to -1 to 1, which is what a texel of a vector holds.
    let signed =
        |x: f32, [from, to]: [f32; 2]| if to > from { 2.0 * (x - from) / (to - from) - 1.0 } else { 0.0 };
    let position = |place: &[f32; 3]| vector(&[0, 1, 2].map(|i| signed(place[i], range[i])));
    let number = |x: &f32| vector(&[signed(*x, range[0]), 0.0, 0.0])[0];
    let (name, size) = (path.display().to_string(), images.size);
    let rgb = |texels: Vec<[C; 3]>| PngImage::from_rgb(&name, size, &texels);
    let grey = |texels: Vec<C>| PngImage::from_grey(&name, size, &texels);
    let image = match map {
        MapChoice::Normal => rgb(images.normal.iter().flatten().map(vector).collect()),
        MapChoice::ObjectNormal => rgb(images.object_normal.iter().flatten().map(vector).collect()),
        MapChoice::Position => rgb(images.position.iter().flatten().map(position).collect()),
        MapChoice::Height => grey(images.height.iter().flatten().map(number).collect()),
        MapChoice::Ao => grey(images.occlusion.iter().flatten().map(number).collect()),
    };
    image.map_err(|error| error.to_string())
}
