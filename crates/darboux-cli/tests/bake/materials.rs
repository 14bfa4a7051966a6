//! What maps take of the materials of high models: alpha modes, other models of shading, numbers that files
//! do not hold, ranges of tiles.

use std::fs;

use serde_json::{Value, json};

use crate::common::{Run, darboux, text};
use crate::pair::{FULL, Pair, edited, half_size_plate, near, plate};

/// A plate with a material.
fn with_material(material: Value, extensions: &[&str]) -> Vec<u8> {
    edited(&plate([0.0, 0.0], &FULL, 1.0), |json| {
        json["meshes"][0]["primitives"][0]["material"] = 0.into();
        json["materials"] = json!([material]);
        json["extensionsUsed"] = json!(extensions);
    })
}

#[test]
fn opacity_is_what_the_mode_of_alpha_says() {
    let pair = Pair::new();
    let opacity = |material: Value| {
        let mut material = material;
        material["pbrMetallicRoughness"] = json!({"baseColorFactor": [1, 1, 1, 0.4]});
        fs::write(pair.path("high.glb"), with_material(material, &[])).expect("a file");
        pair.bake(&["--map", "opacity", "--force"]).exits(0);
        pair.texel("map.png").0[0]
    };
    let found = [
        json!({}),
        json!({"alphaMode": "OPAQUE"}),
        json!({"alphaMode": "MASK"}),
        json!({"alphaMode": "MASK", "alphaCutoff": 0.4}),
        json!({"alphaMode": "BLEND"}),
    ]
    .map(opacity);
    assert_eq!(found, [1.0, 1.0, 0.0, 1.0, 102.0 / 255.0]);
}

/// The alpha of vertices of a primitive without a material means nothing.
#[test]
fn primitives_without_a_material_are_opaque() {
    let pair = Pair::new();
    // Colours whose alpha is 0: the tangents, from three numbers earlier on.
    let colored = edited(&plate([0.0, 0.0], &FULL, 1.0), |json| {
        json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = 5.into();
        let mut view = json["bufferViews"][3].clone();
        view["byteStride"] = 16.into();
        view["byteOffset"] = (view["byteOffset"].as_u64().expect("a number") - 12).into();
        json["bufferViews"].as_array_mut().expect("a list").push(view);
        let colors = json!({"bufferView": 5, "componentType": 5126, "count": 4, "type": "VEC4"});
        json["accessors"].as_array_mut().expect("a list").push(colors);
    });
    fs::write(pair.path("high.glb"), colored).expect("a file");
    pair.bake(&["--map", "opacity"]).exits(0);
    assert_eq!(pair.texel("map.png").0, [1.0]);
}

/// The first texels of base colour, roughness and metalness, and what the command says.
fn shading(pair: &Pair, material: Value, extension: &str) -> (Vec<f64>, [f64; 2], Run) {
    fs::write(pair.path("high.glb"), with_material(material, &[extension])).expect("a file");
    let run = pair.bake(&["--map", "base-color,roughness,metalness", "--force"]).exits(0);
    let number = |map: &str| pair.texel(&format!("map.{map}.png")).0[0];
    (pair.texel("map.base-color.png").0, ["roughness", "metalness"].map(number), run)
}

#[test]
fn unlit_materials_are_no_metals() {
    let pair = Pair::new();
    let material = json!({
        "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1], "roughnessFactor": 0.2},
        "extensions": {"KHR_materials_unlit": {}},
    });
    let (color, numbers, run) = shading(&pair, material, "KHR_materials_unlit");
    assert_eq!((color, numbers), (vec![1.0, 0.0, 0.0], [1.0, 0.0]));
    assert!(!run.stderr.contains("white metal"), "{}", run.stderr);
}

#[test]
fn specular_glossiness_becomes_a_color_and_a_roughness() {
    let pair = Pair::new();
    let name = "KHR_materials_pbrSpecularGlossiness";
    let material = |textures: bool| {
        let mut shading = json!({"diffuseFactor": [1, 0, 0, 1], "glossinessFactor": 0.8});
        if textures {
            shading["diffuseTexture"] = json!({"index": 0});
            shading["specularGlossinessTexture"] = json!({"index": 0});
        }
        json!({"pbrMetallicRoughness": {"baseColorFactor": [0, 1, 0, 1]}, "extensions": {name: shading}})
    };
    let (color, [roughness, metalness], run) = shading(&pair, material(false), name);
    assert_eq!((color, metalness), (vec![1.0, 0.0, 0.0], 0.0));
    assert!(near(&[roughness], &[0.2], 0.5 / 255.0 + 1e-6), "{roughness}");
    let told = "no map has the specular colours (KHR_materials_pbrSpecularGlossiness) of materials[0]";
    assert_eq!(run.stderr.matches(told).count(), 1, "{}", run.stderr);
    // The textures count: an alpha of 0.6 makes a glossiness of 0.48.
    image::save_buffer(
        pair.path("gloss.png"),
        &[[51u8, 99, 99, 153]; 16].concat(),
        4,
        4,
        image::ColorType::Rgba8,
    )
    .expect("a PNG");
    let textured = edited(&with_material(material(true), &[name]), |json| {
        json["images"] = json!([{"uri": "gloss.png"}]);
        json["textures"] = json!([{"source": 0}]);
    });
    fs::write(pair.path("high.glb"), &textured).expect("a file");
    pair.bake(&["--map", "base-color,roughness,metalness", "--force"]).exits(0);
    assert_eq!(pair.texel("map.base-color.png").0, [51.0 / 255.0, 0.0, 0.0]);
    let roughness = pair.texel("map.roughness.png").0;
    assert!(near(&roughness, &[0.52], 0.5 / 255.0 + 1e-6), "{roughness:?}");
    // With a metallic-roughness texture the extension does not count: green and blue, times the base colour.
    let both = edited(&textured, |json| {
        json["materials"][0]["pbrMetallicRoughness"]["metallicRoughnessTexture"] = json!({"index": 0});
    });
    fs::write(pair.path("high.glb"), both).expect("a file");
    let run = pair.bake(&["--map", "base-color,roughness,metalness", "--force"]).exits(0);
    assert!(!run.stderr.contains("specular colours"), "{}", run.stderr);
    assert_eq!(pair.texel("map.base-color.png").0, [0.0, 1.0, 0.0]);
    let [roughness, metalness] =
        ["roughness", "metalness"].map(|map| pair.texel(&format!("map.{map}.png")).0);
    let share = 99.0 / 255.0;
    assert!(
        near(&[roughness[0], metalness[0]], &[share; 2], 0.5 / 255.0 + 1e-6),
        "{roughness:?} {metalness:?}"
    );
}

/// A gradient of 4,096 steps of 16 codes, onto the same UVs. A ray hits within 1e-4 of a texel of its place,
/// and neighbours differ by at most 1,024 codes, in linear light by at most 2.4 times the share, so that a
/// texel is off by at most 0.25 codes and the rounding: by one code.
#[test]
fn textures_of_16_bits_keep_them() {
    const SIDE: usize = 64;
    let pair = Pair::new();
    let codes: Vec<u16> = (0..SIDE * SIDE).map(|texel| 16 * texel as u16).collect();
    let texels = codes.iter().flat_map(|&code| [code; 3]).collect();
    let image = image::ImageBuffer::<image::Rgb<u16>, Vec<u16>>::from_raw(SIDE as u32, SIDE as u32, texels);
    image.expect("all texels").save(pair.path("ramp.png")).expect("a PNG");
    let high = edited(&plate([0.0, 0.0], &FULL, 1.0), |json| {
        json["meshes"][0]["primitives"][0]["material"] = 0.into();
        let texture = json!({"index": 0});
        json["materials"] = json!([{
            "pbrMetallicRoughness": {"baseColorTexture": texture, "metallicRoughnessTexture": texture},
            "occlusionTexture": texture,
        }]);
        json["images"] = json!([{"uri": "ramp.png"}]);
        json["samplers"] = json!([{"wrapS": 33071, "wrapT": 33071}]);
        json["textures"] = json!([{"source": 0, "sampler": 0}]);
    });
    fs::write(pair.path("high.glb"), high).expect("a file");
    let [low, high, map] = ["low.glb", "high.glb", "map.png"].map(|name| pair.path(name));
    let line = ["bake", text(&low), "--high", text(&high), "-o", text(&map), "--size", "64", "--bits", "16"];
    let maps = ["--map", "base-color,roughness,texture", "--texture", "occlusionTexture"];
    darboux(&[&line[..], &["--cage-offset", "1"], &maps].concat()).exits(0);
    for map in ["base-color", "roughness", "texture"] {
        let found = image::open(pair.path(&format!("map.{map}.png"))).expect("a map").into_rgb16();
        let reds: Vec<u16> = found.pixels().map(|texel| texel.0[0]).collect();
        let largest = reds.iter().zip(&codes).map(|(red, code)| red.abs_diff(*code)).max();
        assert!(largest <= Some(1), "{map}: {largest:?}");
        assert_eq!(std::collections::HashSet::<u16>::from_iter(reds).len(), SIDE * SIDE, "{map}");
    }
}

/// Where only some primitives have a material, white metal is a patch that nobody wanted.
#[test]
fn primitives_without_a_material_are_counted() {
    let pair = Pair::new();
    let mixed = edited(&with_material(json!({}), &[]), |json| {
        let mut primitive = json["meshes"][0]["primitives"][0].clone();
        primitive.as_object_mut().expect("an object").remove("material");
        json["meshes"][0]["primitives"].as_array_mut().expect("a list").push(primitive);
    });
    fs::write(pair.path("high.glb"), mixed).expect("a file");
    let told = |maps: &str| pair.bake(&["--map", maps, "--force"]).exits(0).stderr;
    let words = "high.glb: 1 primitive has no material and is baked as glTF's own, white metal";
    assert_eq!(told("roughness,metalness").matches(words).count(), 1);
    assert!(told("material").contains(words));
    assert!(!told("base-color").contains("white metal"));
}

#[test]
fn numbers_that_single_precision_does_not_hold_are_refused() {
    let pair = Pair::new();
    let strength = "KHR_materials_emissive_strength";
    for (material, place) in [
        (
            json!({"emissiveFactor": [1, 0, 0], "extensions": {strength: {"emissiveStrength": 1e39}}}),
            "materials[0].extensions.KHR_materials_emissive_strength.emissiveStrength",
        ),
        (
            json!({"emissiveFactor": [1e20, 0, 0], "extensions": {strength: {"emissiveStrength": 1e20}}}),
            "materials[0].extensions.KHR_materials_emissive_strength.emissiveStrength",
        ),
        (
            json!({"pbrMetallicRoughness": {"baseColorFactor": [0, -1e39, 0, 1]}}),
            "materials[0].pbrMetallicRoughness.baseColorFactor",
        ),
        (
            json!({"pbrMetallicRoughness": {"roughnessFactor": 1e39}}),
            "materials[0].pbrMetallicRoughness.roughnessFactor",
        ),
        (json!({"alphaMode": "MASK", "alphaCutoff": 1e300}), "materials[0].alphaCutoff"),
        (json!({"normalTexture": {"index": 0, "scale": 1e39}}), "materials[0].normalTexture.scale"),
    ] {
        let high = edited(&with_material(material, &[strength]), |json| json["textures"] = json!([{}]));
        fs::write(pair.path("high.glb"), high).expect("a file");
        let run = pair.bake(&["--map", "material"]).exits(1);
        let sentence = format!("high.glb: {place}: the number is too large for single precision");
        assert!(run.stderr.contains(&sentence), "{}", run.stderr);
        assert!(!pair.path("map.normal.png").exists());
    }
}

#[test]
fn halves_do_not_become_infinite() {
    use exr::prelude::{FlatSamples, read_first_flat_layer_from_file};
    let pair = Pair::new();
    let strength = "KHR_materials_emissive_strength";
    let material =
        json!({"emissiveFactor": [1, 0.5, 0], "extensions": {strength: {"emissiveStrength": 1e5}}});
    fs::write(pair.path("high.glb"), with_material(material, &[strength])).expect("a file");
    let [low, high, map] = ["low.glb", "high.glb", "map.exr"].map(|name| pair.path(name));
    let bake = |more: &[&str]| {
        let all =
            ["bake", text(&low), "--high", text(&high), "-o", text(&map), "--map", "emission", "--force"];
        darboux(&[&all[..], &["--size", "4", "--cage-offset", "1"], more].concat()).exits(0)
    };
    let red = || {
        let image = read_first_flat_layer_from_file(&map).expect("an EXR");
        let channels = image.layer_data.channel_data.list;
        let red = channels.iter().find(|channel| channel.name.eq("R")).expect("red");
        match &red.sample_data {
            FlatSamples::F16(halves) => halves[0].to_f32(),
            FlatSamples::F32(floats) => floats[0],
            FlatSamples::U32(_) => 0.0,
        }
    };
    let told = bake(&[]).stderr;
    assert!(told.contains("map.exr: emission has numbers beyond 65504"), "{told}");
    assert!(told.contains("add --bits 32"), "{told}");
    assert_eq!(red(), 65504.0);
    let told = bake(&["--bits", "32"]).stderr;
    assert!(!told.contains("65504"), "{told}");
    assert_eq!(red(), 1e5);
}

/// The background, which is no position, is not in the range.
#[test]
fn positions_lie_in_the_box_of_the_high_models() {
    let pair = Pair::new();
    fs::write(pair.path("low.glb"), half_size_plate()).expect("a file");
    fs::write(pair.path("high.glb"), plate([0.25, 0.5], &FULL, 1.0)).expect("a file");
    for padding in ["0", "3"] {
        let report =
            pair.bake(&["--map", "position", "--padding", padding, "--force", "--json"]).exits(0).json();
        assert_eq!(report["maps"][0]["range"], json!([[0.0, 1.0], [0.0, 1.0], [0.25, 0.5]]), "{padding}");
    }
}

/// The upper sides of two tiles beside each other.
const TWO_TILES: &str = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nvt 0 0\nvt 1 0\nvt 2 0\nvt 0 1\n\
                         vt 1 1\nvt 2 1\nvn 0 0 1\nf 1/1/1 2/2/1 5/5/1 4/4/1\nf 2/2/1 3/3/1 6/6/1 5/5/1\n";

/// The ranges of a map in a report, by tile.
fn ranges(report: &Value, map: &str) -> Vec<Value> {
    let maps = report["maps"].as_array().expect("a list");
    maps.iter().filter(|found| found["map"] == map).map(|found| found["range"].clone()).collect()
}

/// Light and positions of all tiles have one range, so that neighbours fit together.
#[test]
fn tiles_have_one_range() {
    let pair = Pair::new();
    fs::write(pair.path("low.obj"), TWO_TILES).expect("a file");
    let strength = "KHR_materials_emissive_strength";
    for (name, x, light) in [("dim.glb", 0.0, 1.0), ("bright.glb", 1.0, 4.0)] {
        let material =
            json!({"emissiveFactor": [1, 1, 1], "extensions": {strength: {"emissiveStrength": light}}});
        let model = edited(&with_material(material, &[strength]), |json| {
            json["nodes"][0]["translation"] = json!([x, 0, 0]);
        });
        fs::write(pair.path(name), model).expect("a file");
    }
    let bake = |output: &str, more: &[&str]| {
        let [low, dim, bright] = ["low.obj", "dim.glb", "bright.glb"].map(|name| pair.path(name));
        let (output, all) = (
            pair.path(output),
            ["--high", text(&dim), "--high", text(&bright), "--map", "emission,position"],
        );
        let line = ["bake", text(&low), "-o", text(&output), "--size", "8", "--json", "--padding", "0"];
        darboux(&[&line[..], &all, &["--cage-offset", "1"], more].concat()).exits(0)
    };
    let light = |most: f64| json!(vec![[0.0, most]; 3]);
    let report = bake("u.%UDIM%.png", &[]).json();
    assert_eq!(ranges(&report, "emission"), [light(4.0), light(4.0)]);
    let whole = json!([[0.0, 2.0], [0.0, 1.0], [0.0, 0.0]]);
    assert_eq!(ranges(&report, "position"), [whole.clone(), whole]);
    // A quarter of the light is 0.537 in sRGB.
    let [dim, bright] = ["u.1001.emission.png", "u.1002.emission.png"].map(|name| pair.texel(name).0);
    assert_eq!([dim, bright], [vec![137.0 / 255.0; 3], vec![1.0; 3]]);
    // Files that have the numbers themselves need no common range.
    let own = bake("u.%UDIM%.exr", &[]).json();
    assert_eq!(ranges(&own, "emission"), [light(1.0), light(4.0)]);
}

/// The range of thickness is that of the thickest tile, to the bit, whatever else is baked.
#[test]
fn tiles_have_the_range_of_the_thickest() {
    let pair = Pair::new();
    fs::write(pair.path("low.obj"), TWO_TILES).expect("a file");
    let mut boxes = String::new();
    for (x, depth) in [(0, 0.1), (1, 0.3)] {
        let corners = (0..8).map(|i| [x + i % 2, i / 2 % 2, i / 4]);
        boxes.extend(corners.map(|[x, y, z]| format!("v {x} {y} {}\n", f64::from(z - 1) * depth)));
        let sides = [[5, 6, 8, 7], [1, 3, 4, 2], [1, 2, 6, 5], [3, 7, 8, 4], [1, 5, 7, 3], [2, 4, 8, 6]];
        boxes.extend(sides.map(|side| {
            let [a, b, c, d] = side.map(|corner| 8 * x + corner);
            format!("f {a} {b} {c} {d}\n")
        }));
    }
    fs::write(pair.path("high.obj"), boxes).expect("a file");
    let bake = |output: &str, more: &[&str]| {
        let [low, high, output] = ["low.obj", "high.obj", output].map(|name| pair.path(name));
        let line = ["bake", text(&low), "--high", text(&high), "-o", text(&output), "--size", "8", "--json"];
        darboux(&[&line[..], &["--cage-offset", "0.01"], more].concat()).exits(0).json()
    };
    let own = ranges(&bake("t.%UDIM%.exr", &["--map", "thickness,normal", "--bits", "32"]), "thickness");
    let most = |range: &Value| range[0][1].as_f64().expect("a number");
    assert!(most(&own[0]) > 0.09 && most(&own[1]) > 1.5 * most(&own[0]), "{own:?}");
    let of_all = [own[1].clone(), own[1].clone()];
    assert_eq!(ranges(&bake("t.%UDIM%.png", &["--map", "thickness,normal,ao"]), "thickness"), of_all);
    let packed = bake("p.%UDIM%.png", &["--map", "normal", "--pack", "two=ao,thickness"]);
    let pack = json!([[0.0, 1.0], own[1][0]]);
    assert_eq!(ranges(&packed, "two"), [pack.clone(), pack]);
}
