//! [`Map`]: a decoded normal map, the judgement on it and the votes of the meshes that use it, as the rules read them.

use darboux::{BitangentDirection, MapJudgement, TexelLayout, judge_normal_map};
use darboux_io::image::{DecodeLimits, RgbaImage};

use crate::facets::FacetVotes;

/// The normal map of a material, or one that is checked alone.
pub struct Map {
    /// The judgement, or why the image could not be decoded.
    pub judgement: Result<MapJudgement, String>,
    /// Where green should point.
    pub wanted: BitangentDirection,
    /// What the facets of the meshes that use the map say; no votes for a map that is checked alone.
    pub facets: FacetVotes,
}

impl Map {
    /// Decodes and judges an image file. `vote`: gives the votes of the meshes that use the map.
    pub fn read(
        file: &[u8],
        wanted: BitangentDirection,
        vote: impl FnOnce(&RgbaImage) -> FacetVotes,
    ) -> Self {
        match RgbaImage::decode(file, &DecodeLimits::default()) {
            Ok(image) => {
                let size = [image.width, image.height].map(|side| side as usize);
                let judgement = judge_normal_map(&image.texels, size, TexelLayout::RGBA);
                Self { judgement: judgement.map_err(|error| error.to_string()), wanted, facets: vote(&image) }
            }
            Err(error) => Self::unreadable(error.to_string(), wanted),
        }
    }

    /// A map that cannot be read, and why, as a clause.
    pub fn unreadable(problem: String, wanted: BitangentDirection) -> Self {
        Self { judgement: Err(problem), wanted, facets: FacetVotes::default() }
    }
}
