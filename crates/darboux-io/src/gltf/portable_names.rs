//! Names of files that are written beside an output. They come from names in the document, which may hold
//! anything.
//!
//! Whatever a document says, such a file lies in the output's folder or below, its URI can be read again, and
//! Windows, macOS and Linux can have it.

use std::collections::HashMap;
use std::ffi::OsStr;
use std::path::{Component, Path, PathBuf};

/// The most bytes of a part of a path. File systems permit 255, and a number may follow.
const LONGEST_PART: usize = 240;

/// Names that Windows takes for devices, also with an extension; the digits of `COM1` and `LPT1` are left
/// out.
const DEVICES: [&str; 8] = ["CON", "PRN", "AUX", "NUL", "COM", "LPT", "CONIN$", "CONOUT$"];

/// A relative path for a new file: `path` without a root, `.` and `..`, and with `_` in place of whatever a
/// URI cannot spell or a reader refuses.
///
/// These are bytes that are not UTF-8, control characters, the characters `:` and `\`, and dots and spaces at
/// the end of a part. Devices of Windows get a `_` behind their name, and long parts are cut before their
/// extension.
pub fn portable(path: &Path) -> PathBuf {
    let parts = path.components().filter_map(|component| match component {
        Component::Normal(part) => Some(portable_part(part)),
        _ => None,
    });
    let path: PathBuf = parts.collect();
    if path.as_os_str().is_empty() { PathBuf::from("_") } else { path }
}

fn portable_part(part: &OsStr) -> String {
    let text = part.to_string_lossy();
    let is_portable = |c: char| !c.is_control() && !matches!(c, ':' | '\\' | char::REPLACEMENT_CHARACTER);
    let mut text: String = text.chars().map(|c| if is_portable(c) { c } else { '_' }).collect();
    let kept = text.trim_end_matches(['.', ' ']).len();
    text.replace_range(kept.., &"_".repeat(text.len() - kept));
    let stem = text.split('.').next().unwrap_or_default();
    if is_device(stem.trim_end()) {
        text.insert(stem.len(), '_');
    }
    if text.len() > LONGEST_PART {
        let (stem, extension) = match text.rsplit_once('.') {
            Some((stem, extension)) if extension.len() < 16 => (stem, format!(".{extension}")),
            _ => (text.as_str(), String::new()),
        };
        text = stem[..stem.floor_char_boundary(LONGEST_PART - extension.len())].to_owned() + &extension;
    }
    text
}

fn is_device(stem: &str) -> bool {
    let numbered =
        |stem: &str| stem.trim_end_matches(|c: char| c.is_ascii_digit() || "¹²³".contains(c)).len();
    let name = if stem.chars().count() == 4 { &stem[..numbered(stem)] } else { stem };
    let has_number = name.len() < stem.len();
    DEVICES
        .iter()
        .any(|device| device.eq_ignore_ascii_case(name) && has_number == matches!(*device, "COM" | "LPT"))
}

/// The file name of an image, from its name: the part after the last `/` or `\`; none if nothing is left of
/// it.
pub fn image_stem(name: &str) -> Option<&str> {
    let name = name.rsplit(['/', '\\']).next().unwrap_or_default().trim();
    (!name.trim_matches('.').is_empty()).then_some(name)
}

/// Numbers that make names unique. The smallest numbers that are taken are remembered, so that many equal
/// names take no more time each than the first.
#[derive(Debug, Default)]
pub struct Numbers {
    first_free: HashMap<PathBuf, u32>,
}

impl Numbers {
    /// The smallest number of a name that may be free; 0 stands for the name itself.
    pub fn first(&self, name: &Path) -> u32 {
        self.first_free.get(name).copied().unwrap_or_default()
    }

    /// Notes that a number of a name is taken for good.
    pub fn take(&mut self, name: &Path, number: u32) {
        if self.first(name) == number {
            self.first_free.insert(name.to_owned(), number + 1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_leaves_the_folder() {
        for (name, expected) in [
            ("..", "_"),
            (".", "_"),
            ("", "_"),
            ("/", "_"),
            ("../x", "x"),
            ("../../a/../b", "a/b"),
            ("/etc/passwd", "etc/passwd"),
            ("C:x", "C_x"),
            ("C:\\x", "C__x"),
            ("\\\\host\\share", "__host_share"),
            ("a\0b", "a_b"),
            ("...", "___"),
            ("a. .", "a___"),
            ("maps/my color.png", "maps/my color.png"),
        ] {
            assert_eq!(portable(Path::new(name)), Path::new(expected), "{name:?}");
        }
    }

    #[test]
    fn devices_of_windows_are_no_names() {
        for (name, expected) in [
            ("con", "con_"),
            ("NUL.png", "NUL_.png"),
            ("aux .tar.gz", "aux _.tar.gz"),
            ("maps/Com1.png", "maps/Com1_.png"),
            ("lpt².txt", "lpt²_.txt"),
            ("conin$", "conin$_"),
            ("COM", "COM"),
            ("com12.png", "com12.png"),
            ("con1", "con1"),
            ("console.png", "console.png"),
        ] {
            assert_eq!(portable(Path::new(name)), Path::new(expected), "{name:?}");
        }
    }

    #[test]
    fn long_parts_are_cut_before_their_extension() {
        let long = "ä".repeat(300) + ".png";
        let short = portable(Path::new(&long));
        assert_eq!(short.to_str(), Some(format!("{}.png", "ä".repeat(118)).as_str()));
        assert_eq!(portable(Path::new(&"a".repeat(1 << 20))).as_os_str().len(), LONGEST_PART);
        let fits = "b".repeat(LONGEST_PART);
        assert_eq!(portable(Path::new(&fits)), Path::new(&fits));
    }

    #[test]
    fn images_without_a_name_of_a_file_have_none() {
        for name in ["", "..", "a/..", "a\\", " . ", "..."] {
            assert_eq!(image_stem(name), None, "{name:?}");
        }
        assert_eq!(image_stem("C:\\maps\\ oak.png "), Some("oak.png"));
    }
}
