//! The numbers of maps as images have them.

use darboux::{Channel, TexelLayout};
use darboux_bake::{BakeOptions, Images, MapContent, MapKind, is_color_texture};
use darboux_io::image::{PngImage, Sample, linear_to_srgb};

/// Bits per channel without `--bits`.
pub fn default_bits(map: MapKind) -> u8 {
    if map.content() == MapContent::Lengths { 16 } else { 8 }
}

/// How the numbers of a map become those of a file.
pub struct Encoding {
    map: MapKind,
    content: MapContent,
    channels: usize,
    /// The values that black and white mean, one pair per channel; none where the map is a direction.
    pub range: Vec<[f32; 2]>,
}

impl Encoding {
    /// `texture`: the name of the texture of [`MapKind::Texture`].
    pub fn new(map: MapKind, images: &Images, options: &BakeOptions, texture: Option<&str>) -> Self {
        let is_color = map == MapKind::Texture && texture.is_some_and(is_color_texture);
        let content = if is_color { MapContent::Light } else { map.content() };
        let numbers = images.numbers(map).unwrap_or_default();
        let is_opaque = map.channels() == 4 && numbers.as_chunks::<4>().0.iter().all(|texel| texel[3] == 1.0);
        let channels = if is_opaque { 3 } else { map.channels() };
        Self { map, content, channels, range: range(map, content, numbers, options) }
    }

    /// The image in 8 or 16 bits. Errors are one sentence each.
    pub fn png(&self, name: &str, images: &Images, bits: u8) -> Result<PngImage, String> {
        match bits {
            8 => self.encoded::<u8>(name, images),
            _ => self.encoded::<u16>(name, images),
        }
    }

    fn encoded<C: Channel + Sample>(&self, name: &str, images: &Images) -> Result<PngImage, String> {
        let numbers = images.numbers(self.map).unwrap_or_default();
        let codes = |from: usize, texel: &[f32]| -> [C; 3] {
            let signed = |i: usize| texel.get(i).map_or(0.0, |&x| self.signed(from + i, x));
            TexelLayout::<3>::RGB.texel::<C>([0, 1, 2].map(signed))
        };
        let size = images.size;
        let image = match self.channels {
            1 => {
                let grey: Vec<C> = numbers.iter().map(|x| codes(0, &[*x])[0]).collect();
                PngImage::from_grey(name, size, &grey)
            }
            3 => {
                let texels = numbers.chunks_exact(self.map.channels());
                let rgb: Vec<[C; 3]> = texels.map(|texel| codes(0, &texel[..3])).collect();
                PngImage::from_rgb(name, size, &rgb)
            }
            _ => {
                let rgba = |texel: &[f32; 4]| {
                    let [red, green, blue] = codes(0, &texel[..3]);
                    [red, green, blue, codes(3, &texel[3..])[0]]
                };
                let rgba: Vec<[C; 4]> = numbers.as_chunks::<4>().0.iter().map(rgba).collect();
                PngImage::from_rgba(name, size, &rgba)
            }
        };
        image.map_err(|error| error.to_string())
    }

    /// A number of a channel, from -1 (black) to 1 (white).
    fn signed(&self, channel: usize, x: f32) -> f32 {
        let Some(&[from, to]) = self.range.get(channel) else { return x };
        let signed = if to > from { 2.0 * (x - from) / (to - from) - 1.0 } else { 0.0 };
        if self.content == MapContent::Light && channel < 3 {
            let share = (f64::from(signed) + 1.0) / 2.0;
            return (2.0 * linear_to_srgb(share.clamp(0.0, 1.0)) - 1.0) as f32;
        }
        signed
    }
}

/// What black and white mean: heights from as far inside to as far outside as rays can reach, positions the box around all of them, thickness and light up
/// to the largest.
fn range(map: MapKind, content: MapContent, numbers: &[f32], options: &BakeOptions) -> Vec<[f32; 2]> {
    let largest = numbers.iter().fold(0f32, |largest, x| largest.max(x.abs()));
    match (map, content) {
        (MapKind::Height, _) => {
            let reach = options.distance[0].max(options.distance[1]).max(largest);
            vec![[-reach, reach]]
        }
        (MapKind::Position, _) => (0..3)
            .map(|axis| {
                let places = || numbers.iter().skip(axis).step_by(3).copied();
                [places().fold(f32::INFINITY, f32::min), places().fold(f32::NEG_INFINITY, f32::max)]
            })
            .collect(),
        (_, MapContent::Lengths) => vec![[0.0, largest]],
        (_, MapContent::Light) => {
            let light = numbers.chunks_exact(map.channels()).flat_map(|texel| &texel[..3]);
            let brightest = light.fold(1f32, |most, x| most.max(*x));
            let mut range = vec![[0.0, brightest]; 3];
            range.resize(map.channels(), [0.0, 1.0]);
            range
        }
        (_, MapContent::Shares | MapContent::Labels) => vec![[0.0, 1.0]; map.channels()],
        (_, MapContent::Signed) => vec![[-1.0, 1.0]],
        _ => Vec::new(),
    }
}
