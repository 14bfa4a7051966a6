//! `darboux tangents`: every file read, given tangents, written and reported.

use std::path::{Path, PathBuf};
use std::time::Instant;

use darboux_io::Error;
use darboux_io::gltf::{
    Document, Outcome, PrimitiveSummary, SaveOptions, Summary, TangentsOptions, Written, add_tangents,
};
use indicatif::HumanCount;
use serde::Serialize;

use crate::arguments::TangentsArguments;
use crate::jobs::{self, Found, Job, Output};
use crate::messages::{self, Messages};
use crate::{DONE, FAILED, USAGE, interrupt, models};

/// What `--json` prints: one document for all files.
#[derive(Serialize)]
struct Report {
    /// The version of this program.
    version: &'static str,
    /// One entry per input, in order.
    files: Vec<FileReport>,
    /// How many inputs failed.
    failed: usize,
}

/// What became of one input.
#[derive(Serialize)]
struct FileReport {
    input: String,
    /// The files written, the model last; empty where nothing was, or the model went to standard output.
    outputs: Vec<PathBuf>,
    /// Why it failed, in one sentence; null where it did not.
    error: Option<String>,
    #[serde(flatten)]
    summary: Option<Summary>,
}

/// Runs the command; returns the exit code.
pub fn run(arguments: &TangentsArguments) -> u8 {
    let found = jobs::find(&arguments.inputs, arguments.out_dir.as_deref());
    let messages = Messages::new(arguments.quiet, models::total_bytes(&found));
    let jobs = match plan(arguments, &found) {
        Ok(jobs) => jobs,
        Err(usage) => {
            messages.error(&usage);
            return USAGE;
        }
    };
    let mut files = unsearched(&found, &messages);
    for job in &jobs {
        messages.working_on(&job.input.to_string());
        files.push(one_file(arguments, job, &messages));
        messages.done(models::bytes(&job.input));
    }
    messages.end_progress();
    let failed = files.iter().filter(|file| file.error.is_some()).count();
    say_totals(&files, failed, found.left_out, &messages);
    let code = if failed == 0 { DONE } else { FAILED };
    if !arguments.json {
        return code;
    }
    let report = Report { version: env!("CARGO_PKG_VERSION"), files, failed };
    match messages::write_json(&report) {
        Ok(()) => code,
        Err(error) => {
            messages.error(&format!("the report cannot be written: {error}"));
            FAILED
        }
    }
}

fn plan(arguments: &TangentsArguments, found: &Found) -> Result<Vec<Job>, String> {
    let jobs = jobs::plan(arguments, found).map_err(|usage| usage.0)?;
    if jobs.iter().any(|job| job.output == Output::Stdout) && messages::stdout_is_terminal() {
        return Err("a GLB is not for a terminal; redirect standard output or use -o FILE".into());
    }
    Ok(jobs)
}

/// Reports places that could not be searched.
fn unsearched(found: &Found, messages: &Messages) -> Vec<FileReport> {
    let report = |(path, reason): &(PathBuf, String)| {
        let error = format!("{}: {reason}", path.display());
        messages.error(&error);
        FileReport {
            input: path.display().to_string(),
            outputs: Vec::new(),
            error: Some(error),
            summary: None,
        }
    };
    found.failed.iter().map(report).collect()
}

fn one_file(arguments: &TangentsArguments, job: &Job, messages: &Messages) -> FileReport {
    let start = Instant::now();
    let mut report =
        FileReport { input: job.input.to_string(), outputs: Vec::new(), error: None, summary: None };
    match process(arguments, job, messages) {
        Ok((summary, outputs)) => {
            say_file(job, &summary, &outputs, start, messages);
            (report.summary, report.outputs) = (Some(summary), outputs);
        }
        Err(error) => {
            messages.error(&error.to_string());
            report.error = Some(error.to_string());
        }
    }
    report
}

fn process(
    arguments: &TangentsArguments,
    job: &Job,
    messages: &Messages,
) -> Result<(Summary, Vec<PathBuf>), Error> {
    if let Output::File(path) = &job.output {
        refuse_existing(arguments, path)?;
    }
    let mut document = models::read(&job.input, arguments.allow_outside)?;
    let options = TangentsOptions {
        tangents: darboux::TangentOptions { mode: arguments.mode.into(), threshold: arguments.threshold },
        overwrite: arguments.overwrite,
        only_needed: arguments.only_needed,
        strict: arguments.strict,
        apply_texture_transform: arguments.apply_texture_transform,
    };
    let name = job.input.to_string();
    let mut summary = add_tangents(&mut document, &options, &mut |progress| {
        messages.working_on(&format!("{name}: {} of {} triangles", progress.done, progress.total));
    })?;
    summary.warnings.extend(document.warnings().iter().cloned());
    let outputs = save(arguments, job, &document)?;
    Ok((summary, outputs))
}

/// Says before any work that an output is in the way.
fn refuse_existing(arguments: &TangentsArguments, path: &Path) -> Result<(), Error> {
    if path.exists() && !arguments.force && !arguments.in_place {
        let problem = "exists; use --force to replace it, or name another output".into();
        return Err(Error::Output { file: path.to_path_buf(), problem });
    }
    Ok(())
}

fn save(arguments: &TangentsArguments, job: &Job, document: &Document) -> Result<Vec<PathBuf>, Error> {
    match &job.output {
        Output::Stdout => {
            let bytes = document.to_glb()?;
            messages::write_stdout(&bytes)
                .map_err(|source| Error::Write { file: job.output.to_string().into(), source })?;
            Ok(Vec::new())
        }
        Output::File(path) => {
            let _guard = interrupt::writing();
            if arguments.in_place {
                document.save_in_place()
            } else {
                document.save(path, &SaveOptions { force: arguments.force })
            }
        }
    }
}

fn say_file(job: &Job, summary: &Summary, outputs: &[PathBuf], start: Instant, messages: &Messages) {
    let totals = &summary.totals;
    let target = match (&job.output, outputs) {
        (Output::File(_), []) => "unchanged".to_owned(),
        (output, _) => format!("-> {output}"),
    };
    messages.say(&format!(
        "{} {target}: tangents for {} of {} primitives, {} triangles, {} -> {} vertices, {:.2} s",
        job.input,
        totals.written,
        summary.primitives.len(),
        HumanCount(totals.triangles as u64),
        HumanCount(totals.vertices_before as u64),
        HumanCount(totals.vertices_after as u64),
        start.elapsed().as_secs_f32(),
    ));
    for primitive in &summary.primitives {
        messages.say(&format!("  {}", sentence(primitive)));
    }
    for warning in &summary.warnings {
        messages.warn(warning);
    }
}

/// What was done to a primitive, for people.
fn sentence(PrimitiveSummary { name, outcome, .. }: &PrimitiveSummary) -> String {
    match outcome {
        Outcome::Written(written) => format!("{name}: {}", details(written)),
        Outcome::Kept { reason } => format!("{name}: kept: {reason}"),
        Outcome::Skipped { reason } => format!("{name}: skipped: {reason}"),
        other => format!("{name}: {other:?}"),
    }
}

fn details(written: &Written) -> String {
    let counts = &written.counts;
    let mut text = format!(
        "TEXCOORD_{} ({}), {} triangles",
        written.uv_set,
        written.uv_reason,
        HumanCount(counts.triangles as u64)
    );
    let notes = [
        (counts.split_vertices, "vertices split"),
        (counts.mirrored_edges, "mirrored edges"),
        (counts.degenerate_triangles, "degenerate triangles"),
        (counts.uv_degenerate_triangles, "UV-degenerate triangles"),
        (counts.repaired_corners, "corners without a usable tangent"),
        (counts.mixed_sign_triangles, "triangles with mixed signs"),
        (counts.non_finite_corners, "corners with NaN or infinity"),
        (written.morph_targets, "morph targets"),
        (written.regrouped_corners, "corners that a fresh run on a morph target would group otherwise"),
        (written.conflicting_corners, "corners whose morph deltas disagree at one vertex"),
    ];
    for (count, what) in notes.into_iter().filter(|(count, _)| *count > 0) {
        text.push_str(&format!(", {} {what}", HumanCount(count as u64)));
    }
    text
}

/// The end of a batch: how many failed, and which.
fn say_totals(files: &[FileReport], failed: usize, left_out: usize, messages: &Messages) {
    if left_out > 0 {
        messages.say(&format!(
            "{left_out} files named *.tangents.* in folders were left out, as they are outputs"
        ));
    }
    if files.len() < 2 {
        return;
    }
    messages.say(&format!("{} files, {failed} failed", files.len()));
    for file in files.iter().filter(|file| file.error.is_some()) {
        messages.say(&format!("  failed: {}", file.input));
    }
}
