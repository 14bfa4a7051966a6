//! What people read, on standard error; what programs read, on standard output.

use std::cell::Cell;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::thread;
use std::time::Duration;

use anstyle::{AnsiColor, Style};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Messages to a person. They are coloured on a terminal unless NO_COLOR is set; a closed standard error is no fault.
pub struct Messages {
    quiet: bool,
    progress: ProgressBar,
}

/// How far the work on a file is. Dropped, it is at the end.
pub struct FileProgress<'a> {
    progress: &'a ProgressBar,
    /// The file's.
    bytes: u64,
    /// Of these, those that are done.
    done: Cell<u64>,
}

/// After this time there is a progress bar.
const LONG_WORK: Duration = Duration::from_millis(700);

/// The time between its frames.
const FRAME: Duration = Duration::from_millis(200);

impl Messages {
    /// `quiet`: errors only, no progress.
    pub fn new(quiet: bool) -> Self {
        let progress = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::hidden());
        let style = ProgressStyle::with_template("{bar:30} {percent:>3} % {elapsed} {wide_msg}");
        progress.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Self { quiet, progress }
    }

    /// Announces work on inputs of so many bytes, against which progress is shown if it takes long.
    pub fn start(&self, bytes: u64) {
        self.progress.set_length(bytes);
        if self.quiet {
            return;
        }
        let progress = self.progress.clone();
        let show = move || {
            thread::sleep(LONG_WORK);
            if !progress.is_finished() {
                progress.set_draw_target(ProgressDrawTarget::stderr());
                progress.enable_steady_tick(FRAME);
            }
        };
        let _work_goes_on_without = thread::Builder::new().spawn(show);
    }

    /// Begins the work on a file of so many bytes.
    pub fn file(&self, name: &str, bytes: u64) -> FileProgress<'_> {
        self.progress.set_message(name.to_owned());
        FileProgress { progress: &self.progress, bytes, done: Cell::new(0) }
    }

    /// Takes the progress bar away.
    pub fn end_progress(&self) {
        self.progress.finish_and_clear();
    }

    /// What was done.
    pub fn say(&self, text: &str) {
        if !self.quiet {
            self.print("", Style::new(), text);
        }
    }

    /// What is odd.
    pub fn warn(&self, text: &str) {
        if !self.quiet {
            self.print("warning: ", AnsiColor::Yellow.on_default().bold(), text);
        }
    }

    /// What is wrong.
    pub fn error(&self, text: &str) {
        self.print("error: ", AnsiColor::Red.on_default().bold(), text);
    }

    fn print(&self, label: &str, style: Style, text: &str) {
        self.progress.suspend(|| {
            let _closed_is_no_fault = writeln!(anstream::stderr(), "{style}{label}{style:#}{text}");
        });
    }
}

impl FileProgress<'_> {
    /// The file is done to this part.
    pub fn set(&self, done: usize, total: usize) {
        let done = (self.bytes as f64 * done as f64 / total.max(1) as f64) as u64;
        self.progress.inc(done.saturating_sub(self.done.replace(done)));
    }
}

impl Drop for FileProgress<'_> {
    fn drop(&mut self) {
        self.set(1, 1);
    }
}

/// Writes all of `bytes` to standard output. A closed pipe is no fault: its reader has what it wanted.
pub fn write_stdout(bytes: &[u8]) -> io::Result<()> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}

/// True when standard output is a terminal.
pub fn stdout_is_terminal() -> bool {
    io::stdout().is_terminal()
}
