//! Decides which output file each input gets, and refuses contradictory arguments before any work is done.

use std::collections::{HashMap, HashSet};
use std::ffi::OsStr;
use std::fmt;
use std::path::{Path, PathBuf};

use darboux_io::{FileKind, wrong_output};

use crate::inputs::{FoundInputs, Input, UsageError, check_stdin};
use crate::options::files::FileOptions;
use crate::paths::{canonical, is_gltf, is_image, is_png, is_written_model, refuse_missing_folder};

/// Where a file is written to.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Output {
    Stdout,
    File(PathBuf),
}

impl fmt::Display for Output {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Output::Stdout => f.write_str("<stdout>"),
            Output::File(path) => path.display().fmt(f),
        }
    }
}

/// One input and its output.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Job {
    pub input: Input,
    pub output: Output,
}

/// What a command writes.
#[derive(Clone, Copy, Debug)]
pub struct OutputRules<'a> {
    /// The suffix of output names: model.glb becomes model.SUFFIX.glb.
    pub suffix: &'a str,
    /// Whether a JSON report goes to standard output.
    pub json: bool,
    /// Whether the command writes images as well as models.
    pub images: bool,
}

impl OutputRules<'_> {
    /// Whether a name that the user gives can be written.
    fn accepts(self, path: &Path) -> bool {
        is_written_model(path) || (self.images && is_png(path))
    }

    /// Whether an output keeps the extension of its input.
    fn keeps(self, path: &Path) -> bool {
        is_gltf(path) || (self.images && is_png(path))
    }

    /// The extension of the output of an input whose own extension cannot be written.
    fn extension_for(self, input: &Path) -> &'static str {
        if self.images && is_image(input) { "png" } else { "glb" }
    }
}

/// Returns the jobs of a command in the order of the inputs, each input once.
///
/// Errors: an output that does not fit the inputs, two inputs with one output, an output that is an input, a
/// file and a report that both go to standard output.
pub fn plan_jobs(
    options: &FileOptions,
    rules: OutputRules<'_>,
    found: &FoundInputs,
) -> Result<Vec<Job>, UsageError> {
    check_usage(options, rules)?;
    let mut jobs = Vec::new();
    let mut input_of_output: HashMap<PathBuf, &Input> = HashMap::new();
    let shared = shared_outputs(options, rules, found);
    for (input, folder) in &found.files {
        let mut output = output_of(options, rules, input, folder.as_deref(), false);
        if matches!(&output, Output::File(path) if shared.contains(&canonical(path))) {
            output = output_of(options, rules, input, folder.as_deref(), true);
        }
        if let Output::File(path) = &output {
            match input_of_output.insert(canonical(path), input) {
                Some(other) if other == input => continue,
                Some(other) => {
                    return Err(UsageError(format!(
                        "{other} and {input} would both be written to {output}; give them different folders"
                    )));
                }
                None => {}
            }
        }
        jobs.push(Job { input: input.clone(), output });
    }
    if !options.in_place {
        refuse_replaced_inputs(&jobs, &input_of_output)?;
    }
    Ok(jobs)
}

fn check_usage(options: &FileOptions, rules: OutputRules<'_>) -> Result<(), UsageError> {
    let usage = |message: &str| Err(UsageError(message.into()));
    check_stdin(&options.inputs)?;
    let stdin = options.inputs[0] == Path::new("-");
    if stdin && (options.in_place || options.out_dir.is_some()) {
        return usage("standard input has no name and no folder; use -o FILE");
    }
    if let Some(file) = options.out_dir.as_ref().filter(|path| path.exists() && !path.is_dir()) {
        return Err(UsageError(format!(
            "{} is not a folder; name a folder, or use -o FILE for a single output",
            file.display()
        )));
    }
    let Some(output) = &options.output else {
        return match rules.json && stdin {
            true => usage("the file and the report cannot both go to standard output; use -o FILE"),
            false => Ok(()),
        };
    };
    if options.inputs.len() > 1 {
        return usage("-o takes a single input; use --out-dir for several");
    }
    if options.inputs[0].is_dir() {
        return usage("-o takes a single file, but the input is a folder; use --out-dir");
    }
    if output == Path::new("-") {
        return match rules.json {
            true => usage("the file and the report cannot both go to standard output; use -o FILE"),
            false => Ok(()),
        };
    }
    if output.is_dir() {
        return Err(UsageError(format!("{} is a folder; use --out-dir", output.display())));
    }
    if !rules.accepts(output) {
        let images = if rules.images { ", or in .png for an image" } else { "" };
        let problem = wrong_output(FileKind::of(output));
        return Err(UsageError(format!("{} {problem}{images}", output.display())));
    }
    refuse_missing_folder(output).map_err(UsageError)
}

/// The outputs that several inputs would have, such as chair.glb for chair.fbx and chair.glb. Converted ones
/// among them keep the ending of their input.
fn shared_outputs(options: &FileOptions, rules: OutputRules<'_>, found: &FoundInputs) -> HashSet<PathBuf> {
    let mut input_of_output: HashMap<PathBuf, PathBuf> = HashMap::new();
    let mut shared = HashSet::new();
    for (input, folder) in &found.files {
        let output = output_of(options, rules, input, folder.as_deref(), false);
        let (Output::File(output), Input::File(input)) = (output, input) else { continue };
        let (output, input) = (canonical(&output), canonical(input));
        if input_of_output.get(&output).is_some_and(|other| *other != input) {
            shared.insert(output);
        } else {
            input_of_output.insert(output, input);
        }
    }
    shared
}

/// `keep_ending`: whether the ending of an input that is converted stays in the name.
fn output_of(
    options: &FileOptions,
    rules: OutputRules<'_>,
    input: &Input,
    folder: Option<&Path>,
    keep_ending: bool,
) -> Output {
    let path = match (&options.output, input) {
        (Some(output), _) if output != Path::new("-") => return Output::File(output.clone()),
        (Some(_), _) | (None, Input::Stdin) => return Output::Stdout,
        (None, Input::File(path)) => path,
    };
    Output::File(match &options.out_dir {
        Some(out_dir) => {
            let name = || Path::new(path.file_name().unwrap_or_default());
            let below = folder.and_then(|folder| path.strip_prefix(folder).ok());
            let output = out_dir.join(below.unwrap_or_else(name));
            match (rules.keeps(&output), keep_ending) {
                (true, _) => output,
                (false, false) => output.with_extension(rules.extension_for(path)),
                (false, true) => with_added_extension(&output, rules.extension_for(path)),
            }
        }
        None if options.in_place => path.clone(),
        None => {
            let extension = if rules.keeps(path) { path.extension() } else { None };
            let extension = extension.unwrap_or(OsStr::new(rules.extension_for(path)));
            let is_whole = keep_ending && !rules.keeps(path);
            let stem = if is_whole { path.file_name() } else { path.file_stem() };
            let mut name = stem.unwrap_or_default().to_os_string();
            name.push(format!(".{}.", rules.suffix));
            name.push(extension);
            path.with_file_name(name)
        }
    })
}

fn with_added_extension(path: &Path, extension: &str) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{extension}"));
    path.with_file_name(name)
}

fn refuse_replaced_inputs(
    jobs: &[Job],
    input_of_output: &HashMap<PathBuf, &Input>,
) -> Result<(), UsageError> {
    for job in jobs {
        let Input::File(path) = &job.input else { continue };
        if let Some(&writer) = input_of_output.get(&canonical(path)) {
            let output = if *writer == job.input {
                "its own output".into()
            } else {
                format!("the output of {writer}")
            };
            let in_place =
                if is_gltf(path) || is_png(path) { ", or use --in-place to replace inputs" } else { "" };
            return Err(UsageError(format!(
                "{} would be replaced by {output}; name another output{in_place}",
                path.display()
            )));
        }
    }
    Ok(())
}
