//! The channels of an image that hold a vector, named by their letters.

use std::fmt;
use std::str::FromStr;

use png::ColorType;

/// The channels of x, y and, if it is stored, z: `rgb`, `rg`, `ag` (x in alpha, y in green), `la` (grey and
/// alpha) and so on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Channels {
    x: PngChannel,
    y: PngChannel,
    z: Option<PngChannel>,
}

/// A channel of a PNG.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum PngChannel {
    Grey,
    Red,
    Green,
    Blue,
    Alpha,
}

/// The error of a text that does not name channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "name the channels of x, y and, if it is stored, z by two or three different letters of r, g, b, a, or la"
)]
pub struct ChannelsError;

impl Channels {
    /// x, y and z in red, green and blue.
    pub const RGB: Self = Self { x: PngChannel::Red, y: PngChannel::Green, z: Some(PngChannel::Blue) };

    fn letters(self) -> impl Iterator<Item = PngChannel> {
        [self.x, self.y].into_iter().chain(self.z)
    }

    /// The indices of the channels in texels of this kind; none if one is missing.
    pub(super) fn indices(self, color: ColorType) -> Option<(usize, usize, Option<usize>)> {
        let index = |letter: PngChannel| letters(color).find(letter.char());
        let z = self.z.map(index);
        Some((index(self.x)?, index(self.y)?, if z == Some(None) { return None } else { z.flatten() }))
    }

    /// The kind of texels that has these channels: `color` if possible, else the smallest one.
    pub(super) fn kind(self, color: ColorType) -> ColorType {
        let has_all = |color: &ColorType| self.indices(*color).is_some();
        let kinds = [color, ColorType::Rgb, ColorType::Rgba, ColorType::GrayscaleAlpha];
        kinds.into_iter().find(has_all).unwrap_or(ColorType::Rgba)
    }
}

/// The channel letters of a kind of texels.
pub(super) fn letters(color: ColorType) -> &'static str {
    match color {
        ColorType::Rgb => "rgb",
        ColorType::Rgba => "rgba",
        ColorType::GrayscaleAlpha => "la",
        ColorType::Grayscale | ColorType::Indexed => "l",
    }
}

impl PngChannel {
    const ALL: [Self; 5] = [Self::Grey, Self::Red, Self::Green, Self::Blue, Self::Alpha];

    fn char(self) -> char {
        match self {
            Self::Grey => 'l',
            Self::Red => 'r',
            Self::Green => 'g',
            Self::Blue => 'b',
            Self::Alpha => 'a',
        }
    }
}

impl FromStr for Channels {
    type Err = ChannelsError;

    fn from_str(text: &str) -> Result<Self, ChannelsError> {
        let letters =
            text.chars().map(|char| PngChannel::ALL.into_iter().find(|letter| letter.char() == char));
        let letters: Vec<PngChannel> = letters.collect::<Option<_>>().ok_or(ChannelsError)?;
        let channels = match letters[..] {
            [x, y] => Self { x, y, z: None },
            [x, y, z] => Self { x, y, z: Some(z) },
            _ => return Err(ChannelsError),
        };
        let kinds = [ColorType::Rgba, ColorType::GrayscaleAlpha];
        let exists = kinds.into_iter().any(|kind| channels.indices(kind).is_some());
        let differ =
            channels.x != channels.y && Some(channels.x) != channels.z && Some(channels.y) != channels.z;
        if exists && differ { Ok(channels) } else { Err(ChannelsError) }
    }
}

impl fmt::Display for Channels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.letters().try_for_each(|letter| write!(f, "{}", letter.char()))
    }
}
