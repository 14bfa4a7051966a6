//! Computes the mip levels of a texture.

use darboux_io::image::RgbaImage;

/// The image at half its width and height, each rounded down and at least 1.
///
/// A triangle filter as wide as four texels of the image, first along columns, then along rows.
pub fn halved(image: &RgbaImage) -> RgbaImage {
    let [width, height] = [image.width, image.height].map(|texels| (texels / 2).max(1));
    let (columns, rows) = (taps(image.width, width), taps(image.height, height));
    let mut texels = Vec::with_capacity(columns.len() * rows.len());
    for row in &rows {
        let blended: Vec<[f32; 4]> = (0..image.width as usize)
            .map(|x| row.sum(|y| image.texels[y * image.width as usize + x].map(f32::from)))
            .collect();
        let filtered = columns.iter().map(|column| column.sum(|x| blended[x]));
        texels.extend(filtered.map(|texel| texel.map(|channel| channel.clamp(0.0, 255.0).round() as u8)));
    }
    RgbaImage { width, height, texels }
}

/// The texels of a row or column that one texel of the smaller image is computed from.
struct Taps {
    first: usize,
    /// The weights of the texels, starting at `first`. Their sum is 1.
    weights: Vec<f32>,
}

impl Taps {
    fn sum(&self, texel: impl Fn(usize) -> [f32; 4]) -> [f32; 4] {
        let mut sum = [0.0; 4];
        for (i, weight) in self.weights.iter().enumerate() {
            sum.iter_mut().zip(texel(self.first + i)).for_each(|(sum, channel)| *sum += channel * weight);
        }
        sum
    }
}

/// The taps of every texel when `from` texels are reduced to `to`.
fn taps(from: u32, to: u32) -> Vec<Taps> {
    if from == to {
        return (0..to as usize).map(|first| Taps { first, weights: vec![1.0] }).collect();
    }
    let ratio = from as f32 / to as f32;
    let tap = |at: u32| {
        let center = (at as f32 + 0.5) * ratio;
        let first = (center - ratio).floor().max(0.0) as usize;
        let end = ((center + ratio).ceil() as usize).min(from as usize);
        let weight = |i: usize| (1.0 - ((i as f32 - (center - 0.5)) / ratio).abs()).max(0.0);
        let sum: f32 = (first..end).map(weight).sum();
        Taps { first, weights: (first..end).map(|i| weight(i) / sum).collect() }
    };
    (0..to).map(tap).collect()
}

#[cfg(test)]
mod tests {
    use darboux_dice::Dice;
    use image::imageops::{self, FilterType};

    use super::*;

    /// The `image` crate's triangle filter gives the same texels.
    #[test]
    fn halves_are_those_of_the_image_crate() {
        for [width, height] in [[8, 8], [7, 5], [1, 9], [2, 1], [33, 2]] {
            let mut dice = Dice::from_seed(7);
            let texels: Vec<[u8; 4]> = (0..width * height).map(|_| dice.word().to_le_bytes()).collect();
            let half = halved(&RgbaImage { width, height, texels: texels.clone() });
            let image = image::RgbaImage::from_raw(width, height, texels.into_flattened()).unwrap();
            let expected = imageops::resize(&image, half.width, half.height, FilterType::Triangle);
            assert_eq!(half.texels.as_flattened(), expected.as_raw(), "{width} x {height}");
        }
    }
}
