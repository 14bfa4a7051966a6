//! What the texels of a normal map are: normals, or what else.

use darboux::{MapJudgement, MapVerdict};

use crate::measure::map::{Map, TwoChannels, percent};

/// What a map is when it is no tangent-space map of unit vectors. Later rules ask for `Normals` only, so that
/// each map has one such finding.
#[derive(PartialEq, Eq)]
pub enum Kind {
    Grey,
    ObjectSpace,
    /// The vectors point along another axis than z.
    Reordered,
    Srgb,
    TwoChannel,
    Other,
    Normals,
}

pub fn kind(map: &Map, judgement: &MapJudgement) -> Kind {
    if judgement.is_grey() && judgement.verdict != MapVerdict::Flat {
        return Kind::Grey;
    }
    // The commonest colour of a colour texture may be near that of a flat map that was encoded. Decoding it
    // does not give normals.
    if map.before_srgb.is_some_and(|before| !is_map(&before)) {
        return Kind::Other;
    }
    // The encoding turns a nearly flat map's blue into 255 everywhere, as in a map of two channels, and flat
    // texels tell them apart. A part that leans may have the colour of an encoded flat one, but undoing
    // an encoding that never was makes vectors of other lengths than 1.
    let is_better_decoded = map.before_srgb.is_some_and(|before| before.not_unit < judgement.not_unit);
    if is_better_decoded || is_encoded_and_inverted(judgement) {
        return Kind::Srgb;
    }
    if map.scaled.is_some() && judgement.mean[2] > 0.0 {
        return Kind::Normals;
    }
    if let Some(channels) = map.two_channels {
        return if may_be_normals(channels) { Kind::TwoChannel } else { Kind::Other };
    }
    if map.reordered.is_some() {
        Kind::Reordered
    } else if is_no_normal(judgement) {
        Kind::Other
    } else if judgement.is_object_space() {
        Kind::ObjectSpace
    } else if is_no_map(judgement) || map.is_picture {
        Kind::Other
    } else {
        Kind::Normals
    }
}

/// Whether the commonest texel and the mean belong to a flat map whose values were encoded as sRGB and one of
/// whose channels was inverted after that.
fn is_encoded_and_inverted(judgement: &MapJudgement) -> bool {
    let [mean_red, mean_green, mean_blue] = judgement.mean.map(|x| 127.5 * (x + 1.0));
    let is_near = |codes: [u8; 2]| {
        let is_commonest = (0..2).all(|i| judgement.commonest[i].abs_diff(codes[i]) <= 3);
        let means = [mean_red, mean_green];
        is_commonest && (0..2).all(|i| (means[i] - f32::from(codes[i])).abs() <= 10.0)
    };
    mean_blue > 224.0 && (is_near([188, 67]) || is_near([67, 188]))
}

/// How far x and y of a map may lean on average, for it to be a map without z: the slopes of a surface
/// cancel.
const MAX_MEAN_OF_TWO: f32 = 0.2;

/// Whether two channels may be x and y of unit vectors: they are not beyond the unit circle, do not lean on
/// average, and contradict no surface.
fn may_be_normals(of: TwoChannels) -> bool {
    let (TwoChannels::RedGreen(judgement) | TwoChannels::AlphaGreen(judgement)) = of;
    let is_surface = judgement.verdict != MapVerdict::NoGradient || judgement.has_exchanged_channels();
    let is_within = percent(&judgement, judgement.not_unit) <= 1.0;
    is_surface && is_within && judgement.mean[..2].iter().all(|lean| lean.abs() <= MAX_MEAN_OF_TWO)
}

/// The share of texels, in percent, from which on vectors of other lengths that point below the surface, too,
/// are no normals.
const NO_NORMALS: [f64; 2] = [50.0, 10.0];

/// Whether texels are slopes of a surface, or most of them are unit vectors.
fn is_map(judgement: &MapJudgement) -> bool {
    let is_gradient =
        matches!(judgement.verdict, MapVerdict::OpenGl | MapVerdict::DirectX | MapVerdict::Flat);
    is_gradient || percent(judgement, judgement.not_unit) <= NO_NORMALS[0]
}

/// Whether most texels are neither unit nor above the surface; or texels are no slopes of a surface, and most
/// cannot be normals or many are neither unit nor above the surface.
fn is_no_map(judgement: &MapJudgement) -> bool {
    let are_no_normals = [judgement.not_unit, judgement.negative_z].map(|count| percent(judgement, count));
    if are_no_normals.iter().all(|percent| *percent > NO_NORMALS[0]) {
        return true;
    }
    let are_colours =
        (0..2).all(|i| are_no_normals[i] > NO_NORMALS[i]) && !judgement.has_exchanged_channels();
    judgement.verdict == MapVerdict::NoGradient && (judgement.holds_no_normals() || are_colours)
}

/// Whether a map of one colour is none of a normal, or a map has only black, white and middle grey texels,
/// which are no normals.
fn is_no_normal(judgement: &MapJudgement) -> bool {
    let is_background = judgement.background == judgement.texels;
    is_background || judgement.verdict == MapVerdict::Flat && judgement.holds_no_normals()
}
