//! Decodes the first image of KTX 2 files: Basis Universal (ETC1S and UASTC, as KHR_texture_basisu has them),
//! and uncompressed texels.

use ktx2::{Format, Header, Level, Reader, SupercompressionScheme};
use ruzstd::StreamingDecoder;
use ruzstd::io::Read;

use super::decoding::{DecodeError, DecodeLimits, broken, rgba, texel_count, to_byte};

/// Decodes the largest level of the first layer to its width, its height and its texels.
pub fn decode(file: &[u8], limits: &DecodeLimits) -> Result<(u32, u32, Vec<[u8; 4]>), DecodeError> {
    if !has_sound_descriptor(file) {
        return Err(broken("its header is damaged"));
    }
    let reader = Reader::new(file).map_err(|_| broken("its header is damaged"))?;
    let header = reader.header();
    let (width, height) = (header.pixel_width, header.pixel_height.max(1));
    texel_count(width as usize, height as usize, limits)?;
    if header.layer_count > 1 || header.face_count != 1 || header.pixel_depth > 1 {
        return Err(broken("it is no single picture, but an array, a cube or a volume"));
    }
    // Four by four texels take at most 16 bytes. Without this test, damaged lengths ask for any amount of
    // memory.
    let blocks = u64::from(width.div_ceil(4)) * u64::from(height.div_ceil(4));
    let is_too_long = |level: Level<'_>| level.uncompressed_byte_length > 16 * blocks;
    if header.format.is_none() && reader.levels().any(is_too_long) {
        return Err(broken("its levels are longer than its size permits"));
    }
    let texels = match header.format {
        None => decode_basis(file)?,
        Some(format) => decode_plain(&reader, &header, format)?,
    };
    let count = width as usize * height as usize;
    if texels.len() != count {
        return Err(broken(&format!("it has {} texels instead of {count}", texels.len())));
    }
    Ok((width, height, texels))
}

/// Whether the data format descriptor has whole blocks with sizes of texel blocks below 256. The crate `ktx2`
/// 0.5 panics at others.
fn has_sound_descriptor(file: &[u8]) -> bool {
    let word = |at: usize| Some(u32::from_le_bytes(*file.get(at..)?.first_chunk()?) as usize);
    let (Some(start), Some(length)) = (word(48), word(52)) else { return false };
    let Some(mut blocks) = file.get(start..).and_then(|file| file.get(4..length)) else { return false };
    while let Some(header) = blocks.first_chunk::<8>() {
        let size = usize::from(u16::from_le_bytes([header[6], header[7]]));
        let Some(block) = blocks.get(8..size) else { return false };
        let is_basic = header[..6] == [0, 0, 0, 0, 2, 0];
        if is_basic && (block.len() < 16 || block[4..8].contains(&255)) {
            return false;
        }
        blocks = &blocks[size..];
    }
    blocks.is_empty()
}

fn decode_basis(file: &[u8]) -> Result<Vec<[u8; 4]>, DecodeError> {
    use basisu::{DecodeFlags, TargetFormat, Transcoder};
    let fail = |error: basisu::Error| match error {
        basisu::Error::Truncated => broken("it was cut off"),
        basisu::Error::VideoRequiresState => broken("it is a video"),
        basisu::Error::InvalidData => broken("its Basis Universal data is damaged"),
        _ => broken("its Basis Universal data cannot be decoded"),
    };
    let transcoder = Transcoder::new(file).map_err(fail)?;
    let bytes = transcoder.transcode(0, TargetFormat::Rgba32, DecodeFlags::NONE).map_err(fail)?;
    Ok(rgba(&bytes, |texel| texel))
}

/// Texels that are stored as they are, or compressed by Zstandard.
fn decode_plain(
    reader: &Reader<&[u8]>,
    header: &Header,
    format: Format,
) -> Result<Vec<[u8; 4]>, DecodeError> {
    let channels = channels_of(format).ok_or(DecodeError::NoDecoder("KTX 2 in a block format of a GPU"))?;
    let length = header.pixel_width as usize * header.pixel_height.max(1) as usize * channels.bytes();
    let level = reader.levels().next().ok_or_else(|| broken("it has no level"))?;
    let bytes = match header.supercompression_scheme {
        None => level.data.get(..length).map(<[u8]>::to_vec),
        Some(SupercompressionScheme::Zstandard) => inflate(level.data, length),
        Some(_) => return Err(DecodeError::NoDecoder("KTX 2 with an unusual compression")),
    };
    Ok(channels.texels(&bytes.ok_or_else(|| broken("it was cut off or is damaged"))?))
}

/// The first `length` bytes of a Zstandard frame.
fn inflate(frame: &[u8], length: usize) -> Option<Vec<u8>> {
    let mut decoder = StreamingDecoder::new(frame).ok()?;
    let mut bytes = vec![0; length];
    decoder.read_exact(&mut bytes).ok()?;
    Some(bytes)
}

/// The channels of a texel, in the order of the file.
enum Channels {
    Rg,
    Rgb,
    Bgr,
    Rgba,
    Bgra,
    /// Four channels of 16 bits, little-endian.
    Words,
}

fn channels_of(format: Format) -> Option<Channels> {
    Some(match format {
        Format::R8G8_UNORM => Channels::Rg,
        Format::R8G8B8_UNORM | Format::R8G8B8_SRGB => Channels::Rgb,
        Format::B8G8R8_UNORM | Format::B8G8R8_SRGB => Channels::Bgr,
        Format::R8G8B8A8_UNORM | Format::R8G8B8A8_SRGB => Channels::Rgba,
        Format::B8G8R8A8_UNORM | Format::B8G8R8A8_SRGB => Channels::Bgra,
        Format::R16G16B16A16_UNORM => Channels::Words,
        _ => return None,
    })
}

impl Channels {
    fn bytes(&self) -> usize {
        match self {
            Self::Rg => 2,
            Self::Rgb | Self::Bgr => 3,
            Self::Rgba | Self::Bgra => 4,
            Self::Words => 8,
        }
    }

    fn texels(&self, bytes: &[u8]) -> Vec<[u8; 4]> {
        match self {
            Self::Rg => rgba(bytes, |[r, g]| [r, g, 0, 255]),
            Self::Rgb => rgba(bytes, |[r, g, b]| [r, g, b, 255]),
            Self::Bgr => rgba(bytes, |[b, g, r]| [r, g, b, 255]),
            Self::Rgba => rgba(bytes, |texel| texel),
            Self::Bgra => rgba(bytes, |[b, g, r, a]| [r, g, b, a]),
            Self::Words => rgba(bytes, |words: [u8; 8]| {
                std::array::from_fn(|i| to_byte(u16::from_le_bytes([words[2 * i], words[2 * i + 1]])))
            }),
        }
    }
}
