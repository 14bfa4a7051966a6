//! Draws the angles between tangents over the UV layout, one colour per texel.

use std::cmp::Ordering;

use darboux::CornerDifference;
use darboux_io::Error;
use darboux_io::gltf::PairedCorners;
use darboux_io::image::PngImage;

use super::statistics::difference;
use crate::heat_scale::{ENDS, FLIP, HeatRange, ramp, scale_position};

/// The width and height of the UV square in texels.
const SIZE: usize = 1024;
/// The height in texels of the black gap below the UV square.
const GAP: usize = 8;

const BACKGROUND: [u8; 3] = [16, 16, 16];
const STRIPE: [u8; 3] = [255, 255, 255];
/// After visiting this many texels, which takes about a second, only the corners of triangles are drawn.
const MAX_TEXELS: u64 = 1 << 26;
/// Texels per side of a tile, which is skipped once all of its values are greater than a triangle's values.
const TILE: usize = 32;
/// Tiles per side of the UV square.
const TILES: usize = SIZE / TILE;

/// The UV square [0, 1] with v down, as in glTF images. Triangles outside it are moved into it by whole
/// numbers.
///
/// The triangles with the greatest values are drawn first, and equal ones once, so that triangles that lie
/// over each other by the thousand, as in trim sheets and tiled parts, find their tiles filled.
pub struct HeatMap {
    triangles: Vec<Triangle>,
    /// The largest value per texel: an angle in degrees, or infinity for an opposite sign. `None` for an
    /// empty texel.
    worst: Vec<Option<f64>>,
    /// A value per tile that none of its texels is below.
    least: Vec<Option<f64>>,
    /// The texels visited per tile since that value was found.
    visited_since: Vec<usize>,
    visited_texels: u64,
    too_large: usize,
}

/// A triangle in the tile of its smallest coordinates, in texels. The centres of texels are at halves.
#[derive(Clone, Copy)]
struct Triangle {
    points: [[f64; 2]; 3],
    values: [f64; 3],
}

impl Triangle {
    /// None for coordinates that are not finite.
    fn new(uvs: [[f64; 2]; 3], values: [f64; 3]) -> Option<Self> {
        let least = [0, 1].map(|i| uvs.iter().map(|uv| uv[i]).fold(f64::INFINITY, f64::min));
        let points = uvs.map(|uv| [0, 1].map(|i| (uv[i] - least[i].floor()) * SIZE as f64));
        uvs.as_flattened().iter().all(|x| x.is_finite()).then_some(Self { points, values })
    }

    fn greatest(&self) -> f64 {
        self.values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
    }

    /// The value at the centre of a texel inside the triangle.
    fn value_at(&self, [x, y]: [usize; 2]) -> Option<f64> {
        let weights = weights(self.points, [x as f64 + 0.5, y as f64 + 0.5])?;
        Some((0..3).filter(|&i| weights[i] > 0.0).map(|i| weights[i] * self.values[i]).sum())
    }

    /// The greatest value first; equal triangles side by side.
    fn order(&self, other: &Self) -> Ordering {
        let numbers = |triangle: &Self| -> [f64; 9] {
            let [[a, b], [c, d], [e, f]] = triangle.points;
            let [x, y, z] = triangle.values;
            [a, b, c, d, e, f, x, y, z]
        };
        let pairs = numbers(self).into_iter().zip(numbers(other));
        let by_numbers = || pairs.map(|(a, b)| a.total_cmp(&b)).find(|order| order.is_ne());
        let by_value = other.greatest().total_cmp(&self.greatest());
        by_value.then_with(|| by_numbers().unwrap_or(Ordering::Equal))
    }
}

impl HeatMap {
    pub fn new() -> Self {
        Self {
            triangles: Vec::new(),
            worst: vec![None; SIZE * SIZE],
            least: vec![None; TILES * TILES],
            visited_since: vec![0; TILES * TILES],
            visited_texels: 0,
            too_large: 0,
        }
    }

    /// The number of triangles that are drawn as their corners only.
    pub fn too_large(&self) -> usize {
        self.too_large
    }

    /// Adds the triangles of a primitive. A primitive without UVs is not drawn.
    pub fn add(&mut self, corners: &PairedCorners<'_>) {
        for triangle in 0..corners.len() / 3 {
            let places = [0, 1, 2].map(|i| 3 * triangle + i);
            let [Some(a), Some(b), Some(c)] = places.map(|corner| corners.uv(corner)) else { continue };
            let (uvs, differences) = ([a, b, c], places.map(|corner| difference(corners, corner)));
            let flips = differences.iter().any(|difference| difference.flips_sign);
            let values = if flips { [f64::INFINITY; 3] } else { differences.map(value) };
            self.triangles.extend(Triangle::new(uvs.map(|uv| uv.map(f64::from)), values));
        }
    }

    /// Draws the triangles that were added.
    pub fn draw(&mut self) {
        let mut triangles = std::mem::take(&mut self.triangles);
        triangles.sort_unstable_by(Triangle::order);
        triangles.dedup_by(|a, b| a.order(b).is_eq());
        triangles.iter().for_each(|triangle| self.triangle(triangle));
    }

    fn triangle(&mut self, triangle: &Triangle) {
        // A triangle smaller than a texel may cover no centre, so its corners are drawn as well.
        for (point, value) in triangle.points.iter().zip(triangle.values) {
            self.mark(point.map(|x| x as usize), value);
        }
        let [from, to] = bounds(triangle.points);
        if (0..2).any(|i| to[i] - from[i] > SIZE as f64) || self.visited_texels >= MAX_TEXELS {
            self.too_large += 1;
            return;
        }
        let [from, to] = [from, to].map(|end| end.map(|x| x as usize));
        for row in from[1] / TILE..to[1].div_ceil(TILE) {
            for column in from[0] / TILE..to[0].div_ceil(TILE) {
                let tile = [column * TILE, row * TILE];
                let from = [0, 1].map(|i| from[i].max(tile[i]));
                let to = [0, 1].map(|i| to[i].min(tile[i] + TILE));
                self.part_of_tile(triangle, row % TILES * TILES + column % TILES, from, to);
            }
        }
    }

    /// Draws the part of a triangle in a tile, unless all values there are at least as great.
    fn part_of_tile(&mut self, triangle: &Triangle, tile: usize, from: [usize; 2], to: [usize; 2]) {
        if self.least[tile].is_some_and(|least| least >= triangle.greatest()) {
            return;
        }
        for y in from[1]..to[1] {
            for x in from[0]..to[0] {
                if let Some(value) = triangle.value_at([x, y]) {
                    self.mark([x, y], value);
                }
            }
        }
        let visited = (to[0] - from[0]) * (to[1] - from[1]);
        self.visited_texels += visited as u64;
        self.visited_since[tile] += visited;
        if self.visited_since[tile] < TILE * TILE {
            return;
        }
        self.visited_since[tile] = 0;
        let first = tile / TILES * TILE * SIZE + tile % TILES * TILE;
        let texels = (0..TILE).flat_map(|y| &self.worst[first + y * SIZE..][..TILE]);
        let least = texels.map(|texel| texel.unwrap_or(f64::NEG_INFINITY)).fold(f64::INFINITY, f64::min);
        self.least[tile] = Some(least);
    }

    /// Draws a texel of any tile; the largest value stays.
    fn mark(&mut self, [x, y]: [usize; 2], value: f64) {
        let texel = &mut self.worst[y % SIZE * SIZE + x % SIZE];
        *texel = Some(texel.map_or(value, |worst| worst.max(value)));
    }

    /// The picture with the colour scale and its numbers below it.
    pub fn image(&self, name: &str) -> Result<PngImage, Error> {
        let color = |(at, worst): (usize, &Option<f64>)| match worst {
            None => BACKGROUND,
            // Stripes tell opposite signs from angles without the hue.
            Some(degrees) if degrees.is_infinite() && (at % SIZE + at / SIZE) % 8 < 3 => STRIPE,
            Some(degrees) => colour(*degrees),
        };
        let mut texels: Vec<[u8; 3]> = self.worst.iter().enumerate().map(color).collect();
        texels.resize(SIZE * (SIZE + GAP), [0; 3]);
        texels.extend(HeatRange::WHOLE.rows(SIZE).concat());
        PngImage::from_rgb(name, [SIZE as u32, (texels.len() / SIZE) as u32], &texels)
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

/// The barycentric coordinates of a point inside the triangle or on its edges; `None` outside and for
/// triangles without area.
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
            vertices: vec![0, 1, 2],
            uvs: Some(uvs.to_vec().into()),
            tangents: [vec![[1.0, 0.0, 0.0, 1.0]; 3].into(), vec![turned; 3].into()],
            ..PairedCorners::default()
        };
        let mut map = HeatMap::new();
        map.add(&corners);
        map.draw();
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
    fn triangles_over_each_other_show_the_greatest_values_and_find_their_tiles_filled() {
        let mut map = HeatMap::new();
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        for degrees in (0..2000).map(|i| f64::from(i * 7 % 2000) / 100.0) {
            for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
                map.triangles.extend(Triangle::new([a, b, c].map(|i| square[i]), [degrees; 3]));
            }
        }
        map.draw();
        assert!(map.worst.iter().flatten().all(|value| (value - 19.99).abs() < 1e-9));
        assert!(map.worst.iter().all(Option::is_some));
        // Tiles on the diagonal are complete after the second triangle, or after a few that are as great.
        assert!(map.visited_texels < 8 * (SIZE * SIZE) as u64 && map.too_large == 0);
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
