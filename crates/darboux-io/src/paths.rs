//! File kinds by extension, and checks of paths before they are read or written.
//!
//! Only regular files are read and written, links resolved: a pipe would block until its other end opens, and
//! a device may never end.

#[cfg(unix)]
use std::fs::OpenOptions;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use crate::Error;
use crate::source::SourceFormat;

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
    /// `.usd`, `.usda`, `.usdc`, `.usdz`.
    Usd,
    /// `.png`.
    Png,
    /// `.jpg`, `.jpeg`.
    Jpeg,
    /// `.webp`.
    WebP,
    /// `.tga`.
    Tga,
    /// An image format without a decoder here.
    OtherImage,
}

/// The endings of each kind: the one list of formats, from which messages, help and folder searches come.
const ENDINGS: [(FileKind, &[&str]); 12] = [
    (FileKind::Gltf, &["gltf"]),
    (FileKind::Glb, &["glb", "vrm"]),
    (FileKind::Obj, &["obj"]),
    (FileKind::Ply, &["ply"]),
    (FileKind::Stl, &["stl"]),
    (FileKind::Fbx, &["fbx"]),
    (FileKind::Usd, &["usd", "usda", "usdc", "usdz"]),
    (FileKind::Png, &["png"]),
    (FileKind::Jpeg, &["jpeg", "jpg"]),
    (FileKind::WebP, &["webp"]),
    (FileKind::Tga, &["tga"]),
    (FileKind::OtherImage, &["avif", "bmp", "dds", "exr", "ktx2", "psd", "tif", "tiff"]),
];

/// The endings of the kinds that `is_listed` accepts.
fn endings(is_listed: impl Fn(FileKind) -> bool) -> String {
    let listed = ENDINGS.iter().filter(|(kind, _)| is_listed(*kind)).flat_map(|(_, endings)| *endings);
    listed.map(|ending| format!(".{ending}")).collect::<Vec<_>>().join(", ")
}

impl FileKind {
    /// The kind of a path; none for other extensions and for none.
    pub fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_ascii_lowercase();
        let extension = extension.to_str()?;
        ENDINGS.iter().find(|(_, endings)| endings.contains(&extension)).map(|&(kind, _)| kind)
    }

    /// The endings of files that hold models which this build reads, such as `.gltf, .glb, .vrm, .obj`.
    pub fn model_endings() -> String {
        endings(Self::is_model)
    }

    /// The endings of files that documents can be written as.
    pub fn written_endings() -> String {
        endings(Self::is_written_model)
    }

    /// The name of a format of models that this crate knows, whether this build reads it or not.
    pub fn format_name(self) -> Option<&'static str> {
        Some(match self {
            Self::Glb | Self::Gltf => "glTF",
            Self::Obj => SourceFormat::Obj.name(),
            Self::Ply => SourceFormat::Ply.name(),
            Self::Stl => SourceFormat::Stl.name(),
            Self::Fbx => SourceFormat::Fbx.name(),
            Self::Usd => SourceFormat::Usd.name(),
            Self::Png | Self::Jpeg | Self::WebP | Self::Tga | Self::OtherImage => return None,
        })
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
        matches!(self, Self::Png | Self::Jpeg | Self::WebP | Self::Tga)
    }
}

/// What is wrong with an output of a kind that documents are not written as: a clause whose subject is the
/// file.
pub fn wrong_output(kind: Option<FileKind>) -> String {
    let endings = FileKind::written_endings();
    match kind.and_then(|kind| Some((kind, kind.format_name()?))) {
        Some((FileKind::Usd, _)) => format!(
            "is named as USD, which is not written here; end its name in one of {endings}, or use \
             darboux.usd in Python"
        ),
        Some((_, format)) => {
            format!("is named as {format}, which is not written; end its name in one of {endings}")
        }
        None => format!("has no ending of a model; end its name in one of {endings}"),
    }
}

/// The folder that a file is in, by its path.
pub fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
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
/// Another process may have replaced the file since. So the opened file is checked, not the path: errors are
/// a link in the path, and anything but a regular file, which is not waited for.
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

/// The content of a regular file, links followed. A FIFO, a device or a socket is not waited for.
///
/// Errors: there is no file, it is not a regular file, or it cannot be read.
pub fn read_regular(path: &Path) -> Result<Vec<u8>, Error> {
    let resolved = resolve_input(path)?;
    read_resolved(&resolved).map_err(|source| Error::Read { file: path.to_owned(), source })
}

/// The content of a regular file at a path whose links were resolved before. Errors: as [`open_resolved`].
pub fn read_resolved(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_resolved(path)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Opens a file without waiting for the other end of a FIFO. A path that ends in a link is an error.
#[cfg(unix)]
pub fn open_at_once(path: &Path) -> io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt;

    OpenOptions::new().read(true).custom_flags(libc::O_NOFOLLOW | libc::O_NONBLOCK).open(path)
}

#[cfg(not(unix))]
pub fn open_at_once(path: &Path) -> io::Result<File> {
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

/// The regular file to write at `path`, links resolved. `why_not` gives the reason when an existing file must
/// not be replaced.
///
/// Errors: a broken link; an existing file that is not regular, is read-only, or must not be replaced; an
/// existing file without `force`.
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

/// Refuses to replace a read-only file. Its folder would permit that, but version control marks files so to
/// prevent changes.
pub fn refuse_read_only(path: &Path, metadata: &fs::Metadata) -> Result<(), Error> {
    if metadata.permissions().readonly() {
        let problem = "is read-only; make it writable, or name another output".to_owned();
        return Err(Error::Output { file: path.to_owned(), problem });
    }
    Ok(())
}
