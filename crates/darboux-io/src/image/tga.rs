//! Decodes TGA files (Truevision TGA File Format Specification 2.0) to 8-bit RGBA texels.

use std::borrow::Cow;

use tinytga::{Bpp, Compression, DataType, ImageOrigin, RawTga, TgaHeader};

use super::decoding::{DecodeError, DecodeLimits, broken, texel_count};

const FOOTER_SIGNATURE: &[u8] = b"TRUEVISION-XFILE.\0";
/// The bytes of a footer before its signature: where metadata begins.
const OFFSETS: usize = 8;
const HEADER_LENGTH: usize = 18;
/// The bytes of the header with the bits of an entry of the colour map, and of a texel.
const DEPTHS: [usize; 2] = [7, 16];
/// The first bytes of an extension area: its length, 495.
const AREA_LENGTH: [u8; 2] = 495_u16.to_le_bytes();
/// The byte of the extension area that says what alpha holds (field 24).
const ATTRIBUTES_TYPE: usize = 494;

/// Whether the fields of the header fit each other.
pub fn is_tga(file: &[u8]) -> bool {
    let file = &*with_whole_bytes(without_footer(file));
    let Ok(tga) = RawTga::from_slice(file) else { return false };
    let header = tga.header();
    let fits = match header.data_type {
        DataType::TrueColor => header.pixel_depth != Bpp::Bits8,
        DataType::BlackAndWhite => matches!(header.pixel_depth, Bpp::Bits8 | Bpp::Bits16),
        DataType::ColorMapped => header.has_color_map && header.pixel_depth == Bpp::Bits8,
        DataType::NoData => false,
    };
    // The two highest bits of the descriptor are reserved.
    let has_reserved_bits = file.get(HEADER_LENGTH - 1).is_none_or(|descriptor| descriptor & 0xC0 != 0);
    fits && !has_reserved_bits && header.width > 0 && header.height > 0
}

/// Decodes a file that [`is_tga`] to its width, its height and its texels.
pub fn decode(file: &[u8], limits: &DecodeLimits) -> Result<(u32, u32, Vec<[u8; 4]>), DecodeError> {
    let is_opaque = !may_have_alpha(file);
    let file = &*with_whole_bytes(without_footer(file));
    let tga = RawTga::from_slice(file).map_err(|_| broken("its header is damaged"))?;
    let header = tga.header();
    let (width, height) = (usize::from(header.width), usize::from(header.height));
    let count = texel_count(width, height, limits)?;
    if header.has_color_map && header.color_map_start > 0 {
        return Err(DecodeError::NoDecoder("a TGA whose colour map does not begin with 0"));
    }
    let stored = tga.image_data().len() / usize::from(header.pixel_depth.bytes());
    // The decoder takes texels that are missing for zeros.
    if header.compression == Compression::Uncompressed && stored < count {
        return Err(cut_off());
    }
    let is_mirrored = matches!(header.image_origin, ImageOrigin::BottomRight | ImageOrigin::TopRight);
    let mut texels = vec![[0; 4]; count];
    let mut decoded = 0;
    for pixel in tga.pixels() {
        let (x, y) = (pixel.position.x as usize, pixel.position.y as usize);
        let x = if is_mirrored { width - 1 - x } else { x };
        texels[y * width + x] = texel(&tga, &header, pixel.color)?;
        decoded += 1;
    }
    if is_opaque {
        texels.iter_mut().for_each(|texel| texel[3] = 255);
    }
    if decoded < count {
        return Err(cut_off());
    }
    Ok((width as u32, height as u32, texels))
}

fn cut_off() -> DecodeError {
    broken("it ends before its last row: it was cut off")
}

/// A footer only leads to metadata, and the decoder does not expect wrong offsets in it. All footers at the
/// end are left out: the decoder would look at the one before the last.
fn without_footer(mut file: &[u8]) -> &[u8] {
    while let Some(rest) = file.strip_suffix(FOOTER_SIGNATURE) {
        file = &rest[..rest.len().saturating_sub(OFFSETS)];
    }
    file
}

/// Whether alpha may hold something: the extension area, where there is one, says that it does (3), or that
/// the colours are multiplied with it (4). Else it is absent (0), or holds anything (1 and 2).
fn may_have_alpha(file: &[u8]) -> bool {
    let offset = file.strip_suffix(FOOTER_SIGNATURE).and_then(|rest| rest.last_chunk::<OFFSETS>());
    let offset = offset.map_or(0, |&[a, b, c, d, ..]| u32::from_le_bytes([a, b, c, d]) as usize);
    let area = file.get(offset..).filter(|area| offset > 0 && area.starts_with(&AREA_LENGTH));
    let kind = area.and_then(|area| area.get(ATTRIBUTES_TYPE));
    kind.is_none_or(|kind| matches!(kind, 3 | 4))
}

/// The file with texels of 15 bits called those of 16, which are as long: the first bit is that of alpha, and
/// nothing reads it.
fn with_whole_bytes(file: &[u8]) -> Cow<'_, [u8]> {
    if file.len() < HEADER_LENGTH || DEPTHS.iter().all(|&at| file[at] != 15) {
        return file.into();
    }
    let mut file = file.to_vec();
    for at in DEPTHS {
        if file[at] == 15 {
            file[at] = 16;
        }
    }
    file.into()
}

fn texel(tga: &RawTga<'_>, header: &TgaHeader, code: u32) -> Result<[u8; 4], DecodeError> {
    let has_alpha = header.alpha_channel_depth > 0;
    let [low, high, ..] = code.to_le_bytes();
    Ok(match (header.data_type, tga.color_map()) {
        (DataType::BlackAndWhite, _) => {
            [low, low, low, if has_alpha && header.pixel_depth == Bpp::Bits16 { high } else { 255 }]
        }
        (DataType::ColorMapped, Some(colors)) => {
            let color = colors.get_raw(code as usize).ok_or_else(|| broken("its colour map is too short"))?;
            color_of(color, colors.entry_bpp(), has_alpha)
        }
        _ => color_of(code, header.pixel_depth, has_alpha),
    })
}

/// Blue is lowest; 8 bits are grey. Colours of 16 bits have 5 bits per channel, and one that programs use in
/// opposite ways: their texels are opaque.
fn color_of(code: u32, bits: Bpp, has_alpha: bool) -> [u8; 4] {
    if bits == Bpp::Bits16 {
        let channel = |shift: u32| (((code >> shift & 31) * 255 + 15) / 31) as u8;
        return [channel(10), channel(5), channel(0), 255];
    }
    let [blue, green, red, alpha] = code.to_le_bytes();
    if bits == Bpp::Bits8 {
        return [blue, blue, blue, 255];
    }
    [red, green, blue, if has_alpha && bits == Bpp::Bits32 { alpha } else { 255 }]
}
