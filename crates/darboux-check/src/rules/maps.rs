//! Rules about the texels of normal maps.

use darboux::{BitangentDirection, MapJudgement, MapVerdict, SrgbMistake, TangentDirection};

use super::rule::MapRule;
use crate::defect::Obstacle;
use crate::defect::{
    Certainty, Defect, DirectionEvidence, FacesScore, LengthDoubt, MapFault, NoNormals, RedDoubt,
    ReliefEvidence, Texels, Unread,
};
use crate::measure::arrangement::Arrangement;
use crate::measure::directions::{
    SURE_PERCENT, arrangement, candidates, directed, directions, directions_by_mesh, facets_show_exchange,
    has_one_inverted, is_assumed, with_directed_channels,
};
use crate::measure::map::{Map, TwoChannels, percent};
use crate::measure::map_kind::{Kind, kind};
use crate::measure::mesh_votes::MeshVotes;
use crate::severity::{MIN_DAMAGED, Severity};

/// In the order of their findings: causes come before what follows from them. A strong compression changes
/// lengths, flat texels and what the derivatives show.
pub const RULES: &[MapRule] = &[
    not_read,
    height,
    object_space,
    reordered,
    srgb,
    not_normal,
    two_channel,
    enlarged,
    banding,
    blocks,
    contradiction,
    red_flipped,
    green_flipped,
    may_be_dents,
    detail_flipped,
    other_layout,
    channels_swapped,
    not_unit,
    negative_z,
    flat_off,
    flat,
    padding,
];

/// The share of texels, in percent, above which vectors are worth a warning.
const MAX_PERCENT: f64 = 5.0;

fn texels(judgement: &MapJudgement, count: usize) -> Texels {
    Texels { count, percent: percent(judgement, count) }
}

/// The judgement on a map of one kind.
fn of_kind(map: &Map, wanted: Kind) -> Option<&MapJudgement> {
    map.judged().filter(|judgement| kind(map, judgement) == wanted)
}

fn not_read(map: &Map) -> Option<Defect> {
    let why = map.judgement.as_ref().err()?.clone();
    Some(unreadable(String::new(), why, map.file_size))
}

/// The defect of a map without texels. `name`: of its file, or of the image; `bytes`: the size of the file.
pub fn unreadable(name: String, why: Unread, bytes: usize) -> Defect {
    let is_wrong = matches!(why, Unread::Damaged(_) | Unread::Absent(_) | Unread::GitLfsPointer);
    let found = Defect::new(MapFault::Unreadable { name, why, bytes });
    if is_wrong { found } else { found.with_severity(Severity::NotChecked) }
}

fn height(map: &Map) -> Option<Defect> {
    let judgement = of_kind(map, Kind::Grey)?;
    Some(Defect::new(MapFault::Height(texels(judgement, judgement.grey))))
}

fn object_space(map: &Map) -> Option<Defect> {
    let judgement = of_kind(map, Kind::ObjectSpace)?;
    Some(Defect::new(MapFault::ObjectSpace(texels(judgement, judgement.negative_z))))
}

/// The vectors of a tangent-space map point along z on average. Vectors of a flat surface in object space may
/// point along any axis.
fn reordered(map: &Map) -> Option<Defect> {
    let judgement = of_kind(map, Kind::Reordered)?;
    let reordered = map.reordered.clone()?;
    let (is_z, mean) = (reordered.is_z(), judgement.mean[reordered.channel]);
    let found = Defect::new(MapFault::Reordered { reordered, mean }).with_severity(Severity::Error);
    Some(Defect { obstacle: Some(Obstacle::UndecidedOrder { is_z }), ..found })
}

fn srgb(map: &Map) -> Option<Defect> {
    let judgement = of_kind(map, Kind::Srgb)?;
    let mistake = map.srgb_mistake;
    if !matches!(mistake, None | Some(SrgbMistake::Encoded | SrgbMistake::Decoded)) {
        return None;
    }
    let before = map.before_srgb.filter(|_| judgement.srgb_mistake().is_none());
    if let (Some(mistake), Some(before)) = (mistake, before) {
        let (not_unit, undone) = (texels(judgement, judgement.not_unit), percent(&before, before.not_unit));
        return Some(Defect::new(MapFault::SrgbByLength { mistake, not_unit, undone }));
    }
    let commonest = judgement.commonest;
    let found = MapFault::Srgb { mistake, commonest, texels: texels(judgement, judgement.commonest_count) };
    let obstacle = mistake.is_none().then_some(Obstacle::EncodedAndInverted);
    Some(Defect::new(found).with_obstacle(obstacle))
}

fn not_normal(map: &Map) -> Option<Defect> {
    let judgement = of_kind(map, Kind::Other)?;
    let kind = if judgement.background == judgement.texels {
        NoNormals::Background
    } else if judgement.verdict == MapVerdict::Flat {
        NoNormals::OneColour(colour(judgement))
    } else if judgement.holds_no_normals() {
        NoNormals::MostlyImpossible
    } else if map.is_picture {
        NoNormals::Picture
    } else {
        NoNormals::NoSlopes
    };
    Some(Defect::new(MapFault::NotNormal { kind, texels: texels(judgement, judgement.not_normal) }))
}

/// The commonest red and green, and the mean blue, as 8-bit codes.
fn colour(judgement: &MapJudgement) -> [f64; 3] {
    let ([red, green], blue) = (judgement.commonest, 127.5 * (judgement.mean[2] + 1.0));
    [red.into(), green.into(), blue.into()]
}

/// Where blue is 255, bumps are a little too weak, and steep ones much; elsewhere normals point anywhere.
fn two_channel(map: &Map) -> Option<Defect> {
    of_kind(map, Kind::TwoChannel)?;
    let (channels, misreading) = (map.two_channels?, map.misreading?);
    let (TwoChannels::RedGreen(judgement) | TwoChannels::AlphaGreen(judgement)) = channels;
    let is_x_in_alpha = matches!(channels, TwoChannels::AlphaGreen(_));
    let is_unclear = judgement.verdict == MapVerdict::CannotTell && map.facets.is_none();
    let obstacle = if is_x_in_alpha { Some(Obstacle::XInAlpha) } else { None };
    let obstacle = obstacle.or(is_unclear.then_some(Obstacle::UnclearChannels));
    let certainty = certainty(&judgement, map);
    let severity = if misreading.damaged >= MIN_DAMAGED {
        Severity::Error
    } else if misreading.typical >= MIN_STEP {
        Severity::Warning
    } else {
        Severity::Info
    };
    let found = Defect::new(MapFault::TwoChannel { is_x_in_alpha, certainty, misreading });
    Some(found.with_obstacle(obstacle).with_severity(severity))
}

fn certainty(judgement: &MapJudgement, map: &Map) -> Certainty {
    Certainty { z_score: judgement.z_score.into(), tiles: map.tiles }
}

fn faces_score(map: &Map, arrangement: Arrangement) -> FacesScore {
    let faces = map.facets.as_ref().map_or(0, MeshVotes::count);
    FacesScore { z_score: map.facet_score(arrangement), faces }
}

fn direction_evidence(judgement: &MapJudgement, map: &Map) -> DirectionEvidence {
    let decided = arrangement(judgement).filter(|arrangement| map.decide(*arrangement).is_some());
    DirectionEvidence {
        confidence: judgement.confidence,
        correlation: judgement.correlation,
        certainty: certainty(judgement, map),
        relief: ReliefEvidence::of(judgement),
        faces: decided.map(|arrangement| faces_score(map, arrangement)),
    }
}

/// The defect with the severity of its confidence: an error where it is sure. A direction that is not sure is
/// a warning and left.
fn with_confidence(found: Defect, judgement: &MapJudgement) -> Defect {
    let probability = f64::from(judgement.confidence);
    if 100.0 * probability >= SURE_PERCENT {
        found.with_severity(Severity::Error)
    } else {
        found.with_severity(Severity::Warning).with_obstacle(Some(Obstacle::Unsure(probability)))
    }
}

/// One part of the map is in OpenGL's convention and another one in DirectX's.
fn contradiction(map: &Map) -> Option<Defect> {
    with_directed_channels(map)?;
    let found =
        Defect::new(MapFault::Contradiction { contradiction: map.contradiction?, wanted: map.wanted });
    Some(found.with_severity(Severity::Warning).with_obstacle(Some(Obstacle::OnlyAPartOfMap)))
}

/// The z score of the faces up to which they make inverted red likelier than inverted green, without deciding
/// it. Faces that a map was not made for give 4 by chance.
const LEANS_TO_RED: f64 = -5.0;

fn green_flipped(map: &Map) -> Option<Defect> {
    let judgement = directed(map)?;
    if directions(judgement, map)?.green == map.wanted {
        return None;
    }
    let leans_to_red =
        arrangement(judgement).is_some_and(|arrangement| map.facet_score(arrangement) <= LEANS_TO_RED);
    let doubt = match (directions_by_mesh(map), &map.facets) {
        (Some(_), _) => RedDoubt::None,
        _ if is_assumed(map) => RedDoubt::None,
        (None, Some(_)) if leans_to_red => RedDoubt::FacesLeanToRed,
        (None, Some(_)) => RedDoubt::FacesUndecided,
        (None, None) => RedDoubt::NoModel,
    };
    let obstacle = match doubt {
        RedDoubt::None | RedDoubt::FacesUndecided => None,
        RedDoubt::FacesLeanToRed => Some(Obstacle::FacesLeanToRed(map.wanted)),
        RedDoubt::NoModel => Some(Obstacle::OnlyTheModelTells(map.wanted)),
    };
    let obstacle = obstacle.or(judgement.has_opposed_detail.then_some(Obstacle::DetailIsOpposed));
    let evidence = direction_evidence(judgement, map);
    let found = Defect::new(MapFault::GreenFlipped { wanted: map.wanted, doubt, evidence });
    Some(with_confidence(found.with_obstacle(obstacle), judgement))
}

/// Most tiles are in another convention than the relief.
fn detail_flipped(map: &Map) -> Option<Defect> {
    let judgement = directed(map).filter(|judgement| judgement.has_opposed_detail)?;
    let evidence = ReliefEvidence::of(judgement);
    Some(Defect::new(MapFault::DetailFlipped { is_relief_up: judgement.z_score > 0.0, evidence }))
}

fn red_flipped(map: &Map) -> Option<Defect> {
    let judgement = directed(map)?;
    let is_left = directions(judgement, map)?.red == TangentDirection::Left;
    let found = || Defect::new(MapFault::RedFlipped(direction_evidence(judgement, map)));
    let obstacle = judgement.has_opposed_detail.then_some(Obstacle::DetailIsOpposed);
    is_left.then(|| with_confidence(found().with_obstacle(obstacle), judgement))
}

/// A map whose channels seem to be right, and that leans against the faces: bumps on the faces, or dents that
/// were bumps.
fn may_be_dents(map: &Map) -> Option<Defect> {
    let judgement = directed(map).filter(|_| !is_assumed(map))?;
    let shown = arrangement(judgement)?;
    let directions = directions(judgement, map)?;
    let seems_right = directions.red == TangentDirection::Right && directions.green == map.wanted;
    let leans_against = seems_right && map.decide(shown).is_none() && map.facet_score(shown) <= LEANS_TO_RED;
    let found = || Defect::new(MapFault::MayBeDents { wanted: map.wanted, score: faces_score(map, shown) });
    leans_against.then(|| Defect { obstacle: Some(Obstacle::MayBeDents(map.wanted)), ..found() })
}

fn other_layout(map: &Map) -> Option<Defect> {
    with_directed_channels(map)?;
    let seams = map.facets.as_ref()?.seams?;
    let (layout, fit) = seams.other_layout?;
    let fits = [fit, seams.as_it_is];
    Some(Defect::new(MapFault::OtherLayout { layout, fits, points: seams.points }))
}

fn channels_swapped(map: &Map) -> Option<Defect> {
    let judgement = of_kind(map, Kind::Normals)?;
    let by_derivatives = judgement.has_exchanged_channels();
    let by_facets = facets_show_exchange(judgement, map);
    if !by_derivatives && !by_facets {
        return None;
    }
    let [is_down, wants_down] = [judgement.z_score < 0.0, map.wanted == BitangentDirection::Down];
    let is_assumed = || map.assumed.is_some_and(|assumed| has_one_inverted(assumed) == is_down);
    let is_decided = || map.decide(candidates(judgement)[1]).is_some() || is_assumed();
    let is_undecided = is_down != wants_down && !is_decided();
    let [up, down] = judgement.residuals;
    // What is a gradient with exchanged channels is the rest of one in the other convention.
    let found = Defect::new(MapFault::ChannelsSwapped {
        by_derivatives,
        log_energy_ratio: judgement.log_energy_ratio,
        residuals: [up.min(down), 1.0 - up.max(down)],
        certainty: certainty(judgement, map),
        faces: by_facets.then(|| faces_score(map, candidates(judgement)[1])),
    });
    Some(found.with_obstacle(is_undecided.then_some(Obstacle::ExchangedAndInverted(map.wanted))))
}

/// How far x and y of a map may lean on average; the slopes of a surface cancel.
const MAX_MEAN_LEAN: f32 = 0.25;

/// Mean lengths that cost no visible light. Resizing and compression shorten and lengthen single vectors of a
/// rough map, and nearly all renderers normalise: where neither the mean nor most vectors are off, nothing
/// needs to be done.
const MEAN_LENGTHS: std::ops::RangeInclusive<f32> = 0.9..=1.1;

fn not_unit(map: &Map) -> Option<Defect> {
    let judgement = of_kind(map, Kind::Normals)?;
    let found = texels(judgement, judgement.not_unit);
    let verdict = map.scaled.as_ref().unwrap_or(judgement).verdict;
    let is_surface = matches!(verdict, MapVerdict::OpenGl | MapVerdict::DirectX | MapVerdict::Flat);
    let leans = judgement.mean[..2].iter().any(|mean| mean.abs() > MAX_MEAN_LEAN);
    let doubt = if found.percent <= 50.0 {
        None
    } else if leans {
        Some(LengthDoubt::Leaning)
    } else if !is_surface {
        Some(LengthDoubt::NoSlopes)
    } else {
        None
    };
    let obstacle = doubt.map(|doubt| match doubt {
        LengthDoubt::Leaning => Obstacle::VectorsLean,
        LengthDoubt::NoSlopes => Obstacle::MayBeNoMap,
    });
    let fault = MapFault::NotUnit { texels: found, mean_length: judgement.mean_length, doubt };
    let shrinks = !MEAN_LENGTHS.contains(&judgement.mean_length);
    let severity = if found.percent > 50.0 || shrinks { Severity::Warning } else { Severity::Info };
    (found.percent > MAX_PERCENT).then(|| Defect::new(fault).with_obstacle(obstacle).with_severity(severity))
}

/// The share of texels below the surface, in percent, that is worth a warning.
const MAX_PERCENT_BELOW: f64 = 0.01;

fn negative_z(map: &Map) -> Option<Defect> {
    let judgement = of_kind(map, Kind::Normals)?;
    let found = texels(judgement, judgement.negative_z);
    (found.percent > MAX_PERCENT_BELOW).then(|| Defect::new(MapFault::NegativeZ(found)))
}

/// Whether a code is near the code of a texel that does not lean.
fn is_near_zero(code: &u8) -> bool {
    (120..=136).contains(code)
}

/// Whether the commonest texel, or the colour of the whole map, leans. Another commonest texel belongs to the
/// surface, unless there is no other; 127 is the other nearest code of zero.
fn leans_where_flat(judgement: &MapJudgement) -> bool {
    let code = judgement.commonest;
    let is_off = code.iter().any(|code| !(127..=128).contains(code));
    let is_common = percent(judgement, judgement.commonest_count) > MAX_PERCENT;
    is_off && (judgement.verdict == MapVerdict::Flat || code.iter().all(is_near_zero) && is_common)
}

fn flat_off(map: &Map) -> Option<Defect> {
    let judgement = of_kind(map, Kind::Normals).filter(|judgement| leans_where_flat(judgement))?;
    let commonest = judgement.commonest;
    let lean = commonest.map(|code| (f64::from(code) - 127.5) / 127.5);
    let is_one_colour = judgement.verdict == MapVerdict::Flat;
    let is_error = is_one_colour && !commonest.iter().all(is_near_zero);
    let found = Defect::new(MapFault::FlatOff {
        commonest,
        colour: is_one_colour.then(|| colour(judgement)),
        degrees: lean[0].hypot(lean[1]).min(1.0).asin().to_degrees(),
        texels: texels(judgement, judgement.commonest_count),
    });
    Some(if is_error { found.with_severity(Severity::Error) } else { found })
}

fn flat(map: &Map) -> Option<Defect> {
    let judgement = of_kind(map, Kind::Normals)?;
    let is_plain = judgement.verdict == MapVerdict::Flat && !leans_where_flat(judgement);
    is_plain.then(|| Defect::new(MapFault::Flat(percent(judgement, judgement.commonest_count))))
}

/// Steps from which on storage is worth a warning, in degrees.
const MIN_STEP: f64 = 1.5;
const MIN_BLOCK_STEP: f64 = 3.0;

fn enlarged(map: &Map) -> Option<Defect> {
    of_kind(map, Kind::Normals)?;
    let found = map.storage.enlargement?;
    Some(of_step(MapFault::Enlarged(found), found.step, MIN_STEP))
}

fn padding(map: &Map) -> Option<Defect> {
    of_kind(map, Kind::Normals).filter(|judgement| judgement.verdict != MapVerdict::Flat)?;
    Some(Defect::new(MapFault::Padding(map.facets.as_ref()?.padding?)))
}

fn banding(map: &Map) -> Option<Defect> {
    of_kind(map, Kind::Normals).filter(|judgement| judgement.verdict != MapVerdict::Flat)?;
    let found = map.storage.few_levels?;
    Some(of_step(MapFault::Banding(found), found.step, MIN_STEP))
}

/// The borders of the texels of an enlarged map are no borders of blocks.
fn blocks(map: &Map) -> Option<Defect> {
    of_kind(map, Kind::Normals)?;
    let found = map.storage.block_steps.filter(|_| map.storage.enlargement.is_none())?;
    Some(of_step(MapFault::Blocks(found), found.degrees, MIN_BLOCK_STEP))
}

/// The defect with the severity of the steps that it adds: information where they are smaller than `visible`.
fn of_step(fault: MapFault, step: f64, visible: f64) -> Defect {
    Defect::new(fault).with_severity(if step >= visible { Severity::Warning } else { Severity::Info })
}

#[cfg(test)]
mod tests {
    use darboux::{TexelLayout, judge_normal_map};

    use super::*;

    /// Waves along u, v and both, as `[x, y]`; `is_exchanged` exchanges red and green, and green is inverted
    /// before.
    fn map(is_exchanged: bool) -> Map {
        let texel = |i: usize| {
            let (x, y) = ((i % 128) as f32 / 5.0, (i / 128) as f32 / 5.0);
            let both = 0.5 * (x + y).cos();
            let slopes = [x.cos() + both, y.cos() + both].map(|slope| 0.2 * slope);
            let [red, green] = if is_exchanged { [slopes[1], slopes[0]] } else { slopes };
            let length = (red * red + green * green + 1.0).sqrt();
            [-red, green, 1.0].map(|x| (127.5 + 127.5 * x / length).round() as u8)
        };
        let texels: Vec<[u8; 3]> = (0..128 * 128).map(texel).collect();
        let judgement = judge_normal_map(&texels, [128; 2], TexelLayout::RGB).expect("whole rows");
        let facets = Some(MeshVotes::only(candidates(&judgement)[1], 7.0));
        let unread = Map::unread(Unread::LeftOut(String::new()), BitangentDirection::Up);
        Map { judgement: Ok(judgement), facets, ..unread }
    }

    /// Facets that vote for exchanged channels do not outweigh derivatives that show a gradient.
    #[test]
    fn gradients_have_no_exchanged_channels() {
        assert!(channels_swapped(&map(true)).is_some());
        assert!(channels_swapped(&map(false)).is_none());
    }
}
