//! `--resume` continues a run that was stopped, and `--jobs` processes several files at the same time.

mod common;

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use common::{asset, darboux, names_in, text};
use darboux_cli::{DistributedBatch, failed_task, run_task};
use serde_json::Value;
use tempfile::TempDir;

const JOURNAL: &str = "darboux-journal.jsonl";

/// A library of three models, one of them in many files, and an empty folder for outputs.
fn library() -> (TempDir, PathBuf, PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (models, out) = (folder.path().join("models"), folder.path().join("out"));
    fs::create_dir_all(models.join("plane")).expect("a folder");
    fs::copy(asset("made/quantised-sparse.glb"), models.join("a.glb")).expect("a copy");
    fs::copy(asset("Fox/Fox.glb"), models.join("b.glb")).expect("a copy");
    for name in names_in(&asset("TwoSidedPlane")) {
        fs::copy(asset("TwoSidedPlane").join(&name), models.join("plane").join(name)).expect("a copy");
    }
    (folder, models, out)
}

fn resume(models: &Path, out: &Path, options: &[&str], code: i32) -> Value {
    let arguments = ["tangents", text(models), "--out-dir", text(out), "--resume", "--json"];
    darboux(&[&arguments, options].concat()).exits(code).json()
}

fn statuses(report: &Value) -> Vec<&str> {
    let files = report["files"].as_array().expect("files");
    files.iter().map(|file| file["status"].as_str().expect("a status")).collect()
}

/// All files below a folder but the journal, with their bytes.
fn contents(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut found = Vec::new();
    for name in names_in(folder).into_iter().filter(|name| name != JOURNAL) {
        let path = folder.join(name);
        if path.is_dir() {
            found.extend(contents(&path));
        } else {
            found.push((path.clone(), fs::read(&path).expect("an output")));
        }
    }
    found
}

#[test]
fn only_what_changed_is_done_again() {
    let (_folder, models, out) = library();
    let first = resume(&models, &out, &[], 0);
    assert_eq!(statuses(&first), ["written", "copied", "copied"]);
    let again = resume(&models, &out, &[], 0);
    assert_eq!(statuses(&again), ["up_to_date"; 3]);
    assert_eq!(again["totals"]["up_to_date"], 3);
    assert_eq!(again["files"][0]["primitives"], first["files"][0]["primitives"]);

    fs::copy(asset("made/degenerate.gltf"), models.join("b.glb")).expect("another model");
    assert_eq!(statuses(&resume(&models, &out, &[], 0)), ["up_to_date", "written", "up_to_date"]);
    let image = models.join("plane/TwoSidedPlane_Normal.png");
    fs::copy(models.join("plane/TwoSidedPlane_BaseColor.png"), image).expect("another image");
    assert_eq!(statuses(&resume(&models, &out, &[], 0)), ["up_to_date", "up_to_date", "copied"]);
    fs::remove_file(out.join("a.glb")).expect("the output");
    assert_eq!(statuses(&resume(&models, &out, &[], 0)), ["written", "up_to_date", "up_to_date"]);
    fs::write(out.join("a.glb"), b"cut").expect("the output");
    assert_eq!(statuses(&resume(&models, &out, &[], 0)), ["written", "up_to_date", "up_to_date"]);
    let whole = fs::read(out.join("a.glb")).expect("the output");
    let mut damaged = whole.clone();
    *damaged.last_mut().expect("bytes") ^= 1;
    fs::write(out.join("a.glb"), damaged).expect("the output");
    assert_eq!(statuses(&resume(&models, &out, &[], 0)), ["written", "up_to_date", "up_to_date"]);
    assert_eq!(fs::read(out.join("a.glb")).expect("the output"), whole);

    let other = resume(&models, &out, &["--encoding", "snorm8x4", "--overwrite"], 0);
    assert!(!statuses(&other).contains(&"up_to_date"));
    assert_eq!(statuses(&resume(&models, &out, &[], 0)).len(), 3);
    assert_eq!(statuses(&resume(&models, &out, &[], 0)), ["up_to_date"; 3]);
}

/// Outputs that are made again and again do not make the journal grow, and compacting loses no record.
/// The material library of an OBJ and its texture count as parts of it.
#[test]
fn companions_of_an_obj_are_noticed() {
    let (folder, _, out) = library();
    let models = folder.path().join("objs");
    fs::create_dir(&models).expect("a folder");
    for name in ["scene.obj", "scene.mtl", "scene_normal.png"] {
        fs::copy(asset("blender").join(name), models.join(name)).expect("a copy");
    }
    let model = models.join("scene.obj");
    assert_eq!(statuses(&resume(&model, &out, &[], 0)), ["written"]);
    assert_eq!(statuses(&resume(&model, &out, &[], 0)), ["up_to_date"]);
    for name in ["scene.mtl", "scene_normal.png"] {
        let mut bytes = fs::read(models.join(name)).expect("a companion");
        bytes.push(b'\n');
        fs::write(models.join(name), bytes).expect("a companion");
        assert_eq!(statuses(&resume(&model, &out, &[], 0)), ["written"], "{name}");
    }
}

#[test]
fn the_journal_is_compacted() {
    let (_folder, models, out) = library();
    resume(&models, &out, &[], 0);
    let one = models.join("a.glb");
    for round in 0..20 {
        let encoding = ["snorm16x4", "snorm8x4"][round % 2];
        assert_eq!(statuses(&resume(&one, &out, &["--encoding", encoding], 0)), ["written"]);
    }
    let journal = fs::read_to_string(out.join(JOURNAL)).expect("the journal");
    let (runs, records): (Vec<&str>, Vec<&str>) =
        journal.lines().partition(|line| line.starts_with("{\"run\""));
    assert_eq!(runs.len(), 21);
    assert!((3..10).contains(&records.len()), "{} records", records.len());
    assert!(names_in(&out).iter().all(|name| !name.starts_with(".darboux-")));
    assert_eq!(statuses(&resume(&models, &out, &[], 0)), ["written", "up_to_date", "up_to_date"]);
}

/// A folder of outputs may be named in any way, and be moved.
#[test]
fn the_journal_knows_nothing_of_other_folders() {
    let (folder, models, _) = library();
    let resume = |out: &str| -> Value {
        let run = Command::new(env!("CARGO_BIN_EXE_darboux"))
            .args(["tangents", text(&models.join("a.glb")), "--resume", "--json", "--out-dir", out])
            .current_dir(&folder)
            .output()
            .expect("the command runs");
        assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
        let report: Value = serde_json::from_slice(&run.stdout).expect("the report is JSON");
        report["files"][0]["status"].clone()
    };
    let output = folder.path().join("out/a.glb");
    assert_eq!(resume("out"), "written");
    for spelling in ["./out", text(&folder.path().join("out")), "models/../out"] {
        assert_eq!(resume(spelling), "up_to_date", "{spelling}");
    }
    fs::write(&output, b"cut").expect("the output");
    assert_eq!(resume("out"), "written");
    fs::rename(folder.path().join("out"), folder.path().join("moved")).expect("the folder moves");
    assert_eq!(resume("moved"), "up_to_date");
    fs::create_dir(folder.path().join("out")).expect("a folder");
    fs::rename(folder.path().join("moved/a.glb"), &output).expect("the output moves");
    assert_eq!(resume("moved"), "written");
}

#[test]
#[cfg(unix)]
fn an_output_outside_the_folder_is_done_each_time() {
    let (folder, models, out) = library();
    let elsewhere = folder.path().join("elsewhere.glb");
    fs::create_dir(&out).expect("a folder");
    fs::write(&elsewhere, b"old").expect("a file");
    std::os::unix::fs::symlink(&elsewhere, out.join("a.glb")).expect("a link");
    // No journal says that a run wrote it.
    assert_eq!(statuses(&resume(&models.join("a.glb"), &out, &[], 1)), ["failed"]);
    assert_eq!(fs::read(&elsewhere).expect("a file"), b"old");
    for _ in 0..2 {
        assert_eq!(statuses(&resume(&models.join("a.glb"), &out, &["--force"], 0)), ["written"]);
    }
    let journal = fs::read_to_string(out.join(JOURNAL)).expect("the journal");
    assert!(!journal.contains("elsewhere"), "{journal}");
}

#[test]
fn failures_are_collected_and_tried_again() {
    let (_folder, models, out) = library();
    fs::write(models.join("aa.glb"), b"glTF").expect("a broken model");
    let report = resume(&models, &out, &[], 1);
    assert_eq!(statuses(&report), ["written", "failed", "copied", "copied"]);
    fs::copy(models.join("a.glb"), models.join("aa.glb")).expect("the model mended");
    let report = resume(&models, &out, &[], 0);
    assert_eq!(statuses(&report), ["up_to_date", "written", "up_to_date", "up_to_date"]);
}

#[test]
fn a_broken_line_of_the_journal_is_no_line() {
    let (_folder, models, out) = library();
    // One file at a time, so that the journal has the order of the files.
    resume(&models, &out, &["--jobs", "1"], 0);
    let journal = fs::read(out.join(JOURNAL)).expect("the journal");
    // As a process leaves it that is killed while it writes the last line.
    fs::write(out.join(JOURNAL), &journal[..journal.len() - 20]).expect("the journal");
    assert_eq!(statuses(&resume(&models, &out, &[], 0)), ["up_to_date", "up_to_date", "copied"]);
    assert_eq!(statuses(&resume(&models, &out, &[], 0)), ["up_to_date"; 3]);
}

#[test]
fn a_killed_run_goes_on() {
    let (_folder, models, out) = library();
    for number in 0..30 {
        fs::copy(asset("NormalTangentTest/NormalTangentTest.glb"), models.join(format!("many{number}.glb")))
            .expect("a copy");
    }
    let whole = out.with_file_name("whole");
    resume(&models, &whole, &[], 0);
    let mut killed = Command::new(env!("CARGO_BIN_EXE_darboux"))
        .args(["tangents", text(&models), "--out-dir", text(&out), "--resume", "--jobs", "2"])
        .stderr(Stdio::null())
        .spawn()
        .expect("the command starts");
    loop {
        // Before the journal: a machine that pauses here must not make it seem that nothing was journalled.
        let has_ended = killed.try_wait().expect("a status").is_some();
        // Lines say that the run and its files began; the first with a hash is an output.
        if fs::read_to_string(out.join(JOURNAL)).is_ok_and(|journal| journal.contains("\"content\"")) {
            break;
        }
        assert!(!has_ended, "nothing was journalled");
    }
    killed.kill().expect("it can be killed");
    killed.wait().expect("it ends");
    // Temporary files of this run and of another one, both killed; and a file that only looks like one.
    let journal = fs::read_to_string(out.join(JOURNAL)).expect("the journal");
    let begun: Value = serde_json::from_str(journal.lines().next().expect("a line")).expect("JSON");
    let run = begun["run"].as_str().expect("a run");
    fs::create_dir_all(out.join("plane")).expect("a folder");
    let unfinished = out.join(format!("plane/.darboux-{run}-a1B2c3"));
    let other = out.join("plane/.darboux-0123456789abcdef-a1B2c3");
    let mine = out.join("plane/.darboux-ignore");
    [&unfinished, &other, &mine].into_iter().for_each(|file| fs::write(file, b"glT").expect("half a file"));
    let report = resume(&models, &out, &[], 0);
    assert!(!unfinished.exists());
    assert!(!other.exists(), "temporary files of killed processes are removed");
    fs::remove_file(&mine).expect("other files are left alone");
    assert!(statuses(&report).contains(&"up_to_date"));
    let relative = |folder: &Path| -> Vec<(PathBuf, Vec<u8>)> {
        let files = contents(folder).into_iter();
        files.map(|(path, bytes)| (path.strip_prefix(folder).expect("below").to_owned(), bytes)).collect()
    };
    assert!(relative(&out) == relative(&whole), "{:?}", names_in(&out));
}

/// A file that was at work when a run was killed is tried again; at the second time it is skipped and named,
/// until it is asked for.
#[test]
fn a_file_that_kills_runs_is_named() {
    let (_folder, models, out) = library();
    fs::create_dir(&out).expect("a folder");
    let killed_at = |output: &str| {
        let journal = fs::OpenOptions::new().append(true).create(true).open(out.join(JOURNAL));
        writeln!(journal.expect("the journal"), "{}", serde_json::json!({ "begun": output }))
            .expect("a line");
    };
    killed_at("a.glb");
    assert_eq!(statuses(&resume(&models, &out, &[], 0)), ["written", "copied", "copied"]);
    fs::remove_file(out.join("a.glb")).expect("the output");
    killed_at("a.glb");
    assert_eq!(statuses(&resume(&models, &out, &[], 0)), ["written", "up_to_date", "up_to_date"]);
    killed_at("a.glb");
    killed_at("a.glb");
    for _ in 0..4 {
        let report = resume(&models, &out, &[], 1);
        assert_eq!(statuses(&report), ["failed", "up_to_date", "up_to_date"]);
        let error = report["files"][0]["error"].as_str().expect("a sentence");
        assert!(error.contains("a.glb: is skipped") && error.contains("--retry"), "{error}");
    }
    assert_eq!(statuses(&resume(&models, &out, &["--retry"], 0)), ["up_to_date"; 3]);
    assert_eq!(statuses(&resume(&models, &out, &[], 0)), ["up_to_date"; 3]);
}

/// A file of the user at the place of an output is no output of an earlier run.
#[test]
fn a_file_that_no_run_wrote_is_not_replaced() {
    let (_folder, models, out) = library();
    fs::create_dir(&out).expect("a folder");
    fs::write(out.join("b.glb"), b"precious").expect("a file");
    for _ in 0..3 {
        let report = resume(&models, &out, &[], 1);
        assert_eq!(report["files"][1]["status"], "failed");
        let error = report["files"][1]["error"].as_str().expect("a sentence");
        assert!(error.contains("b.glb: exists, and the journal of --resume does not list it"), "{error}");
        assert!(error.contains("--force"), "{error}");
        assert_eq!(fs::read(out.join("b.glb")).expect("the file"), b"precious");
    }
    // The same in steps.
    let options = ["--encoding".to_owned(), "snorm16x4".to_owned()];
    let batch = DistributedBatch::open(std::slice::from_ref(&models), &out, &options).expect("a batch");
    let result = run_task(&batch.tasks()[1]).expect("a result");
    assert!(result.contains("does not list it"), "{result}");
    drop(batch);
    assert_eq!(fs::read(out.join("b.glb")).expect("the file"), b"precious");
    assert_eq!(statuses(&resume(&models, &out, &["--force"], 0))[1], "copied");
    assert_eq!(statuses(&resume(&models, &out, &[], 0))[1], "up_to_date");
}

/// A worker of another program that is lost after it wrote its output leaves no record of it.
#[test]
fn outputs_of_lost_workers_are_replaced() {
    let (_folder, models, out) = library();
    let open = || DistributedBatch::open(std::slice::from_ref(&models), &out, &[]).expect("a batch");
    let batch = open();
    for task in batch.tasks() {
        run_task(task).expect("a result, which is lost");
    }
    drop(batch);
    assert_eq!(statuses(&resume(&models, &out, &[], 0)), ["written", "copied", "copied"]);
    fs::remove_file(out.join(JOURNAL)).expect("the journal");
    assert!(run_task(&open().tasks()[0]).expect("a result").contains("does not list it"));
}

/// Ctrl-C and what batch systems send are no fault of the file at work.
#[test]
#[cfg(target_os = "linux")]
fn signals_count_against_no_file() {
    let (_folder, models, out) = library();
    fs::create_dir(&out).expect("a folder");
    // A file that takes a while.
    let big = format!(
        "{}{}",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\n",
        "f 1/1/1 2/2/1 3/3/1\n".repeat(300_000)
    );
    fs::write(models.join("big.obj"), big).expect("a model");
    let big = models.join("big.obj");
    let mut interrupted = 0;
    for round in 0..40 {
        let journal_length = || fs::metadata(out.join(JOURNAL)).map_or(0, |file| file.len());
        let before = journal_length();
        let mut run = Command::new("env")
            .args(["--default-signal=TERM,INT", env!("CARGO_BIN_EXE_darboux")])
            .args(["tangents", text(&big), "--out-dir", text(&out), "--resume", "--quiet"])
            .stderr(Stdio::null())
            .spawn()
            .expect("the command starts");
        // Until the file has begun, which is the second line.
        let has_begun = || {
            let journal = fs::read_to_string(out.join(JOURNAL)).unwrap_or_default();
            journal.lines().last().is_some_and(|line| line.contains("begun"))
        };
        while run.try_wait().expect("a status").is_none() && !(journal_length() > before && has_begun()) {
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        let signal = ["-INT", "-TERM"][round % 2];
        let _may_be_done = Command::new("kill").args([signal, &run.id().to_string()]).status();
        let ended = run.wait().expect("it ends");
        interrupted += usize::from(ended.code().is_none());
        assert!(!names_in(&out).iter().any(|name| name.starts_with(".darboux-")), "{:?}", names_in(&out));
        if interrupted == 2 {
            break;
        }
    }
    assert_eq!(interrupted, 2, "the runs were done before the signals came");
    let statuses_of_last = statuses(&resume(&big, &out, &[], 0)).join(" ");
    assert!(["written", "up_to_date"].contains(&statuses_of_last.as_str()), "{statuses_of_last}");
}

#[test]
fn several_files_at_a_time_are_the_same_files() {
    let (_folder, models, out) = library();
    let (one, many) = (out.join("one"), out.join("many"));
    let run = |out: &Path, jobs: &str| {
        darboux(&["tangents", text(&models), "--out-dir", text(out), "--jobs", jobs, "--json"])
            .exits(0)
            .json()
    };
    let (first, second) = (run(&one, "1"), run(&many, "8"));
    let inputs = |report: &Value| -> Vec<Value> {
        report["files"].as_array().expect("files").iter().map(|file| file["input"].clone()).collect()
    };
    assert_eq!(inputs(&first), inputs(&second));
    let bytes = |folder: &Path| -> Vec<Vec<u8>> { contents(folder).into_iter().map(|file| file.1).collect() };
    assert!(bytes(&one) == bytes(&many));
    darboux(&["tangents", text(&models), "--jobs", "0"]).exits(2);
}

#[test]
fn one_run_at_a_time_writes_into_a_folder() {
    let (_folder, models, out) = library();
    fs::create_dir(&out).expect("a folder");
    let held = File::create(out.join(JOURNAL)).expect("a journal");
    held.lock().expect("a lock");
    let run = darboux(&["tangents", text(&models), "--out-dir", text(&out), "--resume"]).exits(1);
    assert!(run.stderr.contains("another run is writing there"), "{}", run.stderr);
    drop(held);
    resume(&models, &out, &[], 0);
    darboux(&["tangents", text(&models), "--resume"]).exits(2);
}

#[test]
fn every_command_resumes() {
    let (_folder, models, out) = library();
    let image = text(&models.join("plane/TwoSidedPlane_Normal.png")).to_owned();
    let model = text(&models.join("a.glb")).to_owned();
    let commands: [(&[&str], &[&str]); 2] = [
        (&["normals", &model, "--overwrite"], &["--normals", "flat"]),
        (&["convert", &image, &model, "--from", "unity", "--to", "gltf"], &["--layout", "rg"]),
    ];
    for (command, change) in commands {
        let out = out.join(command[0]);
        let run = |options: &[&str]| -> Vec<String> {
            let ending = ["--out-dir", text(&out), "--resume", "--json", "-q"];
            let report = darboux(&[command, options, &ending].concat()).exits(0).json();
            statuses(&report).into_iter().map(str::to_owned).collect()
        };
        assert!(!run(&[]).contains(&"up_to_date".into()));
        assert!(run(&[]).iter().all(|status| status == "up_to_date"));
        assert!(!run(change).contains(&"up_to_date".into()));
    }
}

#[test]
fn other_processes_can_do_the_work() {
    let (_folder, models, out) = library();
    let inputs = [models.clone(), models.join("nothing.glb")];
    let encoding = ["--encoding".to_owned(), "snorm16x4".to_owned()];
    let batch = DistributedBatch::open(&inputs, &out, &encoding).expect("a batch");
    assert!(DistributedBatch::open(&inputs, &out, &[]).err().expect("locked").contains("another run"));
    let statuses = |batch: &DistributedBatch| -> Vec<String> {
        let results = batch.tasks().iter().map(|task| run_task(task).expect("a result"));
        let recorded = results.map(|result| {
            batch.record(&result).expect("it is recorded");
            let result: Value = serde_json::from_str(&result).expect("JSON");
            result["report"]["status"].as_str().expect("a status").to_owned()
        });
        recorded.collect()
    };
    assert_eq!(statuses(&batch), ["written", "copied", "copied", "failed"]);
    batch.close().expect("closed");
    let again = DistributedBatch::open(&inputs, &out, &encoding).expect("the batch again");
    assert_eq!(statuses(&again), ["up_to_date", "up_to_date", "up_to_date", "failed"]);
    let lost = failed_task(&again.tasks()[3], "it was lost").expect("a result");
    assert!(lost.contains("nothing.glb: it was lost"), "{lost}");
    drop(again);
    resume(&models, &out, &["--encoding", "snorm16x4"], 0);
}

#[test]
fn tasks_and_results_from_elsewhere_are_refused() {
    let (_folder, models, out) = library();
    for text in ["", "{}", "[1]", "{\"report\": 3"] {
        assert!(run_task(text).is_err() && failed_task(text, "").is_err());
    }
    let batch = DistributedBatch::open(std::slice::from_ref(&models), &out, &[]).expect("a batch");
    assert!(batch.record("{}").is_err());
    let refused = |options: &[&str]| {
        let options: Vec<String> = options.iter().map(|&option| option.to_owned()).collect();
        DistributedBatch::open(std::slice::from_ref(&models), &out.join("other"), &options)
            .err()
            .expect("refused")
    };
    assert_eq!(refused(&["--best"]), "unexpected argument '--best' found");
    assert!(refused(&["--method", "area", "--threshold", "3"]).contains("--threshold needs"));
    assert!(refused(&["-o", "x.glb"]).contains("cannot be used with"));
}

/// A journal that another program put there must neither block the command nor lead it out of the folder.
#[test]
#[cfg(unix)]
fn a_journal_that_is_not_a_regular_file_is_refused() {
    let (folder, models, out) = library();
    let journal = out.join(JOURNAL);
    fs::create_dir(&out).expect("a folder");
    let outside = folder.path().join("outside");
    fs::write(&outside, "").expect("a file");
    let made = Command::new("mkfifo").arg(&journal).status().expect("mkfifo");
    assert!(made.success());
    let refused = || {
        let run = darboux(&["tangents", text(&models), "--out-dir", text(&out), "--resume"]).exits(1);
        assert!(run.stderr.contains("the journal cannot be opened"), "{}", run.stderr);
    };
    refused();
    fs::remove_file(&journal).expect("the FIFO");
    std::os::unix::fs::symlink(&outside, &journal).expect("a link");
    refused();
    assert_eq!(fs::read(&outside).expect("a file"), b"");
    assert_eq!(names_in(&out), [JOURNAL]);
}
