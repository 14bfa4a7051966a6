//! `darboux inspect`: a table per file, a line per primitive.

use comfy_table::{CellAlignment, ContentArrangement, Table, presets};
use darboux_io::Error;
use darboux_io::gltf::{PrimitiveInfo, inspect};
use indicatif::HumanCount;
use serde::Serialize;

use crate::arguments::InspectArguments;
use crate::jobs::{self, Input};
use crate::messages::{self, Messages};
use crate::{DONE, FAILED, USAGE, models};

/// What `--json` prints.
#[derive(Serialize)]
struct Report {
    version: &'static str,
    files: Vec<FileReport>,
    failed: usize,
}

#[derive(Serialize)]
struct FileReport {
    input: String,
    /// Why it failed, in one sentence; null where it did not.
    error: Option<String>,
    warnings: Vec<String>,
    primitives: Vec<PrimitiveInfo>,
}

/// Runs the command; returns the exit code.
pub fn run(arguments: &InspectArguments) -> u8 {
    let messages = Messages::new(false, 0);
    let stdin = arguments.inputs.iter().any(|path| path.as_os_str() == "-");
    if stdin && arguments.inputs.len() > 1 {
        messages.error("- (standard input) must be the only input");
        return USAGE;
    }
    let found = jobs::find(&arguments.inputs, None);
    let unsearched = found.failed.iter().map(|(path, reason)| {
        let input = path.display().to_string();
        let error = Some(format!("{input}: {reason}"));
        FileReport { input, error, warnings: Vec::new(), primitives: Vec::new() }
    });
    let read = found.files.iter().map(|(input, _)| one_file(input, arguments.allow_outside));
    let files: Vec<FileReport> = unsearched.chain(read).collect();
    for file in &files {
        file.error.iter().for_each(|error| messages.error(error));
        file.warnings.iter().for_each(|warning| messages.warn(warning));
    }
    let failed = files.iter().filter(|file| file.error.is_some()).count();
    let printed = if arguments.json {
        messages::write_json(&Report { version: env!("CARGO_PKG_VERSION"), files, failed })
    } else {
        messages::write_stdout(tables(&files).as_bytes())
    };
    match printed {
        Ok(()) if failed == 0 => DONE,
        Ok(()) => FAILED,
        Err(error) => {
            messages.error(&format!("the table cannot be written: {error}"));
            FAILED
        }
    }
}

fn one_file(input: &Input, allow_outside: bool) -> FileReport {
    let inspected: Result<_, Error> = models::read(input, allow_outside)
        .and_then(|mut document| Ok((inspect(&mut document)?, document.warnings().to_vec())));
    let (error, (primitives, warnings)) = match inspected {
        Ok(seen) => (None, seen),
        Err(error) => (Some(error.to_string()), Default::default()),
    };
    FileReport { input: input.to_string(), error, warnings, primitives }
}

fn tables(files: &[FileReport]) -> String {
    let shown = files.iter().filter(|file| file.error.is_none());
    shown.map(|file| format!("{}\n{}\n\n", file.input, table(&file.primitives))).collect()
}

const HEADER: [&str; 11] = [
    "primitive",
    "mode",
    "vertices",
    "triangles",
    "attributes",
    "UV set",
    "tangents",
    "split",
    "mirrored",
    "degenerate",
    "UV-degenerate",
];

fn table(primitives: &[PrimitiveInfo]) -> Table {
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY).set_content_arrangement(ContentArrangement::Dynamic);
    table.set_header(HEADER);
    for primitive in primitives {
        table.add_row(row(primitive));
    }
    for column in [2, 3, 7, 8, 9, 10] {
        if let Some(column) = table.column_mut(column) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table
}

fn row(primitive: &PrimitiveInfo) -> [String; 11] {
    let count = |count: usize| HumanCount(count as u64).to_string();
    let counts = &primitive.counts;
    let tangents = match (&primitive.ineligible, primitive.has_tangents, primitive.needs_tangents) {
        (_, true, _) => "yes".to_owned(),
        (Some(reason), ..) => format!("no: {reason}"),
        (None, _, true) => "no, needed".to_owned(),
        (None, ..) => "no".to_owned(),
    };
    [
        primitive.name.to_string(),
        primitive.mode.to_owned(),
        count(primitive.vertices),
        count(counts.triangles),
        primitive.attributes.join(" "),
        format!("TEXCOORD_{} ({})", primitive.uv_set, primitive.uv_reason),
        tangents,
        count(counts.split_vertices),
        count(counts.mirrored_edges),
        count(counts.degenerate_triangles),
        count(counts.uv_degenerate_triangles),
    ]
}
