//! Runs `darboux bake`: reads the models, bakes, writes the maps, reports.

use std::path::Path;

use darboux::Context;
use darboux_bake::{
    BakeOptions, BakeProgress, Baked, HighModel, HighModelOptions, HighSurface, LowModel, LowModelOptions,
    LowSurface, MapSet, bake,
};
use darboux_io::gltf::Document;

use super::arguments::{BakeArguments, MatchChoice};
use super::cage::{Cages, Rays};
use super::matching::group_by_name;
use super::model::write_model;
use super::open::{open_high, open_low};
use super::pictures;
use super::report::{BakeReport, advice, summary};
use super::verified::{PROGRESS_UNITS, Verified};
use super::write::{all_outputs, refuse_outputs, write_maps};
use crate::json::{VERSION, print_report};
use crate::terminal::Messages;
use crate::{exit, interrupt};

/// Runs the command and returns its exit code.
pub fn run(arguments: &BakeArguments) -> u8 {
    let messages = Messages::new(arguments.messages.quiet);
    if let Err(sentence) = check_usage(arguments) {
        messages.error(&sentence);
        return exit::USAGE;
    }
    interrupt::wait_for_writes();
    let done = bake_files(arguments, &messages);
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
    print_report(&report, arguments.messages.json, &messages)
}

fn check_usage(arguments: &BakeArguments) -> Result<(), String> {
    let mut inputs = arguments.high.iter().chain([&arguments.low]).chain(&arguments.cage);
    if inputs.any(|path| path == Path::new("-")) {
        return Err("models on standard input cannot be baked; save them to files first".to_owned());
    }
    refuse_outputs(arguments)
}

/// Reads, bakes and writes. Errors are one sentence each.
fn bake_files(arguments: &BakeArguments, messages: &Messages) -> Result<BakeReport, String> {
    let sentence = |error: darboux_io::Error| error.to_string();
    let mut warnings = Vec::new();
    let low_document = open_low(arguments, &mut warnings)?;
    let mut high_documents = Vec::new();
    for path in &arguments.high {
        high_documents.push(open_high(path, arguments, &mut warnings)?);
    }
    refuse_used(arguments, high_documents.iter().chain([&low_document]))?;

    let low_corners = low_document.corners().map_err(sentence)?;
    let low = LowModel::read(&low_document, &low_corners, &low_options(arguments)).map_err(sentence)?;
    if low.primitives().next().is_none() && low.without_uvs > 0 {
        let set = arguments.uv_set.map_or("UVs".to_owned(), |set| format!("TEXCOORD_{set}"));
        let name = low_document.name();
        return Err(format!(
            "{name}: no triangles have {set}, onto which to bake; `darboux inspect` lists the UV sets"
        ));
    }
    let high_options = HighModelOptions::default().with_normal_maps(!arguments.no_high_maps);
    let high_corners: Vec<_> =
        high_documents.iter().map(Document::corners).collect::<Result<_, _>>().map_err(sentence)?;
    let highs: Vec<HighModel<'_>> = high_documents
        .iter()
        .zip(&high_corners)
        .map(|(document, corners)| HighModel::read(document, corners, &high_options))
        .collect::<Result<_, _>>()
        .map_err(sentence)?;
    if let Some(material) = arguments.material.filter(|_| low.materials.is_empty()) {
        let name = low_document.name();
        return Err(format!("{name}: no triangles have materials[{material}]; `darboux inspect` lists them"));
    }
    warnings.extend(advice::of_models(&low, low_document.name(), &highs));

    let rays = Rays::choose(arguments, low.diagonal());
    let surfaces = low.surfaces().map_err(sentence)?;
    let cages = Cages::read(arguments, &rays, &surfaces)?;
    let mut surfaces = cages.around(surfaces).map_err(|error| error.to_string())?;
    let mut high_surfaces = Vec::new();
    for high in &highs {
        high_surfaces.extend(high.surfaces().map_err(sentence)?);
    }
    if arguments.matching == MatchChoice::Name {
        warnings.extend(group_by_name((&low, &mut surfaces), (&highs, &mut high_surfaces))?);
    }
    let options = options(arguments, &rays);
    let baked = bake_surfaces(arguments, messages, &surfaces, &high_surfaces, &options)?;
    let written = write_maps(arguments, &baked.images, &options)?;
    let misses = pictures::misses(arguments, &baked, &mut warnings)?;
    let model = write_model(arguments, &low, written.normal.as_ref(), &mut warnings)?;
    let verification = match &written.normal {
        Some(normal) if arguments.verify => {
            let surfaces = (&surfaces[..], &high_surfaces[..]);
            let mut verified = Verified::new(arguments, surfaces, &baked.images, normal, &options, messages)?;
            verified.write_model(arguments, &low)?;
            Some(verified)
        }
        _ => None,
    };
    warnings.extend(advice::of_report(&baked.report, arguments, misses.as_deref()));
    Ok(BakeReport {
        command: "bake",
        version: VERSION,
        low: arguments.low.display().to_string(),
        high: arguments.high.iter().map(|path| path.display().to_string()).collect(),
        size: arguments.size,
        samples: arguments.samples.0 * arguments.samples.0,
        rays,
        maps: written.maps,
        model,
        misses,
        counts: baked.report,
        verification,
        warnings,
    })
}

fn low_options(arguments: &BakeArguments) -> LowModelOptions {
    let tangents = arguments.method.map(|method| darboux::Method::from(method).into());
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
    let kinds: Vec<_> = arguments.map.iter().map(|map| map.kind()).collect();
    BakeOptions::new(arguments.size, rays.distance())
        .with_maps(MapSet::of(&kinds))
        .with_samples_per_axis(arguments.samples.0)
        .with_back_faces(arguments.back_faces)
        .with_bitangent(arguments.bitangent.into())
        .with_map_convention(arguments.convention.convention)
        .with_padding(arguments.padding)
        .with_occlusion(arguments.ao_rays, arguments.ao_distance.unwrap_or(f32::INFINITY))
        .with_memory_limit(available_memory())
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

/// The bytes that the system can give without swapping; none where it does not say.
fn available_memory() -> Option<u64> {
    let info = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = info.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kibibytes: u64 = line.trim().strip_suffix(" kB")?.trim().parse().ok()?;
    Some(kibibytes << 10)
}
