//! High surfaces with normal maps of their own: bakes between UV layouts.

mod support;

use darboux::{Context, Convention};
use darboux_bake::{BakeOptions, Baked, LowSurface, MapKind, NormalTexture, TexelState, bake};
use darboux_dice::Dice;
use support::{PAIRS, Shape, Vector, unit};

const SIZE: u32 = 64;

/// Unit normals within 45 degrees of +z, each unlike its neighbours.
fn random_normals() -> Vec<[f32; 3]> {
    let mut dice = Dice::from_seed(6);
    let mut random = || f64::from(dice.uniform()) / 2.0;
    let count = SIZE as usize * SIZE as usize;
    (0..count).map(|_| unit([random(), random(), 1.0]).map(|x| x as f32)).collect()
}

fn texture() -> NormalTexture {
    NormalTexture::new([SIZE; 2], random_normals(), Convention::GLTF, Convention::GLTF).expect("a texture")
}

/// Bakes a shape with the texture onto another shape at the same place.
fn transferred(from: &Shape, to: &Shape, texture: &NormalTexture) -> Baked {
    let (high_tangents, low_tangents) = (from.tangents(), to.tangents());
    let high = from.high().with_normal_map(texture, &from.uvs, &high_tangents).expect("lengths fit");
    let low = LowSurface::new(to.mesh(), &low_tangents).expect("one tangent per corner");
    let options = BakeOptions::new([SIZE; 2], [1e-3, 1e-3]);
    bake(&[low], &[high], &options, &mut Context::new(), &mut |_| {}).expect("valid input")
}

/// The largest difference of a component between baked texels and what is expected at their places.
fn largest_difference(baked: &Baked, expected: impl Fn(usize, usize) -> [f32; 3]) -> f32 {
    let normals = baked.images.vectors(MapKind::Normal).expect("chosen");
    let side = SIZE as usize;
    let texels = (0..side * side).filter(|&texel| baked.images.states[texel] == TexelState::Baked);
    let difference = |texel: usize| {
        let expected = expected(texel % side, texel / side);
        (0..3).map(|i| (normals[texel][i] - expected[i]).abs()).fold(0.0, f32::max)
    };
    texels.map(difference).fold(0.0, f32::max)
}

/// A hit lies within some 1e-6 of its place, a few 1e-5 of a texel, over which the map changes by at most as
/// much times 2.
const TOLERANCE: f32 = 1e-4;

#[test]
fn the_same_layout_gives_the_same_map() {
    let (normals, texture) = (random_normals(), texture());
    for pair in &PAIRS[..3] {
        let shape = pair.low(12);
        let baked = transferred(&shape, &shape, &texture);
        let largest = largest_difference(&baked, |x, y| normals[y * SIZE as usize + x]);
        assert!(largest < TOLERANCE, "{}: {largest}", pair.name);
        assert!(baked.report.charted_texels > 3000 && baked.report.missed_texels == 0, "{:?}", baked.report);
    }
}

#[test]
fn a_mirrored_layout_gives_the_mirrored_map() {
    let (normals, texture) = (random_normals(), texture());
    for pair in &PAIRS[..3] {
        let shape = pair.low(12);
        let mut mirrored = shape.clone();
        mirrored.uvs.iter_mut().for_each(|uv| uv[0] = 1.0 - uv[0]);
        let baked = transferred(&shape, &mirrored, &texture);
        let expected = |x: usize, y: usize| {
            let [nx, ny, nz] = normals[y * SIZE as usize + SIZE as usize - 1 - x];
            [-nx, ny, nz]
        };
        let largest = largest_difference(&baked, expected);
        assert!(largest < TOLERANCE, "{}: {largest}", pair.name);
    }
}

#[test]
fn without_the_map_the_surface_is_smooth() {
    let shape = PAIRS[0].low(4);
    let tangents = shape.tangents();
    let low = LowSurface::new(shape.mesh(), &tangents).expect("one tangent per corner");
    let options = BakeOptions::new([SIZE; 2], [1e-3, 1e-3]);
    let baked = bake(&[low], &[shape.high()], &options, &mut Context::new(), &mut |_| {});
    let flat: Vector = [0.0, 0.0, 1.0];
    let largest = largest_difference(&baked.expect("valid input"), |_, _| flat.map(|x| x as f32));
    assert!(largest < 1e-6, "{largest}");
}

#[test]
fn the_scale_of_the_map_counts() {
    let (normals, shape) = (random_normals(), PAIRS[0].low(4));
    let baked = transferred(&shape, &shape, &texture().with_scale(0.5));
    let largest = largest_difference(&baked, |x, y| {
        let [nx, ny, nz] = normals[y * SIZE as usize + x].map(f64::from);
        unit([nx / 2.0, ny / 2.0, nz]).map(|x| x as f32)
    });
    assert!(largest < TOLERANCE, "{largest}");
}

#[test]
fn lists_of_other_lengths_are_refused() {
    let (shape, texture) = (PAIRS[0].low(2), texture());
    let tangents = shape.tangents();
    let refused = |uvs: &[[f32; 2]], tangents: &[[f32; 4]]| {
        shape.high().with_normal_map(&texture, uvs, tangents).expect_err("refused").to_string()
    };
    assert!(refused(&shape.uvs[1..], &tangents).contains("UVs"));
    assert!(refused(&shape.uvs, &tangents[1..]).contains("tangents"));
}
