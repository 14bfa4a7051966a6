//! Which texels a bilinear filter mixes at a place of an image that repeats, is mirrored, or ends.

use darboux_io::gltf::Wrap;

/// The two texels along an axis that a filter mixes, and the share of the second.
pub struct Mix {
    pub texels: [usize; 2],
    share: f64,
}

impl Mix {
    /// `place`: in texels; texel i has its centre at i + 0.5.
    pub fn of(place: f64, size: usize, wrap: Wrap) -> Self {
        let first = (place - 0.5).floor();
        Self {
            texels: [first, first + 1.0].map(|texel| wrapped(texel, size, wrap)),
            share: place - 0.5 - first,
        }
    }

    /// The mean of what the two texels have, by their shares.
    pub fn mixed<const N: usize>(&self, [a, b]: [[f64; N]; 2]) -> [f64; N] {
        std::array::from_fn(|i| (1.0 - self.share) * a[i] + self.share * b[i])
    }
}

/// The texel of the image that a whole number stands for.
fn wrapped(texel: f64, size: usize, wrap: Wrap) -> usize {
    let last = size as f64 - 1.0;
    let place = match wrap {
        Wrap::Clamp => texel.clamp(0.0, last),
        Wrap::Repeat => texel.rem_euclid(size as f64),
        Wrap::Mirror => {
            let place = texel.rem_euclid(2.0 * size as f64);
            place.min(2.0 * size as f64 - 1.0 - place)
        }
    };
    place.min(last) as usize
}
