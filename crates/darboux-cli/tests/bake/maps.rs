//! The images: formats, bits, packing, dithering, tiles, and runs that must not write any.

use std::fs;
use std::path::Path;

use serde_json::json;

use crate::common::{asset, darboux, names_in, text};
use crate::pair::{FULL, LEANING, Pair, edited, grey, half_size_plate, near, painted_high, plate};

#[test]
fn a_normal_map_is_written_and_not_replaced_unasked() {
    let pair = Pair::new();
    let run = pair.bake(&[]).exits(0);
    assert!(run.stderr.contains("map.png: normal, 16 x 16, 8 bits"), "{}", run.stderr);
    assert!(run.stderr.contains("2 triangles onto 2, a cage at a distance of 1"), "{}", run.stderr);
    assert!(run.stderr.contains("no normals, so every triangle is flat"), "{}", run.stderr);
    // The normal leans by atan 0.5 against red; a code is nearest to it.
    let leaning = [0.5 - 0.5 / 5f64.sqrt(), 0.5, 0.5 + 1.0 / 5f64.sqrt()];
    assert!(near(&pair.texel("map.png").0, &leaning, 0.5 / 255.0 + 1e-6), "{:?}", pair.texel("map.png"));
    assert!(pair.bake(&[]).exits(2).stderr.contains("exists; use --force to replace it"));
    pair.bake(&["--force", "--bits", "16"]).exits(0);
    let (texel, bits) = pair.texel("map.png");
    assert!(bits == 16 && near(&texel, &leaning, 0.5 / 65535.0 + 1e-6), "{texel:?}");
    assert_eq!(names_in(pair.folder.path()), ["high.glb", "low.glb", "map.png"]);
}

#[test]
fn several_maps_share_a_run() {
    let pair = Pair::new();
    let report = pair.bake(&["--map", "normal,object-normal,height,ao,position", "--json"]).exits(0).json();
    let maps = report["maps"].as_array().expect("a list");
    let named: Vec<_> = maps.iter().map(|map| (map["map"].as_str(), map["bits"].as_u64())).collect();
    assert_eq!(
        named,
        [
            (Some("normal"), Some(8)),
            (Some("object-normal"), Some(8)),
            (Some("height"), Some(16)),
            (Some("ao"), Some(8)),
            (Some("position"), Some(16)),
        ]
    );
    // The centre of the first texel is at x = 1/32, y = 31/32; the roof is there 1/64 high.
    assert_eq!(maps[2]["range"], json!([[-1.0, 1.0]]));
    assert!(near(&pair.texel("map.height.png").0, &[0.5 + 0.5 / 64.0], 1e-5));
    assert_eq!(pair.texel("map.ao.png").0, [1.0]);
    let [x, y, z] =
        [0, 1, 2].map(|axis| [0, 1].map(|end| maps[4]["range"][axis][end].as_f64().expect("a number")));
    assert_eq!((x, y, z), ([0.0, 1.0], [0.0, 1.0], [0.0, 0.5]));
    assert!(near(&pair.texel("map.position.png").0, &[1.0 / 32.0, 31.0 / 32.0, 1.0 / 32.0], 1e-4));
    assert_eq!((&report["counts"]["rays"], &report["counts"]["missed_texels"]), (&256.into(), &0.into()));
    assert_eq!(report["rays"], json!({"kind": "cage", "offset": 1.0, "is_default": false}));
}

/// The first texel of a map, or all bytes, differ with an option from those without it.
#[test]
fn every_option_that_changes_a_map_acts() {
    let pair = Pair::new();
    let obj = |name: &str, text: &str| {
        fs::write(pair.path(name), text).expect("a file");
        pair.path(name)
    };
    let leaning = obj("leaning.obj", LEANING);
    let half_turned =
        "v 0 0 0\nv 0.5 0 0.2\nv 0.5 1 0.2\nv 0 1 0\nf 1 2 3 4\nv 1 0 0.5\nv 1 1 0.5\nf 3 6 5 2\n";
    let half_turned = obj("half_turned.obj", half_turned);
    let step =
        obj("step.obj", &format!("{LEANING}v 0.31 0 0.6\nv 1 0 0.6\nv 1 1 0.7\nv 0.31 1 0.6\nf 5 6 7 8\n"));
    let wall = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nv 0.2 0 0\nv 0.2 1 0\nv 0.2 1 0.4\nv 0.2 0 0.4\nf 5 6 7 8\n";
    let wall = obj("wall.obj", wall);
    let half = pair.path("half.glb");
    fs::write(&half, half_size_plate()).expect("a file");
    let (low, shield) = (pair.path("low.glb"), asset("made/shield.glb"));
    let map = pair.path("option.png");
    let baked = |low: &Path, high: &Path, more: &[&str]| {
        let line = ["bake", text(low), "--high", text(high), "-o", text(&map), "--force", "-q"];
        darboux(&[&line[..], more].concat()).exits(0);
        fs::read(&map).expect("a map")
    };
    let common = ["--size", "16", "--bits", "16", "--cage-offset", "1"];
    let ao = [&common[..], &["--map", "ao"]].concat();
    let near_only = ["--size", "64", "--bits", "16", "--cage-offset", "0.01"];
    let cases: [(&Path, &Path, &[&str], &[&str]); 8] = [
        (&low, &leaning, &common[2..], &["--size", "32"]),
        (&low, &step, &common, &["--samples", "16"]),
        (&low, &leaning, &common, &["--convention", "directx"]),
        (&half, &leaning, &common, &["--padding", "1"]),
        (&low, &wall, &ao, &["--ao-rays", "7"]),
        (&low, &wall, &ao, &["--ao-distance", "0.05"]),
        (&low, &half_turned, &common, &["--back-faces"]),
        (&shield, &shield, &near_only, &["--bitangent", "vertex"]),
    ];
    for (low, high, common, option) in cases {
        let without = baked(low, high, common);
        assert!(baked(low, high, &[common, option].concat()) != without, "{option:?}");
        assert!(baked(low, high, &[common, &["--jobs", "3"]].concat()) == without, "threads change nothing");
    }
}

#[test]
#[cfg(unix)]
fn ctrl_c_ends_a_bake_without_files() {
    use std::os::unix::process::ExitStatusExt;
    use std::process::{Command, Stdio};

    let pair = Pair::new();
    let [low, high, map] = ["low.glb", "high.glb", "map.png"].map(|name| pair.path(name));
    // Hours of rays.
    let line =
        ["bake", text(&low), "--high", text(&high), "-o", text(&map), "--size", "4096", "--samples", "256"];
    let mut run = Command::new("env")
        .args(["--default-signal=INT", env!("CARGO_BIN_EXE_darboux")])
        .args([&line[..], &["--map", "normal,ao", "--ao-rays", "1000", "--jobs", "1"]].concat())
        .stderr(Stdio::null())
        .spawn()
        .expect("the command starts");
    std::thread::sleep(std::time::Duration::from_secs(1));
    Command::new("kill").args(["-INT", &run.id().to_string()]).status().expect("a signal is sent");
    let ended = run.wait().expect("it ends");
    // Shells show 128 + 2.
    assert_eq!(ended.signal(), Some(2), "{ended}");
    assert_eq!(names_in(pair.folder.path()), ["high.glb", "low.glb"]);
}

#[test]
fn wrong_use_is_refused() {
    let pair = Pair::new();
    let says = |more: &[&str], code: i32, what: &str| {
        let stderr = pair.bake(more).exits(code).stderr;
        assert!(stderr.contains(what), "{stderr}");
    };
    says(&["--distance", "1,1"], 2, "cannot be used with");
    says(&["--samples", "5"], 2, "expected a square number");
    says(&["--bits", "12"], 2, "expected 8 or 16");
    says(&["--map", "curvy"], 2, "possible values");
    says(&["--map", "texture"], 2, "the map texture needs the option texture: the place");
    says(&["--texture", "occlusionTexture"], 2, "the option texture is for the map texture");
    says(&["--ao-falloff", "linear"], 2, "--ao-distance");
    says(&["--curvature-radius", "0texels"], 2, "texels such as 4texels");
    says(&["--uv-set", "3"], 1, "no triangles have TEXCOORD_3, onto which to bake; choose one of TEXCOORD_0");
    fs::write(pair.path("low.glb"), plate([0.0, 0.0], &["POSITION", "TEXCOORD_0"], 1.0)).expect("a file");
    says(&[], 1, "has no normals");
    pair.bake(&["--normals", "smooth"]).exits(0);
    let low = pair.path("low.glb");
    let onto_itself = darboux(&["bake", text(&low), "--high", text(&low), "-o", text(&low), "--force"]);
    assert!(onto_itself.exits(2).stderr.contains("must end in .png"));
    let from_stdin = darboux(&["bake", "-", "--high", text(&low), "-o", "map.png"]).exits(2);
    assert!(from_stdin.stderr.contains("save them to files first"));
}

/// The model is larger than the maps: with a limit between both it fails, and the maps must not stay behind.
#[cfg(unix)]
#[test]
fn nothing_is_written_when_one_of_several_outputs_fails() {
    let folder = tempfile::tempdir().expect("a folder");
    let line = r#"ulimit -f 120; trap "" XFSZ; exec "$0" bake "$1" --high "$1" -o n.png --size 256 --map normal,ao --ao-rays 4 --write-model w.glb"#;
    let run = std::process::Command::new("bash")
        .args(["-c", line, env!("CARGO_BIN_EXE_darboux"), text(&asset("made/shield.glb"))])
        .current_dir(folder.path())
        .output()
        .expect("bash runs");
    let stderr = String::from_utf8_lossy(&run.stderr);
    assert_eq!(run.status.code(), Some(1), "{stderr}");
    assert!(stderr.contains("w.glb"), "{stderr}");
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0, "{stderr}");
}

#[test]
fn exr_and_tiff_hold_numbers_as_they_are() {
    use exr::prelude::{FlatSamples, read_first_flat_layer_from_file};
    let pair = Pair::new();
    let to = |name: &str, more: &[&str]| {
        let [low, high, map] = ["low.glb", "high.glb", name].map(|name| pair.path(name));
        let line = [
            "bake",
            text(&low),
            "--high",
            text(&high),
            "-o",
            text(&map),
            "--size",
            "16",
            "--cage-offset",
            "1",
        ];
        darboux(&[&line[..], more].concat())
    };
    to("height.exr", &["--map", "height"]).exits(0);
    let image = read_first_flat_layer_from_file(pair.path("height.exr")).expect("an EXR");
    let layer = &image.layer_data;
    let FlatSamples::F32(heights) = &layer.channel_data.list[0].sample_data else { panic!("not 32 bits") };
    assert!(heights[..16].iter().enumerate().all(|(x, h)| (h - (x as f32 + 0.5) / 32.0).abs() < 1e-6));
    let comments = layer.attributes.comments.as_ref().expect("comments").to_string();
    assert!(comments.contains("Scale: [2.0]") && comments.contains("Middle: [0.0]"), "{comments}");
    to("normal.exr", &[]).exits(0);
    let image = read_first_flat_layer_from_file(pair.path("normal.exr")).expect("an EXR");
    let names: Vec<String> =
        image.layer_data.channel_data.list.iter().map(|channel| channel.name.to_string()).collect();
    assert_eq!(names, ["B", "G", "R"]);
    assert!(matches!(image.layer_data.channel_data.list[0].sample_data, FlatSamples::F16(_)));

    to("normal.tif", &[]).exits(0);
    to("normal.png", &["--bits", "16"]).exits(0);
    let file = std::io::BufReader::new(fs::File::open(pair.path("normal.tif")).expect("a TIFF"));
    let decoded = tiff::decoder::Decoder::new(file).and_then(|mut decoder| decoder.read_image());
    let tiff::decoder::DecodingResult::U16(codes) = decoded.expect("a TIFF") else { panic!("not 16 bits") };
    let shares: Vec<f64> = codes[..3].iter().map(|&code| f64::from(code) / 65535.0).collect();
    assert_eq!(shares, pair.texel("normal.png").0);
    assert!(to("other.exr", &["--bits", "8"]).exits(2).stderr.contains("choose 16 or 32"));
    assert!(to("other.exr", &["--verify"]).exits(2).stderr.contains("choose a PNG"));
}

#[test]
fn maps_are_packed_into_channels() {
    let pair = Pair::new();
    painted_high(&pair);
    let line = ["--pack", "orm=ao,roughness,metalness", "--map", "normal"];
    let report = pair.bake(&[&line[..], &["--json"]].concat()).exits(0).json();
    assert_eq!(report["maps"][1]["map"], "orm");
    assert_eq!(pair.texel("map.orm.png").0, [1.0, 64.0 / 255.0, 191.0 / 255.0]);
    assert!(pair.path("map.normal.png").exists() && !pair.path("map.ao.png").exists());
    let refused = |pack: &str| pair.bake(&["--force", "--pack", pack]).exits(2).stderr;
    assert!(refused("orm=ao,normal").contains("normal has 3 channels"));
    assert!(refused("orm=ao").contains("two to four maps") && refused("ao,height").contains("such as orm="));
}

#[test]
fn dithering_keeps_means_that_rounding_loses() {
    let pair = Pair::new();
    // Roughness 0.2525 is code 64.39.
    painted_high(&pair);
    let high = fs::read(pair.path("high.glb")).expect("a model");
    let high = edited(&high, |json| {
        json["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = json!(0.2525);
    });
    fs::write(pair.path("high.glb"), high).expect("a file");
    let mean = |more: &[&str]| {
        let [low, high, map] = ["low.glb", "high.glb", "map.png"].map(|name| pair.path(name));
        let all = ["bake", text(&low), "--high", text(&high), "-o", text(&map), "--size", "64"];
        let options = ["--cage-offset", "1", "--map", "roughness", "--force"];
        darboux(&[&all, &options[..], more].concat()).exits(0);
        let codes = grey(&pair.path("map.png"));
        (codes.iter().map(|&code| f64::from(code)).sum::<f64>() / codes.len() as f64, codes)
    };
    let exact = 255.0 * 0.2525;
    let (rounded, _) = mean(&[]);
    let (dithered, codes) = mean(&["--dither"]);
    assert!((rounded - 64.0).abs() < 1e-9 && (dithered - exact).abs() < 1e-3, "{rounded} {dithered}");
    let (_, one) = mean(&["--dither", "--jobs", "1"]);
    let (_, moved) = mean(&["--dither=7"]);
    assert!(one == codes && moved != codes);
}

/// The low model with its UVs moved by whole tiles to the right and upwards.
fn low_in_tile(columns: f32, rows: f32) -> Vec<u8> {
    let glb = plate([0.0, 0.0], &FULL, 1.0);
    let text = u32::from_le_bytes(glb[12..16].try_into().expect("4 bytes")) as usize;
    // Behind the positions and normals of four vertices.
    let first = 28 + text + 2 * 48;
    let mut moved = glb;
    for (at, word) in moved[first..first + 32].as_chunks_mut::<4>().0.iter_mut().enumerate() {
        let by = if at % 2 == 0 { columns } else { -rows };
        *word = (f32::from_le_bytes(*word) + by).to_le_bytes();
    }
    moved
}

#[test]
fn each_udim_tile_gets_an_image() {
    let pair = Pair::new();
    let [low_path, high_path] = ["low.glb", "high.glb"].map(|name| pair.path(name));
    fs::write(pair.path("low.glb"), low_in_tile(2.0, 1.0)).expect("a file");
    let bake = |output: &str, more: &[&str]| {
        let all = ["bake", text(&low_path), "--high", text(&high_path), "--size", "16"];
        darboux(&[&all[..], &["--cage-offset", "1", "-o", text(&pair.path(output))], more].concat())
    };
    let run = bake("crate.%UDIM%.png", &["--map", "normal,height", "--verify", "--json"]).exits(0);
    let report = run.json();
    assert_eq!(report["maps"][0]["udim"], 1013);
    assert_eq!(report["maps"][1]["file"], text(&pair.path("crate.1013.height.png")));
    assert_eq!(
        (&report["tiles"][0]["udim"], &report["counts"]["charted_texels"]),
        (&json!(1013), &json!(256))
    );
    assert!(report["tiles"][0]["verification"]["all"]["median"].as_f64().expect("a number") < 0.3);
    assert!(run.stderr.contains("tile 1013:") && pair.path("crate.1013.normal.png").exists());
    // The image is the one that a single tile has.
    bake("one.png", &[]).exits(0);
    assert_eq!(
        fs::read(pair.path("crate.1013.normal.png")).expect("a map"),
        fs::read(pair.path("one.png")).expect("a map")
    );
    assert!(
        bake("crate.<UDIM>.normal.png", &[]).exits(1).stderr.contains("1013.normal.png: exists; use --force")
    );
    let model = pair.path("baked.glb");
    let refused = |output: &str, more: &[&str], what: &str| {
        let stderr = bake(output, more).exits(2).stderr;
        assert!(stderr.contains(what), "{stderr}");
    };
    refused("n.%UDIM%.png", &["--write-model", text(&model)], "cannot have UDIM tiles");
    let heat = pair.path("heat.png");
    refused("n.%UDIM%.png", &["--verify", "--heat-map", text(&heat)], "write %UDIM% in its name");
    let heat = pair.path("heat.%UDIM%.png");
    refused("n.png", &["--verify", "--heat-map", text(&heat)], "belongs into the name of -o");
    fs::write(pair.path("low.glb"), low_in_tile(-3.0, 0.0)).expect("a file");
    assert!(bake("n.%UDIM%.png", &[]).exits(1).stderr.contains("tile -3 to the right of the first"));
    // A job has tiles as well, and knows which of their images are missing.
    fs::write(pair.path("low.glb"), low_in_tile(1.0, 0.0)).expect("a file");
    let job = pair.path("job.toml");
    fs::write(&job, "[[bake]]\nlow = \"low.glb\"\nhigh = \"high.glb\"\noutput = \"j.%UDIM%.png\"\nsize = 8\ncage-offset = 1\n").expect("a file");
    let resumed =
        || darboux(&["bake", text(&job), "--resume", "--json"]).exits(0).json()["up_to_date"].clone();
    assert_eq!((resumed(), resumed()), (json!(0), json!(1)));
    fs::remove_file(pair.path("j.1002.png")).expect("a map");
    assert_eq!(resumed(), 0);
}

/// A map of what no high model has is told.
#[test]
fn maps_of_nothing_are_told() {
    let pair = Pair::new();
    painted_high(&pair);
    let told = |more: &[&str]| pair.bake(&[&["--force"], more].concat()).exits(0).stderr;
    assert!(told(&["--map", "vertex-color"]).contains("high.glb: has no vertex colours"));
    let none = told(&["--map", "texture", "--texture", "specular"]);
    assert!(none.contains("high.glb: no material has a texture at specular"), "{none}");
    assert!(!told(&["--map", "base-color"]).contains("vertex colours"));
}
