//! Which way red and green of a normal map point, by its derivatives and by the faces of the model that it was baked for.

use darboux::{BitangentDirection, MapJudgement, MapVerdict, TangentDirection};

use crate::measure::facets::Arrangement;
use crate::measure::map::{Map, MapDirections, TwoChannels};
use crate::measure::map_kind::{Kind, kind};

/// The judgement on a map whose channels have directions, unless red and green are exchanged, or parts of the map contradict each other.
pub fn directed(map: &Map) -> Option<&MapJudgement> {
    let judgement = with_directed_channels(map).filter(|_| map.contradiction.is_none())?;
    (!facets_show_exchange(judgement, map)).then_some(judgement)
}

/// The judgement on a map whose red and green are slopes.
pub fn with_directed_channels(map: &Map) -> Option<&MapJudgement> {
    map.judged().filter(|judgement| matches!(kind(map, judgement), Kind::Normals | Kind::TwoChannel))
}

/// The arrangement that the derivatives show: that of a map with no (or both) channels inverted, or with one.
pub fn arrangement(judgement: &MapJudgement) -> Option<Arrangement> {
    match judgement.verdict {
        MapVerdict::OpenGl => Some(Arrangement::Same),
        MapVerdict::DirectX => Some(Arrangement::GreenInverted),
        _ => None,
    }
}

/// The derivatives tell whether one channel is inverted or none (or both); the facets of the mesh tell which, if they can. Otherwise red is taken to be
/// right.
pub fn directions(judgement: &MapJudgement, map: &Map) -> Option<MapDirections> {
    let arrangement = arrangement(judgement)?;
    let is_left = map.decide(arrangement) == Some(false);
    let is_down = (arrangement == Arrangement::GreenInverted) != is_left;
    let red = if is_left { TangentDirection::Left } else { TangentDirection::Right };
    let green = if is_down { BitangentDirection::Down } else { BitangentDirection::Up };
    Some(MapDirections { red, green })
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

/// The largest log energy ratio of a map whose channels may be exchanged: that of a gradient is not negative, and exchanging them negates it.
const MAX_RATIO_OF_EXCHANGED: f32 = 0.02;

/// Whether the texels follow the facets of the mesh with red and green exchanged, and not otherwise, and their derivatives permit it. A map that
/// was mirrored shows other texels than the baked ones on every facet, and these may lean in any way.
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

/// Whether the texels surely show a convention, as they are or once another mistake is undone, or are flat, so that none matters.
pub fn is_convention_known(map: &Map) -> bool {
    let is_sure = |judgement: &MapJudgement| match judgement.verdict {
        MapVerdict::OpenGl | MapVerdict::DirectX => 100.0 * f64::from(judgement.confidence) >= SURE_PERCENT,
        verdict => verdict == MapVerdict::Flat,
    };
    let of_two_channels = map.two_channels.map(|channels| match channels {
        TwoChannels::RedGreen(judgement) | TwoChannels::AlphaGreen(judgement) => judgement,
    });
    let judgements = [map.judged().copied(), map.before_srgb, map.scaled, of_two_channels];
    map.contradiction.is_none() && judgements.iter().flatten().any(is_sure)
}
