//! Where the textures of OBJ, FBX and PLY are looked up.

#![cfg(feature = "obj")]

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs;
use std::io;
use std::path::Path;
use std::sync::Arc;

use darboux_io::gltf::Document;
use darboux_io::obj::companions;
use darboux_io::{Files, LoadOptions};

const OBJ: &[u8] = b"mtllib a.mtl\nv 0 0 0\nvt 0 0\nusemtl a\nf 1/1 1/1 1/1\n";

fn png() -> Vec<u8> {
    fs::read("../../assets/blender/scene_normal.png").unwrap()
}

/// A file with its folders.
fn write(folder: &Path, name: impl AsRef<OsStr>, content: impl AsRef<[u8]>) {
    let path = folder.join(name.as_ref());
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, content).unwrap();
}

/// The names of a model's images, and the warnings.
fn images_of(document: &Document) -> (Vec<String>, Vec<String>) {
    let images = document.json()["images"].as_array().into_iter().flatten();
    let names = images.map(|image| image["name"].as_str().unwrap().to_owned()).collect();
    (names, document.warnings().to_vec())
}

/// The images and warnings of `a.obj`, whose library `library` has the text `mtl`, beside these images.
/// `companions` finds the same files.
fn opened(library: &str, mtl: &[u8], images: &[&str]) -> (Vec<String>, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let obj = String::from_utf8_lossy(OBJ).replace("a.mtl", library);
    write(folder.path(), "a.obj", obj);
    write(folder.path(), library.trim_matches('"'), mtl);
    images.iter().for_each(|image| write(folder.path(), image, png()));
    opened_in(folder.path())
}

fn opened_in(folder: &Path) -> (Vec<String>, Vec<String>) {
    let path = folder.join("a.obj");
    let (images, warnings) = images_of(&Document::open(&path, &LoadOptions::default()).unwrap());
    let found: BTreeSet<_> = companions(&path).unwrap().into_iter().map(|companion| companion.name).collect();
    let textures: BTreeSet<_> = found.into_iter().filter(|name| !name.ends_with(".mtl")).collect();
    assert_eq!(images.iter().cloned().collect::<BTreeSet<_>>(), textures, "companions");
    (images, warnings)
}

/// Files by name, in which the letters' case counts.
#[derive(Debug)]
struct Given(Vec<(&'static str, Vec<u8>)>);

impl Files for Given {
    fn has(&self, name: &str) -> bool {
        self.0.iter().any(|(given, _)| *given == name)
    }

    fn read(&self, name: &str) -> io::Result<Vec<u8>> {
        let found = self.0.iter().find(|(given, _)| *given == name);
        found.map(|(_, bytes)| bytes.clone()).ok_or_else(|| io::ErrorKind::NotFound.into())
    }
}

#[test]
fn ends_of_paths_and_usual_folders_are_looked_up() {
    for (library, reference, images, expected) in [
        // The longest end of the path is the nearest.
        ("a.mtl", "C:\\proj\\textures\\w.png", &["textures/w.png", "w.png"][..], "textures/w.png"),
        (
            "a.mtl",
            "C:\\proj\\textures\\w.png",
            &["textures/w.png", "proj/textures/w.png"],
            "proj/textures/w.png",
        ),
        ("a.mtl", "/home/me/proj/maps/w.png", &["maps/w.png"], "maps/w.png"),
        ("a.mtl", "../../maps/w.png", &["maps/w.png"], "maps/w.png"),
        ("a.mtl", "https://example.org/maps/w.png?", &["maps/w.png?"], "maps/w.png?"),
        // A path relative to the model, in a library of another folder.
        ("sub/a.mtl", "maps/w.png", &["maps/w.png"], "maps/w.png"),
        ("sub/a.mtl", "D:\\x\\maps\\w.png", &["maps/w.png", "sub/maps/w.png"], "sub/maps/w.png"),
        // The usual folders.
        ("a.mtl", "C:\\proj\\w.png", &["textures/w.png"], "textures/w.png"),
        ("a.mtl", "C:\\proj\\w.png", &["a.fbm/w.png"], "a.fbm/w.png"),
        ("sub/a.mtl", "w.png", &["sub/textures/w.png"], "sub/textures/w.png"),
    ] {
        let (found, warnings) = opened(library, format!("newmtl a\nmap_Kd {reference}\n").as_bytes(), images);
        assert_eq!(found, [expected], "{reference}");
        assert_eq!(warnings, [format!("\"{reference}\" was found as {expected}, by its name")]);
    }
    // A folder that is none of them.
    let (found, warnings) = opened("a.mtl", b"newmtl a\nmap_Kd C:\\proj\\w.png\n", &["other/w.png"]);
    assert_eq!(found, [""; 0]);
    let problem = "a.mtl: \"C:\\proj\\w.png\" is not in the model's folder; the texture is left out";
    assert_eq!(warnings, [problem]);
}

#[test]
#[cfg(target_os = "linux")]
fn ends_of_paths_are_found_in_other_letters_case() {
    let (found, _) = opened("a.mtl", b"newmtl a\nmap_Kd C:\\Proj\\Maps\\W.PNG\n", &["maps/w.png"]);
    assert_eq!(found, ["maps/w.png"]);
    let (found, _) = opened("a.mtl", b"newmtl a\nmap_Kd C:\\Proj\\W.PNG\n", &["TEXTURES/w.png"]);
    assert_eq!(found, ["TEXTURES/w.png"]);
    let (found, _) = opened("a.mtl", b"newmtl a\nmap_Kd C:\\proj\\w.png\n", &["Textures/w.png"]);
    assert_eq!(found, ["Textures/w.png"]);
}

/// Files that a page or a program gives, below a folder of theirs.
#[test]
fn ends_of_paths_are_found_among_given_files() {
    for (reference, image) in [
        ("C:\\proj\\maps\\w.png", "models/maps/w.png"),
        ("C:\\proj\\w.png", "models/textures/w.png"),
        ("C:\\proj\\w.png", "models/a.fbm/w.png"),
    ] {
        let library = format!("newmtl a\nmap_Kd {reference}\n").into_bytes();
        let files = Arc::new(Given(vec![("models/a.mtl", library), (image, png())]));
        let model =
            Document::from_files("models/a.obj", OBJ.to_vec(), files, &LoadOptions::default()).unwrap();
        assert_eq!(images_of(&model).0, [image]);
    }
}

/// No end of a path leads out of the folder, not by a link either.
#[test]
#[cfg(unix)]
fn ends_of_paths_stay_in_the_folder() {
    let [outside, folder] = [(), ()].map(|()| tempfile::tempdir().unwrap());
    write(outside.path(), "w.png", png());
    write(outside.path(), "model/a.obj", OBJ);
    write(outside.path(), "textures/w.png", png());
    std::os::unix::fs::symlink(outside.path(), folder.path().join("textures")).unwrap();
    let library = "newmtl a\nmap_Kd C:\\textures\\w.png\nmap_Ke x/../../w.png\nnorm w.png\n";
    for model in [folder.path(), &outside.path().join("model")] {
        write(model, "a.obj", OBJ);
        write(model, "a.mtl", library);
        let (found, warnings) = opened_in(model);
        assert_eq!(found, [""; 0]);
        assert_eq!(warnings.len(), 3, "{warnings:?}");
        assert!(
            warnings.iter().all(|warning| warning.contains("is not in the model's folder")),
            "{warnings:?}"
        );
    }
}

/// Paths of thousands of parts take a share of the lookups, and no path takes all.
#[test]
fn paths_of_many_parts_are_looked_up_to_a_limit() {
    let path = |i: usize| format!("newmtl a\nmap_Kd C:/{}{i}.png\n", "a/".repeat(2000));
    let library: String = (0..1000).map(path).chain(["newmtl a\nmap_Kd D:\\x\\w.png\n".to_owned()]).collect();
    let (found, warnings) = opened("a.mtl", library.as_bytes(), &["w.png"]);
    assert_eq!((found, warnings.len()), (vec!["w.png".to_owned()], 1001));
}

/// Lines of many words, each of which may begin a name, do not take the lookups of other names.
#[test]
fn lines_of_many_words_leave_other_names_their_lookups() {
    let line = |i: usize| format!("newmtl {i}\nmap_Kd {i} {}x.png\n", "a/b ".repeat(900));
    for (lines, name) in [(30, "D:\\x\\w.png"), (300, "w.png")] {
        let library: String = (0..lines).map(line).chain([format!("newmtl a\nmap_Kd {name}\n")]).collect();
        let (found, _) = opened("a.mtl", library.as_bytes(), &["w.png"]);
        assert_eq!(found, ["w.png"], "after {lines} lines");
    }
}

#[test]
fn names_in_quotes_are_found() {
    let (found, warnings) = opened("\"a b.mtl\"", b"newmtl a\nmap_Kd \"my tex.png\"\n", &["my tex.png"]);
    assert_eq!((found, warnings), (vec!["my tex.png".to_owned()], vec![]));
    let (found, _) = opened("a.mtl", b"newmtl a\nmap_Kd -new 1 \"my tex.png\"\n", &["my tex.png"]);
    assert_eq!(found, ["my tex.png"]);
    let (_, warnings) = opened("a.mtl", b"newmtl a\nmap_Kd \"my tex.png\"\n", &[]);
    assert_eq!(warnings, ["a.mtl: \"my tex.png\" is not in the model's folder; the texture is left out"]);
}

/// Quotes may be part of a name, which then comes first.
#[test]
#[cfg(unix)]
fn quotes_may_be_part_of_a_name() {
    let (found, _) = opened("a.mtl", b"newmtl a\nmap_Kd \"w.png\"\n", &["w.png", "\"w.png\""]);
    assert_eq!(found, ["\"w.png\""]);
}

#[test]
fn text_that_is_not_utf_8_is_windows_1252() {
    let folder = tempfile::tempdir().unwrap();
    write(
        folder.path(),
        "a.obj",
        b"mtllib K\xf6rper.mtl\nv 0 0 0\nvt 0 0\no Stra\xdfe\nusemtl K\xf6rper\nf 1/1 1/1 1/1\n",
    );
    write(
        folder.path(),
        "Körper.mtl",
        [&b"newmtl K\xf6rper\nmap_Kd K\xf6rper \x80.png\nmap_Ke "[..], "Weiß.png\n".as_bytes()].concat(),
    );
    write(folder.path(), "Körper €.png", png());
    write(folder.path(), "Weiß.png", png());
    let (found, warnings) = opened_in(folder.path());
    assert_eq!((found, warnings), (vec!["Körper €.png".to_owned(), "Weiß.png".to_owned()], vec![]));
    let model = Document::open(&folder.path().join("a.obj"), &LoadOptions::default()).unwrap();
    assert_eq!(model.json()["materials"][0]["name"], "Körper");
    assert_eq!(model.json()["meshes"][0]["name"], "Straße");
}

/// Archives that were packed on Windows give such names.
#[test]
#[cfg(target_os = "linux")]
fn names_of_files_that_are_not_utf_8_are_found() {
    use std::os::unix::ffi::OsStrExt;

    for reference in [&b"K\xf6rper.png"[..], "Körper.png".as_bytes(), b"D:\\maps\\K\xf6rper.png"] {
        let folder = tempfile::tempdir().unwrap();
        write(folder.path(), "a.obj", OBJ);
        write(folder.path(), "a.mtl", [b"newmtl a\nmap_Kd ", reference, b"\n"].concat());
        write(folder.path(), OsStr::from_bytes(b"K\xf6rper.png"), png());
        assert_eq!(opened_in(folder.path()).0, ["Körper.png"]);
    }
}

/// MeshLab names textures so, and reads the name of the PLY without folder and ending.
#[test]
#[cfg(feature = "ply")]
fn this_is_the_name_of_a_ply() {
    let ply = "ply\nformat ascii 1.0\ncomment TextureFile <this>_A.png\ncomment TextureFile <THIS>.png\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float s\nproperty float t\nelement face 1\nproperty list uchar int vertex_indices\nproperty int texnumber\nend_header\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2 0\n";
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "scan.1.ply", ply);
    write(folder.path(), "scan.1_A.png", png());
    let model = Document::open(&folder.path().join("scan.1.ply"), &LoadOptions::default()).unwrap();
    let (images, warnings) = images_of(&model);
    assert_eq!(images, ["scan.1_A.png"]);
    assert_eq!(warnings, ["\"scan.1.png\" is not in the model's folder; the texture is left out"]);
    assert_eq!(model.json()["materials"][0]["name"], "scan.1_A.png");
}

#[test]
fn a_texture_that_git_lfs_did_not_fetch_is_named() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "a.obj", OBJ);
    write(folder.path(), "a.mtl", "newmtl a\nmap_Kd w.png\n");
    write(folder.path(), "w.png", "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 1\n");
    let model = Document::open(&folder.path().join("a.obj"), &LoadOptions::default()).unwrap();
    let problem = "is a pointer of Git LFS, not the image; run: git lfs pull; the texture is left out";
    assert_eq!(model.warnings(), [format!("w.png: {problem}")]);
}

#[test]
fn a_library_that_git_lfs_did_not_fetch_is_named() {
    let (_, warnings) =
        opened("a.mtl", b"version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 1\n", &[]);
    let problem = "is a pointer of Git LFS, not the file; run: git lfs pull; its materials are left out";
    assert_eq!(warnings[0], format!("a.mtl: {problem}"));
}

/// The normal map of a material that glTF cannot hold.
#[test]
fn normal_maps_that_are_left_out_are_told_by_their_materials() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "a.obj", OBJ);
    write(folder.path(), "a.mtl", "newmtl b\nmap_Kd w.dds\nnewmtl a\nmap_Kd w.dds\nnorm n.bmp\n");
    write(folder.path(), "w.dds", "DDS ");
    write(folder.path(), "n.bmp", "BM and so on");
    let model = Document::open(&folder.path().join("a.obj"), &LoadOptions::default()).unwrap();
    let unread = &model.provenance().unwrap().unread_maps;
    let told: Vec<_> = unread.iter().map(|map| (map.material, &*map.file, &*map.problem)).collect();
    assert_eq!(told, [(1, "n.bmp", "is BMP, which is not read; save it as PNG")]);
    assert_eq!(model.warnings().len(), 2, "{:?}", model.warnings());
}

/// A map of `norm` is a normal map; one of the bump statements may be one of heights.
#[test]
fn normal_maps_that_are_not_there_are_told_by_their_materials() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "a.obj", OBJ);
    write(
        folder.path(),
        "a.mtl",
        "newmtl b\nmap_Bump heights.png\nnewmtl a\nmap_Kd w.png\nnorm C:\\maps\\n.png\n",
    );
    let model = Document::open(&folder.path().join("a.obj"), &LoadOptions::default()).unwrap();
    let unread = &model.provenance().unwrap().unread_maps;
    let told: Vec<_> =
        unread.iter().map(|map| (map.material, &*map.file, &*map.problem, map.is_absent)).collect();
    assert_eq!(told, [(1, "n.png", "is not in the model's folder", true)]);
}

/// Several statements of one material, in several of its textures.
#[test]
fn a_material_that_loses_something_counts_once() {
    let library = "newmtl a\nmap_Kd -mm 0 2 -imfchan r a.mtl\nmap_Ke -t 1 1 1 a.mtl\nmap_Ks -mm 1 1 a.mtl\n";
    let (_, warnings) = opened("a.mtl", library.as_bytes(), &[]);
    let lost: Vec<_> = warnings.iter().filter(|warning| warning.contains("material")).collect();
    assert_eq!(lost, ["not carried over: map_Ks of 1 material, options of textures of 1 material"]);
}
