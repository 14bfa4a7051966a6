//! The words of defects of the texels of normal maps.

use darboux::{BitangentDirection, SrgbMistake};

use super::counts::{Count, Sure, counted};
use super::said::Said;
use crate::code::Code;
use crate::defect::{
    Certainty, DirectionEvidence, FacesScore, LengthDoubt, MapFault, NoNormals, RedDoubt, ReliefEvidence,
    Texels, Unread,
};
use crate::measure::contradiction::{Contradiction, Part};
use crate::measure::padding::Padding;
use crate::measure::reordered::Reordered;
use crate::measure::seams::Layout;
use crate::measure::storage::{BlockSteps, Enlargement, FewLevels};

pub fn said(fault: &MapFault) -> Said {
    match fault {
        MapFault::Unreadable { name, why, bytes } => unread(name, why, *bytes as f64),
        MapFault::Height(texels) => Said::new("it is grey").with("grey texels", texels.percent, "%"),
        MapFault::ObjectSpace(texels) => Said::new("its unit vectors point in all directions").with(
            "texels with negative z",
            texels.percent,
            "%",
        ),
        MapFault::Reordered { reordered, mean } => {
            along_other_axis(reordered).with("mean of that channel, from -1 to 1", f64::from(*mean), "")
        }
        MapFault::Srgb { mistake, commonest: [red, green], texels } => Said::new(format!(
            "its commonest texel is {red}, {green} instead of 128, 128: linear values were {}",
            transfer(*mistake)
        ))
        .with("texels of this colour", texels.percent, "%"),
        MapFault::SrgbByLength { mistake, not_unit, undone } => Said::new(format!(
            "linear values were {}: without that, nearly all its vectors have length 1",
            transfer(Some(*mistake))
        ))
        .with("texels of another length than 1", not_unit.percent, "%")
        .with("once that is undone", *undone, "%"),
        MapFault::NotNormal { kind, texels } => {
            Said::new(no_normals(kind)).with("texels that are no normals", texels.percent, "%")
        }
        MapFault::TwoChannel { is_x_in_alpha, certainty, misreading } => {
            let text = if *is_x_in_alpha {
                "its x is in alpha (DXT5nm): its red channel has one value only"
            } else {
                "its blue channel has one value only"
            };
            let said = Said::new(text)
                .with(
                    "typical angle between its normals and those of all three channels",
                    misreading.typical,
                    "degrees",
                )
                .with("part of the map that looks wrong by that, by the angle", misreading.damaged, "%");
            with_certainty(said, certainty)
        }
        MapFault::Contradiction { contradiction, .. } => contradictory(contradiction),
        MapFault::GreenFlipped { wanted, doubt, evidence } => green_flipped(*wanted, *doubt, evidence),
        MapFault::RedFlipped(evidence) => {
            let text = match evidence.faces {
                Some(_) => "its red is inverted: its texels lean against the faces of the mesh",
                None => "its red is inverted, as was assumed",
            };
            with_directions(Said::new(text), evidence)
        }
        MapFault::MayBeDents { wanted, score } => may_be_dents(*wanted, score),
        MapFault::DetailFlipped { is_relief_up, evidence } => detail_flipped(*is_relief_up, evidence),
        MapFault::ChannelsSwapped { by_derivatives, log_energy_ratio, residuals, certainty, faces } => {
            let text = if *by_derivatives {
                "its red changes from texel to texel as green should, and its green as red should: they are \
                 exchanged"
            } else {
                "its texels follow the faces of the mesh with red and green exchanged"
            };
            let [as_they_are, exchanged] = residuals.map(|residual| 100.0 * f64::from(residual));
            let said = Said::new(text)
                .with(RATIO, f64::from(*log_energy_ratio), "")
                .with("part of the slopes that no height field explains, as they are", as_they_are, "%")
                .with("exchanged", exchanged, "%");
            with_faces(with_certainty(said, certainty), faces.as_ref())
        }
        MapFault::NotUnit { texels, mean_length, doubt } => not_unit(texels, *mean_length, *doubt),
        MapFault::NegativeZ(texels) => Said::new(format!("{} texels point below the surface", texels.count))
            .with("texels", texels.percent, "%"),
        MapFault::FlatOff { commonest, colour, degrees, texels } => {
            flat_off(*commonest, colour.as_ref(), *degrees, texels)
        }
        MapFault::OtherLayout { layout, fits: [fit, as_it_is], points } => {
            Said::new(format!("it fits the seams of the mesh only {}, and not as it is", turned(*layout)))
                .with("correlation of both sides of the seams so", fit.correlation, "")
                .with("its distance from that of the map at other places", fit.z_score, "standard deviations")
                .with("correlation as it is", as_it_is.correlation, "")
                .with("points of seams that were compared", *points as f64, "points")
        }
        MapFault::Padding(Padding { wanted, fewer_than, degrees, inside }) => Said::new(format!(
            "its background is no normal and gets into the borders of its charts from afar: they want \
                 {wanted} texels of padding and have fewer than {fewer_than}"
        ))
        .with("typical lean of the borders", *degrees, "degrees")
        .with("the same inside of charts", *inside, "degrees")
        .with("size of the model on the screen", Padding::PIXELS, "pixels"),
        MapFault::Enlarged(Enlargement { factors: [across, down], size: [width, height], step }) => {
            Said::new(format!(
                "it was enlarged from {width} x {height} texels without interpolation: each of them is there \
                 {across} times across and {down} times down"
            ))
            .with("typical step between them", *step, "degrees")
        }
        MapFault::Banding(FewLevels { bits: [red, green], levels, step }) => {
            let bits = if red == green { format!("{red} bits") } else { format!("{red} and {green} bits") };
            Said::new(format!("its red and green have {bits} instead of 8, so that slopes end in bands"))
                .with("step from one level to the next", *step, "degrees")
                .with("levels of red", levels[0] as f64, "levels")
                .with("levels of green", levels[1] as f64, "levels")
        }
        MapFault::Blocks(BlockSteps { side, degrees, share }) => Said::new(format!(
            "a compression in blocks of {side} x {side} texels left steps at their borders"
        ))
        .with("what a typical border adds to the steps inside of blocks", *degrees, "degrees")
        .with("borders that stand out", 100.0 * share, "%"),
        MapFault::Flat(percent) => {
            Said::new("all its texels are the same").with("texels of the commonest colour", *percent, "%")
        }
    }
}

fn unread(name: &str, why: &Unread, bytes: f64) -> Said {
    let it = if name.is_empty() { "it".to_owned() } else { format!("its file {name}") };
    match why {
        Unread::Damaged(problem) => Said::new(format!("{it} {problem}")).with("file", bytes, "bytes"),
        Unread::GitLfsPointer => Said::new(format!("{it} is a pointer of Git LFS, not the image"))
            .with_cure("Type `git lfs pull` in the repository of the file, and check again."),
        Unread::Absent(problem) => Said::new(format!("{it} {problem}")).with_cure(
            "Put the image where the model refers to it, or correct the reference; in the \
                 command, --allow-outside reads images of other folders.",
        ),
        Unread::OtherFormat(problem) => Said::new(format!("{it} was not checked, because it {problem}"))
            .with_cure("None needed. To check the map, check the model before its images are compressed.")
            .with("file", bytes, "bytes"),
        Unread::LeftOut(problem) => Said::new(format!("{it} was not checked, because it {problem}"))
            .with_cure("None needed. To check the map, check its file alone."),
        Unread::NotCarried(problem) => {
            let name = if name.is_empty() { String::new() } else { format!(" {name}") };
            Said::new(format!("its normal map{name} was not checked, because it {problem}"))
                .with_cure("To check the map, let the material name an image that is read, and check again.")
        }
    }
}

/// How a map has to be read to fit the seams.
fn turned(layout: Layout) -> &'static str {
    match layout {
        Layout::TurnedUvs([true, true]) => "if the UVs are turned by 180 degrees",
        Layout::TurnedUvs([true, false]) => "if u of the UVs is turned to 1 - u",
        Layout::QuarterTurnedUvs { .. } => "if the UVs are turned by 90 degrees",
        Layout::TurnedUvs(_) => "if v of the UVs is turned to 1 - v",
        Layout::TurnedImage([true, true]) => "if the image is turned by 180 degrees",
        Layout::TurnedImage([true, false]) => "if the image is mirrored from left to right",
        Layout::TurnedImage(_) | Layout::Same => "if the image is turned upside down",
    }
}

/// What the texels show: inverted red looks as inverted green does.
const CONFIDENCE: &str = "confidence that one of red and green is inverted, by the texels";

/// What the z score of the derivatives is called, and the number of tiles that it is from.
const CERTAINTY: &str = "distance of the tiles' mean agreement from zero (positive for OpenGL, negative for \
     DirectX), each tile alike";
const TILES: &str = "tiles that were compared";

/// What the z score of the faces is called, and their number.
const BY_FACES: &str =
    "distance of the faces' mean agreement with the map from zero (6 or more decide, or -6 or less)";
const FACES: &str = "faces that were compared";

/// What the log energy ratio is called.
const RATIO: &str =
    "logarithm of the changes along red's and green's own axes over those across (negative if exchanged)";

fn with_certainty(said: Said, certainty: &Certainty) -> Said {
    said.with(CERTAINTY, certainty.z_score, "standard errors").with(TILES, certainty.tiles as f64, "tiles")
}

fn with_faces(said: Said, faces: Option<&FacesScore>) -> Said {
    match faces {
        Some(score) => {
            said.with(BY_FACES, score.z_score, "standard errors").with(FACES, score.faces as f64, "faces")
        }
        None => said,
    }
}

fn with_directions(said: Said, evidence: &DirectionEvidence) -> Said {
    let said = said.with(CONFIDENCE, Sure(evidence.confidence.into()).percent(), "%").with(
        "agreement of red and green as slopes, from -1 (DirectX) to 1 (OpenGL)",
        evidence.correlation.into(),
        "",
    );
    let said = with_relief(with_certainty(said, &evidence.certainty), &evidence.relief);
    with_faces(said, evidence.faces.as_ref())
}

fn with_relief(said: Said, ReliefEvidence { correlation, shift_score, residuals }: &ReliefEvidence) -> Said {
    said.with("the same agreement, each tile weighted by its slopes", *correlation, "")
        .with(
            "how much better a height field fits with green up than with green down",
            *shift_score,
            "deviations of shifted channels",
        )
        .with("part of the slopes that no height field explains, with green up", 100.0 * residuals[0], "%")
        .with("with green down", 100.0 * residuals[1], "%")
}

fn detail_flipped(is_relief_up: bool, evidence: &ReliefEvidence) -> Said {
    let [relief, detail] = ["green up (OpenGL)", "green down (DirectX)"];
    let [relief, detail] = if is_relief_up { [relief, detail] } else { [detail, relief] };
    let text = format!(
        "its relief is with {relief}, and its fine detail, which most of the map shows, with {detail}, as \
         where a detail map was laid over it"
    );
    with_relief(Said::new(text), evidence)
}

fn along_other_axis(reordered: &Reordered) -> Said {
    if reordered.is_z() {
        return Said::new(
            "its vectors point into the surface: blue is inverted, or the whole image is a \
             negative",
        )
        .with_cure(
            "Invert blue, or all three channels if the image is a negative: with blue alone, bumps of a \
             negative become dents.",
        );
    }
    let channel = ["red", "green", "blue"][reordered.channel];
    let axis = if reordered.is_negative { format!("inverted {channel}") } else { channel.to_owned() };
    let orders: Vec<String> = reordered.orders.iter().map(|order| letters(*order).to_uppercase()).collect();
    let text = format!(
        "its vectors point along {axis}, and those of a map in tangent space along blue: its channels are in \
         another order (x, y and z in {}), or it is in the object space of a flat surface",
        orders.join(" or ")
    );
    let command = |order: &[usize; 3]| {
        format!("`darboux convert --from opengl --to opengl --layout {} --to-layout rgb`", letters(*order))
    };
    let commands: Vec<String> = reordered.orders.iter().map(command).collect();
    let invert = if reordered.is_negative {
        format!("invert {channel} in an image editor, then ")
    } else {
        String::new()
    };
    Said::new(text).with_cure(format!(
        "If the channels were packed in another order, {invert}put them back: {}. If the baker was set to \
         object space, bake in tangent space.",
        commands.join(" or ")
    ))
}

/// The letters of the channels.
fn letters(order: [usize; 3]) -> String {
    order.map(|channel| ["r", "g", "b"][channel]).concat()
}

/// What happened to linear values.
fn transfer(mistake: Option<SrgbMistake>) -> &'static str {
    match mistake {
        Some(SrgbMistake::Decoded) => "decoded as sRGB",
        Some(_) => "encoded as sRGB",
        None => "encoded as sRGB, and red or green was inverted after that",
    }
}

fn no_normals(kind: &NoNormals) -> String {
    match kind {
        NoNormals::Background => {
            "all its texels are black, white or middle grey, which are no normals: a flat map is 128, 128, \
             255"
            .to_owned()
        }
        NoNormals::OneColour(colour) => {
            let colour = colour_text(colour);
            format!("all its texels are about {colour}, which is no normal: a flat map is 128, 128, 255")
        }
        NoNormals::MostlyImpossible => "most of its texels cannot be normals".to_owned(),
        NoNormals::Picture => {
            "most of its texels have no length near 1, and red and green are light and dark together, as in \
             a picture"
                .to_owned()
        }
        NoNormals::NoSlopes => {
            "its texels are no slopes of a surface, and most are no unit vectors".to_owned()
        }
    }
}

fn colour_text([red, green, blue]: &[f64; 3]) -> String {
    format!("{red}, {green}, {blue:.0}")
}

fn contradictory(Contradiction { side, parts: [up, down] }: &Contradiction) -> Said {
    let place = |Part { columns, rows, .. }: &Part| {
        format!("texels x {} to {}, y {} to {}", columns[0], columns[1] - 1, rows[0], rows[1] - 1)
    };
    Said::new(format!(
        "parts of it contradict each other: of blocks of {side} x {side} texels, {} with green up (OpenGL) \
         ({}), and {} with green down (DirectX) or red inverted ({})",
        counted(up.blocks, "is", "are"),
        place(up),
        counted(down.blocks, "is", "are"),
        place(down)
    ))
    .with_cure("Invert green in the part that is inverted, in an image editor, or bake the whole map again.")
    .with(
        "mean agreement of the tiles from zero, in the clearest block with green up",
        up.z_score.into(),
        "standard errors",
    )
    .with("in the clearest block with green down", down.z_score.into(), "standard errors")
}

fn green_flipped(wanted: BitangentDirection, doubt: RedDoubt, evidence: &DirectionEvidence) -> Said {
    let (program, cure) = match wanted {
        BitangentDirection::Up => {
            ("DirectX (green down) instead of OpenGL (green up)", Code::MapGreenFlipped.cure())
        }
        BitangentDirection::Down => (
            "OpenGL (green up) instead of DirectX (green down)",
            "Export or bake the map with green down (DirectX, -Y), or let `darboux check FILE --convention \
             directx --fix --assume map=opengl` invert its green.",
        ),
    };
    let doubt = match doubt {
        RedDoubt::None => "",
        RedDoubt::FacesLeanToRed => {
            ", or its red is inverted, which looks the same to this test: the faces of the model lean that \
             way"
        }
        RedDoubt::FacesUndecided => {
            ", or its red is inverted, which is much rarer, looks the same to this test, and is not decided \
             by the faces of the model"
        }
        RedDoubt::NoModel => ", or its red is inverted, which is much rarer and looks the same to this test",
    };
    let said = Said::new(format!("it is in the convention of {program}{doubt}")).with_cure(cure);
    with_directions(said, evidence)
}

fn may_be_dents(wanted: BitangentDirection, score: &FacesScore) -> Said {
    let text = "its texels lean against the faces of the mesh: it has a bump on every face, or its red and \
         green are both inverted, so that bumps are dents";
    let cure = match wanted {
        BitangentDirection::Up => Code::MapMayBeDents.cure(),
        BitangentDirection::Down => {
            "Look at one bump. If it is a dent, type `darboux check FILE --convention directx --fix --assume \
             map=red-inverted`."
        }
    };
    with_faces(Said::new(text).with_cure(cure), Some(score))
}

fn not_unit(texels: &Texels, mean_length: f32, doubt: Option<LengthDoubt>) -> Said {
    let (clause, cure) = match doubt {
        None => ("", Code::MapNotUnit.cure()),
        Some(LengthDoubt::Leaning) => (
            ", and they lean to one side on average, as after a change of brightness, contrast or colours",
            "Undo the change of brightness or colours, or export the map again as it was.",
        ),
        Some(LengthDoubt::NoSlopes) => (
            ", and nothing shows that they are slopes of a surface: it may be another kind of image",
            "Put the normal map into the slot; if this is one, normalise it in the program that made it.",
        ),
    };
    Said::new(format!("{} texels have another length than 1{clause}", Count(texels.count)))
        .with_cure(cure)
        .with("texels", texels.percent, "%")
        .with("mean length", mean_length.into(), "")
}

fn flat_off([red, green]: [u8; 2], colour: Option<&[f64; 3]>, degrees: f64, texels: &Texels) -> Said {
    let said = match colour {
        Some(colour) => Said::new(format!(
            "all its texels are about {} instead of 128, 128, 255, so that the whole surface is lit as if it \
             leaned by {degrees:.0} degrees",
            colour_text(colour)
        ))
        .with_cure("Leave the map out, or fill it with 128, 128, 255."),
        None => Said::new(format!("its flat texels are {red}, {green} instead of 128, 128")),
    };
    said.with("angle", degrees, "degrees").with("texels", texels.percent, "%")
}
