//! What every run must keep: exit codes, messages, inputs, outputs, limits.

use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::time::Duration;

use super::case::{Case, Content};
use super::child::{EndedRun, Limits};
use super::tree::{Tree, WORK, is_temporary};

/// A promise that was broken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BrokenPromise {
    pub kind: &'static str,
    pub detail: String,
}

/// The memory that every run may take, beside a multiple of its input.
const BASE_MEMORY: u64 = 256 << 20;

/// How often a refused input may fit into the memory that the run takes beside [`BASE_MEMORY`].
const REFUSED_INPUT: u64 = 4;

/// The same for an input that is read: the default of `--memory-limit`, which bounds what is decoded.
const READ_INPUT: u64 = 64;

/// What the program itself takes in addition, and an adapter that draws with the processor.
const PROGRAM: u64 = 64 << 20;
const ADAPTER: u64 = 512 << 20;

/// The most characters of a line of messages: a sentence is cut after 1,000, and its labels and ends come in
/// addition.
const LONGEST_LINE: usize = 1100;

/// The exit code of a Rust program that panicked.
const PANIC: i32 = 101;

/// What a run of this case may take.
pub fn limits(case: &Case) -> Limits {
    // Where there is no GPU, an adapter on the processor compiles the shaders.
    let draws = case.has("render") || case.has("gpu");
    let computes_texels = draws || case.has("bake") || case.has("--space");
    Limits {
        processor: Duration::from_secs(if computes_texels { 40 } else { 15 }),
        idle: Duration::from_secs(60),
        wall: Duration::from_secs(3600),
        memory: BASE_MEMORY + READ_INPUT * case.input_size() + PROGRAM + if draws { ADAPTER } else { 0 },
    }
}

/// All promises that a run broke, by its end, its messages and its files.
pub fn judge(case: &Case, ended: &EndedRun, before: &Tree, after: &Tree) -> Vec<BrokenPromise> {
    let mut broken = Vec::new();
    end(case, ended, &mut broken);
    if ended.over.is_none() {
        messages(case, ended, &mut broken);
        files(case, ended, before, after, &mut broken);
    }
    broken
}

fn add(broken: &mut Vec<BrokenPromise>, kind: &'static str, detail: impl Into<String>) {
    broken.push(BrokenPromise { kind, detail: detail.into() });
}

fn end(case: &Case, ended: &EndedRun, broken: &mut Vec<BrokenPromise>) {
    if let Some(limit) = ended.over {
        let used = ended.used;
        let detail = format!(
            "killed after {:.1} s of the processor, {:.1} s, {} MB for {} bytes of input",
            used.processor.as_secs_f32(),
            used.wall.as_secs_f32(),
            used.memory >> 20,
            case.input_size()
        );
        return add(broken, limit, detail);
    }
    let memory = ended.used.memory;
    if ended.status.code() == Some(1) && memory > BASE_MEMORY + REFUSED_INPUT * case.input_size() {
        let detail = format!("{} MB to refuse {} bytes of input", memory >> 20, case.input_size());
        add(broken, "memory", detail);
    }
    match (ended.status.code(), ended.status.signal()) {
        (Some(PANIC), _) => add(broken, "panic", last_line(&ended.stderr)),
        (Some(code), _) if !is_expected(case, code) => {
            add(
                broken,
                "exit code",
                format!("{code} instead of {:?}: {}", case.expected.codes, last_line(&ended.stderr)),
            );
        }
        (None, signal) => {
            add(broken, "crash", format!("signal {}: {}", signal.unwrap_or(0), last_line(&ended.stderr)))
        }
        _ => {}
    }
}

/// A comparison exits with 3 where files differ by more than its tolerance.
fn is_expected(case: &Case, code: i32) -> bool {
    case.expected.codes.contains(&code) || (code == 3 && case.has("--tolerance"))
}

fn last_line(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes);
    text.lines().next_back().unwrap_or_default().chars().take(300).collect()
}

fn messages(case: &Case, ended: &EndedRun, broken: &mut Vec<BrokenPromise>) {
    let text = String::from_utf8_lossy(&ended.stderr);
    if text.contains("this is a defect of darboux") || text.contains("panicked at") {
        add(broken, "panic", last_line(&ended.stderr));
    }
    let controls = |text: &str| text.chars().any(|c| c.is_control() && c != '\n');
    if controls(&text) || text.contains(is_direction_mark) {
        add(broken, "message", format!("control characters: {:?}", last_line(&ended.stderr)));
    }
    let writes_text = !case.has("-") || case.has("-o");
    if writes_text && !is_stdout_a_model(case) && controls(&String::from_utf8_lossy(&ended.stdout)) {
        add(broken, "message", "control characters on standard output");
    }
    if let Some(line) = text.lines().find(|line| line.chars().count() > LONGEST_LINE) {
        add(broken, "message", format!("a line of {} characters", line.chars().count()));
    }
    if !text.contains(case.expected.words) {
        add(broken, "message", format!("does not say {}: {}", case.expected.words, last_line(&ended.stderr)));
    }
    sentences(case, ended, &text, broken);
}

fn is_direction_mark(c: char) -> bool {
    matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

fn is_stdout_a_model(case: &Case) -> bool {
    case.value_of("-o").is_some_and(|output| output == "-") || (case.has("-") && !case.has("-o"))
}

/// Subcommands that print nothing to standard error but warnings, errors, and what they did with the output.
const SILENT: [&str; 3] = ["compare", "inspect", "render"];

fn sentences(case: &Case, ended: &EndedRun, text: &str, broken: &mut Vec<BrokenPromise>) {
    let errors = text.lines().filter(|line| line.starts_with("error: ")).count();
    match ended.status.code() {
        Some(0) if errors > 0 && !has_findings(case, ended) => {
            add(broken, "message", format!("exit code 0 with an error: {}", last_line(text.as_bytes())))
        }
        Some(1 | 2) if errors == 0 && !has_findings(case, ended) => {
            add(broken, "message", format!("exit code without an error: {}", last_line(text.as_bytes())));
        }
        _ => {}
    }
    let is_silent =
        SILENT.iter().any(|subcommand| case.arguments.first().is_some_and(|first| first == subcommand));
    let output = case.value_of("-o").map_or("error: ".into(), |output| output.to_string_lossy());
    let is_labelled =
        |line: &str| ["error: ", "warning: ", &output].iter().any(|start| line.starts_with(*start));
    if is_silent
        && ended.status.code() != Some(2)
        && let Some(line) = text.lines().find(|line| !is_labelled(line))
    {
        add(broken, "message", format!("a line that is neither a warning nor an error: {line}"));
    }
}

/// Whether a check was done: it printed the count of its findings, which may be errors, or of the edits that
/// it plans.
fn has_findings(case: &Case, ended: &EndedRun) -> bool {
    let is_count = |line: &str| {
        (line.contains(" finding") || line.contains(" planned in ") || line.ends_with(" worth knowing"))
            && !line.starts_with("error: ")
    };
    let counts = |stream: &[u8]| String::from_utf8_lossy(stream).lines().any(is_count);
    case.has("check") && (case.has("--json") || counts(&ended.stderr) || counts(&ended.stdout))
}

/// Inputs must be as they were, and a run that failed on its only input must leave nothing.
fn files(case: &Case, ended: &EndedRun, before: &Tree, after: &Tree, broken: &mut Vec<BrokenPromise>) {
    let code = ended.status.code();
    let is_done = matches!(code, Some(0 | 3)) || has_findings(case, ended);
    let may_replace = case.has("--in-place") && is_done;
    for (path, content) in before {
        let is_outside = !path.starts_with(WORK);
        if after.get(path) != Some(content) && (is_outside || !(may_replace || may_change(case, path))) {
            add(broken, "input touched", path.display().to_string());
        }
    }
    for path in after.keys().filter(|path| !before.contains_key(*path)) {
        if !path.starts_with(WORK) {
            add(broken, "written outside", path.display().to_string());
        } else if is_temporary(path) {
            add(broken, "left behind", path.display().to_string());
        } else if !is_done && !has_several_inputs(before) && !may_change(case, path) {
            add(broken, "left behind", format!("{} after exit code {code:?}", path.display()));
        }
    }
}

/// A journal grows; with `--in-place` and several inputs some may be replaced before one fails.
fn may_change(case: &Case, path: &Path) -> bool {
    path.ends_with("darboux-journal.jsonl") || (case.has("--in-place") && case.has("models"))
}

fn has_several_inputs(before: &Tree) -> bool {
    before.keys().any(|path| path.starts_with(Path::new(WORK).join("models")))
}

/// The files that a run wrote and that must be readable: models and pictures that are new or different.
pub fn outputs<'a>(before: &'a Tree, after: &'a Tree) -> impl Iterator<Item = (&'a Path, &'a [u8])> {
    after.iter().filter_map(move |(path, content)| {
        let extension = path.extension()?.to_str()?;
        let Content::Bytes(bytes) = content else { return None };
        let is_output = ["glb", "gltf", "vrm", "obj", "ply", "png"].contains(&extension)
            && before.get(path) != Some(content);
        is_output.then_some((path.as_path(), bytes.as_slice()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::soak::child::ResourceUse;

    fn ended(code: i32, stderr: &str) -> EndedRun {
        let status = std::process::ExitStatus::from_raw(code << 8);
        EndedRun {
            status,
            stdout: Vec::new(),
            stderr: stderr.into(),
            used: ResourceUse::default(),
            over: None,
        }
    }

    fn kinds(case: &Case, ended: &EndedRun, after: &Tree) -> Vec<&'static str> {
        let before = Tree::from([("work/a.glb".into(), Content::Bytes(vec![1]))]);
        judge(case, ended, &before, after).iter().map(|broken| broken.kind).collect()
    }

    fn tree(files: &[(&str, u8)]) -> Tree {
        files.iter().map(|&(path, byte)| (path.into(), Content::Bytes(vec![byte]))).collect()
    }

    #[test]
    fn a_good_run_breaks_no_promise() {
        let case = Case::new(["tangents", "a.glb"]);
        let after = tree(&[("work/a.glb", 1), ("work/a.tangents.glb", 2)]);
        assert!(kinds(&case, &ended(0, "a.glb -> a.tangents.glb\n"), &after).is_empty());
        assert!(kinds(&case, &ended(1, "error: a.glb: x\n"), &tree(&[("work/a.glb", 1)])).is_empty());
    }

    #[test]
    fn findings_of_a_check_are_no_failure() {
        let case = Case::new(["check", "a.glb", "--fix", "-o", "b.glb"]);
        let after = tree(&[("work/a.glb", 1), ("work/b.glb", 2)]);
        let found = "error: a.glb: the image: map-height: it is grey\n1 finding repaired, 1 that --fix \
             cannot repair\n";
        for code in [0, 1] {
            assert!(kinds(&case, &ended(code, found), &after).is_empty(), "{code}");
        }
        assert_eq!(kinds(&case, &ended(1, "error: a.glb: it is no model\n"), &after), ["left behind"]);
    }

    #[test]
    fn every_broken_promise_is_found() {
        let case = Case::new(["inspect", "a.glb"]);
        let same = tree(&[("work/a.glb", 1)]);
        for (code, stderr, after, kind) in [
            (101, "error: x\n", &same, "panic"),
            (2, "error: x\n", &same, "exit code"),
            (1, "", &same, "message"),
            (0, "error: x\n", &same, "message"),
            (1, "error: a\u{1b}[2J\n", &same, "message"),
            (1, "error: a\nforged\n", &same, "message"),
            (1, "error: x\n", &tree(&[("work/a.glb", 2)]), "input touched"),
            (1, "error: x\n", &tree(&[("work/a.glb", 1), ("work/b.glb", 1)]), "left behind"),
            (0, "", &tree(&[("work/a.glb", 1), ("work/.darboux-a1B2c3", 1)]), "left behind"),
            (0, "", &tree(&[("work/a.glb", 1), ("b.glb", 1)]), "written outside"),
        ] {
            assert_eq!(kinds(&case, &ended(code, stderr), after), [kind], "{code} {stderr:?}");
        }
        let long = ended(1, &format!("error: {}\n", "x".repeat(2000)));
        assert_eq!(kinds(&case, &long, &same), ["message"]);
    }
}
