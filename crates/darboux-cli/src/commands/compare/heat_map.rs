//! Draws the angles between tangents over the UV layout, one colour per texel.

use darboux::CornerDifference;
use darboux_io::Error;
use darboux_io::gltf::PairedCorners;
use darboux_io::image::PngImage;

use super::statistics::differences;
use crate::heat_scale::{ENDS, FLIP, ramp, row, scale_position};

/// The width and height of the UV square in texels.
const SIZE: usize = 1024;
/// The height in texels of the black gap below the UV square.
const GAP: usize = 8;
/// The height in texels of the colour scale below the gap.
const SCALE: usize = 24;

const BACKGROUND: [u8; 3] = [16, 16, 16];
/// After visiting this many texels, which takes some seconds, only the corners of triangles are drawn.
const MAX_TEXELS: u64 = 1 << 30;

/// The UV square [0, 1] with v down, as in glTF images. Triangles outside it are moved into it by whole numbers.
pub struct HeatMap {
    /// The largest value per texel: an angle in degrees, or infinity for an opposite sign. `None` for an empty texel.
    worst: Vec<Option<f64>>,
    visited_texels: u64,
    too_large: usize,
}

impl HeatMap {
    pub fn new() -> Self {
        Self { worst: vec![None; SIZE * SIZE], visited_texels: 0, too_large: 0 }
    }

    /// The number of triangles of which only the corners are drawn.
    pub fn too_large(&self) -> usize {
        self.too_large
    }

    /// Draws the triangles of a primitive. A primitive without UVs is not drawn.
    pub fn draw(&mut self, corners: &PairedCorners) {
        let uvs = corners.uvs.as_deref().unwrap_or_default().as_chunks::<3>().0;
        let differences: Vec<CornerDifference> = differences(corners).collect();
        for (uvs, differences) in uvs.iter().zip(differences.as_chunks::<3>().0) {
            let flips = differences.iter().any(|difference| difference.flips_sign);
            let values = if flips { [f64::INFINITY; 3] } else { differences.map(value) };
            self.triangle(uvs.map(|uv| uv.map(f64::from)), values);
        }
    }

    fn triangle(&mut self, uvs: [[f64; 2]; 3], values: [f64; 3]) {
        if !uvs.as_flattened().iter().all(|x| x.is_finite()) {
            return;
        }
        let least = [0, 1].map(|i| uvs.iter().map(|uv| uv[i]).fold(f64::INFINITY, f64::min));
        // The corners in texels, relative to the tile of the smallest coordinates. The centres of texels are at halves.
        let points = uvs.map(|uv| [0, 1].map(|i| (uv[i] - least[i].floor()) * SIZE as f64));
        // A triangle smaller than a texel may cover no centre, so its corners are drawn as well.
        for (point, value) in points.iter().zip(values) {
            self.mark(point.map(|x| x as usize), value);
        }
        let [from, to] = bounds(points);
        let texels = ((to[0] - from[0]) * (to[1] - from[1])) as u64;
        if (0..2).any(|i| to[i] - from[i] > SIZE as f64)
            || self.visited_texels.saturating_add(texels) > MAX_TEXELS
        {
            self.too_large += 1;
            return;
        }
        self.visited_texels += texels;
        for y in from[1] as usize..to[1] as usize {
            for x in from[0] as usize..to[0] as usize {
                if let Some(weights) = weights(points, [x as f64 + 0.5, y as f64 + 0.5]) {
                    let value = (0..3).filter(|&i| weights[i] > 0.0).map(|i| weights[i] * values[i]).sum();
                    self.mark([x, y], value);
                }
            }
        }
    }

    /// Draws a texel of any tile; the largest value stays.
    fn mark(&mut self, [x, y]: [usize; 2], value: f64) {
        let texel = &mut self.worst[y % SIZE * SIZE + x % SIZE];
        *texel = Some(texel.map_or(value, |worst| worst.max(value)));
    }

    /// The picture with the colour scale below it.
    pub fn image(&self, name: &str) -> Result<PngImage, Error> {
        let mut texels: Vec<[u8; 3]> =
            self.worst.iter().map(|worst| worst.map_or(BACKGROUND, colour)).collect();
        texels.resize(SIZE * (SIZE + GAP), [0; 3]);
        let row = row(SIZE);
        (0..SCALE).for_each(|_| texels.extend_from_slice(&row));
        PngImage::from_rgb(name, [SIZE as u32, (SIZE + GAP + SCALE) as u32], &texels)
    }
}

/// The angle. Without an angle: 0 for identical tangents, the largest angle for others.
fn value(difference: CornerDifference) -> f64 {
    difference.angle.unwrap_or(if difference.is_identical { 0.0 } else { ENDS[1] })
}

/// The bounding box of a triangle in whole texels: minimum and maximum.
fn bounds(points: [[f64; 2]; 3]) -> [[f64; 2]; 2] {
    let fold =
        |i: usize, start: f64, f: fn(f64, f64) -> f64| points.iter().map(|point| point[i]).fold(start, f);
    [
        [0, 1].map(|i| fold(i, f64::INFINITY, f64::min).floor()),
        [0, 1].map(|i| fold(i, f64::NEG_INFINITY, f64::max).ceil()),
    ]
}

/// The barycentric coordinates of a point inside the triangle or on its edges; `None` outside and for triangles without area.
fn weights([p, q, r]: [[f64; 2]; 3], at: [f64; 2]) -> Option<[f64; 3]> {
    let area =
        |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let whole = area(p, q, r);
    let weights = [area(at, q, r), area(p, at, r), area(p, q, at)].map(|part| part / whole);
    weights.iter().all(|weight| *weight >= 0.0).then_some(weights)
}

fn colour(degrees: f64) -> [u8; 3] {
    if degrees == f64::INFINITY { FLIP } else { ramp(scale_position(degrees)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(uvs: [[f32; 2]; 3], angle: f32) -> HeatMap {
        let turned = [angle.to_radians().cos(), angle.to_radians().sin(), 0.0, 1.0];
        let corners = PairedCorners {
            positions: vec![[0.0; 3]; 3],
            uvs: Some(uvs.to_vec()),
            tangents: [vec![[1.0, 0.0, 0.0, 1.0]; 3], vec![turned; 3]],
            moved: 0,
        };
        let mut map = HeatMap::new();
        map.draw(&corners);
        map
    }

    #[test]
    fn half_of_the_square_is_half_of_the_texels() {
        let map = drawn([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], 10.0);
        let marked = map.worst.iter().flatten().count() as f64;
        assert!((marked / (SIZE * SIZE) as f64 - 0.5).abs() < 1e-3);
        let all_ten = map.worst.iter().flatten().all(|angle| (angle - 10.0).abs() < 1e-4);
        assert!(all_ten && map.worst[SIZE * SIZE - 1].is_none());
    }

    #[test]
    fn other_tiles_fall_onto_the_first_and_large_triangles_keep_their_corners() {
        let here = drawn([[0.1, 0.1], [0.6, 0.2], [0.3, 0.7]], 10.0);
        let there = drawn([[-2.9, 4.1], [-2.4, 4.2], [-2.7, 4.7]], 10.0);
        let differ = here.worst.iter().zip(&there.worst).filter(|(a, b)| a.is_some() != b.is_some()).count();
        assert!(differ < 200, "{differ} texels differ, which is more than rounding at the edges");
        let large = drawn([[0.5, 0.5], [9.0, 0.5], [0.5, 3.0]], 10.0);
        assert_eq!(large.too_large(), 1);
        assert!((1..=3).contains(&large.worst.iter().flatten().count()));
        assert_eq!(drawn([[f32::NAN, 0.0], [1.0, 0.0], [0.0, 1.0]], 10.0).worst.iter().flatten().count(), 0);
        assert_eq!(drawn([[f32::MAX, 0.0], [f32::MIN, 0.0], [0.0, 1.0]], 10.0).too_large(), 1);
    }
}
