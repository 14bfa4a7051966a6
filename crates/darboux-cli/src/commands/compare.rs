//! `darboux compare`: compares the tangents of two files, or of a file and a method, corner by corner.

pub mod arguments;
mod heat_map;
mod report;
mod statistics;
mod text;

use std::path::Path;

use darboux::{Choice, TangentOptions};
use darboux_io::gltf::{AddTangentsOptions, Document, Pair, Progress, add_tangents, pair_tangents};
use darboux_io::{SaveOptions, system_reason};

use crate::documents::{load, refuse_used};
use crate::inputs::Input;
use crate::json::{VERSION, to_json};
use crate::paths::{is_png, refuse_missing_folder};
use crate::terminal::{FileProgress, Messages, write_stdout};
use crate::text::command_line;
use crate::{exit, interrupt};
use arguments::CompareArguments;
use heat_map::HeatMap;
use report::{CompareReport, Verdict};
use statistics::Comparison;

/// Runs the command and returns its exit code.
pub fn run(arguments: &CompareArguments) -> u8 {
    let messages = Messages::new(arguments.messages.quiet);
    let inputs = [Some(&arguments.first), arguments.second.as_ref()];
    if inputs.into_iter().flatten().any(|path| path == Path::new("-")) {
        messages.error("standard input cannot be compared; save it to a file first");
        return exit::USAGE;
    }
    if let Err(sentence) = arguments.heat_map.as_deref().map_or(Ok(()), refuse_missing_folder) {
        messages.error(&sentence);
        return exit::USAGE;
    }
    interrupt::wait_for_writes();
    let report = match compare(arguments, &messages) {
        Ok(report) => report,
        Err(sentence) => {
            messages.end_progress();
            messages.error(&sentence);
            return exit::FAILED;
        }
    };
    messages.end_progress();
    report.warnings.iter().for_each(|warning| messages.warn(warning));
    let text = match (arguments.messages.json, arguments.messages.quiet) {
        (true, _) => to_json(&report).map_err(std::io::Error::from),
        (false, true) => Ok(Vec::new()),
        (false, false) => Ok(text::describe(&report).into_bytes()),
    };
    if let Err(error) = text.and_then(|text| write_stdout(&text)) {
        messages.error(&format!("the comparison cannot be written: {}", system_reason(&error)));
        return exit::FAILED;
    }
    if report.within_tolerance == Some(false) { exit::DIFFERENT } else { exit::DONE }
}

/// Reads both sides, compares them and draws the heat map. Errors are one sentence each.
fn compare(arguments: &CompareArguments, messages: &Messages) -> Result<CompareReport, String> {
    if let Some(path) = arguments.heat_map.as_ref().filter(|path| path.exists() && !arguments.force) {
        return Err(format!("{}: exists; use --force to replace it, or choose another name", path.display()));
    }
    if let Some(path) = arguments.heat_map.as_ref().filter(|path| !is_png(path)) {
        return Err(format!("{}: the heat map is a PNG; its name must end in .png", path.display()));
    }
    let other = arguments.second.as_ref().unwrap_or(&arguments.first);
    let inputs = [&arguments.first, other].map(|path| Input::File(path.clone()));
    messages.start(inputs.iter().map(Input::byte_length).sum());
    let progress_of = |input: &Input| messages.file(&input.to_string(), input.byte_length());
    let progress = progress_of(&inputs[0]);
    let first = load(&inputs[0], &arguments.reading)?;
    drop(progress);
    let progress = progress_of(&inputs[1]);
    let mut second = load(&inputs[1], &arguments.reading)?;
    if let Some(path) = &arguments.heat_map {
        refuse_used(path, [&first, &second])?;
    }
    if let Some(method) = arguments.method {
        give_tangents(&mut second, method, &progress)?;
    }
    drop(progress);
    let warnings_of = |document: &Document| -> Vec<String> {
        document.warnings().iter().map(|warning| format!("{}: {warning}", document.name())).collect()
    };
    let mut warnings = warnings_of(&first);
    warnings.extend(arguments.second.iter().flat_map(|_| warnings_of(&second)));
    let without_tangents = nothing_to_compare([&first, &second]);
    let [first_name, second_name] = [&first, &second].map(|document| document.name().to_owned());
    let pairs = pair_tangents(&first, &second).map_err(|error| error.to_string())?;
    warnings.extend(moved(&pairs));
    let Comparison { totals, primitives, worst } =
        Comparison::new(&pairs, arguments.worst).map_err(|error| error.to_string())?;
    if primitives.iter().all(|primitive| primitive.statistics.is_none()) {
        return Err(without_tangents);
    }
    let heat_map = match &arguments.heat_map {
        Some(path) => Some(draw(&pairs, path, arguments.force, &mut warnings)?),
        None => None,
    };
    let one_sided = pairs.iter().any(|pair| matches!(&pair.corners, Err(unpaired) if unpaired.is_one_sided));
    let within = |degrees: f64| totals.is_within(degrees) && !one_sided;
    Ok(CompareReport {
        command: "compare",
        version: VERSION,
        first: first_name,
        second: arguments.second.as_ref().map(|_| second_name),
        method: arguments.method.map(|method| method.name().to_owned()),
        worst,
        within_tolerance: arguments.tolerance.map(within),
        verdict: Verdict::new(&totals, one_sided),
        totals,
        primitives,
        heat_map,
        warnings,
    })
}

/// The error if no primitive has tangents on both sides: names the file without tangents.
fn nothing_to_compare(documents: [&Document; 2]) -> String {
    let has_tangents = |document: &Document| {
        let mut primitives = document.meshes().iter().flat_map(|mesh| &mesh.primitives);
        primitives.any(|primitive| primitive.attributes.contains_key("TANGENT"))
    };
    match documents.into_iter().find(|document| !has_tangents(document)) {
        Some(document) => {
            let name = document.name();
            let repair = command_line(&["tangents"], &[name]);
            format!("{name}: has no tangents to compare; to add them: {repair}")
        }
        None => {
            let [first, second] = documents.map(Document::name);
            format!("{first}: no primitive has tangents both here and in {second}")
        }
    }
}

/// Replaces all tangents by the tangents of a method.
fn give_tangents(
    document: &mut Document,
    method: darboux::Method,
    progress: &FileProgress<'_>,
) -> Result<(), String> {
    let tangents = TangentOptions::from(method);
    let options = AddTangentsOptions::default().with_tangents(tangents).with_overwrite(true);
    let mut on_progress = |Progress { done, total }: Progress| progress.set(done, total);
    add_tangents(document, &options, &mut on_progress).map(drop).map_err(|error| error.to_string())
}

/// A warning for each primitive whose corners have other positions in the second file.
fn moved(pairs: &[Pair<'_>]) -> impl Iterator<Item = String> {
    let moved = pairs.iter().filter_map(|pair| {
        let moved = pair.corners.as_ref().ok()?.moved;
        (moved > 0).then_some((&pair.name, moved))
    });
    moved.map(|(name, moved)| {
        format!(
            "{name}: {moved} corners have other positions in the second file; check that both are the \
             same model with corners in the same order"
        )
    })
}

fn draw(pairs: &[Pair<'_>], path: &Path, force: bool, warnings: &mut Vec<String>) -> Result<String, String> {
    let mut map = HeatMap::new();
    for corners in pairs.iter().filter_map(|pair| pair.corners.as_ref().ok()) {
        map.add(corners);
    }
    map.draw();
    if map.too_large() > 0 {
        warnings.push(format!(
            "{}: only the corners of {} triangles are drawn: their UVs span more than the map, or there are \
             too many triangles",
            path.display(),
            map.too_large()
        ));
    }
    let _guard = interrupt::writing();
    let image = map.image(&path.display().to_string()).map_err(|error| error.to_string())?;
    let written =
        image.save(path, &SaveOptions::default().with_force(force)).map_err(|error| error.to_string())?;
    Ok(written.display().to_string())
}
