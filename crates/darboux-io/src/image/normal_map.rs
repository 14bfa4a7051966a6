//! Converts normal maps between conventions and channels: [`darboux::Conversion::texels`] and
//! [`darboux::repack_texels`] on images.

use darboux::{Channel, Conversion, TexelLayout, repack_texels};

use super::channels::Channels;
use super::png_image::{PngImage, Texels};
use crate::Error;
use crate::error::ContentError;

/// Converts a normal map in place: inverts red and green as `conversion` requires, and moves the vector from
/// the channels `from` to the channels `to`.
///
/// Channels outside the vector keep their content. If `to` has a z and `from` does not, z is reconstructed.
/// The kind of texels changes if `to` requires it. Errors: the image does not have the channels `from`.
pub fn convert_normal_map(
    image: &mut PngImage,
    conversion: &Conversion,
    from: Channels,
    to: Channels,
) -> Result<(), Error> {
    let indices = from.indices(image.color).ok_or_else(|| lacks(image, from))?;
    let color = to.kind(image.color);
    let target = to.indices(color).unwrap_or(indices);
    let (before, after) = (image.color.samples(), color.samples());
    let texels = match &image.texels {
        Texels::Bytes(bytes) => {
            Texels::Bytes(converted(bytes, conversion, (before, indices), (after, target)))
        }
        Texels::Words(words) => {
            Texels::Words(converted(words, conversion, (before, indices), (after, target)))
        }
    };
    image.is_changed |= color != image.color || texels != image.texels;
    (image.color, image.texels) = (color, texels);
    Ok(())
}

/// The vectors of all texels, row after row, as [`TexelLayout::vector`] decodes them: not normalised. A z
/// that is not stored is reconstructed.
///
/// Errors: the image does not have the channels.
pub fn normal_vectors(image: &PngImage, channels: Channels) -> Result<Vec<[f32; 3]>, Error> {
    let indices = channels.indices(image.color).ok_or_else(|| lacks(image, channels))?;
    let samples = image.color.samples();
    Ok(match &image.texels {
        Texels::Bytes(bytes) => decoded(bytes, samples, indices),
        Texels::Words(words) => decoded(words, samples, indices),
    })
}

/// The codes of red, green and blue of all texels, row after row.
#[derive(Clone, Debug, PartialEq, Eq)]
#[expect(clippy::exhaustive_enums, reason = "samples of images have 8 or 16 bits")]
pub enum RgbCodes {
    /// Codes of 8 bits.
    Bytes(Vec<[u8; 3]>),
    /// Codes of 16 bits.
    Words(Vec<[u16; 3]>),
}

/// The codes of red, green and blue, which take less memory than [`normal_vectors`]. Errors: the image does
/// not have the channels.
pub fn rgb_codes(image: &PngImage) -> Result<RgbCodes, Error> {
    fn picked<C: Copy>(channels: &[C], samples: usize, [r, g, b]: [usize; 3]) -> Vec<[C; 3]> {
        channels.chunks_exact(samples).map(|texel| [texel[r], texel[g], texel[b]]).collect()
    }
    let lacks = || lacks(image, Channels::RGB);
    let (red, green, blue) = Channels::RGB.indices(image.color).ok_or_else(lacks)?;
    let indices = [red, green, blue.ok_or_else(lacks)?];
    let samples = image.color.samples();
    Ok(match &image.texels {
        Texels::Bytes(bytes) => RgbCodes::Bytes(picked(bytes, samples, indices)),
        Texels::Words(words) => RgbCodes::Words(picked(words, samples, indices)),
    })
}

/// Replaces the vectors of all texels; each component becomes the nearest code. Other channels keep their
/// content.
///
/// `vectors`: one per texel, with components from -1 to 1. Errors: the image does not have the channels, or
/// another number of texels.
pub fn set_normal_vectors(
    image: &mut PngImage,
    channels: Channels,
    vectors: &[[f32; 3]],
) -> Result<(), Error> {
    let indices = channels.indices(image.color).ok_or_else(|| lacks(image, channels))?;
    if vectors.len() != image.width as usize * image.height as usize {
        let problem = format!("has {} x {} texels, not {}", image.width, image.height, vectors.len());
        return Err(ContentError::invalid("", problem).in_file(image.name()));
    }
    let samples = image.color.samples();
    let texels = match &image.texels {
        Texels::Bytes(bytes) => Texels::Bytes(encoded(bytes, samples, indices, vectors)),
        Texels::Words(words) => Texels::Words(encoded(words, samples, indices, vectors)),
    };
    image.is_changed |= texels != image.texels;
    image.texels = texels;
    Ok(())
}

fn lacks(image: &PngImage, channels: Channels) -> Error {
    let problem = format!(
        "has the channels {}, not {channels}; name the channels that hold the vector",
        image.channels()
    );
    ContentError::invalid("", problem).in_file(image.name())
}

fn decoded<C: Channel>(channels: &[C], samples: usize, (x, y, z): VectorChannels) -> Vec<[f32; 3]> {
    let texels = channels.chunks_exact(samples);
    match z {
        Some(z) => texels.map(|texel| TexelLayout::RGB.vector([texel[x], texel[y], texel[z]])).collect(),
        None => texels.map(|texel| TexelLayout::RG.vector([texel[x], texel[y]])).collect(),
    }
}

fn encoded<C: Channel>(
    channels: &[C],
    samples: usize,
    (x, y, z): VectorChannels,
    vectors: &[[f32; 3]],
) -> Vec<C> {
    let mut channels = channels.to_vec();
    for (texel, &vector) in channels.chunks_exact_mut(samples).zip(vectors) {
        let codes: [C; 3] = TexelLayout::RGB.texel(vector);
        (texel[x], texel[y]) = (codes[0], codes[1]);
        if let Some(z) = z {
            texel[z] = codes[2];
        }
    }
    channels
}

/// Changes red, green and blue of every texel, each a number from 0 to 1, and rounds to the image's bit
/// depth. Alpha is kept.
///
/// Errors: the image does not have these channels.
pub fn change_texels(image: &mut PngImage, change: impl Fn([f64; 3]) -> [f64; 3]) -> Result<(), Error> {
    let Some((0, 1, Some(2))) = Channels::RGB.indices(image.color) else {
        let problem = format!("has the channels {}, not rgb; save it as RGB", image.channels());
        return Err(ContentError::invalid("", problem).in_file(image.name()));
    };
    let samples = image.color.samples();
    let texels = match &image.texels {
        Texels::Bytes(bytes) => {
            let to_code = |x: f64| (255.0 * x.clamp(0.0, 1.0)).round() as u8;
            Texels::Bytes(changed(bytes, samples, |code| f64::from(code) / 255.0, &change, to_code))
        }
        Texels::Words(words) => {
            let to_code = |x: f64| (65535.0 * x.clamp(0.0, 1.0)).round() as u16;
            Texels::Words(changed(words, samples, |code| f64::from(code) / 65535.0, &change, to_code))
        }
    };
    image.is_changed |= texels != image.texels;
    image.texels = texels;
    Ok(())
}

fn changed<C: Channel>(
    channels: &[C],
    samples: usize,
    to_number: impl Fn(C) -> f64,
    change: impl Fn([f64; 3]) -> [f64; 3],
    to_code: impl Fn(f64) -> C,
) -> Vec<C> {
    let mut channels = channels.to_vec();
    for texel in channels.chunks_exact_mut(samples) {
        let changed = change([texel[0], texel[1], texel[2]].map(&to_number));
        texel.iter_mut().zip(changed).for_each(|(channel, x)| *channel = to_code(x));
    }
    channels
}

/// Counts the texels whose channels do not hold a unit normal ([`TexelLayout::holds_normal`]): nearly none in
/// a normal map, most in a photograph, all if the image does not have the channels.
pub fn count_invalid_normals(image: &PngImage, channels: Channels) -> usize {
    let indices = channels.indices(image.color);
    match (&image.texels, indices) {
        (_, None) => image.width as usize * image.height as usize,
        (Texels::Bytes(bytes), Some(indices)) => count_invalid(bytes, image.color.samples(), indices),
        (Texels::Words(words), Some(indices)) => count_invalid(words, image.color.samples(), indices),
    }
}

fn count_invalid<C: Channel>(channels: &[C], samples: usize, indices: VectorChannels) -> usize {
    fn count<C: Channel, const N: usize>(channels: &[C], indices: VectorChannels) -> usize {
        let layout = layout::<N>(indices);
        channels.as_chunks::<N>().0.iter().filter(|&&texel| !layout.holds_normal(texel)).count()
    }
    match samples {
        2 => count::<C, 2>(channels, indices),
        3 => count::<C, 3>(channels, indices),
        _ => count::<C, 4>(channels, indices),
    }
}

/// The indices of the channels of x, y and z.
type VectorChannels = (usize, usize, Option<usize>);

/// Converts texels of `before` channels, with the vector in `from`, to texels of `after` channels, with the
/// vector in `to`.
fn converted<C: Channel>(
    channels: &[C],
    conversion: &Conversion,
    (before, from): (usize, VectorChannels),
    (after, to): (usize, VectorChannels),
) -> Vec<C> {
    match before {
        2 => converted_from::<C, 2>(channels, conversion, from, after, to),
        3 => converted_from::<C, 3>(channels, conversion, from, after, to),
        _ => converted_from::<C, 4>(channels, conversion, from, after, to),
    }
}

fn converted_from<C: Channel, const N: usize>(
    channels: &[C],
    conversion: &Conversion,
    from: VectorChannels,
    after: usize,
    to: VectorChannels,
) -> Vec<C> {
    let from = layout::<N>(from);
    let mut texels = channels.as_chunks::<N>().0.to_vec();
    conversion.texels(from, &mut texels);
    match after {
        2 => repack_texels(&texels, from, layout::<2>(to)).into_flattened(),
        3 => repack_texels(&texels, from, layout::<3>(to)).into_flattened(),
        _ => repack_texels(&texels, from, layout::<4>(to)).into_flattened(),
    }
}

fn layout<const N: usize>((x, y, z): VectorChannels) -> TexelLayout<N> {
    TexelLayout::new(x, y, z).expect("the channels differ and are channels of the texel")
}
