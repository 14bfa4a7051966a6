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
fn of_lines_longer_than_paths_the_ends_are_looked_up() {
    let line = |words: usize| format!("map_Kd {}a.png", "- ".repeat(words));
    let names = |words| names_of("mtllib a.mtl", &line(words), &["a.mtl", "a.png"]);
    assert_eq!(names(2000), ["a.png", "a.mtl"]);
    assert_eq!(names(60_000), ["a.png", "a.mtl"]);
    let long = format!("map_Kd {}a.png", "-".repeat(5000));
    assert_eq!(names_of("mtllib a.mtl", &long, &["a.mtl", "a.png"]), ["a.mtl"]);
    assert!(names_of(&format!("mtllib {}a.mtl", " - ".repeat(60_000)), "", &["a.mtl"]).is_empty());
}

#[test]
#[cfg(target_os = "linux")]
fn companions_are_found_as_the_reader_finds_them() {
    let library = "norm -bm 1 A_Normal.PNG\nmap_Kd C:\\work\\b.png\n";
    let names = names_of("mtllib A.MTL", library, &["a.mtl", "a_normal.png", "b.png"]);
    assert_eq!(names, ["a_normal.png", "b.png", "a.mtl"]);
}

/// Every line would be looked up at every one of its words, which takes minutes.
#[test]
fn libraries_of_many_words_are_looked_up_to_a_limit() {
    let line = |i: usize| format!("map_Kd {i} {}a.png\n", "- ".repeat(1500));
    let library: String = (0..1000).map(line).collect();
    let names = names_of(&"mtllib a.mtl\n".repeat(1000), &library, &["a.mtl", "a.png"]);
    assert_eq!(names, ["a.png", "a.mtl"]);
}

/// A link out of the folder that is put in the place of a file, or of its folder, after the lookup.
#[test]
#[cfg(unix)]
fn companions_that_were_replaced_by_links_are_not_read() {
    use std::os::unix::fs::symlink;

    let [outside, folder] = [(), ()].map(|()| tempfile::tempdir().unwrap());
    fs::create_dir(folder.path().join("maps")).unwrap();
    for secret in ["a.png", "b.png"] {
        fs::write(outside.path().join(secret), "secret").unwrap();
    }
    let path = |name: &str| folder.path().join(name);
    for file in ["a.png", "maps/b.png"] {
        fs::write(path(file), "texture").unwrap();
    }
    fs::write(path("a.mtl"), "map_Kd a.png\nnorm maps/b.png\n").unwrap();
    fs::write(path("a.obj"), "mtllib a.mtl\nf 1 2 3\n").unwrap();
    let found = companions(&path("a.obj")).unwrap();
    assert_eq!(found.len(), 3);
    assert!(found.iter().all(|companion| companion.read().is_ok()));

    fs::remove_file(path("a.png")).unwrap();
    symlink(outside.path().join("a.png"), path("a.png")).unwrap();
    fs::remove_dir_all(path("maps")).unwrap();
    symlink(outside.path(), path("maps")).unwrap();
    let read: Vec<_> = found.iter().filter(|companion| companion.read().is_ok()).collect();
    assert!(read.len() == 1 && read[0].name == "a.mtl", "{read:?}");
}
