//! Encodes the images as PNG files and writes them.

use std::path::{Path, PathBuf};

use darboux::{Channel, TexelLayout};
use darboux_bake::{BakeOptions, Images};
use darboux_io::SaveOptions;
use darboux_io::image::{PngImage, Sample};
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

/// The chosen maps, each once, with their files.
pub fn outputs(arguments: &BakeArguments) -> Vec<(MapChoice, PathBuf)> {
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
    for (_, path) in outputs(arguments) {
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

/// Writes all maps. Errors are one sentence each.
pub fn write_maps(
    arguments: &BakeArguments,
    images: &Images,
    options: &BakeOptions,
) -> Result<Vec<WrittenMap>, String> {
    let mut written = Vec::new();
    for (map, path) in outputs(arguments) {
        let bits = arguments.bits.unwrap_or_else(|| map.default_bits());
        let range = range(map, images, options);
        let image = match bits {
            8 => encode::<u8>(map, images, &range, &path)?,
            _ => encode::<u16>(map, images, &range, &path)?,
        };
        let _guard = interrupt::writing();
        let saved = image.save(&path, &SaveOptions::default().with_force(arguments.force));
        let file = saved.map_err(|error| error.to_string())?.display().to_string();
        written.push(WrittenMap { map: map.name(), file, bits, range });
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
