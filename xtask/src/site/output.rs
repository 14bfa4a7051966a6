//! The folder of the site, and what lies in it.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use super::html::{Link, Page, escaped, target};
use crate::run::{Outcome, root};

/// Files above this size are not copied: the site would repeat the repository's models.
const LARGEST_COPY: u64 = 1 << 22;

pub struct Output {
    folder: PathBuf,
}

impl Output {
    /// An empty folder. Errors: it cannot be emptied.
    pub fn new(folder: &Path) -> Result<Self, String> {
        if folder.exists() {
            fs::remove_dir_all(folder)
                .map_err(|error| format!("{} cannot be emptied: {error}", folder.display()))?;
        }
        Ok(Self { folder: folder.to_path_buf() })
    }

    pub fn write(&self, path: &Path, bytes: &[u8]) -> Outcome {
        let path = self.folder.join(path);
        let made = path.parent().map_or(Ok(()), fs::create_dir_all).and_then(|()| fs::write(&path, bytes));
        made.map_err(|error| format!("{} cannot be written: {error}", path.display()))
    }

    pub fn copy(&self, from: &Path, to: &Path) -> Outcome {
        let bytes = fs::read(from).map_err(|error| format!("{} cannot be read: {error}", from.display()))?;
        self.write(to, &bytes)
    }

    /// Copies the files that links lead to. Folders become lists of their files.
    pub fn add_linked_files<'a>(&mut self, links: impl Iterator<Item = &'a Link>) -> Outcome {
        for link in links {
            let source = root().join(&link.target);
            let target = self.folder.join(target(&link.target));
            if source.is_dir() && !target.join("index.html").exists() {
                self.write(&link.target.join("index.html"), list(&link.target, &source)?.as_bytes())?;
            } else if source.is_file() && !target.exists() {
                self.copy_or_name(&source, &link.target)?;
            }
        }
        Ok(())
    }

    /// Copies a file; of a large one, its name and size.
    fn copy_or_name(&self, source: &Path, path: &Path) -> Outcome {
        let size =
            source.metadata().map_err(|error| format!("{} cannot be read: {error}", source.display()))?.len();
        if size <= LARGEST_COPY {
            return self.copy(source, path);
        }
        self.write(
            path,
            format!("{} has {size} bytes. It lies in the repository.\n", path.display()).as_bytes(),
        )
    }

    /// Why a link leads nowhere in the site; none if it leads somewhere.
    pub fn problem(&self, link: &Link, pages: &BTreeMap<PathBuf, Page>) -> Option<String> {
        let target = self.folder.join(target(&link.target));
        let shown = format!("{}: {}", link.page.display(), link.target.display());
        if !target.exists() {
            return Some(format!("{shown}: there is no such file"));
        }
        let heading = link.heading.as_ref()?;
        let page = pages.get(&link.target)?;
        (!page.ids.contains(heading)).then(|| format!("{shown}#{heading}: there is no such heading"))
    }
}

/// A page with the names of the files in a folder.
fn list(path: &Path, folder: &Path) -> Result<String, String> {
    let failed = |error| format!("{} cannot be read: {error}", folder.display());
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        names.push(entry.map_err(failed)?.file_name().to_string_lossy().into_owned());
    }
    names.sort();
    let title = escaped(&path.to_string_lossy());
    let items: String =
        names.iter().map(|name| format!("<li><code>{}</code></li>\n", escaped(name))).collect();
    let base = "../".repeat(path.components().count());
    Ok(format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{title}</title>\
         <link rel=\"stylesheet\" href=\"{base}style.css\"></head>\n<body><main>\n<h1>{title}</h1>\n\
         <p>A folder of the repository. <a \
         href=\"{base}index.html\">Darboux</a></p>\n<ul>\n{items}</ul>\n</main></body></html>\n"
    ))
}
