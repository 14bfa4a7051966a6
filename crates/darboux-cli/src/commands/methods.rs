//! `darboux methods`: explains the methods of computing tangents.

use darboux::{Choice, Method};
use darboux_io::system_reason;

use crate::exit;
use crate::terminal::{Messages, write_stdout};

const INTRODUCTION: &str = "\
A normal map stores directions relative to the tangents of the program that baked it: use the method of that \
program.
";

const CONCLUSION: &str = "\
`darboux compare model.glb --method NAME` shows how much a file's tangents differ from a method's; \
docs/algorithms/methods.md derives them.
";

/// Runs the command and returns its exit code.
pub fn run() -> u8 {
    let width = Method::ALL.iter().map(|method| method.name().len()).max().unwrap_or_default();
    let line = |method: &Method| format!("  {:width$}  {}\n", method.name(), method.summary());
    let lines: String = Method::ALL.iter().map(line).collect();
    match write_stdout(format!("{INTRODUCTION}{lines}{CONCLUSION}").as_bytes()) {
        Ok(()) => exit::DONE,
        Err(error) => {
            Messages::new(false).error(&format!("the text cannot be written: {}", system_reason(&error)));
            exit::FAILED
        }
    }
}
