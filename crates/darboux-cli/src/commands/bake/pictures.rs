//! Pictures over the UV layout: where rays missed, and how large errors are.

use darboux_bake::{Baked, Images, TexelState, Verification};
use darboux_io::Outputs;
use darboux_io::image::PngImage;

use super::arguments::BakeArguments;
use super::outputs::picture_of_misses;
use super::report::advice;
use super::write::stage;
use crate::heat_scale::{HeatRange, ramp};
use crate::html_page::raster::Raster;

const OUTSIDE: [u8; 3] = [16, 16, 16];
const HIT: [u8; 3] = [96, 96, 96];
const MISSED: [u8; 3] = [230, 40, 40];
const MISSED_BEHIND: [u8; 3] = [255, 160, 0];

/// The rows of the gap between a heat map and its scale.
const GAP: usize = 8;

/// Draws the texels without a hit, if they are many, beside the map. Returns the path; none without a
/// picture. Errors are one sentence each.
pub fn misses(
    arguments: &BakeArguments,
    baked: &Baked,
    warnings: &mut Vec<String>,
    outputs: &mut Outputs,
) -> Result<Option<String>, String> {
    let path = picture_of_misses(arguments);
    if !advice::has_many_misses(&baked.report) {
        if path.exists() {
            warnings.push(format!(
                "{}: is of an earlier run, whose rays missed; this run has no such picture",
                path.display()
            ));
        }
        return Ok(None);
    }
    if path.exists() && !arguments.may_replace(&path) {
        let shown = path.display();
        warnings.push(format!("{shown}: exists and does not show this run; use --force to replace it"));
        return Ok(None);
    }
    let Raster { size, pixels } = of_misses(&baked.images);
    let image = PngImage::from_rgb(&path.display().to_string(), size, &pixels);
    stage(&image.map_err(|error| error.to_string())?, &path, arguments, outputs).map(Some)
}

/// The texels without a hit over the UV layout.
pub fn of_misses(images: &Images) -> Raster {
    let color = |state: &TexelState| match state {
        TexelState::Missed => MISSED,
        TexelState::MissedBehind => MISSED_BEHIND,
        TexelState::Baked => HIT,
        _ => OUTSIDE,
    };
    Raster { size: images.size, pixels: images.states.iter().map(color).collect() }
}

/// The errors of a verification with the scale below them. `most`: the longest side of the picture without
/// the scale.
pub fn heat_map(verification: &Verification, range: HeatRange, most: u32) -> Raster {
    let errors = Raster { size: verification.heat_size, pixels: heat_colors(verification, range) };
    let Raster { size: [width, height], mut pixels } = errors.at_most(most);
    pixels.resize(width as usize * (height as usize + GAP), [0; 3]);
    pixels.extend(range.rows(width as usize).concat());
    Raster { size: [width, (pixels.len() / width as usize) as u32], pixels }
}

/// The errors of a verification without a scale, as a texture. Texels outside the charts have the colour of
/// the texel before them, so that filters do not darken the borders.
pub fn heat_texture(name: &str, verification: &Verification, range: HeatRange) -> Result<PngImage, String> {
    let mut texels = heat_colors(verification, range);
    for at in 1..texels.len() {
        if verification.heat[at].is_nan() {
            texels[at] = texels[at - 1];
        }
    }
    PngImage::from_rgb(name, verification.heat_size, &texels).map_err(|error| error.to_string())
}

/// The scale alone, for a picture beside the painted model.
pub fn scale(name: &str, range: HeatRange) -> Result<PngImage, String> {
    const WIDTH: usize = 512;
    let rows = range.rows(WIDTH);
    let size = [WIDTH as u32, rows.len() as u32];
    PngImage::from_rgb(name, size, &rows.concat()).map_err(|error| error.to_string())
}

fn heat_colors(verification: &Verification, range: HeatRange) -> Vec<[u8; 3]> {
    let color = |error: &f32| match error.is_nan() {
        true => OUTSIDE,
        false => ramp(range.position(f64::from(*error))),
    };
    verification.heat.iter().map(color).collect()
}
