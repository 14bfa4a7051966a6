//! Checks files, several at the same time.

use std::num::{NonZero, NonZeroUsize};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use darboux_check::{Finding, ReportedFindings, check_document};
use darboux_io::gltf::Document;

use super::arguments::FindingOptions;
use super::folder;
use super::model::Model;
use super::report::{CheckedFile, ReportedMap};
use crate::documents::Source;
use crate::inputs::{FoundInputs, Input};
use crate::memory::JobMemory;
use crate::net;
use crate::options::reading::ReadOptions;
use crate::terminal::Messages;

/// How files are checked.
pub struct Checks<'a> {
    /// What is checked, and which findings are reported.
    pub findings: &'a FindingOptions,
    /// The model that images are checked on.
    pub model: Model,
    pub reading: ReadOptions,
    /// How many files are checked at the same time; none: one per processor core.
    pub jobs: Option<NonZero<u16>>,
}

impl Checks<'_> {
    /// Checks all files that were found, in their order, after those that were not. `messages`: where a
    /// progress bar is shown meanwhile.
    pub fn check_found(&self, found: &FoundInputs, messages: &Messages) -> Vec<CheckedFile> {
        let inputs: Vec<&Input> = found.files.iter().map(|(input, _)| input).collect();
        let failed = found.failed.iter().map(|(path, reason)| {
            let maps = folder::maps_instead(path).map_or(String::new(), |clause| format!("; {clause}"));
            failed(path.display().to_string(), format!("{}: {reason}{maps}", path.display()))
        });
        messages.start(inputs.iter().map(|input| input.byte_length()).sum());
        let checked = self.check_all(&inputs, messages);
        messages.end_progress();
        failed.chain(checked).collect()
    }

    fn check_all(&self, inputs: &[&Input], messages: &Messages) -> Vec<CheckedFile> {
        let next = AtomicUsize::new(0);
        let checked: Vec<OnceLock<CheckedFile>> = inputs.iter().map(|_| OnceLock::new()).collect();
        let memory = JobMemory::of_process();
        let work = || {
            loop {
                let number = next.fetch_add(1, Ordering::Relaxed);
                let Some(input) = inputs.get(number) else { return };
                let _share = memory.wait_for(|| input.memory(&self.reading.load_options()));
                let _progress = messages.file(&input.to_string(), input.byte_length());
                // Every number is taken once.
                _ = checked[number].set(self.check_file(input, messages));
            }
        };
        let cores = || thread::available_parallelism().map_or(1, NonZeroUsize::get);
        let jobs = self.jobs.map_or_else(cores, |jobs| usize::from(jobs.get()));
        thread::scope(|scope| {
            for _ in 1..jobs.min(inputs.len()) {
                // Without a further thread, this one does the work.
                _ = thread::Builder::new().spawn_scoped(scope, work);
            }
            work();
        });
        checked.into_iter().filter_map(OnceLock::into_inner).collect()
    }

    fn check_file(&self, input: &Input, messages: &Messages) -> CheckedFile {
        let limit = self.reading.load_options().memory_limit;
        let options = self.findings.check_options().with_memory_limit(limit);
        let name = input.to_string();
        let reported = |findings: Vec<Finding>, map: Option<ReportedMap>, document: Option<&Document>| {
            let wanted = findings.into_iter().filter(|finding| self.findings.reports(finding.code));
            let ReportedFindings { findings, diagnosis, importer_note, warnings, .. } =
                ReportedFindings::new(wanted, document, &options);
            let input = name.clone();
            CheckedFile { input, error: None, map, importer_note, diagnosis, findings, warnings }
        };
        let check = || {
            let source = Source::new(input)?;
            match source.image()? {
                Some(file) => {
                    let checked = self.model.check_image(&file, &options)?;
                    let map = ReportedMap::of(&checked);
                    Ok(reported(checked.findings, map, None))
                }
                None => {
                    let document = source.load(&self.reading)?;
                    warn_of_source(&document, messages);
                    let findings = check_document(&document, &options).map_err(|error| error.to_string())?;
                    Ok(reported(findings, None, Some(&document)))
                }
            }
        };
        net::catch(input, check).unwrap_or_else(|sentence: String| failed(name.clone(), sentence))
    }
}

/// Says what of a file in another format than glTF is not in its document, as textures that are missing:
/// no finding can name it.
fn warn_of_source(document: &Document, messages: &Messages) {
    if document.provenance().is_some() {
        document
            .warnings()
            .iter()
            .for_each(|warning| messages.warn(&format!("{}: {warning}", document.name())));
    }
}

fn failed(input: String, sentence: String) -> CheckedFile {
    CheckedFile {
        input,
        error: Some(sentence),
        map: None,
        importer_note: None,
        diagnosis: String::new(),
        findings: Vec::new(),
        warnings: Vec::new(),
    }
}
