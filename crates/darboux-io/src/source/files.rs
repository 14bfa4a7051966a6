//! The files that a model refers to: textures, material libraries. The rules are glTF's: nothing outside the
//! model's folder, unless the caller allows it.
//!
//! Other formats often hold absolute paths of another machine, or paths of Windows. Such a file is looked up
//! by the ends of its path and in the usual subfolders. Names may differ from the file's in the case of
//! letters, which Windows ignores.

use std::cell::{Cell, RefCell};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::other_case::OtherCase;
#[cfg(any(feature = "fbx", feature = "obj"))]
use crate::MemoryLimit;
use crate::error::quoted;
#[cfg(any(feature = "fbx", feature = "obj"))]
use crate::error::shortened;
#[cfg(any(feature = "fbx", feature = "obj"))]
use crate::source::scene::MissingImage;
use crate::words::Count;
use crate::{Files, LoadOptions, files, paths};

/// The most paths that are looked up for one model beside those that its references state. Each lookup asks
/// the operating system.
const MAX_LOOKUPS: usize = 100_000;

/// The most paths of these for one reference: more than the ends of the longest line, and a small part of
/// all, so that lines of many words leave the others theirs.
const MAX_LOOKUPS_OF_ONE: usize = 3000;

/// No path has more bytes. Longer references are not looked up: one may begin at every word of a line.
pub const LONGEST_PATH: usize = 4096;

/// The ends of a path that are looked up have at most as many parts.
const MOST_PARTS: usize = 16;

/// Where a model's files are.
#[derive(Clone, Debug)]
pub enum FileSource {
    /// A folder on this machine, links resolved.
    Folder(PathBuf),
    /// Files that a program gives, and the model's folder among them.
    Given(Arc<dyn Files>, PathBuf),
    /// The model came without a folder.
    None,
}

/// Looks up the files that a model refers to.
#[derive(Debug)]
pub struct ModelFiles {
    /// The name of the model's file without folder and ending.
    stem: String,
    source: FileSource,
    allow_outside: bool,
    allow_outside_name: &'static str,
    #[cfg(any(feature = "fbx", feature = "obj"))]
    memory_limit: MemoryLimit,
    lookups_left: Cell<usize>,
    /// The lookups that are left for the reference that is looked up now.
    left_of_reference: Cell<usize>,
    /// The files that were read from the disk.
    read: RefCell<Vec<PathBuf>>,
    other_case: RefCell<OtherCase>,
}

/// A file that exists and may be read.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct FoundFile {
    /// The path relative to the model's folder, its parts separated by `/`.
    pub name: String,
    /// The path on this machine, links resolved; the name among given files.
    pub path: PathBuf,
    /// Whether it was found by its name alone, or with letters of another case.
    pub is_by_name: bool,
}

impl ModelFiles {
    /// The files of the model whose file is `model`.
    pub fn new(model: &str, source: FileSource, options: &LoadOptions) -> Self {
        let stem = Path::new(model).file_stem().unwrap_or_default();
        Self {
            stem: stem.to_string_lossy().into_owned(),
            source,
            allow_outside: options.allow_outside,
            allow_outside_name: options.option_names.allow_outside,
            #[cfg(any(feature = "fbx", feature = "obj"))]
            memory_limit: options.memory_limit,
            lookups_left: Cell::new(MAX_LOOKUPS),
            left_of_reference: Cell::new(MAX_LOOKUPS_OF_ONE),
            read: RefCell::default(),
            other_case: RefCell::default(),
        }
    }

    /// The name of the model's file without folder and ending.
    #[cfg(feature = "ply")]
    pub fn stem(&self) -> &str {
        &self.stem
    }

    /// Begins the lookups of another reference. Its own path is looked up in any case.
    pub fn begin_reference(&self) {
        self.left_of_reference.set(self.lookups_left.get().clamp(1, MAX_LOOKUPS_OF_ONE));
    }

    /// The file that a reference names, relative to the folder of the file `base`; empty is the model itself.
    /// `\` separates folders as `/` does. Where the path leads nowhere, other places are looked up.
    pub fn find(&self, base: &str, reference: &str) -> Option<FoundFile> {
        self.find_in_place(base, reference).or_else(|| {
            let places = self.other_places(base, &self.usable(reference)?);
            let found = places.iter().find_map(|path| self.inside(path, true));
            found.or_else(|| places.iter().find_map(|path| self.in_other_case(path)))
        })
    }

    /// Where a file may be whose path leads nowhere, relative to the model's folder, the nearest place first.
    /// `C:/proj/textures/w.png` in `sub/a.mtl` of `chair.obj`:
    ///
    /// ```text
    /// sub/proj/textures/w.png   proj/textures/w.png   the ends of the path, the longest first,
    /// sub/textures/w.png        textures/w.png        beside the file that names it, and beside the model
    /// sub/w.png                 w.png
    /// sub/Textures/w.png        Textures/w.png        its name in the folders where programs put textures
    /// sub/chair.fbm/w.png       chair.fbm/w.png
    /// ```
    fn other_places(&self, base: &str, reference: &str) -> Vec<PathBuf> {
        let is_part = |part: &&str| !matches!(*part, "" | "." | "..") && !part.ends_with(':');
        let parts: Vec<&str> = reference.split('/').filter(is_part).collect();
        let Some(name) = parts.last() else { return Vec::new() };
        let longest = parts.len().min(MOST_PARTS);
        let ends = (1..=longest).rev().map(|count| parts[parts.len() - count..].join("/"));
        let usual =
            ["textures", "Textures", &format!("{}.fbm", self.stem)].map(|folder| format!("{folder}/{name}"));
        let beside = folder_of(base);
        let mut places: Vec<_> =
            ends.chain(usual).flat_map(|end| [beside.join(&end), PathBuf::from(end)]).collect();
        places.dedup();
        places
    }

    /// As [`ModelFiles::find`], but at the path itself only, in whatever case its letters are.
    pub fn find_in_place(&self, base: &str, reference: &str) -> Option<FoundFile> {
        let reference = self.usable(reference)?;
        let is_absolute = reference.starts_with('/') || reference.as_bytes().get(1) == Some(&b':');
        if is_absolute {
            let is_on_disk = matches!(self.source, FileSource::Folder(_));
            if !(is_on_disk && self.allow_outside && self.may_look_up()) {
                return None;
            }
            let path = PathBuf::from(&reference).canonicalize().ok().filter(|path| path.is_file())?;
            return Some(FoundFile { name: reference, path, is_by_name: false });
        }
        let relative = folder_of(base).join(reference);
        self.inside(&relative, false).or_else(|| self.in_other_case(&relative))
    }

    /// The reference with `/` between its parts; none for one that is not looked up: callers try many ends of
    /// long lines.
    fn usable(&self, reference: &str) -> Option<String> {
        let reference = reference.trim();
        let is_usable =
            !reference.is_empty() && reference.len() <= LONGEST_PATH && self.left_of_reference.get() > 0;
        is_usable.then(|| reference.replace('\\', "/"))
    }

    /// The file at a path relative to the model's folder whose parts differ in the case of letters only.
    fn in_other_case(&self, relative: &Path) -> Option<FoundFile> {
        let FileSource::Folder(folder) = &self.source else { return None };
        let found = self.other_case.borrow_mut().find(folder, relative, || self.may_look_up())?;
        self.inside(&found, true)
    }

    /// The file at a path relative to the model's folder.
    fn inside(&self, relative: &Path, is_by_name: bool) -> Option<FoundFile> {
        if !self.may_look_up() {
            return None;
        }
        match &self.source {
            FileSource::None => None,
            FileSource::Given(given, folder) => {
                let path = files::normalised(&folder.join(relative))?;
                let name = files::name(&path);
                given.has(&name).then_some(FoundFile { name, path, is_by_name })
            }
            FileSource::Folder(folder) => {
                let normalised = files::normalised(relative);
                if normalised.is_none() && !self.allow_outside {
                    return None;
                }
                let path = folder.join(relative).canonicalize().ok()?;
                let may_read = self.allow_outside || path.starts_with(folder);
                let name = files::name(normalised.as_deref().unwrap_or(relative));
                (may_read && path.is_file()).then_some(FoundFile { name, path, is_by_name })
            }
        }
    }

    /// The memory limit of the model.
    #[cfg(any(feature = "fbx", feature = "obj"))]
    pub fn memory_limit(&self) -> MemoryLimit {
        self.memory_limit
    }

    fn may_look_up(&self) -> bool {
        let left = self.left_of_reference.get();
        self.left_of_reference.set(left.saturating_sub(1));
        self.lookups_left.set(self.lookups_left.get().saturating_sub(1));
        left > 0
    }

    /// The content of a file. Errors: it cannot be read, or was replaced since it was found.
    pub fn read(&self, file: &FoundFile) -> io::Result<Vec<u8>> {
        match &self.source {
            FileSource::Given(given, _) => given.read(&file.name),
            FileSource::Folder(_) | FileSource::None => {
                self.read.borrow_mut().push(file.path.clone());
                paths::read_resolved(&file.path)
            }
        }
    }

    /// The files that were read from the disk, links resolved, each once.
    pub fn into_read(self) -> Vec<PathBuf> {
        let mut read = self.read.into_inner();
        read.sort_unstable();
        read.dedup();
        read
    }

    /// What is wrong with a reference that was not found: a sentence without its last part.
    pub fn problem(&self, reference: &str) -> String {
        format!("{} {}", quoted(reference), self.absence(reference))
    }

    /// The image of a reference that was not found.
    #[cfg(any(feature = "fbx", feature = "obj"))]
    pub fn missing_image(&self, reference: &str) -> MissingImage {
        let name = reference.rsplit(['/', '\\']).next().unwrap_or(reference);
        let was_looked_up = self.lookups_left.get() > 0 && self.left_of_reference.get() > 0;
        let is_absent = was_looked_up && !matches!(self.source, FileSource::None);
        MissingImage { name: shortened(name), problem: self.absence(reference), is_absent }
    }

    /// What is wrong with a reference that was not found: a clause whose subject is the file.
    fn absence(&self, reference: &str) -> String {
        match &self.source {
            _ if self.lookups_left.get() == 0 => {
                format!(
                    "was looked up at its own path only, because more than {} paths were tried for the files \
                     that the model names",
                    Count(MAX_LOOKUPS)
                )
            }
            _ if self.left_of_reference.get() == 0 => {
                format!("is not at the first {} paths that it may mean", Count(MAX_LOOKUPS_OF_ONE))
            }
            FileSource::None => "was not looked up, because the model came without a folder".to_owned(),
            FileSource::Given(..) => "is not among the files".to_owned(),
            FileSource::Folder(_) if self.allow_outside => "does not exist".to_owned(),
            FileSource::Folder(_) if reference.contains("..") => {
                let option = self.allow_outside_name;
                format!("is not in the model's folder ({option} allows files outside)")
            }
            FileSource::Folder(_) => "is not in the model's folder".to_owned(),
        }
    }

    /// A sentence about a file that was found by its name only, or with letters of another case.
    pub fn by_name_warning(reference: &str, file: &FoundFile) -> Option<String> {
        file.is_by_name.then(|| format!("{} was found as {}, by its name", quoted(reference), file.name))
    }
}

/// The folder of a file named `name`.
fn folder_of(name: &str) -> &Path {
    Path::new(name.rsplit_once('/').map_or("", |(folder, _)| folder))
}
