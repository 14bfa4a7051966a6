//! The bytes of image files: PNG, EXR and TIFF.

use std::io::Cursor;

use darboux_io::image::PngImage;
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, SmallVec, Text,
    WritableImage, f16,
};
use tiff::encoder::colortype::{ColorType, Gray16, Gray32Float, RGB16, RGB32Float, RGBA16, RGBA32Float};
use tiff::encoder::{Compression, DeflateLevel, TiffEncoder, TiffValue};
use tiff::tags::Tag;

use super::dither::BlueNoise;
use super::encode::{Channels, FileKind};

/// What a file says about its numbers, by keywords.
pub type Notes = Vec<(&'static str, String)>;

/// An image in a format and with bits that it can have. Errors are one sentence each.
pub fn file_bytes(
    kind: FileKind,
    name: &str,
    channels: &Channels<'_>,
    bits: u8,
    notes: &Notes,
    noise: Option<&BlueNoise>,
) -> Result<Vec<u8>, String> {
    match kind {
        FileKind::Png => {
            png(name, channels, bits, notes, noise)?.to_bytes().map_err(|error| error.to_string())
        }
        FileKind::Exr => {
            exr(channels, bits, notes).map_err(|error| format!("{name}: cannot be encoded: {error}"))
        }
        FileKind::Tiff => {
            tiff(channels, bits, notes).map_err(|error| format!("{name}: cannot be encoded: {error}"))
        }
    }
}

/// A PNG of 8 or 16 bits. Two channels get a third one that is black. Errors are one sentence each.
pub fn png(
    name: &str,
    channels: &Channels<'_>,
    bits: u8,
    notes: &Notes,
    noise: Option<&BlueNoise>,
) -> Result<PngImage, String> {
    let size = channels.size;
    let image = match (bits, channels.count()) {
        (8, 1) => PngImage::from_grey(name, size, &channels.codes::<u8>(noise)),
        (8, 4) => PngImage::from_rgba(name, size, channels.codes::<u8>(noise).as_chunks().0),
        (8, count) => PngImage::from_rgb(name, size, &rgb(&channels.codes::<u8>(noise), count)),
        (_, 1) => PngImage::from_grey(name, size, &channels.codes::<u16>(None)),
        (_, 4) => PngImage::from_rgba(name, size, channels.codes::<u16>(None).as_chunks().0),
        (_, count) => PngImage::from_rgb(name, size, &rgb(&channels.codes::<u16>(None), count)),
    };
    let texts: Vec<(&str, String)> = notes.iter().map(|(keyword, text)| (*keyword, text.clone())).collect();
    let noted = image.and_then(|image| if texts.is_empty() { Ok(image) } else { image.with_texts(&texts) });
    noted.map_err(|error| error.to_string())
}

/// Texels of two or three channels as three.
fn rgb<T: Copy + Default>(numbers: &[T], count: usize) -> Vec<[T; 3]> {
    let texel = |texel: &[T]| [0, 1, 2].map(|channel| texel.get(channel).copied().unwrap_or_default());
    numbers.chunks_exact(count).map(texel).collect()
}

/// The largest number that an EXR of 16 bits holds.
pub const LARGEST_HALF: f32 = 65504.0;

fn exr(channels: &Channels<'_>, bits: u8, notes: &Notes) -> exr::error::Result<Vec<u8>> {
    let (count, numbers) = (channels.count(), channels.floats());
    let names = if count == 1 { &["Y"][..] } else { &["R", "G", "B", "A"] };
    let channel = |at: usize| {
        let of_channel = numbers.iter().skip(at).step_by(count).copied();
        let samples = match bits {
            16 => FlatSamples::F16(
                of_channel.map(|x| f16::from_f32(x.clamp(-LARGEST_HALF, LARGEST_HALF))).collect(),
            ),
            _ => FlatSamples::F32(of_channel.collect()),
        };
        AnyChannel::new(names[at], samples)
    };
    let list: SmallVec<[AnyChannel<FlatSamples>; 4]> = (0..count).map(channel).collect();
    // One attribute: the crate would write several in a random order.
    let comments = joined(notes).and_then(Text::new_or_none);
    let attributes = LayerAttributes { comments, ..LayerAttributes::default() };
    let size = channels.size.map(|side| side as usize);
    let layer = Layer::new((size[0], size[1]), attributes, Encoding::SMALL_LOSSLESS, AnyChannels::sort(list));
    let mut bytes = Cursor::new(Vec::new());
    // On one thread, so that the bytes do not depend on their number.
    Image::from_layer(layer).write().non_parallel().to_buffered(&mut bytes)?;
    Ok(bytes.into_inner())
}

fn tiff(channels: &Channels<'_>, bits: u8, notes: &Notes) -> tiff::TiffResult<Vec<u8>> {
    let (size, count) = (channels.size, channels.count());
    match bits {
        16 => {
            let codes = channels.codes::<u16>(None);
            match count {
                1 => encode_tiff::<Gray16>(size, &codes, notes),
                4 => encode_tiff::<RGBA16>(size, &codes, notes),
                _ => encode_tiff::<RGB16>(size, rgb(&codes, count).as_flattened(), notes),
            }
        }
        _ => {
            let floats = channels.floats();
            match count {
                1 => encode_tiff::<Gray32Float>(size, &floats, notes),
                4 => encode_tiff::<RGBA32Float>(size, &floats, notes),
                _ => encode_tiff::<RGB32Float>(size, rgb(&floats, count).as_flattened(), notes),
            }
        }
    }
}

fn encode_tiff<C: ColorType>(
    [width, height]: [u32; 2],
    texels: &[C::Inner],
    notes: &Notes,
) -> tiff::TiffResult<Vec<u8>>
where
    [C::Inner]: TiffValue,
{
    let mut bytes = Cursor::new(Vec::new());
    let compression = Compression::Deflate(DeflateLevel::Balanced);
    let mut encoder = TiffEncoder::new(&mut bytes)?.with_compression(compression);
    let mut image = encoder.new_image::<C>(width, height)?;
    if let Some(text) = joined(notes) {
        image.encoder().write_tag(Tag::ImageDescription, text.as_str())?;
    }
    image.write_data(texels)?;
    Ok(bytes.into_inner())
}

/// All notes as one text; none without notes.
fn joined(notes: &Notes) -> Option<String> {
    let lines: Vec<String> = notes.iter().map(|(keyword, text)| format!("{keyword}: {text}")).collect();
    (!lines.is_empty()).then(|| lines.join("\n"))
}
