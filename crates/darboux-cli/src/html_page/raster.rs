//! Pictures in a page.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use darboux_io::image::PngImage;

/// Pixels in sRGB, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    /// The width and height in pixels.
    pub size: [u32; 2],
    pub pixels: Vec<[u8; 3]>,
}

impl Raster {
    /// The mean colours of squares of `side` pixels; those at the right and lower border may be cut.
    pub fn reduced(&self, side: u32) -> Self {
        let size = self.size.map(|length| length.div_ceil(side));
        let mean = |x: u32, y: u32| {
            let [right, bottom] = [0, 1].map(|i| (side * ([x, y][i] + 1)).min(self.size[i]));
            let rows = side * y..bottom;
            let in_square = rows.flat_map(|row| {
                let start = (row * self.size[0]) as usize;
                &self.pixels[start + (side * x) as usize..start + right as usize]
            });
            let (mut sums, mut count) = ([0u32; 3], 0);
            for pixel in in_square {
                (0..3).for_each(|channel| sums[channel] += u32::from(pixel[channel]));
                count += 1;
            }
            sums.map(|sum| (sum / count) as u8)
        };
        let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| mean(x, y))).collect();
        Self { size, pixels }
    }

    /// The picture with no side longer than `most` pixels.
    #[cfg(feature = "bake")]
    pub fn at_most(self, most: u32) -> Self {
        match self.size[0].max(self.size[1]).div_ceil(most) {
            0 | 1 => self,
            side => self.reduced(side),
        }
    }

    /// The address that holds the picture as a PNG. Errors: one sentence.
    pub fn address(&self) -> Result<String, String> {
        let image = PngImage::from_rgb("the picture", self.size, &self.pixels);
        let bytes = image.and_then(|image| image.to_bytes()).map_err(|error| error.to_string())?;
        Ok(format!("data:image/png;base64,{}", STANDARD.encode(bytes)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_have_the_mean_of_their_pixels_also_at_the_borders() {
        let grey = |x: u8| [x, 0, 255];
        let pixels = [10, 20, 30, 40, 50, 60].map(grey).to_vec();
        let raster = Raster { size: [3, 2], pixels };
        let half = raster.reduced(2);
        assert_eq!((half.size, half.pixels), ([2, 1], [30, 45].map(grey).to_vec()));
        assert_eq!(raster.clone().at_most(3), raster);
        assert_eq!(raster.at_most(2).size, [2, 1]);
    }
}
