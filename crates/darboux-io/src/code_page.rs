//! Text of programs that know no UTF-8.

use std::borrow::Cow;
use std::ffi::OsStr;

/// The characters of the bytes 0x80 to 0x9F in Windows-1252. The five bytes that it leaves undefined are
/// control characters, as WHATWG's standard decodes them. All other bytes are as in Latin-1.
const WINDOWS_1252: [char; 32] = [
    '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8d}', 'Ž', '\u{8f}', //
    '\u{90}', '‘', '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9d}', 'ž', 'Ÿ',
];

/// A text in UTF-8, or else in Windows-1252.
pub fn decoded(text: &[u8]) -> Cow<'_, str> {
    let character = |&byte: &u8| match byte {
        0x80..=0x9F => WINDOWS_1252[usize::from(byte) - 0x80],
        other => char::from(other),
    };
    str::from_utf8(text).map_or_else(|_| text.iter().map(character).collect(), Cow::Borrowed)
}

/// The name of a file as text. On Unix it may be in another encoding than UTF-8, as in an archive that was
/// packed on Windows.
pub fn decoded_name(name: &OsStr) -> Cow<'_, str> {
    #[cfg(unix)]
    return decoded(std::os::unix::ffi::OsStrExt::as_bytes(name));
    #[cfg(not(unix))]
    return name.to_string_lossy();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_that_are_not_utf_8_are_windows_1252() {
        assert_eq!(decoded("Körper €".as_bytes()), "Körper €");
        assert_eq!(decoded(b"K\xf6rper \x80 \x9c\x9f\xa0\xff \x81"), "Körper € œŸ\u{a0}ÿ \u{81}");
        let all: Vec<u8> = (0x80..=0xFF).collect();
        let expected: std::collections::BTreeSet<char> = decoded(&all).chars().collect();
        assert_eq!(expected.len(), 128);
    }
}
