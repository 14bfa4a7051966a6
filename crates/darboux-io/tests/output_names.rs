//! Whatever is written beside a document has a name that this crate can read again, and is never another
//! writer's file.

use std::fs;
use std::path::Path;
use std::thread;

use darboux_io::gltf::{AddTangentsOptions, Document, add_tangents};
use darboux_io::{LoadOptions, SaveOptions};

mod support;

use support::{BOTH, Builder, butterfly};

/// A document whose tangents need a new buffer.
fn document() -> Document {
    let mut builder = Builder::new();
    let attributes = butterfly().attributes(&mut builder);
    let indices = builder.indices(&BOTH);
    builder.mesh(&[serde_json::json!({"attributes": attributes, "indices": indices})]);
    let mut document = builder.build();
    add_tangents(&mut document, &AddTangentsOptions::default(), &mut |_| {}).unwrap();
    document
}

/// Writes a document to a file and reads it again.
#[track_caller]
fn survives(path: &Path) {
    let written = document().save(path, &SaveOptions::default()).unwrap();
    assert_eq!(written.len(), 2, "{written:?}");
    let again = Document::open(path, &LoadOptions::default()).unwrap();
    let tangents = again.meshes()[0].primitives[0].attributes["TANGENT"];
    assert!(again.vectors::<4>(tangents).is_ok());
}

#[test]
fn buffers_get_names_that_uris_can_spell() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["plain.gltf", "ä b%20c#.gltf", "tab\there.gltf"] {
        survives(&folder.path().join(name));
    }
}

#[test]
#[cfg(unix)]
fn names_that_only_unix_permits_are_replaced() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;

    for name in [&b"m\xFC.gltf"[..], b"a:b.gltf", b"a\\b.gltf", b"c:.gltf", b"https:x.gltf"] {
        let folder = tempfile::tempdir().unwrap();
        survives(&folder.path().join(OsStr::from_bytes(name)));
    }
}

#[test]
fn writers_in_one_folder_do_not_collide() {
    let folder = tempfile::tempdir().unwrap();
    let path = |i: usize| folder.path().join(format!("{i}")).with_extension("gltf");
    // Every document wants the same name for its buffer.
    thread::scope(|scope| {
        for i in 0..16 {
            let stem = folder.path().join(format!("same.{i}.gltf"));
            scope.spawn(move || document().save(&stem, &SaveOptions::default()).unwrap());
            let path = path(i);
            scope.spawn(move || document().save(&path, &SaveOptions::default()).unwrap());
        }
    });
    for i in 0..16 {
        assert!(Document::open(&path(i), &LoadOptions::default()).is_ok());
    }
    let names = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name());
    assert!(names.map(|name| name.to_string_lossy().into_owned()).all(|name| !name.starts_with(".darboux")));
}
