//! Files that are no model in a format that is read: the sentence says what they are, or what they were meant
//! to be, and what to do.
#![cfg(all(feature = "obj", feature = "ply", feature = "stl"))]

use std::fs;
use std::path::Path;

use darboux_io::gltf::Document;
use darboux_io::{FileKind, LoadOptions};

fn blender(name: &str) -> Vec<u8> {
    fs::read(Path::new("../../assets/blender").join(name)).unwrap()
}

/// The sentence about a file, without its name.
#[track_caller]
fn refusal(name: &str, bytes: &[u8]) -> String {
    match Document::from_bytes(name, bytes.to_vec(), None, &LoadOptions::default()) {
        Ok(_) => panic!("{name} is read"),
        Err(error) => {
            let sentence = error.to_string();
            assert!(!sentence.contains('\n') && sentence.contains("; "), "says what to do: {sentence}");
            sentence.strip_prefix(&format!("{name}: ")).expect("the file's name").to_owned()
        }
    }
}

#[test]
fn files_of_other_programs_are_named() {
    for (name, bytes, words) in [
        ("a.blend", &b"BLENDER-v405"[..], "is a Blender file"),
        ("a.blend", b"\x1F\x8B\x08\0", "is a Blender file"),
        ("a.gz", b"\x1F\x8B\x08\0", "is compressed with gzip"),
        ("a.max", b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1", "is a scene of 3ds Max"),
        ("a.3ds", b"\x4D\x4D\x08\x00\x00\x00\x3D\x3D", "is a 3DS file"),
        ("a.ma", b"//Maya ASCII 2025 scene", "is a scene of Maya"),
        ("a.mb", b"FOR8\0\0\0\0", "is a scene of Maya"),
        ("a.dae", b"<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"\">", "is a COLLADA file"),
        ("a.dae", b"<COLLADA version=\"1.4.1\">", "is a COLLADA file"),
        ("a.abc", b"Ogawa\xFF\0\x01", "is an Alembic file"),
        ("a.abc", b"\x89HDF\r\n\x1A\n\0", "is an Alembic file"),
        ("a.usda", b"#usda 1.0\n", "is USD"),
        ("a.c4d", b"QC4DC4D6", "is a scene of Cinema 4D"),
        ("a.skp", b"\xFF\xFE\xFF\x0ES\0k\0e\0t\0c\0h\0U\0p\0", "is a file of SketchUp"),
        ("a.3dm", b"3D Geometry File Format        7", "is a file of Rhino"),
        ("a.step", b"ISO-10303-21;\nHEADER;", "is a STEP file"),
        ("a.dxf", b"  0\nSECTION\n  2\nHEADER\n", "is a drawing of AutoCAD"),
        ("a.dwg", b"AC1032\0", "is a drawing of AutoCAD"),
        ("a.wrl", b"#VRML V2.0 utf8\n", "is a VRML or X3D file"),
        ("a.x3d", b"<?xml version=\"1.0\"?><X3D>", "is a VRML or X3D file"),
        ("a.off", b"OFF\n3 1 0\n", "is an OFF file"),
        ("a.3mf", b"PK\x03\x04", "is a 3MF file"),
        ("a.zip", b"PK\x03\x04", "is a zip archive"),
        ("a.lwo", b"FORM\0\0\0\x08LWO2", "is a LightWave or Modo file"),
        ("a.x", b"xof 0303txt 0032", "is a DirectX .x file"),
        ("a.pmx", b"PMX \0\0\0\x40", "is a model of MikuMikuDance"),
        ("a.md3", b"IDP3\x0F\0\0\0", "is a model of Quake"),
        ("a.drc", b"DRACO\x02\x02", "is geometry compressed with Draco"),
        ("a.b3dm", b"b3dm\x01\0\0\0", "is a tile of 3D Tiles"),
        ("a.exr", b"\x76\x2F\x31\x01", "is an image"),
        ("a.pdf", b"%PDF-1.7", "is a PDF"),
        ("a.glb", b"<!DOCTYPE html><html>", "is a web page"),
        ("a.mtl", b"newmtl a\nKd 1 1 1\n", "is a material library of an OBJ"),
        ("a.glb", b"version https://git-lfs.github.com/spec/v1", "is a pointer of Git LFS"),
        ("a.obj", b"\xFF\xFEv\0 \0", "is a text in UTF-16"),
    ] {
        let sentence = refusal(name, bytes);
        assert!(sentence.starts_with(words), "{name}: {sentence}");
    }
}

/// The ending of the name says what an unknown content was meant to be.
#[test]
fn unknown_contents_are_named_by_the_ending() {
    let endings = FileKind::model_endings();
    for (name, format) in [
        ("a.gltf", "glTF"),
        ("a.glb", "glTF"),
        ("a.obj", "OBJ"),
        ("a.PLY", "PLY"),
        ("a.fbx", "FBX"),
        ("a.usdz", "USD"),
    ] {
        assert_eq!(
            refusal(name, b"hello\n"),
            format!(
                "is named as {format}, but its content is that of no format that is read ({endings}); export or download it again"
            )
        );
    }
    // A text with letters beyond ASCII has no header of an STL.
    let text =
        "SOLID W\u{fc}rfel\nfacet normal 0 0 1 und so weiter, bis der Kopf von 84 Bytes voll ist, und mehr\n";
    let latin: Vec<u8> = text.chars().map(|c| c as u8).collect();
    for bytes in [text.as_bytes(), &latin, &latin[..30]] {
        let sentence = refusal("a.stl", bytes);
        assert!(sentence.starts_with("is named as STL, but its content is"), "{sentence}");
    }
    assert!(refusal("a.txt", b"MMhello world").starts_with("is of no format that is read"));
    for name in ["index.html", "model"] {
        assert_eq!(
            refusal(name, b"hello\n"),
            format!("is of no format that is read; give a model in one of those that are: {endings}")
        );
    }
    assert!(endings.contains(".stl") && endings.contains(".ply") && endings.contains(".obj"), "{endings}");
}

#[test]
fn truncated_stls_are_named() {
    let whole = blender("scene.stl");
    let text = fs::read("../../assets/others/assimp.stl").unwrap();
    let bytes = whole.len();
    let cases = [
        (
            &whole[..1000],
            "is named as STL, whose header counts 100 facets, which take 5084 bytes, but there are 1000",
        ),
        (
            &whole[..bytes - 1],
            "is named as STL, whose header counts 100 facets, which take 5084 bytes, but there are 5083",
        ),
        (&whole[..40], "holds zeros only"),
        (&[0xFF; 40], "is named as STL and has 40 bytes, fewer than the 84 of an STL's header"),
        (&text[..5], "is an STL that is cut off before its first facet"),
        (&text[..13], "is an STL that is cut off before its first facet"),
        (&text[..3000], "is an STL that is cut off before endsolid"),
    ];
    assert!(bytes == 5084 && text.starts_with(b"solid"));
    for (bytes, words) in cases {
        let sentence = refusal("a.stl", bytes);
        assert!(sentence.starts_with(words), "{} bytes: {sentence}", bytes.len());
    }
    // Without the name, the facets say it.
    assert!(
        refusal("download", &whole[..1000]).starts_with("is an STL that is cut off or counts its facets")
    );
}

/// Files that are empty, hold zeros, or end within their first bytes.
#[test]
fn files_of_almost_nothing_are_named() {
    for ending in ["glb", "gltf", "obj", "ply", "stl", "fbx", "usdz", "blend"] {
        let name = format!("a.{ending}");
        for bytes in [&b""[..], b" \r\n\n", b"\xEF\xBB\xBF"] {
            assert!(refusal(&name, bytes).starts_with("is empty; "), "{name}");
        }
        assert!(refusal(&name, &[0; 50]).starts_with("holds zeros only"), "{name}");
    }
    for (bytes, words) in [
        (&b"glT"[..], "is a GLB that is cut off in its first bytes"),
        (b"Kaydara FBX", "is an FBX that is cut off"),
        (b"pl", "is a PLY that is cut off"),
    ] {
        assert!(refusal("download", bytes).starts_with(words));
    }
}

/// A PLY of points or of Gaussian splats.
#[test]
fn a_ply_without_faces_is_named() {
    let header = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n";
    assert!(refusal("a.ply", header.as_bytes()).contains("without faces"));
}

/// Statements that say nothing about faces may come first.
#[test]
fn an_obj_may_begin_with_any_of_its_statements() {
    for first in ["mg 1 1", "bevel off", "lod 2", "c_interp off", "usemap off"] {
        let text = format!("{first}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        let read = Document::from_bytes("a.obj", text.into_bytes(), None, &LoadOptions::default());
        assert_eq!(read.expect(first).meshes().len(), 1, "{first}");
    }
}

/// A buffer that Git LFS has not fetched is not called too short.
#[test]
fn buffers_that_git_lfs_did_not_fetch_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let json = r#"{"asset":{"version":"2.0"},"buffers":[{"uri":"a.bin","byteLength":1000}]}"#;
    fs::write(folder.path().join("a.gltf"), json).unwrap();
    fs::write(
        folder.path().join("a.bin"),
        "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 1\n",
    )
    .unwrap();
    let error =
        Document::open(&folder.path().join("a.gltf"), &LoadOptions::default()).unwrap_err().to_string();
    assert!(
        error.ends_with("buffers[0].uri: is a pointer of Git LFS, not the file; run: git lfs pull"),
        "{error}"
    );
}
