//! Files and data that a document refers to by URI, and the rules of what may be read.
//!
//! Only regular files inside the document's folder are touched, unless the caller allows more: no absolute path, no `..`
//! that leaves the folder, no link out of it.

use std::borrow::Cow;
use std::collections::HashMap;
use std::ffi::OsStr;
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use percent_encoding::{AsciiSet, CONTROLS, percent_decode_str, utf8_percent_encode};

use super::file_bytes::FileBytes;

/// What a URI refers to.
#[derive(Debug)]
pub enum UriTarget<'a> {
    /// A `data:` URI: what follows the colon.
    Data(&'a str),
    /// `http:` or `https:`.
    Remote,
    /// A file.
    File(LocatedFile),
}

/// A file that may be read.
#[derive(Clone, Debug)]
pub struct LocatedFile {
    /// Where it is, links resolved.
    pub path: PathBuf,
    /// Where it is relative to the document's folder, or just its name when it lies outside.
    pub relative: PathBuf,
    /// Whether it lies outside.
    pub is_outside: bool,
}

/// A file that was read.
#[derive(Debug)]
pub struct ResourceFile {
    /// Where it is.
    pub located: LocatedFile,
    /// Its content.
    pub bytes: FileBytes,
}

/// The rules, and the files read so far.
#[derive(Debug)]
pub struct Resources {
    base: Option<PathBuf>,
    allow_outside: bool,
    read: HashMap<PathBuf, Arc<ResourceFile>>,
}

impl Resources {
    /// `base` is the document's folder, if it has one.
    pub fn new(base: Option<&Path>, allow_outside: bool) -> io::Result<Self> {
        let base = base.map(Path::canonicalize).transpose()?;
        Ok(Self { base, allow_outside, read: HashMap::new() })
    }

    /// The document's folder, links resolved.
    pub fn base(&self) -> Option<&Path> {
        self.base.as_deref()
    }

    /// What `uri` refers to; for files, they exist and may be read. The error is a clause that says why not.
    pub fn resolve<'a>(&self, uri: &'a str) -> Result<UriTarget<'a>, String> {
        match scheme(uri) {
            Some(name) if name.eq_ignore_ascii_case("data") => Ok(UriTarget::Data(&uri[5..])),
            Some(name) if name.eq_ignore_ascii_case("http") || name.eq_ignore_ascii_case("https") => {
                Ok(UriTarget::Remote)
            }
            Some(name) => Err(format!("uses the scheme {name:?}; use a relative path")),
            None => self.locate(uri).map(UriTarget::File),
        }
    }

    fn locate(&self, uri: &str) -> Result<LocatedFile, String> {
        let shown = shortened(uri);
        let base = self.base.as_ref().ok_or_else(|| {
            format!("refers to the file {shown}, but input without a folder has none; give a .glb or a path")
        })?;
        let decoded = percent_decode_str(uri).decode_utf8().map_err(|_| format!("{shown} is not UTF-8"))?;
        let inside = normalised(&decoded);
        if inside.is_none() && !self.allow_outside {
            return Err(outside(&shown));
        }
        let joined = base.join(Path::new(&*decoded));
        let path = joined.canonicalize().map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => format!("the file {shown} does not exist; put it beside the document"),
            _ => format!("the file {shown} cannot be opened: {error}"),
        })?;
        if !path.starts_with(base) && !self.allow_outside {
            return Err(outside(&shown));
        }
        if !fs::metadata(&path).is_ok_and(|metadata| metadata.is_file()) {
            return Err(format!("{shown} is not a regular file"));
        }
        let name = || path.file_name().map(PathBuf::from).unwrap_or_default();
        let is_outside = inside.is_none();
        let relative = inside.unwrap_or_else(name);
        Ok(LocatedFile { path, relative, is_outside })
    }

    /// Reads a file, once however often it is asked for.
    pub fn read(&mut self, located: &LocatedFile) -> io::Result<Arc<ResourceFile>> {
        if let Some(file) = self.read.get(&located.path) {
            return Ok(Arc::clone(file));
        }
        let bytes = FileBytes::open(&located.path)?;
        let file = Arc::new(ResourceFile { located: located.clone(), bytes });
        self.read.insert(located.path.clone(), Arc::clone(&file));
        Ok(file)
    }
}

fn outside(shown: &str) -> String {
    format!("{shown} lies outside the document's folder; move it there, or allow files outside")
}

/// The scheme of a URI. One letter is not a scheme but a Windows drive.
fn scheme(uri: &str) -> Option<&str> {
    let (name, _) = uri.split_once(':')?;
    let is_scheme = name.len() > 1
        && name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || "+-.".contains(c));
    is_scheme.then_some(name)
}

/// A relative path without `.` and `..`, unless it is absolute, leaves its folder, or is one of Windows' forms.
fn normalised(path: &str) -> Option<PathBuf> {
    let drive = path.as_bytes().get(1) == Some(&b':');
    if drive || path.contains(['\\', '\0']) {
        return None;
    }
    let mut parts: Vec<&OsStr> = Vec::new();
    for component in Path::new(path).components() {
        match component {
            Component::Normal(part) => parts.push(part),
            Component::CurDir => {}
            Component::ParentDir => {
                parts.pop()?;
            }
            Component::RootDir | Component::Prefix(_) => return None,
        }
    }
    (!parts.is_empty()).then(|| parts.iter().collect())
}

/// Decodes what follows `data:`. The error is a clause that says what is wrong.
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
        .map_err(|error| format!("the data URI is not base64 ({error}); export the file again"))
}

/// A `data:` URI of a buffer's bytes.
pub fn encode_data_uri(bytes: &[u8]) -> String {
    let encoded = base64::engine::general_purpose::STANDARD.encode(bytes);
    format!("data:application/octet-stream;base64,{encoded}")
}

/// The URI of a relative path.
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
    let webp = bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP");
    let known = starts.iter().find(|(start, _)| bytes.starts_with(start));
    if webp { Some("image/webp") } else { known.map(|&(_, kind)| kind) }
}

/// A URI as it is shown in messages: quoted, and not longer than a line.
fn shortened(uri: &str) -> String {
    match uri.char_indices().nth(100) {
        Some((end, _)) => format!("{:?}...", &uri[..end]),
        None => format!("{uri:?}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_that_leave_the_folder_are_not_normalised() {
        for path in ["../a", "a/../../b", "/a", "C:\\a", "c:a", "..\\a", "\\\\host\\a", "", ".", "a\0b"] {
            assert_eq!(normalised(path), None, "{path:?}");
        }
        assert_eq!(normalised("./a//b/../c d.bin"), Some(PathBuf::from("a/c d.bin")));
    }

    #[test]
    fn schemes_are_not_drives() {
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
