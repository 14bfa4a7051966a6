//! Fuzzes writing: a document that was read, and one with new tangents, is written whole in every format and
//! reads again, or is refused and leaves nothing. Whatever names it has, nothing is written outside the
//! folder.

#![no_main]

use std::fs;
use std::path::{Path, PathBuf};

use darboux_io::gltf::{AddTangentsOptions, Document, add_tangents};
use darboux_io::{LoadOptions, SaveOptions};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let read = || Document::from_bytes("input", bytes.to_vec(), None, &LoadOptions::default());
    let Ok(mut document) = read() else { return };
    write_in_all_formats(&document);
    let options = AddTangentsOptions::default().with_overwrite(true);
    if add_tangents(&mut document, &options, &mut |_| {}).is_ok() {
        write_in_all_formats(&document);
    }
});

fn write_in_all_formats(document: &Document) {
    let outside = std::env::temp_dir().join(format!("darboux-fuzz-save-{}", std::process::id()));
    let folder = outside.join("a/b");
    let Ok(corners) = document.corners() else { return };
    let has_triangles = corners.iter().any(|corners| !corners.is_empty());
    for name in ["out.glb", "out.gltf", "out.obj", "out.ply"] {
        _ = fs::remove_dir_all(&outside);
        fs::create_dir_all(&folder).expect("a folder");
        let path = folder.join(name);
        let saved = document.save(&path, &SaveOptions::default());
        let found = files(&outside);
        match saved {
            Ok(mut written) => {
                written.sort();
                assert_eq!(found, written);
                assert!(written.iter().all(|file| file.starts_with(&folder)), "{written:?}");
                // PLY and OBJ without faces are refused.
                let is_gltf = ["out.glb", "out.gltf"].contains(&name);
                if is_gltf
                    || has_triangles && !document.mesh_instances().unwrap_or_default().meshes.is_empty()
                {
                    Document::open(&path, &LoadOptions::default()).expect("what was written reads again");
                }
            }
            Err(_) => assert!(found.is_empty(), "{found:?}"),
        }
    }
    _ = fs::remove_dir_all(&outside);
}

/// All files below a folder, sorted.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let below = |path: PathBuf| if path.is_dir() { files(&path) } else { vec![path] };
    let mut found: Vec<PathBuf> = entries.flat_map(below).collect();
    found.sort();
    found
}
