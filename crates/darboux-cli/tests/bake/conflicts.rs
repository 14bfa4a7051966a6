//! Outputs that would replace an input or each other are refused before anything is baked, with `--force`
//! too.

use std::fs;
use std::path::Path;

use serde_json::json;

use crate::common::{darboux, text};
use crate::pair::{FULL, Pair, edited, plate};

/// A grey image of one texel.
fn image(path: &Path) {
    image::GrayImage::from_pixel(1, 1, image::Luma([128])).save(path).expect("an image");
}

/// Runs a bake that would replace `victim`, which stays.
#[track_caller]
fn keeps(pair: &Pair, victim: &str, arguments: &[&str], what: &str) {
    let before = fs::read(pair.path(victim)).expect("the file");
    let run = pair.bake(&[arguments, &["--force"]].concat());
    assert!(run.code != 0 && run.stderr.contains(what), "{}: {}", run.code, run.stderr);
    assert!(run.stderr.lines().count() == 1, "{}", run.stderr);
    assert!(fs::read(pair.path(victim)).expect("the file") == before, "{victim} was replaced");
}

#[test]
fn no_input_is_replaced() {
    let pair = Pair::new();
    fs::write(pair.path("cage.glb"), plate([1.0, 1.0], &FULL, 1.0)).expect("a file");
    image(&pair.path("skew.png"));
    image(&pair.path("map.misses.png"));
    let path = |name: &str| text(&pair.path(name)).to_owned();
    let [low, high, skew, misses] = ["low.glb", "high.glb", "skew.png", "map.misses.png"].map(path);
    keeps(&pair, "low.glb", &["--write-model", &low], "low.glb: would replace the low model; choose");
    keeps(&pair, "high.glb", &["--write-cage", &high], "would replace a high model");
    let map = ["--skew", &skew, "--verify", "--heat-map", &skew];
    keeps(&pair, "skew.png", &map, "would replace the image of --skew");
    keeps(&pair, "map.misses.png", &["--skew", &misses], "would replace the image of --skew");
    // The pair's own bake has --cage-offset, which excludes a cage.
    let cage = path("cage.glb");
    let run = darboux(&[
        "bake",
        &low,
        "--high",
        &high,
        "-o",
        &path("map.png"),
        "--cage",
        &cage,
        "--write-model",
        &cage,
        "--force",
    ]);
    assert!(run.exits(2).stderr.contains("would replace the cage"));
    // What may be replaced is replaced.
    pair.bake(&["--force", "--skew", &skew]).exits(0);
    pair.bake(&["--force", "--skew", &skew]).exits(0);
}

#[test]
#[cfg(unix)]
fn links_and_other_spellings_are_followed() {
    use std::os::unix::fs::symlink;

    let pair = Pair::new();
    symlink(".", pair.path("here")).expect("a link");
    symlink("low.glb", pair.path("link.glb")).expect("a link");
    fs::hard_link(pair.path("high.glb"), pair.path("second.glb")).expect("a link");
    let path = |name: &str| text(&pair.path(name)).to_owned();
    keeps(
        &pair,
        "low.glb",
        &["--write-model", &path("here/low.glb")],
        "here/low.glb: would replace the low model (",
    );
    keeps(&pair, "low.glb", &["--write-model", &path("link.glb")], "link.glb: would replace the low model (");
    keeps(&pair, "high.glb", &["--write-model", &path("second.glb")], "would replace a high model (");
    // Neither file exists yet.
    let heat_map = path("here/map.png");
    let run = pair.bake(&["--verify", "--heat-map", &heat_map, "--force"]).exits(2);
    assert!(run.stderr.contains("here/map.png: is named twice ("), "{}", run.stderr);
    let picture = path("here/map.misses.png");
    let run = pair.bake(&["--verify", "--heat-map", &picture, "--force"]).exits(2);
    assert!(run.stderr.contains("is named twice"), "{}", run.stderr);
}

/// Images of the models are known when these are open.
#[test]
fn no_image_of_a_model_is_replaced() {
    let pair = Pair::new();
    image(&pair.path("paint.png"));
    let painted = edited(&fs::read(pair.path("high.glb")).expect("a model"), |json| {
        json["meshes"][0]["primitives"][0]["material"] = 0.into();
        json["materials"] = json!([{"normalTexture": {"index": 0}}]);
        json["textures"] = json!([{"source": 0}]);
        json["images"] = json!([{"uri": "paint.png"}]);
    });
    fs::write(pair.path("high.glb"), painted).expect("a file");
    let paint = text(&pair.path("paint.png")).to_owned();
    keeps(&pair, "paint.png", &["--verify", "--heat-map", &paint], "would replace a file of ");
    // A cage's files count, too: here the other bake of a job would replace one.
    let job = pair.path("job.toml");
    let entries = "[defaults]\nsize = 8\ncage-offset = 1\n[[bake]]\nlow = \"low.glb\"\nhigh = \"high.glb\"\noutput = \"a.png\"\n\
        [[bake]]\nlow = \"low.glb\"\nhigh = \"low.glb\"\noutput = \"./paint.png\"\n";
    fs::write(&job, entries).expect("a file");
    let before = fs::read(&paint).expect("the image");
    let run = darboux(&["bake", text(&job), "--force"]).exits(2);
    assert!(
        run.stderr.contains("would replace a file of ") && !pair.path("a.png").exists(),
        "{}",
        run.stderr
    );
    assert!(fs::read(&paint).expect("the image") == before);
}

#[test]
fn bakes_of_a_job_do_not_write_what_others_read() {
    let pair = Pair::new();
    let job = pair.path("job.toml");
    let refused = |second: &str, what: &str| {
        let text_of_job = format!(
            "[defaults]\nsize = 8\n[[bake]]\nlow = \"low.glb\"\nhigh = \"high.glb\"\noutput = \"a.png\"\n[[bake]]\n{second}"
        );
        fs::write(&job, text_of_job).expect("a file");
        let run = darboux(&["bake", text(&job), "--force"]).exits(2);
        assert!(run.stderr.contains(what) && !pair.path("a.png").exists(), "{}", run.stderr);
    };
    fs::write(pair.path("other.glb"), plate([0.0, 0.0], &FULL, 1.0)).expect("a file");
    let pair_of = "low = \"other.glb\"\nhigh = \"high.glb\"\n";
    refused(
        &format!("{pair_of}output = \"b.png\"\nwrite-model = \"low.glb\"\n"),
        "would replace the low model",
    );
    refused(&format!("{pair_of}output = \"./a.png\"\n"), "is written by two bakes of the job");
}

/// Which tiles there are is known when a low model is open.
#[test]
fn images_of_tiles_count_before_models_are_open() {
    let pair = Pair::new();
    let job = pair.path("job.toml");
    let bake = |outputs: [&str; 2]| {
        let entry = |output: &str| format!("[[bake]]\nlow = \"low.glb\"\nhigh = \"high.glb\"\n{output}\n");
        let entries: String = outputs.iter().map(|output| entry(output)).collect();
        fs::write(&job, format!("[defaults]\nsize = 8\ncage-offset = 1\n{entries}")).expect("a file");
        darboux(&["bake", text(&job), "--force"])
    };
    for other in ["a.1001.png", "./a.<UDIM>.png", "a.9990.png", "a.%UDIM%.png"] {
        let run = bake(["output = \"a.%UDIM%.png\"", &format!("output = \"{other}\"")]).exits(2);
        assert!(run.stderr.contains("is written by two bakes of the job"), "{other}: {}", run.stderr);
        assert!(!pair.path("a.1001.png").exists());
    }
    let skew = "output = \"a.png\"\nskew = \"paint.1001.png\"";
    image(&pair.path("paint.1001.png"));
    let run = bake([skew, "output = \"paint.%UDIM%.png\""]).exits(2);
    assert!(run.stderr.contains("would replace the image of --skew"), "{}", run.stderr);
    // The number may stand elsewhere in the path, too.
    fs::create_dir(pair.path("1001")).expect("a folder");
    let run = bake(["output = \"1001/a.%UDIM%.png\"", "output = \"1001/a.1001.png\""]).exits(2);
    assert!(run.stderr.contains("is written by two bakes of the job"), "{}", run.stderr);
    for other in ["a.1000.png", "b.1001.png", "a.9991.png", "a.1001.exr"] {
        bake(["output = \"a.%UDIM%.png\"", &format!("output = \"{other}\"")]).exits(0);
    }
}

/// A FIFO would block the command, and a device never ends.
#[test]
#[cfg(unix)]
fn only_regular_files_are_read() {
    let pair = Pair::new();
    let pipe = text(&pair.path("pipe.png")).to_owned();
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().expect("mkfifo runs").success());
    let run = pair.bake(&["--skew", &pipe]).exits(1);
    assert!(run.stderr.contains("pipe.png: cannot be read: it is not a regular file"), "{}", run.stderr);
    let run = pair.bake(&["--skew", "/dev/zero"]).exits(1);
    assert!(run.stderr.contains("/dev/zero: cannot be read"), "{}", run.stderr);
    let [low, high, map] = ["low.glb", "high.glb", "map.png"].map(|name| text(&pair.path(name)).to_owned());
    let run = darboux(&["bake", &low, "--high", &high, "-o", &map, "--cage", &pipe]).exits(1);
    assert!(run.stderr.contains("pipe.png: cannot be read: it is not a regular file"), "{}", run.stderr);
}

/// Models that do not exist show that nothing was read before.
#[test]
#[cfg(unix)]
fn outputs_that_cannot_be_replaced_are_refused_before_models_are_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    assert!(std::process::Command::new("mkfifo").arg(at("pipe.png")).status().expect("mkfifo").success());
    std::os::unix::fs::symlink(at("nowhere"), at("broken.png")).expect("a link");
    fs::write(at("kept.png"), "").expect("a file");
    let mut permissions = at("kept.png").metadata().expect("a file").permissions();
    permissions.set_readonly(true);
    fs::set_permissions(at("kept.png"), permissions).expect("a read-only file");
    for (name, what) in [
        ("pipe.png", "pipe.png: exists and is not a regular file; name another output"),
        ("broken.png", "broken.png: is a broken link; remove it"),
        ("kept.png", "kept.png: is read-only; make it writable, or name another output"),
    ] {
        let (model, output) = (at("missing.glb"), at(name));
        let [model, output] = [&model, &output].map(|path| text(path));
        let run = darboux(&["bake", model, "--high", model, "-o", output, "--force"]).exits(2);
        assert!(run.stderr.contains(what), "{}", run.stderr);
    }
}
