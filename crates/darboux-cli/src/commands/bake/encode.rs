//! The numbers of maps as the channels of files.

use std::path::Path;

use darboux::{Channel, TexelLayout};
use darboux_bake::{BakeOptions, Images, MapContent, MapKind, is_color_texture};
use darboux_io::image::{Sample, linear_to_srgb};

use super::dither::BlueNoise;

/// A format of image files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// 8 or 16 bits.
    Png,
    /// 16 or 32 bits, floating point.
    Exr,
    /// 16 bits, or 32 bits floating point.
    Tiff,
}

impl FileKind {
    /// The format that a name's ending asks for; none for other endings.
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_lowercase();
        match ending.as_str() {
            "png" => Some(Self::Png),
            "exr" => Some(Self::Exr),
            "tif" | "tiff" => Some(Self::Tiff),
            _ => None,
        }
    }

    /// The bits per channel that the format can have.
    pub fn bits(self) -> [u8; 2] {
        if self == Self::Png { [8, 16] } else { [16, 32] }
    }

    /// Whether files with these bits have codes between black and white, and not the numbers themselves.
    pub fn has_codes(self, bits: u8) -> bool {
        match self {
            Self::Png => true,
            Self::Exr => false,
            Self::Tiff => bits == 16,
        }
    }

    /// Bits per channel without `--bits`: few, but more for distances and places.
    pub fn default_bits(self, map: MapKind) -> u8 {
        self.bits()[usize::from(map.content() == MapContent::Lengths)]
    }
}

/// The values that black and white mean, of maps for which they are known before an image is encoded: one
/// pair per channel.
#[derive(Debug, Default)]
pub struct Ranges(Vec<(MapKind, Vec<[f32; 2]>)>);

impl Ranges {
    /// The range of a map, if it is known.
    pub fn of(&self, map: MapKind) -> Option<&[[f32; 2]]> {
        self.0.iter().find(|(known, _)| *known == map).map(|(_, range)| &range[..])
    }

    /// Widens the range of a map to what it has in one more image.
    pub fn widen(&mut self, map: MapKind, range: Vec<[f32; 2]>) {
        match self.0.iter_mut().find(|(known, _)| *known == map) {
            Some((_, known)) => {
                for (known, [from, to]) in known.iter_mut().zip(range) {
                    *known = [known[0].min(from), known[1].max(to)];
                }
            }
            None => self.0.push((map, range)),
        }
    }
}

/// How the numbers of a map are encoded in a file.
pub struct Encoding {
    content: MapContent,
    /// The channels that files have.
    pub channels: usize,
    /// The values that black and white mean, one pair per channel; none where the map is a direction.
    pub range: Vec<[f32; 2]>,
}

impl Encoding {
    /// `texture`: the name of the texture of [`MapKind::Texture`]; `ranges`: those that are known; others are
    /// the image's own.
    pub fn new(
        map: MapKind,
        images: &Images,
        options: &BakeOptions,
        texture: Option<&str>,
        ranges: &Ranges,
    ) -> Self {
        let is_color = map == MapKind::Texture && texture.is_some_and(is_color_texture);
        let content = if is_color { MapContent::Light } else { map.content() };
        let numbers = images.numbers(map).unwrap_or_default();
        let is_opaque = map.channels() == 4 && numbers.as_chunks::<4>().0.iter().all(|texel| texel[3] == 1.0);
        let channels = if is_opaque { 3 } else { map.channels() };
        let known = ranges.of(map).map(<[_]>::to_vec);
        let range = known.unwrap_or_else(|| range(map, content, numbers, options));
        Self { content, channels, range }
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

    /// A number of a channel of a file of floating-point numbers: as it is, but directions as shares, as
    /// every reader of normal maps expects.
    fn float(&self, x: f32) -> f32 {
        if self.content == MapContent::Directions { 0.5 + 0.5 * x } else { x }
    }
}

/// The channels of a file: of one map, or of several that are packed.
pub struct Channels<'a> {
    pub size: [u32; 2],
    sources: Vec<Source<'a>>,
}

/// Where a channel of a file comes from.
struct Source<'a> {
    encoding: &'a Encoding,
    /// All numbers of the map.
    numbers: &'a [f32],
    /// The numbers per texel, and which of them is meant.
    stride: usize,
    channel: usize,
}

impl<'a> Channels<'a> {
    /// All channels of a map.
    pub fn of_map(map: MapKind, encoding: &'a Encoding, images: &'a Images) -> Self {
        let numbers = images.numbers(map).unwrap_or_default();
        let source = |channel| Source { encoding, numbers, stride: map.channels(), channel };
        Self { size: images.size, sources: (0..encoding.channels).map(source).collect() }
    }

    /// The first channels of several maps.
    pub fn packed(maps: &'a [(MapKind, Encoding)], images: &'a Images) -> Self {
        let source = |(map, encoding): &'a (MapKind, Encoding)| Source {
            encoding,
            numbers: images.numbers(*map).unwrap_or_default(),
            stride: map.channels(),
            channel: 0,
        };
        Self { size: images.size, sources: maps.iter().map(source).collect() }
    }

    pub fn count(&self) -> usize {
        self.sources.len()
    }

    /// The numbers as floating-point files have them.
    pub fn floats(&self) -> Vec<f32> {
        self.numbers(|source, _, x| source.encoding.float(x))
    }

    /// The codes of integers, with dithering if there is noise.
    pub fn codes<C: Channel + Sample>(&self, noise: Option<&BlueNoise>) -> Vec<C> {
        let width = self.size[0] as usize;
        let signed = self.numbers(|source, [texel, place], x| {
            let signed = source.encoding.signed(source.channel, x);
            match noise {
                Some(noise) => dithered(signed, noise.threshold([texel % width, texel / width], place)),
                None => signed,
            }
        });
        let code = |signed: f32| TexelLayout::<3>::RGB.texel::<C>([signed, 0.0, 0.0])[0];
        signed.into_iter().map(code).collect()
    }

    /// `with`: gets a source, the texel, the place of the channel, and the number.
    fn numbers(&self, with: impl Fn(&Source<'_>, [usize; 2], f32) -> f32) -> Vec<f32> {
        let texels = self.size.map(|side| side as usize).iter().product();
        let mut numbers = Vec::with_capacity(texels * self.count());
        for texel in 0..texels {
            for (place, source) in self.sources.iter().enumerate() {
                let x = source.numbers[source.stride * texel + source.channel];
                numbers.push(with(source, [texel, place], x));
            }
        }
        numbers
    }
}

/// A number from -1 to 1 that is an 8-bit code, with the threshold deciding between the two nearest.
fn dithered(signed: f32, threshold: f32) -> f32 {
    let code = (127.5 * (signed + 1.0) + threshold).floor().clamp(0.0, 255.0);
    code / 127.5 - 1.0
}

/// The most that a mean of white may have by rounding.
const MOST_OF_WHITE: f32 = 1.0 + 4.0 * f32::EPSILON;

/// What black and white mean: heights from as far inside to as far outside as rays can reach, thickness and
/// light up to the largest.
fn range(map: MapKind, content: MapContent, numbers: &[f32], options: &BakeOptions) -> Vec<[f32; 2]> {
    let largest = numbers.iter().fold(0f32, |largest, x| largest.max(x.abs()));
    match (map, content) {
        (MapKind::Height, _) => {
            let reach = options.distance[0].max(options.distance[1]).max(largest);
            vec![[-reach, reach]]
        }
        (_, MapContent::Lengths) => vec![[0.0, largest]],
        (_, MapContent::Light) => {
            let light = numbers.chunks_exact(map.channels()).flat_map(|texel| &texel[..3]);
            let brightest = light.fold(0f32, |most, x| most.max(*x));
            // Weights of corners, texels and samples sum to 1 but for their rounding, and so does white.
            let brightest = if brightest <= MOST_OF_WHITE { 1.0 } else { brightest };
            let mut range = vec![[0.0, brightest]; 3];
            range.resize(map.channels(), [0.0, 1.0]);
            range
        }
        (_, MapContent::Shares | MapContent::Labels) => vec![[0.0, 1.0]; map.channels()],
        (_, MapContent::Signed) => vec![[-1.0, 1.0]],
        _ => Vec::new(),
    }
}
