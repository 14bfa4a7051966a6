//! How normals are generated: flat, smooth or creased.

use darboux::{NormalOptions, Shading};

use super::angle::degrees;

/// Flat, smooth or creased.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShadingChoice {
    Flat,
    Smooth,
    Crease(f32),
}

impl ShadingChoice {
    /// The options of the library.
    pub fn options(self) -> NormalOptions {
        let smooth = NormalOptions::default();
        match self {
            Self::Flat => smooth.with_shading(Shading::Flat),
            Self::Smooth => smooth,
            Self::Crease(crease) => smooth.with_crease(crease),
        }
    }
}

/// `--normals` of `darboux tangents`: whether normals are generated first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NormalsChoice {
    Keep,
    Generate(ShadingChoice),
}

impl NormalsChoice {
    /// The options of the library; `None` if no normals are generated.
    pub fn options(self) -> Option<NormalOptions> {
        match self {
            Self::Keep => None,
            Self::Generate(shading) => Some(shading.options()),
        }
    }
}

/// Parses a shading.
pub fn shading(text: &str) -> Result<ShadingChoice, String> {
    match (text, text.strip_prefix("crease=").map(degrees::<f32>)) {
        ("flat", _) => Ok(ShadingChoice::Flat),
        ("smooth", _) => Ok(ShadingChoice::Smooth),
        (_, Some(Ok(degrees))) => Ok(ShadingChoice::Crease(degrees)),
        (_, Some(Err(_))) => Err("expected an angle of 0 to 180 degrees, as in crease=30".into()),
        _ => Err("expected flat, smooth or crease=DEG".into()),
    }
}

/// Parses a shading or "keep".
pub fn normals_choice(text: &str) -> Result<NormalsChoice, String> {
    if text == "keep" {
        return Ok(NormalsChoice::Keep);
    }
    let made = shading(text).map(NormalsChoice::Generate);
    made.map_err(|problem| problem.replace("expected flat", "expected keep, flat"))
}
