//! Git LFS leaves a short text in the place of a file until the file is fetched.

/// The start of the text.
pub const START: &[u8] = b"version https://git-lfs";
