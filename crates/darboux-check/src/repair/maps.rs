//! Rewrites the texels of normal maps at their bit depth.

use std::collections::BTreeMap;

use darboux::{
    BitangentDirection, Convention, Conversion, MapJudgement, MapVerdict, SrgbMistake, TangentDirection,
};
use darboux_io::gltf::Document;
use darboux_io::image::{
    Channels, DecodeLimits, PngImage, RgbaImage, change_texels, convert_normal_map, linear_to_srgb,
    srgb_to_linear,
};
use darboux_io::{Error, LoadOptions};

use super::options::FixOptions;
use super::outcome::{FixedFinding, outcome};
use super::pairs::leaves_inverted_red;
use crate::check::{MapDefects, ModelOfMaps, identified_defects, map_defects, map_defects_on_model};
use crate::code::Code;
use crate::defect::Defect;
use crate::defect::Obstacle;
use crate::hypotheses::is_about_channels;
use crate::inverted::{Inverted, relative};
use crate::map_users::MapUsers;
use crate::place::Place;
use crate::severity::Severity;

/// The result of [`fix_map`].
#[derive(Debug)]
#[non_exhaustive]
pub struct FixedMap {
    /// The image with its new texels; none if nothing was repaired.
    pub image: Option<PngImage>,
    /// The findings, and those that the first repairs revealed.
    pub findings: Vec<FixedFinding>,
}

/// Repairs an image file that is a normal map. A JPEG becomes a PNG. Inverted green is left, because it may
/// as well be inverted red: [`fix_map_on_model`] asks the faces of the model.
///
/// `name` stands for the file in messages. Errors: a PNG that needs more memory than `loading` permits.
pub fn fix_map(
    name: &str,
    file: &[u8],
    loading: &LoadOptions,
    options: &FixOptions,
) -> Result<FixedMap, Error> {
    let options = &with_limit_of(options, loading);
    let check = |file: &[u8]| map_defects(file, &options.check, None);
    fix_checked(name, file, check(file), &check, loading, options)
}

/// As [`fix_map`], for the normal map of a model, which is not changed. The result has no findings of the
/// model.
pub fn fix_map_on_model(
    name: &str,
    file: &[u8],
    model: &ModelOfMaps,
    loading: &LoadOptions,
    options: &FixOptions,
) -> Result<FixedMap, Error> {
    let options = &with_limit_of(options, loading);
    let check = |file: &[u8]| map_defects_on_model(file, model, &options.check);
    fix_checked(name, file, check(file), &check, loading, options)
}

fn with_limit_of(options: &FixOptions, loading: &LoadOptions) -> FixOptions {
    FixOptions { check: options.check.with_memory_limit(loading.memory_limit), ..options.clone() }
}

/// Checks an image file again after a repair, with all that was known before, so that one repair does not
/// mislead the next.
type Check<'a> = dyn Fn(&[u8]) -> MapDefects + 'a;

/// Repairs an image file whose findings are known: meshes may have helped to find them.
///
/// A repair that ends in an error that was not there is refused, and the others are tried again without it:
/// every round refuses one more code at least.
fn fix_checked(
    name: &str,
    file: &[u8],
    checked: MapDefects,
    check: &Check<'_>,
    loading: &LoadOptions,
    options: &FixOptions,
) -> Result<FixedMap, Error> {
    let known = &checked.defects;
    if leaves_inverted_red(known, options) {
        return Ok(all_left(known.clone(), &Obstacle::OnlyInvertedRedIsCertain));
    }
    let repair = ImageRepair { name, file, checked: &checked, check, loading, options };
    // Each with the error that its repair would end in.
    let mut refused: BTreeMap<Code, Code> = BTreeMap::new();
    let attempt = loop {
        let attempt = repair.attempt(&refused)?;
        let more = repair.refused_after(&attempt);
        if more.is_empty() {
            break attempt;
        }
        refused.extend(more);
    };
    let remaining = attempt.remaining(known);
    let is_left = |defect: &Defect| remaining.iter().any(|left| left.is_same(defect));
    let outcome_of = |defect: &Defect| match refused.get(&defect.code()) {
        Some(code) if options.repairs(defect) && is_left(defect) => {
            FixedFinding::left(defect.clone(), Obstacle::WouldEndIn(*code))
        }
        _ => outcome(defect.clone(), remaining.iter(), options),
    };
    let mut findings: Vec<FixedFinding> = Vec::new();
    let mut seen: Vec<&Defect> = Vec::new();
    for defect in known.iter().chain(attempt.steps.iter().flat_map(|step| &step.left)) {
        if !seen.iter().any(|known| known.is_same(defect)) {
            seen.push(defect);
            findings.push(outcome_of(defect));
        }
    }
    let is_any_repaired = findings.iter().any(|finding| finding.repaired);
    Ok(FixedMap { image: attempt.image.filter(|_| is_any_repaired), findings })
}

/// A repair of one code, and the defects after it.
struct Step {
    code: Code,
    left: Vec<Defect>,
}

/// The repairs of an image, one after the other.
struct Attempt {
    image: Option<PngImage>,
    steps: Vec<Step>,
}

impl Attempt {
    /// The defects at the end.
    fn remaining<'a>(&'a self, known: &'a [Defect]) -> &'a [Defect] {
        self.steps.last().map_or(known, |step| &step.left)
    }

    fn repaired(&self, code: Code) -> bool {
        self.steps.iter().any(|step| step.code == code)
    }

    /// The repair since which a defect is there.
    fn cause(&self, defect: &Defect) -> Option<Code> {
        let has = |step: &&Step| step.left.iter().any(|left| left.is_same(defect));
        self.steps.iter().rev().take_while(has).last().map(|step| step.code)
    }
}

/// An image to repair, with what is known about it.
struct ImageRepair<'a> {
    name: &'a str,
    file: &'a [u8],
    checked: &'a MapDefects,
    check: &'a Check<'a>,
    loading: &'a LoadOptions,
    options: &'a FixOptions,
}

impl ImageRepair<'_> {
    /// Repairs one code after the other until none is left that can be repaired and is not refused.
    fn attempt(&self, refused: &BTreeMap<Code, Code>) -> Result<Attempt, Error> {
        let mut attempt = Attempt { image: None, steps: Vec::new() };
        let mut mistake = self.checked.srgb_mistake;
        loop {
            let is_next = |defect: &&Defect| {
                let code = defect.code();
                self.options.repairs(defect) && !attempt.repaired(code) && !refused.contains_key(&code)
            };
            let remaining = attempt.remaining(&self.checked.defects);
            let Some(next) = remaining.iter().find(is_next).map(Defect::code) else { return Ok(attempt) };
            let mut changed = match attempt.image.take() {
                Some(image) => image,
                None => open(self.name, self.file, self.loading)?,
            };
            repair(&mut changed, next, mistake, self.options)?;
            let mut checked = (self.check)(&changed.to_bytes()?);
            if self.is_both_assumed() {
                // With both inverted back the texels show what they showed before, and the assumption would
                // be said of them again.
                checked.defects.retain(|left| {
                    !is_about_channels(left) || left.code() != next && !attempt.repaired(left.code())
                });
            }
            keep_reasons(&self.checked.defects, &mut checked.defects);
            mistake = checked.srgb_mistake;
            attempt.image = Some(changed);
            attempt.steps.push(Step { code: next, left: checked.defects });
        }
    }

    /// The repairs that may not be carried out, each with the error that it would end in.
    fn refused_after(&self, attempt: &Attempt) -> BTreeMap<Code, Code> {
        let known = &self.checked.defects;
        let remaining = attempt.remaining(known);
        // No repair of other texels inverts a channel, but it may reveal that one is inverted.
        let has_directions =
            |judgement: &MapJudgement| matches!(judgement.verdict, MapVerdict::OpenGl | MapVerdict::DirectX);
        let were_hidden = !self.checked.judgement.as_ref().is_some_and(has_directions);
        let is_worse = |left: &&Defect| {
            is_new_error(left, known) && !(were_hidden && left.code() == Code::MapGreenFlipped)
        };
        let mut refused: BTreeMap<Code, Code> = BTreeMap::new();
        for worse in remaining.iter().filter(is_worse) {
            refused.extend(attempt.cause(worse).map(|cause| (cause, worse.code())));
        }
        // One of two channels inverted back would turn all bumps into dents.
        let inverted = [Code::MapRedFlipped, Code::MapGreenFlipped];
        let is_left = |code: &&Code| remaining.iter().any(|left| left.code() == **code);
        let half = inverted.iter().filter(is_left).find(|code| !attempt.repaired(**code));
        if self.is_both_assumed() && inverted.iter().any(|code| attempt.repaired(*code)) {
            refused.extend(half.into_iter().flat_map(|half| inverted.map(|code| (code, *half))));
        }
        refused
    }

    /// Whether the user says that both channels are inverted.
    fn is_both_assumed(&self) -> bool {
        let check = &self.options.check;
        check.assumed_map.map(|assumed| relative(assumed, check.green)) == Some(Inverted::Both)
    }
}

/// What was known to be left is left for the same reason after other repairs: other images and surfaces may
/// be that.
fn keep_reasons(known: &[Defect], defects: &mut [Defect]) {
    for defect in defects {
        let Some(before) = known.iter().find(|known| known.is_same(defect)) else { continue };
        // What identifies inverted channels was all known before.
        let own = defect.obstacle.take().filter(|_| !is_about_channels(defect));
        defect.obstacle = own.or_else(|| before.obstacle.clone());
        defect.cancelled.clone_from(&before.cancelled);
    }
}

/// An image that is not changed, and why.
fn all_left(defects: Vec<Defect>, reason: &Obstacle) -> FixedMap {
    let left = |defect: Defect| FixedFinding::left(defect, reason.clone());
    FixedMap { image: None, findings: defects.into_iter().map(left).collect() }
}

/// Whether a repair has made an image worse: an error that it did not have before.
fn is_new_error(left: &Defect, known: &[Defect]) -> bool {
    left.severity == Severity::Error && !known.iter().any(|known| known.is_same(left))
}

/// The texels of a file. A JPEG and a TGA have 8 bits.
fn open(name: &str, file: &[u8], loading: &LoadOptions) -> Result<PngImage, Error> {
    if PngImage::is_png(file) {
        return PngImage::from_bytes(name, file.to_vec(), loading);
    }
    let undecodable = |problem: String| Error::Invalid { file: name.to_owned(), at: String::new(), problem };
    let decoded = RgbaImage::decode(file, &DecodeLimits::of_file(file.len(), loading.memory_limit));
    let RgbaImage { width, height, texels } = decoded.map_err(|error| undecodable(error.to_string()))?;
    let texels: Vec<[u8; 3]> = texels.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect();
    PngImage::from_rgb(name, [width, height], &texels)
}

/// Repairs one finding.
fn repair(
    image: &mut PngImage,
    code: Code,
    mistake: Option<SrgbMistake>,
    options: &FixOptions,
) -> Result<(), Error> {
    let keep = Convention::GLTF.to(Convention::GLTF);
    let two_channels: Channels = "rg".parse().expect("two letters");
    let exchanged: Channels = "grb".parse().expect("three letters");
    match code {
        Code::MapGreenFlipped => {
            convert_normal_map(image, &green(options.check.green), Channels::RGB, Channels::RGB)
        }
        Code::MapRedFlipped => {
            let left = Convention { tangent: TangentDirection::Left, ..Convention::GLTF };
            convert_normal_map(image, &left.to(Convention::GLTF), Channels::RGB, Channels::RGB)
        }
        Code::MapChannelsSwapped => convert_normal_map(image, &keep, exchanged, Channels::RGB),
        Code::MapTwoChannel => convert_normal_map(image, &keep, two_channels, Channels::RGB),
        Code::MapSrgb => match mistake {
            Some(SrgbMistake::Encoded) => change_texels(image, |texel| texel.map(srgb_to_linear)),
            Some(SrgbMistake::Decoded) => change_texels(image, |texel| texel.map(linear_to_srgb)),
            _ => Ok(()),
        },
        Code::MapNotUnit => change_texels(image, unit),
        _ => Ok(()),
    }
}

/// The conversion that makes green point the wanted way.
fn green(wanted: BitangentDirection) -> Conversion {
    let up = Convention::GLTF;
    let down = Convention { bitangent: BitangentDirection::Down, ..up };
    match wanted {
        BitangentDirection::Up => down.to(up),
        BitangentDirection::Down => up.to(down),
    }
}

/// A texel with a vector of length 1. Background keeps its values: black, white and middle grey, and black of
/// maps with two channels, which has x = y = -1 and a computed z of 0.
fn unit(texel: [f64; 3]) -> [f64; 3] {
    let vector = texel.map(|x| 2.0 * x - 1.0);
    let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    let is_grey = texel.iter().all(|x| (x - texel[0]).abs() < 1.0 / 512.0);
    let [x, y, z] = vector;
    let is_without_z = x * x + y * y > 1.3 && z.abs() < 0.1;
    if is_grey || is_without_z || length < 0.05 { texel } else { vector.map(|x| (x / length + 1.0) / 2.0) }
}

/// Repairs the images of a document that defects name.
pub fn fix_images(
    document: &mut Document,
    defects: Vec<Defect>,
    options: &FixOptions,
) -> Result<Vec<FixedFinding>, Error> {
    let options = &FixOptions { check: options.check.in_document(document), ..options.clone() };
    // An image is named with one material.
    let mut places: BTreeMap<(Option<usize>, Option<usize>), Vec<&Defect>> = BTreeMap::new();
    for defect in &defects {
        places.entry((defect.place.image, defect.place.material)).or_default().push(defect);
    }
    let kept = |defects: &[&Defect]| -> Vec<FixedFinding> {
        defects.iter().map(|&defect| outcome(defect.clone(), defects.iter().copied(), options)).collect()
    };
    let (mut fixed, mut rewritten) = (Vec::new(), Vec::new());
    if !defects.iter().any(|defect| options.repairs(defect)) {
        return Ok(places.values().flat_map(|of_image| kept(of_image)).collect());
    }
    let users = MapUsers::new(document, &document.materials()?)?;
    for ((image, material), of_image) in &places {
        let has_work = of_image.iter().any(|defect| options.repairs(defect));
        let (&Some(index), true) = (image, has_work) else {
            fixed.extend(kept(of_image));
            continue;
        };
        let file = document.image_bytes(index)?.into_owned();
        let name = format!("{}: images[{index}]", document.name());
        let place = Place { image: *image, material: *material, ..Place::default() };
        let without_place = |defect: &&Defect| Defect { place: Place::default(), ..(*defect).clone() };
        let known = of_image.iter().map(without_place).collect();
        let checked = MapDefects { defects: known, ..map_defects(&file, &options.check, None) };
        let surfaces = users.of(index)?;
        let check = |file: &[u8]| identified_defects(file, &surfaces, &options.check);
        let made = match fix_checked(&name, &file, checked, &check, document.load_options(), options) {
            Ok(made) => made,
            Err(error) => {
                let reason = Obstacle::Failed(error.to_string());
                fixed.extend(
                    of_image.iter().map(|&defect| FixedFinding::left(defect.clone(), reason.clone())),
                );
                continue;
            }
        };
        if let Some(image) = made.image {
            rewritten.push((index, image.to_bytes()?));
        }
        fixed.extend(made.findings.into_iter().map(|fixed| fixed.at(place.clone())));
    }
    for (index, bytes) in rewritten {
        document.set_image(index, bytes, "image/png")?;
    }
    Ok(fixed)
}
