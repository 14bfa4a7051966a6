//! [`Map`]: a decoded normal map, the judgement on it and the votes of the meshes that use it, as the rules
//! read them.

use darboux::{
    BitangentDirection, MapJudgement, MapVerdict, NormalMapJudge, SrgbMistake, TangentDirection, TexelLayout,
    judge_normal_map,
};
use darboux_io::image::{DecodeError, DecodeLimits, RgbaImage, linear_to_srgb, srgb_to_linear};

use crate::check_options::{AssumedMap, CheckOptions};
use crate::defect::Unread;
use crate::measure::arrangement::Arrangement;
use crate::measure::contradiction::Contradiction;
use crate::measure::mesh_votes::MeshVotes;
use crate::measure::misreading::Misreading;
use crate::measure::reordered::Reordered;
use crate::measure::storage::Storage;

/// The normal map of a material, or one that is checked alone.
pub struct Map {
    /// The judgement, or why there is none.
    pub judgement: Result<MapJudgement, Unread>,
    /// In bytes; 0 where the file itself could not be read.
    pub file_size: usize,
    /// The number of tiles that the judgement is from.
    pub tiles: usize,
    /// Where the texels look as if they had gone through the transfer function of sRGB once too often: which
    /// way, and the judgement on them as they were before.
    pub srgb_mistake: Option<SrgbMistake>,
    pub before_srgb: Option<MapJudgement>,
    /// Where all vectors have about the same length, which is not 1: the judgement on them after they were
    /// scaled to it.
    pub scaled: Option<MapJudgement>,
    /// What the two channels hold that would be x and y of a map without z; none where three channels vary.
    pub two_channels: Option<TwoChannels>,
    /// What a renderer that reads three channels makes of these two.
    pub misreading: Option<Misreading>,
    /// Where parts of the map are in other conventions than others: which ones.
    pub contradiction: Option<Contradiction>,
    /// Where the vectors point along another axis than z: which one.
    pub reordered: Option<Reordered>,
    /// Whether most texels have other lengths than 1, red and green are light and dark together, as in
    /// pictures, and filtered normals are not like that.
    pub is_picture: bool,
    /// What storage did to the texels.
    pub storage: Storage,
    /// Where green should point.
    pub wanted: BitangentDirection,
    /// What the facets of the meshes that use the map say; none for a map that is checked alone.
    pub facets: Option<MeshVotes>,
    /// What the user says about the channels.
    pub assumed: Option<AssumedMap>,
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
    /// The channels of x and y.
    fn x_and_y(self) -> [usize; 2] {
        match self {
            Self::RedGreen(_) => [0, 1],
            Self::AlphaGreen(_) => [3, 1],
        }
    }

    /// `judgement`: that on red, green and blue.
    fn of(image: &RgbaImage, judgement: &MapJudgement) -> Option<Self> {
        let size = [image.width, image.height].map(|side| side as usize);
        let judge = |[x, y]: [usize; 2]| {
            let layout = TexelLayout::new(x, y, None)?;
            judge_normal_map(&image.texels, size, layout).ok()
        };
        let [first_red, .., first_alpha] = image.texels.first()?;
        let is_red_constant = image.texels.iter().all(|[red, ..]| red == first_red);
        if is_red_constant && image.texels.iter().any(|[.., alpha]| alpha != first_alpha) {
            judge([3, 1]).map(Self::AlphaGreen)
        } else if judgement.is_two_channel() {
            judge([0, 1]).map(Self::RedGreen)
        } else {
            None
        }
    }
}

/// Gives the votes of the meshes that use a map.
pub type Vote<'a> = &'a dyn Fn(&RgbaImage) -> MeshVotes;

impl Map {
    /// Decodes and judges an image file. `vote`: none for a map that is checked alone.
    pub fn read(file: &[u8], options: &CheckOptions, vote: Option<Vote<'_>>) -> Self {
        let wanted = options.green;
        match RgbaImage::decode(file, &DecodeLimits::of_file(file.len(), options.memory_limit)) {
            Ok(image) => {
                let mut judge = NormalMapJudge::new(image.width as usize, TexelLayout::RGBA);
                let mut rows = image.texels.chunks_exact(image.width.max(1) as usize);
                let pushed = rows.try_for_each(|row| judge.push_row(row));
                let tiles = judge.tiles().correlations.iter().flatten().count();
                let judgement =
                    pushed.map(|()| judge.judgement()).map_err(|error| Unread::Damaged(error.to_string()));
                let srgb_mistake = judgement.as_ref().ok().and_then(|judgement| {
                    judgement.srgb_mistake().or_else(|| srgb_mistake_by_length(&image, judgement))
                });
                let scaled = judgement.as_ref().ok().and_then(|judgement| judge_scaled(&image, judgement));
                let two_channels =
                    judgement.as_ref().ok().and_then(|judgement| TwoChannels::of(&image, judgement));
                let misreading = two_channels.map(|channels| Misreading::of(&image, channels.x_and_y()));
                let before_srgb = srgb_mistake.and_then(|mistake| judge_without(mistake, &image));
                let facets = vote.map(|vote| vote(&image));
                let reordered =
                    judgement.as_ref().ok().and_then(|judgement| Reordered::of(&image, judgement));
                let contradiction = Contradiction::of(&image);
                let is_picture = judgement.as_ref().is_ok_and(|judgement| is_picture(&image, judgement));
                Self {
                    judgement,
                    file_size: file.len(),
                    tiles,
                    srgb_mistake,
                    before_srgb,
                    scaled,
                    two_channels,
                    misreading,
                    contradiction,
                    reordered,
                    is_picture,
                    storage: Storage::of(&image, file),
                    wanted,
                    facets,
                    assumed: None,
                }
            }
            Err(error) => {
                let why = match error {
                    DecodeError::GitLfsPointer => Unread::GitLfsPointer,
                    DecodeError::Broken(_) => Unread::Damaged(error.to_string()),
                    _ if is_other_format(file) => Unread::OtherFormat(error.to_string()),
                    _ => Unread::Damaged(error.to_string()),
                };
                Self { file_size: file.len(), ..Self::unread(why, wanted) }
            }
        }
    }

    /// The judgement, if the image can be decoded.
    pub fn judged(&self) -> Option<&MapJudgement> {
        self.judgement.as_ref().ok()
    }

    /// True where the facets of a mesh decide for the first of the two possibilities of an arrangement, false
    /// for the second one; none where there is no mesh, or it does not decide.
    pub fn decide(&self, arrangement: Arrangement) -> Option<bool> {
        self.facets.as_ref()?.decide(arrangement)
    }

    /// The z score that the facets give an arrangement; 0 without a mesh.
    pub fn facet_score(&self, arrangement: Arrangement) -> f64 {
        self.facets.as_ref().map_or(0.0, |facets| facets.z_score(arrangement))
    }

    /// A map without texels, and why.
    pub fn unread(why: Unread, wanted: BitangentDirection) -> Self {
        Self {
            judgement: Err(why),
            file_size: 0,
            tiles: 0,
            srgb_mistake: None,
            before_srgb: None,
            scaled: None,
            two_channels: None,
            misreading: None,
            contradiction: None,
            reordered: None,
            is_picture: false,
            storage: Storage::default(),
            wanted,
            facets: None,
            assumed: None,
        }
    }
}

/// Whether a file begins as a KTX, Basis Universal, AVIF, JPEG XL or DDS file.
fn is_other_format(file: &[u8]) -> bool {
    let starts: [&[u8]; 6] =
        [b"\xABKTX 11\xBB", b"\xABKTX 20\xBB", b"sB", b"\0\0\0\x0CJXL ", b"\xFF\x0A", b"DDS "];
    let is_avif = file.get(4..12).is_some_and(|head| head == b"ftypavif" || head == b"ftypavis");
    is_avif || starts.iter().any(|start| file.starts_with(start))
}

/// The smallest correlation between red and green of a picture. Slopes in all directions have 0, and
/// brightness has 1.
const MIN_CORRELATION_OF_PICTURES: f64 = 0.8;

/// The least confidence in the convention of a map that was filtered or compressed until most vectors are
/// shorter than 1, its least mean z, the largest mean lean of its x and y, and its share of texels, in
/// percent, that no filter makes of normals. Pictures are within one or the other (docs/notes/check.md).
const MIN_CONFIDENCE: f32 = 0.99;
const MIN_MEAN_Z: f32 = 0.5;
const MAX_MEAN_LEAN: f32 = 0.25;
const MAX_IMPOSSIBLE: f64 = 5.0;

/// Whether a map holds normals that were filtered or compressed: nearly all texels are what that can make of
/// normals, they point out of the surface on average, and they are the slopes of one for certain.
fn are_filtered_normals(judgement: &MapJudgement) -> bool {
    let [x, y, z] = judgement.mean;
    let is_direction = matches!(judgement.verdict, MapVerdict::OpenGl | MapVerdict::DirectX);
    let are_slopes = is_direction && judgement.confidence >= MIN_CONFIDENCE;
    let is_upright = z >= MIN_MEAN_Z && x.abs().max(y.abs()) <= MAX_MEAN_LEAN;
    are_slopes && is_upright && percent(judgement, judgement.not_normal) <= MAX_IMPOSSIBLE
}

/// Whether most texels have other lengths than 1, and red and green are light and dark together.
fn is_picture(image: &RgbaImage, judgement: &MapJudgement) -> bool {
    if 2 * judgement.not_unit <= judgement.texels - judgement.background
        || judgement.verdict == MapVerdict::Flat
        || are_filtered_normals(judgement)
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

/// The shares of vectors of other lengths than 1, in percent, of texels as they should not be, and as they
/// were before.
const MIN_NOT_UNIT: f64 = 40.0;
const MAX_HEALTHY: f64 = 5.0;

/// How far maps lean at least, in red and green, whose values went through the transfer function: flat texels
/// lean by 0.47 and 0.57.
const MIN_LEAN: f32 = 0.3;

/// The mistake that explains why few vectors have length 1: without it, nearly all do. A map without flat
/// parts has no commonest texel that shows the mistake.
fn srgb_mistake_by_length(image: &RgbaImage, judgement: &MapJudgement) -> Option<SrgbMistake> {
    let [x, y, _] = judgement.mean;
    let mistake = if x.min(y) >= MIN_LEAN {
        SrgbMistake::Encoded
    } else if x.max(y) <= -MIN_LEAN {
        SrgbMistake::Decoded
    } else {
        return None;
    };
    if judgement.verdict == MapVerdict::Flat || percent(judgement, judgement.not_unit) < MIN_NOT_UNIT {
        return None;
    }
    let before = judge_without(mistake, image)?;
    let leans = before.mean[..2].iter().any(|mean| mean.abs() >= MIN_LEAN);
    (!leans && percent(&before, before.not_unit) <= MAX_HEALTHY).then_some(mistake)
}

/// Judges an image after giving its vectors the length 1 on average; none where they have it, or where their
/// lengths differ.
fn judge_scaled(image: &RgbaImage, judgement: &MapJudgement) -> Option<MapJudgement> {
    let length = judgement.mean_length;
    let is_other = percent(judgement, judgement.not_unit) > 100.0 - MAX_HEALTHY;
    if !is_other || judgement.verdict == MapVerdict::Flat || !(0.3..=0.9).contains(&length) {
        return None;
    }
    let code_of =
        std::array::from_fn(|code| (127.5 + (code as f32 - 127.5) / length).round().clamp(0.0, 255.0) as u8);
    let scaled = judge_through(&code_of, image)?;
    (percent(&scaled, scaled.not_unit) <= MAX_HEALTHY && scaled.mean[2] > 0.6).then_some(scaled)
}

/// Judges an image after undoing a mistake; none for a mistake that is not known here.
fn judge_without(mistake: SrgbMistake, image: &RgbaImage) -> Option<MapJudgement> {
    let undo = match mistake {
        SrgbMistake::Encoded => srgb_to_linear,
        SrgbMistake::Decoded => linear_to_srgb,
        _ => return None,
    };
    let code_of =
        std::array::from_fn(|code| (255.0 * undo(code as f64 / 255.0)).round().clamp(0.0, 255.0) as u8);
    judge_through(&code_of, image)
}

/// Judges an image after each code became another one.
fn judge_through(code_of: &[u8; 256], image: &RgbaImage) -> Option<MapJudgement> {
    let width = image.width as usize;
    let mut judge = NormalMapJudge::new(width, TexelLayout::RGB);
    let mut changed = Vec::with_capacity(width);
    for row in image.texels.chunks_exact(width.max(1)) {
        changed.clear();
        changed.extend(row.iter().map(|[r, g, b, _]| [*r, *g, *b].map(|code| code_of[usize::from(code)])));
        judge.push_row(&changed).ok()?;
    }
    Some(judge.judgement())
}

/// A number of texels in percent of those that are no background.
pub fn percent(judgement: &MapJudgement, count: usize) -> f64 {
    100.0 * count as f64 / (judgement.texels - judgement.background).max(1) as f64
}
