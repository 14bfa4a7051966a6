//! Faces invert no map that was not baked for them: real maps of one model are put on other ones.

use std::env;
use std::io::Write;
use std::path::{Path, PathBuf};

use darboux::TangentDirection;
use darboux_check::{CheckOptions, ModelOfMaps, check_map_on_model, check_model_of_maps};
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use walkdir::WalkDir;

/// A model, and the files of its normal maps.
struct Real {
    name: String,
    model: ModelOfMaps,
    maps: Vec<Vec<u8>>,
}

fn read(path: &Path) -> Option<Real> {
    let document = Document::open(path, &LoadOptions::default()).ok()?;
    let materials = document.materials().ok()?;
    let textures = materials.iter().filter_map(|material| material.normal_texture.as_ref());
    let mut images: Vec<usize> = textures.filter_map(|texture| texture.image).collect();
    images.sort_unstable();
    images.dedup();
    let maps =
        images.iter().filter_map(|&image| Some(document.image_bytes(image).ok()?.into_owned())).collect();
    let model = check_model_of_maps(&document).ok()?;
    Some(Real { name: path.file_name()?.to_string_lossy().into_owned(), model, maps })
}

fn models() -> Vec<Real> {
    let Some(folder) = env::var_os("DARBOUX_MODELS").map(PathBuf::from) else { return Vec::new() };
    let files = WalkDir::new(folder).sort_by_file_name().into_iter().filter_map(Result::ok);
    let is_model = |path: &PathBuf| path.extension().is_some_and(|end| end == "glb" || end == "gltf");
    let is_small = |path: &PathBuf| path.metadata().is_ok_and(|file| file.len() < 20_000_000);
    let paths = files.map(walkdir::DirEntry::into_path).filter(is_model).filter(is_small);
    let mut found: Vec<Real> = paths.filter_map(|path| read(&path)).collect();
    found.dedup_by(|a, b| a.maps == b.maps && !a.maps.is_empty());
    found
}

/// The most pairs that are checked, evenly chosen: all of them would take hours.
const MOST_PAIRS: usize = 1000;

#[test]
#[ignore = "puts real maps on real models: cargo xtask ci --full runs it"]
fn maps_of_other_models_are_not_inverted_by_faces() {
    let models = models();
    if models.is_empty() {
        writeln!(std::io::stdout(), "skipped: DARBOUX_MODELS names no folder of models").expect("output");
        return;
    }
    let maps: Vec<(&Real, &Vec<u8>)> =
        models.iter().flat_map(|of_map| of_map.maps.iter().map(move |map| (of_map, map))).collect();
    let others = |(of_map, map)| {
        models.iter().filter(move |on| !on.maps.contains(map)).map(move |on| (of_map, map, on))
    };
    let all: Vec<(&Real, &Vec<u8>, &Real)> = maps.into_iter().flat_map(others).collect();
    let chosen = all.iter().step_by(all.len().div_ceil(MOST_PAIRS).max(1));
    let (mut pairs, mut decided, mut inverted) = (0, 0, Vec::new());
    for (of_map, map, on) in chosen {
        pairs += 1;
        let Some(directions) = check_map_on_model(map, &on.model, &CheckOptions::default()).directions else {
            continue;
        };
        decided += 1;
        if directions.red == TangentDirection::Left {
            inverted.push(format!("{} on {}: {directions:?}", of_map.name, on.name));
        }
    }
    let of = all.len();
    writeln!(std::io::stdout(), "{decided} of {pairs} pairs (of {of}) are decided").expect("output");
    assert!(inverted.is_empty(), "{} of {pairs} are called inverted: {inverted:#?}", inverted.len());
}
