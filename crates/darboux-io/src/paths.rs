//! File kinds by extension, and checks of paths before they are read or written.
//!
//! Only regular files are read and written, links resolved: a pipe would block until its other end opens, and a device may never end.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::Error;

/// The kind of a file by its extension, in upper or lower case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FileKind {
    /// `.glb`, and `.vrm`, which has the same format.
    Glb,
    /// `.gltf`.
    Gltf,
    /// `.png`.
    Png,
    /// An image format that is not read here: lossy, or rare for normal maps.
    OtherImage,
}

impl FileKind {
    /// The kind of a path; none for other extensions and for none.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_ascii_lowercase().to_str()? {
            "glb" | "vrm" => Some(Self::Glb),
            "gltf" => Some(Self::Gltf),
            "png" => Some(Self::Png),
            "avif" | "bmp" | "dds" | "exr" | "jpeg" | "jpg" | "ktx2" | "psd" | "tga" | "tif" | "tiff"
            | "webp" => Some(Self::OtherImage),
            _ => None,
        }
    }

    /// Whether files of this kind hold models.
    pub fn is_model(self) -> bool {
        matches!(self, Self::Glb | Self::Gltf)
    }
}

/// The regular file to read at `path`, links resolved. Errors: there is no file, or it is not a regular file.
pub fn resolve_input(path: &Path) -> Result<PathBuf, Error> {
    let failed = |source| Error::Read { file: path.to_owned(), source };
    // Metadata comes first: a piped /dev/stdin links to something without a path.
    let metadata = fs::metadata(path).map_err(failed)?;
    if metadata.is_dir() {
        return Err(failed(io::Error::other("it is a folder; name a file in it")));
    }
    if !metadata.is_file() {
        return Err(failed(io::Error::other("it is not a regular file; save its content as one")));
    }
    path.canonicalize().map_err(failed)
}

/// The regular file to write at `path`, links resolved. `why_not` gives the reason when an existing file must not be replaced.
///
/// Errors: a broken link; an existing file that is not regular, is read-only, or must not be replaced; an existing file without `force`.
pub fn resolve_output(
    path: &Path,
    force: bool,
    why_not: impl FnOnce(&Path) -> Option<&'static str>,
) -> Result<PathBuf, Error> {
    let refuse = |problem: &str| Error::Output { file: path.to_owned(), problem: problem.to_owned() };
    let Ok(metadata) = fs::metadata(path) else {
        return if path.is_symlink() {
            Err(refuse("is a broken link; remove it"))
        } else {
            Ok(path.to_owned())
        };
    };
    if !metadata.is_file() {
        return Err(refuse("exists and is not a regular file; name another output"));
    }
    refuse_read_only(path, &metadata)?;
    let target = path.canonicalize().map_err(|source| Error::Write { file: path.to_owned(), source })?;
    if let Some(problem) = why_not(&target) {
        return Err(refuse(problem));
    }
    if force { Ok(target) } else { Err(refuse("exists; force its replacement or name another output")) }
}

/// Refuses to replace a read-only file. Its folder would permit that, but version control marks files so to prevent changes.
pub fn refuse_read_only(path: &Path, metadata: &fs::Metadata) -> Result<(), Error> {
    if metadata.permissions().readonly() {
        let problem = "is read-only; make it writable, or name another output".to_owned();
        return Err(Error::Output { file: path.to_owned(), problem });
    }
    Ok(())
}
