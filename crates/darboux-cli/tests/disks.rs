//! Disks that are full to the brim, folders that nobody may write into, and an output that takes nothing:
//! each is one sentence and exit code 1, and nothing is left or changed.

#![cfg(target_os = "linux")]

mod common;

use std::fs::{self, File};
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use common::{asset, folder_with, program, text};

/// Every way to write a file. `disk` is the folder in which they run, with `shield.glb`.
const WRITING: &[&str] = &[
    "tangents shield.glb --overwrite -o out.glb",
    "tangents shield.glb --overwrite -o out.gltf",
    "tangents shield.glb --overwrite --in-place",
    "tangents shield.glb --overwrite --out-dir out",
    "normals shield.glb --overwrite -o out.glb",
    "convert shield.glb --from unity --to gltf -o out.glb",
    "check shield.glb --fix -o out.glb",
    "compare shield.glb --method lengyel --heat-map out.png",
    "bake shield.glb --high shield.glb -o out.png --size 64 --map normal,height --write-model out.glb",
];

/// Runs the command with a disk of its own at `disk`, below `folder`: `mount` and its options. None where the
/// system mounts nothing for us.
fn on_disk(folder: &Path, prepare: &str, line: &str) -> Option<Output> {
    let script = format!(
        "{prepare} && cd disk && \"$@\"; code=$?; ls -A > ../left; cat shield.glb > ../input; exit $code"
    );
    let run = |options: &[&str], arguments: &[&str]| {
        let mut command = Command::new("unshare");
        command.args(options).args(["--mount", "sh", "-c"]).args(arguments);
        command.current_dir(folder).output()
    };
    // As a user with a name space of its own, or as root.
    let ways = [&["--user", "--map-root-user"][..], &[]];
    let mounts = |options: &&&[&str]| {
        run(options, &["mount -t tmpfs none /mnt"]).is_ok_and(|output| output.status.success())
    };
    let Some(options) = ways.iter().find(mounts) else {
        writeln!(
            std::io::stdout(),
            "skipped: no file system can be mounted (Debian: util-linux, and user namespaces)"
        )
        .expect("standard output");
        return None;
    };
    let command = program();
    let words: Vec<&str> = [script.as_str(), "sh", command.get_program().to_str().expect("a path")]
        .into_iter()
        .chain(line.split(' '))
        .collect();
    Some(run(options, &words).expect("unshare runs"))
}

/// The run failed with one sentence, and the disk is as it was but for empty folders.
#[track_caller]
fn failed_without_a_trace(folder: &Path, line: &str, output: &Output, part: &str) {
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{line}: {stderr}");
    let errors: Vec<&str> = stderr.lines().filter(|line| line.starts_with("error: ")).collect();
    assert!(errors.len() == 1 && errors[0].contains(part), "{line}: {stderr}");
    assert!(!stderr.contains("panicked") && !stderr.contains("os error"), "{line}: {stderr}");
    let left = fs::read_to_string(folder.join("left")).expect("a list");
    let left: Vec<&str> = left.lines().filter(|name| !["fill", "out"].contains(name)).collect();
    assert_eq!(left, ["shield.glb"], "{line}: {stderr}");
    let input = fs::read(folder.join("input")).expect("a copy");
    assert!(input == fs::read(asset("made/shield.glb")).expect("the model"), "{line}");
}

#[test]
fn a_full_disk_leaves_nothing() {
    for line in WRITING {
        // With nothing, with a page, and with most of an output free.
        for free in [0, 4 << 10, 100 << 10] {
            if free > 8 << 10 && line.contains("compare") {
                continue; // The picture fits.
            }
            let folder = folder_with(&["made/shield.glb"]);
            fs::create_dir(folder.path().join("disk")).expect("a folder");
            let prepare = format!(
                "mount -t tmpfs -o size=1m none disk && cp shield.glb disk && \
                 head -c $(($(stat -f -c '%a * %S' disk) - {free})) /dev/zero > disk/fill"
            );
            let Some(output) = on_disk(folder.path(), &prepare, line) else { return };
            failed_without_a_trace(folder.path(), line, &output, "No space left on device; free some space");
        }
    }
}

#[test]
fn a_folder_that_cannot_be_written_stays_as_it_is() {
    for line in WRITING {
        let folder = folder_with(&["made/shield.glb"]);
        fs::create_dir(folder.path().join("disk")).expect("a folder");
        let prepare = "mount -t tmpfs -o size=1m none disk && cp shield.glb disk && mount -o remount,ro disk";
        let Some(output) = on_disk(folder.path(), prepare, line) else { return };
        failed_without_a_trace(
            folder.path(),
            line,
            &output,
            "Read-only file system; name an output elsewhere",
        );
    }
}

/// What is printed goes to a device that is always full.
#[test]
fn results_that_cannot_be_printed_are_an_error() {
    let model = asset("made/quantised-sparse.glb");
    let model = text(&model);
    for arguments in [
        &["inspect", model][..],
        &["inspect", model, "--json"],
        &["check", model],
        &["check", model, "--json"],
        &["compare", text(&asset("made/shield.glb")), "--method", "area"],
        &["tangents", model, "-o", "-"],
        &["methods"],
        &["completions", "bash"],
    ] {
        let full = File::options().write(true).open("/dev/full").expect("a device");
        let output = program().args(arguments).stdin(Stdio::null()).stdout(full).output().expect("it starts");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {stderr}");
        assert!(stderr.contains("cannot be written: No space left on device"), "{arguments:?}: {stderr}");
        assert!(!stderr.contains("panicked"), "{arguments:?}: {stderr}");
    }
}
