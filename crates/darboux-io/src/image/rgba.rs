//! Decodes texture files (PNG, JPEG, WebP, TGA; KTX 2 with the feature `ktx2`) to RGBA texels of 8 bits, or
//! of 16 bits where a PNG has them. The first bytes of a file decide its format.

use std::io::Cursor;

use image_webp::WebPDecoder;
use png::{ColorType, Transformations};
use zune_core::bytestream::ZCursor;
use zune_core::colorspace::ColorSpace;
use zune_core::options::DecoderOptions;
use zune_jpeg::JpegDecoder;

use super::chunks::SIGNATURE as PNG;
use super::decoding::{DecodeError, DecodeLimits, broken, check_memory, rgba, texel_count, to_byte};
use super::palette::check_palette;
use super::{other_formats, reasons, tga};
use crate::image::PngImage;
use crate::{Error, git_lfs};

/// An image as 8-bit RGBA texels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RgbaImage {
    /// Texels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The texels, row after row, the top row first.
    pub texels: Vec<[u8; 4]>,
}

/// The RGBA texels of an image in the depth of its file, row after row, the top row first.
#[derive(Clone, Debug, PartialEq, Eq)]
#[expect(clippy::exhaustive_enums, reason = "samples of images have 8 or 16 bits")]
pub enum RgbaCodes {
    /// 8 bits per channel.
    Bytes(Vec<[u8; 4]>),
    /// 16 bits per channel.
    Words(Vec<[u16; 4]>),
}

impl RgbaCodes {
    /// Decodes an image file as [`RgbaImage::decode`] does, but keeps the 16 bits of a PNG. Returns the
    /// texels per row and the rows, and the texels.
    ///
    /// A PNG of 16 bits takes up to 16 bytes per texel while it is decoded, twice as many as
    /// [`DecodeLimits::of_file`] counts; other images take up to 8.
    pub fn decode(file: &[u8], limits: &DecodeLimits) -> Result<([u32; 2], Self), DecodeError> {
        if PngImage::is_deep(file) {
            return decode_deep_png(file, limits);
        }
        let RgbaImage { width, height, texels } = RgbaImage::decode(file, limits)?;
        Ok(([width, height], Self::Bytes(texels)))
    }
}

const JPEG: &[u8] = b"\xFF\xD8\xFF";
const KTX2: &[u8] = b"\xABKTX 20\xBB\r\n\x1A\n";

impl RgbaImage {
    /// Decodes an image file. Grey becomes RGB; 16-bit channels are rounded to 8 bits; without alpha, texels
    /// are opaque.
    pub fn decode(file: &[u8], limits: &DecodeLimits) -> Result<Self, DecodeError> {
        let brand = file.get(8..12);
        if file.starts_with(&PNG) {
            decode_png(file, limits)
        } else if file.starts_with(JPEG) {
            decode_jpeg(file, limits)
        } else if file.starts_with(b"RIFF") && brand == Some(b"WEBP") {
            decode_webp(file, limits)
        } else if file.starts_with(KTX2) {
            decode_ktx2(file, limits)
        } else if file.get(4..8) == Some(b"ftyp") && brand.is_some_and(|brand| brand.starts_with(b"avi")) {
            Err(DecodeError::NoDecoder("AVIF"))
        } else if git_lfs::is_pointer(file) {
            Err(DecodeError::GitLfsPointer)
        } else if tga::is_tga(file) {
            let (width, height, texels) = tga::decode(file, limits)?;
            Ok(Self { width, height, texels })
        } else {
            Err(other_formats::name(file).map_or(DecodeError::UnknownFormat, DecodeError::NoDecoder))
        }
    }

    /// Whether a file begins as a format that is decoded.
    pub fn is_format_known(file: &[u8]) -> bool {
        let is_webp = file.starts_with(b"RIFF") && file.get(8..12) == Some(b"WEBP");
        file.starts_with(&PNG)
            || file.starts_with(JPEG)
            || is_webp
            || cfg!(feature = "ktx2") && file.starts_with(KTX2)
            || tga::is_tga(file)
    }

    /// Whether a file is a TGA, which glTF cannot hold, and a PNG of 8 bits can without loss. The format has
    /// no signature: a header whose fields fit each other tells it from others.
    pub fn is_tga(file: &[u8]) -> bool {
        tga::is_tga(file)
    }

    /// The name of the format of a file without a decoder here, by its first bytes: BMP, TIFF, PSD, DDS and
    /// others.
    pub(crate) fn other_format(file: &[u8]) -> Option<&'static str> {
        other_formats::name(file)
    }

    /// The image as a PNG of 8 bits, without alpha where all texels are opaque.
    pub fn to_png(&self, name: &str) -> Result<Vec<u8>, Error> {
        let size = [self.width, self.height];
        let image = if self.texels.iter().all(|texel| texel[3] == 255) {
            let texels: Vec<[u8; 3]> = self.texels.iter().map(|&[r, g, b, _]| [r, g, b]).collect();
            PngImage::from_rgb(name, size, &texels)?
        } else {
            PngImage::from_rgba(name, size, &self.texels)?
        };
        image.to_bytes()
    }

    /// Whether the image has colours, as normal maps do and height maps do not: whether the channels of its
    /// texels differ by more than 24 of 255 on average.
    ///
    /// The image is averaged down to 32 x 32 texels first, so that noise does not count.
    pub fn is_colored(&self) -> bool {
        const SIDE: usize = 32;
        const DIFFERENCE: u64 = 24;
        let range = |cell: usize, texels: u32| {
            let first = cell * texels as usize / SIDE;
            first..((cell + 1) * texels as usize / SIDE).max(first + 1)
        };
        let mean_difference = |x: usize, y: usize| {
            let mut sums = [0u64; 3];
            let mut count = 0;
            for row in range(y, self.height) {
                for texel in
                    range(x, self.width).map(|column| self.texels[row * self.width as usize + column])
                {
                    sums.iter_mut().zip(texel).for_each(|(sum, channel)| *sum += u64::from(channel));
                    count += 1;
                }
            }
            let means = sums.map(|sum| sum / count);
            means.iter().max().zip(means.iter().min()).map_or(0, |(max, min)| max - min)
        };
        let cells = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y)));
        let sum: u64 = cells.map(|(x, y)| mean_difference(x, y)).sum();
        sum > DIFFERENCE * (SIDE * SIDE) as u64
    }
}

fn decode_png(file: &[u8], limits: &DecodeLimits) -> Result<RgbaImage, DecodeError> {
    let mut reader = open_png(file, limits)?;
    let (width, height) = (reader.info().width, reader.info().height);
    let (color, depth) = reader.output_color_type();
    let length = reader.output_buffer_size().ok_or_else(|| broken("it is too large"))?;
    // The channels of 16 bits are there until those of 8 bits are.
    let peak = if depth == png::BitDepth::Sixteen { length as u64 * 3 / 2 } else { length as u64 };
    check_memory([width as usize, height as usize], peak, limits)?;
    let mut bytes = vec![0; length];
    reader.next_frame(&mut bytes).map_err(|error| broken(reasons::of_png(&error)))?;
    if depth == png::BitDepth::Sixteen {
        bytes = bytes.as_chunks().0.iter().map(|&word| to_byte(u16::from_be_bytes(word))).collect();
    }
    let texels = texels_of_png(color, &bytes, |byte| byte, u8::MAX)?;
    Ok(RgbaImage { width, height, texels })
}

fn decode_deep_png(file: &[u8], limits: &DecodeLimits) -> Result<([u32; 2], RgbaCodes), DecodeError> {
    let mut reader = open_png(file, limits)?;
    let size = [reader.info().width, reader.info().height];
    let (color, _) = reader.output_color_type();
    let mut bytes = vec![0; reader.output_buffer_size().ok_or_else(|| broken("it is too large"))?];
    reader.next_frame(&mut bytes).map_err(|error| broken(reasons::of_png(&error)))?;
    let texels = texels_of_png(color, bytes.as_chunks().0, u16::from_be_bytes, u16::MAX)?;
    Ok((size, RgbaCodes::Words(texels)))
}

/// A reader of a PNG whose palette and channels of fewer than 8 bits are expanded, once its header was
/// checked.
fn open_png<'a>(file: &'a [u8], limits: &DecodeLimits) -> Result<png::Reader<Cursor<&'a [u8]>>, DecodeError> {
    let mut decoder = png::Decoder::new(Cursor::new(file));
    decoder.set_transformations(Transformations::EXPAND);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let reader = decoder.read_info().map_err(|error| broken(reasons::of_png(&error)))?;
    check_palette(reader.info()).map_err(|problem| broken(&problem))?;
    texel_count(reader.info().width as usize, reader.info().height as usize, limits)?;
    Ok(reader)
}

/// The texels of a PNG's samples. `code`: of a sample; `opaque`: the code of alpha where the PNG has none.
fn texels_of_png<S: Copy, C: Copy>(
    color: ColorType,
    samples: &[S],
    code: impl Fn(S) -> C,
    opaque: C,
) -> Result<Vec<[C; 4]>, DecodeError> {
    let grey = |[l, a]: [C; 2]| [l, l, l, a];
    Ok(match color {
        ColorType::Grayscale => rgba(samples, |[l]| grey([code(l), opaque])),
        ColorType::GrayscaleAlpha => rgba(samples, |texel: [S; 2]| grey(texel.map(&code))),
        ColorType::Rgb => rgba(samples, |[r, g, b]| [code(r), code(g), code(b), opaque]),
        ColorType::Rgba => rgba(samples, |texel: [S; 4]| texel.map(&code)),
        ColorType::Indexed => return Err(broken("its palette is missing")),
    })
}

fn decode_jpeg(file: &[u8], limits: &DecodeLimits) -> Result<RgbaImage, DecodeError> {
    if !ends_with_its_image(file) {
        return Err(broken("it ends before its last row: it was cut off"));
    }
    let side = limits.max_side as usize;
    // Without the strict mode, the decoder fills what damaged data does not give with grey.
    let options = DecoderOptions::default().set_strict_mode(true).set_max_width(side).set_max_height(side);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(file), options);
    decoder.decode_headers().map_err(|error| broken(reasons::of_jpeg(&error)))?;
    let (width, height) = decoder.dimensions().ok_or_else(|| broken("it has no size"))?;
    texel_count(width, height, limits)?;
    let is_grey = decoder.input_colorspace() == Some(ColorSpace::Luma);
    let space = if is_grey { ColorSpace::Luma } else { ColorSpace::RGB };
    decoder.set_options(options.jpeg_set_out_colorspace(space));
    let bytes = decoder.decode().map_err(|error| broken(reasons::of_jpeg(&error)))?;
    let texels = match is_grey {
        true => rgba(&bytes, |[l]| [l, l, l, 255]),
        false => rgba(&bytes, |[r, g, b]| [r, g, b, 255]),
    };
    Ok(RgbaImage { width: width as u32, height: height as u32, texels })
}

/// Whether the segments of a JPEG reach the marker of its end (ITU-T T.81, annex B). A thumbnail in the
/// metadata has such a marker, too, so the segments are followed by their lengths.
fn ends_with_its_image(file: &[u8]) -> bool {
    const END: u8 = 0xD9;
    let mut at = 2;
    loop {
        // A marker is 0xFF, repeated as often as one likes, and a code. In the data of a scan, 0xFF 0x00 is a
        // byte and 0xD0 to 0xD7 are restarts.
        let rest = file.get(at..).unwrap_or_default();
        let is_marker = |pair: &[u8]| pair[0] == 0xFF && !matches!(pair[1], 0 | 0xD0..=0xD7 | 0xFF);
        let Some(skipped) = rest.windows(2).position(is_marker) else { return false };
        if rest[skipped + 1] == END {
            return true;
        }
        let Some(&[high, low]) = rest.get(skipped + 2..skipped + 4) else { return false };
        at += skipped + 2 + usize::from(u16::from_be_bytes([high, low])).max(2);
    }
}

#[cfg(feature = "ktx2")]
fn decode_ktx2(file: &[u8], limits: &DecodeLimits) -> Result<RgbaImage, DecodeError> {
    let (width, height, texels) = super::ktx2_image::decode(file, limits)?;
    Ok(RgbaImage { width, height, texels })
}

#[cfg(not(feature = "ktx2"))]
fn decode_ktx2(_: &[u8], _: &DecodeLimits) -> Result<RgbaImage, DecodeError> {
    Err(DecodeError::NoDecoder("KTX 2"))
}

fn decode_webp(file: &[u8], limits: &DecodeLimits) -> Result<RgbaImage, DecodeError> {
    let mut decoder =
        WebPDecoder::new(Cursor::new(file)).map_err(|error| broken(reasons::of_webp(&error)))?;
    let (width, height) = decoder.dimensions();
    texel_count(width as usize, height as usize, limits)?;
    let length = decoder.output_buffer_size().ok_or_else(|| broken("it is too large"))?;
    let mut bytes = vec![0; length];
    decoder.read_image(&mut bytes).map_err(|error| broken(reasons::of_webp(&error)))?;
    let texels = match decoder.has_alpha() {
        true => rgba(&bytes, |texel| texel),
        false => rgba(&bytes, |[r, g, b]| [r, g, b, 255]),
    };
    Ok(RgbaImage { width, height, texels })
}
