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
    // Of a second run nothing remains; a changed option or output is baked again, and a lost journal costs
    // nothing but time.
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
    // A bake at which two runs were killed is skipped otherwise.
    darboux(&["bake", text(&killed), "--resume", "--retry"]).exits(0);
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
    refused("[[bakes]]\n", "line 1: has bakes");
    refused("[[bake]]\nhigh = \"high.glb\"\n", "job.toml: line 1: this [[bake]] has no low");
    refused(
        &format!("{entry}sise = 3\n"),
        "job.toml: line 5: sise is no option of darboux bake; size is one",
    );
    refused(&format!("{entry}size = 0\n"), "job.toml: line 5: invalid value '0' for '--size <N|WxH>'");
    refused(&format!("{entry}\n[defaults]\nbits = 3\n"), "job.toml: line 7: invalid value '3' for '--bits");
    refused(&format!("{entry}distance = [1, 2]\ncage-offset = 1\n"), "job.toml: line ");
    refused(&format!("{entry}resume = true\n"), "line 5: resume is about the whole job");
    refused("defaults = 3\n", "line 1: defaults is no table");
    refused("bake = 3\n", "line 1: bake is one table");
    refused("[bake]\nlow = \"low.glb\"\n", "line 1: bake is one table; write [[bake]]");
    refused("bake = [3]\n", "line 1: bake is no table; write [[bake]]");
    refused(
        &format!("{entry}[[bake]]\nlow = \"low.glb\"\noutput = \"b.png\"\n"),
        "line 5: there is no high model",
    );
    refused(&format!("{entry}{entry}"), "is written by two bakes");
    refused(&format!("{entry}uv-set = 1979-05-27\n"), "line 5: uv-set is neither text nor a number");
    refused(&"[".repeat(100_000), "line 1");
    refused(&format!("{entry}{}", "# long\n".repeat(700_000)), "has more than 4 MiB");
    // Every bake has the defaults.
    let defaults = format!("[defaults]\nmap = \"{}normal\"\n", "normal,".repeat(50_000));
    refused(&format!("{defaults}{}", entry.repeat(100)), "have more than 16 MiB");
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

/// Options of the bakes stand in the file; beside it they would be without effect. Limits act.
#[test]
fn options_beside_a_job_act_or_are_refused() {
    let pair = Pair::new();
    let job = pair.path("job.toml");
    let entry = "[[bake]]\nlow = \"low.glb\"\nhigh = \"high.glb\"\noutput = \"maps/new/a.png\"\nsize = 8\ncage-offset = 1\n";
    fs::write(&job, entry).expect("a file");
    let run = |more: &[&str]| darboux(&[&["bake", text(&job)], more].concat());
    for (option, value) in [
        ("--cage-offset", "1"),
        ("--size", "16"),
        ("-o", "b.png"),
        ("--high", "high.glb"),
        ("--map", "normal"),
    ] {
        let run = run(&[option, value]).exits(2);
        let name = if option == "-o" { "--output" } else { option };
        assert!(
            run.stderr.contains(&format!("so {name} beside it would be without effect")),
            "{}",
            run.stderr
        );
        assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
    }
    let both = run(&["--verify", "--bits", "16", "--quiet"]).exits(2);
    assert!(
        both.stderr.contains("--bits, --verify") && both.stderr.contains("write bits, verify into"),
        "{}",
        both.stderr
    );
    // The least that the option can say is too little for any model.
    let limited = run(&["--memory-limit", "0"]).exits(1);
    assert!(limited.stderr.contains("--memory-limit"), "{}", limited.stderr);
    // The folder of the output is made.
    run(&["--jobs", "1", "--memory-limit", "64", "--allow-outside", "--quiet"]).exits(0);
    assert!(pair.path("maps/new/a.png").exists());
    // A single bake's is not: most likely its name is mistyped.
    let map = pair.path("other/a.png");
    let single = darboux(&[
        "bake",
        text(&pair.path("low.glb")),
        "--high",
        text(&pair.path("high.glb")),
        "-o",
        text(&map),
    ]);
    assert!(single.exits(2).stderr.contains("does not exist"));
}

/// What a folder has beside its pairs is named.
#[test]
fn models_without_a_pair_are_named() {
    let pair = Pair::new();
    let [low, high] = ["low.glb", "high.glb"].map(|name| fs::read(pair.path(name)).expect("a model"));
    let folder = pair.path("models");
    fs::create_dir(&folder).expect("a folder");
    let write = |name: &str, bytes: &[u8]| fs::write(folder.join(name), bytes).expect("a file");
    write("crate_low.glb", &low);
    write("crate_high.glb", &high);
    write("alone_low.glb", &low);
    write("roof_high.glb", &high);
    write("wall_high.glb", &high);
    write("wall_low.png", b"no model");
    write("crate_low.txt", b"no model");
    let out = pair.path("new/maps");
    let run = |more: &[&str]| {
        let all = ["bake", text(&folder), "--suffixes", "--size", "8", "--cage-offset", "1", "--json"];
        darboux(&[&all, more].concat())
    };
    let first = run(&["-o", text(&out)]).exits(0);
    for warning in [
        "warning: ",
        "alone_low.glb: is left out, because there is no model alone_high",
        "roof_high.glb: is left out, because there is no model roof_low\n",
        "wall_high.glb: is left out, because there is no model wall_low (",
        "wall_low.png is an image)",
    ] {
        assert!(first.stderr.contains(warning), "{}", first.stderr);
    }
    assert!(!first.stderr.contains("crate_low.txt"), "{}", first.stderr);
    assert_eq!(names_in(&out), ["crate.png"]);
    // Formats by their endings, as everywhere.
    write(
        "leaf_low.obj",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1/1 2/2/1 3/3/1\n",
    );
    write("leaf_high.stl", b"solid leaf\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0.1\nvertex 1 0 0.1\nvertex 0 1 0.1\nendloop\nendfacet\nendsolid leaf\n");
    run(&["-o", text(&out), "--force"]).exits(0);
    assert_eq!(names_in(&out), ["crate.png", "leaf.png"]);
    write("crate_high.obj", b"");
    assert!(
        run(&["-o", text(&out), "--force"])
            .exits(2)
            .stderr
            .contains("are the same part of one pair; move one")
    );
    fs::remove_file(folder.join("crate_high.obj")).expect("the file");
    write("bolt_LP.glb", &low);
    write("bolt_HighPoly.glb", &high);
    run(&["-o", text(&out), "--force"]).exits(0);
    assert_eq!(names_in(&out), ["bolt.png", "crate.png", "leaf.png"]);
    write("bolt_low.glb", &low);
    assert!(run(&["-o", text(&out), "--force"]).exits(2).stderr.contains("are the same part of one pair"));
    fs::remove_file(folder.join("bolt_low.glb")).expect("the file");
    write("bolt_hp_nails.glb", &high);
    run(&["-o", text(&out), "--force"]).exits(0);
    write("Bolt_high.glb", &high);
    let twice = run(&["-o", text(&out), "--force"]).exits(2).stderr;
    assert!(
        twice.contains("Bolt_high.glb and ") && twice.contains("bolt_HighPoly.glb are the same part"),
        "{twice}"
    );
    for name in ["Bolt_high.glb", "bolt_hp_nails.glb", "bolt_LP.glb", "bolt_HighPoly.glb"] {
        fs::remove_file(folder.join(name)).expect("the file");
    }
    for option in ["--high", "--cage"] {
        let model = folder.join("wall_high.glb");
        let refused = darboux(&["bake", text(&folder), "--suffixes", option, text(&model)]).exits(2);
        assert!(refused.stderr.contains("and --suffixes exclude each other"), "{}", refused.stderr);
    }
    for name in ["crate_low.glb", "leaf_low.obj"] {
        fs::remove_file(folder.join(name)).expect("the file");
    }
    let none = run(&["-o", text(&out)]).exits(2);
    assert!(
        none.stderr.contains("has no pair of models") && none.stderr.contains("no model roof_low"),
        "{}",
        none.stderr
    );
}

/// Each pair has images for the tiles that its charts touch.
#[test]
fn suffixes_and_tiles_go_together() {
    let pair = Pair::new();
    let [low, high] = ["low.glb", "high.glb"].map(|name| fs::read(pair.path(name)).expect("a model"));
    for name in ["crate", "lid"] {
        fs::write(pair.path(&format!("{name}_low.glb")), &low).expect("a file");
        fs::write(pair.path(&format!("{name}_high.glb")), &high).expect("a file");
    }
    let folder = pair.folder.path();
    let out = pair.path("maps");
    let pattern = out.join("%NAME%_bake.%UDIM%.tif");
    let run = |output: &Path, more: &[&str]| {
        let all =
            ["bake", text(folder), "--suffixes", "--size", "8", "--cage-offset", "1", "-o", text(output)];
        darboux(&[&all, more].concat())
    };
    run(&pattern, &["--verify"]).exits(2);
    run(&pattern, &[]).exits(0);
    assert_eq!(names_in(&out), ["crate_bake.1001.tif", "lid_bake.1001.tif"]);
    let picture = out.join("%NAME%.errors.%UDIM%.png");
    run(&out.join("%NAME%.%UDIM%.png"), &["--verify", "--heat-map", text(&picture)]).exits(0);
    assert!(out.join("lid.errors.1001.png").exists() && out.join("crate.1001.png").exists());
    assert!(run(&out.join("all.%UDIM%.png"), &[]).exits(2).stderr.contains("write %NAME% in the name"));
}

/// A folder of pairs becomes one of textured models.
#[test]
fn models_of_pairs_lie_in_their_folder_with_their_images() {
    let pair = Pair::new();
    for (name, of) in [("crate_low.glb", "low.glb"), ("crate_high.glb", "high.glb")] {
        fs::copy(pair.path(of), pair.path(name)).expect("a file");
    }
    let (folder, out) = (pair.folder.path(), pair.path("models"));
    let run = |model: &Path| {
        let all = ["bake", text(folder), "--suffixes", "--size", "8", "--cage-offset", "1", "--write-model"];
        darboux(&[&all[..], &[text(model)]].concat())
    };
    let told = run(&out).exits(0).stderr;
    let line = format!("{}, {}", text(&out.join("crate.baked.glb")), text(&out.join("crate.baked.*.png")));
    assert!(told.contains(&line), "{told}");
    assert_eq!(names_in(&out), ["crate.baked.ao.png", "crate.baked.glb", "crate.baked.normal.png"]);
    let refused = run(&out.join("all.glb")).exits(2).stderr;
    assert!(refused.contains("all pairs would write it"), "{refused}");
    run(&out.join("%NAME%_textured.glb")).exits(0);
    assert!(out.join("crate_textured.normal.png").exists());
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
        ("crate_highlight.glb", &high),
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
