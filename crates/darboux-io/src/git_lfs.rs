//! Git LFS leaves a short text in the place of a file until the file is fetched.

/// The start of the text.
pub const START: &[u8] = b"version https://git-lfs";

/// What is wrong with such a text in the place of an image: a clause whose subject is the file.
pub const NOT_AN_IMAGE: &str = "is a pointer of Git LFS, not the image; run: git lfs pull";
