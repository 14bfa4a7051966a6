//! Normal maps between conventions and layouts.

use darboux::{BitangentDirection, Convention, TangentDirection, TexelLayout, repack_texels};

/// Every 8-bit red and green; blue and alpha depend on both.
fn bytes() -> Vec<[u8; 4]> {
    let texel = |i: u32| [i as u8, (i >> 8) as u8, (i % 251) as u8, (i % 239) as u8];
    (0..65_536).map(texel).collect()
}

/// Every 16-bit red.
fn words() -> Vec<[u16; 3]> {
    (0..=u16::MAX).map(|x| [x, x.wrapping_mul(40_503), x.rotate_left(5)]).collect()
}

fn conventions() -> impl Iterator<Item = Convention> {
    Convention::PRESETS.into_iter().flat_map(|(_, preset)| {
        let left = Convention { tangent: TangentDirection::Left, ..preset };
        [preset, left]
    })
}

#[test]
fn every_pair_of_conventions_round_trips() {
    let (bytes, words) = (bytes(), words());
    for from in conventions() {
        for to in conventions() {
            let (mut there_bytes, mut there_words) = (bytes.clone(), words.clone());
            from.to(to).texels(TexelLayout::RGBA, &mut there_bytes);
            from.to(to).texels(TexelLayout::RGB, &mut there_words);
            let changes = from.tangent != to.tangent || from.bitangent != to.bitangent;
            assert_eq!(there_bytes != bytes, changes);
            assert_eq!(there_words != words, changes);
            to.to(from).texels(TexelLayout::RGBA, &mut there_bytes);
            to.to(from).texels(TexelLayout::RGB, &mut there_words);
            assert!(there_bytes == bytes && there_words == words);
        }
    }
}

/// A converted texel has the same direction: red and green times the directions of tangent and bitangent stay
/// the same.
#[test]
fn a_texel_leans_the_same_way_on_the_picture() {
    let in_picture = |convention: Convention, [x, y, z]: [f32; 3]| {
        let x = if convention.tangent == TangentDirection::Right { x } else { -x };
        let y = if convention.bitangent == BitangentDirection::Up { y } else { -y };
        [x, y, z]
    };
    for from in conventions() {
        for to in conventions() {
            for texel in bytes().into_iter().step_by(97) {
                let mut there = [texel];
                from.to(to).texels(TexelLayout::RGBA, &mut there);
                let before = in_picture(from, TexelLayout::RGBA.vector(texel));
                assert_eq!(in_picture(to, TexelLayout::RGBA.vector(there[0])), before);
                assert_eq!(there[0][2..], texel[2..]);
            }
        }
    }
}

#[test]
fn green_alone_changes_between_opengl_and_directx() {
    let mut texels = [[128u8, 128, 255], [0, 255, 7], [200, 0, 9]];
    Convention::OPENGL.to(Convention::DIRECTX).texels(TexelLayout::RGB, &mut texels);
    assert_eq!(texels, [[128, 127, 255], [0, 0, 7], [200, 255, 9]]);
    let mut packed = [[255u8, 10, 0, 20]];
    Convention::OPENGL.to(Convention::DIRECTX).texels(TexelLayout::AG, &mut packed);
    assert_eq!(packed, [[255, 245, 0, 20]]);
}

#[test]
fn layouts_keep_x_and_y_and_rebuild_z() {
    let unit = |i: u32| {
        let z = f64::from(i % 1000) / 999.0;
        let (sin, cos) = (f64::from(i) * 0.37).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        [radius * cos, radius * sin, z].map(|c| ((c + 1.0) / 2.0 * 65_535.0).round() as u16)
    };
    let texels: Vec<[u16; 3]> = (0..20_000).map(unit).collect();
    let two = repack_texels(&texels, TexelLayout::RGB, TexelLayout::RG);
    let packed = repack_texels(&two, TexelLayout::RG, TexelLayout::AG);
    let back = repack_texels(&packed, TexelLayout::AG, TexelLayout::RGB);
    for (texel, back) in texels.iter().zip(&back) {
        assert_eq!(texel[..2], back[..2]);
        // dz = (x dx + y dy) / z, half a step each, and half a step of rounding z itself; near z = 0 the
        // square root of it.
        let z = f64::from(texel[2]) / 32_767.5 - 1.0;
        let steps = 1.5 + (1.0 / z).min(256.0);
        assert!(f64::from(texel[2].abs_diff(back[2])) <= steps, "{texel:?} {back:?}");
    }
}

#[test]
fn channels_without_a_component_stay_or_are_full() {
    let gray = TexelLayout::<4>::new(1, 0, Some(2)).unwrap();
    assert_eq!(repack_texels(&[[1u8, 2, 3, 4]], TexelLayout::RGBA, gray), [[2, 1, 3, 4]]);
    assert_eq!(repack_texels(&[[1u8, 2, 3]], TexelLayout::RGB, TexelLayout::RGBA), [[1, 2, 3, 255]]);
    assert_eq!(repack_texels(&[[1u8, 2, 3, 4]], TexelLayout::RGBA, TexelLayout::AG), [[255, 2, 255, 1]]);
    assert_eq!(repack_texels(&[[1u8, 2, 3, 4]], TexelLayout::AG, TexelLayout::RGBA), [[4, 2, 128, 255]]);
}

#[test]
fn impossible_layouts_are_refused() {
    assert_eq!(TexelLayout::<3>::new(0, 0, None), None);
    assert_eq!(TexelLayout::<3>::new(0, 3, None), None);
    assert_eq!(TexelLayout::<3>::new(0, 1, Some(1)), None);
    assert_eq!(TexelLayout::<3>::new(0, 1, Some(3)), None);
    assert_eq!(TexelLayout::<3>::new(0, 1, Some(2)), Some(TexelLayout::RGB));
}
