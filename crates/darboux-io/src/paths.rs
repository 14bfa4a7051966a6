//! What paths stand for, and which may be read and written: regular files, links resolved. A pipe would wait for its other end, a device give no end.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::Error;

/// What a file is, as its extension says in whichever case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// `.glb`, and `.vrm`, which is one.
    Glb,
    /// `.gltf`.
    Gltf,
    /// `.png`.
    Png,
    /// An image that loses texels, or that few programs write as a normal map: nothing here reads it.
    OtherImage,
}

impl FileKind {
    /// None: another extension, or none.
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

    /// Whether it holds a model.
    pub fn is_model(self) -> bool {
        matches!(self, Self::Glb | Self::Gltf)
    }
}

/// The file to read: `path`, or what it links to. Errors: none there; anything but a regular file.
pub fn readable(path: &Path) -> Result<PathBuf, Error> {
    let failed = |source| Error::Read { file: path.to_owned(), source };
    // Asked first, as a piped /dev/stdin links to nothing that has a name.
    let metadata = fs::metadata(path).map_err(failed)?;
    if metadata.is_dir() {
        return Err(failed(io::Error::other("it is a folder; name a file in it")));
    }
    if !metadata.is_file() {
        return Err(failed(io::Error::other("it is not a regular file; save its content as one")));
    }
    path.canonicalize().map_err(failed)
}

/// The file to write: `path`, or what it links to. `why_not` says why an existing one must stay, if it must.
///
/// Errors: a broken link; what is no regular file, is read-only, or must stay; an existing file without `force`.
pub fn writable(
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

/// A file can be replaced where its folder can be written; one that is read-only was made so to prevent that, as some version control does.
pub fn refuse_read_only(path: &Path, metadata: &fs::Metadata) -> Result<(), Error> {
    if metadata.permissions().readonly() {
        let problem = "is read-only; make it writable, or name another output".to_owned();
        return Err(Error::Output { file: path.to_owned(), problem });
    }
    Ok(())
}
