//! The words of obstacles, as clauses.

use darboux::{BitangentDirection, Choice};

use super::counts::Sure;
use crate::code::Code;
use crate::defect::{Assumption, Obstacle, Pair};
use crate::inverted::{Inverted, assumption};
use crate::measure::reversal::Undecided;

/// Why a repair leaves a defect.
pub fn reason(obstacle: &Obstacle) -> String {
    let clause = match obstacle {
        Obstacle::NoTangents(reason) => return format!("tangents cannot be computed: {reason}"),
        Obstacle::Unsure(probability) => return format!("this is only {} sure", Sure(*probability)),
        Obstacle::NotIdentified { probability, wanted } => {
            let [green, red, _] = assumptions(*wanted);
            let sure = Sure(*probability);
            return format!(
                "which channel is inverted is only {sure} sure, because inverted red and inverted green look alike and no \
                 faces of the model tell them apart, so that inverting the wrong one would make it worse; \
                 look at one bump with a light beside it: if that is right, green is inverted, and `--assume \
                 map={green}` says so (`--assume map={red}`: red is)"
            );
        }
        Obstacle::FacesLeanToRed(wanted) => {
            let [green, red, _] = assumptions(*wanted);
            return format!(
                "the faces of the model lean towards inverted red without deciding it; look at one bump with \
                 a light beside it and one above it, and say which channel is inverted with `--assume \
                 map={red}` or `--assume map={green}`"
            );
        }
        Obstacle::OnlyTheModelTells(wanted) => {
            let [green, red, _] = assumptions(*wanted);
            return format!(
                "only the faces of the model tell inverted green from inverted red; name the model with \
                 --model, or say which it is with `--assume map={green}` or `--assume map={red}`"
            );
        }
        Obstacle::ExchangedAndInverted(wanted) => {
            let [green, red, _] = assumptions(*wanted);
            return format!(
                "one channel is inverted, too, and no faces of a model show which: `--assume map={green}` \
                 says that green is, once red and green are exchanged back, and `--assume map={red}` that \
                 red is"
            );
        }
        Obstacle::RedLikelier { image } => {
            return format!("red may be inverted instead of green, as in images[{image}]");
        }
        Obstacle::MapMayCancel { assumption: Assumption::GreenInverted, image, .. } => {
            return format!(
                "the green of {} is inverted, as was assumed, which its texels do not show: it cancels the \
                 flipped signs, and neither is repaired",
                map_in(*image)
            );
        }
        Obstacle::MapMayCancel { assumption: Assumption::OtherInverted, image, .. } => {
            return format!(
                "channels of {} are inverted, as was assumed, which its texels do not show, so that neither \
                 they nor the signs are repaired",
                map_in(*image)
            );
        }
        Obstacle::MapMayCancel { image, is_from_sketchfab, right, assumption, wanted } => {
            let [_, _, is_right] = assumptions(*wanted);
            let map = map_in(*image);
            let known = right.map_or_else(
                || format!("the convention of {map} is not known"),
                |right| format!("it is only {} sure that {map} is right", Sure(right)),
            );
            let prior = if *is_from_sketchfab {
                ", as in 20 of 24 maps of other models from Sketchfab, where this one is from"
            } else {
                ""
            };
            let refused = match assumption {
                Assumption::Contradicted => {
                    "; what was assumed is not applied, because the texels show otherwise"
                }
                _ => "",
            };
            return format!(
                "{known}, and inverted green there would cancel the flipped signs{prior}: look at a bump with \
                 a light above it, and if it looks inverted, the map is right, and `--assume map={is_right}` \
                 has the signs repaired{refused}"
            );
        }
        Obstacle::MapHasOtherLayout { image } => {
            return format!(
                "{} was made for another UV layout, and these tangents may fit that one: put the UVs back \
                 first, and check again",
                map_in(*image)
            );
        }
        Obstacle::UvsWereRounded { steps } => {
            return format!(
                "the UVs were rounded to {steps} steps, perhaps after these tangents were computed, and new \
                 ones would follow the rounding; `darboux tangents --overwrite` computes them all the same"
            );
        }
        Obstacle::NotRewritable(clause) => return format!("the image {clause}"),
        Obstacle::PairIsLeft(pair) => {
            let [of_map, of_surface] = names(pair);
            return format!(
                "{of_surface} and {of_map} cancel here, and one of them is left; repair both or none"
            );
        }
        Obstacle::WouldEndIn(code) => return format!("its repair would end in {code}"),
        Obstacle::Failed(sentence) => return sentence.clone(),
        Obstacle::NoRepair(code) => code.left_because().unwrap_or("nothing repairs it"),
        Obstacle::UndecidedReversal(reason) => undecided(*reason),
        Obstacle::UndecidedOrder { is_z: true } => {
            "nothing says whether only blue is inverted or the whole image"
        }
        Obstacle::UndecidedOrder { is_z: false } => {
            "nothing says for certain whether its channels are in another order or it is in object space"
        }
        Obstacle::FlatShadingMayBeWanted => "flat shading may be wanted; `darboux normals` makes smooth ones",
        Obstacle::MorphTargetsMoveNormals => "morph targets move these normals",
        Obstacle::SignsAreLeft => {
            "flipped signs w of a part of these tangents are left, because the map may cancel them, and this \
             repair would repair them, too: say first what the map is, with `--assume`"
        }
        Obstacle::SignsAreNotChosen => {
            "flipped signs w of a part of these tangents are not among the findings to repair, and computing \
             the tangents again would repair them, too: name their code as well"
        }
        Obstacle::NormalsInOtherAxes => {
            "the normals of the primitive are in other axes, which has to be repaired first"
        }
        Obstacle::TangentsMayBeTurned => "what turned these normals may have turned the tangents, too",
        Obstacle::AxesUnclear => {
            "they fit the faces in several ways nearly as well, or in none of them closely"
        }
        Obstacle::FacesMayBeReversed => {
            "the faces enclose a negative volume, so that they may be reversed, too"
        }
        Obstacle::DifferenceIsInvisible => "the difference cannot be seen",
        Obstacle::BakedOnQuads => {
            "the map was probably baked on the quads, with these tangents; if it was not, `--only \
             tangent-other-recipe` computes them again"
        }
        Obstacle::MapMayFitTangents => {
            "these tangents are right if the map was baked with them; if it was not, `--only \
             tangent-other-recipe` computes them again"
        }
        Obstacle::EncodedAndInverted => {
            "invert the channel near 67 of the map again first: `darboux convert --from directx --to opengl` \
             inverts green"
        }
        Obstacle::XInAlpha => {
            "alpha may be wanted for something else; if it is x, `darboux convert --from opengl --to opengl \
             --layout ag --to-layout rgb` computes blue"
        }
        Obstacle::UnclearChannels => {
            "its red and green are too few or too even to tell the slopes of a surface from other data"
        }
        Obstacle::DetailIsOpposed => {
            "its fine detail is in the other convention, and would be inverted with the rest"
        }
        Obstacle::OnlyAPartOfMap => "nothing says where one part ends and the other one begins",
        Obstacle::MayBeDents(BitangentDirection::Up) => {
            Code::MapMayBeDents.left_because().unwrap_or_default()
        }
        Obstacle::MayBeDents(BitangentDirection::Down) => {
            "a map with bumps on the faces looks the same to every test; `--assume map=red-inverted` says \
             that both channels are inverted (red points to the left, and green up), `--assume map=directx` \
             that the map is right"
        }
        Obstacle::VectorsLean => {
            "scaled to length 1, the vectors would still lean; undo the change of the colours, or export the \
             map again"
        }
        Obstacle::MayBeNoMap => {
            "scaled to length 1, the texels of another kind of image would still be no normals; if this is a \
             normal map, normalise it in the program that made it"
        }
        Obstacle::NegativeScale => {
            "the scale of its material is negative, which inverts red and green: make it positive first, and \
             check again"
        }
        Obstacle::TransformTurns => {
            "the texture transform of its material mirrors or turns the image, so that what is inverted \
             before the transform is right after it, and renderers disagree on which of both counts: apply \
             the transform to the UVs first, and check again"
        }
        Obstacle::OnTheModelToo => {
            "the tangents of the model have to be repaired with it; put the map on the model and repair that"
        }
        Obstacle::OtherImageFormat => {
            "of images only PNG, JPEG and TGA are repaired, and become PNG; save this one as a PNG first, or \
             export the model with PNG images"
        }
        Obstacle::InTheModel => "it is in the model, and the repair of an image changes no model",
        Obstacle::NotChosen => "its code is not among those to repair",
        Obstacle::OtherMethodWanted => "another method than MikkTSpace was asked for",
        Obstacle::RecipeIsKept => {
            "the rest needs all tangents computed again, and those of this recipe are kept"
        }
        Obstacle::NotRemoved => "the repair did not remove it",
        Obstacle::OnlyInvertedRedIsCertain => {
            "its red is inverted, and only that is certain while it is left"
        }
    };
    clause.to_owned()
}

/// The normal map in an image; none for one without a document.
fn map_in(image: Option<usize>) -> String {
    image.map_or_else(|| "the normal map".to_owned(), |image| format!("the normal map in images[{image}]"))
}

fn undecided(reason: Undecided) -> &'static str {
    match reason {
        Undecided::OnlyAPart => {
            "only a part of the surface is reversed, and nothing says whether its faces or its normals are"
        }
        Undecided::NoTangents => {
            "it is open and has no tangents, so that nothing says whether its faces or its normals are \
             reversed"
        }
        Undecided::TangentsFollowNormals => {
            "it is open, so that nothing says whether its faces are reversed or both its normals and the \
             signs w"
        }
        Undecided::ContradictoryTangents => {
            "it is open and its tangents contradict each other, so that nothing says whether its faces or \
             its normals are reversed"
        }
    }
}

/// What `--assume` calls a map with inverted green, one with inverted red and one that is right, where green
/// should point in a direction.
fn assumptions(wanted: BitangentDirection) -> [&'static str; 3] {
    [Inverted::Green, Inverted::Red, Inverted::None].map(|inverted| assumption(inverted, wanted).name())
}

/// What cancels, of the map and of the tangents.
pub fn names(pair: &Pair) -> [&'static str; 2] {
    let [on_red, on_green] =
        [Code::MapRedFlipped, Code::MapGreenFlipped].map(|code| pair.on_map.contains(&code));
    match (on_red, on_green) {
        (true, true) => ["inverted red and green", "negated tangents"],
        (true, false) => ["inverted red", "negated tangents and signs w"],
        _ => ["inverted green", "flipped signs w"],
    }
}
