//! The net: a panic fails one file, or the command, with one sentence instead of ending the process.

use std::any::Any;
use std::env;
use std::fmt::Display;
use std::panic::{self, AssertUnwindSafe, catch_unwind};

use crate::exit;
use crate::terminal::Messages;

/// Returns the result of `work` on an input, or one sentence for its panic. `work` shares no state with later
/// inputs except complete files on disk.
pub fn catch<T>(input: &impl Display, work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    let panicked = |payload| Err(sentence(&format!("{input}: darboux failed on this file"), payload));
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(panicked)
}

/// Runs a command and returns its exit code. After a panic outside of [`catch`] it is the code of a failed
/// file.
pub fn run(work: impl FnOnce() -> u8) -> u8 {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|payload| {
        Messages::new(true).error(&sentence("darboux failed", payload));
        exit::FAILED
    })
}

/// What failed, the first line of the panic, and what to do.
fn sentence(what: &str, payload: Box<dyn Any + Send>) -> String {
    let text =
        payload.downcast_ref::<String>().map(String::as_str).or(payload.downcast_ref::<&str>().copied());
    let reason = text.and_then(|text| text.lines().next()).unwrap_or("unknown reason");
    format!(
        "{what}: {reason}; this is a defect of darboux, please report it with what RUST_BACKTRACE=1 prints"
    )
}

/// Leaves the description of a panic to the net's sentence, unless RUST_BACKTRACE asks for its place in the
/// code. For programs of their own only: the setting is the process's.
pub fn silence_panics() {
    if env::var_os("RUST_BACKTRACE").is_none_or(|value| value == "0") {
        panic::set_hook(Box::new(|_| {}));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_on_a_file_becomes_one_sentence() {
        let sentence = catch::<()>(&"a.glb", || panic!("first line\nsecond line")).expect_err("it panicked");
        assert!(
            sentence.starts_with("a.glb: darboux failed on this file: first line; this is a defect"),
            "{sentence}"
        );
        assert_eq!(catch(&"a.glb", || Ok(3)), Ok(3));
    }

    #[test]
    fn a_panic_of_a_command_fails_it() {
        assert_eq!(run(|| panic!("no such row")), exit::FAILED);
        assert_eq!(run(|| exit::DIFFERENT), exit::DIFFERENT);
    }
}
