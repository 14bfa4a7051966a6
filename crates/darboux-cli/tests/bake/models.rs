//! The models that are read and written: OBJ, materials, tangents, texture transforms, transfer, errors by
//! vertex.

use std::fs;

use serde_json::{Value, json};

use crate::common::{Run, darboux, text};
use crate::pair::{FULL, Pair, edited, half_size_plate, json_of, near, painted_high, plate};

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
fn a_model_that_is_low_and_high_is_warned_about_once() {
    let pair = Pair::new();
    let plate =
        "mtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1\n";
    fs::write(pair.path("low.obj"), plate).expect("a file");
    let [low, map] = ["low.obj", "map.png"].map(|name| pair.path(name));
    let line = ["bake", text(&low), "--high", text(&low), "-o", text(&map), "--size", "8", "--json"];
    let report = darboux(&line).exits(0).json();
    let warnings = report["warnings"].as_array().expect("a list");
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(warnings[0].as_str().is_some_and(|warning| warning.contains("gone.mtl")), "{warnings:?}");
}

/// Renderers do not agree below a node that mirrors.
#[test]
fn low_parts_below_mirroring_nodes_are_warned_about() {
    let pair = Pair::new();
    let told = |scale: [i32; 3]| {
        let low = edited(&plate([0.0, 0.0], &FULL, 1.0), |json| json["nodes"][0]["scale"] = json!(scale));
        fs::write(pair.path("low.glb"), low).expect("a file");
        let high =
            edited(&plate([0.0, 0.5], &["POSITION"], 1.0), |json| json["nodes"][0]["scale"] = json!(scale));
        fs::write(pair.path("high.glb"), high).expect("a file");
        let run = pair.bake(&["--force"]).exits(0);
        run.stderr.contains("low.glb: 1 part lies below a node that mirrors it")
    };
    assert_eq!([[1, 1, 1], [-1, 1, 1], [-1, -1, 1], [1, 1, -1]].map(told), [false, true, false, true]);
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

/// From two models to one with textures: no name of an image, and no list of maps.
#[test]
fn a_model_alone_gets_the_maps_of_a_material() {
    let pair = Pair::new();
    let [low, high, model, job] =
        ["low.glb", "high.glb", "crate.glb", "job.toml"].map(|name| pair.path(name));
    let bake = |more: &[&str]| {
        let all = ["bake", text(&low), "--high", text(&high), "--size", "16", "--cage-offset", "1"];
        darboux(&[&all, more].concat())
    };
    painted_high(&pair);
    let of_material = ["normal", "ao", "base-color", "roughness", "metalness", "emission"];
    let report = bake(&["--write-model", text(&model), "--json"]).exits(0).json();
    assert_eq!(names(&report), of_material);
    assert_eq!(pair.texel("crate.base-color.png").0, [1.0, 188.0 / 255.0, 0.0]);
    let material = &json_of(&model)["materials"][0];
    for place in
        ["/normalTexture", "/occlusionTexture", "/emissiveTexture", "/pbrMetallicRoughness/baseColorTexture"]
    {
        assert!(material.pointer(place).is_some(), "{place}: {material}");
    }
    // The same as a name, once each, and in a job; an image's name leaves the normal map alone.
    let named = pair.bake(&["--map", "material,height,normal", "--json"]).exits(0).json();
    assert_eq!(names(&named), [&of_material[..], &["height"]].concat());
    fs::write(&job, "[[bake]]\nlow = \"low.glb\"\nhigh = \"high.glb\"\nsize = 16\ncage-offset = 1\nwrite-model = \"other.glb\"\n")
        .expect("a job");
    darboux(&["bake", text(&job)]).exits(0);
    assert_eq!(pair.texel("other.roughness.png").0, [64.0 / 255.0]);
    let one = bake(&["-o", text(&pair.path("n.png")), "--write-model", text(&model), "--force", "--json"]);
    assert_eq!(names(&one.exits(0).json()), ["normal"]);
    for (more, words) in [
        (&["-o", text(&model)][..], "--write-model writes a model with its maps"),
        (&[], "name the map with --output (-o), or a model with its maps with --write-model"),
    ] {
        let refused = bake(more).exits(2).stderr;
        assert!(refused.contains(words), "{refused}");
    }
}

/// The names of the maps of a report.
fn names(report: &Value) -> Vec<String> {
    let maps = report["maps"].as_array().expect("maps").iter();
    maps.map(|map| map["map"].as_str().expect("a name").to_owned()).collect()
}

/// A plate with vertex colours.
fn colored_plate(height: f32) -> Vec<u8> {
    edited(&plate([0.0, 0.0], &FULL, height), |json| {
        let attributes = &mut json["meshes"][0]["primitives"][0]["attributes"];
        attributes["COLOR_0"] = attributes["NORMAL"].clone();
    })
}

/// A sculpture has no material, and glTF's own is white metal, which would replace that of the low model.
#[test]
fn high_models_without_materials_leave_those_of_the_low_model() {
    let pair = Pair::new();
    fs::write(pair.path("low.glb"), colored_plate(1.0)).expect("a file");
    let model = pair.path("model.glb");
    let bake = |more: &[&str]| {
        let line = [&["--force", "--json", "--write-model", text(&model)], more].concat();
        let run = pair.bake(&line).exits(0);
        let primitive = json_of(&model)["meshes"][0]["primitives"][0].clone();
        (names(&run.json()), run.stderr, primitive["attributes"]["COLOR_0"].is_null())
    };
    let (maps, told, is_without_colors) = bake(&["--map", "material"]);
    assert_eq!((maps, is_without_colors), (vec!["normal".to_owned(), "ao".to_owned()], false));
    let left_out = "no materials, so base-color, roughness, metalness, emission are not baked";
    assert!(told.contains(left_out) && !told.contains("white metal"), "{told}");
    // What is named is baked.
    let (maps, told, is_without_colors) = bake(&["--map", "base-color,roughness"]);
    assert_eq!((maps, is_without_colors), (vec!["base-color".to_owned(), "roughness".to_owned()], true));
    assert_eq!(told.matches("white metal").count(), 1, "{told}");
    assert!(told.contains("low.glb: the written model is without its vertex colours"), "{told}");
    // Vertex colours are colours.
    fs::write(pair.path("high.glb"), colored_plate(1.0)).expect("a file");
    assert_eq!(bake(&["--map", "material"]).0, ["normal", "ao", "base-color"]);
}

/// A texture whose other channels are not baked would lose them.
#[test]
fn channels_of_the_low_model_are_not_lost() {
    let pair = Pair::new();
    painted_high(&pair);
    let model = pair.path("model.glb");
    let bake = |maps: &str, material: Value| {
        let low = edited(&plate([0.0, 0.0], &FULL, 1.0), |json| {
            json["meshes"][0]["primitives"][0]["material"] = 0.into();
            json["materials"] = json!([material]);
            json["textures"] = json!([{}]);
        });
        fs::write(pair.path("low.glb"), low).expect("a file");
        pair.bake(&["--force", "--map", maps, "--write-model", text(&model)])
    };
    let textured =
        |name: &str, mode: &str| json!({"alphaMode": mode, "pbrMetallicRoughness": {name: {"index": 0}}});
    for (maps, material, missing) in [
        (
            "roughness",
            textured("metallicRoughnessTexture", "OPAQUE"),
            "has metalness beside what is baked, which would be lost; add metalness to --map",
        ),
        ("metalness,ao", textured("metallicRoughnessTexture", "OPAQUE"), "add roughness to --map"),
        (
            "opacity",
            textured("baseColorTexture", "BLEND"),
            "has colours beside what is baked, which would be lost; add base-color",
        ),
        (
            "base-color",
            textured("baseColorTexture", "MASK"),
            "has alpha beside what is baked, which would be lost; add opacity",
        ),
    ] {
        let refused = bake(maps, material).exits(1).stderr;
        assert!(refused.contains(missing), "{maps}: {refused}");
    }
    assert!(!model.exists());
    bake("base-color", textured("baseColorTexture", "OPAQUE")).exits(0);
    bake("roughness", json!({})).exits(0);
    // A material that says otherwise does not keep baked alpha from showing.
    bake(
        "base-color,opacity",
        json!({"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.25]}}),
    )
    .exits(0);
    let material = &json_of(&model)["materials"][0];
    assert!(material["alphaMode"].is_null(), "{material}");
    assert_eq!(material["pbrMetallicRoughness"]["baseColorFactor"], json!([1, 1, 1, 1]));
}

/// A written model has the tangents of the map, and keeps those of other materials and of maps that stay.
#[test]
fn tangents_of_other_maps_stay() {
    let pair = Pair::new();
    let low = edited(&plate([0.0, 0.0], &["POSITION", "NORMAL", "TEXCOORD_0", "TANGENT"], 1.0), |json| {
        let primitive = json["meshes"][0]["primitives"][0].clone();
        json["meshes"][0]["primitives"] = json!([primitive, primitive]);
        json["meshes"][0]["primitives"][0]["material"] = 0.into();
        json["meshes"][0]["primitives"][1]["material"] = 1.into();
        json["materials"] = json!([{}, {}]);
    });
    fs::write(pair.path("low.glb"), &low).expect("a file");
    let model = pair.path("model.glb");
    let tangents = |more: &[&str]| {
        pair.bake(
            &[&["--force", "--material", "0", "--method", "mikktspace", "--write-model", text(&model)], more]
                .concat(),
        )
        .exits(0);
        let json = json_of(&model);
        [0, 1].map(|primitive| json["meshes"][0]["primitives"][primitive]["attributes"]["TANGENT"].as_u64())
    };
    let [of_first, of_second] = tangents(&[]);
    assert!(of_first != of_second && of_second.is_some(), "{of_first:?} {of_second:?}");
    let [of_first, of_second] = tangents(&["--map", "ao"]);
    assert_eq!(of_first, of_second);
}

/// What the materials of the low model keep is told by name.
#[test]
fn what_a_written_model_keeps_is_told() {
    let pair = Pair::new();
    let low = edited(&plate([0.0, 0.0], &FULL, 1.0), |json| {
        let extensions =
            json!({"KHR_materials_unlit": {}, "KHR_materials_sheen": {}, "KHR_materials_ior": {}});
        json["meshes"][0]["primitives"][0]["material"] = 0.into();
        json["materials"] = json!([{"extensions": extensions}]);
        json["extensionsUsed"] = json!(["KHR_materials_unlit", "KHR_materials_sheen", "KHR_materials_ior"]);
    });
    fs::write(pair.path("low.glb"), low).expect("a file");
    let model = pair.path("model.glb");
    let told = pair.bake(&["--write-model", text(&model)]).exits(0).stderr;
    assert!(told.contains("is without KHR_materials_unlit, with which"), "{told}");
    assert!(told.contains("keeps KHR_materials_sheen of its materials"), "{told}");
    assert!(json_of(&model)["materials"][0]["extensions"]["KHR_materials_unlit"].is_null());
    assert!(!pair.bake(&["--force"]).exits(0).stderr.contains("KHR_materials"));
}

/// The alpha of a written model counts as that of the high models.
#[test]
fn cut_outs_stay_cut_outs() {
    let pair = Pair::new();
    let model = pair.path("model.glb");
    let mode = |material: Value| {
        let high = edited(&plate([0.0, 0.0], &FULL, 1.0), |json| {
            json["meshes"][0]["primitives"][0]["material"] = 0.into();
            json["materials"] = json!([material]);
        });
        fs::write(pair.path("high.glb"), high).expect("a file");
        pair.bake(&["--force", "--map", "base-color,opacity", "--write-model", text(&model)]).exits(0);
        let material = &json_of(&model)["materials"][0];
        (material["alphaMode"].as_str().map(str::to_owned), material["alphaCutoff"].as_f64())
    };
    let with = |mode: &str| json!({"alphaMode": mode, "alphaCutoff": 0.8, "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]}});
    assert_eq!(mode(with("OPAQUE")), (None, None));
    assert_eq!(mode(with("MASK")), (Some("MASK".to_owned()), Some(0.5)));
    assert_eq!(mode(with("BLEND")), (Some("BLEND".to_owned()), None));
}

/// A black texture would be read for nothing, and a light of the old material must not go on.
#[test]
fn a_model_without_light_gets_no_texture_of_it() {
    let pair = Pair::new();
    let with_material = |path: &str, material: Value| {
        let file = edited(&plate([0.0, 0.0], &FULL, 1.0), |json| {
            json["meshes"][0]["primitives"][0]["material"] = 0.into();
            json["materials"] = json!([material]);
        });
        fs::write(pair.path(path), file).expect("a file");
    };
    with_material("low.glb", json!({"emissiveFactor": [1, 0, 0]}));
    with_material("high.glb", json!({}));
    let model = pair.path("model.glb");
    pair.bake(&["--map", "material", "--write-model", text(&model)]).exits(0);
    let material = &json_of(&model)["materials"][0];
    assert!(material["normalTexture"].is_object(), "{material}");
    assert!(material["emissiveTexture"].is_null() && material["emissiveFactor"].is_null(), "{material}");
}

/// Exporters that lose the names of images give all textures of a material the first one.
#[test]
fn one_image_as_colours_and_as_normals_is_named() {
    let pair = Pair::new();
    pair.bake(&[]).exits(0);
    for name in ["first.png", "second.png"] {
        fs::copy(pair.path("map.png"), pair.path(name)).expect("an image");
    }
    let says = |colors: usize, more: &[&str]| {
        let high = edited(&plate([0.0, 0.0], &FULL, 1.0), |json| {
            json["meshes"][0]["primitives"][0]["material"] = 0.into();
            json["images"] = json!([{"uri": "first.png"}, {"uri": "second.png"}]);
            json["textures"] = json!([{"source": 0}, {"source": 1}, {"source": 0}]);
            let colors = json!({"baseColorTexture": {"index": colors}});
            json["materials"] = json!([{"normalTexture": {"index": 0}, "pbrMetallicRoughness": colors}]);
        });
        fs::write(pair.path("high.glb"), high).expect("a file");
        let run = pair.bake(&[&["--force"], more].concat()).exits(0);
        run.stderr.contains("materials[0] shows one image as base colour and as normal map")
    };
    assert_eq!([0, 1, 2].map(|colors| says(colors, &[])), [true, false, true]);
    assert!(!says(0, &["--no-high-maps"]));
}
