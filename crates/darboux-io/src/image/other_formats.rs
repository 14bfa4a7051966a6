//! The names of image formats without a decoder here.

/// The first bytes of files, and the format.
const STARTS: [(&[u8], &str); 16] = [
    (b"BM", "BMP"),
    (b"II*\0", "TIFF"),
    (b"MM\0*", "TIFF"),
    (b"II+\0", "TIFF"),
    (b"MM\0+", "TIFF"),
    (b"8BPS", "PSD"),
    (b"DDS ", "DDS"),
    (b"GIF8", "GIF"),
    (b"\xABKTX 11\xBB", "KTX 1"),
    (b"\x76\x2F\x31\x01", "OpenEXR"),
    (b"#?RADIANCE", "Radiance HDR"),
    (b"#?RGBE", "Radiance HDR"),
    (b"\0\0\0\x0CJXL ", "JPEG XL"),
    (b"\xFF\x0A", "JPEG XL"),
    (b"\0\0\0\x0CjP  ", "JPEG 2000"),
    (b"\x01\xDA", "SGI RGB"),
];

/// The name of the format of a file, by its first bytes.
pub fn name(file: &[u8]) -> Option<&'static str> {
    STARTS.iter().find(|(start, _)| file.starts_with(start)).map(|&(_, name)| name)
}
