//! Bakes surfaces that are known in closed form, shades the low mesh as a renderer does, and measures the
//! angle to the true normal. [`support::shading`] knows the truth.

mod support;

use std::io::Write;

use darboux_bake::{BakeOptions, Bitangent, MapKind};
use darboux_dice::Dice;
use support::shading::{Fragment, Texture, errors, fragments, quantile};
use support::{PAIRS, Shape, baked};

fn normals_of(low: &Shape, high: &Shape, size: u32, bitangent: Bitangent) -> Vec<[f32; 3]> {
    let options = BakeOptions::new([size, size], [0.15, 0.15]).with_bitangent(bitangent);
    let baked = baked(low, high, &options);
    // At the ends of open surfaces rays of a coarse low mesh may pass beside the high one; the rest must hit.
    assert!(baked.report.missed_texels * 50 < baked.report.charted_texels, "{:?}", baked.report);
    baked.images.vectors(MapKind::Normal).expect("chosen").to_vec()
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

/// The median error of filtered texels whose components are wrong by up to half a code, evenly and
/// independently: the limit of 8 bits.
///
/// Rounding moves x and y by up to a = 1/255 (half of a code of 2/255). For normals near z the angle is the
/// length of that error. A bilinear filter adds the errors of four texels with its weights.
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
