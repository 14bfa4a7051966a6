//! Writes the files of the maps.

use std::path::Path;

use darboux::Choice;
use darboux_bake::{BakeOptions, Images, MapKind, Udim};
use darboux_io::Outputs;
use darboux_io::image::PngImage;
use serde::Serialize;

use super::arguments::BakeArguments;
use super::dither::BlueNoise;
use super::encode::{Channels, Encoding, FileKind, Ranges};
use super::files::{LARGEST_HALF, Notes, file_bytes, png};
use super::outputs::{maps_of, packs_of};
use super::thumbnail::thumbnail;
use crate::html_page::raster::Raster;
use crate::interrupt;

/// A map that was written.
#[derive(Debug, Serialize)]
pub struct WrittenMap {
    pub map: String,
    pub file: String,
    /// The number of its tile; none where one image has all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub udim: Option<u32>,
    pub bits: u8,
    /// The values that black and white mean, one pair per channel; none where the map is a direction.
    pub range: Vec<[f32; 2]>,
}

/// The maps that were written.
#[derive(Debug, Default)]
pub struct WrittenMaps {
    pub maps: Vec<WrittenMap>,
    /// The normal map, if it was chosen and something uses it.
    pub normal: Option<PngImage>,
    /// For `--report`: a picture of each map.
    pub pictures: Vec<Raster>,
    /// About the numbers that files do not hold.
    pub warnings: Vec<String>,
}

/// Stages an image and returns its path. Errors are one sentence each.
pub fn stage(
    image: &PngImage,
    path: &Path,
    arguments: &BakeArguments,
    outputs: &mut Outputs,
) -> Result<String, String> {
    image.stage(path, &arguments.save_options(path), outputs).map_err(|error| error.to_string())?;
    Ok(path.display().to_string())
}

/// Gives all outputs their names. Errors are one sentence each.
pub fn commit(outputs: Outputs) -> Result<(), String> {
    let _guard = interrupt::writing();
    outputs.commit().map(drop).map_err(|error| error.to_string())
}

/// Stages all maps. `ranges`: those that are not the image's own. Errors are one sentence each.
pub fn stage_maps(
    arguments: &BakeArguments,
    images: &Images,
    options: &BakeOptions,
    ranges: &Ranges,
    outputs: &mut Outputs,
) -> Result<WrittenMaps, String> {
    let mut written = WrittenMaps::default();
    let kind = FileKind::of(&arguments.output).unwrap_or(FileKind::Png);
    let noise = arguments.dither.map(BlueNoise::new);
    let texture = arguments.content.texture.as_deref();
    let encoding = |map| Encoding::new(map, images, options, texture, ranges);
    let udim = options.udim.map(Udim::number);
    let mut stage_file =
        |path: &Path, name: &str, bits: u8, channels: &Channels<'_>, range: Vec<[f32; 2]>| {
            let notes = notes(name, &range);
            let noise = noise.as_ref().filter(|_| bits == 8);
            let shown = path.display().to_string();
            let bytes = file_bytes(kind, &shown, channels, bits, &notes, noise)?;
            let save = arguments.save_options(path);
            outputs.stage_bytes(path, &bytes, &save).map_err(|error| error.to_string())?;
            if kind == FileKind::Exr && bits == 16 {
                written.warnings.extend(warning_of_halves(name, &shown, channels));
            }
            written.pictures.extend(arguments.report.is_some().then(|| thumbnail(channels)));
            written.maps.push(WrittenMap { map: name.to_owned(), file: shown, udim, bits, range });
            Ok::<_, String>(())
        };
    for (map, path) in maps_of(arguments) {
        let bits = arguments.bits_of_map(kind, map);
        let encoding = encoding(map);
        let channels = Channels::of_map(map, &encoding, images);
        stage_file(&path, map.name(), bits, &channels, encoding.range.clone())?;
    }
    for (pack, path) in packs_of(arguments) {
        let encodings: Vec<_> = pack.maps.iter().map(|&map| (map, encoding(map))).collect();
        let bits = arguments.bits_of_packs(kind);
        let range = encodings.iter().flat_map(|(_, encoding)| encoding.range.clone()).collect();
        stage_file(&path, &pack.name, bits, &Channels::packed(&encodings, images), range)?;
    }
    let BakeArguments { verify, write_model, report, .. } = arguments;
    if arguments.maps().contains(&MapKind::Normal) && (*verify || write_model.is_some() || report.is_some()) {
        let encoding = encoding(MapKind::Normal);
        let channels = Channels::of_map(MapKind::Normal, &encoding, images);
        let bits = if kind == FileKind::Png { arguments.bits.unwrap_or(8) } else { 16 };
        let noise = noise.as_ref().filter(|_| bits == 8);
        written.normal = Some(png("the normal map", &channels, bits, &Vec::new(), noise)?);
    }
    Ok(written)
}

/// A warning where numbers of a map are too large for halves.
fn warning_of_halves(name: &str, file: &str, channels: &Channels<'_>) -> Option<String> {
    let is_too_large = channels.floats().iter().any(|x| x.abs() > LARGEST_HALF);
    is_too_large.then(|| {
        format!(
            "{file}: {name} has numbers beyond {LARGEST_HALF}, the largest that 16 bits hold, which are clamped \
             to it; add --bits 32"
        )
    })
}

/// What the file of a map says about its numbers: the values of black and white, where they are no shares.
fn notes(name: &str, range: &[[f32; 2]]) -> Notes {
    if range.iter().all(|range| *range == [0.0, 1.0]) {
        return Notes::new();
    }
    let list = |numbers: Vec<f32>| format!("{numbers:?}");
    vec![
        ("Map", name.to_owned()),
        ("Black", list(range.iter().map(|range| range[0]).collect())),
        ("White", list(range.iter().map(|range| range[1]).collect())),
        ("Scale", list(range.iter().map(|range| range[1] - range[0]).collect())),
        ("Middle", list(range.iter().map(|range| 0.5 * range[0] + 0.5 * range[1]).collect())),
    ]
}
