//! Jobs: resumed, killed, refused, and made from the suffixes in a folder.

use std::fs;
use std::path::Path;

use serde_json::json;

use crate::common::{darboux, names_in, text};
use crate::pair::{FULL, Pair, plate};

#[test]
fn a_job_bakes_what_has_changed() {
    let pair = Pair::new();
    let job = pair.path("job.toml");
    let write = |size: u32| {
        let text = format!(
            "[defaults]\nsize = 16\ncage-offset = 1\n\n[[bake]]\nlow = \"low.glb\"\nhigh = [\"high.glb\"]\noutput = \"a.png\"\nmap = [\"normal\", \"ao\"]\n\n[[bake]]\nlow = \"low.glb\"\nhigh = \"high.glb\"\noutput = \"b.png\"\nsize = {size}\nback-faces = true\n"
        );
        fs::write(&job, text).expect("a file");
    };
    write(8);
    let run = |more: &[&str]| darboux(&[&["bake", text(&job), "--json"], more].concat());
    let report = run(&["--resume"]).exits(0).json();
    assert_eq!((report["bakes"].as_array().map(Vec::len), &report["up_to_date"]), (Some(2), &json!(0)));
    assert_eq!(report["bakes"][1]["size"], json!([8, 8]));
    let first = fs::read(pair.path("a.normal.png")).expect("a map");
    // Of a second run nothing remains; a changed option or output is baked again, and a lost journal costs nothing but time.
    assert_eq!(run(&["--resume"]).exits(0).json()["up_to_date"], 2);
    write(4);
    fs::remove_file(pair.path("a.ao.png")).expect("a map");
    let report = run(&["--resume"]).exits(0).json();
    assert_eq!((report["bakes"].as_array().map(Vec::len), &report["up_to_date"]), (Some(2), &json!(0)));
    assert_eq!(fs::read(pair.path("a.normal.png")).expect("a map"), first);
    fs::write(pair.path("high.glb"), plate([0.0, 0.25], &["POSITION"], 1.0)).expect("a file");
    assert_eq!(run(&["--resume"]).exits(0).json()["bakes"].as_array().map(Vec::len), Some(2));
    // Without --resume nothing is replaced unasked.
    assert!(run(&[]).exits(2).stderr.contains("exists; use --force"));
    run(&["--force"]).exits(0);
}

#[test]
fn jobs_killed_at_random_are_continued_and_equal() {
    let pair = Pair::new();
    let entries: String = (0..6)
        .map(|number| {
            format!(
                "[[bake]]\nlow = \"../low.glb\"\nhigh = \"../high.glb\"\noutput = \"map{number}.png\"\nsize = {}\n",
                96 + 16 * number
            )
        })
        .collect();
    let job = |name: &str| {
        let folder = pair.path(name);
        fs::create_dir(&folder).expect("a folder");
        let defaults = "[defaults]\nmap = [\"normal\", \"ao\"]\nao-rays = 8\ncage-offset = 1\n";
        fs::write(folder.join("job.toml"), format!("{defaults}{entries}")).expect("a file");
        folder.join("job.toml")
    };
    let (killed, whole) = (job("killed"), job("whole"));
    darboux(&["bake", text(&whole)]).exits(0);
    let mut dice = 12_345u64;
    for _ in 0..12 {
        let mut process = std::process::Command::new(env!("CARGO_BIN_EXE_darboux"))
            .args(["bake", text(&killed), "--resume", "--quiet"])
            .spawn()
            .expect("the command starts");
        dice = dice.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        std::thread::sleep(std::time::Duration::from_millis(dice >> 32 & 255));
        process.kill().expect("it is ours");
        process.wait().expect("it has ended");
        // What has its name is whole.
        for name in maps_in(&killed) {
            let [found, expected] = [&killed, &whole].map(|job| fs::read(job.with_file_name(&name)));
            assert_eq!(found.expect("a map"), expected.expect("a map"), "{name}");
        }
    }
    darboux(&["bake", text(&killed), "--resume"]).exits(0);
    assert_eq!(maps_in(&killed), maps_in(&whole));
    for name in maps_in(&whole) {
        let [found, expected] = [&killed, &whole].map(|job| fs::read(job.with_file_name(&name)));
        assert_eq!(found.expect("a map"), expected.expect("a map"), "{name}");
    }
    let left = names_in(killed.parent().expect("a folder"));
    assert!(!left.iter().any(|name| name.starts_with('.')), "{left:?}");
}

/// The names of the maps beside a job, in order.
fn maps_in(job: &Path) -> Vec<String> {
    let mut names = names_in(job.parent().expect("a folder"));
    names.retain(|name| name.ends_with(".png") && !name.starts_with('.'));
    names.sort();
    names
}

#[test]
fn jobs_that_cannot_be_right_are_refused() {
    let pair = Pair::new();
    let job = pair.path("job.toml");
    let refused = |toml: &str, what: &str| {
        fs::write(&job, toml).expect("a file");
        let stderr = darboux(&["bake", text(&job)]).exits(2).stderr;
        assert!(stderr.contains(what), "{stderr}");
    };
    let entry = "[[bake]]\nlow = \"low.glb\"\nhigh = \"high.glb\"\noutput = \"a.png\"\n";
    refused("", "has no [[bake]]");
    refused("[[bake]\n", "line 1");
    refused("[[bakes]]\n", "has bakes");
    refused("[[bake]]\nhigh = \"high.glb\"\n", "bake[0]: has no low");
    refused(&format!("{entry}sise = 3\n"), "bake[0]: unexpected argument '--sise'");
    refused(&format!("{entry}{entry}"), "is written by two bakes");
    refused(&format!("{entry}when = 1979-05-27\n"), "neither text nor a number");
    refused(&"[".repeat(100_000), "line 1");
    refused(&format!("{entry}{}", "# long\n".repeat(700_000)), "has more than 4 MiB");
    // A path that begins with a dash is no option.
    fs::write(&job, "[[bake]]\nlow = \"--force\"\nhigh = \"-x\"\noutput = \"-o.png\"\n").expect("a file");
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_darboux"));
    let output =
        command.args(["bake", "job.toml"]).current_dir(pair.folder.path()).output().expect("it runs");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(stderr.contains("--force: cannot be read"), "{stderr}");
    // One bad model does not stop the other.
    fs::write(pair.path("bad.glb"), "no model").expect("a file");
    fs::write(&job, format!("{entry}[[bake]]\nlow = \"bad.glb\"\nhigh = \"high.glb\"\noutput = \"b.png\"\n"))
        .expect("a file");
    let run = darboux(&["bake", text(&job), "--json"]).exits(1);
    assert_eq!(
        (run.json()["bakes"].as_array().map(Vec::len), run.json()["errors"].as_array().map(Vec::len)),
        (Some(1), Some(1))
    );
    assert!(pair.path("a.png").exists() && !pair.path("b.png").exists());
    assert!(
        darboux(&["bake", text(&pair.path("low.glb")), "--resume", "-o", "x.png"])
            .exits(2)
            .stderr
            .contains("belongs to jobs")
    );
}

#[test]
fn a_folder_is_baked_by_suffixes() {
    let pair = Pair::new();
    let [low, high] = ["low.glb", "high.glb"].map(|name| fs::read(pair.path(name)).expect("a model"));
    let cage = plate([1.0, 1.0], &FULL, 1.0);
    for (name, model) in [
        ("Crate_Low.glb", &low),
        ("crate_high.glb", &high),
        ("crate_high_bolts.glb", &high),
        ("lid_low.glb", &low),
        ("lid_high.glb", &high),
        ("lid_cage.glb", &cage),
        ("alone_low.glb", &low),
    ] {
        fs::write(pair.path(name), model).expect("a file");
    }
    let folder = pair.folder.path();
    let run = darboux(&["bake", text(folder), "--suffixes", "--size", "8", "--cage-offset", "1", "--json"])
        .exits(0);
    let report = run.json();
    assert_eq!(report["bakes"].as_array().map(Vec::len), Some(2));
    assert_eq!(report["bakes"][0]["high"].as_array().map(Vec::len), Some(2));
    assert_eq!(report["bakes"][1]["rays"]["kind"], "cage_file");
    assert!(run.stderr.contains("crate_high_bolts.glb") && pair.path("crate.png").exists());
    assert!(darboux(&["bake", text(folder)]).exits(2).stderr.contains("add --suffixes"));
}
