//! Normal maps from object space to tangent space and back.

mod support;

use darboux::{Channel, Context, Convention, TexelLayout};
use darboux_bake::{
    BakeOptions, Bitangent, LowSurface, MapKind, MapSet, NormalSpace, SpaceOptions, bake, convert_space,
};
use darboux_dice::Dice;
use support::{PAIRS, Pair, degrees, unit};

const SIZE: u32 = 96;

fn rounded<C: Channel>(texels: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let layout = TexelLayout::<3>::RGB;
    texels.iter().map(|&texel| layout.vector(layout.texel::<C>(texel))).collect()
}

fn converted(pair: &Pair, texels: &[[f32; 3]], options: &SpaceOptions) -> Vec<[f32; 3]> {
    let low = pair.low(12);
    let tangents = low.tangents();
    let surface = LowSurface::new(low.mesh(), &tangents).expect("one tangent per corner");
    convert_space(&[surface], texels, options, &mut Context::new()).expect("valid input").texels
}

/// The largest angle between maps in degrees, in the chart: the outer 3 % are not.
fn largest_angle(a: &[[f32; 3]], b: &[[f32; 3]]) -> f64 {
    let border = SIZE as usize * 3 / 100 + 1;
    let chart = border..SIZE as usize - border;
    let texels = chart.clone().flat_map(|y| chart.clone().map(move |x| y * SIZE as usize + x));
    texels
        .map(|texel| degrees(unit(a[texel].map(f64::from)), unit(b[texel].map(f64::from))))
        .fold(0.0, f64::max)
}

/// Rounding to codes moves each component by up to half a code, h = 1 / (2^bits - 1), and the vector by
/// sqrt(3) h. The first rounding acts through the frame, whose condition is below 2 where the normals of a
/// triangle differ by less than 30 degrees; the second acts on the result.
fn tolerance(bits: i32) -> f64 {
    let h = 1.0 / (2f64.powi(bits) - 1.0);
    (3.0 * 3f64.sqrt() * h).to_degrees()
}

fn round_trip<C: Channel>(bits: i32) {
    let mut dice = Dice::from_seed(3);
    for pair in &PAIRS {
        let mut random = || f64::from(dice.uniform());
        let count = SIZE as usize * SIZE as usize;
        let normals: Vec<[f32; 3]> =
            (0..count).map(|_| unit([random(), random(), random()]).map(|x| x as f32)).collect();
        let object = rounded::<C>(&normals);
        for (a, b) in [
            (Convention::GLTF, Convention::GLTF),
            (Convention::UNREAL, Convention::GLTF),
            (Convention::UNITY, Convention::UNREAL),
            (Convention::GLTF, Convention::DIRECTX),
        ] {
            let to_tangent = SpaceOptions::new([SIZE; 2], NormalSpace::Tangent).with_conventions(a, b);
            let tangent = rounded::<C>(&converted(pair, &object, &to_tangent));
            let back = SpaceOptions::new([SIZE; 2], NormalSpace::Object).with_conventions(b, a);
            let largest = largest_angle(&object, &rounded::<C>(&converted(pair, &tangent, &back)));
            assert!(largest < tolerance(bits), "{} in {bits} bits: {largest}", pair.name);
        }
    }
}

#[test]
fn there_and_back_costs_two_roundings_in_8_bits() {
    round_trip::<u8>(8);
}

#[test]
fn there_and_back_costs_two_roundings_in_16_bits() {
    round_trip::<u16>(16);
}

/// Both maps of one bake, in every convention, are one another's conversions.
#[test]
fn the_baker_and_the_conversion_agree() {
    let pair = PAIRS[1];
    let (low, high) = (pair.low(12), pair.high(100));
    let tangents = low.tangents();
    let surface = LowSurface::new(low.mesh(), &tangents).expect("one tangent per corner");
    for convention in [Convention::GLTF, Convention::UNREAL, Convention::UNITY, Convention::DIRECTX] {
        for bitangent in [Bitangent::PerPixel, Bitangent::PerVertex] {
            let maps = MapSet::of(&[MapKind::Normal, MapKind::ObjectNormal]);
            let options = BakeOptions::new([SIZE; 2], [0.1, 0.1])
                .with_maps(maps)
                .with_map_convention(convention)
                .with_bitangent(bitangent);
            let baked = bake(&[surface], &[high.high()], &options, &mut Context::new(), &mut |_| {});
            let images = baked.expect("valid input").images;
            let (normal, object) = (
                images.vectors(MapKind::Normal).expect("chosen").to_vec(),
                images.vectors(MapKind::ObjectNormal).expect("chosen").to_vec(),
            );
            for (to, from, expected) in
                [(NormalSpace::Tangent, &object, &normal), (NormalSpace::Object, &normal, &object)]
            {
                let options = SpaceOptions::new([SIZE; 2], to)
                    .with_conventions(convention, convention)
                    .with_bitangent(bitangent);
                let found = converted(&pair, from, &options);
                // Single precision: some 1e-7 radians, through frames of a condition below 2.
                assert!(largest_angle(&found, expected) < 1e-4, "{convention} {to:?}");
            }
        }
    }
}

#[test]
fn options_act_and_sizes_are_checked() {
    let pair = PAIRS[0];
    let up = vec![[0.6, 0.0, 0.8]; SIZE as usize * SIZE as usize];
    let options = SpaceOptions::new([SIZE; 2], NormalSpace::Tangent);
    let (all, none) =
        (converted(&pair, &up, &options), converted(&pair, &up, &options.with_padding(Some(0))));
    assert!((all[0][0] - 0.6).abs() < 1e-6);
    assert_eq!(none[0], [0.0, 0.0, 1.0]);
    let low = pair.low(2);
    let tangents = low.tangents();
    let surface = LowSurface::new(low.mesh(), &tangents).expect("one tangent per corner");
    let refused = |low: &[LowSurface<'_>], texels: &[[f32; 3]], options: SpaceOptions| {
        convert_space(low, texels, &options, &mut Context::new()).expect_err("refused").to_string()
    };
    assert!(refused(&[surface], &up[1..], options).contains("9215 texels but its size needs 9216"));
    assert!(refused(&[], &up, options).contains("no triangles"));
    assert!(refused(&[surface], &[], SpaceOptions::new([0; 2], NormalSpace::Object)).contains("0 x 0"));
    assert!(refused(&[surface], &up, options.with_memory_limit(Some(10))).contains("limit"));
}
