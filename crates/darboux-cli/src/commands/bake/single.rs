//! Bakes one low model: reads the models, bakes, writes the maps, reports.

use std::collections::HashSet;
use std::path::Path;

use darboux::Context;
use darboux_bake::{
    BakeOptions, BakeProgress, Baked, HighModel, HighModelOptions, HighSurface, LowModel, LowModelOptions,
    LowSurface, bake, check_verification, group_by_name,
};
use darboux_io::Outputs;
use darboux_io::gltf::{Document, PrimitiveCorners};

use super::arguments::{BakeArguments, MatchChoice};
use super::cage::{Cages, Rays};
use super::legend::stage_legends;
use super::model::{refuse_model, stage_model};
use super::open::open_low;
use super::outputs::{all_outputs, refuse_outputs};
use super::pictures;
use super::report::{BakeReport, advice, summary};
use super::verified::{PROGRESS_UNITS, Verified};
use super::write::{commit, stage_maps};
use crate::documents::load_with_warnings;
use crate::json::{VERSION, print_report};
use crate::memory;
use crate::terminal::Messages;
use crate::{exit, interrupt};

/// Bakes one low model and returns the exit code.
pub fn run(arguments: &BakeArguments, messages: &Messages) -> u8 {
    if let Err(sentence) = check_usage(arguments) {
        messages.error(&sentence);
        return exit::USAGE;
    }
    interrupt::wait_for_writes();
    let done = bake_files(arguments, messages);
    messages.end_progress();
    let report = match done {
        Ok(report) => report,
        Err(sentence) => {
            messages.error(&sentence);
            return exit::FAILED;
        }
    };
    report.warnings.iter().for_each(|warning| messages.warn(warning));
    summary(&report).iter().for_each(|line| messages.say(line));
    print_report(&report, arguments.messages.json, messages)
}

/// Refuses arguments that cannot be right, before files are read. The error is one sentence.
pub fn check_usage(arguments: &BakeArguments) -> Result<(), String> {
    if arguments.high.is_empty() {
        return Err("there is no high model; name it with --high".to_owned());
    }
    if arguments.output.as_os_str().is_empty() {
        return Err("there is no output; name the map with -o".to_owned());
    }
    let mut inputs = arguments.high.iter().chain([&arguments.low]).chain(&arguments.cage);
    if inputs.any(|path| path == Path::new("-")) {
        return Err("models on standard input cannot be baked; save them to files first".to_owned());
    }
    refuse_outputs(arguments)
}

/// Reads, bakes and writes. Errors are one sentence each.
pub fn bake_files(arguments: &BakeArguments, messages: &Messages) -> Result<BakeReport, String> {
    let mut warnings = Vec::new();
    let documents = Documents::open(arguments, &mut warnings)?;
    let corners = documents.corners()?;
    let models = Models::read(arguments, &documents, &corners)?;
    warnings.extend(advice::of_models(&models.low, documents.low.name(), &models.highs));

    let rays = Rays::choose(arguments, &models.low);
    let surfaces = models.low.surfaces().map_err(sentence)?;
    let cages = Cages::read(arguments, &rays, &surfaces)?;
    let mut surfaces = cages.around(surfaces).map_err(|error| error.to_string())?;
    let high_surfaces = models.high_surfaces(arguments, &mut surfaces, &mut warnings)?;

    let options = options(arguments, &rays);
    refuse_model(arguments, &models.low)?;
    if arguments.verify {
        let check = check_verification(&surfaces, &high_surfaces, &options);
        check.map_err(|error| format!("--verify cannot follow the bake: {error}"))?;
    }
    let baked = bake_surfaces(arguments, messages, &surfaces, &high_surfaces, &options)?;
    if let Some(reason) = advice::failure(&baked.report, arguments, models.low.elongation()) {
        return Err(reason);
    }
    let mut outputs = Outputs::new(None);
    let written = stage_maps(arguments, &baked.images, &options, &mut outputs)?;
    let misses = pictures::misses(arguments, &baked, &mut warnings, &mut outputs)?;
    let legends = stage_legends(arguments, &baked.legends, &models.highs, &mut outputs)?;
    let model = stage_model(arguments, &models.low, &baked.images, &written, &mut warnings, &mut outputs)?;
    let verification = match &written.normal {
        Some(normal) if arguments.verify => {
            let surfaces = (&surfaces[..], &high_surfaces[..]);
            let images = &baked.images;
            let mut verified =
                Verified::new(arguments, surfaces, images, normal, &options, messages, &mut outputs)?;
            verified.stage_model(arguments, &models.low, &mut outputs)?;
            Some(verified)
        }
        _ => None,
    };
    commit(outputs)?;
    warnings.extend(advice::of_report(&baked.report, arguments, models.low.elongation(), misses.as_deref()));
    Ok(BakeReport {
        command: "bake",
        version: VERSION,
        low: arguments.low.display().to_string(),
        high: arguments.high.iter().map(|path| path.display().to_string()).collect(),
        size: arguments.size,
        samples: arguments.samples.0 * arguments.samples.0,
        rays,
        maps: written.maps,
        legends,
        model,
        misses,
        counts: baked.report,
        verification,
        warnings: distinct(warnings),
    })
}

/// Sentences in their order, each once: a model may be LOW and HIGH.
fn distinct(sentences: Vec<String>) -> Vec<String> {
    let mut seen = HashSet::new();
    sentences.into_iter().filter(|sentence| seen.insert(sentence.clone())).collect()
}

/// The opened files of the low model and of the high ones.
struct Documents {
    low: Document,
    highs: Vec<Document>,
}

/// The corners of all documents, in their order.
struct Corners<'a> {
    low: Vec<PrimitiveCorners<'a>>,
    highs: Vec<Vec<PrimitiveCorners<'a>>>,
}

impl Documents {
    /// Opens all files. Errors: a file that cannot be read; an output that the models use.
    fn open(arguments: &BakeArguments, warnings: &mut Vec<String>) -> Result<Self, String> {
        let low = open_low(arguments, warnings)?;
        let mut highs = Vec::new();
        for path in &arguments.high {
            highs.push(load_with_warnings(path, &arguments.reading, warnings)?);
        }
        refuse_used(arguments, highs.iter().chain([&low]))?;
        Ok(Self { low, highs })
    }

    fn corners(&self) -> Result<Corners<'_>, String> {
        let highs = self.highs.iter().map(Document::corners).collect::<Result<_, _>>();
        Ok(Corners { low: self.low.corners().map_err(sentence)?, highs: highs.map_err(sentence)? })
    }
}

/// The low model and the high ones.
struct Models<'a> {
    low: LowModel<'a>,
    highs: Vec<HighModel<'a>>,
}

impl<'a> Models<'a> {
    fn read(
        arguments: &BakeArguments,
        documents: &'a Documents,
        corners: &'a Corners<'a>,
    ) -> Result<Self, String> {
        let low = LowModel::read(&documents.low, &corners.low, &low_options(arguments)).map_err(sentence)?;
        let high_options = HighModelOptions::default()
            .with_normal_maps(!arguments.no_high_maps)
            .with_maps(arguments.baked_maps())
            .with_texture(arguments.content.texture.clone());
        let highs = HighModel::read_all(&documents.highs, &corners.highs, &high_options);
        Ok(Self { low, highs: highs.map_err(sentence)? })
    }

    /// The surfaces of the high models, in groups where names decide. Errors: no names match.
    fn high_surfaces(
        &self,
        arguments: &BakeArguments,
        low: &mut [LowSurface<'_>],
        warnings: &mut Vec<String>,
    ) -> Result<Vec<HighSurface<'_>>, String> {
        let mut surfaces = HighModel::surfaces_of_all(&self.highs).map_err(sentence)?;
        if arguments.matching == MatchChoice::Name {
            let unpaired = group_by_name((&self.low, low), (&self.highs, &mut surfaces)).warnings();
            if surfaces.is_empty() {
                return Err(unpaired.join("; "));
            }
            warnings.extend(unpaired);
        }
        Ok(surfaces)
    }
}

fn sentence(error: darboux_io::Error) -> String {
    error.to_string()
}

fn low_options(arguments: &BakeArguments) -> LowModelOptions {
    let tangents = arguments.method.map(Into::into);
    LowModelOptions::default()
        .with_uv_set(arguments.uv_set)
        .with_tangents(tangents)
        .with_material(arguments.material)
}

/// Refuses to write a map over a file that the models use.
fn refuse_used<'a>(
    arguments: &BakeArguments,
    documents: impl Iterator<Item = &'a Document>,
) -> Result<(), String> {
    let outputs = all_outputs(arguments);
    for document in documents {
        if let Some(output) = outputs.iter().find(|path| document.uses_file(path)) {
            return Err(format!("{}: is used by {}; choose another name", output.display(), document.name()));
        }
    }
    Ok(())
}

fn options(arguments: &BakeArguments, rays: &Rays) -> BakeOptions {
    let content = &arguments.content;
    let world_direction = content.world_direction.0;
    BakeOptions::new(arguments.size, rays.distance())
        .with_maps(arguments.baked_maps())
        .with_samples_per_axis(arguments.samples.0)
        .with_back_faces(arguments.back_faces)
        .with_bitangent(arguments.bitangent.into())
        .with_map_convention(arguments.convention.convention)
        .with_padding(arguments.padding)
        .with_occlusion(content.ao_rays, content.ao_distance.unwrap_or(f32::INFINITY))
        .with_occlusion_falloff(content.ao_falloff)
        .with_occlusion_weights(content.ao_weights)
        .with_own_part_only(content.ao_own_part)
        .with_thickness_distance(content.thickness_distance.unwrap_or(f32::INFINITY))
        .with_curvature_radius(content.curvature_radius)
        .with_id_source(content.id_from)
        .with_world_direction(world_direction)
        .with_memory_limit(memory::available())
}

fn bake_surfaces(
    arguments: &BakeArguments,
    messages: &Messages,
    low: &[LowSurface<'_>],
    high: &[HighSurface<'_>],
    options: &BakeOptions,
) -> Result<Baked, String> {
    let mut context = Context::new();
    if let Some(jobs) = arguments.jobs {
        context.set_max_threads(usize::from(jobs.get()));
    }
    messages.start(PROGRESS_UNITS * (1 + u64::from(arguments.verify)));
    let progress = messages.file(&arguments.output.display().to_string(), PROGRESS_UNITS);
    let mut tell = move |BakeProgress { done, total }: BakeProgress| progress.set(done, total);
    bake(low, high, options, &mut context, &mut tell).map_err(|error| error.to_string())
}
