//! Runs `darboux render`: reads the model, draws it, and writes the PNG.

use std::path::Path;

use clap::ValueEnum;
use darboux::{Method, NormalOptions, Shading, TangentOptions};
use darboux_gpu::{Gpu, GpuError};
use darboux_io::SaveOptions;
use darboux_io::gltf::{AddNormalsOptions, AddTangentsOptions, Document, add_normals, add_tangents};
use darboux_io::image::PngImage;
use darboux_render::{Camera, HeatScale, Lines, Mistakes, Model, Picture, RenderError, RenderOptions, Side};
use serde::Serialize;

use super::arguments::{
    LayoutPlacement, MistakeChoice, RenderArguments, ShaderMistake, TangentSource, VectorLines, ViewChoice,
};
use super::legend::Legend;
use crate::documents::{load, refuse_used};
use crate::gpu::without_driver_messages;
use crate::heat_scale::{ENDS, FLIP, RAMP};
use crate::inputs::Input;
use crate::json::{VERSION, print_report};
use crate::paths::{is_png, refuse_missing_folder};
use crate::terminal::Messages;
use crate::text::counted;
use crate::{exit, interrupt};

/// The JSON report. json.txt documents its fields.
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

/// Runs the command and returns its exit code.
pub fn run(arguments: &RenderArguments) -> u8 {
    let messages = Messages::new(arguments.messages.quiet);
    if arguments.model == Path::new("-") {
        messages.error("a model on standard input cannot be drawn; save it to a file first");
        return exit::USAGE;
    }
    let refused = refuse_missing_folder(&arguments.output).and_then(|()| refuse_contradictions(arguments));
    if let Err(sentence) = refused {
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
    print_report(&report, arguments.messages.json, &messages)
}

/// Refuses arguments that contradict each other or have no effect.
fn refuse_contradictions(arguments: &RenderArguments) -> Result<(), String> {
    let RenderArguments { view, against, split, mistakes, output, .. } = arguments;
    if output.is_dir() {
        return Err(format!("{} is a folder; choose a file in it", output.display()));
    }
    if against.is_some() && *view != ViewChoice::Angle && split.is_none() {
        return Err("--against needs --view angle or --split; add one of them".to_owned());
    }
    if split.is_some() && *view == ViewChoice::Angle {
        return Err("--view angle compares two sources in one picture; remove --split".to_owned());
    }
    if split.is_some() && against.is_none() && mistakes.is_empty() {
        return Err("--split needs --against or --mistakes; without them both sides are the same".to_owned());
    }
    let is_lit = matches!(view, ViewChoice::Shaded | ViewChoice::Bumps);
    if arguments.ground && (!is_lit || arguments.layout == Some(LayoutPlacement::Alone)) {
        return Err("--ground stands below a lit model; remove it, or draw the model with --view shaded or \
                    --view bumps"
            .to_owned());
    }
    Ok(())
}

/// Reads the model, draws it and writes the picture. Errors are one sentence each.
fn draw(arguments: &RenderArguments) -> Result<RenderReport, String> {
    let RenderArguments { model: path, output, view, size, .. } = arguments;
    check_output(output, arguments.force)?;
    let LoadedModel { document, source, warnings } = open(arguments, arguments.tangents)?;
    let other = arguments.against.map(|source| open(arguments, Some(source))).transpose()?;
    let other = other.map(|other| other.document);
    refuse_used(output, [&document, other.as_ref().unwrap_or(&document)])?;
    let name = document.name().to_owned();
    let model = model(arguments, &document, Some(source))?;
    let other = other.as_ref().map(|document| self::model(arguments, document, arguments.against));
    let (model, other) = match other.transpose()? {
        Some(other) => {
            let model = model.compared_with(&other);
            let other = other.compared_with(&model);
            (model, Some(other))
        }
        None => (model, None),
    };
    let gpu = without_driver_messages(|| pollster::block_on(Gpu::open())).map_err(no_adapter)?;
    let picture = picture(arguments, source, &gpu, &model, other.as_ref()).map_err(|error| match error {
        RenderError::NothingToDraw | RenderError::TooManyTriangles { .. } => format!("{name}: {error}"),
        error => error.to_string(),
    })?;
    let image = PngImage::from_rgb(&output.display().to_string(), *size, &picture.pixels)
        .map_err(|error| error.to_string())?;
    let _guard = interrupt::writing();
    let written = image
        .save(output, &SaveOptions::default().with_force(arguments.force))
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
        warnings: warnings
            .into_iter()
            .chain(picture.warnings)
            .map(|warning| with_name(&name, warning))
            .collect(),
    })
}

/// The chosen meshes of a document as a model to draw.
fn model<'a>(
    arguments: &RenderArguments,
    document: &'a Document,
    source: Option<TangentSource>,
) -> Result<Model<'a>, String> {
    let meshes = chosen(document, &arguments.mesh)?;
    let model = Model::read(document).map_err(|error| error.to_string())?;
    let model = if arguments.mesh.is_empty() { model } else { model.only(&meshes) };
    Ok(if source == Some(TangentSource::Derivatives) { model.derived() } else { model })
}

/// Draws the model and the legend.
fn picture(
    arguments: &RenderArguments,
    source: TangentSource,
    gpu: &Gpu,
    model: &Model<'_>,
    other: Option<&Model<'_>>,
) -> Result<Picture, RenderError> {
    let options = options(arguments);
    let legend = Legend::of(arguments, source, &options);
    let has = |mistake| arguments.mistakes.contains(&MistakeChoice::Shader(mistake));
    let mistakes = Mistakes::default()
        .with_green(has(ShaderMistake::Green))
        .with_w(has(ShaderMistake::W))
        .with_v(has(ShaderMistake::V))
        .with_columns(has(ShaderMistake::Columns));
    let of_frames = arguments.mistakes.iter().filter_map(|mistake| match *mistake {
        MistakeChoice::Frames(mistake) => Some(mistake),
        MistakeChoice::Shader(_) => None,
    });
    let wrong = of_frames.fold(None, |wrong: Option<Model<'_>>, mistake| {
        Some(wrong.as_ref().or(other).unwrap_or(model).with_mistake(mistake))
    });
    let right = arguments.split.map(|part| {
        let side = Side { model: wrong.as_ref().or(other).unwrap_or(model), mistakes };
        (side, part / 100.0)
    });
    let mistakes = if right.is_some() { Mistakes::default() } else { mistakes };
    let model = wrong.as_ref().filter(|_| right.is_none()).unwrap_or(model);
    let mut picture = darboux_render::render(gpu, Side { model, mistakes }, right, &legend.above(&options))?;
    legend.add(&mut picture);
    Ok(picture)
}

/// Refuses an output that exists or is not a PNG, before any work.
fn check_output(path: &Path, force: bool) -> Result<(), String> {
    if path.exists() && !force {
        return Err(format!("{}: exists; use --force to replace it, or choose another name", path.display()));
    }
    if !is_png(path) {
        return Err(format!("{}: the picture is a PNG; its name must end in .png", path.display()));
    }
    Ok(())
}

/// A document with tangents.
struct LoadedModel {
    document: Document,
    /// The source of the tangents.
    source: TangentSource,
    /// Warnings about the file, one sentence each.
    warnings: Vec<String>,
}

/// Reads the model with the tangents of a source. Triangles without normals get flat ones, as the glTF
/// specification asks of renderers.
fn open(arguments: &RenderArguments, source: Option<TangentSource>) -> Result<LoadedModel, String> {
    let sentence = |error: darboux_io::Error| error.to_string();
    let mut document = load(&Input::File(arguments.model.clone()), &arguments.reading)?;
    let warnings = if document.provenance().is_some() { document.warnings().to_vec() } else { Vec::new() };
    let flat = NormalOptions::new().with_shading(Shading::Flat);
    let flat = AddNormalsOptions::default().with_normals(flat);
    add_normals(&mut document, &flat, &mut |_| {}).map_err(sentence)?;
    let of_file =
        if has_tangents(&document) { TangentSource::File } else { TangentSource::Method(Method::default()) };
    let tangents = match source {
        Some(TangentSource::File) if of_file != TangentSource::File => {
            let name = document.name();
            return Err(format!("{name}: has no tangents; choose a method, as in --tangents mikktspace"));
        }
        Some(source @ (TangentSource::File | TangentSource::Derivatives)) => {
            return Ok(LoadedModel { document, source, warnings });
        }
        Some(TangentSource::Method(method)) => {
            let tangents = TangentOptions::from(method);
            AddTangentsOptions::default().with_tangents(tangents).with_overwrite(true)
        }
        None => AddTangentsOptions::default(),
    };
    add_tangents(&mut document, &tangents, &mut |_| {}).map_err(sentence)?;
    Ok(LoadedModel { document, source: source.unwrap_or(of_file), warnings })
}

/// Returns the indices of meshes given by name or index. The error is one sentence.
fn chosen(document: &Document, words: &[String]) -> Result<Vec<usize>, String> {
    let meshes = document.meshes();
    let mut chosen = Vec::new();
    for word in words {
        let named = meshes.iter().enumerate().filter(|(_, mesh)| mesh.name.as_deref() == Some(word));
        let before = chosen.len();
        chosen.extend(named.map(|(index, _)| index));
        if chosen.len() == before {
            let index = word.parse().ok().filter(|&index: &usize| index < meshes.len());
            chosen.push(index.ok_or_else(|| no_mesh(document, word))?);
        }
    }
    Ok(chosen)
}

/// The number of mesh names in an error message.
const NAMES_IN_ERROR: usize = 8;

fn no_mesh(document: &Document, word: &str) -> String {
    let names: Vec<&str> =
        document.meshes().iter().filter_map(|mesh| mesh.name.as_deref()).take(NAMES_IN_ERROR).collect();
    let names = if names.is_empty() { String::new() } else { format!(", such as {}", names.join(", ")) };
    let count = counted(document.meshes().len(), "mesh", "meshes");
    format!(
        "{}: has no mesh {word}; use the name of one of its {count}{names}, or an index from 0",
        document.name()
    )
}

fn has_tangents(document: &Document) -> bool {
    let mut primitives = document.meshes().iter().flat_map(|mesh| &mesh.primitives);
    primitives.any(|primitive| primitive.attributes.contains_key("TANGENT"))
}

fn options(arguments: &RenderArguments) -> RenderOptions {
    let [yaw, pitch, zoom] = arguments.camera;
    let draws = |vector| arguments.lines.contains(&vector);
    let view = match arguments.view {
        ViewChoice::Shaded => darboux_render::View::Shaded,
        ViewChoice::Bumps => darboux_render::View::TestBumps,
        ViewChoice::Tangent => darboux_render::View::Tangent,
        ViewChoice::Bitangent => darboux_render::View::Bitangent,
        ViewChoice::Normal => darboux_render::View::Normal,
        ViewChoice::Sign => darboux_render::View::Sign,
        ViewChoice::Angle => darboux_render::View::Angle,
    };
    let lines = Lines::default()
        .with_tangent(draws(VectorLines::Tangent))
        .with_bitangent(draws(VectorLines::Bitangent))
        .with_normal(draws(VectorLines::Normal))
        .with_length(arguments.length / 100.0);
    let layout = arguments.layout.map(|layout| match layout {
        LayoutPlacement::Corner => darboux_render::LayoutPlacement::Corner,
        LayoutPlacement::Alone => darboux_render::LayoutPlacement::Alone,
    });
    let heat = HeatScale { ends: ENDS.map(|end| end as f32), ramp: RAMP, flip: FLIP, none: [0; 3] };
    RenderOptions::new(view, arguments.size, heat)
        .with_lines(lines)
        .with_seams(arguments.seams)
        .with_ground(arguments.ground)
        .with_layout(layout)
        .with_camera(Camera { yaw, pitch, zoom })
        .with_look(arguments.look)
        .with_background(arguments.background)
}

/// Adds the file name to a warning that lacks it.
fn with_name(name: &str, warning: String) -> String {
    if warning.starts_with(name) { warning } else { format!("{name}: {warning}") }
}

/// What to do where there is no adapter.
pub fn no_adapter(error: GpuError) -> String {
    match error {
        GpuError::NoAdapter => {
            "no graphics adapter was found; install a driver for Vulkan, Metal or Direct3D 12 (Mesa's \
             lavapipe works without a GPU)"
                .to_owned()
        }
        error => error.to_string(),
    }
}
