//! File kinds by extension, and checks of paths before they are read or written.
//!
//! Only regular files are read and written, links resolved: a pipe would block until its other end opens, and a device may never end.

#[cfg(unix)]
use std::fs::OpenOptions;
use std::fs::{self, File};
use std::io::{self, Read};
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
    /// `.obj`.
    Obj,
    /// `.ply`.
    Ply,
    /// `.stl`.
    Stl,
    /// `.fbx`.
    Fbx,
    /// `.png`.
    Png,
    /// `.jpg`, `.jpeg`.
    Jpeg,
    /// `.webp`.
    WebP,
    /// An image format without a decoder here.
    OtherImage,
}

impl FileKind {
    /// The kind of a path; none for other extensions and for none.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_ascii_lowercase().to_str()? {
            "glb" | "vrm" => Some(Self::Glb),
            "gltf" => Some(Self::Gltf),
            "obj" => Some(Self::Obj),
            "ply" => Some(Self::Ply),
            "stl" => Some(Self::Stl),
            "fbx" => Some(Self::Fbx),
            "png" => Some(Self::Png),
            "jpeg" | "jpg" => Some(Self::Jpeg),
            "webp" => Some(Self::WebP),
            "avif" | "bmp" | "dds" | "exr" | "ktx2" | "psd" | "tga" | "tif" | "tiff" => {
                Some(Self::OtherImage)
            }
            _ => None,
        }
    }

    /// Whether files of this kind hold models that this build reads.
    pub fn is_model(self) -> bool {
        match self {
            Self::Obj => cfg!(feature = "obj"),
            Self::Ply => cfg!(feature = "ply"),
            Self::Stl => cfg!(feature = "stl"),
            Self::Fbx => cfg!(feature = "fbx"),
            other => other.is_gltf(),
        }
    }

    /// Whether files of this kind hold glTF.
    pub fn is_gltf(self) -> bool {
        matches!(self, Self::Glb | Self::Gltf)
    }

    /// Whether documents can be written as files of this kind.
    pub fn is_written_model(self) -> bool {
        self.is_gltf() || matches!(self, Self::Obj | Self::Ply)
    }

    /// Whether files of this kind are images.
    pub fn is_image(self) -> bool {
        self.is_decoded_image() || self == Self::OtherImage
    }

    /// Whether files of this kind are images that can be decoded (feature `textures`).
    pub fn is_decoded_image(self) -> bool {
        matches!(self, Self::Png | Self::Jpeg | Self::WebP)
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

/// Opens a regular file at a path whose links were resolved before.
///
/// Another process may have replaced the file since. So the opened file is checked, not the path: errors are a link in the path, and anything
/// but a regular file, which is not waited for.
pub fn open_resolved(path: &Path) -> io::Result<File> {
    let file = open_at_once(path)?;
    let opened = file.metadata()?;
    if !opened.is_file() {
        return Err(io::Error::other("it is not a regular file; save its content as one"));
    }
    if path.canonicalize()? != path || !is_same_file(&opened, &fs::symlink_metadata(path)?) {
        return Err(io::Error::other("it was replaced while it was opened; try again"));
    }
    Ok(file)
}

/// The content of a regular file at a path whose links were resolved before. Errors: those of [`open_resolved`].
pub fn read_resolved(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_resolved(path)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Opens a file without waiting for the other end of a FIFO. A path that ends in a link is an error.
#[cfg(unix)]
fn open_at_once(path: &Path) -> io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt;

    OpenOptions::new().read(true).custom_flags(libc::O_NOFOLLOW | libc::O_NONBLOCK).open(path)
}

#[cfg(not(unix))]
fn open_at_once(path: &Path) -> io::Result<File> {
    File::open(path)
}

#[cfg(unix)]
fn is_same_file(a: &fs::Metadata, b: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;

    (a.dev(), a.ino()) == (b.dev(), b.ino())
}

/// True: the standard library gives no identity of files here.
#[cfg(not(unix))]
fn is_same_file(_: &fs::Metadata, _: &fs::Metadata) -> bool {
    true
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
