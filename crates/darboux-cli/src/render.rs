//! `darboux render`.

use std::path::Path;

use clap::ValueEnum;
use darboux::{NormalOptions, Shading, TangentOptions};
use darboux_gpu::{Gpu, GpuError};
use darboux_io::gltf::{
    Document, NormalsOptions, Pair, SaveOptions, TangentsOptions, add_normals, add_tangents, pair_tangents,
};
use darboux_io::image::Image;
use darboux_render::{Camera, HeatScale, Model, RenderError, RenderOptions};
use serde::Serialize;

use crate::arguments::{RenderArguments, Source, View};
use crate::batch::counted;
use crate::compare::heat_map::{self, ENDS, FLIP, RAMP};
use crate::compare::refuse_used;
use crate::jobs::{Input, is_png, refuse_missing_folder};
use crate::messages::{Messages, write_stdout};
use crate::models::load;
use crate::report::{VERSION, to_json};
use crate::{exit, interrupt};

/// What `darboux render --json` prints.
#[derive(Serialize)]
struct RenderReport {
    command: &'static str,
    version: &'static str,
    input: String,
    output: String,
    view: String,
    size: [u32; 2],
    adapter: String,
    triangles: u64,
    warnings: Vec<String>,
}

/// Runs the command; gives its exit code.
pub fn run(arguments: &RenderArguments) -> u8 {
    let messages = Messages::new(arguments.talk.quiet);
    if arguments.model == Path::new("-") {
        messages.error("a model on standard input cannot be drawn; save it to a file");
        return exit::USAGE;
    }
    if let Err(sentence) = refuse_missing_folder(&arguments.output) {
        messages.error(&sentence);
        return exit::USAGE;
    }
    interrupt::wait_for_writes();
    let report = match draw(arguments) {
        Ok(report) => report,
        Err(sentence) => {
            messages.error(&sentence);
            return exit::FAILED;
        }
    };
    report.warnings.iter().for_each(|warning| messages.warn(warning));
    let RenderReport { output, view, size: [width, height], triangles, adapter, .. } = &report;
    let triangles = counted(*triangles as usize, "triangle", "triangles");
    messages.say(&format!("{output}: {view}, {width} x {height}, {triangles}, drawn by {adapter}"));
    let told = match arguments.talk.json {
        true => to_json(&report).map_err(std::io::Error::from).and_then(|text| write_stdout(&text)),
        false => Ok(()),
    };
    if let Err(error) = told {
        messages.error(&format!("the report cannot be written: {error}"));
        return exit::FAILED;
    }
    exit::DONE
}

/// Reads, draws, writes. Errors are one sentence each.
fn draw(arguments: &RenderArguments) -> Result<RenderReport, String> {
    let RenderArguments { model: path, output, view, size, .. } = arguments;
    check_output(output, arguments.force)?;
    let mut document = document(arguments, arguments.tangents)?;
    refuse_used(output, [&document, &document])?;
    let name = document.name().to_owned();
    let pairs = match (view, arguments.against) {
        (View::Heat, Some(source)) => compared(arguments, &mut document, source)?,
        _ => Vec::new(),
    };
    let meshes = chosen(&document, &arguments.mesh)?;
    let model = Model::read(&mut document, &pairs).map_err(|error| error.to_string())?;
    let model = if arguments.mesh.is_empty() { model } else { model.only(&meshes) };
    let gpu = pollster::block_on(Gpu::open()).map_err(no_adapter)?;
    let picture = darboux_render::render(&gpu, &model, &options(arguments)).map_err(|error| match error {
        RenderError::Nothing | RenderError::TooMany { .. } => format!("{name}: {error}"),
        error => error.to_string(),
    })?;
    let mut pixels = picture.pixels;
    if *view == View::Heat {
        add_scale(&mut pixels, *size);
    }
    let image =
        Image::from_rgb(&output.display().to_string(), *size, &pixels).map_err(|error| error.to_string())?;
    let _guard = interrupt::writing();
    let written = image
        .save(output, &SaveOptions { force: arguments.force, run: None })
        .map_err(|error| error.to_string())?;
    Ok(RenderReport {
        command: "render",
        version: VERSION,
        input: path.display().to_string(),
        output: written.display().to_string(),
        view: view.to_possible_value().map(|view| view.get_name().to_owned()).unwrap_or_default(),
        size: *size,
        adapter: gpu.name.clone(),
        triangles: model.triangle_count(),
        warnings: picture.warnings.into_iter().map(|warning| with_name(&name, warning)).collect(),
    })
}

/// Says what is wrong with the output before any work.
fn check_output(path: &Path, force: bool) -> Result<(), String> {
    if path.exists() && !force {
        return Err(format!("{}: exists; use --force to replace it, or name another file", path.display()));
    }
    if !is_png(path) {
        return Err(format!("{}: the picture is a PNG; name it .png", path.display()));
    }
    Ok(())
}

/// The model with the tangents of a source. Triangles without normals get flat ones, as glTF asks of renderers.
fn document(arguments: &RenderArguments, source: Option<Source>) -> Result<Document, String> {
    let sentence = |error: darboux_io::Error| error.to_string();
    let mut document = load(&Input::File(arguments.model.clone()), arguments.allow_outside)?;
    let flat = NormalOptions { shading: Shading::Flat, ..NormalOptions::default() };
    let flat = NormalsOptions { normals: flat, ..NormalsOptions::default() };
    add_normals(&mut document, &flat, &mut |_| {}).map_err(sentence)?;
    let tangents = match source {
        Some(Source::File) if !has_tangents(&document) => {
            let name = document.name();
            return Err(format!(
                "{name}: has no tangents; name a method in place of file, or make some: darboux tangents {name}"
            ));
        }
        Some(Source::File) => return Ok(document),
        Some(Source::Method(method)) => {
            let tangents = TangentOptions { method: method.into(), ..TangentOptions::default() };
            TangentsOptions { tangents, overwrite: true, ..TangentsOptions::default() }
        }
        None => TangentsOptions::default(),
    };
    add_tangents(&mut document, &tangents, &mut |_| {}).map_err(sentence)?;
    Ok(document)
}

/// The meshes that names and indices mean. The error is a sentence.
fn chosen(document: &Document, words: &[String]) -> Result<Vec<usize>, String> {
    let meshes = document.meshes();
    let mut chosen = Vec::new();
    for word in words {
        let named = meshes.iter().enumerate().filter(|(_, mesh)| mesh.name.as_ref() == Some(word));
        let before = chosen.len();
        chosen.extend(named.map(|(index, _)| index));
        if chosen.len() == before {
            let index = word.parse().ok().filter(|&index: &usize| index < meshes.len());
            chosen.push(index.ok_or_else(|| no_mesh(document, word))?);
        }
    }
    Ok(chosen)
}

/// More names than this help nobody.
const MOST_NAMES: usize = 8;

fn no_mesh(document: &Document, word: &str) -> String {
    let names: Vec<&str> =
        document.meshes().iter().filter_map(|mesh| mesh.name.as_deref()).take(MOST_NAMES).collect();
    let names = if names.is_empty() { String::new() } else { format!(", such as {}", names.join(", ")) };
    let count = counted(document.meshes().len(), "mesh", "meshes");
    format!("{}: has no mesh {word}; name one of its {count}{names}, or an index from 0", document.name())
}

fn has_tangents(document: &Document) -> bool {
    let mut primitives = document.meshes().iter().flat_map(|mesh| &mesh.primitives);
    primitives.any(|primitive| primitive.attributes.contains_key("TANGENT"))
}

/// The tangents of a document beside those of another source.
fn compared(
    arguments: &RenderArguments,
    document: &mut Document,
    source: Source,
) -> Result<Vec<Pair>, String> {
    let mut other = self::document(arguments, Some(source))?;
    pair_tangents(document, &mut other).map_err(|error| error.to_string())
}

fn options(arguments: &RenderArguments) -> RenderOptions {
    let [yaw, pitch, zoom] = arguments.camera;
    RenderOptions {
        view: match arguments.view {
            View::Shaded => darboux_render::View::Shaded,
            View::Tangent => darboux_render::View::Tangent,
            View::Bitangent => darboux_render::View::Bitangent,
            View::Normal => darboux_render::View::Normal,
            View::Sign => darboux_render::View::Sign,
            View::Heat => darboux_render::View::Heat,
            View::Uv => darboux_render::View::Uv,
        },
        size: arguments.size,
        camera: Camera { yaw, pitch, zoom },
        background: arguments.background,
        heat: HeatScale { ends: ENDS.map(|end| end as f32), ramp: RAMP, flip: FLIP, none: [0; 3] },
    }
}

/// Draws the scale over the last rows of a picture, as heat maps have it, unless it would hide much.
fn add_scale(pixels: &mut [[u8; 3]], [width, height]: [u32; 2]) {
    let rows = heat_map::SCALE;
    if height as usize >= 8 * rows {
        let scale = heat_map::scale(width as usize);
        pixels.rchunks_exact_mut(width as usize).take(rows).for_each(|row| row.copy_from_slice(&scale));
    }
}

/// Warnings name their file.
fn with_name(name: &str, warning: String) -> String {
    if warning.starts_with(name) { warning } else { format!("{name}: {warning}") }
}

fn no_adapter(error: GpuError) -> String {
    match error {
        GpuError::NoAdapter => {
            "no adapter was found to draw with: install a Vulkan, Metal or Direct3D 12 driver; Mesa's lavapipe draws without a GPU"
                .to_owned()
        }
        error => error.to_string(),
    }
}
