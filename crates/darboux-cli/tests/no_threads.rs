//! The command where the system starts no thread for it, as under `ulimit -u`: it works on one thread and
//! writes the same files.

#![cfg(target_os = "linux")]

mod common;

use std::fs;
use std::io::Write;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output};

use common::{folder_with, names_in, program, text};

/// A user that has no processes, for root, whom limits do not bind.
const OTHER_USER: u32 = 54_321;

/// A command line that runs what follows it without further threads and processes.
fn limit() -> Command {
    let is_root = Command::new("id").arg("-u").output().is_ok_and(|id| id.stdout == b"0\n");
    let mut command = Command::new(if is_root { "setpriv" } else { "prlimit" });
    if is_root {
        command.arg(format!("--reuid={OTHER_USER}")).args(["--clear-groups", "prlimit"]);
    }
    command.arg("--nproc=1");
    command
}

/// Whether the limit can be set, and holds: a shell under it starts no process.
fn has_limit() -> bool {
    let output = limit().args(["sh", "-c", "ls / | cat"]).output();
    let holds = output.is_ok_and(|output| String::from_utf8_lossy(&output.stderr).contains("fork"));
    if !holds {
        assert!(std::env::var_os("CI").is_none(), "the number of threads cannot be limited");
        writeln!(std::io::stdout(), "skipped: no setpriv and prlimit (Debian: util-linux)")
            .expect("standard output");
    }
    holds
}

/// Makes a file or folder accessible to [`OTHER_USER`].
fn open_to_all(path: &Path) {
    fs::set_permissions(path, fs::Permissions::from_mode(0o777)).expect("permissions");
}

#[test]
fn without_threads_every_command_does_its_work() {
    if !has_limit() {
        return;
    }
    let folder = folder_with(&[
        "made/shield.glb",
        "NormalTangentTest/NormalTangentTest.glb",
        "TwoSidedPlane/TwoSidedPlane_Normal.png",
    ]);
    open_to_all(folder.path());
    let copy = folder.path().join("darboux");
    fs::copy(program().get_program(), &copy).expect("a copy of the command");
    open_to_all(&copy);
    let run = |mut command: Command, arguments: &str| -> Output {
        command.args(arguments.split(' ')).current_dir(folder.path()).output().expect("the command starts")
    };
    let read_all = |out: &str| -> Vec<Vec<u8>> {
        let out = folder.path().join(out);
        names_in(&out).iter().map(|name| fs::read(out.join(name)).expect("an output")).collect()
    };
    for line in [
        "tangents shield.glb NormalTangentTest.glb --overwrite --jobs 4 --out-dir",
        "normals shield.glb NormalTangentTest.glb --overwrite --jobs 4 --out-dir",
        "convert TwoSidedPlane_Normal.png --from opengl --to directx --out-dir",
        "check shield.glb NormalTangentTest.glb --jobs 4",
        "inspect shield.glb NormalTangentTest.glb",
        "compare NormalTangentTest.glb --method mikktspace",
    ] {
        let writes = line.ends_with("--out-dir");
        let (with, without) = if writes { (" with", " without") } else { ("", "") };
        let expected = run(program(), &format!("{line}{with}"));
        let mut limited = limit();
        limited.arg(text(&copy));
        let output = run(limited, &format!("{line}{without}"));
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(!said.contains("panicked"), "{line}: {said}");
        assert_eq!(output.status.code(), expected.status.code(), "{line}: {said}");
        if writes {
            assert!(read_all("without") == read_all("with") && !read_all("with").is_empty(), "{line}");
            fs::remove_dir_all(folder.path().join("with")).expect("an output folder");
            fs::remove_dir_all(folder.path().join("without")).expect("an output folder");
        } else {
            assert!(output.stdout == expected.stdout, "{line}");
        }
    }
}
