//! The `darboux` command as a library: parse, call, print.

mod arguments;
mod jobs;

pub use arguments::Arguments;

/// Runs the command with the process's standard streams; the first argument is the program's name. Returns the exit code:
/// 0 done, 1 an input is bad or a file failed, 2 wrong usage.
pub fn run<I, A>(_arguments: I) -> u8
where
    I: IntoIterator<Item = A>,
    A: Into<std::ffi::OsString> + Clone,
{
    0
}
