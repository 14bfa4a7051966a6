//! Models of every size bake: to the same bits up to the scale where that is a power of two, and without a
//! crash at the ends of the numbers.

mod support;

use darboux::{Choice, Context};
use darboux_bake::{BakeOptions, Baked, LowSurface, MapKind, MapSet, bake, inflated_cage};
use support::{PAIRS, Shape};

const SIZE: u32 = 40;

/// Bakes all maps of a pair with both models scaled, from a cage that is scaled with them.
fn baked_at(scale: f32) -> Baked {
    let scaled = |shape: Shape| Shape {
        positions: shape.positions.iter().map(|position| position.map(|x| scale * x)).collect(),
        ..shape
    };
    let tangents = PAIRS[0].low(6).tangents();
    let (low, high) = (scaled(PAIRS[0].low(6)), scaled(PAIRS[0].high(24)));
    let distance = scale * 0.1;
    let cage = inflated_cage(&low.mesh(), distance).expect("triangles");
    let surface = LowSurface::new(low.mesh(), &tangents).expect("one tangent per corner");
    let surface = surface.with_cage(&cage).expect("one position per vertex");
    let options = BakeOptions::new([SIZE; 2], [distance; 2])
        .with_maps(MapSet::of(MapKind::ALL))
        .with_occlusion(8, 4.0 * distance);
    bake(&[surface], &[high.high()], &options, &mut Context::new(), &mut |_| {}).expect("valid input")
}

#[test]
fn maps_have_equal_bits_up_to_the_scale_from_1e_minus_30_to_1e30() {
    let expected = baked_at(1.0);
    assert_eq!(expected.report.missed_texels, 0);
    for exponent in [-101, -60, -1, 1, 60, 101] {
        let scale = 2f32.powi(exponent);
        let mut found = baked_at(scale);
        let restore = |x: &mut f32| *x /= scale;
        for kind in [MapKind::Height, MapKind::Position, MapKind::Thickness] {
            found.images.numbers_mut(kind).expect("chosen").iter_mut().for_each(restore);
        }
        assert!(found == expected, "2^{exponent}");
    }
    for scale in [1e-30, 1e30] {
        assert_eq!(baked_at(scale).report.missed_texels, 0, "{scale}");
    }
}

#[test]
fn models_at_the_ends_of_the_numbers_do_not_crash() {
    for scale in [1e-43, 1e-40, 1e37, 3e38, f32::MAX] {
        let report = baked_at(scale).report;
        assert_eq!(report.texels, u64::from(SIZE * SIZE), "{scale}");
    }
}
