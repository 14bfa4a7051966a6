//! What the decoders of textures share: limits, errors, and texels.

use crate::MemoryLimit;

/// The largest image that is decoded. By default the sides may have 16,384 texels and the image 2^27, which
/// take 512 MiB.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct DecodeLimits {
    /// The largest width and height.
    pub max_side: u32,
    /// The most texels.
    pub max_texels: u64,
}

/// Bytes per texel while an image is decoded: four channels of 16 bits.
const BYTES_PER_TEXEL: u64 = 8;

impl DecodeLimits {
    /// The limits for a file of `size` bytes: the default, and at most the texels that fit a memory limit
    /// while they are decoded.
    pub fn of_file(size: usize, limit: MemoryLimit) -> Self {
        let limits = Self::default();
        let texels = limit.budget(size, 0, "").bytes as u64 / BYTES_PER_TEXEL;
        limits.with_max_texels(limits.max_texels.min(texels))
    }

    /// These limits with another width and height.
    #[must_use]
    pub const fn with_max_side(self, max_side: u32) -> Self {
        Self { max_side, ..self }
    }

    /// These limits with another number of texels.
    #[must_use]
    pub const fn with_max_texels(self, max_texels: u64) -> Self {
        Self { max_texels, ..self }
    }
}

impl Default for DecodeLimits {
    fn default() -> Self {
        Self { max_side: 1 << 14, max_texels: 1 << 27 }
    }
}

/// Why an image was not decoded: a clause whose subject is the image.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DecodeError {
    /// The format is recognised, but there is no decoder for it.
    #[error("is {0}, for which there is no decoder here; convert it to PNG, JPEG or WebP")]
    NoDecoder(&'static str),
    /// The format is not recognised.
    #[error("is neither PNG nor JPEG nor WebP nor TGA; convert it to one of them")]
    UnknownFormat,
    /// The file is the text that Git LFS leaves in the place of the image.
    #[error("{}", crate::git_lfs::NOT_AN_IMAGE)]
    GitLfsPointer,
    /// The image exceeds [`DecodeLimits`].
    #[error("has {width} x {height} texels, more than the limit; make it smaller, or raise the memory limit")]
    TooLarge {
        /// Texels per row.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// The content is damaged or of a kind that the decoder lacks.
    #[error("cannot be decoded ({0}); save it again")]
    Broken(String),
}

pub(super) fn broken(problem: &str) -> DecodeError {
    DecodeError::Broken(problem.to_owned())
}

/// Checks a size from a header; gives the number of texels.
pub(super) fn texel_count(width: usize, height: usize, limits: &DecodeLimits) -> Result<usize, DecodeError> {
    let side = limits.max_side as usize;
    match width.checked_mul(height) {
        _ if width == 0 || height == 0 => Err(broken("it has no texels")),
        Some(texels) if width <= side && height <= side && texels as u64 <= limits.max_texels => Ok(texels),
        _ => Err(DecodeError::TooLarge { width, height }),
    }
}

/// Checks the bytes that decoding takes, where a decoder needs more than eight per texel. Errors: they are
/// more than the limit permits.
pub(super) fn check_memory(
    [width, height]: [usize; 2],
    bytes: u64,
    limits: &DecodeLimits,
) -> Result<(), DecodeError> {
    if bytes > limits.max_texels.saturating_mul(BYTES_PER_TEXEL) {
        return Err(DecodeError::TooLarge { width, height });
    }
    Ok(())
}

pub(super) fn rgba<S: Copy, C, const N: usize>(
    channels: &[S],
    texel: impl Fn([S; N]) -> [C; 4],
) -> Vec<[C; 4]> {
    channels.as_chunks().0.iter().map(|&channels| texel(channels)).collect()
}

/// The nearest 8-bit value: `word` / 257, rounded.
pub(super) fn to_byte(word: u16) -> u8 {
    ((u32::from(word) + 128) / 257) as u8
}
