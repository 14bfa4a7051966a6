//! `darboux tangents`.

use std::io::Read;
use std::path::Path;
use std::time::Instant;

use darboux::TangentOptions;
use darboux_io::gltf::{
    Document, LoadOptions, Outcome, Progress, SaveOptions, TangentsOptions, Totals, Written, add_tangents,
};
use indicatif::HumanCount;

use crate::arguments::{Files, Method, TangentsArguments};
use crate::jobs::{self, Input, Job, Output, Scan, Usage, word};
use crate::messages::{Messages, stdout_is_terminal, write_stdout};
use crate::report::{FileReport, Status, TangentsReport, to_json};
use crate::{exit, interrupt};

/// Runs the command; gives its exit code.
pub fn run(arguments: &TangentsArguments) -> u8 {
    let start = Instant::now();
    let messages = Messages::new(arguments.talk.quiet);
    let found =
        jobs::find(&arguments.files.inputs, Scan::Sources { out_dir: arguments.files.out_dir.as_deref() });
    let plan = |()| jobs::plan(&arguments.files, word::TANGENTS, arguments.talk.json, &found);
    let jobs = match check_threshold(arguments).and_then(plan).and_then(refuse_terminal) {
        Ok(jobs) => jobs,
        Err(Usage(sentence)) => {
            messages.error(&sentence);
            return exit::USAGE;
        }
    };
    if found.left_out > 0 {
        messages.say(&format!(
            "{} left out: earlier outputs, by their names",
            counted(found.left_out, "file", "files")
        ));
    }
    interrupt::wait_for_writes();
    messages.start(jobs.iter().map(|job| size_of(&job.input)).sum());
    let unsearched = found.failed.into_iter().map(|(path, reason)| {
        let path = path.display().to_string();
        let sentence = format!("{path}: {reason}");
        FileReport::failed(path, sentence)
    });
    let mut files: Vec<FileReport> = unsearched.collect();
    for job in &jobs {
        files.push(work(job, arguments, &messages));
    }
    messages.end_progress();
    finish(TangentsReport::new(files), arguments, &messages, start)
}

fn check_threshold(arguments: &TangentsArguments) -> Result<(), Usage> {
    if arguments.method != Method::MikkTSpace && arguments.threshold != TangentOptions::default().threshold {
        return Err(Usage("--threshold belongs to --method mikktspace; leave one of them out".into()));
    }
    Ok(())
}

fn refuse_terminal(jobs: Vec<Job>) -> Result<Vec<Job>, Usage> {
    if jobs.iter().any(|job| job.output == Output::Stdout) && stdout_is_terminal() {
        return Err(Usage("a GLB is not for a terminal; use -o FILE, or > FILE".into()));
    }
    Ok(jobs)
}

/// One file's work, told as it ends. Its error, if any, is told at the end of all.
fn work(job: &Job, arguments: &TangentsArguments, messages: &Messages) -> FileReport {
    messages.start_file(&job.input.to_string(), size_of(&job.input));
    let report = process(job, arguments, messages)
        .unwrap_or_else(|sentence| FileReport::failed(job.input.to_string(), sentence));
    messages.end_file();
    tell(&report, messages);
    report
}

/// Reads, adds tangents, writes. Errors are one sentence each.
fn process(job: &Job, arguments: &TangentsArguments, messages: &Messages) -> Result<FileReport, String> {
    let sentence = |error: darboux_io::Error| error.to_string();
    refuse_existing(&job.output, &arguments.files)?;
    let mut document = load(&job.input, arguments.files.allow_outside)?;
    let mut on_progress = |progress: Progress| messages.progress(progress.done, progress.total);
    let mut summary = add_tangents(&mut document, &options(arguments), &mut on_progress).map_err(sentence)?;
    summary.warnings.splice(0..0, document.warnings().iter().cloned());
    let files_written = save(&document, &job.output, &arguments.files)?;
    let status = match summary.totals.written {
        _ if arguments.files.in_place && files_written.is_empty() => Status::Untouched,
        0 => Status::Copied,
        _ => Status::Written,
    };
    Ok(FileReport {
        input: job.input.to_string(),
        output: Some(job.output.to_string()),
        status,
        error: None,
        files_written,
        summary,
    })
}

/// Says before any work that an output is in the way.
fn refuse_existing(output: &Output, files: &Files) -> Result<(), String> {
    match output {
        Output::File(path) if path.exists() && !files.force && !files.in_place => {
            Err(format!("{output}: exists; use --force to replace it, or name another output"))
        }
        _ => Ok(()),
    }
}

/// Reads a document; `-` has no folder, so its buffers must be embedded. Errors are one sentence each.
pub fn load(input: &Input, allow_outside: bool) -> Result<Document, String> {
    let options = LoadOptions { allow_outside };
    let document = match input {
        Input::File(path) => Document::open(path, &options),
        Input::Stdin => {
            let mut bytes = Vec::new();
            std::io::stdin()
                .lock()
                .read_to_end(&mut bytes)
                .map_err(|error| format!("{input}: cannot be read: {error}"))?;
            Document::from_bytes(&input.to_string(), bytes, None, &options)
        }
    };
    document.map_err(|error| error.to_string())
}

fn options(arguments: &TangentsArguments) -> TangentsOptions {
    TangentsOptions {
        tangents: TangentOptions {
            method: arguments.method.into(),
            mode: arguments.mode.into(),
            threshold: arguments.threshold,
        },
        encoding: arguments.encoding,
        overwrite: arguments.overwrite,
        only_needed: arguments.only_needed,
        strict: arguments.strict,
        apply_texture_transform: arguments.apply_texture_transform,
    }
}

/// Writes the document where it belongs; gives the files written.
fn save(document: &Document, output: &Output, files: &Files) -> Result<Vec<String>, String> {
    let sentence = |error: darboux_io::Error| error.to_string();
    let path = match output {
        Output::Stdout => {
            let bytes = document.to_glb().map_err(sentence)?;
            write_stdout(&bytes).map_err(|error| format!("{output}: cannot be written: {error}"))?;
            return Ok(Vec::new());
        }
        Output::File(path) => path,
    };
    let _guard = interrupt::writing();
    let written = match files.in_place {
        true => document.save_in_place(),
        false => document.save(path, &SaveOptions { force: files.force }),
    };
    Ok(written.map_err(sentence)?.iter().map(|path| path.display().to_string()).collect())
}

/// Tells what was done to a file.
fn tell(report: &FileReport, messages: &Messages) {
    let (Some(output), FileReport { input, summary, .. }) = (&report.output, report) else { return };
    match report.status {
        Status::Written | Status::Copied if input != output => messages.say(&format!("{input} -> {output}")),
        Status::Untouched => messages.say(&format!("{input}: nothing to do, left as it was")),
        _ => messages.say(input),
    }
    for primitive in &summary.primitives {
        let what = match &primitive.outcome {
            Outcome::Written(written) => told(written),
            Outcome::Kept { reason } => format!("kept: {reason}"),
            Outcome::Skipped { reason } => format!("left alone: {reason}"),
            _ => continue,
        };
        messages.say(&format!("  {}: {what}", primitive.name));
    }
    for warning in &summary.warnings {
        messages.warn(&format!("{input}: {warning}"));
    }
}

/// The tangents of a primitive in words; counts of nothing are left out.
fn told(written: &Written) -> String {
    let Written { counts, vertices_before, vertices_after, .. } = written;
    let mut text = format!("TEXCOORD_{} ({})", written.uv_set, written.uv_reason);
    text += &format!(
        ", {}, {}",
        counted(counts.triangles, "triangle", "triangles"),
        counted(*vertices_before, "vertex", "vertices")
    );
    if vertices_after != vertices_before {
        text += &format!(" became {}", HumanCount(*vertices_after as u64));
    }
    let remarks = [
        (counts.split_vertices, "vertex split", "vertices split"),
        (counts.mirrored_edges, "mirrored edge", "mirrored edges"),
        (counts.degenerate_triangles, "degenerate triangle", "degenerate triangles"),
        (counts.uv_degenerate_triangles, "UV-degenerate triangle", "UV-degenerate triangles"),
        (counts.non_finite_corners, "non-finite corner", "non-finite corners"),
        (counts.repaired_corners, "unusable corner", "unusable corners"),
        (counts.merged_vertices, "mirrored seam vertex not split", "mirrored seam vertices not split"),
        (counts.mixed_sign_triangles, "triangle with both signs", "triangles with both signs"),
        (written.morph_targets, "morph target", "morph targets"),
        (
            written.regrouped_corners,
            "morphed corner grouped as the base is",
            "morphed corners grouped as the base is",
        ),
        (
            written.conflicting_corners,
            "morphed corner unlike its vertex",
            "morphed corners unlike their vertices",
        ),
    ];
    for (count, one, many) in remarks.into_iter().filter(|remark| remark.0 > 0) {
        text += &format!(", {}", counted(count, one, many));
    }
    text
}

fn finish(report: TangentsReport, arguments: &TangentsArguments, messages: &Messages, start: Instant) -> u8 {
    for error in report.files.iter().filter_map(|file| file.error.as_ref()) {
        messages.error(error);
    }
    if report.totals.failed < report.totals.files || report.totals.files > 1 {
        messages.say(&total(&report, start));
    }
    if arguments.talk.json {
        let written = to_json(&report).map_err(std::io::Error::from).and_then(|text| write_stdout(&text));
        if let Err(error) = written {
            messages.error(&format!("the report cannot be written: {error}"));
            return exit::FAILED;
        }
    }
    if report.totals.failed > 0 { exit::FAILED } else { exit::DONE }
}

/// The last line: what became of all files and primitives.
fn total(report: &TangentsReport, start: Instant) -> String {
    let sum =
        |of: fn(&Totals) -> usize| report.files.iter().map(|file| of(&file.summary.totals)).sum::<usize>();
    let mut text = format!(
        "{} got tangents, {} kept, {} left alone in {}",
        counted(sum(|totals| totals.written), "primitive", "primitives"),
        sum(|totals| totals.kept),
        sum(|totals| totals.skipped),
        counted(report.totals.files - report.totals.failed, "file", "files"),
    );
    if report.totals.failed > 0 {
        text += &format!(", {} failed", counted(report.totals.failed, "file", "files"));
    }
    text + &format!("; {:.2} s", start.elapsed().as_secs_f32())
}

fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{} {}", HumanCount(count as u64), if count == 1 { one } else { many })
}

fn size_of(input: &Input) -> u64 {
    match input {
        Input::File(path) => Path::metadata(path).map_or(0, |metadata| metadata.len()),
        Input::Stdin => 0,
    }
}
