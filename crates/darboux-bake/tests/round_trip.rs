//! Bakes surfaces that are known in closed form, shades the low mesh as a renderer does, and measures the angle to the true normal.
//!
//! The truth at a point of the low mesh is the normal where the line along its interpolated normal meets the analytic surface, found by
//! Newton's method: neither the high mesh nor a ray is part of it.

mod support;

use std::io::Write;

use darboux::{Channel, Convention, TexelLayout};
use darboux_bake::{BakeOptions, Bitangent};
use darboux_dice::Dice;
use support::{PAIRS, Pair, Shape, Vector, baked, cross, degrees, dot, is_in_second_half, normal, unit};

/// Points per measurement.
const POINTS: usize = 20_000;

/// A point of the low mesh, as a fragment shader sees it, and the true normal.
struct Fragment {
    uv: [f64; 2],
    normal: Vector,
    tangent: Vector,
    sign: f64,
    truth: Vector,
    /// The distance to the nearest border of a chart, in units of UVs.
    to_border: f64,
}

/// Points at random places of the charts.
fn fragments(pair: &Pair, low: &Shape, cells: usize) -> Vec<Fragment> {
    let conversion = Convention::GLTF.generated().to(Convention::GLTF);
    let tangents: Vec<_> = low.tangents().into_iter().map(|tangent| conversion.tangent(tangent)).collect();
    let mut dice = Dice::from_seed(1);
    let mut random = || (f64::from(dice.word()) + 0.5) / 4_294_967_296.0;
    let fragment = |_| {
        let place = [random(), random()];
        let cell = place.map(|x| (x * cells as f64) as usize);
        let [x, y] = [0, 1].map(|i| place[i] * cells as f64 - cell[i] as f64);
        // The triangles of a cell, and the weights of their corners, in the order of `Shape::grid`.
        let is_turned = pair.is_mirrored && is_in_second_half(cell[0], cells);
        let (triangle, weights) = match is_turned {
            false if y > x => (0, [1.0 - y, y - x, x]),
            false => (1, [1.0 - x, y, x - y]),
            true if x + y < 1.0 => (0, [1.0 - x - y, y, x]),
            true => (1, [1.0 - y, 1.0 - x, x + y - 1.0]),
        };
        let first = 6 * (cell[1] * cells + cell[0]) + 3 * triangle;
        let corners = [first, first + 1, first + 2];
        let vertices = corners.map(|corner| low.indices[corner] as usize);
        let position = mixed(weights, vertices.map(|vertex| low.positions[vertex]));
        let normal = mixed(weights, vertices.map(|vertex| low.normals[vertex]));
        let [tx, ty, tz, sign] = mixed(weights, corners.map(|corner| tangents[corner]));
        Fragment {
            uv: mixed(weights, vertices.map(|vertex| low.uvs[vertex])),
            normal,
            tangent: [tx, ty, tz],
            sign,
            truth: true_normal(pair, place, position, unit(normal)),
            to_border: border_distance(pair, place),
        }
    };
    (0..POINTS).map(fragment).collect()
}

fn mixed<const N: usize>(weights: [f64; 3], corners: [[f32; N]; 3]) -> [f64; N] {
    std::array::from_fn(|i| (0..3).map(|k| weights[k] * f64::from(corners[k][i])).sum())
}

fn border_distance(pair: &Pair, [u, v]: [f64; 2]) -> f64 {
    let (seam, along) = if pair.is_mirrored { ((2.0 * u - 1.0).abs(), 0.94) } else { (u, 0.94) };
    along * seam.min(1.0 - seam).min(v).min(1.0 - v)
}

/// The normal where the line through `position` along `direction` meets the surface.
fn true_normal(pair: &Pair, start: [f64; 2], position: Vector, direction: Vector) -> Vector {
    const STEP: f64 = 1e-6;
    let [mut u, mut v] = start;
    let mut t = 0.0;
    let surface = |u: f64, v: f64| pair.point(u, v);
    for _ in 0..12 {
        let at = surface(u, v);
        let miss = [0, 1, 2].map(|i| position[i] + t * direction[i] - at[i]);
        let derivative = |a: Vector, b: Vector| [0, 1, 2].map(|i| (a[i] - b[i]) / (2.0 * STEP));
        let along_u = derivative(surface(u + STEP, v), surface(u - STEP, v));
        let along_v = derivative(surface(u, v + STEP), surface(u, v - STEP));
        let back = direction.map(|x| -x);
        // Cramer's rule for du * along_u + dv * along_v + dt * back = miss.
        let volume = dot(along_u, cross(along_v, back));
        u += dot(miss, cross(along_v, back)) / volume;
        v += dot(along_u, cross(miss, back)) / volume;
        t += dot(along_u, cross(along_v, miss)) / volume;
    }
    normal(surface, u, v)
}

/// The map, filtered as a GPU does.
struct Texture {
    size: usize,
    texels: Vec<[f32; 3]>,
}

impl Texture {
    /// Normals, rounded to the codes of a channel type.
    fn rounded<C: Channel>(normals: &[[f32; 3]], size: usize) -> Self {
        let layout = TexelLayout::<3>::RGB;
        let texels = normals.iter().map(|&normal| layout.vector(layout.texel::<C>(normal))).collect();
        Self { size, texels }
    }

    fn bilinear(&self, uv: [f64; 2]) -> Vector {
        let last = self.size as f64 - 1.0;
        let place = uv.map(|x| (x * self.size as f64 - 0.5).clamp(0.0, last));
        let first = place.map(|x| x.floor().min(last - 1.0) as usize);
        let [x, y] = [0, 1].map(|i| place[i] - first[i] as f64);
        let texel = |dx: usize, dy: usize| self.texels[(first[1] + dy) * self.size + first[0] + dx];
        let rows = [[texel(0, 0), texel(1, 0)], [texel(0, 1), texel(1, 1)]];
        std::array::from_fn(|i| {
            let row = |[a, b]: [[f32; 3]; 2]| (1.0 - x) * f64::from(a[i]) + x * f64::from(b[i]);
            (1.0 - y) * row(rows[0]) + y * row(rows[1])
        })
    }
}

/// The normal that a glTF renderer computes.
fn shaded(fragment: &Fragment, texture: &Texture) -> Vector {
    let Fragment { normal, tangent, sign, .. } = fragment;
    let bitangent = cross(*normal, *tangent).map(|x| sign * x);
    let [x, y, z] = texture.bilinear(fragment.uv);
    unit([0, 1, 2].map(|i| x * tangent[i] + y * bitangent[i] + z * normal[i]))
}

/// The errors in degrees, sorted.
fn errors<'a>(fragments: impl IntoIterator<Item = &'a Fragment>, texture: &Texture) -> Vec<f64> {
    let mut errors: Vec<f64> =
        fragments.into_iter().map(|fragment| degrees(shaded(fragment, texture), fragment.truth)).collect();
    errors.sort_by(f64::total_cmp);
    errors
}

fn quantile(sorted: &[f64], share: f64) -> f64 {
    sorted[((sorted.len() - 1) as f64 * share) as usize]
}

fn normals_of(low: &Shape, high: &Shape, size: u32, bitangent: Bitangent) -> Vec<[f32; 3]> {
    let options = BakeOptions::new([size, size], [0.15, 0.15]).with_bitangent(bitangent);
    let baked = baked(low, high, &options);
    // At the ends of open surfaces rays of a coarse low mesh may pass beside the high one; the rest must hit.
    assert!(baked.report.missed_texels * 50 < baked.report.charted_texels, "{:?}", baked.report);
    baked.images.normal.expect("chosen")
}

fn show(line: &str) {
    writeln!(std::io::stdout(), "{line}").expect("standard output");
}

/// The largest median error on smooth charts, in degrees.
const MEDIAN: f64 = 0.05;

fn measure(size: u32, low_cells: usize, high_cells: usize) {
    for pair in PAIRS {
        let (low, high) = (pair.low(low_cells), pair.high(high_cells));
        let fragments = fragments(&pair, &low, low_cells);
        let normals = normals_of(&low, &high, size, Bitangent::PerPixel);
        let texture = Texture::rounded::<u16>(&normals, size as usize);
        let all = errors(&fragments, &texture);
        let is_near_border = |fragment: &&Fragment| fragment.to_border * f64::from(size) < 1.0;
        let border = errors(fragments.iter().filter(is_near_border), &texture);
        let rows = [0.5, 0.99, 1.0].map(|share| [quantile(&all, share), quantile(&border, share)]);
        show(&format!(
            "{} at {size}: median {:.4}, 99 % {:.4}, largest {:.4} degrees; within a texel of borders {:.4}, {:.4}, {:.4}",
            pair.name, rows[0][0], rows[1][0], rows[2][0], rows[0][1], rows[1][1], rows[2][1]
        ));
        assert!(rows[0][0] <= MEDIAN, "{}: {}", pair.name, rows[0][0]);
    }
}

#[test]
fn a_renderer_shows_the_true_normals() {
    measure(512, 24, 400);
}

#[test]
#[ignore = "a minute: the numbers of docs/bake.md"]
fn a_renderer_shows_the_true_normals_at_2048() {
    measure(2048, 24, 1000);
    measure(2048, 96, 1000);
}

/// The median error of filtered texels whose components are wrong by up to half a code, evenly and independently: the limit of 8 bits.
///
/// Rounding moves x and y by up to a = 1/255 (half of a code of 2/255). For normals near z the angle is the length of that error. A bilinear
/// filter adds the errors of four texels with its weights.
fn limit_of_8_bits() -> f64 {
    let mut dice = Dice::from_seed(2);
    let mut error = || {
        let [x, y] = [0, 1].map(|_| (f64::from(dice.uniform()) + 1.0) / 2.0);
        let weights = [(1.0 - x) * (1.0 - y), x * (1.0 - y), (1.0 - x) * y, x * y];
        let mut component =
            || weights.iter().map(|weight| weight * f64::from(dice.uniform()) / 255.0).sum::<f64>();
        component().hypot(component()).to_degrees()
    };
    let mut errors: Vec<f64> = (0..100_000).map(|_| error()).collect();
    errors.sort_by(f64::total_cmp);
    quantile(&errors, 0.5)
}

#[test]
fn rounding_to_8_bits_costs_what_it_must() {
    let pair = PAIRS[0];
    let (low, high) = (pair.low(24), pair.high(400));
    let normals = normals_of(&low, &high, 512, Bitangent::PerPixel);
    let all = errors(&fragments(&pair, &low, 24), &Texture::rounded::<u8>(&normals, 512));
    let (median, limit) = (quantile(&all, 0.5), limit_of_8_bits());
    show(&format!("8 bits: median {median:.4} degrees, limit {limit:.4}"));
    // The limit was drawn at random from 100,000 errors, and is exact to 1 %.
    assert!((median / limit - 1.0).abs() < 0.1, "{median} {limit}");
}

#[test]
fn a_map_for_another_bitangent_or_green_is_wrong() {
    let pair = PAIRS[1];
    let (low, high) = (pair.low(8), pair.high(200));
    let fragments = fragments(&pair, &low, 8);
    let median =
        |normals: &[[f32; 3]]| quantile(&errors(&fragments, &Texture::rounded::<u16>(normals, 256)), 0.5);
    let right = normals_of(&low, &high, 256, Bitangent::PerPixel);
    let flipped: Vec<[f32; 3]> = right.iter().map(|&[x, y, z]| [x, -y, z]).collect();
    let vertex = normals_of(&low, &high, 256, Bitangent::PerVertex);
    let [good, per_vertex, green] = [&right, &vertex, &flipped].map(|normals| median(normals));
    show(&format!("right {good:.4}, bitangent per vertex {per_vertex:.4}, green flipped {green:.4} degrees"));
    assert!(good < MEDIAN && per_vertex > 1.5 * good && green > 20.0 * good);
}
