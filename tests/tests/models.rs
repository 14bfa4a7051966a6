//! Real models against the reference, bit for bit: the repository's, and a larger set where it lies beside the repository.

use std::io::Write;
use std::path::{Path, PathBuf};

use darboux::Mode;
use darboux_io::gltf::schema::Primitive;
use darboux_io::gltf::{Document, LoadOptions};
use darboux_tests::{Case, OwnedMesh, all_modes, assert_equal, engine, engines};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// All .gltf and .glb files below a folder, sorted.
fn models(folder: &Path) -> Vec<PathBuf> {
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

/// The triangles of a primitive, where it is a triangle list with all that tangents need.
fn mesh(document: &Document, primitive: &Primitive) -> Option<OwnedMesh> {
    let accessor = |semantic: &str| primitive.attributes.get(semantic).copied();
    let (position, normal, uv) = (accessor("POSITION")?, accessor("NORMAL")?, accessor("TEXCOORD_0")?);
    let indices = primitive.indices.map(|indices| document.read_indices(indices)).transpose().ok()?;
    let mesh = OwnedMesh {
        positions: document.read_vectors(position).ok()?,
        normals: document.read_vectors(normal).ok()?,
        uvs: document.read_vectors(uv).ok()?,
        indices,
        ..OwnedMesh::default()
    };
    let whole = mesh.corner_count() > 0 && mesh.corner_count().is_multiple_of(3);
    let in_range =
        (0..mesh.corner_count()).all(|corner| mesh.vertex_of_corner(corner) < mesh.positions.len());
    (primitive.mode == 4 && whole && in_range).then_some(mesh)
}

/// Compares every primitive below `folder`; returns how many primitives and triangles that were.
fn compare(folder: &Path) -> (usize, usize) {
    let (mut primitives, mut triangles) = (0, 0);
    for path in models(folder) {
        let Ok(mut document) = Document::open(&path, &LoadOptions::default()) else { continue };
        if document.decompress().is_err() {
            continue;
        }
        for (number, primitive) in document.meshes().iter().flat_map(|mesh| &mesh.primitives).enumerate() {
            let Some(mesh) = mesh(&document, primitive) else { continue };
            let expected = engine::reference(&mesh, 180.0);
            for engine in engines() {
                if let Some(found) = engine.run(&mesh, 180.0, Mode::Reference) {
                    let what = format!("{}: {}, primitive {number}", engine.name(), path.display());
                    assert_equal(&what, &mesh, 180.0, &expected, &found);
                }
            }
            (primitives, triangles) = (primitives + 1, triangles + mesh.corner_count() / 3);
            if let Err(broken) = all_modes(&Case { mesh, threshold: 180.0 }) {
                panic!("{}, primitive {number}: {broken}", path.display());
            }
        }
    }
    println!("{}: {primitives} primitives, {triangles} triangles", folder.display());
    (primitives, triangles)
}

#[test]
fn the_repository_s_models() {
    let (primitives, _) = compare(&root().join("assets"));
    assert!(primitives > 8, "{primitives} primitives");
}

#[test]
fn the_larger_set() {
    let folder = root().join("../shared/assets");
    if !folder.is_dir() {
        // Written past the test runner's capture, so that it is seen and counted.
        writeln!(std::io::stdout(), "skipped: {} is absent", folder.display()).expect("standard output");
        return;
    }
    let (primitives, _) = compare(&folder);
    assert!(primitives > 100, "{primitives} primitives");
}
