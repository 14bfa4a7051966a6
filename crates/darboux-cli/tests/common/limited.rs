//! Runs of the command within limits of processor time, memory and output, on files of the test's own.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::text;

/// Seconds of the processor that a small file may take: the two that are promised for a release build, times
/// five for builds without optimisation, in which the longest of these runs takes 3 s, times four for
/// machines that others share: a run of 2.5 s took 11 s there. What these tests are for takes minutes.
const SECONDS: u32 = 2 * 5 * 4;

/// Runs command lines, each on a file `name` of its own, which stands for the word IN. Each must end by
/// itself with code 0 within the limits: [`SECONDS`] of the processor, 512 MiB and ten times the file of
/// addresses, and 16 MiB and 30 times the file of output. `check` ends with code 1 where errors are left.
/// The output that follows -o is there. Returns what was said last.
#[track_caller]
pub fn ends_in_time(name: &str, file: &[u8], lines: &[&str]) -> String {
    ends_beside(name, file, &[], lines)
}

/// As [`ends_in_time`], with other files in the folder.
#[track_caller]
pub fn ends_beside(name: &str, file: &[u8], others: &[(&str, &[u8])], lines: &[&str]) -> String {
    let mut last = String::new();
    for line in lines {
        let is_check = line.starts_with("check ");
        let (code, said) = run(name, file, others, line);
        assert!(code == 0 || is_check && code == 1, "{line}: exit code {code}: {said}");
        assert!(!said.lines().any(|line| line.starts_with("error: ")), "{line}: {said}");
        last = said;
    }
    last
}

/// Runs a command line as [`ends_in_time`] does, which must end with one error that has these words.
#[track_caller]
pub fn is_refused(name: &str, file: &[u8], line: &str, words: &str) {
    let (code, said) = run(name, file, &[], line);
    let mut errors = said.lines().filter(|line| line.starts_with("error: "));
    assert!(code == 1 && errors.next().is_some_and(|error| error.contains(words)), "{line}: {said}");
    assert_eq!(errors.next(), None, "{line}: {said}");
}

/// The exit code and the start of standard error of a run within the limits.
#[track_caller]
fn run(name: &str, file: &[u8], others: &[(&str, &[u8])], line: &str) -> (i32, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    fs::write(&path, file).expect("a file");
    for (other, bytes) in others {
        fs::write(folder.path().join(other), bytes).expect("a file");
    }
    let length = file.len() + others.iter().map(|(_, bytes)| bytes.len()).sum::<usize>();
    let addresses = (512 << 10) + 10 * length / 1024;
    let times = tempfile::NamedTempFile::new().expect("a file");
    // The shell tells the processor time of the command alone: tests run beside each other, and the system
    // counts the children of a process together.
    let script = format!(
        "(ulimit -t {} && ulimit -v {addresses} && exec \"$0\" \"$@\"); code=$?; times > '{}'; exit $code",
        SECONDS + 1,
        text(times.path())
    );
    let output = Command::new("sh")
        .args(["-c", &script, env!("CARGO_BIN_EXE_darboux")])
        .args(line.split(' ').map(|word| if word == "IN" { text(&path) } else { word }))
        .current_dir(folder.path())
        .output()
        .expect("a shell");
    let said: String = String::from_utf8_lossy(&output.stderr).chars().take(2000).collect();
    let seconds = seconds(&fs::read_to_string(times.path()).expect("the times"));
    assert!(seconds < f64::from(SECONDS), "{line}: {seconds} s of the processor: {said}");
    let written = size(folder.path()) + (output.stdout.len() + output.stderr.len()) as u64;
    assert!(written < (16 << 20) + 30 * length as u64, "{line}: {written} bytes for {length}");
    let code = output.status.code().expect("the command ends by itself");
    let mut words = line.split(' ').skip_while(|&word| word != "-o");
    if let Some(out) = words.nth(1) {
        assert_eq!(folder.path().join(out).exists(), !said.contains("error: "), "{line}: {out}: {said}");
    }
    (code, said)
}

/// The processor time of a shell's children, which is the second line of what its `times` prints: 0m1.25s of
/// the user and 0m0.03s of the system.
fn seconds(times: &str) -> f64 {
    let of_word = |word: &str| {
        let (minutes, seconds) = word.trim_end_matches('s').split_once('m').expect("minutes");
        60.0 * minutes.parse::<f64>().expect("minutes") + seconds.parse::<f64>().expect("seconds")
    };
    times.lines().nth(1).expect("two lines").split(' ').map(of_word).sum()
}

/// The bytes of all files below a folder.
fn size(folder: &Path) -> u64 {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    entries.map(|path| if path.is_dir() { size(&path) } else { path.metadata().expect("a file").len() }).sum()
}
