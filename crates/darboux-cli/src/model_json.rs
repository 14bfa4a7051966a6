//! The JSON of a glTF or GLB, read without the rest of the file.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use darboux_io::FileKind;

/// The most bytes of JSON that are read.
const MOST_BYTES: u64 = 4 << 20;

/// What was read of a model file.
#[derive(Debug, PartialEq, Eq)]
pub enum ModelJson {
    /// The JSON, which need not be valid.
    Text(Vec<u8>),
    /// The JSON has more than 4 MiB, or cannot be read.
    Unread,
    /// The file is neither a GLB by its content nor a `.gltf` by its name.
    Absent,
}

impl ModelJson {
    /// Reads the JSON of an open file; `path` is its path.
    pub fn of(file: &mut File, path: &Path) -> Self {
        match Self::place(file, path) {
            Some((start, length)) => Self::read(file, start, length).map_or(Self::Unread, Self::Text),
            None => Self::Absent,
        }
    }

    /// The offset of the JSON in the file, and its length (glTF 2.0, 4.4).
    fn place(file: &mut File, path: &Path) -> Option<(u64, u64)> {
        let mut head = Vec::new();
        file.rewind().ok()?;
        file.by_ref().take(20).read_to_end(&mut head).ok()?;
        match *head {
            [b'g', b'l', b'T', b'F', _, _, _, _, _, _, _, _, a, b, c, d, ..] => {
                Some((20, u32::from_le_bytes([a, b, c, d]).into()))
            }
            _ if FileKind::of(path) == Some(FileKind::Gltf) => Some((0, file.metadata().ok()?.len())),
            _ => None,
        }
    }

    fn read(file: &mut File, start: u64, length: u64) -> Option<Vec<u8>> {
        if length > MOST_BYTES {
            return None;
        }
        let mut text = Vec::new();
        file.seek(SeekFrom::Start(start)).ok()?;
        file.take(length).read_to_end(&mut text).ok()?;
        Some(text)
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn json_of(name: &str, content: &[u8]) -> ModelJson {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join(name);
        fs::write(&path, content).expect("a file");
        ModelJson::of(&mut File::open(&path).expect("a file"), &path)
    }

    #[test]
    fn glbs_are_known_by_their_content_and_gltf_by_its_name() {
        let glb = [&b"glTF\x02\0\0\0\x1C\0\0\0\x04\0\0\0JSON"[..], b"{  }", b"BIN\0"].concat();
        assert_eq!(json_of("m.obj", &glb), ModelJson::Text(b"{  }".to_vec()));
        assert_eq!(json_of("m.GLTF", b"{}"), ModelJson::Text(b"{}".to_vec()));
        for (name, content) in [("m.glb", &glb[..10]), ("m.vrm", b"{}"), ("m.obj", b"v 0 0 0"), ("m", b"")] {
            assert_eq!(json_of(name, content), ModelJson::Absent, "{name}");
        }
    }

    #[test]
    fn no_more_than_four_mebibytes_are_read() {
        for (length, is_read) in [(4 << 20, true), ((4 << 20) + 1, false)] {
            let json = vec![b' '; length];
            let head = [&b"glTF\x02\0\0\0\0\0\0\0"[..], &(length as u32).to_le_bytes(), b"JSON"].concat();
            for (name, content) in [("m.glb", [head, json.clone()].concat()), ("m.gltf", json.clone())] {
                let expected = if is_read { ModelJson::Text(json.clone()) } else { ModelJson::Unread };
                assert!(json_of(name, &content) == expected, "{name} of {length} bytes");
            }
        }
    }
}
