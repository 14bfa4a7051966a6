//! Where rays begin and what they hit: scenes, distances, cages, parts, straightened rays.

use std::fs;
use std::path::Path;

use serde_json::json;

use crate::common::{asset, darboux, text};
use crate::pair::{FULL, Pair, edited, named_plate, near, plate, rgb};

#[test]
fn the_default_distance_follows_the_size_of_the_model() {
    let pair = Pair::new();
    let [low, high, map] = ["low.glb", "high.glb", "map.png"].map(|name| pair.path(name));
    fs::write(&high, plate([0.0, 0.01], &FULL, 1.0)).expect("a file");
    let line = ["bake", text(&low), "--high", text(&high), "-o", text(&map), "--size", "8", "--json"];
    let report = darboux(&line).exits(0).json();
    let offset = report["rays"]["offset"].as_f64().expect("a number");
    assert!((offset - 0.02 * 2f64.sqrt()).abs() < 1e-6 && report["rays"]["is_default"] == true, "{report}");
}

#[test]
fn scenes_place_models() {
    let pair = Pair::new();
    // Both models twice as large: the same map.
    pair.bake(&[]).exits(0);
    let before = fs::read(pair.path("map.png")).expect("a map");
    fs::write(pair.path("low.glb"), plate([0.0, 0.0], &FULL, 2.0)).expect("a file");
    fs::write(pair.path("high.glb"), plate([0.0, 0.5], &["POSITION"], 2.0)).expect("a file");
    pair.bake(&["--force"]).exits(0);
    assert!(fs::read(pair.path("map.png")).expect("a map") == before);
    // Mirrored along all axes, the roof lies below the plate and faces down as it does.
    fs::write(pair.path("low.glb"), plate([0.0, 0.0], &FULL, -1.0)).expect("a file");
    fs::write(pair.path("high.glb"), plate([0.0, 0.5], &["POSITION"], -1.0)).expect("a file");
    pair.bake(&["--force"]).exits(0);
    assert!(fs::read(pair.path("map.png")).expect("a map") == before);
}

#[test]
fn a_bake_that_misses_says_what_to_change() {
    let pair = Pair::new();
    let [low, high, map] = ["low.glb", "high.glb", "map.png"].map(|name| pair.path(name));
    let bake = |more: &[&str]| {
        let all = ["bake", text(&low), "--high", text(&high), "-o", text(&map), "--size", "16", "--force"];
        darboux(&[&all, more].concat()).exits(0).stderr
    };
    let missed = bake(&["--distance", "0.2,0.2"]);
    assert!(
        missed.contains("the rays of 62.5 % of the texels hit nothing: begin rays farther outside"),
        "{missed}"
    );
    let missed = bake(&["--cage-offset", "0.2"]);
    assert!(missed.contains("choose a larger --cage-offset"), "{missed}");
    fs::write(&high, plate([0.0, 0.5], &["POSITION"], 1.0)).expect("a file");
    assert!(!bake(&["--distance", "1,1"]).contains("hit nothing"));
}

#[test]
fn a_picture_shows_where_rays_missed() {
    let pair = Pair::new();
    let few = pair.bake(&["--json"]).exits(0).json();
    assert!(few["misses"].is_null());
    let [low, high, map] = ["low.glb", "high.glb", "map.png"].map(|name| pair.path(name));
    let line = |high: &Path, more: &[&str]| {
        let all = ["bake", text(&low), "--high", text(high), "-o", text(&map), "--size", "16", "--json"];
        darboux(&[&all, more].concat()).exits(0)
    };
    let report = line(&high, &["--force", "--cage-offset", "0.2"]).json();
    let picture = pair.path("map.misses.png");
    assert_eq!(report["misses"], text(&picture));
    assert!(report["warnings"].to_string().contains("map.misses.png shows where"), "{report}");
    // The roof rises to the right: its left is hit, its right is not.
    let pixel = |x: usize| rgb(&picture)[8 * 16 + x];
    assert_eq!([pixel(0), pixel(15)], [[96, 96, 96], [230, 40, 40]]);
    // A later run that hits everything says that the picture is not its own.
    let whole = line(&high, &["--force", "--distance", "2,2"]).json();
    assert!(whole["misses"].is_null());
    assert!(whole["warnings"].to_string().contains("map.misses.png: is of an earlier run"), "{whole}");
}

/// A grid of waves, stretched along x, as an OBJ.
fn waves(stretch: f32) -> String {
    let side = 17;
    let points = || (0..side * side).map(|i| ((i % side) as f32, (i / side) as f32));
    let mut text = String::new();
    for (x, y) in points() {
        let height = 0.3 * (x + y).sin();
        text += &format!("v {:e} {height} {y}\nvt {} {}\n", stretch * x, x / 16.0, y / 16.0);
    }
    text += "vn 0 1 0\n";
    for (x, y) in points().filter(|&(x, y)| x < 16.0 && y < 16.0) {
        let first = y as usize * side + x as usize + 1;
        let corner = |i: usize| format!("{i}/{i}/1");
        let [a, b, c, d] = [first, first + side, first + side + 1, first + 1].map(corner);
        text += &format!("f {a} {b} {c} {d}\n");
    }
    text
}

/// A larger cage is no advice where a model is longer than numbers can hold its directions.
#[test]
fn a_model_that_is_stretched_too_far_is_named() {
    for stretch in [1e20, 1e30, 1e37] {
        let folder = tempfile::tempdir().expect("a folder");
        let [model, map] = ["long.obj", "map.png"].map(|name| folder.path().join(name));
        fs::write(&model, waves(stretch)).expect("a file");
        let line = ["bake", text(&model), "--high", text(&model), "-o", text(&map), "--size", "16"];
        let said = darboux(&line).exits(1).stderr;
        assert!(said.contains("a million times as long as wide"), "{stretch}: {said}");
        assert!(!said.contains("cage") && said.lines().count() == 1, "{said}");
    }
}

#[test]
fn a_bake_that_hits_nothing_fails_and_writes_nothing() {
    let pair = Pair::new();
    let [low, high, map] = ["low.glb", "high.obj", "map.png"].map(|name| pair.path(name));
    fs::write(&high, "v 0 0 0\nv 1 0 0.5\nv 1 1 0.5\nv 0 1 0\nf 4 3 2 1\n").expect("a file");
    let line = ["bake", text(&low), "--high", text(&high), "-o", text(&map), "--size", "16", "--verify"];
    let failed = darboux(&[&line[..], &["--distance", "2,2"]].concat()).exits(1);
    assert!(failed.stderr.contains("all rays hit nothing, and nothing was written"), "{}", failed.stderr);
    assert!(failed.stderr.contains("turned inside out"), "{}", failed.stderr);
    assert!(!map.exists() && !pair.path("map.misses.png").exists());
}

#[test]
fn a_cage_is_the_low_model_moved() {
    let pair = Pair::new();
    let cage = pair.path("cage.glb");
    fs::write(&cage, plate([1.0, 1.0], &FULL, 1.0)).expect("a file");
    let [low, high, map] = ["low.glb", "high.glb", "map.png"].map(|name| pair.path(name));
    let line = |cage: &Path| {
        let all = ["bake", text(&low), "--high", text(&high), "-o", text(&map), "--size", "16", "--force"];
        darboux(&[&all[..], &["--cage", text(cage), "--json"]].concat())
    };
    let report = line(&cage).exits(0).json();
    assert_eq!(
        (&report["counts"]["missed_texels"], &report["rays"]["kind"]),
        (&0.into(), &"cage_file".into())
    );
    let other = line(&asset("NormalTangentTest/NormalTangentTest.glb")).exits(1).stderr;
    assert!(other.contains("make the cage by moving the vertices of the low model only"), "{other}");
}

#[test]
fn names_decide_what_parts_see() {
    let pair = Pair::new();
    fs::write(pair.path("low.glb"), named_plate([0.0, 0.0], &FULL, 1.0, "Roof_low")).expect("a file");
    let other = pair.path("other.glb");
    fs::write(pair.path("high.glb"), named_plate([0.0, 0.5], &FULL, 1.0, "roof_high")).expect("a file");
    fs::write(&other, named_plate([0.75, 0.75], &FULL, 1.0, "roof2_high")).expect("a file");
    let heights = |more: &[&str]| {
        let all = ["--high", text(&other), "--force", "--map", "height"];
        pair.bake(&[&all, more].concat()).exits(0);
        pair.texel("map.png").0[0]
    };
    // From 1 inside to 1 outside: the floor covers the roof.
    assert!((heights(&[]) - 0.875).abs() < 1e-4);
    assert!((heights(&["--match", "name"]) - (0.5 + 0.5 / 64.0)).abs() < 1e-4);
    let named = ["--high", text(&other), "--force", "--match", "name"];
    let left_out = pair.bake(&named).exits(0).stderr;
    assert!(left_out.contains("no part of the low model belongs to roof2_high"), "{left_out}");
    fs::write(pair.path("low.glb"), named_plate([0.0, 0.0], &FULL, 1.0, "Wall_low")).expect("a file");
    let alone = pair.bake(&["--force", "--match", "name"]).exits(1);
    assert!(alone.stderr.contains("no part of the high models belongs to Wall_low"), "{}", alone.stderr);
}

#[test]
fn cages_are_made_written_and_read_again() {
    let pair = Pair::new();
    let [low, high, cage] = ["low.glb", "high.glb", "cage.glb"].map(|name| pair.path(name));
    let bake = |output: &str, more: &[&str]| {
        let output = pair.path(output);
        let all = ["bake", text(&low), "--high", text(&high), "--size", "16", "-o", text(&output), "--json"];
        darboux(&[&all, more].concat())
    };
    let run = bake("made.png", &["--auto-cage", "--cage-offset", "2", "--write-cage", text(&cage)]).exits(0);
    let rays = run.json()["rays"].clone();
    let number = |name: &str| rays[name].as_f64().expect("a number");
    // The roof rises to 0.5; the margin is 2 % of the largest offset.
    assert_eq!(rays["kind"], "auto_cage");
    assert!(near(&[number("least"), number("most"), number("inwards")], &[0.53, 0.54, 0.04], 0.02), "{rays}");
    assert!(run.stderr.contains("which all but 0.001 of the rays allow"), "{}", run.stderr);
    assert_eq!(run.json()["cage"], text(&cage));
    let read = bake("read.png", &["--cage", text(&cage)]).exits(0).json();
    assert_eq!((&read["rays"]["kind"], &read["counts"]["missed_texels"]), (&json!("cage_file"), &json!(0)));
    assert_eq!(pair.texel("made.png"), pair.texel("read.png"));
    let refused = |more: &[&str], what: &str| {
        let stderr = bake("refused.png", more).exits(2).stderr;
        assert!(stderr.contains(what), "{stderr}");
    };
    refused(&["--auto-cage=1"], "expected a share from 0 on and below 1");
    refused(&["--auto-cage", "--distance", "1,1"], "cannot be used with");
    refused(&["--write-cage", text(&pair.path("cage.obj"))], "its name must end in .glb");
    let without = bake("refused.png", &["--offset-colors"]).exits(1).stderr;
    assert!(without.contains("without vertex colours, which --offset-colors needs"), "{without}");
}

#[test]
fn rays_are_straightened_by_an_amount_or_a_painted_image() {
    let pair = Pair::new();
    let [low_path, high_path] = ["low.glb", "high.glb"].map(|name| pair.path(name));
    // Normals that lean by 45 degrees.
    let low = plate([0.0, 0.0], &FULL, 1.0);
    let length = u32::from_le_bytes(low[12..16].try_into().expect("4 bytes")) as usize;
    let mut leaning = low;
    for normal in leaning[28 + length + 48..28 + length + 96].as_chunks_mut::<12>().0 {
        let half = 0.5f32.sqrt();
        normal.copy_from_slice([half, 0.0, half].map(f32::to_le_bytes).as_flattened());
    }
    fs::write(pair.path("low.glb"), leaning).expect("a file");
    let height = |name: &str, skew: &[&str]| {
        let distance = ["--distance", "2,2", "--map", "position", "--bits", "16"];
        let output = pair.path(name);
        let all = ["bake", text(&low_path), "--high", text(&high_path), "--size", "16"];
        darboux(&[&all[..], &["-o", text(&output)], &distance[..], skew].concat()).exits(0);
        fs::read(&output).expect("a map")
    };
    let paint = |name: &str, code: u8| {
        let path = pair.path(name);
        image::save_buffer(&path, &[code; 16 * 16], 16, 16, image::ColorType::L8).expect("a PNG");
        path.display().to_string()
    };
    let (white, black) = (paint("white.png", 255), paint("black.png", 0));
    let straight = height("straight.png", &["--skew", "1"]);
    let leaning = height("leaning.png", &[]);
    assert!(straight != leaning);
    assert_eq!(height("white_map.png", &["--skew", &white]), straight);
    assert_eq!(height("black_map.png", &["--skew", &black]), leaning);
    let all = ["bake", text(&low_path), "--high", text(&high_path), "-o", "x.png"];
    assert!(darboux(&[&all[..], &["--skew", "2"]].concat()).exits(2).stderr.contains("from 0 to 1"));
    let missing = darboux(&[&all[..], &["--skew", "missing.png"]].concat()).exits(1).stderr;
    assert!(missing.contains("missing.png: cannot be read"), "{missing}");
}

/// Most of a map that shows nothing is a mistake in most bakes, but not in all: decals cover little. So
/// scripts say what they allow.
#[test]
fn many_misses_are_a_warning_and_an_error_where_that_was_asked_for() {
    let pair = Pair::new();
    fs::write(pair.path("high.glb"), plate([0.0, 0.0], &["POSITION"], 0.2)).expect("a file");
    let run = pair.bake(&[]).exits(0);
    let sentence = "warning: most of the map shows nothing of the high models: the rays of 9";
    assert!(run.stderr.contains(sentence) && run.stderr.contains("misses.png"), "{}", run.stderr);
    pair.bake(&["--force", "--max-misses", "0.99"]).exits(0);
    for name in ["map.png", "map.misses.png"] {
        fs::remove_file(pair.path(name)).expect("a file of the bake");
    }
    let run = pair.bake(&["--max-misses", "0.5"]).exits(1);
    assert!(run.stderr.contains("which --max-misses 0.5 forbids, and nothing was written"), "{}", run.stderr);
    assert!(!pair.path("map.png").exists() && !pair.path("map.misses.png").exists());
    pair.bake(&["--max-misses", "1"]).exits(2);
    // In a job the sentence names the model.
    let job = pair.path("job.toml");
    let entry =
        "[[bake]]\nlow = \"low.glb\"\nhigh = \"high.glb\"\noutput = \"a.png\"\nsize = 16\ncage-offset = 1\n";
    fs::write(&job, entry).expect("a file");
    let run = darboux(&["bake", text(&job)]).exits(0);
    assert!(run.stderr.contains("low.glb: most of the map shows nothing"), "{}", run.stderr);
    fs::write(&job, format!("{entry}max-misses = 0.5\nforce = true\n")).expect("a file");
    darboux(&["bake", text(&job)]).exits(1);
}

/// Models of two programs often have other units, axes or places, for which no distance of rays is a cure.
#[test]
fn models_that_do_not_fit_are_told_apart() {
    let pair = Pair::new();
    let obj = |name: &str, corners: &[[f32; 3]]| {
        let mut text: String = corners.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
        text += "f 1 2 3 4\n";
        fs::write(pair.path(name), text).expect("a file");
    };
    let bake = |high: &str| {
        let [low, high, map] = ["low.glb", high, "map.png"].map(|name| pair.path(name));
        darboux(&["bake", text(&low), "--high", text(&high), "-o", text(&map), "--size", "8", "--force"])
    };
    let square = |by: f32, x: f32| {
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[u, v]| [x + by * u, by * v, 0.3])
    };
    obj("large.obj", &square(100.0, 0.0));
    assert!(
        bake("large.obj")
            .exits(1)
            .stderr
            .contains("100 times as large as the low one; export both in one unit")
    );
    obj("beside.obj", &square(1.0, 20.0));
    assert!(bake("beside.obj").exits(1).stderr.contains("lie beside the low one, 20.0 away"));
    obj("turned.obj", &square(1.0, 0.0).map(|[x, y, _]| [x, 0.02, -y]));
    assert!(bake("turned.obj").exits(1).stderr.contains("another axis up"));
}

/// A cage that was exported in another format often has its vertices in another order.
#[test]
fn a_cage_in_another_order_is_told() {
    let pair = Pair::new();
    let cage = plate([0.2, 0.2], &FULL, 1.0);
    fs::write(pair.path("cage.glb"), &cage).expect("a file");
    let [low, high, map, path] = ["low.glb", "high.glb", "map.png", "cage.glb"].map(|name| pair.path(name));
    let bake = |more: &[&str]| {
        let all = [
            "bake",
            text(&low),
            "--high",
            text(&high),
            "-o",
            text(&map),
            "--size",
            "8",
            "--force",
            "--cage",
            text(&path),
            "--json",
        ];
        darboux(&[&all[..], more].concat())
    };
    // The inner end of the rays can be chosen.
    let run = bake(&["--cage-offset", "0.5"]).exits(0);
    assert!(!run.stderr.contains("another order"), "{}", run.stderr);
    let rays = run.json()["rays"].clone();
    assert_eq!((&rays["kind"], rays["inwards"].as_f64()), (&json!("cage_file"), Some(0.5)));
    assert!(bake(&["--distance", "1,1"]).exits(2).stderr.contains("cannot be used with"));
    let turned = edited(&cage, |json| json["nodes"][0]["rotation"] = json!([0, 0, 1, 0]));
    fs::write(pair.path("cage.glb"), turned).expect("a file");
    let told = bake(&[]).stderr;
    assert!(told.contains("are in another order: export both from one program in one format"), "{told}");
}
