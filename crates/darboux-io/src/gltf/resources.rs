//! Resolves the URIs of a document: to files that may be read, to embedded data, or to other machines.
//!
//! Only regular files inside the document's folder are opened, unless the caller allows more: no absolute
//! path, no `..` that leaves the folder, no link out of it.

use std::borrow::Cow;
use std::collections::HashMap;
use std::fs;
use std::io::{self, Cursor, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use percent_encoding::{AsciiSet, CONTROLS, percent_decode_str, utf8_percent_encode};

use super::file_bytes::{FileAccess, FileBytes};
use crate::error::quoted;
use crate::{LoadOptions, files, paths, system_reason};

/// The target of a URI.
#[derive(Debug)]
pub enum UriTarget<'a> {
    /// A `data:` URI: the text after the colon.
    Data(&'a str),
    /// An `http:` or `https:` URI.
    Remote,
    /// A file.
    File(LocatedFile),
}

/// A file that exists and may be read.
#[derive(Clone, Debug)]
pub struct LocatedFile {
    /// The path, links resolved.
    pub path: PathBuf,
    /// The path relative to the document's folder, or the file's name if it lies outside.
    pub relative: PathBuf,
    /// Whether the file lies outside the document's folder.
    pub is_outside: bool,
}

/// A file that was opened.
#[derive(Debug)]
pub struct ResourceFile {
    pub located: LocatedFile,
    pub bytes: FileBytes,
}

/// What may be read, and the files opened so far.
#[derive(Debug)]
pub struct Resources {
    base: Option<PathBuf>,
    options: LoadOptions,
    access: FileAccess,
    opened: HashMap<PathBuf, Arc<ResourceFile>>,
}

impl Resources {
    /// `base` is the document's folder, if it has one.
    pub fn new(base: Option<&Path>, options: LoadOptions, access: FileAccess) -> io::Result<Self> {
        let base = base.map(|folder| access.resolved(folder)).transpose()?;
        Ok(Self { base, options, access, opened: HashMap::new() })
    }

    /// The document's folder, links resolved.
    pub fn base(&self) -> Option<&Path> {
        self.base.as_deref()
    }

    /// The target of `uri`. A file exists and may be read. The error is a clause that says what is wrong and
    /// what to do.
    pub fn resolve<'a>(&self, uri: &'a str) -> Result<UriTarget<'a>, String> {
        match scheme(uri) {
            Some(name) if name.eq_ignore_ascii_case("data") => Ok(UriTarget::Data(&uri[5..])),
            Some(name) if name.eq_ignore_ascii_case("http") || name.eq_ignore_ascii_case("https") => {
                Ok(UriTarget::Remote)
            }
            Some(name) => Err(format!("uses the scheme {}; use a relative path", shortened(name))),
            None => self.locate(uri).map(UriTarget::File),
        }
    }

    fn locate(&self, uri: &str) -> Result<LocatedFile, String> {
        let shown = shortened(uri);
        let base = self.base.as_ref().ok_or_else(|| {
            format!("refers to the file {shown}, but input without a folder has none; give a .glb or a path")
        })?;
        let decoded = decoded_path(uri).ok_or_else(|| format!("{shown} is not UTF-8; rename the file"))?;
        let inside = normalised(&decoded);
        if inside.is_none() && !self.options.allow_outside {
            return Err(self.outside(&shown));
        }
        let joined = base.join(Path::new(&*decoded));
        let path = self.access.resolved(&joined).map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => format!("the file {shown} does not exist; put it beside the document"),
            _ => format!("the file {shown} cannot be opened: {}", system_reason(&error)),
        })?;
        if !path.starts_with(base) && !self.options.allow_outside {
            return Err(self.outside(&shown));
        }
        if !self.access.is_file(&path) {
            return Err(match &self.access {
                FileAccess::Disk { .. } => format!("{shown} is not a regular file; put a file there"),
                FileAccess::Given(_) => {
                    format!("the file {shown} is not among the files; give the whole folder")
                }
            });
        }
        let name = || path.file_name().map(PathBuf::from).unwrap_or_default();
        let is_outside = inside.is_none();
        let relative = inside.unwrap_or_else(name);
        Ok(LocatedFile { path, relative, is_outside })
    }

    /// The problem of a file outside the folder.
    fn outside(&self, shown: &str) -> String {
        let option = self.options.option_names.allow_outside;
        format!(
            "{shown} lies outside the document's folder; move it there, or allow files outside ({option})"
        )
    }

    /// Opens a file once, however often it is asked for.
    pub fn open(&mut self, located: &LocatedFile) -> io::Result<Arc<ResourceFile>> {
        if let Some(file) = self.opened.get(&located.path) {
            return Ok(Arc::clone(file));
        }
        let bytes = self.bytes(&located.path)?;
        let file = Arc::new(ResourceFile { located: located.clone(), bytes });
        self.opened.insert(located.path.clone(), Arc::clone(&file));
        Ok(file)
    }

    /// Whether files are read from the disk.
    pub fn are_on_disk(&self) -> bool {
        matches!(self.access, FileAccess::Disk { .. })
    }

    /// Whether there is such a file.
    pub fn has(&self, path: &Path) -> bool {
        match &self.access {
            FileAccess::Disk { .. } => path.is_file(),
            FileAccess::Given(given) => given.has(&files::name(path)),
        }
    }

    /// The content of a file, which is not kept, in parts.
    pub fn reader(&self, path: &Path) -> io::Result<Box<dyn Read>> {
        match &self.access {
            FileAccess::Disk { .. } => Ok(Box::new(paths::open_resolved(path)?)),
            FileAccess::Given(_) => Ok(Box::new(Cursor::new(self.bytes(path)?.into_vec()))),
        }
    }

    /// Whether a file on the disk has the content of one of these files.
    pub fn is_same(&self, existing: &Path, path: &Path) -> io::Result<bool> {
        match &self.access {
            FileAccess::Disk { .. } => Ok(existing.canonicalize()? == path || same_files(existing, path)?),
            FileAccess::Given(_) => {
                Ok(*paths::read_resolved(&existing.canonicalize()?)? == *self.bytes(path)?)
            }
        }
    }

    /// The content of a file, which is not kept.
    pub fn bytes(&self, path: &Path) -> io::Result<FileBytes> {
        self.access.open(path, self.options.memory_limit.process())
    }
}

/// The file that a URI of the glTF at `document` names, links resolved; none where it is not a regular file
/// that [`Document::open`](super::Document::open) reads with these options.
pub fn file_of_uri(document: &Path, uri: &str, options: &LoadOptions) -> Option<PathBuf> {
    let resources = Resources::new(Some(paths::folder_of(document)), *options, FileAccess::default()).ok()?;
    match resources.resolve(uri).ok()? {
        UriTarget::File(located) => Some(located.path),
        UriTarget::Data(_) | UriTarget::Remote => None,
    }
}

fn same_files(a: &Path, b: &Path) -> io::Result<bool> {
    if fs::metadata(a)?.len() != fs::metadata(b)?.len() {
        return Ok(false);
    }
    let open =
        |path: &Path| Ok::<_, io::Error>(io::BufReader::new(paths::open_resolved(&path.canonicalize()?)?));
    let (mut a, mut b) = (open(a)?, open(b)?);
    let (mut left, mut right) = (vec![0; 1 << 16], vec![0; 1 << 16]);
    loop {
        let length = a.read(&mut left)?;
        if length == 0 {
            return Ok(true);
        }
        if b.read_exact(&mut right[..length]).is_err() || left[..length] != right[..length] {
            return Ok(false);
        }
    }
}

/// The path that a relative URI spells; none if it is not UTF-8.
fn decoded_path(uri: &str) -> Option<Cow<'_, str>> {
    percent_decode_str(uri).decode_utf8().ok()
}

/// The scheme of a URI. A single letter is a drive of Windows, not a scheme.
fn scheme(uri: &str) -> Option<&str> {
    let (name, _) = uri.split_once(':')?;
    let is_scheme = name.len() > 1
        && name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || "+-.".contains(c));
    is_scheme.then_some(name)
}

/// A relative path without `.` and `..`; none if it is absolute, leaves its folder, or has a form of Windows
/// (`c:a`, `a\b`).
fn normalised(path: &str) -> Option<PathBuf> {
    let drive = path.as_bytes().get(1) == Some(&b':');
    if drive || path.contains(['\\', '\0']) {
        return None;
    }
    files::normalised(Path::new(path)).filter(|path| !path.as_os_str().is_empty())
}

/// Decodes the text after `data:`. The error is a clause that says what is wrong and what to do.
pub fn decode_data_uri(data: &str) -> Result<Vec<u8>, String> {
    let (kind, content) = data.split_once(',').ok_or("the data URI has no comma; export the file again")?;
    let content: Cow<[u8]> = percent_decode_str(content).into();
    if !kind.ends_with(";base64") {
        return Ok(content.into_owned());
    }
    let config = GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true);
    GeneralPurpose::new(&STANDARD, config)
        .decode(content)
        .map_err(|_| "the data URI is not base64; export the file again".to_owned())
}

/// The `data:` URI of bytes of a media type.
pub fn encode_data_uri(media_type: &str, bytes: &[u8]) -> String {
    let encoded = base64::engine::general_purpose::STANDARD.encode(bytes);
    format!("data:{media_type};base64,{encoded}")
}

/// The URI of a relative path that [`portable`](super::portable_names::portable) gave.
pub fn encode_path(path: &Path) -> String {
    const RESERVED: &AsciiSet =
        &CONTROLS.add(b' ').add(b'"').add(b'#').add(b'%').add(b'<').add(b'>').add(b'?').add(b':').add(b'\\');
    let parts: Vec<_> = path.iter().map(|part| part.to_string_lossy()).collect();
    utf8_percent_encode(&parts.join("/"), RESERVED).to_string()
}

/// The media type of an image, by its first bytes.
pub fn image_type(bytes: &[u8]) -> Option<&'static str> {
    let starts: [(&[u8], &str); 4] = [
        (b"\x89PNG", "image/png"),
        (b"\xFF\xD8\xFF", "image/jpeg"),
        (b"\xABKTX 20", "image/ktx2"),
        (b"DDS ", "image/vnd-ms.dds"),
    ];
    if bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP") {
        return Some("image/webp");
    }
    if bytes.get(4..12) == Some(b"ftypavif") {
        return Some("image/avif");
    }
    starts.iter().find(|(start, _)| bytes.starts_with(start)).map(|&(_, kind)| kind)
}

/// A URI in messages: quoted, and at most 100 characters.
fn shortened(uri: &str) -> String {
    match uri.char_indices().nth(100) {
        Some((end, _)) => format!("{}...", quoted(&uri[..end])),
        None => quoted(uri),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gltf::portable_names::portable;

    #[test]
    fn paths_that_leave_the_folder_are_not_normalised() {
        for path in ["../a", "a/../../b", "/a", "C:\\a", "c:a", "..\\a", "\\\\host\\a", "", ".", "a\0b"] {
            assert_eq!(normalised(path), None, "{path:?}");
        }
        assert_eq!(normalised("./a//b/../c d.bin"), Some(PathBuf::from("a/c d.bin")));
    }

    #[test]
    fn portable_names_are_readable_from_their_uri() {
        for name in [
            "a:b.bin",
            "a\\b.bin",
            "ab:c",
            "C:",
            "https:x",
            "data:a",
            "a b%20#?.bin",
            "tab\there",
            "m\u{fffd}",
            "ä",
            "%5C",
        ] {
            let portable = portable(Path::new(name));
            let uri = encode_path(&portable);
            assert_eq!(scheme(&uri), None, "{name:?}");
            assert_eq!(decoded_path(&uri).and_then(|path| normalised(&path)), Some(portable), "{name:?}");
        }
    }

    #[test]
    fn files_of_uris_are_those_that_are_read() {
        let outside = tempfile::tempdir().unwrap();
        let folder = outside.path().canonicalize().unwrap().join("models");
        fs::create_dir(&folder).unwrap();
        fs::write(folder.join("a b.bin"), "").unwrap();
        fs::write(folder.join("../c.bin"), "").unwrap();
        let document = folder.join("m.gltf");
        let file = |uri, allows: bool| {
            file_of_uri(&document, uri, &LoadOptions::default().with_allow_outside(allows))
        };
        assert_eq!(file("a%20b.bin", false), Some(folder.join("a b.bin")));
        for uri in ["none.bin", ".", "data:,a", "https://a/b.bin", "file:a%20b.bin"] {
            assert_eq!([file(uri, false), file(uri, true)], [None, None], "{uri}");
        }
        assert_eq!(file("../c.bin", false), None);
        assert_eq!(
            file("../c.bin", true),
            outside.path().canonicalize().ok().map(|folder| folder.join("c.bin"))
        );
    }

    #[test]
    fn drives_are_not_schemes() {
        assert_eq!(scheme("https://a/b"), Some("https"));
        assert_eq!(scheme("data:,x"), Some("data"));
        assert_eq!(scheme("C:/a"), None);
        assert_eq!(scheme("a/b:c"), None);
    }

    #[test]
    fn data_uris_decode() {
        assert_eq!(decode_data_uri("application/octet-stream;base64,AAEC").unwrap(), [0, 1, 2]);
        assert_eq!(decode_data_uri(";base64,AAE").unwrap(), [0, 1]);
        assert_eq!(decode_data_uri(",a%20b").unwrap(), b"a b");
        assert!(decode_data_uri(";base64,A!").is_err());
        assert!(decode_data_uri("base64").is_err());
    }
}
