//! Git LFS leaves a short text in the place of a file until the file is fetched.

/// The start of the text.
pub const START: &[u8] = b"version https://git-lfs";

/// What is wrong with such a text in the place of an image: a clause whose subject is the file.
pub const NOT_AN_IMAGE: &str = "is a pointer of Git LFS, not the image; run: git lfs pull";

/// The same in the place of any other file.
pub const NOT_THE_FILE: &str = "is a pointer of Git LFS, not the file; run: git lfs pull";

/// Whether a file is such a text.
pub fn is_pointer(file: &[u8]) -> bool {
    file.starts_with(START)
}
