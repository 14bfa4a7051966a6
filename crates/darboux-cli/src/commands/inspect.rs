//! `darboux inspect`: prints a table of the primitives of each file.

pub mod arguments;
mod report;

use comfy_table::{CellAlignment, ColumnConstraint, ContentArrangement, LineStyle, Table, TableStyle, Width};
use console::Term;
use darboux_io::gltf::{PrimitiveInfo, inspect};
use indicatif::HumanCount;

use crate::documents::load;
use crate::exit;
use crate::inputs::{Input, SearchMode, UsageError, check_stdin, find_inputs};
use crate::json::{VERSION, to_json};
use crate::options::reading::ReadOptions;
use crate::terminal::{Messages, write_stdout};
use arguments::InspectArguments;
use report::{InspectReport, InspectedFile};

/// Runs the command; gives its exit code.
pub fn run(arguments: &InspectArguments) -> u8 {
    let messages = Messages::new(arguments.messages.quiet);
    if let Err(UsageError(sentence)) = check_stdin(&arguments.inputs) {
        messages.error(&sentence);
        return exit::USAGE;
    }
    let found = find_inputs(&arguments.inputs, SearchMode::All);
    let mut files: Vec<InspectedFile> = Vec::new();
    for (input, _) in &found.files {
        files.push(look(input, &arguments.reading));
    }
    files.extend(found.failed.iter().map(|(path, reason)| {
        let path = path.display().to_string();
        let sentence = format!("{path}: {reason}");
        failed(path, sentence)
    }));
    let text = match (arguments.messages.json, arguments.messages.quiet) {
        (true, _) => to_json(&InspectReport { command: "inspect", version: VERSION, files: files.clone() }),
        (false, true) => Ok(Vec::new()),
        (false, false) => {
            let good = files.iter().filter(|file| file.error.is_none());
            Ok(good.map(described).collect::<String>().into_bytes())
        }
    };
    if let Err(error) = text.map_err(std::io::Error::from).and_then(|text| write_stdout(&text)) {
        messages.error(&format!("the table cannot be written: {error}"));
        return exit::FAILED;
    }
    tell(&files, &messages)
}

/// Warnings and errors of all files; gives the exit code.
fn tell(files: &[InspectedFile], messages: &Messages) -> u8 {
    for file in files {
        file.warnings.iter().for_each(|warning| messages.warn(&format!("{}: {warning}", file.input)));
    }
    let errors: Vec<&String> = files.iter().filter_map(|file| file.error.as_ref()).collect();
    errors.iter().for_each(|error| messages.error(error));
    if errors.is_empty() { exit::DONE } else { exit::FAILED }
}

fn look(input: &Input, reading: &ReadOptions) -> InspectedFile {
    let looked = load(input, reading).and_then(|mut document| {
        let primitives = inspect(&mut document).map_err(|error| error.to_string())?;
        Ok(InspectedFile {
            input: input.to_string(),
            error: None,
            warnings: document.warnings().to_vec(),
            primitives,
        })
    });
    looked.unwrap_or_else(|sentence| failed(input.to_string(), sentence))
}

fn failed(input: String, sentence: String) -> InspectedFile {
    InspectedFile { input, error: Some(sentence), warnings: Vec::new(), primitives: Vec::new() }
}

/// A column: its title, how it is laid out, and what it says of a primitive.
type Column = (&'static str, Kind, fn(&PrimitiveInfo) -> String);

/// How a column is laid out.
#[derive(PartialEq)]
enum Kind {
    /// To the left, wrapped to the width that the others leave, at least this.
    Long(u16),
    /// To the left, never wrapped.
    Short,
    /// To the right, never wrapped.
    Number,
}

const COLUMNS: &[Column] = &[
    ("", Kind::Short, |info| format!("{}.{}", info.name.mesh, info.name.primitive)),
    ("mesh", Kind::Long(7), |info| {
        info.name.mesh_name.as_deref().unwrap_or_default().escape_debug().to_string()
    }),
    ("vertices", Kind::Number, |info| count(info.vertices)),
    ("triangles", Kind::Number, triangles),
    ("UV", Kind::Number, |info| info.uv_set.to_string()),
    ("mirrored", Kind::Number, |info| count(info.counts.mirrored_edges)),
    ("degenerate", Kind::Number, degenerate),
    ("split", Kind::Number, |info| count(info.counts.split_vertices)),
    ("tangents", Kind::Short, |info| tangents(info).to_string()),
    ("attributes", Kind::Long(11), attributes),
];

fn count(count: usize) -> String {
    HumanCount(count as u64).to_string()
}

/// Their number, and what they are in where that is not a list.
fn triangles(info: &PrimitiveInfo) -> String {
    match info.mode.strip_prefix("TRIANGLE_") {
        Some(mode) => format!("{} {}", count(info.counts.triangles), mode.to_lowercase()),
        None => count(info.counts.triangles),
    }
}

fn degenerate(info: &PrimitiveInfo) -> String {
    match info.counts.uv_degenerate_triangles {
        0 => count(info.counts.degenerate_triangles),
        in_uv => format!("{}, {} UV", count(info.counts.degenerate_triangles), count(in_uv)),
    }
}

fn attributes(info: &PrimitiveInfo) -> String {
    let mut text = info.attributes.join(" ").escape_debug().to_string();
    if info.morph_targets > 0 {
        text += &format!(" + {} morph targets", info.morph_targets);
    }
    text
}

fn tangents(info: &PrimitiveInfo) -> &'static str {
    match (info.has_tangents, info.needs_tangents, &info.ineligible) {
        (true, ..) => "yes",
        (false, _, Some(_)) => "-",
        (false, true, None) => "needed",
        (false, false, None) => "no",
    }
}

/// The width of lines where no terminal is wider.
const WIDTH: u16 = 100;

/// Columns apart by two spaces: one here, one in [`described`].
const STYLE: TableStyle = TableStyle::new().header_separator(LineStyle::none().fill('-').junction('-'));

/// The file's name, its table, and why primitives cannot have tangents.
fn described(file: &InspectedFile) -> String {
    let mut table = Table::new();
    table.load_style(STYLE).set_header(COLUMNS.iter().map(|column| column.0));
    let terminal = Term::stdout().size_checked().map_or(WIDTH, |(_, width)| width.max(WIDTH));
    table.set_content_arrangement(ContentArrangement::Dynamic).set_width(terminal);
    for (column, (_, kind, _)) in table.column_iter_mut().zip(COLUMNS) {
        column.set_padding((0, 1));
        if *kind == Kind::Number {
            column.set_cell_alignment(CellAlignment::Right);
        }
        column.set_constraint(match kind {
            Kind::Long(least) => ColumnConstraint::LowerBoundary(Width::Fixed(*least)),
            Kind::Short | Kind::Number => ColumnConstraint::ContentWidth,
        });
    }
    for info in &file.primitives {
        table.add_row(COLUMNS.iter().map(|column| column.2(info)));
    }
    let mut text = format!("{}\n\n{}\n\n", file.input, table.trim_fmt());
    for info in &file.primitives {
        if let Some(reason) = &info.ineligible {
            text += &format!("{}.{}: {reason}\n", info.name.mesh, info.name.primitive);
        }
    }
    text
}
