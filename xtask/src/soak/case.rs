//! One case: files, a command line, and what must hold after the run.

use std::ffi::{OsStr, OsString};
use std::path::PathBuf;

use super::random::Random;

/// Makes a case with random sizes and options. Errors: a file cannot be made.
pub type Make = fn(&mut Random) -> Result<Case, String>;

/// Files in an empty folder, and a command line that runs in it.
pub struct Case {
    /// What the case tries: a row of the summary.
    pub name: String,
    /// Paths relative to the folder in which the command runs. The folder's parent belongs to the case as
    /// well.
    pub files: Vec<(PathBuf, Content)>,
    pub arguments: Vec<OsString>,
    pub stdin: Vec<u8>,
    /// Variables of the environment.
    pub variables: Vec<(&'static str, OsString)>,
    /// A command of the shell that lowers a limit before the program starts: `ulimit -f 1`.
    pub shell_limit: Option<&'static str>,
    pub action: Action,
    pub expected: Expected,
}

/// What lies at a path.
#[derive(Clone, PartialEq, Eq)]
pub enum Content {
    Bytes(Vec<u8>),
    Fifo,
    /// A symbolic link to this path.
    Link(PathBuf),
}

/// What is done with the command line.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Action {
    /// Run it to its end.
    Run,
    /// Run it to its end, and again with a signal at a random moment.
    Kill(Signal),
    /// Run it several times at the same time.
    Together,
    /// Send hostile requests to the server that it starts.
    View,
}

/// How a run is ended from outside.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Signal {
    Interrupt,
    Terminate,
    Kill,
}

/// What the run must give.
#[derive(Clone, Copy)]
pub struct Expected {
    /// The exit codes that are right.
    pub codes: &'static [i32],
    /// Words that the messages must contain; empty for none in particular.
    pub words: &'static str,
}

/// The exit codes of a command line that is right: done, or an input is bad.
pub const DONE_OR_FAILED: &[i32] = &[0, 1];

impl Case {
    /// A case that runs these arguments to their end and succeeds or refuses an input.
    pub fn new<A: Into<OsString>>(arguments: impl IntoIterator<Item = A>) -> Self {
        Self {
            name: String::new(),
            files: Vec::new(),
            arguments: arguments.into_iter().map(Into::into).collect(),
            stdin: Vec::new(),
            variables: Vec::new(),
            shell_limit: None,
            action: Action::Run,
            expected: Expected { codes: DONE_OR_FAILED, words: "" },
        }
    }

    /// Adds a file.
    pub fn file(mut self, path: impl Into<PathBuf>, bytes: impl Into<Vec<u8>>) -> Self {
        self.files.push((path.into(), Content::Bytes(bytes.into())));
        self
    }

    /// Adds something that is no regular file.
    pub fn special(mut self, path: impl Into<PathBuf>, content: Content) -> Self {
        self.files.push((path.into(), content));
        self
    }

    /// The one exit code that is right, and words that the messages must contain.
    pub fn expects(mut self, codes: &'static [i32], words: &'static str) -> Self {
        self.expected = Expected { codes, words };
        self
    }

    pub fn with_action(mut self, action: Action) -> Self {
        self.action = action;
        self
    }

    /// Whether the command line has this word.
    pub fn has(&self, word: &str) -> bool {
        self.arguments.iter().any(|argument| argument == OsStr::new(word))
    }

    /// The value after an option.
    pub fn value_of(&self, option: &str) -> Option<&OsStr> {
        let at = self.arguments.iter().position(|argument| argument == OsStr::new(option))?;
        self.arguments.get(at + 1).map(OsString::as_os_str)
    }

    /// The bytes of all files and of standard input.
    pub fn input_size(&self) -> u64 {
        let size = |content: &Content| match content {
            Content::Bytes(bytes) => bytes.len() as u64,
            _ => 0,
        };
        self.files.iter().map(|(_, content)| size(content)).sum::<u64>() + self.stdin.len() as u64
    }
}
