//! Messages and a progress bar on standard error; results on standard output.

use std::cell::Cell;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::thread;
use std::time::Duration;

use anstyle::{AnsiColor, Style};
use darboux::internal::vertex_progress::VertexProgress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::text::{printable, sentence};

/// Prints messages. They are coloured on a terminal unless NO_COLOR is set; a closed standard error is
/// ignored.
pub struct Messages {
    quiet: bool,
    progress: ProgressBar,
    vertex: VertexProgress,
}

/// The progress on one file; dropping it marks the file as finished.
pub struct FileProgress<'a> {
    progress: &'a ProgressBar,
    /// Progress on a vertex with very many faces. All files share it: it shows one such vertex at a time.
    pub vertex: &'a VertexProgress,
    byte_length: u64,
    finished_bytes: Cell<u64>,
}

/// The progress bar appears after this time.
const PROGRESS_DELAY: Duration = Duration::from_millis(700);

/// The time between two frames of the progress bar.
const FRAME: Duration = Duration::from_millis(200);

impl Messages {
    /// `quiet`: print errors and the summary only, and no progress bar.
    pub fn new(quiet: bool) -> Self {
        let progress = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::hidden());
        let style = ProgressStyle::with_template("{bar:30} {percent:>3} % {elapsed} {prefix}{wide_msg}");
        progress.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Self { quiet, progress, vertex: VertexProgress::default() }
    }

    /// Starts the progress bar; inputs of `byte_length` bytes in total are 100 %.
    pub fn start(&self, byte_length: u64) {
        self.progress.set_length(byte_length);
        if self.quiet {
            return;
        }
        let (progress, vertex) = (self.progress.clone(), self.vertex.clone());
        let show = move || {
            thread::sleep(PROGRESS_DELAY);
            if !progress.is_finished() {
                progress.set_draw_target(ProgressDrawTarget::stderr());
            }
            while !progress.is_finished() {
                let of_vertex = vertex.percent();
                let prefix =
                    of_vertex.map(|percent| format!("{percent} % of a vertex with very many faces, "));
                progress.set_prefix(prefix.unwrap_or_default());
                // Not `enable_steady_tick`: it starts a thread of its own, and panics where the system
                // refuses one.
                progress.tick();
                thread::sleep(FRAME);
            }
        };
        let _work_goes_on_without = thread::Builder::new().spawn(show);
    }

    /// Starts the progress of one file.
    pub fn file(&self, name: &str, byte_length: u64) -> FileProgress<'_> {
        self.progress.set_message(printable(name).into_owned());
        FileProgress {
            progress: &self.progress,
            vertex: &self.vertex,
            byte_length,
            finished_bytes: Cell::new(0),
        }
    }

    /// Removes the progress bar.
    pub fn end_progress(&self) {
        self.progress.finish_and_clear();
    }

    /// Prints what was done.
    pub fn say(&self, text: &str) {
        if !self.quiet {
            self.summary(text);
        }
    }

    /// Prints what was done, with `--quiet` as well.
    pub fn summary(&self, text: &str) {
        self.print("", Style::new(), text);
    }

    /// Prints a warning.
    pub fn warn(&self, text: &str) {
        if !self.quiet {
            self.print("warning: ", AnsiColor::Yellow.on_default().bold(), text);
        }
    }

    /// Prints an error.
    pub fn error(&self, text: &str) {
        self.print("error: ", AnsiColor::Red.on_default().bold(), text);
    }

    fn print(&self, label: &str, style: Style, text: &str) {
        let text = sentence(text);
        self.progress.suspend(|| {
            let _closed_is_no_fault = writeln!(anstream::stderr(), "{style}{label}{style:#}{text}");
        });
    }
}

impl FileProgress<'_> {
    /// `finished` of `total` units of this file are finished.
    pub fn set(&self, finished: usize, total: usize) {
        let bytes = (self.byte_length as f64 * finished as f64 / total.max(1) as f64) as u64;
        self.progress.inc(bytes.saturating_sub(self.finished_bytes.replace(bytes)));
    }
}

impl Drop for FileProgress<'_> {
    fn drop(&mut self) {
        self.set(1, 1);
    }
}

/// Writes all of `bytes` to standard output. A closed pipe is not an error: its reader has read enough.
pub fn write_stdout(bytes: &[u8]) -> io::Result<()> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}

/// Whether standard output is a terminal.
pub fn stdout_is_terminal() -> bool {
    io::stdout().is_terminal()
}
