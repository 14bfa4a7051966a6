//! Conversion between object space and tangent space.

use std::fs;
use std::path::Path;

use crate::common::{darboux, text};
use crate::pair::{LEANING, Pair, near};

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
