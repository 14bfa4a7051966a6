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
    /// The bytes of the current file, and of those before it.
    file: Cell<(u64, u64)>,
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
        Self { quiet, progress, file: Cell::new((0, 0)) }
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
    pub fn start_file(&self, name: &str, bytes: u64) {
        self.file.set((bytes, self.file.get().1));
        self.progress.set_message(name.to_owned());
    }

    /// The current file is done to this part.
    pub fn progress(&self, done: usize, total: usize) {
        let (bytes, before) = self.file.get();
        self.progress.set_position(before + (bytes as f64 * done as f64 / total.max(1) as f64) as u64);
    }

    /// Ends the work on the current file.
    pub fn end_file(&self) {
        let (bytes, before) = self.file.get();
        self.file.set((0, before + bytes));
        self.progress.set_position(before + bytes);
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
