//! Reads model files as meshes.

use std::io::Write;
use std::path::{Path, PathBuf};

use darboux_io::LoadOptions;
use darboux_io::gltf::schema::Primitive;
use darboux_io::gltf::{Document, IndexList};

use crate::OwnedMesh;

/// The folder of models beside those of the repository, which the environment variable `DARBOUX_MODELS`
/// names; a relative path starts at the repository's root. `None` if the variable is not set, with a sentence
/// past the test runner's capture.
///
/// # Panics
/// The path is not a folder.
pub fn further_models() -> Option<PathBuf> {
    const VARIABLE: &str = "DARBOUX_MODELS";
    let Some(path) = std::env::var_os(VARIABLE) else {
        let what = "skipped: no further models; set DARBOUX_MODELS to a folder of .gltf and .glb files";
        writeln!(std::io::stdout(), "{what}").expect("standard output");
        return None;
    };
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path);
    assert!(folder.is_dir(), "{VARIABLE} is {}, which is not a folder", folder.display());
    Some(folder)
}

/// All .gltf and .glb files below a folder, sorted.
pub fn models(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("a readable folder").path()).collect();
    paths.sort();
    let is_model =
        |path: &Path| path.extension().is_some_and(|extension| extension == "gltf" || extension == "glb");
    paths
        .into_iter()
        .flat_map(|path| if path.is_dir() { models(&path) } else { vec![path] })
        .filter(|path| is_model(path))
        .collect()
}

/// The mesh of a primitive, if it is a triangle list with positions, normals and UVs.
fn mesh(document: &Document, primitive: &Primitive) -> Option<OwnedMesh> {
    let accessor = |semantic: &str| primitive.attributes.get(semantic).copied();
    let (position, normal, uv) = (accessor("POSITION")?, accessor("NORMAL")?, accessor("TEXCOORD_0")?);
    let indices =
        primitive.indices.map(|indices| document.indices(indices)).transpose().ok()?.map(IndexList::into_u32);
    let mesh = OwnedMesh {
        positions: document.vectors(position).ok()?.into_owned(),
        normals: document.vectors(normal).ok()?.into_owned(),
        uvs: document.vectors(uv).ok()?.into_owned(),
        indices,
        ..OwnedMesh::default()
    };
    let whole = mesh.corner_count() > 0 && mesh.corner_count().is_multiple_of(3);
    let in_range =
        (0..mesh.corner_count()).all(|corner| mesh.vertex_of_corner(corner) < mesh.positions.len());
    (primitive.mode == 4 && whole && in_range).then_some(mesh)
}

/// The primitives of a model that are triangle lists with positions, normals and UVs, and their numbers;
/// empty if the file cannot be read.
pub fn meshes(path: &Path) -> Vec<(usize, OwnedMesh)> {
    let Ok(document) = Document::open(path, &LoadOptions::default()) else { return Vec::new() };
    let numbered = document.meshes().iter().flat_map(|mesh| &mesh.primitives).enumerate();
    numbered.filter_map(|(number, primitive)| Some((number, mesh(&document, primitive)?))).collect()
}
