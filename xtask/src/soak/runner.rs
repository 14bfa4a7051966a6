//! Runs one case: once, with a signal in between, several times at once, or as a server.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;
use std::{fs, io, thread};

use rustix::process::Signal as SystemSignal;

use super::case::{Action, Case, Content, Signal};
use super::child::{self, EndedRun, ResourceUse};
use super::inputs::images::png_is_readable;
use super::program::Program;
use super::random::Random;
use super::tree::{self, Tree, WORK, is_temporary};
use super::verdict::{BrokenPromise, judge, limits, outputs};
use super::view;

/// What a case gave.
#[derive(Default)]
pub struct Outcome {
    /// The exit code of each run; `None` for one that a signal ended.
    pub codes: Vec<Option<i32>>,
    /// The most that a run used.
    pub used: ResourceUse,
    /// How many runs were sent a signal.
    pub signals: usize,
    /// How many outputs were read again.
    pub reopened: usize,
    pub broken: Vec<BrokenPromise>,
}

/// The processes of [`Action::Together`].
const PROCESSES: usize = 4;

/// The extensions of models.
const MODELS: [&str; 7] = ["glb", "gltf", "vrm", "obj", "ply", "stl", "fbx"];

/// The folders of a case that runs.
struct CaseFolders<'a> {
    program: &'a Program,
    case: &'a Case,
    /// The files of the case.
    files: &'a Path,
    /// The standard streams of its processes.
    streams: &'a Path,
}

/// Runs a case in `folder`, whose content is replaced. Errors: the system refuses what the test itself needs.
pub fn run(program: &Program, case: &Case, random: &mut Random, folder: &Path) -> io::Result<Outcome> {
    let [files, streams] = ["case", "streams"].map(|name| folder.join(name));
    fs::create_dir_all(&streams)?;
    let room = CaseFolders { program, case, files: &files, streams: &streams };
    let mut outcome = Outcome::default();
    match case.action {
        Action::Run => room.run_once(&mut outcome).map(drop)?,
        Action::Kill(signal) => room.run_killed(signal, random, &mut outcome)?,
        Action::Together => room.run_together(&mut outcome)?,
        Action::View => {
            tree::make(&files, case)?;
            let command = &mut room.command();
            view::run(command, &streams, case.input_size(), random, &mut outcome.used, &mut outcome.broken)?;
            outcome.codes.push(Some(0));
        }
    }
    Ok(outcome)
}

impl CaseFolders<'_> {
    /// The command line of the case, in its folder and with its limits.
    fn command(&self) -> Command {
        let mut command = match self.case.shell_limit {
            Some(limit) => {
                let mut shell = Command::new("sh");
                shell.args(["-c", &format!("{limit} && exec \"$0\" \"$@\"")]).arg(&self.program.path);
                shell
            }
            None => Command::new(&self.program.path),
        };
        command.args(&self.case.arguments).current_dir(self.files.join(WORK)).env_remove("XDG_RUNTIME_DIR");
        command.envs(self.case.variables.iter().map(|(name, value)| (name, value)));
        command
    }

    /// Runs the command line in a new folder, and judges the run. Returns its time.
    fn run_once(&self, outcome: &mut Outcome) -> io::Result<Duration> {
        tree::make(self.files, self.case)?;
        let before = tree::read(self.files)?;
        let ended = child::run(&mut self.command(), self.streams, &self.case.stdin, limits(self.case), None)?;
        outcome.count(&ended);
        let after = tree::read(self.files)?;
        outcome.broken.extend(judge(self.case, &ended, &before, &after));
        if ended.status.success() {
            self.save_stdout(&ended.stdout)?;
        }
        self.reopen(&before, outcome)?;
        Ok(ended.used.wall)
    }

    /// Runs the command line to its end, then in a new folder with a signal at a random moment, then again in
    /// what this left.
    fn run_killed(&self, signal: Signal, random: &mut Random, outcome: &mut Outcome) -> io::Result<()> {
        let time = self.run_once(outcome)?.mul_f32(1.1 * random.fraction());
        tree::make(self.files, self.case)?;
        let before = tree::read(self.files)?;
        let kind = match signal {
            Signal::Interrupt => SystemSignal::INT,
            Signal::Terminate => SystemSignal::TERM,
            Signal::Kill => SystemSignal::KILL,
        };
        let limits = limits(self.case);
        let ended = child::run(&mut self.command(), self.streams, &[], limits, Some((kind, time)))?;
        outcome.count(&ended);
        outcome.signals += 1;
        let left = tree::read(self.files)?;
        if signal != Signal::Kill {
            outcome.temporaries(&left, "a signal");
        }
        self.reopen(&before, outcome)?;
        let ended = child::run(&mut self.command(), self.streams, &[], limits, None)?;
        outcome.count(&ended);
        let after = tree::read(self.files)?;
        outcome.temporaries(&after, "the next run");
        let left = left.into_iter().filter(|(path, _)| !is_temporary(path)).collect();
        outcome.broken.extend(judge(self.case, &ended, &left, &after));
        self.reopen(&before, outcome)
    }

    fn run_together(&self, outcome: &mut Outcome) -> io::Result<()> {
        tree::make(self.files, self.case)?;
        let before = tree::read(self.files)?;
        let ended: Vec<io::Result<EndedRun>> = thread::scope(|scope| {
            let start = |number: usize| {
                let streams = self.streams.join(number.to_string());
                scope.spawn(move || {
                    fs::create_dir_all(&streams)?;
                    child::run(&mut self.command(), &streams, &[], limits(self.case), None)
                })
            };
            let threads: Vec<_> = (0..PROCESSES).map(start).collect();
            threads
                .into_iter()
                .map(|thread| thread.join().unwrap_or_else(|_| Err(io::Error::other("a thread failed"))))
                .collect()
        });
        let after = tree::read(self.files)?;
        for ended in ended {
            let ended = ended?;
            outcome.count(&ended);
            outcome.broken.extend(judge(self.case, &ended, &before, &after));
        }
        self.reopen(&before, outcome)
    }

    /// Puts a model or image that was written to standard output beside the other outputs.
    fn save_stdout(&self, bytes: &[u8]) -> io::Result<()> {
        let extension = match bytes.get(..4) {
            Some(b"glTF") => "glb",
            Some(b"\x89PNG") => "png",
            _ => return Ok(()),
        };
        fs::write(self.files.join(WORK).join(format!("stdout.{extension}")), bytes)
    }

    /// Reads every output with the program itself, and images with the decoder of PNG.
    fn reopen(&self, before: &Tree, outcome: &mut Outcome) -> io::Result<()> {
        let after = tree::read(self.files)?;
        // A copy of an input is as readable as the input.
        let is_copy = |bytes: &[u8]| {
            self.case
                .files
                .iter()
                .any(|(_, content)| matches!(content, Content::Bytes(input) if input == bytes))
        };
        for (path, bytes) in outputs(before, &after).filter(|(_, bytes)| !is_copy(bytes)) {
            outcome.reopened += 1;
            let problem = if path.extension().is_some_and(|extension| extension == "png") {
                (!png_is_readable(bytes)).then(|| "no readable PNG".to_owned())
            } else {
                self.inspect(self.files, path)?
            };
            if let Some(problem) = problem.filter(|_| self.inputs_are_readable().unwrap_or(true)) {
                outcome.broken.push(BrokenPromise {
                    kind: "unreadable",
                    detail: format!("{}: {problem}", path.display()),
                });
            }
        }
        Ok(())
    }

    /// Whether every model of the case can be read. An output of one whose data are wrong may be as wrong.
    fn inputs_are_readable(&self) -> io::Result<bool> {
        let inputs = self.streams.join("inputs");
        tree::make(&inputs, self.case)?;
        if !self.case.stdin.is_empty() {
            fs::write(inputs.join(WORK).join("stdin.glb"), &self.case.stdin)?;
        }
        let is_model =
            |path: &&PathBuf| path.extension().is_some_and(|kind| MODELS.iter().any(|model| kind == *model));
        for path in tree::read(&inputs)?.keys().filter(is_model) {
            if self.inspect(&inputs, path)?.is_some() {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Why a model cannot be read; `None` if it can.
    fn inspect(&self, folder: &Path, path: &Path) -> io::Result<Option<String>> {
        let mut command = Command::new(&self.program.path);
        command.args(["inspect", "--quiet"]).current_dir(folder).env_remove("XDG_RUNTIME_DIR");
        for option in ["--allow-outside", "--memory-limit"] {
            if self.case.has(option) {
                command.arg(option);
                command.args(
                    self.case.value_of(option).filter(|_| option == "--memory-limit").map(OsString::from),
                );
            }
        }
        let mut limits = limits(self.case);
        limits.memory = u64::MAX;
        let ended = child::run(command.arg("--").arg(path), self.streams, &[], limits, None)?;
        let text = String::from_utf8_lossy(&ended.stderr).into_owned();
        // --raw writes the conventions of other programs.
        let is_readable = ended.status.success() || text.contains("its vertices are in the convention");
        Ok((!is_readable).then_some(text))
    }
}

impl Outcome {
    fn count(&mut self, ended: &EndedRun) {
        self.codes.push(ended.status.code());
        self.used.memory = self.used.memory.max(ended.used.memory);
        self.used.processor = self.used.processor.max(ended.used.processor);
        self.used.wall = self.used.wall.max(ended.used.wall);
    }

    fn temporaries(&mut self, tree: &Tree, after: &str) {
        for path in tree.keys().filter(|path| is_temporary(path)) {
            self.broken.push(BrokenPromise {
                kind: "left behind",
                detail: format!("{} after {after}", path.display()),
            });
        }
    }
}
