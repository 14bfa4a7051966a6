//! Mip levels of a map: no background within the charts.

mod support;

use darboux::Context;
use darboux_bake::{BakeOptions, LowSurface, MapKind, bake};
use support::Shape;

const SIZE: usize = 256;

/// A disc in the plane z = 0, whose chart is a disc of radius 0.3.
fn disc() -> Shape {
    let mut disc = Shape::default();
    let corners = 40;
    for corner in 0..=corners {
        let angle = std::f64::consts::TAU * f64::from(corner) / f64::from(corners);
        let radius = if corner == corners { 0.0 } else { 1.0 };
        let (x, y) = (radius * angle.cos(), radius * angle.sin());
        disc.positions.push([x as f32, y as f32, 0.0]);
        disc.normals.push([0.0, 0.0, 1.0]);
        disc.uvs.push([(0.5 + 0.3 * x) as f32, (0.5 - 0.3 * y) as f32]);
    }
    for corner in 0..corners {
        disc.indices.extend([corners, corner, (corner + 1) % corners]);
    }
    disc
}

/// Strips narrower than a texel over a square, with two normals in turn: x is 0.6 in both.
fn strips() -> Shape {
    let mut strips = Shape::default();
    let count = 300;
    for strip in 0..count {
        let [from, to] = [strip, strip + 1].map(|i| (2.4 * f64::from(i) / f64::from(count) - 1.2) as f32);
        let normal = if strip % 2 == 0 { [0.6, 0.0, 0.8] } else { [0.6, 0.48, 0.64] };
        let first = strips.positions.len() as u32;
        strips.positions.extend([[from, -1.2, 0.0], [to, -1.2, 0.0], [to, 1.2, 0.0], [from, 1.2, 0.0]]);
        strips.normals.extend([normal; 4]);
        strips.indices.extend([0, 1, 2, 0, 2, 3].map(|i| first + i));
    }
    strips
}

/// The next smaller level: means of four texels.
fn halved(level: &[[f32; 3]], side: usize) -> Vec<[f32; 3]> {
    let half = side / 2;
    let texel = |at: usize| {
        let first = 2 * (at / half) * side + 2 * (at % half);
        let four = [first, first + 1, first + side, first + side + 1];
        [0, 1, 2].map(|i| four.iter().map(|&texel| level[texel][i]).sum::<f32>() / 4.0)
    };
    (0..half * half).map(texel).collect()
}

/// The least x of the texels that a bilinear filter reads at points of the chart, at mip levels 0 to 5.
fn least_x(padding: Option<u32>) -> [f32; 6] {
    let (low, high) = (disc(), strips());
    let tangents = low.tangents();
    let surface = LowSurface::new(low.mesh(), &tangents).expect("one tangent per corner");
    let options =
        BakeOptions::new([SIZE as u32; 2], [0.1, 0.1]).with_samples_per_axis(4).with_padding(padding);
    let baked = bake(&[surface], &[high.high()], &options, &mut Context::new(), &mut |_| {});
    let mut level = baked.expect("valid input").images.vectors(MapKind::Normal).expect("chosen").to_vec();
    std::array::from_fn(|index| {
        let side = SIZE >> index;
        if index > 0 {
            level = halved(&level, 2 * side);
        }
        let mut least = f32::INFINITY;
        for step in 0..4000 {
            // Points on rings up to the border of the chart.
            let (radius, angle) = (0.3 * f64::from(1 + step % 10) / 10.0, f64::from(step));
            let place = [0.5 + radius * angle.cos(), 0.5 + radius * angle.sin()];
            let first = place.map(|x| (x * side as f64 - 0.5).floor() as usize);
            for texel in [[0, 0], [1, 0], [0, 1], [1, 1]] {
                least = least.min(level[(first[1] + texel[1]) * side + first[0] + texel[0]][0]);
            }
        }
        least
    })
}

#[test]
fn no_mip_level_shows_the_background_in_the_charts() {
    // Texels hold unit means of both normals: x is at least 0.6.
    let filled = least_x(None);
    assert!(filled.iter().all(|&x| x > 0.59), "{filled:?}");
    let bare = least_x(Some(0));
    assert!(bare.iter().all(|&x| x < 0.5), "{bare:?}");
    let narrow = least_x(Some(4));
    assert!(narrow[0] > 0.59 && narrow[5] < 0.5, "{narrow:?}");
}
