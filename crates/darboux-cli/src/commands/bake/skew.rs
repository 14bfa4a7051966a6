//! `--skew`: an amount for all rays, or a painted map.

use std::path::PathBuf;

use darboux_bake::{BakeError, ColorTexture, LowSurface, SkewCorrection, with_skew};
use darboux_io::image::{DecodeLimits, RgbaImage};
use darboux_io::read_regular;

use crate::options::reading::ReadOptions;

/// What `--skew` names.
#[derive(Clone, Debug, PartialEq)]
pub enum SkewChoice {
    /// From 0 to 1.
    Amount(f32),
    Image(PathBuf),
}

/// An amount, or a map that was read.
pub enum Skew {
    Amount(f32),
    Map(ColorTexture),
}

impl Skew {
    /// Reads the map. None without `--skew`. Errors are one sentence each.
    pub fn read(choice: Option<&SkewChoice>, reading: &ReadOptions) -> Result<Option<Self>, String> {
        let path = match choice {
            None => return Ok(None),
            Some(SkewChoice::Amount(amount)) => return Ok(Some(Self::Amount(*amount))),
            Some(SkewChoice::Image(path)) => path,
        };
        let shown = path.display();
        let bytes = read_regular(path).map_err(|error| error.to_string())?;
        let image = RgbaImage::decode(
            &bytes,
            &DecodeLimits::of_file(bytes.len(), reading.load_options().memory_limit),
        );
        let image = image.map_err(|error| format!("{shown}: the image {error}"))?;
        let map = ColorTexture::new([image.width, image.height], image.texels, false);
        map.map(|map| Some(Self::Map(map))).map_err(|error| format!("{shown}: {error}"))
    }

    /// The surfaces with this correction.
    pub fn on<'a>(&'a self, low: Vec<LowSurface<'a>>) -> Result<Vec<LowSurface<'a>>, BakeError> {
        let correction = match self {
            Self::Amount(amount) => SkewCorrection::Everywhere(*amount),
            Self::Map(map) => SkewCorrection::Map(map),
        };
        with_skew(&low, correction)
    }
}

/// Parses `--skew`. The error is a clause.
pub fn skew(text: &str) -> Result<SkewChoice, String> {
    match text.parse::<f32>() {
        Ok(amount) if (0.0..=1.0).contains(&amount) => Ok(SkewChoice::Amount(amount)),
        Ok(_) => Err("expected an amount from 0 to 1, or an image".to_owned()),
        Err(_) => Ok(SkewChoice::Image(text.into())),
    }
}
