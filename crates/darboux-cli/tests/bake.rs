//! `darboux bake`: what it writes, what it advises and what it refuses.

mod common;

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use common::{Run, asset, darboux, names_in, text};

/// A square plate over [0, 1] x [0, 1] with heights at x = 0 and x = 1, as the bytes of a GLB.
fn plate(heights: [f32; 2], attributes: &[&str], scale: f32) -> Vec<u8> {
    named_plate(heights, attributes, scale, "plate")
}

/// As [`plate`], with a name of its node.
fn named_plate(heights: [f32; 2], attributes: &[&str], scale: f32, name: &str) -> Vec<u8> {
    let places = [[0.0f32, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let positions: Vec<f32> = places.iter().flat_map(|p| [p[0], p[1], heights[p[0] as usize]]).collect();
    let normals: Vec<f32> = places.iter().flat_map(|_| [0.0, 0.0, 1.0]).collect();
    let uvs: Vec<f32> = places.iter().flat_map(|p| [p[0], 1.0 - p[1]]).collect();
    let mut bytes: Vec<u8> = Vec::new();
    let mut views = Vec::new();
    // Against the UVs, so that they are told from computed ones.
    let tangents: Vec<f32> = places.iter().flat_map(|_| [0.0, 1.0, 0.0, 1.0]).collect();
    for floats in [&positions, &normals, &uvs, &tangents] {
        views.push(json!({"buffer": 0, "byteOffset": bytes.len(), "byteLength": 4 * floats.len()}));
        bytes.extend(floats.iter().flat_map(|x| x.to_le_bytes()));
    }
    views.push(json!({"buffer": 0, "byteOffset": bytes.len(), "byteLength": 12}));
    bytes.extend([0u16, 1, 2, 0, 2, 3].iter().flat_map(|i| i.to_le_bytes()));
    let all = json!({"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2, "TANGENT": 3});
    let kept: serde_json::Map<String, Value> =
        attributes.iter().map(|&name| (name.to_owned(), all[name].clone())).collect();
    let json = json!({
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": name, "mesh": 0, "scale": [scale, scale, scale]}],
        "meshes": [{"primitives": [{"attributes": kept, "indices": 4}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, heights[0].min(heights[1])], "max": [1, 1, heights[0].max(heights[1])]},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2"},
            {"bufferView": 3, "componentType": 5126, "count": 4, "type": "VEC4"},
            {"bufferView": 4, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": views,
        "buffers": [{"byteLength": bytes.len()}],
    });
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut glb = b"glTF\x02\0\0\0".to_vec();
    glb.extend(((28 + text.len() + bytes.len()) as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", &text), (b"BIN\0", &bytes)] {
        glb.extend((chunk.len() as u32).to_le_bytes());
        glb.extend(kind);
        glb.extend(chunk);
    }
    glb
}

const FULL: [&str; 3] = ["POSITION", "NORMAL", "TEXCOORD_0"];

/// A folder with a flat low model and a high model whose roof rises by one half.
struct Pair {
    folder: tempfile::TempDir,
}

impl Pair {
    fn new() -> Self {
        let pair = Self { folder: tempfile::tempdir().expect("a folder") };
        fs::write(pair.path("low.glb"), plate([0.0, 0.0], &FULL, 1.0)).expect("a file");
        fs::write(pair.path("high.glb"), plate([0.0, 0.5], &["POSITION"], 1.0)).expect("a file");
        pair
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn bake(&self, more: &[&str]) -> Run {
        let [low, high, map] = ["low.glb", "high.glb", "map.png"].map(|name| self.path(name));
        let all = [
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
        darboux(&[&all, more].concat())
    }

    /// The channels of the first texel of a PNG, from 0 to 1, and its bits per channel.
    fn texel(&self, name: &str) -> (Vec<f64>, u8) {
        let file = std::io::BufReader::new(fs::File::open(self.path(name)).expect("a map"));
        let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
        let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
        let info = reader.next_frame(&mut bytes).expect("texels");
        let samples = info.color_type.samples();
        match info.bit_depth {
            png::BitDepth::Sixteen => {
                let words = bytes.as_chunks::<2>().0[..samples].iter();
                (words.map(|&word| f64::from(u16::from_be_bytes(word)) / 65535.0).collect(), 16)
            }
            _ => (bytes[..samples].iter().map(|&byte| f64::from(byte) / 255.0).collect(), 8),
        }
    }
}

fn near(a: &[f64], b: &[f64], by: f64) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= by)
}

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
    assert!(
        near(&x, &[1.0 / 32.0, 31.0 / 32.0], 1e-6)
            && near(&y, &x, 1e-6)
            && near(&z, &[1.0 / 64.0, 31.0 / 64.0], 1e-6)
    );
    assert!(near(&pair.texel("map.position.png").0, &[0.0, 1.0, 0.0], 1e-4));
    assert_eq!((&report["counts"]["rays"], &report["counts"]["missed_texels"]), (&256.into(), &0.into()));
    assert_eq!(report["rays"], json!({"kind": "cage", "offset": 1.0, "is_default": false}));
}

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

/// The pixels of an RGB picture with 8 bits.
fn rgb(path: &Path) -> Vec<[u8; 3]> {
    image::open(path).expect("a picture").to_rgb8().pixels().map(|pixel| pixel.0).collect()
}

#[test]
fn verification_prints_degrees_and_draws_them() {
    let pair = Pair::new();
    let heat = pair.path("heat.png");
    let run = pair.bake(&["--verify", "--heat-map", text(&heat), "--json"]).exits(0);
    for words in ["error in degrees", "by rounding to its bits", "inside charts", "with the other green"] {
        assert!(run.stderr.contains(words), "{}", run.stderr);
    }
    let verification = run.json()["verification"].clone();
    let number = |of: &Value, name: &str| of[name].as_f64().expect("a number");
    // The roof has one normal, which 8 bits hold to half a code: below sqrt(3) / 255 radians.
    let limit = (3f64.sqrt() / 255.0).to_degrees();
    assert!(number(&verification["all"], "worst") < limit, "{verification}");
    assert!(number(&verification["all"], "median") > 1e-4, "{verification}");
    assert_eq!(number(&verification["all"], "points"), 256.0);
    assert!(
        (number(&verification["all"], "median") - number(&verification["rounding"], "median")).abs() < 1e-3
    );
    assert_eq!(verification["places"][0][0], "inside");
    assert_eq!(verification["mistakes"][1][0], "other_green");
    assert_eq!(image::image_dimensions(&heat).expect("a picture"), (16, 16 + 38));
    // 16 bits are better by 2 to the 8th.
    let fine = pair.bake(&["--verify", "--force", "--bits", "16", "--json"]).exits(0).json();
    assert!(number(&fine["verification"]["all"], "worst") < limit / 200.0, "{fine}");
    assert!(fine["verification"]["heat_map"].is_null());
    assert!(pair.bake(&["--force", "--json"]).exits(0).json()["verification"].is_null());
    let no_map = pair.bake(&["--force", "--verify", "--map", "height"]).exits(2).stderr;
    assert!(no_map.contains("--verify needs a normal map"), "{no_map}");
    assert!(pair.bake(&["--force", "--heat-map", text(&heat)]).exits(2).stderr.contains("--verify"));
}

#[test]
fn errors_are_painted_on_the_model() {
    let pair = Pair::new();
    let painted = pair.path("painted.glb");
    let report = pair.bake(&["--verify", "--heat-model", text(&painted), "--json"]).exits(0).json();
    assert_eq!(report["verification"]["heat_model"], text(&painted));
    let glb = fs::read(&painted).expect("a model");
    let material_of = |glb: &[u8]| {
        let mut material = Value::Null;
        edited(glb, |json| material = json["materials"][0].clone());
        material
    };
    let material = material_of(&glb);
    // Light and a normal map would change the colours.
    let color = &material["pbrMetallicRoughness"]["baseColorTexture"];
    assert!(color["texCoord"] == 0 && color["index"].is_u64(), "{material}");
    assert!(material["normalTexture"].is_null(), "{material}");
    assert_eq!(material["extensions"]["KHR_materials_unlit"], json!({}), "{material}");
    let scale = pair.path("painted.scale.png");
    assert_eq!(image::image_dimensions(&scale).expect("a picture").0, 512);
    let checked = darboux(&["check", text(&painted), "--json"]);
    assert!(checked.code < 2, "{}", checked.stderr);
    fs::write(pair.path("low.glb"), half_size_plate()).expect("a file");
    let wide = ["--verify", "--heat-model", text(&painted), "--heat-range", "0.1,90", "--force"];
    let run = pair.bake(&wide).exits(0);
    let said = [run.stderr, String::from_utf8_lossy(&run.stdout).into_owned()].concat();
    assert!(said.contains("from 0.1 to 90 degrees"), "{said}");
    let material = material_of(&fs::read(&painted).expect("a model"));
    let color = &material["pbrMetallicRoughness"]["baseColorTexture"];
    assert_eq!(color["extensions"]["KHR_texture_transform"]["scale"], json!([0.5, 0.5]), "{material}");
    assert!(pair.bake(&["--force", "--heat-model", text(&painted)]).exits(2).stderr.contains("--verify"));
    let gltf = pair.path("painted.gltf");
    let refused = pair.bake(&["--force", "--verify", "--heat-model", text(&gltf)]).exits(2).stderr;
    assert!(refused.contains("must end in .glb"), "{refused}");
}

#[test]
fn a_model_is_written_that_bakes_to_the_same_map() {
    let pair = Pair::new();
    for (case, method) in [("mikktspace", None), ("lengyel", Some("lengyel"))] {
        let model = pair.path(&format!("{case}.glb"));
        let mut more = vec!["--force", "--bits", "16", "--write-model", text(&model), "--json"];
        more.extend(method.iter().flat_map(|method| ["--method", *method]));
        let report = pair.bake(&more).exits(0).json();
        assert_eq!(report["model"], text(&model));
        let map = fs::read(pair.path("map.png")).expect("a map");
        let checked = darboux(&["check", text(&model), "--json"]);
        // The high surface leans as a whole, and so does its map of one colour. Nothing else is found.
        let checked = checked.json();
        let findings = checked["files"][0]["findings"].as_array().expect("a list");
        assert!(findings.iter().all(|finding| finding["code"] == "map-flat-off"), "{findings:?}");
        let inspected = darboux(&["inspect", text(&model), "--json"]).exits(0).json().to_string();
        assert!(inspected.contains("\"has_tangents\":true"), "{inspected}");
        // Its own tangents give the same map.
        let [high, again] = ["high.glb", "again.png"].map(|name| pair.path(name));
        let line =
            ["bake", text(&model), "--high", text(&high), "-o", text(&again), "--size", "16", "--bits", "16"];
        darboux(&[&line[..], &["--cage-offset", "1", "--force"]].concat()).exits(0);
        assert_eq!(fs::read(&again).expect("a map"), map, "{case}");
        // The map lies in the model, byte for byte.
        let bytes = fs::read(&model).expect("a model");
        assert!(bytes.windows(map.len()).any(|window| window == map), "{case}");
    }
    let model = pair.path("model.glb");
    let refused = |more: &[&str], what: &str| {
        let all = ["--force", "--write-model", text(&model)];
        let stderr = pair.bake(&[&all, more].concat()).exits(2).stderr;
        assert!(stderr.contains(what), "{stderr}");
    };
    refused(&["--convention", "unreal"], "needs a map in glTF's convention");
    refused(&["--map", "height"], "--write-model needs a map that materials have");
    let gltf = pair.path("model.gltf");
    assert!(
        pair.bake(&["--force", "--write-model", text(&gltf)]).exits(2).stderr.contains("must end in .glb")
    );
    assert!(!model.exists() && !gltf.exists());
}

#[test]
fn object_space_maps_become_tangent_space_ones_and_back() {
    let pair = Pair::new();
    pair.bake(&["--bits", "16", "--map", "normal,object-normal", "--convention", "unreal"]).exits(0);
    let [low, object, tangent] =
        ["low.glb", "map.object-normal.png", "map.normal.png"].map(|name| pair.path(name));
    let convert = |from: &Path, to: &str, space: &str, output: &str| {
        let output = pair.path(output);
        let all = ["convert", text(from), "--from", "unreal", "--to", to, "--space", space, "--force"];
        darboux(&[&all[..], &["--model", text(&low), "-o", text(&output)]].concat()).exits(0)
    };
    let one_code = 1.0 / 65535.0 + 1e-9;
    convert(&object, "unreal", "tangent", "t.png");
    assert!(near(&pair.texel("t.png").0, &pair.texel("map.normal.png").0, one_code));
    convert(&tangent, "unreal", "object", "o.png");
    assert!(near(&pair.texel("o.png").0, &pair.texel("map.object-normal.png").0, one_code));
    // The roof leans along red only, so green is the same up to its rounding in both conventions.
    let run = convert(&object, "gltf", "tangent", "g.png");
    assert!(run.stderr.contains("tangent space, 256 texels in charts"), "{}", run.stderr);
    assert!(near(&pair.texel("g.png").0, &pair.texel("map.normal.png").0, one_code));
    let refused = |more: &[&str], what: &str| {
        let all = ["convert", text(&object), "--from", "gltf", "--to", "gltf"];
        let stderr = darboux(&[&all, more].concat()).exits(2).stderr;
        assert!(stderr.contains(what), "{stderr}");
    };
    refused(&["--space", "tangent"], "--model");
    refused(&["--model", text(&low)], "--space");
    refused(&["--space", "object", "--model", text(&low), "--layout", "rg"], "name three channels");
    refused(
        &["--space", "object", "--model", text(&low), "--to-layout", "rg"],
        "cannot be used with --space",
    );
}

/// A plate that leans along both axes of the image, as an OBJ.
const LEANING: &str = "v 0 0 0\nv 1 0 0.5\nv 1 1 0.2\nv 0 1 -0.3\nf 1 2 3 4\n";

/// Both maps of a bake in one convention are converted into every other one.
#[test]
fn spaces_are_converted_between_all_conventions() {
    let pair = Pair::new();
    let [low, high] = ["low.glb", "leaning.obj"].map(|name| pair.path(name));
    fs::write(&high, LEANING).expect("a file");
    let names = ["gltf", "unreal", "unity", "directx"];
    for name in names {
        let maps = pair.path(&format!("{name}.png"));
        let line = ["bake", text(&low), "--high", text(&high), "-o", text(&maps), "--size", "16"];
        let more = ["--map", "normal,object-normal", "--bits", "16", "--convention", name];
        darboux(&[&line[..], &more, &["--cage-offset", "1"]].concat()).exits(0);
    }
    let mut seen: Vec<Vec<f64>> = Vec::new();
    for from in names {
        for to in names {
            for (space, of, kind) in
                [("tangent", "object-normal", "normal"), ("object", "normal", "object-normal")]
            {
                let [map, result] =
                    [format!("{from}.{of}.png"), format!("{from}-{to}.png")].map(|name| pair.path(&name));
                let line = ["convert", text(&map), "--from", from, "--to", to, "--space", space, "--force"];
                darboux(&[&line[..], &["--model", text(&low), "-o", text(&result)]].concat()).exits(0);
                let (found, _) = pair.texel(&format!("{from}-{to}.png"));
                let (expected, _) = pair.texel(&format!("{to}.{kind}.png"));
                // Both roundings, of half a code each, through a frame of orthogonal unit vectors.
                assert!(
                    near(&found, &expected, 2.0 / 65535.0),
                    "{from} {to} {space}: {found:?} {expected:?}"
                );
                seen.push(expected);
            }
        }
    }
    // The conventions tell themselves apart on this plate.
    assert!(seen.iter().any(|texel| !near(texel, &seen[0], 0.1)));
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
fn faces_of_an_obj_with_many_corners_are_baked() {
    let pair = Pair::new();
    // A plate as one face of eight corners.
    let corners =
        "v 0 0 0.2\nv 0.5 0 0.2\nv 1 0 0.2\nv 1 0.5 0.2\nv 1 1 0.2\nv 0.5 1 0.2\nv 0 1 0.2\nv 0 0.5 0.2\n";
    fs::write(pair.path("n.obj"), format!("{corners}f 1 2 3 4 5 6 7 8\n")).expect("a file");
    let [low, high, map] = ["low.glb", "n.obj", "map.png"].map(|name| pair.path(name));
    let line = ["bake", text(&low), "--high", text(&high), "-o", text(&map), "--size", "20", "--json"];
    let counts = darboux(&[&line[..], &["--cage-offset", "1"]].concat()).exits(0).json()["counts"].clone();
    let [triangles, missed] = ["high_triangles", "missed_texels"].map(|name| counts[name].clone());
    assert_eq!((triangles, missed), (json!(6), json!(0)), "{counts}");
}

#[test]
fn an_obj_can_be_the_low_model() {
    let pair = Pair::new();
    let corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n";
    fs::write(pair.path("low.obj"), format!("{corners}f 1/1/1 2/2/1 3/3/1 4/4/1\n")).expect("a file");
    let [obj, high, map, model] = ["low.obj", "high.glb", "obj.png", "obj.glb"].map(|name| pair.path(name));
    let line = ["bake", text(&obj), "--high", text(&high), "-o", text(&map), "--size", "16"];
    let more = ["--cage-offset", "1", "--bits", "16", "--write-model", text(&model)];
    darboux(&[&line[..], &more].concat()).exits(0);
    pair.bake(&["--bits", "16"]).exits(0);
    assert_eq!(pair.texel("obj.png"), pair.texel("map.png"));
    let of_model = darboux(&["compare", text(&model), "--method", "mikktspace", "--json"]).exits(0).json();
    assert_eq!(of_model["verdict"], "identical");
    let spaces = ["convert", text(&map), "--space", "object", "--model", text(&obj), "--from", "gltf"];
    let output = pair.path("object.png");
    darboux(&[&spaces[..], &["--to", "gltf", "-o", text(&output)]].concat()).exits(0);
}

#[test]
fn an_obj_can_be_the_high_model() {
    let pair = Pair::new();
    let obj = "v 0 0 0\nv 1 0 0.5\nv 1 1 0.5\nv 0 1 0\nf 1 2 3 4\n";
    fs::write(pair.path("high.obj"), obj).expect("a file");
    pair.bake(&["--bits", "16"]).exits(0);
    let expected = fs::read(pair.path("map.png")).expect("a map");
    let [low, high, map] = ["low.glb", "high.obj", "map.png"].map(|name| pair.path(name));
    let line = ["bake", text(&low), "--high", text(&high), "-o", text(&map), "--size", "16", "--force"];
    darboux(&[&line[..], &["--cage-offset", "1", "--bits", "16"]].concat()).exits(0);
    assert_eq!(fs::read(&map).expect("a map"), expected);
}

/// The normal map of the first bake becomes that of a high model, which is baked onto the same layout again.
#[test]
fn normal_maps_of_high_models_count() {
    let pair = Pair::new();
    let mapped = pair.path("mapped.glb");
    pair.bake(&["--bits", "16", "--write-model", text(&mapped)]).exits(0);
    let (leaning, _) = pair.texel("map.png");
    let [low, map] = ["low.glb", "map.png"].map(|name| pair.path(name));
    let line = ["bake", text(&low), "--high", text(&mapped), "-o", text(&map), "--size", "16", "--force"];
    let again = |more: &[&str]| {
        darboux(&[&line[..], &["--cage-offset", "0.01", "--bits", "16"], more].concat()).exits(0);
        pair.texel("map.png").0
    };
    assert!(near(&again(&[]), &leaning, 1.5 / 65535.0));
    assert!(near(&again(&["--no-high-maps"]), &[0.5, 0.5, 1.0], 1.0 / 65535.0));
}

/// A plate whose normal map shows its UVs at half their size.
fn half_size_plate() -> Vec<u8> {
    edited(&plate([0.0, 0.0], &FULL, 1.0), |json| {
        json["meshes"][0]["primitives"][0]["material"] = 0.into();
        let transform = json!({"KHR_texture_transform": {"scale": [0.5, 0.5]}});
        json["materials"] = json!([{"normalTexture": {"index": 0, "extensions": transform}}]);
        json["textures"] = json!([{}]);
        json["extensionsUsed"] = json!(["KHR_texture_transform"]);
    })
}

/// A GLB with its JSON edited.
fn edited(glb: &[u8], edit: impl FnOnce(&mut Value)) -> Vec<u8> {
    let length = u32::from_le_bytes([glb[12], glb[13], glb[14], glb[15]]) as usize;
    let mut json: Value = serde_json::from_slice(&glb[20..20 + length]).expect("JSON");
    edit(&mut json);
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let rest = &glb[20 + length..];
    let mut out = b"glTF\x02\0\0\0".to_vec();
    out.extend(((20 + text.len() + rest.len()) as u32).to_le_bytes());
    out.extend((text.len() as u32).to_le_bytes());
    out.extend(b"JSON");
    [out, text, rest.to_vec()].concat()
}

#[test]
fn a_material_can_be_chosen_and_several_are_named() {
    let pair = Pair::new();
    let two = edited(&plate([0.0, 0.0], &FULL, 1.0), |json| {
        let primitive = json["meshes"][0]["primitives"][0].clone();
        json["meshes"][0]["primitives"] = json!([primitive, primitive]);
        json["meshes"][0]["primitives"][0]["material"] = 0.into();
        json["meshes"][0]["primitives"][1]["material"] = 1.into();
        json["materials"] = json!([{}, {}]);
    });
    fs::write(pair.path("low.glb"), two).expect("a file");
    let all = pair.bake(&["--json"]).exits(0);
    assert!(all.stderr.contains("2 materials share this map"), "{}", all.stderr);
    let one = pair.bake(&["--json", "--force", "--material", "1"]).exits(0);
    assert!(!one.stderr.contains("materials share"), "{}", one.stderr);
    let count = |run: &Run, name: &str| run.json()["counts"][name].clone();
    assert_eq!(["overlapping_texels", "chart_area"].map(|name| count(&all, name)), [json!(256), json!(512)]);
    assert_eq!(["overlapping_texels", "chart_area"].map(|name| count(&one, name)), [json!(0), json!(256)]);
    assert!(all.stderr.contains("are covered 2.00 times on average"), "{}", all.stderr);
    let none = pair.bake(&["--force", "--material", "2"]).exits(1).stderr;
    assert!(none.contains("low.glb: no triangles have materials[2]; choose one of 0, 1"), "{none}");
}

#[test]
fn the_texture_transform_of_the_low_model_counts() {
    let pair = Pair::new();
    fs::write(pair.path("low.glb"), half_size_plate()).expect("a file");
    let model = pair.path("model.glb");
    let line = ["--json", "--write-model", text(&model)];
    let counts = pair.bake(&line).exits(0).json()["counts"].clone();
    assert_eq!((&counts["charted_texels"], &counts["texels"]), (&json!(64), &json!(256)));
    // The written model keeps the transform, so that the map fits it.
    let kept = String::from_utf8_lossy(&fs::read(&model).expect("a model")).contains("\"scale\":[0.5,0.5]");
    assert!(kept);
}

#[test]
fn tangents_of_another_uv_set_are_computed() {
    let pair = Pair::new();
    let tangents = ["POSITION", "NORMAL", "TEXCOORD_0", "TANGENT"];
    let low = edited(&plate([0.0, 0.0], &tangents, 1.0), |json| {
        json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = 2.into();
    });
    fs::write(pair.path("low.glb"), low).expect("a file");
    let texel = |more: &[&str]| {
        pair.bake(&[&["--bits", "16", "--force"], more].concat()).exits(0);
        pair.texel("map.png").0
    };
    let [leaning, upright] = [0.5 - 0.5 / 5f64.sqrt(), 0.5 + 1.0 / 5f64.sqrt()];
    // The file's tangents point up; those of the second set, which has the same UVs, to the right.
    assert!(near(&texel(&[]), &[0.5, 1.0 - leaning, upright], 1e-5));
    assert!(near(&texel(&["--uv-set", "1"]), &[leaning, 0.5, upright], 1e-5));
    let model = pair.path("model.glb");
    texel(&["--uv-set", "1", "--write-model", text(&model)]);
    let of_model = darboux(&["compare", text(&model), "--method", "mikktspace", "--json"]).exits(0).json();
    assert_eq!(of_model["verdict"], "identical");
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
fn a_model_that_is_low_and_high_is_warned_about_once() {
    let pair = Pair::new();
    let broken = edited(&plate([0.0, 0.0], &FULL, 1.0), |json| {
        json["extensionsUsed"] = json!(["EXT_unheard_of"]);
    });
    fs::write(pair.path("low.glb"), broken).expect("a file");
    let [low, map] = ["low.glb", "map.png"].map(|name| pair.path(name));
    let line = ["bake", text(&low), "--high", text(&low), "-o", text(&map), "--size", "8", "--json"];
    let report = darboux(&line).exits(0).json();
    let warnings: Vec<String> =
        report["warnings"].as_array().expect("a list").iter().map(Value::to_string).collect();
    assert_eq!(warnings.iter().collect::<std::collections::HashSet<_>>().len(), warnings.len());
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
    says(&["--map", "texture"], 2, "--texture names the place");
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

#[test]
fn tangents_come_from_the_file_unless_a_method_is_named() {
    let pair = Pair::new();
    fs::write(pair.path("low.glb"), plate([0.0, 0.0], &["POSITION", "NORMAL", "TEXCOORD_0", "TANGENT"], 1.0))
        .expect("a file");
    let [leaning, upright] = [0.5 + 0.5 / 5f64.sqrt(), 0.5 + 1.0 / 5f64.sqrt()];
    // The file's tangents point up and its bitangents to the left, where the normal leans.
    pair.bake(&["--bits", "16"]).exits(0);
    assert!(near(&pair.texel("map.png").0, &[0.5, leaning, upright], 1e-5), "{:?}", pair.texel("map.png"));
    pair.bake(&["--bits", "16", "--force", "--method", "mikktspace"]).exits(0);
    assert!(near(&pair.texel("map.png").0, &[1.0 - leaning, 0.5, upright], 1e-5));
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

/// The JSON of a GLB.
fn json_of(path: &Path) -> Value {
    let glb = fs::read(path).expect("a model");
    let length = u32::from_le_bytes([glb[12], glb[13], glb[14], glb[15]]) as usize;
    serde_json::from_slice(&glb[20..20 + length]).expect("JSON")
}

/// A high model whose material has colour, roughness, metalness and light.
fn painted_high(pair: &Pair) {
    let high = edited(&plate([0.0, 0.0], &["POSITION"], 1.0), |json| {
        json["meshes"][0]["primitives"][0]["material"] = 0.into();
        json["materials"] = json!([{
            "name": "paint",
            "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 1], "roughnessFactor": 0.25, "metallicFactor": 0.75},
            "emissiveFactor": [1, 1, 0.5],
            "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}},
        }]);
        json["extensionsUsed"] = json!(["KHR_materials_emissive_strength"]);
    });
    fs::write(pair.path("high.glb"), high).expect("a file");
}

#[test]
fn materials_are_transferred_and_put_where_gltf_wants_them() {
    let pair = Pair::new();
    painted_high(&pair);
    let model = pair.path("baked.glb");
    let maps = "normal,ao,base-color,roughness,metalness,emission,id,uv-islands";
    let report = pair.bake(&["--map", maps, "--write-model", text(&model), "--json"]).exits(0).json();
    // 0.5 in linear light is 188 in sRGB.
    assert_eq!(pair.texel("map.base-color.png").0, [1.0, 188.0 / 255.0, 0.0]);
    assert_eq!(pair.texel("map.roughness.png").0, [64.0 / 255.0]);
    assert_eq!(pair.texel("map.metalness.png").0, [191.0 / 255.0]);
    assert_eq!(pair.texel("map.emission.png").0, [1.0, 1.0, 188.0 / 255.0]);
    assert_eq!(report["maps"][5]["range"][0], json!([0.0, 4.0]));
    let legend: Value =
        serde_json::from_slice(&fs::read(pair.path("map.id.json")).expect("a legend")).expect("JSON");
    assert_eq!((&legend[0]["name"], &legend[0]["texels"]), (&json!("paint"), &json!(256)));
    assert_eq!(report["legends"].as_array().map(Vec::len), Some(2));
    let json = json_of(&model);
    let material = &json["materials"][0];
    let metallic = &material["pbrMetallicRoughness"];
    assert_eq!(material["occlusionTexture"]["index"], metallic["metallicRoughnessTexture"]["index"]);
    assert_eq!(metallic["baseColorFactor"], json!([1, 1, 1, 1]));
    assert!((&metallic["roughnessFactor"], &metallic["metallicFactor"]) == (&json!(1), &json!(1)));
    assert_eq!(material["emissiveFactor"], json!([1, 1, 1]));
    let strength = &material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"];
    assert_eq!(strength.as_f64(), Some(4.0));
    assert_eq!(json["textures"].as_array().map(Vec::len), Some(4));
    // Its materials give the same maps again.
    let again = pair.path("again.png");
    let line =
        ["bake", text(&pair.path("low.glb")), "--high", text(&model), "-o", text(&again)].map(str::to_owned);
    let line: Vec<&str> = line.iter().map(String::as_str).collect();
    let more = ["--size", "16", "--cage-offset", "0.01", "--map", "base-color,roughness,metalness"];
    darboux(&[&line[..], &more].concat()).exits(0);
    for map in ["base-color", "roughness", "metalness"] {
        let [first, second] = ["map", "again"].map(|name| fs::read(pair.path(&format!("{name}.{map}.png"))));
        assert_eq!(first.expect("a map"), second.expect("a map"), "{map}");
    }
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

/// The codes of a grey PNG of 8 bits.
fn grey(path: &Path) -> Vec<u8> {
    let file = std::io::BufReader::new(fs::File::open(path).expect("a map"));
    let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
    let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
    reader.next_frame(&mut bytes).expect("texels");
    bytes
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
        let run =
            darboux(&[&all[..], &["-o", text(&output), "--json"], &distance[..], skew].concat()).exits(0);
        run.json()["maps"][0]["range"][0].clone()
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
