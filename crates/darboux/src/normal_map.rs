//! Texels of normal maps: channels inverted, moved, and z rebuilt.
//!
//! A channel c of n bits stands for 2 c / (2^n - 1) - 1 (glTF 2.0, 3.9.3; unsigned normalized formats of every API). No c stands for
//! zero, and the 128 of a flat 8-bit texel leans by 1/255: an inverted flat map has 127 there, and that is right, since c and
//! 2^n - 1 - c are exact opposites and inverting twice gives the first texel back. Tools that read 128 as zero, (c - 128) / 127, have
//! no opposite for 0.

use crate::Conversion;

/// A channel of a texel: `u8` or `u16`.
pub trait Channel: Copy + sealed::Channel {}

impl Channel for u8 {}
impl Channel for u16 {}

mod sealed {
    pub trait Channel {
        const LARGEST: Self;
        fn inverted(self) -> Self;
        fn component(self) -> f64;
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

            fn nearest(component: f64) -> Self {
                ((component + 1.0) / 2.0 * f64::from(Self::MAX)).round() as Self
            }
        }
    )*};
}

channel!(u8 u16);

/// Which of a texel's `N` channels hold the vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TexelLayout<const N: usize> {
    x: usize,
    y: usize,
    z: Option<usize>,
}

impl TexelLayout<2> {
    /// x and y, z rebuilt: BC5, EAC RG, 3Dc.
    pub const RG: Self = Self { x: 0, y: 1, z: None };
}

impl TexelLayout<3> {
    /// x, y and z.
    pub const RGB: Self = Self { x: 0, y: 1, z: Some(2) };
}

impl TexelLayout<4> {
    /// x, y and z; alpha is something else.
    pub const RGBA: Self = Self { x: 0, y: 1, z: Some(2) };
    /// x in alpha, y in green, z rebuilt: "DXT5nm", whose alpha and green are the finest channels of BC3.
    pub const AG: Self = Self { x: 3, y: 1, z: None };
}

impl<const N: usize> TexelLayout<N> {
    /// The vector's components by channel, or none where two share one or a channel is not there.
    pub fn new(x: usize, y: usize, z: Option<usize>) -> Option<Self> {
        let is_free = |z: usize| z < N && z != x && z != y;
        (x < N && y < N && x != y && z.is_none_or(is_free)).then_some(Self { x, y, z })
    }

    fn holds(&self, channel: usize) -> bool {
        channel == self.x || channel == self.y || Some(channel) == self.z
    }

    /// The vector of a texel, as stored: unit to rounding at best. Where z is not stored, it is rebuilt.
    pub fn vector<C: Channel>(&self, texel: [C; N]) -> [f32; 3] {
        let [x, y] = [texel[self.x].component(), texel[self.y].component()];
        let z = self.z.map_or_else(|| rebuilt(x, y), |z| texel[z].component());
        [x, y, z].map(|component| component as f32)
    }

    /// Whether a texel can be a normal of a tangent-space map: about unit length, as filters and rounding leave it, and not below the
    /// surface. Where z is not stored, whether x and y leave room for it.
    pub fn holds_normal<C: Channel>(&self, texel: [C; N]) -> bool {
        let [x, y, z] = self.vector(texel);
        let length = (x * x + y * y + z * z).sqrt();
        (0.5..=1.2).contains(&length) && z >= -0.1
    }
}

impl Conversion {
    /// A normal map in the other convention. The picture stays upright: what moves is where red and green lean.
    pub fn texels<C: Channel, const N: usize>(&self, layout: TexelLayout<N>, texels: &mut [[C; N]]) {
        let channels = [(self.inverts_red(), layout.x), (self.inverts_green(), layout.y)];
        for (_, channel) in channels.into_iter().filter(|(inverts, _)| *inverts) {
            for texel in texels.iter_mut() {
                texel[channel] = texel[channel].inverted();
            }
        }
    }
}

/// A normal map with the same x and y in other channels, to the bit; z the same or, where `from` has none, rebuilt.
///
/// Channels of `to` without a component keep what is in that channel now, or are at their largest where a component was in it.
/// Dropping z and rebuilding it gives z back where texels are unit to rounding; others change their direction.
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

/// The z >= 0 of the unit vector with this x and y; 0 where they alone are longer than 1.
fn rebuilt(x: f64, y: f64) -> f64 {
    (1.0 - x * x - y * y).max(0.0).sqrt()
}
