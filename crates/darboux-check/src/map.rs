//! [`Map`]: a decoded normal map, the judgement on it and the votes of the meshes that use it, as the rules read them.

use darboux::{
    BitangentDirection, MapJudgement, MapVerdict, NormalMapJudge, SrgbMistake, TangentDirection, TexelLayout,
    judge_normal_map,
};
use darboux_io::image::{DecodeLimits, RgbaImage, linear_to_srgb, srgb_to_linear};

use crate::contradiction::Contradiction;
use crate::facets::{Arrangement, FacetVotes};
use crate::reordered::Reordered;

/// The normal map of a material, or one that is checked alone.
pub struct Map {
    /// The judgement, or why the image could not be decoded.
    pub judgement: Result<MapJudgement, String>,
    /// In bytes; 0 where the file itself could not be read.
    pub file_size: usize,
    /// Where the texels look as if they had gone through the transfer function of sRGB once too often: the judgement on them as they were before.
    pub before_srgb: Option<MapJudgement>,
    /// What the two channels hold that would be x and y of a map without z; none where three channels vary.
    pub two_channels: Option<TwoChannels>,
    /// Where parts of the map are in other conventions than others: which ones.
    pub contradiction: Option<Contradiction>,
    /// Where the vectors point along another axis than z: which one.
    pub reordered: Option<Reordered>,
    /// Whether most texels have other lengths than 1, and red and green are light and dark together, as in pictures.
    pub is_picture: bool,
    /// Where green should point.
    pub wanted: BitangentDirection,
    /// What the facets of the meshes that use the map say; none for a map that is checked alone.
    pub facets: Option<FacetVotes>,
}

/// The directions of a map's channels, as the texels and the faces of its model show them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct MapDirections {
    /// Where red points.
    pub red: TangentDirection,
    /// Where green points.
    pub green: BitangentDirection,
}

/// Two channels of an image that may be a map without z, and the judgement on them.
#[derive(Clone, Copy, Debug)]
pub enum TwoChannels {
    /// Red and green; blue has one value.
    RedGreen(MapJudgement),
    /// Alpha and green ("DXT5nm"); red has one value.
    AlphaGreen(MapJudgement),
}

impl TwoChannels {
    /// `judgement`: that on red, green and blue.
    fn of(image: &RgbaImage, judgement: &MapJudgement) -> Option<Self> {
        let size = [image.width, image.height].map(|side| side as usize);
        let judge = |[x, y]: [usize; 2]| {
            let layout = TexelLayout::new(x, y, None)?;
            judge_normal_map(&image.texels, size, layout).ok()
        };
        let [first_red, .., first_alpha] = image.texels.first()?;
        let is_red_constant = image.texels.iter().all(|[red, ..]| red == first_red);
        let is_alpha_varying = image.texels.iter().any(|[.., alpha]| alpha != first_alpha);
        match () {
            () if is_red_constant && is_alpha_varying => judge([3, 1]).map(Self::AlphaGreen),
            () if judgement.is_two_channel() => judge([0, 1]).map(Self::RedGreen),
            () => None,
        }
    }
}

/// Gives the votes of the meshes that use a map.
pub type Vote<'a> = &'a dyn Fn(&RgbaImage) -> FacetVotes;

impl Map {
    /// Decodes and judges an image file. `vote`: none for a map that is checked alone.
    pub fn read(file: &[u8], wanted: BitangentDirection, vote: Option<Vote<'_>>) -> Self {
        match RgbaImage::decode(file, &DecodeLimits::default()) {
            Ok(image) => {
                let size = [image.width, image.height].map(|side| side as usize);
                let judgement = judge_normal_map(&image.texels, size, TexelLayout::RGBA);
                let judgement = judgement.map_err(|error| error.to_string());
                let mistake = judgement.as_ref().ok().and_then(MapJudgement::srgb_mistake);
                let two_channels =
                    judgement.as_ref().ok().and_then(|judgement| TwoChannels::of(&image, judgement));
                let before_srgb = mistake.and_then(|mistake| judge_without(mistake, &image));
                let facets = vote.map(|vote| vote(&image));
                let reordered =
                    judgement.as_ref().ok().and_then(|judgement| Reordered::of(&image, judgement));
                let contradiction = Contradiction::of(&image, TexelLayout::RGBA);
                let is_picture = judgement.as_ref().is_ok_and(|judgement| is_picture(&image, judgement));
                Self {
                    judgement,
                    file_size: file.len(),
                    before_srgb,
                    two_channels,
                    contradiction,
                    reordered,
                    is_picture,
                    wanted,
                    facets,
                }
            }
            Err(error) => Self { file_size: file.len(), ..Self::unreadable(error.to_string(), wanted) },
        }
    }

    /// True where the facets of a mesh decide for the first of the two possibilities of an arrangement, false for the second one; none where there is
    /// no mesh, or it does not decide.
    pub fn decide(&self, arrangement: Arrangement) -> Option<bool> {
        self.facets.as_ref()?.decide(arrangement)
    }

    /// The z score that the facets give an arrangement; 0 without a mesh.
    pub fn facet_score(&self, arrangement: Arrangement) -> f64 {
        self.facets.as_ref().map_or(0.0, |facets| facets.z_score(arrangement))
    }

    /// A map that cannot be read, and why, as a clause.
    pub fn unreadable(problem: String, wanted: BitangentDirection) -> Self {
        Self {
            judgement: Err(problem),
            file_size: 0,
            before_srgb: None,
            two_channels: None,
            contradiction: None,
            reordered: None,
            is_picture: false,
            wanted,
            facets: None,
        }
    }
}

/// The smallest correlation between red and green of a picture. That of slopes in all directions is 0, and that of brightness is 1.
const MIN_CORRELATION_OF_PICTURES: f64 = 0.8;

/// Whether most texels have other lengths than 1, and red and green are light and dark together.
fn is_picture(image: &RgbaImage, judgement: &MapJudgement) -> bool {
    if 2 * judgement.not_unit <= judgement.texels - judgement.background
        || judgement.verdict == MapVerdict::Flat
    {
        return false;
    }
    let mut sums = [0.0; 5];
    for [red, green, ..] in &image.texels {
        let [red, green] = [red, green].map(|code| f64::from(*code));
        let terms = [red, green, red * red, green * green, red * green];
        sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
    }
    let [red, green, red_squared, green_squared, product] = sums.map(|sum| sum / image.texels.len() as f64);
    let variances = (red_squared - red * red) * (green_squared - green * green);
    variances > 0.0 && product - red * green >= MIN_CORRELATION_OF_PICTURES * variances.sqrt()
}

/// Judges an image after undoing a mistake; none for a mistake that is not known here.
fn judge_without(mistake: SrgbMistake, image: &RgbaImage) -> Option<MapJudgement> {
    let undo = match mistake {
        SrgbMistake::Encoded => srgb_to_linear,
        SrgbMistake::Decoded => linear_to_srgb,
        _ => return None,
    };
    let code_of: [u8; 256] =
        std::array::from_fn(|code| (255.0 * undo(code as f64 / 255.0)).round().clamp(0.0, 255.0) as u8);
    let width = image.width as usize;
    let mut judge = NormalMapJudge::new(width, TexelLayout::RGB);
    let mut undone = Vec::with_capacity(width);
    for row in image.texels.chunks_exact(width.max(1)) {
        undone.clear();
        undone.extend(row.iter().map(|[r, g, b, _]| [*r, *g, *b].map(|code| code_of[usize::from(code)])));
        judge.push_row(&undone).ok()?;
    }
    Some(judge.judgement())
}
