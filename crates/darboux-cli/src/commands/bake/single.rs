//! Bakes one low model: reads the models, bakes, writes the maps, reports.

use std::collections::HashSet;
use std::path::Path;

use darboux::Context;
use darboux_bake::{
    BakeOptions, BakeProgress, Baked, MapKind, ModelSurfaces, Models, PreparedSurfaces, check_verification,
};
use darboux_io::gltf::{Document, PrimitiveCorners};
use darboux_io::{Outputs, RunId};

use super::arguments::BakeArguments;
use super::cage::{CagePositions, Rays};
use super::cage_file::stage_cage;
use super::conflicts::{InputFile, all_inputs, files_of, outputs_of, refuse_twice};
use super::encode::{Encoding, Ranges};
use super::failure::BakeFailure;
use super::legend::stage_legends;
use super::map_choice::choices_for;
use super::model::{refuse_model, stage_model, warn_of_materials};
use super::open::open_low;
use super::outputs::refuse_outputs;
use super::page::PageContent;
use super::pictures;
use super::ranges;
use super::report::{BakeReport, TileReport, advice, summary};
use super::seconds::{Clock, Seconds};
use super::skew::Skew;
use super::tiles::{Tile, tiles_of};
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
    messages.start(progress_units(arguments));
    let done = bake_files(arguments, None, None, messages);
    messages.end_progress();
    let report = match done {
        Ok(report) => report,
        Err(failure) => {
            messages.error(&String::from(failure));
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
        return Err("there is no output; name the map with --output (-o), or a model with its maps with \
                    --write-model"
            .to_owned());
    }
    let mut inputs = arguments.high.iter().chain([&arguments.low]).chain(&arguments.cage);
    if inputs.any(|path| path == Path::new("-")) {
        return Err("models on standard input cannot be baked; save them to files first".to_owned());
    }
    refuse_outputs(arguments)?;
    refuse_twice(&outputs_of(arguments, 0), &all_inputs(arguments))
}

/// Reads, bakes and writes.
///
/// `run`: the run of a job that the files belong to; `share`: the bytes that the bake may use beside the
/// models, if it works beside others.
pub fn bake_files(
    arguments: &BakeArguments,
    run: Option<RunId>,
    share: Option<u64>,
    messages: &Messages,
) -> Result<BakeReport, BakeFailure> {
    let (mut clock, mut warnings) = (Clock::start(), Vec::new());
    options(arguments, [0.0; 2], memory::available(share)).check_memory()?;
    let documents = Documents::open(arguments, &mut warnings)?;
    let (map, fewer) = choices_for(&arguments.map, &documents.highs, arguments.write_model.is_some());
    let arguments = &BakeArguments { map, ..arguments.clone() };
    warnings.extend(fewer);
    let corners = documents.corners()?;
    let models = read_models(arguments, &documents, &corners)?;
    let skew = Skew::read(arguments.skew.as_ref(), &arguments.reading)?;
    warnings.extend(models.warnings());
    warnings.extend(warn_of_materials(arguments, &documents.low, &models.low));
    refuse_model(arguments, &documents.low, &models.low)?;
    // What the models take is no longer free.
    let memory_limit = memory::available(share);

    let mut rays = Rays::choose(arguments, &models.low);
    let surfaces = models.surfaces(arguments.part_match).map_err(|error| error.to_string())?;
    let ModelSurfaces { low: surfaces, highs: high_surfaces, warnings: of_names } = surfaces;
    warnings.extend(of_names);
    let tiles = tiles_of(arguments, &surfaces, &documents.inputs, memory_limit)?;
    if arguments.verify {
        let check =
            check_verification(&surfaces, &high_surfaces, &options(arguments, rays.distance(), memory_limit));
        check.map_err(|error| BakeFailure::from(error).after("--verify cannot follow the bake"))?;
    }
    let mut seconds = Seconds { reading: clock.lap(), ..Seconds::default() };
    let mut context = context(arguments);
    let prepared = PreparedSurfaces::new(&surfaces, &high_surfaces, memory_limit, &context)?;
    let cage = documents.cage.as_ref();
    let cages =
        CagePositions::read(arguments, cage, &mut rays, &models.low, &surfaces, &prepared, &mut context)?;
    warnings.extend(cage.and_then(|file| cages.warning(file, &surfaces, models.low.diagonal())));
    let mut surfaces = cages.around(surfaces)?;
    if let Some(skew) = &skew {
        surfaces = skew.on(surfaces)?;
    }
    warnings.extend(advice::of_rays(arguments, &surfaces, models.low.names(), rays.distance()[0]));
    let surfaces = prepared.with_low(&surfaces, &context)?;

    seconds.building = clock.lap();

    let outputs = Outputs::new(run);
    let page = PageContent::default();
    let options = options(arguments, rays.distance(), memory_limit);
    let mut ranges = Ranges::default();
    if options.maps.has(MapKind::Position) {
        ranges.widen(MapKind::Position, ranges::of_positions(&high_surfaces, &options));
    }
    let mut bake = Run {
        models: &models,
        surfaces: &surfaces,
        ranges,
        context,
        messages,
        warnings,
        clock,
        page,
        outputs,
    };
    let cage = stage_cage(arguments, surfaces.low(), models.low.names(), &cages.0, &mut bake.outputs)?;
    let mut report = BakeReport {
        command: "bake",
        version: VERSION,
        low: arguments.low.display().to_string(),
        high: arguments.high.iter().map(|path| path.display().to_string()).collect(),
        size: arguments.size,
        samples: arguments.samples.0 * arguments.samples.0,
        rays,
        maps: Vec::new(),
        legends: Vec::new(),
        model: None,
        misses: None,
        cage,
        counts: darboux_bake::BakeReport::default(),
        verification: None,
        seconds,
        report: None,
        tiles: Vec::new(),
        warnings: Vec::new(),
    };
    if tiles.len() > 1 {
        let maps = ranges::maps_of_all_tiles(arguments, &high_surfaces);
        bake.find_ranges(&tiles, &options.with_maps(maps), &mut report)?;
    }
    for tile in &tiles {
        bake.tile(tile, &options.with_udim(tile.udim), &mut report)?;
    }
    let Run { page, mut outputs, warnings, .. } = bake;
    report.warnings = distinct(warnings);
    // The pictures of the page need memory, too.
    drop(surfaces);
    report.report = page.stage(arguments, &report, &mut outputs)?;
    commit(outputs)?;
    Ok(report)
}

/// What the tiles of a bake share.
struct Run<'a> {
    models: &'a Models<'a>,
    surfaces: &'a PreparedSurfaces<'a>,
    /// Of maps whose range is not that of one image.
    ranges: Ranges,
    context: Context,
    messages: &'a Messages,
    warnings: Vec<String>,
    clock: Clock,
    page: PageContent,
    outputs: Outputs,
}

impl Run<'_> {
    /// Finds the ranges that maps have in all tiles together, so that tiles fit together: bakes these maps
    /// alone, one tile after the other, and keeps no image.
    fn find_ranges(
        &mut self,
        tiles: &[Tile],
        options: &BakeOptions,
        report: &mut BakeReport,
    ) -> Result<(), BakeFailure> {
        if options.maps.is_empty() {
            return Ok(());
        }
        for tile in tiles {
            let options = options.with_udim(tile.udim);
            let baked = self.bake(tile, &options)?;
            for map in options.maps.kinds() {
                let encoding = Encoding::new(map, &baked.images, &options, None, &Ranges::default());
                self.ranges.widen(map, encoding.range);
            }
        }
        report.seconds.rays += self.clock.lap();
        Ok(())
    }

    /// Bakes a tile and tells its progress. Errors: those of the bake; what its counts do not allow.
    fn bake(&mut self, Tile { udim, arguments }: &Tile, options: &BakeOptions) -> Result<Baked, BakeFailure> {
        let progress = self.messages.file(&arguments.output.display().to_string(), PROGRESS_UNITS);
        let mut tell = move |BakeProgress { done, total }: BakeProgress| progress.set(done, total);
        let baked = self.surfaces.bake(options, &mut self.context, &mut tell)?;
        match advice::failure(&baked.report, arguments, self.misfit(&baked).as_deref()) {
            Some(reason) => Err(udim.map_or(reason.clone(), |udim| format!("tile {udim}: {reason}")).into()),
            None => Ok(baked),
        }
    }

    /// How the models do not fit together, where rays hit nothing.
    fn misfit(&self, baked: &Baked) -> Option<String> {
        (baked.report.missed_texels > 0).then(|| self.models.misfit()).flatten()
    }

    /// Bakes a tile, stages its files and adds it to the report.
    fn tile(
        &mut self,
        tile: &Tile,
        options: &BakeOptions,
        report: &mut BakeReport,
    ) -> Result<(), BakeFailure> {
        let Tile { udim, arguments } = tile;
        let low = &self.models.low;
        let baked = self.bake(tile, options)?;
        report.seconds.rays += self.clock.lap();
        let outputs = &mut self.outputs;
        let mut written = stage_maps(arguments, &baked.images, options, &self.ranges, outputs)?;
        self.warnings.append(&mut written.warnings);
        let misses = pictures::misses(arguments, &baked, &mut self.warnings, outputs)?;
        let legends = stage_legends(arguments, &baked.legends, &self.models.highs, outputs)?;
        report.legends.extend(legends.iter().map(|legend| legend.file.clone()));
        report.model =
            stage_model(arguments, self.models, &baked.images, &written, &mut self.warnings, outputs)?;
        self.page.add(arguments, self.models, &baked, &mut written, legends, udim.is_some());
        report.seconds.writing += self.clock.lap();
        let names: Vec<&str> = low.names().collect();
        let verification = match &written.normal {
            Some(normal) if arguments.verify => {
                let mut verified = Verified::new(
                    arguments,
                    self.surfaces,
                    &names,
                    &baked.images,
                    normal,
                    options,
                    &mut self.context,
                    self.messages,
                    outputs,
                )?;
                verified.stage_model(arguments, low, outputs)?;
                Some(verified)
            }
            _ => None,
        };
        report.seconds.verifying += self.clock.lap();
        let advice =
            advice::of_report(&baked.report, arguments, self.misfit(&baked).as_deref(), misses.as_deref());
        let named = |warning: String| udim.map_or(warning.clone(), |udim| format!("tile {udim}: {warning}"));
        self.warnings.extend(advice.into_iter().map(named));
        report.maps.extend(written.maps);
        match udim {
            None => {
                (report.misses, report.counts, report.verification) = (misses, baked.report, verification);
            }
            Some(udim) => {
                report.counts = report.counts.with_tile(&baked.report);
                let (udim, counts) = (udim.number(), baked.report);
                report.tiles.push(TileReport { udim, misses, counts, verification });
            }
        }
        Ok(())
    }
}

/// The progress units of a bake, or of each of its tiles.
pub fn progress_units(arguments: &BakeArguments) -> u64 {
    PROGRESS_UNITS * (1 + u64::from(arguments.verify))
}

fn context(arguments: &BakeArguments) -> Context {
    let mut context = Context::new();
    if let Some(jobs) = arguments.jobs {
        context.set_max_threads(usize::from(jobs.get()));
    }
    context
}

/// Sentences in their order, each once: a model may be LOW and HIGH.
fn distinct(sentences: Vec<String>) -> Vec<String> {
    let mut seen = HashSet::new();
    sentences.into_iter().filter(|sentence| seen.insert(sentence.clone())).collect()
}

/// The opened files of the low model, of the high ones and of the cage.
struct Documents {
    low: Document,
    highs: Vec<Document>,
    cage: Option<Document>,
    /// Every file that the bake reads.
    inputs: Vec<InputFile>,
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
        let cage = arguments.cage.as_ref();
        let cage =
            cage.map(|path| load_with_warnings(path, &arguments.reading, &mut Vec::new())).transpose()?;
        let mut inputs = all_inputs(arguments);
        inputs.extend(highs.iter().chain([&low]).chain(&cage).flat_map(files_of));
        refuse_twice(&outputs_of(arguments, 0), &inputs)?;
        Ok(Self { low, highs, cage, inputs })
    }

    fn corners(&self) -> Result<Corners<'_>, String> {
        let highs = self.highs.iter().map(Document::corners).collect::<Result<_, _>>();
        Ok(Corners { low: self.low.corners().map_err(sentence)?, highs: highs.map_err(sentence)? })
    }
}

fn read_models<'a>(
    arguments: &BakeArguments,
    documents: &'a Documents,
    corners: &'a Corners<'a>,
) -> Result<Models<'a>, String> {
    let low = (&documents.low, &corners.low[..]);
    let highs = (&documents.highs[..], &corners.highs[..]);
    Models::read(low, highs, &arguments.low_options(), &arguments.high_options()).map_err(sentence)
}

fn sentence(error: darboux_io::Error) -> String {
    error.to_string()
}

fn options(arguments: &BakeArguments, distance: [f32; 2], memory_limit: Option<u64>) -> BakeOptions {
    let content = &arguments.content;
    let world_direction = content.world_direction.0;
    BakeOptions::new(arguments.size, distance)
        .with_maps(arguments.baked_maps())
        .with_samples_per_axis(arguments.samples.0)
        .with_back_faces(arguments.back_faces)
        .with_bitangent(arguments.bitangent)
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
        .with_memory_limit(memory_limit)
}
