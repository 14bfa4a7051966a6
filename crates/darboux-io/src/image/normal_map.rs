//! Normal maps between conventions and channels: [`darboux::Conversion::texels`] and [`darboux::repack_texels`] on images.

use darboux::{Channel, Conversion, TexelLayout, repack_texels};

use super::channels::Channels;
use super::png_image::{PngImage, Texels};
use crate::Error;
use crate::error::Fault;

/// Converts a normal map in place: red and green inverted where `conversion` says so, and the vector moved from the channels `from` to
/// the channels `to`.
///
/// Channels that hold nothing of the vector keep their content. Where `to` has a z that `from` has not, it is rebuilt. The image gets
/// an alpha channel, or loses grey, where `to` needs that. Errors: an image without the channels `from`.
pub fn convert_normal_map(
    image: &mut PngImage,
    conversion: &Conversion,
    from: Channels,
    to: Channels,
) -> Result<(), Error> {
    let Some(places) = from.places(image.color) else {
        let problem =
            format!("has the channels {}, not {from}; name those that hold the vector", image.channels());
        return Err(Fault::invalid("", problem).in_file(image.name()));
    };
    let color = to.kind(image.color);
    let target = to.places(color).unwrap_or(places);
    let (before, after) = (image.color.samples(), color.samples());
    let texels = match &image.texels {
        Texels::Bytes(bytes) => {
            Texels::Bytes(converted(bytes, conversion, (before, places), (after, target)))
        }
        Texels::Words(words) => {
            Texels::Words(converted(words, conversion, (before, places), (after, target)))
        }
    };
    image.is_changed |= color != image.color || texels != image.texels;
    (image.color, image.texels) = (color, texels);
    Ok(())
}

/// How many texels hold no normal in these channels ([`TexelLayout::holds_normal`]): nearly none of a normal map, most of a photograph.
///
/// All of them where the image does not have the channels.
pub fn count_no_normals(image: &PngImage, channels: Channels) -> usize {
    let places = channels.places(image.color);
    match (&image.texels, places) {
        (_, None) => image.width as usize * image.height as usize,
        (Texels::Bytes(bytes), Some(places)) => no_normals(bytes, image.color.samples(), places),
        (Texels::Words(words), Some(places)) => no_normals(words, image.color.samples(), places),
    }
}

fn no_normals<C: Channel>(channels: &[C], samples: usize, places: Places) -> usize {
    fn of<C: Channel, const N: usize>(channels: &[C], places: Places) -> usize {
        let layout = layout::<N>(places);
        channels.as_chunks::<N>().0.iter().filter(|&&texel| !layout.holds_normal(texel)).count()
    }
    match samples {
        2 => of::<C, 2>(channels, places),
        3 => of::<C, 3>(channels, places),
        _ => of::<C, 4>(channels, places),
    }
}

/// The channels of x, y and z by number.
type Places = (usize, usize, Option<usize>);

/// Texels of `before` channels, `from` of them the vector, as texels of `after` channels with the vector in `to`.
fn converted<C: Channel>(
    channels: &[C],
    conversion: &Conversion,
    (before, from): (usize, Places),
    (after, to): (usize, Places),
) -> Vec<C> {
    match before {
        2 => of::<C, 2>(channels, conversion, from, after, to),
        3 => of::<C, 3>(channels, conversion, from, after, to),
        _ => of::<C, 4>(channels, conversion, from, after, to),
    }
}

fn of<C: Channel, const N: usize>(
    channels: &[C],
    conversion: &Conversion,
    from: Places,
    after: usize,
    to: Places,
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

fn layout<const N: usize>((x, y, z): Places) -> TexelLayout<N> {
    TexelLayout::new(x, y, z).expect("these are different channels of the texel")
}
