//! Killed, interrupted and resumed bakes: what stays, what is done again and what is replaced.

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use serde_json::{Value, json};

use crate::common::{darboux, names_in, text};
use crate::pair::Pair;

const JOURNAL: &str = "darboux-journal.jsonl";

/// A job with the maps a.png and b.png of a pair.
fn job_of(pair: &Pair, defaults: &str) -> String {
    let entry =
        |name: &str| format!("[[bake]]\nlow = \"low.glb\"\nhigh = \"high.glb\"\noutput = \"{name}.png\"\n");
    let job = pair.path("job.toml");
    fs::write(&job, format!("[defaults]\ncage-offset = 1\n{defaults}{}{}", entry("a"), entry("b")))
        .expect("a file");
    text(&job).to_owned()
}

fn resume(job: &str, more: &[&str], code: i32) -> Value {
    darboux(&[&["bake", job, "--resume", "--json"], more].concat()).exits(code).json()
}

/// The numbers of bakes, of those that are up to date, and the errors.
fn counts(report: &Value) -> (usize, u64, Vec<&str>) {
    let list = |name: &str| report[name].as_array().expect("a list");
    let errors = list("errors").iter().map(|error| error.as_str().expect("a sentence")).collect();
    (list("bakes").len(), report["up_to_date"].as_u64().expect("a number"), errors)
}

/// As files of a batch are: once tried again, then skipped and named, until they are asked for.
#[test]
fn a_bake_that_kills_runs_is_named() {
    let pair = Pair::new();
    let job = job_of(&pair, "size = 8\n");
    let killed_at = |output: &str| {
        let journal = fs::OpenOptions::new().append(true).create(true).open(pair.path(JOURNAL));
        writeln!(journal.expect("the journal"), "{}", json!({ "begun": output })).expect("a line");
    };
    killed_at("a.png");
    assert_eq!(counts(&resume(&job, &[], 0)), (2, 0, vec![]));
    killed_at("a.png");
    killed_at("a.png");
    for _ in 0..2 {
        let report = resume(&job, &[], 1);
        let (baked, up_to_date, errors) = counts(&report);
        assert_eq!((baked, up_to_date, errors.len()), (0, 1, 1));
        assert!(errors[0].contains("low.glb: is skipped") && errors[0].contains("--retry"), "{}", errors[0]);
    }
    assert_eq!(counts(&resume(&job, &["--retry"], 0)), (0, 2, vec![]));
    assert_eq!(counts(&resume(&job, &[], 0)), (0, 2, vec![]));
}

#[test]
fn a_killed_bake_is_noted_before_it_begins() {
    let pair = Pair::new();
    let job = job_of(&pair, "size = 2048\nmap = \"ao\"\nao-rays = 4096\n");
    let mut run = start(&["bake", &job, "--resume", "--quiet", "--jobs", "1"]);
    let journal = || fs::read_to_string(pair.path(JOURNAL)).unwrap_or_default();
    while !journal().contains("\"begun\":\"a.png\"") {
        assert!(run.try_wait().expect("a status").is_none(), "the run ended: {}", journal());
    }
    run.kill().expect("it is ours");
    run.wait().expect("it has ended");
    assert!(!journal().contains("ended"), "{}", journal());
}

fn start(arguments: &[&str]) -> Child {
    Command::new("env")
        .args(["--default-signal=TERM,INT", env!("CARGO_BIN_EXE_darboux")])
        .args(arguments)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the command starts")
}

fn pause() {
    std::thread::sleep(std::time::Duration::from_millis(1));
}

fn hidden(folder: &Path) -> Vec<String> {
    names_in(folder).into_iter().filter(|name| name.starts_with(".darboux-")).collect()
}

/// The maps are staged before they are verified, which takes a while.
#[test]
#[cfg(target_os = "linux")]
fn signals_leave_no_temporary_file_and_count_against_no_bake() {
    let pair = Pair::new();
    let job = job_of(&pair, "size = 1024\nverify = true\n");
    let folder = pair.folder.path();
    let mut interrupted = 0;
    for round in 0..40 {
        let mut run = start(&["bake", &job, "--resume", "--force", "--jobs", "1"]);
        while run.try_wait().expect("a status").is_none() && hidden(folder).is_empty() {
            pause();
        }
        let signal = ["-INT", "-TERM"][round % 2];
        let _may_be_done = Command::new("kill").args([signal, &run.id().to_string()]).status();
        let ended = run.wait().expect("it ends");
        interrupted += usize::from(ended.code().is_none());
        assert_eq!(hidden(folder), Vec::<String>::new());
        // So that there is something to do.
        for name in ["a.png", "b.png"] {
            let _may_not_exist = fs::remove_file(pair.path(name));
        }
        if interrupted == 2 {
            break;
        }
    }
    assert_eq!(interrupted, 2, "the runs were done before the signals came");
    let job = job_of(&pair, "size = 8\n");
    assert_eq!(counts(&resume(&job, &[], 0)), (2, 0, vec![]));
    let mut run = start(&[
        "bake",
        text(&pair.path("low.glb")),
        "--high",
        text(&pair.path("high.glb")),
        "-o",
        text(&pair.path("single.png")),
        "--size",
        "1024",
        "--cage-offset",
        "1",
        "--verify",
    ]);
    while run.try_wait().expect("a status").is_none() && hidden(folder).is_empty() {
        pause();
    }
    let _may_be_done = Command::new("kill").args(["-INT", &run.id().to_string()]).status();
    run.wait().expect("it ends");
    assert_eq!(hidden(folder), Vec::<String>::new());
}

/// Not even where the pair's other files are of an earlier run.
#[test]
fn files_that_no_run_wrote_are_not_replaced() {
    let pair = Pair::new();
    let job = job_of(&pair, "size = 8\n");
    fs::write(pair.path("a.png"), "precious").expect("a file");
    for _ in 0..2 {
        let report = resume(&job, &[], 1);
        let (_, _, errors) = counts(&report);
        assert_eq!(errors.len(), 1);
        assert!(
            errors[0].contains("a.png: exists, and the journal of --resume does not list it"),
            "{errors:?}"
        );
        assert_eq!(fs::read(pair.path("a.png")).expect("the file"), b"precious");
    }
    assert!(pair.path("b.png").exists(), "the other pair is baked");
    assert_eq!(counts(&resume(&job, &["--force"], 0)), (1, 1, vec![]));
    fs::write(pair.path("model.glb"), "precious").expect("a file");
    let text_of_job = fs::read_to_string(&job).expect("the job");
    fs::write(&job, format!("{text_of_job}write-model = \"model.glb\"\n")).expect("the job");
    let report = resume(&job, &[], 1);
    assert!(counts(&report).2[0].contains("model.glb: exists, and the journal"), "{report}");
    assert_eq!(fs::read(pair.path("model.glb")).expect("the file"), b"precious");
    fs::remove_file(pair.path("model.glb")).expect("the file");
    assert_eq!(counts(&resume(&job, &[], 0)), (1, 1, vec![]));
}

/// A lock says that another program reads or writes the file; waiting for it could take forever.
#[test]
fn locked_outputs_and_journals_do_not_block() {
    let pair = Pair::new();
    let job = job_of(&pair, "size = 8\n");
    resume(&job, &[], 0);
    let locked: Vec<fs::File> = ["a.png", "b.png"]
        .map(|name| fs::File::open(pair.path(name)).expect("a map"))
        .into_iter()
        .inspect(|file| file.lock().expect("a lock"))
        .collect();
    pair.bake(&["--verify", "--heat-map", text(&pair.path("a.png")), "--force"]).exits(0);
    pair.bake(&["--verify", "--heat-map", text(&pair.path("a.png")), "--force"]).exits(0);
    resume(&job, &["--force"], 0);
    drop(locked);
    let journal = fs::File::open(pair.path(JOURNAL)).expect("the journal");
    journal.lock().expect("a lock");
    let run = darboux(&["bake", &job, "--resume"]).exits(1);
    assert!(run.stderr.contains("another run is writing there"), "{}", run.stderr);
}
