//! The files that an OBJ refers to.

use std::fs;

use darboux_io::obj::companions;

/// The names of an OBJ's companions; `files` exist, each with the content `library`.
fn names_of(obj: &str, library: &str, files: &[&str]) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    files.iter().for_each(|file| fs::write(path(file), library).unwrap());
    fs::write(path("a.obj"), format!("{obj}\nf 1 2 3\n")).unwrap();
    companions(&path("a.obj")).unwrap().into_iter().map(|companion| companion.name).collect()
}

#[test]
fn a_line_names_one_library_or_several() {
    assert_eq!(names_of("mtllib a.mtl\tb.mtl  c.mtl", "", &["a.mtl", "b.mtl"]), ["a.mtl", "b.mtl"]);
    assert_eq!(names_of("mtllib a b.mtl", "", &["a b.mtl", "a", "b.mtl"]), ["a b.mtl"]);
}

#[test]
fn lines_longer_than_paths_are_ignored() {
    let line = |words: usize| format!("map_Kd {}a.png", "- ".repeat(words));
    let names = |words| names_of("mtllib a.mtl", &line(words), &["a.mtl", "a.png"]);
    assert_eq!(names(2000), ["a.png", "a.mtl"]);
    assert_eq!(names(60_000), ["a.mtl"]);
    assert!(names_of(&format!("mtllib {}a.mtl", " - ".repeat(60_000)), "", &["a.mtl"]).is_empty());
}

/// Every line would be looked up at every one of its words, which takes minutes.
#[test]
fn libraries_of_many_words_are_looked_up_to_a_limit() {
    let line = |i: usize| format!("map_Kd {i} {}a.png\n", "- ".repeat(1500));
    let library: String = (0..1000).map(line).collect();
    let names = names_of(&"mtllib a.mtl\n".repeat(1000), &library, &["a.mtl", "a.png"]);
    assert_eq!(names, ["a.png", "a.mtl"]);
}
