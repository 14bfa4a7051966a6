//! Texels of normal maps: inverts channels, moves channels, and reconstructs z.
//!
//! An n-bit code c decodes to 2 c / (2^n - 1) - 1 (glTF 2.0, 3.9.3; unsigned normalized formats of all APIs).
//! No code decodes to zero: the 128 of a flat 8-bit texel is 1/255. Inversion maps c to 2^n - 1 - c, its
//! exact negation, so that inverting twice restores the texel and 128 becomes 127. Tools that decode 128 as
//! zero, by (c - 128) / 127, have no negation of code 0.

use crate::Conversion;

/// The type of a texel's channels: `u8` or `u16`.
pub trait Channel: Copy + sealed::Channel {}

impl Channel for u8 {}
impl Channel for u16 {}

mod sealed {
    pub trait Channel {
        const LARGEST: Self;
        fn inverted(self) -> Self;
        fn component(self) -> f64;
        /// The component, to six digits.
        fn component_f32(self) -> f32;
        /// The highest eight bits.
        fn byte(self) -> u8;
        fn nearest(component: f64) -> Self;
    }
}

macro_rules! channel {
    ($($integer:ty)*) => {$(
        impl sealed::Channel for $integer {
            const LARGEST: Self = Self::MAX;

            fn inverted(self) -> Self {
                Self::MAX - self
            }

            fn component(self) -> f64 {
                2.0 * f64::from(self) / f64::from(Self::MAX) - 1.0
            }

            #[inline(always)]
            fn component_f32(self) -> f32 {
                f32::from(self) * (2.0 / Self::MAX as f32) - 1.0
            }

            #[inline(always)]
            fn byte(self) -> u8 {
                (self >> (Self::BITS - 8)) as u8
            }

            fn nearest(component: f64) -> Self {
                ((component + 1.0) / 2.0 * f64::from(Self::MAX)).round() as Self
            }
        }
    )*};
}

channel!(u8 u16);

/// The channels of an `N`-channel texel that store the components of the vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TexelLayout<const N: usize> {
    pub(super) x: usize,
    pub(super) y: usize,
    pub(super) z: Option<usize>,
}

impl TexelLayout<2> {
    /// x and y; z is reconstructed. BC5, EAC RG, 3Dc.
    pub const RG: Self = Self { x: 0, y: 1, z: None };
}

impl TexelLayout<3> {
    /// x, y and z.
    pub const RGB: Self = Self { x: 0, y: 1, z: Some(2) };
}

impl TexelLayout<4> {
    /// x, y and z; alpha is not part of the vector.
    pub const RGBA: Self = Self { x: 0, y: 1, z: Some(2) };
    /// x in alpha and y in green; z is reconstructed. "DXT5nm": alpha and green are the most precise channels
    /// of BC3.
    pub const AG: Self = Self { x: 3, y: 1, z: None };
}

impl<const N: usize> TexelLayout<N> {
    /// The layout with the given channels of x, y and z. `None` where two components share a channel or a
    /// channel is not below `N`.
    pub fn new(x: usize, y: usize, z: Option<usize>) -> Option<Self> {
        let is_free = |z: usize| z < N && z != x && z != y;
        (x < N && y < N && x != y && z.is_none_or(is_free)).then_some(Self { x, y, z })
    }

    fn holds(&self, channel: usize) -> bool {
        channel == self.x || channel == self.y || Some(channel) == self.z
    }

    /// Decodes the vector of a texel. Not normalised. A z that is not stored is reconstructed.
    pub fn vector<C: Channel>(&self, texel: [C; N]) -> [f32; 3] {
        let [x, y] = [texel[self.x].component(), texel[self.y].component()];
        let z = self.z.map_or_else(|| rebuilt(x, y), |z| texel[z].component());
        [x, y, z].map(|component| component as f32)
    }

    /// Encodes a vector with components from -1 to 1, each as the nearest code. Channels without a component
    /// have the maximum value.
    pub fn texel<C: Channel>(&self, [x, y, z]: [f32; 3]) -> [C; N] {
        let mut texel = [C::LARGEST; N];
        texel[self.x] = C::nearest(f64::from(x));
        texel[self.y] = C::nearest(f64::from(y));
        if let Some(channel) = self.z {
            texel[channel] = C::nearest(f64::from(z));
        }
        texel
    }

    /// True when a texel can be a normal of a tangent-space map: its length is in [0.5, 1.2], as filtering
    /// and rounding leave it, and z is at least -0.1.
    pub fn holds_normal<C: Channel>(&self, texel: [C; N]) -> bool {
        let [x, y, z] = self.vector(texel);
        can_be_normal((x * x + y * y + z * z).sqrt(), z)
    }
}

/// Whether a vector of this length and z can be a normal of a tangent-space map.
#[inline(always)]
pub(super) fn can_be_normal(length: f32, z: f32) -> bool {
    (0.5..=1.2).contains(&length) & (z >= -0.1)
}

impl Conversion {
    /// Converts the texels of a normal map in place: inverts red and green as the conventions require. The
    /// image is not flipped.
    pub fn texels<C: Channel, const N: usize>(&self, layout: TexelLayout<N>, texels: &mut [[C; N]]) {
        let channels = [(self.inverts_red(), layout.x), (self.inverts_green(), layout.y)];
        for (_, channel) in channels.into_iter().filter(|(inverts, _)| *inverts) {
            for texel in texels.iter_mut() {
                texel[channel] = texel[channel].inverted();
            }
        }
    }
}

/// Moves the components of a normal map to other channels.
///
/// x and y keep their bits. z keeps its bits, or is reconstructed where `from` does not store it. A channel
/// of `to` without a component keeps the value of that channel, or has the maximum value where `from` stored
/// a component in it. Reconstructing a z that was dropped restores it for unit vectors; other vectors change
/// their direction.
pub fn repack_texels<C: Channel, const N: usize, const M: usize>(
    texels: &[[C; N]],
    from: TexelLayout<N>,
    to: TexelLayout<M>,
) -> Vec<[C; M]> {
    let repack = |texel: &[C; N]| {
        let mut out = [C::LARGEST; M];
        for (channel, value) in
            out.iter_mut().enumerate().take(N).filter(|(channel, _)| !from.holds(*channel))
        {
            *value = texel[channel];
        }
        out[to.x] = texel[from.x];
        out[to.y] = texel[from.y];
        if let Some(z) = to.z {
            let rebuild = || C::nearest(rebuilt(texel[from.x].component(), texel[from.y].component()));
            out[z] = from.z.map_or_else(rebuild, |z| texel[z]);
        }
        out
    };
    texels.iter().map(repack).collect()
}

/// The z >= 0 of the unit vector with this x and y. 0 where the length of (x, y) exceeds 1.
fn rebuilt(x: f64, y: f64) -> f64 {
    (1.0 - x * x - y * y).max(0.0).sqrt()
}
