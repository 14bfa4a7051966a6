//! Which way red and green of a normal map point, by its derivatives and by the faces of the model that it
//! was baked for.

use darboux::{BitangentDirection, MapJudgement, MapVerdict, TangentDirection};

use crate::check_options::AssumedMap;
use crate::hypotheses::MapWitness;
use crate::inverted::relative;
use crate::measure::arrangement::Arrangement;
use crate::measure::map::{Map, MapDirections, TwoChannels};
use crate::measure::map_kind::{Kind, kind};

/// The judgement on a map whose channels have directions, unless red and green are exchanged, or parts of the
/// map contradict each other.
pub fn directed(map: &Map) -> Option<&MapJudgement> {
    let judgement = with_directed_channels(map).filter(|_| map.contradiction.is_none())?;
    (!facets_show_exchange(judgement, map)).then_some(judgement)
}

/// The judgement on a map whose red and green are slopes.
pub fn with_directed_channels(map: &Map) -> Option<&MapJudgement> {
    map.judged().filter(|judgement| matches!(kind(map, judgement), Kind::Normals | Kind::TwoChannel))
}

/// The arrangement that the derivatives show: no channel or both are inverted, or one is.
pub fn arrangement(judgement: &MapJudgement) -> Option<Arrangement> {
    match judgement.verdict {
        MapVerdict::OpenGl => Some(Arrangement::Same),
        MapVerdict::DirectX => Some(Arrangement::GreenInverted),
        _ => None,
    }
}

/// The derivatives tell whether one channel is inverted or none (or both); the facets of the mesh tell which,
/// if they can, or else the user. Otherwise red is taken to be right.
pub fn directions(judgement: &MapJudgement, map: &Map) -> Option<MapDirections> {
    let arrangement = arrangement(judgement)?;
    let is_left = match map.decide(arrangement) {
        Some(is_right) => !is_right,
        None => is_assumed(map) && map.assumed.is_some_and(has_red_inverted),
    };
    let is_down = (arrangement == Arrangement::GreenInverted) != is_left;
    let red = if is_left { TangentDirection::Left } else { TangentDirection::Right };
    let green = if is_down { BitangentDirection::Down } else { BitangentDirection::Up };
    Some(MapDirections { red, green })
}

fn has_red_inverted(assumed: AssumedMap) -> bool {
    matches!(assumed, AssumedMap::RedInverted | AssumedMap::BothInverted)
}

/// Whether the user says which of the possibilities that the derivatives leave is so.
pub fn is_assumed(map: &Map) -> bool {
    let shown = map.judged().and_then(arrangement);
    map.assumed.is_some_and(|assumed| {
        shown.is_some_and(|shown| (shown == Arrangement::GreenInverted) == has_one_inverted(assumed))
    })
}

/// Whether what a user says of a map is that one of its channels is inverted.
pub fn has_one_inverted(assumed: AssumedMap) -> bool {
    matches!(assumed, AssumedMap::DirectX | AssumedMap::RedInverted)
}

/// The directions of the channels, if the faces of the mesh decide them.
pub fn directions_by_mesh(map: &Map) -> Option<MapDirections> {
    let judgement = directed(map)?;
    let is_decided = arrangement(judgement).is_some_and(|arrangement| map.decide(arrangement).is_some());
    directions(judgement, map).filter(|_| is_decided)
}

/// The arrangements that the sign of the derivatives permits: red and green at their places, and exchanged.
pub fn candidates(judgement: &MapJudgement) -> [Arrangement; 2] {
    if judgement.z_score > 0.0 {
        [Arrangement::Same, Arrangement::Exchanged]
    } else {
        [Arrangement::GreenInverted, Arrangement::ExchangedAndInverted]
    }
}

/// The largest log energy ratio of a map whose channels may be exchanged: the ratio of a gradient is not
/// negative, and exchanging the channels negates it.
const MAX_RATIO_OF_EXCHANGED: f32 = 0.02;

/// Whether the texels follow the facets of the mesh with red and green exchanged, and not otherwise, and
/// their derivatives permit it. A map that was mirrored shows other texels than the baked ones on every
/// facet, and these may lean in any way.
pub fn facets_show_exchange(judgement: &MapJudgement, map: &Map) -> bool {
    if judgement.log_energy_ratio > MAX_RATIO_OF_EXCHANGED {
        return false;
    }
    let [straight, exchanged] = candidates(judgement).map(|arrangement| map.facet_score(arrangement).abs());
    let decided = candidates(judgement).map(|arrangement| map.decide(arrangement).is_some());
    decided[1] && exchanged > 2.0 * straight
}

/// The confidence in percent from which on a direction is sure.
pub const SURE_PERCENT: f64 = 90.0;

/// The largest logarithm of the odds that faces give: a million to one.
const MAX_LOG_ODDS: f64 = 14.0;

/// The logarithm of the odds that a z score gives, as a normal distribution falls.
fn log_odds(z_score: f64) -> f64 {
    (z_score * z_score / 2.0).min(MAX_LOG_ODDS).copysign(z_score)
}

/// The probability of an odd number of inverted channels after the faces were heard, too. With one channel
/// inverted more or less than the arrangement that they decide says, red or green would contradict them, and
/// the other arrangement would agree better.
fn with_faces(odd: f64, shown: Arrangement, map: &Map) -> f64 {
    let other = match shown {
        Arrangement::Same => Arrangement::GreenInverted,
        _ => Arrangement::Same,
    };
    let [shown, other] = [shown, other].map(|arrangement| map.facet_score(arrangement).powi(2) / 2.0);
    let factor = (shown - other).clamp(-MAX_LOG_ODDS, MAX_LOG_ODDS).exp();
    if odd > 0.5 { odd * factor / (odd * factor + 1.0 - odd) } else { odd / (odd + (1.0 - odd) * factor) }
}

/// What the texels, as they are or once another mistake is undone, and the faces tell of the directions of
/// the channels.
pub fn witness(map: &Map) -> MapWitness {
    let of_two_channels = map.two_channels.map(|channels| match channels {
        TwoChannels::RedGreen(judgement) | TwoChannels::AlphaGreen(judgement) => judgement,
    });
    let judgements = [map.judged().copied(), map.before_srgb, map.scaled, of_two_channels];
    let judgements = || judgements.iter().flatten().filter(|_| map.contradiction.is_none());
    let is_inverted = |judgement: &MapJudgement| {
        let confidence = f64::from(judgement.confidence);
        let is_shown = match judgement.verdict {
            MapVerdict::OpenGl => map.wanted == BitangentDirection::Up,
            MapVerdict::DirectX => map.wanted == BitangentDirection::Down,
            _ => return None,
        };
        Some(if is_shown { 1.0 - confidence } else { confidence })
    };
    let is_clearer = |a: &f64, b: &f64| (a - 0.5).abs().total_cmp(&(b - 0.5).abs());
    let decided = map.judged().and_then(arrangement).filter(|shown| map.decide(*shown).is_some());
    MapWitness {
        odd: judgements()
            .filter_map(is_inverted)
            .max_by(is_clearer)
            .map(|odd| decided.map_or(odd, |shown| with_faces(odd, shown, map))),
        faces: decided.map_or(0.0, |shown| log_odds(map.facet_score(shown))),
        is_flat: judgements().any(|judgement| judgement.verdict == MapVerdict::Flat),
        assumed: map.assumed.map(|assumed| relative(assumed, map.wanted)),
    }
}
