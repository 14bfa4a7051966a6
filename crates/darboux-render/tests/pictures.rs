//! What pixels show: colours of known frames, light on mirrored halves, angles, layouts.

mod common;

use common::{Quad, document, has_adapter_or_says_so, picture};
use darboux_render::{RenderOptions, View};

/// Pixels across and down.
const SIZE: usize = 64;

/// The pixel in the middle of the left, or of the right, half.
fn half(pixels: &[[u8; 3]], is_right: bool) -> [u8; 3] {
    pixels[SIZE / 2 * SIZE + if is_right { 3 * SIZE / 4 } else { SIZE / 4 }]
}

fn halves(quad: &Quad, view: View) -> [[u8; 3]; 2] {
    let pixels = picture(quad, quad, view);
    [false, true].map(|is_right| half(&pixels, is_right))
}

fn light([r, g, b]: [u8; 3]) -> u32 {
    u32::from(r) + u32::from(g) + u32::from(b)
}

/// Half of 255 is rounded either way.
fn is_about(pixel: [u8; 3], color: [u8; 3]) -> bool {
    pixel.iter().zip(color).all(|(a, b)| a.abs_diff(b) <= 1)
}

#[test]
fn frames_have_the_colours_of_their_directions() {
    if !has_adapter_or_says_so() {
        return;
    }
    let turned = Quad { node: r#""rotation":[0,0,0.70710678,0.70710678]"#, ..Quad::default() };
    let mirrored = Quad { node: r#""scale":[-2,2,2]"#, ..Quad::default() };
    let [left, right, up, down, near] =
        [[0, 128, 128], [255, 128, 128], [128, 255, 128], [128, 0, 128], [128, 128, 255]];
    let cases = [
        (Quad::default(), View::Tangent, right),
        (Quad::default(), View::Bitangent, up),
        (Quad::default(), View::Normal, near),
        (turned.clone(), View::Tangent, up),
        (turned.clone(), View::Bitangent, left),
        (turned, View::Normal, near),
        // Directions go with the surface.
        (mirrored.clone(), View::Tangent, left),
        (mirrored.clone(), View::Bitangent, up),
        (mirrored, View::Normal, near),
        (Quad { w: [-1.0; 2], ..Quad::default() }, View::Bitangent, down),
    ];
    for (at, (quad, view, color)) in cases.into_iter().enumerate() {
        for pixel in halves(&quad, view) {
            assert!(is_about(pixel, color), "case {at}, {view:?}: {pixel:?} in place of {color:?}");
        }
    }
}

#[test]
fn mirrored_halves_are_lit_from_the_same_side() {
    if !has_adapter_or_says_so() {
        return;
    }
    // A map that leans up the image: towards the light on either half.
    let up = Quad { texel: [128, 220, 200], ..Quad::mirrored() };
    let flat = Quad { texel: [128, 128, 255], ..Quad::mirrored() };
    let [left, right] = halves(&up, View::Shaded);
    let [level, _] = halves(&flat, View::Shaded);
    assert!(is_about(left, right), "{left:?} {right:?}");
    assert!(light(left) > light(level) + 30, "{left:?} {level:?}");
    // A wrong w on the mirrored half is seen.
    let [wrong, right] = halves(&Quad { w: [1.0; 2], ..up.clone() }, View::Shaded);
    assert!(light(wrong) + 30 < light(level), "{wrong:?} {level:?}");
    assert!(is_about(left, right), "{left:?} {right:?}");
    // A map that leans along u: towards the light, which is on the right, where u grows to the right.
    let along = Quad { texel: [220, 128, 200], ..Quad::mirrored() };
    let [left, right] = halves(&along, View::Shaded);
    assert!(light(left) + 60 < light(right), "{left:?} {right:?}");
    // The same of a node that mirrors: neither inside out nor lit from below.
    let [left, right] = halves(&Quad { node: r#""scale":[-1,1,1]"#, ..up }, View::Shaded);
    assert!(is_about(left, right) && light(left) > light(level) + 30, "{left:?} {right:?} {level:?}");
}

#[test]
fn signs_have_two_colours() {
    if !has_adapter_or_says_so() {
        return;
    }
    let [minus, plus] = halves(&Quad::mirrored(), View::Sign);
    assert!(minus[0] > 200 && minus[2] < 80, "{minus:?}");
    assert!(plus[2] > 190 && plus[0] < 80, "{plus:?}");
}

#[test]
fn heat_is_the_angle() {
    if !has_adapter_or_says_so() {
        return;
    }
    let quad = Quad::default();
    let (scale, middle) = (common::heat(), SIZE / 2 * SIZE + SIZE / 2);
    let shown = |other: &Quad| picture(&quad, other, View::Heat)[middle];
    assert!(is_about(shown(&quad), scale.ramp[0]));
    let opposite = Quad { tangent: [-1.0, 0.0, 0.0], ..Quad::default() };
    assert!(is_about(shown(&opposite), scale.ramp[8]));
    // In the middle of a scale from 0.01 to 180 degrees.
    let angle = (0.01f32 * 180.0).sqrt().to_radians();
    let between = Quad { tangent: [angle.cos(), angle.sin(), 0.0], ..Quad::default() };
    assert!(is_about(shown(&between), scale.ramp[4]), "{:?}", shown(&between));
    let flipped = Quad { w: [-1.0; 2], ..Quad::default() };
    assert!(is_about(shown(&flipped), scale.flip));
    let without = Quad { has_tangents: false, ..Quad::default() };
    assert!(is_about(shown(&without), scale.none));
}

#[test]
fn layouts_show_where_uvs_are() {
    if !has_adapter_or_says_so() {
        return;
    }
    // UVs in the left half of the square.
    let [left, right] = halves(&Quad { u_scale: 0.5, ..Quad::default() }, View::Uv);
    assert!(is_about(left, [255, 128, 128]), "{left:?}");
    assert_eq!(right, common::BACKGROUND);
}

#[test]
fn what_cannot_be_drawn_is_said() {
    if !has_adapter_or_says_so() {
        return;
    }
    let gpu = common::gpu().expect("an adapter");
    let options = common::options(View::Shaded);
    let said = |quad: &Quad, options: &RenderOptions| {
        let mut document = document(quad);
        let model = darboux_render::Model::read(&mut document, &[]).expect("a model");
        darboux_render::render(gpu, &model, options).expect_err("no picture").to_string()
    };
    assert!(
        said(&Quad { half_size: f32::NAN, ..Quad::default() }, &options).starts_with("has nothing to draw")
    );
    for size in [[0, 64], [64, 1_000_000], [16_384, 16_384]] {
        let sentence = said(&Quad::default(), &RenderOptions { size, ..options.clone() });
        assert!(sentence.contains("pixels") && sentence.contains(&size[1].to_string()), "{sentence}");
    }
}
