//! [`Map`]: a decoded normal map and the judgement on it, as the rules read it.

use darboux::{BitangentDirection, MapJudgement, TexelLayout, judge_normal_map};
use darboux_io::image::{DecodeLimits, RgbaImage};

/// The normal map of a material, or one that is checked alone.
pub struct Map {
    /// The judgement, or why the image could not be decoded.
    pub judgement: Result<MapJudgement, String>,
    /// Where green should point.
    pub wanted: BitangentDirection,
}

impl Map {
    /// Decodes and judges an image file.
    pub fn read(file: &[u8], wanted: BitangentDirection) -> Self {
        let judged = RgbaImage::decode(file, &DecodeLimits::default()).map_err(|error| error.to_string());
        let judgement = judged.and_then(|image| {
            let size = [image.width, image.height].map(|side| side as usize);
            judge_normal_map(&image.texels, size, TexelLayout::RGBA).map_err(|error| error.to_string())
        });
        Self { judgement, wanted }
    }
}
