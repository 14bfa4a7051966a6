//! Rules about the texels of normal maps.

use darboux::{BitangentDirection, MapJudgement, MapVerdict, SrgbMistake, TangentDirection};

use crate::code::Code;
use crate::contradiction::Contradiction;
use crate::facets::{Arrangement, FacetVotes};
use crate::finding::Finding;
use crate::map::{Map, MapDirections, TwoChannels, percent};
use crate::map_kind::{Kind, kind};
use crate::rule::MapRule;
use crate::severity::Severity;
use crate::text::counted;

pub const RULES: &[MapRule] = &[
    unreadable,
    height,
    object_space,
    reordered,
    srgb,
    not_normal,
    two_channel,
    contradiction,
    red_flipped,
    green_flipped,
    channels_swapped,
    not_unit,
    negative_z,
    flat_off,
    flat,
];

/// The share of texels, in percent, above which vectors are worth a warning.
const MAX_PERCENT: f64 = 5.0;

/// The confidence in percent from which on a direction is an error. Below it is a warning, and is not repaired.
const SURE_PERCENT: f64 = 90.0;

fn unreadable(map: &Map) -> Option<Finding> {
    let problem = map.judgement.as_ref().err()?;
    let bytes = map.file_size as f64;
    Some(Finding::new(Code::MapUnreadable, format!("it {problem}")).with_evidence("file", bytes, "bytes"))
}

/// The judgement on a map, if it is of any use.
fn judged(map: &Map) -> Option<&MapJudgement> {
    map.judgement.as_ref().ok()
}

fn height(map: &Map) -> Option<Finding> {
    let judgement = judged(map).filter(|judgement| kind(map, judgement) == Kind::Grey)?;
    let share = percent(judgement, judgement.grey);
    Some(Finding::new(Code::MapHeight, "it is grey").with_count(judgement.grey).with_evidence(
        "grey texels",
        share,
        "%",
    ))
}

fn object_space(map: &Map) -> Option<Finding> {
    let judgement = judged(map).filter(|judgement| kind(map, judgement) == Kind::ObjectSpace)?;
    let share = percent(judgement, judgement.negative_z);
    let finding = Finding::new(Code::MapObjectSpace, "its unit vectors point in all directions");
    Some(finding.with_count(judgement.negative_z).with_evidence("texels with negative z", share, "%"))
}

/// The vectors of a tangent-space map point along z on average. Those of a flat surface in object space may point along any axis.
fn reordered(map: &Map) -> Option<Finding> {
    let judgement = judged(map).filter(|judgement| kind(map, judgement) == Kind::Reordered)?;
    let reordered = map.reordered.as_ref()?;
    let (code, text, cure, obstacle) = match reordered.is_z() {
        true => (
            Code::MapNegativeZ,
            "its vectors point into the surface: blue is inverted, or the whole image is a negative".to_owned(),
            "Invert blue, or all three channels if the image is a negative: with blue alone, bumps of a negative become dents.".to_owned(),
            "nothing says whether only blue is inverted or the whole image",
        ),
        false => (
            Code::MapChannelsSwapped,
            format!("its vectors point along {}, and those of a map in tangent space along blue: its channels are in another order{}, or it is in the object space of a flat surface", reordered.axis(), reordered.orders()),
            reordered.cure(),
            "nothing says for certain whether its channels are in another order or it is in object space",
        ),
    };
    let lean = f64::from(judgement.mean[reordered.channel()]);
    let finding = Finding::new(code, text).with_severity(Severity::Error).with_cure(cure);
    let finding = finding.with_evidence("mean of that channel, from -1 to 1", lean, "");
    Some(Finding { left_because: Some(obstacle.to_owned()), ..finding })
}

fn srgb(map: &Map) -> Option<Finding> {
    let judgement = judged(map).filter(|judgement| kind(map, judgement) == Kind::Srgb)?;
    let [red, green] = judgement.commonest;
    let (what, obstacle) = match map.srgb_mistake {
        Some(SrgbMistake::Encoded) => ("encoded as sRGB", None),
        Some(SrgbMistake::Decoded) => ("decoded as sRGB", None),
        None => ("encoded as sRGB, and red or green was inverted after that", Some(INVERTED_CODE)),
        Some(_) => return None,
    };
    let is_by_length = map.srgb_mistake.is_some() && judgement.srgb_mistake().is_none();
    let before = map.before_srgb.filter(|_| is_by_length);
    if let Some(before) = before {
        let text = format!("linear values were {what}: without that, nearly all its vectors have length 1");
        let [spoilt, healthy] = [judgement, &before].map(|of| percent(of, of.not_unit));
        let finding = Finding::new(Code::MapSrgb, text).with_count(judgement.not_unit);
        let finding = finding.with_evidence("texels of another length than 1", spoilt, "%");
        return Some(finding.with_evidence("once that is undone", healthy, "%"));
    }
    let text =
        format!("its commonest texel is {red}, {green} instead of 128, 128: linear values were {what}");
    let share = percent(judgement, judgement.commonest_count);
    let finding = Finding::new(Code::MapSrgb, text).with_count(judgement.commonest_count);
    let finding = finding.with_obstacle(obstacle.map(str::to_owned));
    Some(finding.with_evidence("texels of this colour", share, "%"))
}

/// Why a map that was encoded and then inverted is left.
const INVERTED_CODE: &str = "invert the channel near 67 of the map again first: `darboux convert --from directx --to opengl` inverts green";

fn not_normal(map: &Map) -> Option<Finding> {
    let judgement = judged(map).filter(|judgement| kind(map, judgement) == Kind::Other)?;
    let share = percent(judgement, judgement.not_normal);
    let text = match () {
        () if judgement.background == judgement.texels => {
            "all its texels are black, white or middle grey, which are no normals: a flat map is 128, 128, 255"
                .to_owned()
        }
        () if judgement.verdict == MapVerdict::Flat => {
            format!("all its texels are about {}, which is no normal: a flat map is 128, 128, 255", colour(judgement))
        }
        () if judgement.holds_no_normals() => "most of its texels cannot be normals".to_owned(),
        () if map.is_picture => {
            "most of its texels have no length near 1, and red and green are light and dark together, as in a picture"
                .to_owned()
        }
        () => "its texels are no slopes of a surface, and most are no unit vectors".to_owned(),
    };
    let finding = Finding::new(Code::MapNotNormal, text);
    Some(finding.with_count(judgement.not_normal).with_evidence("texels that are no normals", share, "%"))
}

/// The commonest red and green, and the mean blue, as 8-bit codes.
fn colour(judgement: &MapJudgement) -> String {
    let ([red, green], blue) = (judgement.commonest, 127.5 * (judgement.mean[2] + 1.0));
    format!("{red}, {green}, {blue:.0}")
}

fn two_channel(map: &Map) -> Option<Finding> {
    judged(map).filter(|judgement| kind(map, judgement) == Kind::TwoChannel)?;
    let (text, judgement, obstacle) = match map.two_channels? {
        TwoChannels::RedGreen(judgement) => ("its blue channel has one value only", judgement, None),
        TwoChannels::AlphaGreen(judgement) => {
            ("its x is in alpha (DXT5nm): its red channel has one value only", judgement, Some(X_IN_ALPHA))
        }
    };
    let is_unclear = judgement.verdict == MapVerdict::CannotTell && map.facets.is_none();
    let obstacle = obstacle.or(is_unclear.then_some(UNCLEAR_CHANNELS)).map(str::to_owned);
    let finding = Finding::new(Code::MapTwoChannel, text).with_obstacle(obstacle);
    Some(with_certainty(finding, &judgement, map))
}

/// Why a map with x in alpha is left.
const X_IN_ALPHA: &str = "alpha may be wanted for something else; if it is x, `darboux convert --from opengl --to opengl --layout ag --to-layout rgb` computes blue";

/// Why a map without z is left whose derivatives say nothing, and which no material uses as a normal map.
const UNCLEAR_CHANNELS: &str =
    "its red and green are too few or too even to tell the slopes of a surface from other data";

/// The arrangement that the derivatives show: that of a map with no (or both) channels inverted, or with one.
fn arrangement(judgement: &MapJudgement) -> Option<Arrangement> {
    match judgement.verdict {
        MapVerdict::OpenGl => Some(Arrangement::Same),
        MapVerdict::DirectX => Some(Arrangement::GreenInverted),
        _ => None,
    }
}

/// The derivatives tell whether one channel is inverted or none (or both); the facets of the mesh tell which, if they can. Otherwise red is taken to be
/// right.
fn directions(judgement: &MapJudgement, map: &Map) -> Option<MapDirections> {
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

/// What the z score of the derivatives is called, and the number of tiles that it is from.
const CERTAINTY: &str =
    "distance of the tiles' mean agreement from zero (4 or more decide for OpenGL, -4 or less for DirectX)";
const TILES: &str = "tiles that were compared";

/// What the z score of the faces is called, and their number.
pub const BY_FACES: &str =
    "distance of the faces' mean agreement with the map from zero (6 or more decide, or -6 or less)";
const FACES: &str = "faces that were compared";

/// The finding with the z score of the derivatives as evidence.
fn with_certainty(finding: Finding, judgement: &MapJudgement, map: &Map) -> Finding {
    let finding = finding.with_evidence(CERTAINTY, judgement.z_score.into(), "standard errors");
    finding.with_evidence(TILES, map.tiles as f64, "tiles")
}

/// The finding with the z score that the faces give an arrangement as evidence.
fn with_faces(finding: Finding, map: &Map, arrangement: Arrangement) -> Finding {
    let finding = finding.with_evidence(BY_FACES, map.facet_score(arrangement), "standard errors");
    let faces = map.facets.as_ref().map_or(0, FacetVotes::count);
    finding.with_evidence(FACES, faces as f64, "faces")
}

/// The finding with the evidence for the direction of the channels.
fn with_directions(finding: Finding, judgement: &MapJudgement, map: &Map) -> Finding {
    let percent = 100.0 * f64::from(judgement.confidence);
    let is_sure = percent >= SURE_PERCENT;
    let unsure = (!is_sure).then(|| format!("this is only {percent:.0} % sure"));
    let finding = finding
        .with_severity(if is_sure { Severity::Error } else { Severity::Warning })
        .with_obstacle(unsure)
        .with_evidence("confidence", 100.0 * f64::from(judgement.confidence), "%")
        .with_evidence(
            "agreement of red and green as slopes, from -1 (DirectX) to 1 (OpenGL)",
            judgement.correlation.into(),
            "",
        );
    let finding = with_certainty(finding, judgement, map);
    match arrangement(judgement).filter(|arrangement| map.decide(*arrangement).is_some()) {
        Some(arrangement) => with_faces(finding, map, arrangement),
        None => finding,
    }
}

/// The judgement on a map whose channels have directions, unless red and green are exchanged, or parts of the map contradict each other.
fn directed(map: &Map) -> Option<&MapJudgement> {
    let judgement = with_directed_channels(map).filter(|_| map.contradiction.is_none())?;
    (!facets_show_exchange(judgement, map)).then_some(judgement)
}

fn with_directed_channels(map: &Map) -> Option<&MapJudgement> {
    judged(map).filter(|judgement| matches!(kind(map, judgement), Kind::Normals | Kind::TwoChannel))
}

/// Why a map is left of which only a part is inverted.
const ONLY_A_PART: &str = "nothing says where one part ends and the other one begins";

/// One part of the map is in OpenGL's convention and another one in DirectX's.
fn contradiction(map: &Map) -> Option<Finding> {
    with_directed_channels(map)?;
    let Contradiction { side, parts: [up, down] } = map.contradiction?;
    let text = format!(
        "parts of it contradict each other: of blocks of {side} x {side} texels, {} with green up (OpenGL) ({}), and {} with green down (DirectX) or red inverted ({})",
        counted(up.blocks, "is", "are"),
        up.place(),
        counted(down.blocks, "is", "are"),
        down.place()
    );
    let wrong = if map.wanted == BitangentDirection::Up { down } else { up };
    let finding = Finding::new(Code::MapGreenFlipped, text).with_severity(Severity::Warning);
    let finding = Finding { is_on_part_of_image: true, ..finding };
    let finding = finding.with_count(wrong.blocks * side * side).with_obstacle(Some(ONLY_A_PART.to_owned()));
    let finding = finding.with_cure(
        "Invert green in the part that is inverted, in an image editor, or bake the whole map again.",
    );
    Some(
        finding
            .with_evidence(
                "mean agreement of the tiles from zero, in the clearest block with green up",
                up.z_score.into(),
                "standard errors",
            )
            .with_evidence("in the clearest block with green down", down.z_score.into(), "standard errors"),
    )
}

fn green_flipped(map: &Map) -> Option<Finding> {
    let judgement = directed(map)?;
    if directions(judgement, map)?.green == map.wanted {
        return None;
    }
    let program = match map.wanted {
        BitangentDirection::Up => "DirectX (green down) instead of OpenGL (green up)",
        BitangentDirection::Down => "OpenGL (green up) instead of DirectX (green down)",
    };
    let leans_to_red =
        arrangement(judgement).is_some_and(|arrangement| map.facet_score(arrangement) <= LEANS_TO_RED);
    let (doubt, obstacle) = match (directions_by_mesh(map), &map.facets) {
        (Some(_), _) => ("", None),
        (None, Some(_)) if leans_to_red => (
            ", or its red is inverted, which looks the same to this test: the faces of the model lean that way",
            Some(
                "the faces of the model lean towards inverted red without deciding it; look at one bump with a light beside it and one above it",
            ),
        ),
        (None, Some(_)) => (
            ", or its red is inverted, which is much rarer, looks the same to this test, and is not decided by the faces of the model",
            None,
        ),
        (None, None) => (
            ", or its red is inverted, which is much rarer and looks the same to this test",
            Some(ONLY_THE_MODEL),
        ),
    };
    let obstacle = obstacle.map(str::to_owned);
    let cure = match map.wanted {
        BitangentDirection::Up => Code::MapGreenFlipped.cure(),
        BitangentDirection::Down => {
            "Export or bake the map with green down (DirectX, -Y), or invert green of the map with `darboux convert --from opengl --to directx`."
        }
    };
    let finding = Finding::new(Code::MapGreenFlipped, format!("it is in the convention of {program}{doubt}"))
        .with_cure(cure);
    Some(with_directions(finding.with_obstacle(obstacle), judgement, map))
}

/// The z score of the faces up to which they make inverted red likelier than inverted green, without deciding it. Faces that a map was not made for
/// give 4 by chance.
const LEANS_TO_RED: f64 = -5.0;

/// Why inverted green is left in a map without a model.
const ONLY_THE_MODEL: &str = "only the faces of the model tell inverted green from inverted red; name the model with --model, or invert green with `darboux convert`";

fn red_flipped(map: &Map) -> Option<Finding> {
    let judgement = directed(map)?;
    (directions(judgement, map)?.red == TangentDirection::Left).then(|| {
        let text = "its red is inverted: its texels lean against the faces of the mesh";
        with_directions(Finding::new(Code::MapRedFlipped, text), judgement, map)
    })
}

/// The arrangements that the sign of the derivatives permits: red and green at their places, and exchanged.
fn candidates(judgement: &MapJudgement) -> [Arrangement; 2] {
    match judgement.z_score > 0.0 {
        true => [Arrangement::Same, Arrangement::Exchanged],
        false => [Arrangement::GreenInverted, Arrangement::ExchangedAndInverted],
    }
}

/// The largest log energy ratio of a map whose channels may be exchanged: that of a gradient is not negative, and exchanging them negates it.
const MAX_RATIO_OF_EXCHANGED: f32 = 0.02;

/// Whether the texels follow the facets of the mesh with red and green exchanged, and not otherwise, and their derivatives permit it. A map that
/// was mirrored shows other texels than the baked ones on every facet, and these may lean in any way.
fn facets_show_exchange(judgement: &MapJudgement, map: &Map) -> bool {
    if judgement.log_energy_ratio > MAX_RATIO_OF_EXCHANGED {
        return false;
    }
    let [straight, exchanged] = candidates(judgement).map(|arrangement| map.facet_score(arrangement).abs());
    let decided = candidates(judgement).map(|arrangement| map.decide(arrangement).is_some());
    decided[1] && exchanged > 2.0 * straight
}

/// Why exchanged channels are left of which one is inverted.
const INVERTED_TOO: &str = "one channel is inverted, too, and no faces of a model show which: once red and green are exchanged back, either green is inverted or red is";

fn channels_swapped(map: &Map) -> Option<Finding> {
    let judgement = judged(map).filter(|judgement| kind(map, judgement) == Kind::Normals)?;
    let by_derivatives = judgement.has_exchanged_channels();
    let by_facets = facets_show_exchange(judgement, map);
    let text = match (by_derivatives, by_facets) {
        (false, false) => return None,
        (true, _) => {
            "its red changes from texel to texel as green should, and its green as red should: they are exchanged"
        }
        (false, true) => "its texels follow the faces of the mesh with red and green exchanged",
    };
    let is_undecided = judgement.z_score < 0.0 && map.decide(Arrangement::ExchangedAndInverted).is_none();
    let finding = Finding::new(Code::MapChannelsSwapped, text)
        .with_obstacle(is_undecided.then(|| INVERTED_TOO.to_owned()))
        .with_evidence("logarithm of the changes along red's and green's own axes over those across (negative if exchanged)", judgement.log_energy_ratio.into(), "");
    let finding = with_certainty(finding, judgement, map);
    Some(match by_facets {
        true => with_faces(finding, map, candidates(judgement)[1]),
        false => finding,
    })
}

/// How far x and y of a map may lean on average; the slopes of a surface cancel.
const MAX_MEAN_LEAN: f32 = 0.25;

/// What is said of vectors that lean on average, and why they are not scaled.
const LEANS: &str =
    ", and they lean to one side on average, as after a change of brightness, contrast or colours";
const LEANS_TOO: &str = "scaled to length 1, the vectors would still lean; undo the change of the colours, or export the map again";

/// What is said of vectors that show no surface.
const NO_SLOPES: &str =
    ", and nothing shows that they are slopes of a surface: it may be another kind of image";

/// Why vectors of an image are not scaled that may be no normal map.
const MAY_BE_NO_MAP: &str = "scaled to length 1, the texels of another kind of image would still be no normals; if this is a normal map, normalise it in the program that made it";

fn not_unit(map: &Map) -> Option<Finding> {
    let judgement = judged(map).filter(|judgement| kind(map, judgement) == Kind::Normals)?;
    let share = percent(judgement, judgement.not_unit);
    let verdict = map.scaled.as_ref().unwrap_or(judgement).verdict;
    let is_surface = matches!(verdict, MapVerdict::OpenGl | MapVerdict::DirectX | MapVerdict::Flat);
    let leans = judgement.mean[..2].iter().any(|mean| mean.abs() > MAX_MEAN_LEAN);
    let doubt = match () {
        () if share <= 50.0 => None,
        () if leans => Some((
            LEANS,
            LEANS_TOO,
            "Undo the change of brightness or colours, or export the map again as it was.",
        )),
        () if !is_surface => Some((
            NO_SLOPES,
            MAY_BE_NO_MAP,
            "Put the normal map into the slot; if this is one, normalise it in the program that made it.",
        )),
        () => None,
    };
    let clause = doubt.map_or("", |(clause, ..)| clause);
    let cure = doubt.map_or(Code::MapNotUnit.cure(), |(.., cure)| cure);
    (share > MAX_PERCENT).then(|| {
        Finding::new(
            Code::MapNotUnit,
            format!("{} texels have another length than 1{clause}", judgement.not_unit),
        )
        .with_count(judgement.not_unit)
        .with_cure(cure)
        .with_obstacle(doubt.map(|(_, obstacle, _)| obstacle.to_owned()))
        .with_evidence("texels", share, "%")
        .with_evidence("mean length", judgement.mean_length.into(), "")
    })
}

fn negative_z(map: &Map) -> Option<Finding> {
    let judgement = judged(map).filter(|judgement| kind(map, judgement) == Kind::Normals)?;
    let share = percent(judgement, judgement.negative_z);
    (share > 0.01).then(|| {
        Finding::new(Code::MapNegativeZ, format!("{} texels point below the surface", judgement.negative_z))
            .with_count(judgement.negative_z)
            .with_evidence("texels", share, "%")
    })
}

fn flat_off(map: &Map) -> Option<Finding> {
    let judgement = judged(map).filter(|judgement| kind(map, judgement) == Kind::Normals)?;
    let code = judgement.commonest;
    // Another commonest texel belongs to the surface, unless there is no other; 127 is the other nearest code of zero.
    let is_near = code.iter().all(|code| (120..=136).contains(code));
    let is_off = code.iter().any(|code| !(127..=128).contains(code));
    let is_one_colour = judgement.verdict == MapVerdict::Flat;
    let share = percent(judgement, judgement.commonest_count);
    let is_told = is_one_colour || is_near && share > MAX_PERCENT;
    if !is_off || !is_told {
        return None;
    }
    let [red, green] = code;
    let lean = code.map(|code| (f64::from(code) - 127.5) / 127.5);
    let degrees = lean[0].hypot(lean[1]).min(1.0).asin().to_degrees();
    let finding = match is_one_colour {
        true => {
            let colour = colour(judgement);
            let text = format!(
                "all its texels are about {colour} instead of 128, 128, 255, so that the whole surface is lit as if it leaned by {degrees:.0} degrees"
            );
            Finding::new(Code::MapFlatOff, text)
                .with_severity(if is_near { Severity::Warning } else { Severity::Error })
                .with_cure("Leave the map out, or fill it with 128, 128, 255.")
        }
        false => {
            Finding::new(Code::MapFlatOff, format!("its flat texels are {red}, {green} instead of 128, 128"))
        }
    };
    let finding = finding.with_count(judgement.commonest_count).with_evidence("angle", degrees, "degrees");
    Some(finding.with_evidence("texels", share, "%"))
}

fn flat(map: &Map) -> Option<Finding> {
    let judgement = judged(map).filter(|judgement| judgement.verdict == MapVerdict::Flat)?;
    let is_plain = kind(map, judgement) == Kind::Normals && flat_off(map).is_none();
    let share = percent(judgement, judgement.commonest_count);
    let finding = || Finding::new(Code::MapFlat, "all its texels are the same");
    is_plain.then(|| finding().with_evidence("texels of the commonest colour", share, "%"))
}

#[cfg(test)]
mod tests {
    use darboux::{TexelLayout, judge_normal_map};

    use super::*;

    /// Waves along u, v and both, as `[x, y]`; `is_exchanged` exchanges red and green, and green is inverted before.
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
        let judgement =
            judge_normal_map(&texels, [128; 2], TexelLayout::RGB).map_err(|error| error.to_string());
        let arrangement = candidates(judgement.as_ref().expect("a judgement"))[1];
        let facets = Some(FacetVotes::only(arrangement, 7.0));
        Map {
            judgement,
            file_size: 0,
            tiles: 0,
            srgb_mistake: None,
            before_srgb: None,
            scaled: None,
            two_channels: None,
            contradiction: None,
            reordered: None,
            is_picture: false,
            wanted: BitangentDirection::Up,
            facets,
        }
    }

    /// Facets that vote for exchanged channels do not outweigh derivatives that show a gradient.
    #[test]
    fn gradients_have_no_exchanged_channels() {
        assert!(channels_swapped(&map(true)).is_some());
        assert!(channels_swapped(&map(false)).is_none());
    }
}
