//! OBJ files become documents: whole ones with their materials, odd ones with warnings, broken ones with an
//! error.
#![cfg(feature = "obj")]

use std::fs;
use std::path::Path;

use darboux_dice::Dice;
use darboux_io::LoadOptions;
use darboux_io::gltf::{Document, inspect};

const OBJ: &str = "mtllib a.mtl\no quad\nv 0 0 0\nv 1 0 0\nv 1 1 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n\
    usemtl a\ng one\nf 1/1/1 2/2/1 -1/-1/-1\nf 1//1 2//1 3//1 1//1 2//1\nl 1 2\n";
const MTL: &str =
    "newmtl a\nKd 0.5 0.5 0.5\nNs 10\nillum 2\nmap_Kd a.png\nbump -bm 1 a.png\nnewmtl b\nd 0.5\n";

/// Replacements of words: limits of numbers, missing parts, and bytes that are not text.
const WORDS: [&[u8]; 22] = [
    b"",
    b" ",
    b"\n",
    b"/",
    b"//",
    b"1/2/3/4",
    b"0",
    b"-1",
    b"-2/-3/-4",
    b"1/-9/1",
    b"1/1/-9",
    b"99",
    b"9223372036854775807",
    b"1/9223372036854775807",
    b"1/1/9223372036854775807",
    b"-9223372036854775808",
    b"1/1/-6148914691236517207",
    b"18446744073709551616",
    b"nan",
    b"1e999",
    b"\xFF\x00\xFE",
    b"\\",
];

/// The text with some words replaced, removed or repeated.
fn mutated(text: &str, dice: &mut Dice<'_>) -> Vec<u8> {
    let mut words: Vec<Vec<u8>> = text.split_inclusive([' ', '\n']).map(|word| word.into()).collect();
    for _ in 0..1 + dice.below(3) {
        let at = dice.below(words.len());
        let last = *words[at].last().expect("no word is empty");
        words[at] = match dice.below(8) {
            0 => Vec::new(),
            1 => words[at].repeat(1 + dice.below(2000)),
            2 => words[dice.below(words.len())].clone(),
            _ => WORDS[dice.below(WORDS.len())].to_vec(),
        };
        words[at].push(last);
    }
    words.concat()
}

#[test]
fn mutated_files_give_models_or_errors() {
    let folder = tempfile::tempdir().unwrap();
    let [obj, mtl] = ["a.obj", "a.mtl"].map(|name| folder.path().join(name));
    let mut dice = Dice::from_seed(1);
    let [mut models, mut errors] = [0; 2];
    for case in 0..600 {
        let [text, library] = match case % 2 {
            0 => [mutated(OBJ, &mut dice), MTL.into()],
            _ => [OBJ.into(), mutated(MTL, &mut dice)],
        };
        fs::write(&obj, text).unwrap();
        fs::write(&mtl, library).unwrap();
        match Document::open(&obj, &LoadOptions::default()) {
            Ok(model) => {
                inspect(&model).unwrap();
                models += 1;
            }
            Err(error) => {
                let sentence = error.to_string();
                assert!(sentence.contains("a.obj: ") && !sentence.contains('\n'), "{sentence}");
                errors += 1;
            }
        }
    }
    assert!(models > 100 && errors > 50, "{models} models, {errors} errors");
}

fn open(path: &Path) -> Document {
    Document::open(path, &LoadOptions::default()).unwrap()
}

/// The warnings about an OBJ with a library.
fn warnings(obj: &str, library: &str) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.mtl"), library).unwrap();
    fs::write(folder.path().join("a.obj"), format!("mtllib a.mtl\n{obj}")).unwrap();
    open(&folder.path().join("a.obj")).warnings().to_vec()
}

#[test]
fn colours_of_one_number_are_grey() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.mtl"), "newmtl a\nKd 1\n").unwrap();
    fs::write(folder.path().join("a.obj"), "mtllib a.mtl\nv 0 0 0\nusemtl a\nf 1 1 1\n").unwrap();
    let model = open(&folder.path().join("a.obj"));
    assert_eq!(model.json()["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"], [1.0, 1.0, 1.0, 1.0]);
}

/// As Blender's importer and exporter of glTF place the texture; v points up in OBJ.
#[test]
fn options_place_textures() {
    let folder = tempfile::tempdir().unwrap();
    fs::copy("../../assets/blender/scene_normal.png", folder.path().join("a.png")).unwrap();
    fs::write(folder.path().join("a.obj"), "mtllib a.mtl\nv 0 0 0\nvt 0 0\nusemtl a\nf 1/1 1/1 1/1\n")
        .unwrap();
    let texture = |options: &str| {
        fs::write(
            folder.path().join("a.mtl"),
            format!("newmtl a\nmap_Kd {options} a.png\nnorm {options} a.png\n"),
        )
        .unwrap();
        let model = open(&folder.path().join("a.obj"));
        let (json, material) = (model.json(), &model.json()["materials"][0]);
        let color = &material["pbrMetallicRoughness"]["baseColorTexture"];
        assert_eq!(*color, material["normalTexture"], "one texture for both");
        assert_eq!(json["images"].as_array().unwrap().len(), 1);
        (color["extensions"].to_string(), json["samplers"].to_string(), model.warnings().to_vec())
    };
    let transform = |numbers: &str| format!("{{\"KHR_texture_transform\":{{{numbers}}}}}");
    let moved = r#""offset":[0.25,-3.5],"rotation":0.0,"scale":[2.0,4.0]"#;
    let clamped = r#"[{"wrapS":33071,"wrapT":33071}]"#;
    for (options, transform, samplers) in [
        ("-o 0.25 0.5 0 -s 2 4 1 -clamp on", transform(moved), clamped),
        ("-s 2", transform(r#""offset":[0.0,0.0],"rotation":0.0,"scale":[2.0,1.0]"#), "null"),
        ("-s 1 1 1 -o 0 0 0 -clamp off -mm 0 1 -t 0 0 0", "null".to_owned(), "null"),
    ] {
        assert_eq!(texture(options), (transform, samplers.to_owned(), Vec::new()), "{options}");
    }
    for options in [
        "-mm 0 2",
        "-t 0 1",
        "-imfchan r",
        "-bm nan",
        "-o inf",
        "-s 1 1e39",
        "-s 1 3e38 -o 0 3e38 -clamp off",
    ] {
        let (transform, _, warnings) = texture(options);
        assert_eq!(transform, "null", "{options}");
        assert!(
            warnings.iter().any(|warning| warning.contains("options of textures")),
            "{options} {warnings:?}"
        );
    }
}

#[test]
fn attributes_of_some_corners_are_a_warning() {
    let elements = "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvn 0 0 1\n";
    let warnings = |faces: &str| warnings(&format!("{elements}{faces}"), "");
    assert_eq!(warnings("f 1/1/1 2/1/1 3/1/1\n"), [""; 0]);
    assert_eq!(warnings("f 1 2 3\n"), [""; 0]);
    let uvs = "1 face lacks UVs; its corners without them have the UV (0, 0), and a face with one UV at all \
        corners has no area in UV space";
    assert_eq!(warnings("f 1/1/1 2//1 3/1/1\n"), [uvs]);
    assert_eq!(
        warnings("f 1/1/1 2 3/1/1\no b\nf 1/1/1 2/1 3/1/1\n"),
        [uvs, "2 meshes have normals at some corners only; these normals are left out"]
    );
    let several = "o a\nf 1/1/1 2/1/1 3/1/1\nf 1//1 2//1 3//1\nf 1/1/1 2//1 3/1/1\n";
    let warnings = warnings(&format!("{several}{}", several.replace('a', "b")));
    assert!(warnings[0].starts_with("o a and 1 other mesh: 4 faces lack UVs; "), "{warnings:?}");
}

/// As Blender reads them: (0, 0) where v points up.
#[test]
fn corners_without_uvs_keep_the_uvs_of_others() {
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0.25 0\nvt 1 0\nvt 1 1\n";
    let uvs = |faces: &str| {
        let obj = format!("{square}{faces}").into_bytes();
        let model = Document::from_bytes("a", obj, None, &LoadOptions::default()).unwrap();
        let corners = model.corners().unwrap();
        let uvs = corners[0].vectors::<2>("TEXCOORD_0").unwrap();
        uvs.map(|uvs| corners[0].vertices().iter().map(|&vertex| uvs[vertex as usize]).collect::<Vec<_>>())
    };
    let first = [[0.25, 1.0], [1.0, 1.0], [1.0, 0.0]];
    let all = [first.to_vec(), vec![[0.0, 1.0]; 3]].concat();
    assert_eq!(uvs("f 1/1 2/2 3/3\nf 1 3 4\n"), Some(all));
    assert_eq!(uvs("f 1/1 2/2 3\n"), Some(vec![first[0], first[1], [0.0, 1.0]]));
    assert_eq!(uvs("f 1 2 3\n"), None);
}

/// The index lists of a model.
fn indices(obj: &str) -> Vec<Vec<u32>> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.obj"), obj).unwrap();
    let model = open(&folder.path().join("a.obj"));
    assert_eq!(model.warnings(), [""; 0]);
    let corners = model.corners().unwrap();
    corners.iter().map(|corners| corners.vertices().to_vec()).collect()
}

#[test]
fn concave_faces_do_not_fold_over() {
    let elements = "v -2 -1 0\nv 0 1 0\nv 2 -1 0\nv 0 3 0\nv 3 3 0\n";
    // An arrow whose second corner is its notch, beside a convex quad and a triangle.
    assert_eq!(indices(&format!("{elements}f 1 2 3 4\n")), [[0, 1, 3, 1, 2, 3]]);
    assert_eq!(indices(&format!("{elements}f 2 3 5 4\nf 1 2 4\n")), [[0, 1, 2, 0, 2, 3, 4, 0, 3]]);
}

#[test]
fn faces_that_cross_themselves_are_a_warning() {
    let elements = "v 0 0 0\nv 3 3 0\nv 3 0 0\nv 0 2 0\nv 9 9 9\n";
    let [warning] = &warnings(&format!("{elements}f 1 2 3 4\n"), "")[..] else { panic!("one warning") };
    assert!(warning.starts_with("1 face crosses itself, is not flat or is too large to cut, and its"));
    let several =
        format!("{elements}o first\nf 1 2 3 4\no second\nf 1 2 3 4\nf 2 3 4 1\ng third\nf 4 3 2 1\n");
    let several = warnings(&several, "");
    assert!(several[0].starts_with("o first and 2 other meshes: 4 faces cross themselves"), "{several:?}");
    assert_eq!(warnings(&format!("{elements}f 1 1 1 1\nf 1 2 2 5\n"), ""), [""; 0]);
}

#[test]
#[cfg(unix)]
fn unreadable_libraries_are_a_warning() {
    use std::os::unix::fs::PermissionsExt;

    let folder = tempfile::tempdir().unwrap();
    let [obj, mtl] = ["a.obj", "a.mtl"].map(|name| folder.path().join(name));
    fs::write(&obj, "mtllib a.mtl\nv 0 0 0\nf 1 1 1\n").unwrap();
    fs::write(&mtl, MTL).unwrap();
    fs::set_permissions(&mtl, fs::Permissions::from_mode(0o000)).unwrap();
    // Administrators can read everything.
    let is_readable = fs::read(&mtl).is_ok();
    let warnings = open(&obj).warnings().to_vec();
    let is_warning = warnings.iter().any(|warning| warning.starts_with("a.mtl: cannot be read: "));
    assert_eq!(is_warning, !is_readable, "{warnings:?}");
}

#[test]
fn references_that_are_not_looked_up_say_so() {
    let line = |i: usize| format!("newmtl {i}\nmap_Kd {i} {}a.png\n", "- ".repeat(1500));
    let library: String = (0..150).map(line).collect();
    let warnings = warnings("v 0 0 0\nf 1 1 1\n", &library);
    let left = "was looked up at its own path only, because more than 100,000 paths were tried for the files";
    let counts = ["is not at the first 3,000 paths that it may mean", left]
        .map(|problem| warnings.iter().filter(|warning| warning.contains(problem)).count());
    assert_eq!(counts, [33, 117]);
    assert!(warnings.iter().all(|warning| warning.len() < 400));
}

/// The same library named again and again costs one reading.
#[test]
fn repeated_libraries_are_loaded_once() {
    let folder = tempfile::tempdir().unwrap();
    let library = "newmtl a\nKd 1 0 0\nmap_Kd missing.png\n";
    fs::write(folder.path().join("a.mtl"), library).unwrap();
    let obj = format!("{}v 0 0 0\nusemtl a\nf 1 1 1\n", "mtllib a.mtl a.mtl\n".repeat(20));
    fs::write(folder.path().join("a.obj"), obj).unwrap();
    let model = open(&folder.path().join("a.obj"));
    let warnings = model.warnings();
    assert_eq!((model.materials().unwrap().len(), warnings.len()), (1, 1), "{warnings:?}");
}

/// Editors of Windows begin a text with three bytes that belong to no statement.
#[test]
fn byte_order_marks_belong_to_no_statement() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.mtl"), "\u{FEFF}newmtl a\nKd 1 1 1\n").unwrap();
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nmtllib a.mtl\nusemtl a\nf 1 2 3\n";
    fs::write(folder.path().join("a.obj"), format!("\u{FEFF}{obj}")).unwrap();
    let model = open(&folder.path().join("a.obj"));
    assert_eq!(model.warnings(), [""; 0]);
    assert_eq!(model.json()["materials"][0]["name"], "a");
    assert_eq!(model.corners().unwrap()[0].vectors::<3>("POSITION").unwrap().unwrap()[1], [1.0, 0.0, 0.0]);
    let generator = |text: String| {
        let model = Document::from_bytes("a", text.into_bytes(), None, &LoadOptions::default()).unwrap();
        model.provenance().unwrap().generator.clone()
    };
    assert_eq!(generator(format!("\u{FEFF}# Program 1.0.2\n{obj}")).as_deref(), Some("Program 1.0.2"));
    let utf16: Vec<u8> = format!("\u{FEFF}{obj}").encode_utf16().flat_map(u16::to_le_bytes).collect();
    let error = Document::from_bytes("a", utf16, None, &LoadOptions::default()).unwrap_err().to_string();
    assert!(error.contains("is a text in UTF-16, which is not read; save it in UTF-8"), "{error}");
}

/// Two quads that meet at a right angle along the edge of positions 2 and 3, each with its statement before
/// it; `normals` follows the position of each corner of the first.
fn fold(first: &str, second: &str, normals: &str) -> (Vec<[f32; 3]>, Vec<String>) {
    let positions = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 -1\nv 1 1 -1\nvn 0 0 5\n";
    let [a, b, c, d] = [1, 2, 3, 4].map(|position| format!("{position}{normals}"));
    let obj = format!("{positions}{first}\nf {a} {b} {c} {d}\n{second}\nf 2 5 6 3\n");
    let model = Document::from_bytes("a", obj.into_bytes(), None, &LoadOptions::default()).unwrap();
    let normals = model.corners().unwrap()[0].vectors::<3>("NORMAL").unwrap().unwrap_or_default();
    (normals, model.warnings().to_vec())
}

/// A file without normals gets them by its smoothing groups.
#[test]
fn smoothing_groups_make_normals() {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let (up, right, between) = ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [half, 0.0, half]);
    let made = "1 mesh has no normals; they were made by its smoothing groups";
    let close = |found: &[[f32; 3]], expected: &[[f32; 3]]| {
        // Triangles of the first quad, then of the second.
        let mut kinds: Vec<[f32; 3]> = Vec::new();
        for normal in found {
            let is_known =
                kinds.iter().any(|kind| kind.iter().zip(normal).all(|(a, b)| (a - b).abs() < 1e-6));
            if !is_known {
                kinds.push(*normal);
            }
        }
        let is_expected = |kind: &[f32; 3]| {
            expected.iter().any(|normal| normal.iter().zip(kind).all(|(a, b)| (a - b).abs() < 1e-6))
        };
        assert!(found.len() == 12 && kinds.len() == expected.len(), "{kinds:?}");
        assert!(kinds.iter().all(is_expected), "{kinds:?}");
    };
    for (first, second, expected) in [
        ("s 1", "", &[up, right, between][..]),
        ("s 7", "s 7", &[up, right, between]),
        ("s 1", "s 2", &[up, right]),
        ("s off", "", &[up, right]),
        ("s 0", "s off", &[up, right]),
        ("s 1", "s off", &[up, right]),
        ("", "s 1", &[up, right]),
    ] {
        let (normals, warnings) = fold(first, second, "");
        close(&normals, expected);
        assert_eq!(warnings, [made], "{first} {second}");
    }
    // Without groups, normals are absent, and glTF's are flat.
    assert_eq!(fold("", "", ""), (Vec::new(), Vec::new()));
    // Normals that the file has are kept.
    let (normals, warnings) = fold("s 1", "", "//1");
    assert_eq!(warnings, ["1 mesh lacks normals at some corners; those were made by its smoothing groups"]);
    assert_eq!(normals.iter().filter(|normal| **normal == [0.0, 0.0, 5.0]).count(), 6);
    close(&normals, &[[0.0, 0.0, 5.0], right, between]);
}

/// All corners of a flat face have the same bits, which tangents need.
#[test]
fn corners_of_flat_faces_have_the_same_bits() {
    let obj = "s off\nv 0 0 0\nv 3 0.1 0.7\nv 2.5 2 1\nv -0.3 1.7 0.2\nf 1 2 3 4\ns 3\nf 4 3 2 1\n";
    let model = Document::from_bytes("a", obj.into(), None, &LoadOptions::default()).unwrap();
    let normals = model.corners().unwrap()[0].vectors::<3>("NORMAL").unwrap().unwrap();
    assert!(normals[..6].iter().all(|normal| *normal == normals[0]), "{normals:?}");
}

/// Elements may follow the faces that refer to them, so the error is known at the end, and names the line.
#[test]
fn a_missing_element_is_reported_with_the_line_of_its_face() {
    let problem = |obj: &str| {
        let document = Document::from_bytes("a.obj", obj.into(), None, &LoadOptions::default());
        document.unwrap_err().to_string()
    };
    let elements = "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvn 0 0 1\n";
    let good = "f 1 2 3\nl 1 2\nf 1 2\nfo 1 2 \\\n3\no b\nf 3 2 1\n";
    for (face, wanted) in [
        ("f 1 2 4", "line 13: refers to position 4, but there are 3"),
        ("f 1/1 2/2 3/1", "line 13: refers to UV 2, but there are 1"),
        ("f 1//1 2//1 3//9", "line 13: refers to normal 9, but there are 1"),
    ] {
        let problem = problem(&format!("{elements}{good}{face}\nf 1 2 3\n"));
        assert_eq!(problem, format!("a.obj: {wanted}; export the file again"));
    }
    assert!(problem("f 1 99999999999999999999 2\n").contains("line 1: has \"99999999999999999999\""));
}

/// Indices have signs; negative ones count from the end.
#[test]
fn indices_have_signs() {
    let elements = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
    assert_eq!(indices(&format!("{elements}f +1 -2 003\n")), [[0, 1, 2]]);
}

/// Names in other encodings than UTF-8 are compared as bytes.
#[test]
fn materials_are_found_by_the_bytes_of_their_names() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.mtl"), b"newmtl caf\xe8\nKd 1 0 0\nnewmtl caf\xe9\nKd 0 1 0\n").unwrap();
    let obj = b"mtllib a.mtl\nv 0 0 0\nusemtl caf\xe9\nf 1 1 1\nusemtl caf\xe8\nf 1 1 1\n";
    fs::write(folder.path().join("a.obj"), obj).unwrap();
    let model = open(&folder.path().join("a.obj"));
    assert_eq!(model.warnings(), [""; 0]);
    let primitives = model.json()["meshes"][0]["primitives"].as_array().unwrap().clone();
    assert_eq!([0, 1].map(|at| primitives[at]["material"].as_u64()), [Some(1), Some(0)]);
}

#[test]
fn what_a_library_lacks_is_a_warning() {
    let of_library = |library: &[u8]| {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("a.mtl"), library).unwrap();
        fs::write(folder.path().join("a.obj"), "mtllib a.mtl\nv 0 0 0\nusemtl a\nf 1 1 1\n").unwrap();
        let model = open(&folder.path().join("a.obj"));
        (model.warnings().to_vec(), model.json().to_string())
    };
    for library in [&b""[..], b"\xff\xfen\0e\0w\0m\0t\0l\0 \0a\0", b"\x01\x02"] {
        assert_eq!(of_library(library).0, ["no library has the material a; it is kept with default values"]);
    }
    for (statement, lost) in [
        ("Kd 0.5 nan 0.5", "Kd (broken numbers)"),
        ("Kd 0.5 x", "Kd (broken numbers)"),
        ("Kd", "Kd (broken numbers)"),
        ("Ns abc", "Ns (broken numbers)"),
        ("Ke inf 0 0", "Ke (broken numbers)"),
        ("d", "d (broken numbers)"),
        ("Kd spectral a.rfl 1", "Kd (spectral)"),
        ("Ke xyz 0.1 0.2 0.3", "Ke (xyz)"),
        // Once for each material.
        ("map_Ks a.png\nmap_Ks b.png", "map_Ks"),
        ("map_Kd -mm 0 2 a.mtl\nmap_Ke -mm 0 2 a.mtl", "options of textures"),
    ] {
        let (warnings, _) = of_library(format!("newmtl a\n{statement}\n").as_bytes());
        let expected = format!("not carried over: {lost} of 1 material");
        assert!(warnings.contains(&expected), "{statement}: {warnings:?}");
    }
    let (warnings, json) =
        of_library(b"# Blender 5.0.1 MTL File: 'None'\nnewmtl a\nKd 0.25 0.5 2\nKe 0.5 0 0\n");
    assert_eq!(warnings, [""; 0]);
    assert!(json.contains("[0.25,0.5,1.0,1.0]") && json.contains("[0.5,0.0,0.0]"), "{json}");
    let (warnings, json) = of_library(b"newmtl a\nKe 2 1 0\nd -halo 0.5\n");
    assert_eq!(warnings, [""; 0]);
    assert!(json.contains("emissiveStrength") && json.contains("\"emissiveFactor\":[1.0,"), "{json}");
}

#[test]
fn materials_that_no_library_has_are_counted() {
    let faces: String = (1..=7).map(|i| format!("usemtl m{i}\nf 1 1 1\n")).collect();
    let of = |faces: &str| warnings(&format!("v 0 0 0\n{faces}"), "newmtl a\n");
    assert_eq!(
        of(&faces),
        ["no library has the materials m1, m2, m3, m4, m5 and 2 more; they are kept with default values"]
    );
    assert_eq!(of(&faces[..36]), ["no library has the materials m1, m2; they are kept with default values"]);
}

/// Blender writes the linear numbers that its glTF has.
#[test]
fn colours_of_blender_are_those_of_its_gltf() {
    let color = |name: &str| {
        let model = open(&Path::new("../../assets/blender").join(name));
        model.materials().unwrap()[0].base_color
    };
    assert_eq!(color("scene.obj"), color("scene.glb"));
}

#[test]
fn indices_of_nothing_are_errors() {
    let problem = |face: &str| {
        let obj = format!("v 0 0 0\nv 1 0 0\nv 1 1 0\n{face}\n");
        let document = Document::from_bytes("a.obj", obj.into(), None, &LoadOptions::default());
        document.unwrap_err().to_string()
    };
    assert!(problem("f 0 1 2").contains("line 4: has the index 0, but indices begin at 1; "));
    assert!(problem("f -1 -2 -5").contains("line 4: refers to position -5, but there are 3 before it; "));
    for word in ["x", "$", "2!", "/"] {
        let said = format!("line 4: has \"{word}\", which is no corner of a face; ");
        assert!(problem(&format!("f 1 2 {word}")).contains(&said), "{word}");
    }
}

/// As Blender keeps them.
#[test]
fn materials_without_a_library_keep_their_groups() {
    let elements = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
    let faces = "f 3 2 1\nusemtl red\nf 1 2 3\nusemtl unused\nusemtl blue\nf 2 3 1\nusemtl red\nf 3 1 2\n";
    let model = |obj: String| Document::from_bytes("a", obj.into(), None, &LoadOptions::default()).unwrap();
    let materials = |document: &Document| -> Vec<Option<String>> {
        let primitives = document.json()["meshes"][0]["primitives"].as_array().unwrap().clone();
        let name = |material: u64| document.json()["materials"][material as usize]["name"].as_str();
        let name = |material: u64| name(material).map(str::to_owned);
        primitives.iter().map(|primitive| primitive["material"].as_u64().and_then(name)).collect()
    };
    let expected = [None, Some("red".to_owned()), Some("blue".to_owned())];
    let document = model(format!("{elements}{faces}"));
    assert_eq!(materials(&document), expected);
    assert_eq!(document.json()["materials"].as_array().unwrap().len(), 2);
    assert_eq!(
        document.warnings(),
        ["no library has the materials blue, red; they are kept with default values"]
    );
    // A library that is missing, and one that comes after the faces and has one of two.
    let document = model(format!("mtllib missing.mtl\n{elements}{faces}"));
    assert_eq!(materials(&document), expected);
    assert_eq!(document.warnings().len(), 2);
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.mtl"), "newmtl red\nKd 1 0 0\n").unwrap();
    fs::write(folder.path().join("a.obj"), format!("{elements}{faces}mtllib a.mtl\nf 1 2 3\n")).unwrap();
    fs::write(folder.path().join("b.obj"), format!("mtllib a.mtl b.mtl\n{elements}usemtl red\nf 1 2 3\n"))
        .unwrap();
    let document = open(&folder.path().join("b.obj"));
    let [warning] = document.warnings() else { panic!("one library is missing") };
    assert!(warning.contains("b.mtl") && !warning.contains("a.mtl"), "{warning}");
    let late = open(&folder.path().join("a.obj"));
    assert_eq!(materials(&late), expected);
    assert_eq!(late.json()["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"], [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(late.warnings(), ["no library has the material blue; it is kept with default values"]);
}

/// Two scans in one file, of which one has colours.
#[test]
fn colours_of_some_positions_are_left_out_with_a_word() {
    for positions in ["v 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\n", "v 0 0 0\nv 1 0 0\nv 1 1 0 1 0 0\n"] {
        let obj = format!("{positions}f 1 2 3\n");
        let document = Document::from_bytes("a", obj.into(), None, &LoadOptions::default()).unwrap();
        assert_eq!(document.warnings(), ["not carried over: 1 colour for 3 positions"]);
    }
}

#[test]
fn colours_of_zbrush_are_read() {
    let model = |colors: &str| {
        let obj = format!("v 0 0 0\nv 1 0 0\nv 1 1 0\n{colors}f 1 2 3\n");
        Document::from_bytes("a", obj.into(), None, &LoadOptions::default()).unwrap()
    };
    let document = model("#MRGB ffff000000FF00\n");
    assert_eq!(document.warnings(), ["not carried over: 1 colour of ZBrush (#MRGB) for 3 positions"]);
    let document = model("#MRGB ffff0000ff00ff00\n#MRGB ff0000bc\n");
    assert_eq!(document.warnings(), [""; 0]);
    let corners = document.corners().unwrap();
    let colors = corners[0].vectors::<4>("COLOR_0").unwrap().unwrap();
    assert_eq!(colors[..2], [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0]]);
    assert!((colors[2][2] - 0.503).abs() < 1e-3);
}

#[test]
fn models_without_faces_are_named_for_what_they_are() {
    let problem = |obj: &str| {
        let document = Document::from_bytes("a.obj", obj.into(), None, &LoadOptions::default());
        document.unwrap_err().to_string()
    };
    let points = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
    let advice = "bake and tangents need faces; export the model as a mesh";
    assert_eq!(
        problem(&format!("{points}l 1 2 3\n")),
        format!("a.obj: is an OBJ without faces, only lines and points; {advice}")
    );
    assert_eq!(problem(points), format!("a.obj: is an OBJ without faces, a point cloud; {advice}"));
}

/// A primitive without UVs cannot have textures in glTF.
#[test]
fn primitives_without_uvs_get_a_material_without_textures() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, content: &str| fs::write(folder.path().join(name), content).expect("a file");
    write(
        "m.obj",
        "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\no a\nf 1/1 2/2 3/3\no b\nf 1 2 3\no c\nf 1 2 3\n",
    );
    write("m.mtl", "newmtl m\nKd 0.5 0.5 0.5\nmap_Kd c.png\n");
    fs::copy("../../assets/blender/scene_normal.png", folder.path().join("c.png")).expect("a file");
    let document = Document::open(&folder.path().join("m.obj"), &LoadOptions::default()).expect("a model");
    let materials = document.materials().expect("materials");
    let are_textured: Vec<_> = materials.iter().map(|material| material.base_texture.is_some()).collect();
    assert_eq!(are_textured, [true, false]);
    let of_meshes: Vec<_> = document.meshes().iter().map(|mesh| mesh.primitives[0].material).collect();
    assert_eq!(of_meshes, [Some(0), Some(1), Some(1)]);
    let warnings = document.warnings().join("\n");
    assert!(
        warnings.contains("2 primitives of the material m lack UVs of its textures; a copy of the material without these textures"),
        "{warnings}"
    );
}
