//! The files of the viewer's page.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use walkdir::WalkDir;

/// The page: its files by their path below its folder, with `/` between parts. Nothing else in the folder's surroundings can be asked for.
pub struct Page {
    files: HashMap<String, PathBuf>,
}

impl Page {
    /// Finds the page in `folder`, or in its usual places. Errors: it has not been made.
    pub fn find(folder: Option<&Path>) -> Result<Self, String> {
        let places = folder.map_or_else(usual_places, |folder| vec![folder.to_owned()]);
        let is_page = |folder: &&PathBuf| folder.join("index.html").is_file();
        let found = places.iter().find(is_page).ok_or_else(|| {
            let places: Vec<_> = places.iter().map(|place| place.display().to_string()).collect();
            let places = places.join(" and ");
            format!("the viewer's page is not in {places}; make it with `cargo xtask dist-viewer` (needs node and npm)")
        })?;
        Ok(Self { files: files_in(found) })
    }

    /// The media type and content of a file. None: there is no such file.
    pub fn read(&self, name: &str) -> Option<(&'static str, Vec<u8>)> {
        let path = self.files.get(name)?;
        Some((media_type(path), fs::read(path).ok()?))
    }
}

/// Beside this program, and in the sources that it was built from.
fn usual_places() -> Vec<PathBuf> {
    let program = std::env::current_exe().ok();
    let beside = program.as_deref().and_then(Path::parent).map(|folder| folder.join("viewer"));
    let sources =
        Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).map(|root| root.join("viewer/dist"));
    beside.into_iter().chain(sources).collect()
}

fn files_in(folder: &Path) -> HashMap<String, PathBuf> {
    let files =
        WalkDir::new(folder).into_iter().filter_map(Result::ok).filter(|entry| entry.file_type().is_file());
    let named = files.filter_map(|entry| {
        let below = entry.path().strip_prefix(folder).ok()?;
        let parts: Option<Vec<_>> = below.iter().map(|part| part.to_str()).collect();
        Some((parts?.join("/"), entry.path().to_owned()))
    });
    named.collect()
}

fn media_type(path: &Path) -> &'static str {
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("html") => "text/html; charset=utf-8",
        Some("js") => "text/javascript; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("wasm") => "application/wasm",
        Some("glb") => "model/gltf-binary",
        Some("svg") => "image/svg+xml",
        Some("json") => "application/json",
        Some("txt") => "text/plain; charset=utf-8",
        _ => "application/octet-stream",
    }
}

#[cfg(test)]
mod tests {
    use std::path::Component;

    use super::usual_places;

    #[test]
    fn places_are_named_as_people_look_them_up() {
        let places = usual_places();
        assert_eq!(places.len(), 2);
        for place in places {
            assert!(
                place.is_absolute() && !place.components().any(|part| part == Component::ParentDir),
                "{place:?}"
            );
        }
    }
}
