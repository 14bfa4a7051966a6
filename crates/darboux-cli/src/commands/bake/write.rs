//! Writes the files of the maps.

use std::path::Path;

use darboux::Choice;
use darboux_bake::{BakeOptions, Images, MapKind};
use darboux_io::image::PngImage;
use darboux_io::{Outputs, SaveOptions};
use serde::Serialize;

use super::arguments::BakeArguments;
use super::encode::{self, Encoding};
use super::outputs::maps_of;
use crate::interrupt;

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
        let bits = arguments.bits.unwrap_or_else(|| encode::default_bits(map));
        let encoding = Encoding::new(map, images, options, arguments.content.texture.as_deref());
        let image = encoding.png(&path.display().to_string(), images, bits)?;
        let file = stage(&image, &path, arguments.force, outputs)?;
        written.maps.push(WrittenMap { map: map.name().to_owned(), file, bits, range: encoding.range });
        if map == MapKind::Normal {
            written.normal = Some(image);
        }
    }
    Ok(written)
}
