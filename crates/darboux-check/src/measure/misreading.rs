//! [`Misreading`]: what a renderer that reads x, y and z makes of a map that has x and y only.

use darboux_io::image::RgbaImage;

use crate::severity::SEEN;

/// The angles between the vectors that a renderer reads from red, green and blue and those that two channels
/// mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Misreading {
    /// Their root mean square, in degrees.
    pub typical: f64,
    /// In percent of the texels, each weighted as surfaces are ([`crate::damage`]): by its angle over 90
    /// degrees, from [`SEEN`] on.
    pub damaged: f64,
}

impl Misreading {
    /// About so many texels are compared: every n-th one.
    const TEXELS: usize = 1 << 20;

    /// `x_and_y`: the channels that mean x and y.
    pub fn of(image: &RgbaImage, x_and_y: [usize; 2]) -> Self {
        let (mut squares, mut damaged, mut count) = (0.0, 0.0, 0.0f64);
        // An odd step visits all columns of an image whose width is a power of two.
        for texel in image.texels.iter().step_by((image.texels.len() / Self::TEXELS) | 1) {
            if is_background(x_and_y.map(|channel| texel[channel])) {
                continue;
            }
            let coordinate = |channel: usize| f64::from(texel[channel]) / 127.5 - 1.0;
            let [x, y] = x_and_y.map(coordinate);
            let z = (1.0 - x * x - y * y).max(0.0).sqrt();
            let degrees = angle([0, 1, 2].map(coordinate), [x, y, z]);
            squares += degrees * degrees;
            damaged += if degrees < SEEN { 0.0 } else { (degrees / 90.0).min(1.0) };
            count += 1.0;
        }
        let count = count.max(1.0);
        Self { typical: (squares / count).sqrt(), damaged: 100.0 * damaged / count }
    }
}

/// Whether a texel is background: both channels have the lowest code or the highest one.
fn is_background([x, y]: [u8; 2]) -> bool {
    x == y && (x == 0 || x == 255)
}

/// The angle between two vectors, in degrees.
fn angle(a: [f64; 3], b: [f64; 3]) -> f64 {
    let dot: f64 = (0..3).map(|i| a[i] * b[i]).sum();
    let cross = |i: usize| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    let sine = (0..3).map(|i| cross(i) * cross(i)).sum::<f64>().sqrt();
    sine.atan2(dot).to_degrees()
}
