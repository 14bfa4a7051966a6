//! What people read, on standard error; what programs read, on standard output.

use std::io::{self, ErrorKind, IsTerminal, Write};

use anstyle::{AnsiColor, Style};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde::Serialize;

/// Messages to a person. They are coloured on a terminal unless NO_COLOR is set; a closed standard error is no fault.
pub struct Messages {
    quiet: bool,
    progress: ProgressBar,
}

impl Messages {
    /// `quiet`: errors only, no progress. `total`: the bytes of all inputs, to show progress against.
    pub fn new(quiet: bool, total: u64) -> Self {
        let progress = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::hidden());
        if !quiet && total >= LONG_WORK {
            progress.set_draw_target(ProgressDrawTarget::stderr());
            progress.set_style(
                ProgressStyle::with_template(
                    "{bar:30} {binary_bytes}/{binary_total_bytes} {elapsed} {wide_msg}",
                )
                .unwrap_or_else(|_| ProgressStyle::default_bar()),
            );
            progress.enable_steady_tick(std::time::Duration::from_millis(200));
        }
        Self { quiet, progress }
    }

    /// Shows which file is being worked on.
    pub fn working_on(&self, file: &str) {
        self.progress.set_message(file.to_owned());
    }

    /// Moves progress on by an input's bytes.
    pub fn done(&self, bytes: u64) {
        self.progress.inc(bytes);
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

/// Bytes of input from which on progress is shown.
const LONG_WORK: u64 = 16 << 20;

/// Writes all of `bytes` to standard output. A closed pipe is no fault: its reader has what it wanted.
pub fn write_stdout(bytes: &[u8]) -> io::Result<()> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}

/// Writes `value` to standard output as JSON for programs.
pub fn write_json(value: &impl Serialize) -> io::Result<()> {
    let mut text = serde_json::to_string_pretty(value)?;
    text.push('\n');
    write_stdout(text.as_bytes())
}

/// True when standard output is a terminal.
pub fn stdout_is_terminal() -> bool {
    io::stdout().is_terminal()
}
