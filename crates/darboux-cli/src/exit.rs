//! The exit codes that `darboux --help` lists.

/// Everything was done.
pub const DONE: u8 = 0;
/// An input is bad, or at least one file failed.
pub const FAILED: u8 = 1;
/// The command line is wrong.
pub const USAGE: u8 = 2;
/// The compared files differ by more than the tolerance.
pub const DIFFERENT: u8 = 3;
