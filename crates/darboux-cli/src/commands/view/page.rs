//! Finds and reads the files of the viewer's page.

use std::collections::HashMap;
use std::fs::OpenOptions;
use std::io::Read;
use std::path::{Path, PathBuf};

use walkdir::WalkDir;

use crate::regular_file::{Links, open_regular};

/// The files of the page by their path relative to the page's folder, with `/` on every system. No other file
/// is served.
pub struct Page {
    files: HashMap<String, PathBuf>,
}

impl Page {
    /// Finds the page in `folder`, or beside the program and in its source folder. Errors: the page was not
    /// built.
    pub fn find(folder: Option<&Path>) -> Result<Self, String> {
        let folders = folder.map_or_else(default_folders, |folder| vec![folder.to_owned()]);
        let is_page = |folder: &&PathBuf| folder.join("index.html").is_file();
        let found = folders.iter().find(is_page).ok_or_else(|| {
            let folders: Vec<_> = folders.iter().map(|folder| folder.display().to_string()).collect();
            let folders = folders.join(" or ");
            format!(
                "the viewer's page was not found in {folders}; build it with `cargo xtask dist-viewer`, \
                 which needs Node.js, or name its folder with --page"
            )
        })?;
        Ok(Self { files: files_in(found) })
    }

    /// The media type and content of a file; `None` if the page has no such regular file.
    pub fn read(&self, name: &str) -> Option<(&'static str, Vec<u8>)> {
        let path = self.files.get(name)?;
        let mut bytes = Vec::new();
        open_regular(path, OpenOptions::new().read(true), Links::Refuse)
            .ok()?
            .read_to_end(&mut bytes)
            .ok()?;
        Some((media_type(path), bytes))
    }
}

/// The folder `viewer` beside this program, and the build output in the source folder of this program.
fn default_folders() -> Vec<PathBuf> {
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

    use super::default_folders;

    #[test]
    fn default_folders_are_absolute_and_normalised() {
        let folders = default_folders();
        assert_eq!(folders.len(), 2);
        for folder in folders {
            assert!(
                folder.is_absolute() && !folder.components().any(|part| part == Component::ParentDir),
                "{folder:?}"
            );
        }
    }
}
