//! Tests single pixels of pictures: colours of known frames, light on mirrored halves, angles, UV layouts.

mod common;

use common::{Quad, document, has_adapter_or_says_so};
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use darboux_render::{LayoutPlacement, Mistakes, Model, RenderOptions, Side, View};
use image::{DynamicImage, ImageFormat, Rgb, RgbImage, Rgba, RgbaImage};

/// The width and height of the pictures.
const SIZE: usize = 64;

/// The pixel in the middle of the left, or of the right, half.
fn half(pixels: &[[u8; 3]], is_right: bool) -> [u8; 3] {
    pixels[SIZE / 2 * SIZE + if is_right { 3 * SIZE / 4 } else { SIZE / 4 }]
}

/// The pixels of a quad that is compared with another. Panics without an adapter.
fn picture(quad: &Quad, other: &Quad, view: View) -> Vec<[u8; 3]> {
    let [mut document, mut other] = [quad, other].map(document);
    let [model, other] = [&mut document, &mut other].map(|document| Model::read(document).expect("a model"));
    let picture = common::shown(&model.compared_with(&other), Mistakes::default(), &common::options(view));
    assert!(picture.warnings.is_empty(), "{:?}", picture.warnings);
    picture.pixels
}

fn halves(quad: &Quad, view: View) -> [[u8; 3]; 2] {
    let pixels = picture(quad, quad, view);
    [false, true].map(|is_right| half(&pixels, is_right))
}

fn light([r, g, b]: [u8; 3]) -> u32 {
    u32::from(r) + u32::from(g) + u32::from(b)
}

/// Adapters round half of 255 up or down.
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
        // A node that mirrors mirrors the directions.
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
    // A normal map that leans up, towards the light, on both halves.
    let up = Quad { texel: [128, 220, 200], ..Quad::mirrored() };
    let flat = Quad { texel: [128, 128, 255], ..Quad::mirrored() };
    let [left, right] = halves(&up, View::Shaded);
    let [level, _] = halves(&flat, View::Shaded);
    assert!(is_about(left, right), "{left:?} {right:?}");
    assert!(light(left) > light(level) + 30, "{left:?} {level:?}");
    // A wrong w darkens the mirrored half.
    let [wrong, right] = halves(&Quad { w: [1.0; 2], ..up.clone() }, View::Shaded);
    assert!(light(wrong) + 30 < light(level), "{wrong:?} {level:?}");
    assert!(is_about(left, right), "{left:?} {right:?}");
    // A normal map that leans along u. The light is on the right, so only the half where u grows to the right
    // leans towards it.
    let along = Quad { texel: [220, 128, 200], ..Quad::mirrored() };
    let [left, right] = halves(&along, View::Shaded);
    assert!(light(left) + 40 < light(right), "{left:?} {right:?}");
    // A node that mirrors neither turns the surface inside out nor moves the light.
    let [left, right] = halves(&Quad { node: r#""scale":[-1,1,1]"#, ..up }, View::Shaded);
    assert!(is_about(left, right) && light(left) > light(level) + 30, "{left:?} {right:?} {level:?}");
}

/// Tolerates that the light shines a little more on one half.
fn is_like(a: [u8; 3], b: [u8; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 12)
}

/// A quad with a red base colour, whose left and right halves have these alpha values.
fn translucent(alpha: [u8; 2], material: &'static str) -> Quad {
    let texels = RgbaImage::from_fn(8, 8, |x, _| Rgba([255, 0, 0, alpha[usize::from(x >= 4)]]));
    let base = common::file_of(&texels.into(), ImageFormat::Png);
    Quad { base: Some((base, "image/png")), material, ..Quad::default() }
}

#[test]
fn alpha_means_what_the_material_says() {
    if !has_adapter_or_says_so() {
        return;
    }
    let seen = |alpha, material| halves(&translucent(alpha, material), View::Shaded);
    let is_red = |pixel: [u8; 3]| pixel[0] > 100 && pixel[1] < 80;
    // Opaque materials ignore alpha.
    let [left, right] = seen([0, 255], "");
    assert!(is_red(left) && is_like(left, right), "{left:?} {right:?}");
    // The default cutoff is one half. Alpha equal to the cutoff is opaque.
    for (material, alpha) in
        [(r#","alphaMode":"MASK""#, [127, 128]), (r#","alphaMode":"MASK","alphaCutoff":0.8"#, [203, 204])]
    {
        let [gone, there] = seen(alpha, material);
        assert!(gone == common::BACKGROUND && is_like(there, right), "{material}: {gone:?} {there:?}");
    }
    // About half of the background shines through. Coverage has four samples, which adapters round up or
    // down.
    let [none, half] = seen([0, 128], r#","alphaMode":"BLEND""#);
    assert_eq!(none, common::BACKGROUND);
    let linear = |channel: u8| (f64::from(channel) / 255.0).powf(2.2);
    let covered = linear(half[0]) / linear(right[0]);
    assert!((0.24..0.77).contains(&covered), "{half:?} of {right:?}");
    // Views of frames ignore alpha.
    let [left, right] = halves(&translucent([0, 255], r#","alphaMode":"BLEND""#), View::Tangent);
    assert!(is_like(left, right) && left != common::BACKGROUND, "{left:?} {right:?}");
}

#[test]
fn jpeg_and_webp_textures_are_drawn_and_others_are_warned_about() {
    if !has_adapter_or_says_so() {
        return;
    }
    let texels = DynamicImage::from(RgbImage::from_fn(32, 32, |x, _| match x < 16 {
        true => Rgb([220, 30, 30]),
        false => Rgb([30, 30, 220]),
    }));
    let quad = |format, kind, image_extension| {
        let base = Some((common::file_of(&texels, format), kind));
        Quad { base, image_extension, ..Quad::default() }
    };
    let png = halves(&quad(ImageFormat::Png, "image/png", ""), View::Shaded);
    let others = [
        quad(ImageFormat::Jpeg, "image/jpeg", ""),
        quad(ImageFormat::WebP, "image/webp", "EXT_texture_webp"),
        quad(ImageFormat::WebP, "image/webp", ""),
    ];
    for (at, other) in others.iter().enumerate() {
        let shown = halves(other, View::Shaded);
        assert!(is_like(png[0], shown[0]) && is_like(png[1], shown[1]), "{at}: {png:?} {shown:?}");
        assert!(shown[0][0] > shown[0][2] + 60 && shown[1][2] > shown[1][0] + 60, "{at}: {shown:?}");
    }
    let cases = [
        (&b"GIF89a, or so"[..], "", "images[1] is GIF, for which there is no decoder here"),
        (b"\0\0\0\x20ftypavif\0\0\0\0avifmif1miafMA1B", "EXT_texture_avif", "images[1] is AVIF, for which"),
    ];
    for (file, image_extension, expected) in cases {
        let quad = Quad { base: Some((file.to_vec(), "image/other")), image_extension, ..Quad::default() };
        let warnings = common::drawn(&quad, &common::options(View::Shaded)).warnings;
        assert!(
            matches!(&warnings[..], [one] if one.starts_with(expected) && one.ends_with("drawn without it")),
            "{warnings:?}"
        );
    }
}

/// A quad with a skin. Joint 1, which is node 1, has all the weight. The attributes of joints and weights are
/// the tangents: 1, 0, 0, 1.
fn skinned(joint: &'static str) -> Quad {
    Quad {
        node: r#""skin":0,"children":[1],"translation":[7,8,9]"#,
        nodes: joint,
        attributes: r#","JOINTS_0":2,"WEIGHTS_0":2"#,
        file: r#","skins":[{"joints":[0,1]}]"#,
        ..Quad::default()
    }
}

#[test]
fn skins_move_vertices_and_their_frames() {
    if !has_adapter_or_says_so() {
        return;
    }
    let turned = skinned(r#",{"rotation":[0,0,0.70710678,0.70710678]}"#);
    for (view, color) in
        [(View::Tangent, [128, 255, 128]), (View::Bitangent, [0, 128, 128]), (View::Normal, [128, 128, 255])]
    {
        for pixel in halves(&turned, view) {
            assert!(is_about(pixel, color), "{view:?}: {pixel:?}");
        }
    }
    // The quad is three times wider than high, so two thirds of the rows are empty.
    let wide = picture(&skinned(r#",{"scale":[3,1,1]}"#), &Quad::default(), View::Normal);
    let rows = wide.chunks(SIZE).filter(|row| row[SIZE / 2] != common::BACKGROUND).count();
    assert!((18..=22).contains(&rows), "{rows}");
    // A joint that mirrors is lit as a node that mirrors.
    let up = |quad: Quad| halves(&Quad { texel: [128, 220, 200], ..quad }, View::Shaded);
    let [joint, node] =
        [up(skinned(r#",{"scale":[-1,1,1]}"#)), up(Quad { node: r#""scale":[-1,1,1]"#, ..Quad::default() })];
    assert!((0..2).all(|half| is_about(joint[half], node[half])), "{joint:?} {node:?}");
}

#[test]
fn morph_targets_move_vertices_and_their_frames() {
    if !has_adapter_or_says_so() {
        return;
    }
    // The target moves positions by the normals, with a weight of one half.
    let morphed = Quad {
        node: r#""weights":[0.5]"#,
        primitive: r#","targets":[{"POSITION":1,"TANGENT":1}]"#,
        ..Quad::default()
    };
    // The direction of (1, 0, 0.5).
    for pixel in halves(&morphed, View::Tangent) {
        assert!(is_about(pixel, [242, 128, 185]), "{pixel:?}");
    }
    let still = Quad { node: r#""weights":[0]"#, ..morphed };
    assert!(halves(&still, View::Tangent).iter().all(|&pixel| is_about(pixel, [255, 128, 128])));
}

#[test]
fn instances_are_drawn_at_their_places() {
    if !has_adapter_or_says_so() {
        return;
    }
    // One instance at each corner of the quad.
    let node = r#""extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0}}}"#;
    let quad = Quad { half_size: 0.25, node, ..Quad::default() };
    let document = document(&quad);
    assert_eq!(Model::read(&document).expect("a model").triangle_count(), 48);
    let pixels = picture(&quad, &quad, View::Normal);
    assert!(pixels[3 * SIZE + 3] != common::BACKGROUND && pixels[60 * SIZE + 60] != common::BACKGROUND);
}

#[test]
fn invalid_poses_are_errors() {
    let cases = [
        (
            Quad { node: r#""skin":1"#, ..Quad::default() },
            "nodes[0].skin: skin 1 does not exist: there are 0",
        ),
        (skinned(",{}"), ""),
        (
            Quad {
                attributes: r#","JOINTS_0":2,"WEIGHTS_0":2,"JOINTS_4":2,"WEIGHTS_4":2"#,
                ..skinned(",{}")
            },
            "meshes[0].primitives[0]: has vertices with more than 16 joints",
        ),
        (
            Quad { file: r#","skins":[{"joints":[0,4]}]"#, ..skinned(",{}") },
            "skins[0].joints[1]: node 4 does not exist: there are 2",
        ),
        (
            Quad { file: r#","skins":[{"joints":[0,2]}]"#, ..skinned(",{},{}") },
            "skins[0].joints[1]: is not in the scene",
        ),
        (
            Quad { file: r#","skins":[{"joints":[0,1],"inverseBindMatrices":2}]"#, ..skinned(",{}") },
            "accessors[2].type: is VEC4; it must have 16 components",
        ),
        (
            Quad {
                node: r#""extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"SCALE":0,"ROTATION":3}}}"#,
                ..Quad::default()
            },
            "accessors[3].type",
        ),
    ];
    for (quad, expected) in cases {
        let read = common::load(&quad).and_then(|document| Model::read(&document).map(|_| ()));
        let error = read.err().map(|error| error.to_string()).unwrap_or_default();
        assert!(
            error.contains(expected) && error.is_empty() == expected.is_empty(),
            "{error} in place of {expected}"
        );
    }
}

#[test]
fn the_number_of_poses_of_a_mesh_is_limited() {
    // One triangle. The file does not store the vertices, which are zeros.
    let read = |vertices: usize| {
        let file = format!(
            r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0,1,2]}}],
            "nodes":[{{"mesh":0}},{{"mesh":0,"weights":[1]}},{{"mesh":0,"weights":[2]}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
            "accessors":[{{"componentType":5126,"count":{vertices},"type":"VEC3"}},{{"componentType":5125,"count":3,"type":"SCALAR"}}]}}"#
        );
        let document = Document::from_bytes("file", file.into_bytes(), None, &LoadOptions::default());
        let triangles = Model::read(&document.expect("a document")).map(|model| model.triangle_count());
        triangles.map_err(|error| error.to_string())
    };
    assert_eq!(read(3), Ok(3));
    let error = read(30_000_000).expect_err("too many");
    assert!(error.contains("has too many poses"), "{error}");
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
    let shown = |other: &Quad| picture(&quad, other, View::Angle)[middle];
    assert!(is_about(shown(&quad), scale.ramp[0]));
    let opposite = Quad { tangent: [-1.0, 0.0, 0.0], ..Quad::default() };
    assert!(is_about(shown(&opposite), scale.ramp[8]));
    // The middle of a logarithmic scale from 0.01 to 180 degrees.
    let angle = (0.01f32 * 180.0).sqrt().to_radians();
    let between = Quad { tangent: [angle.cos(), angle.sin(), 0.0], ..Quad::default() };
    assert!(is_about(shown(&between), scale.ramp[4]), "{:?}", shown(&between));
    let flipped = Quad { w: [-1.0; 2], ..Quad::default() };
    // Opposite signs have stripes.
    let pixels = picture(&quad, &flipped, View::Angle);
    let count = |color| pixels.iter().filter(|&&pixel| is_about(pixel, color)).count();
    let (plain, stripes) = (count(scale.flip), count([255; 3]));
    assert!(plain > stripes && stripes > plain / 3, "{plain} {stripes}");
    let without = Quad { has_tangents: false, ..Quad::default() };
    assert!(is_about(shown(&without), scale.none));
}

/// Options for the UV layout alone.
fn alone(view: View) -> RenderOptions {
    common::options(view).with_layout(Some(LayoutPlacement::Alone))
}

/// A colour over the background, with an alpha of 0.6.
fn through(color: [u8; 3]) -> [u8; 3] {
    [0, 1, 2].map(|i| (0.6 * f64::from(color[i]) + 0.4 * f64::from(common::BACKGROUND[i])).round() as u8)
}

#[test]
fn layouts_show_where_uvs_are_in_the_colours_of_the_surface() {
    if !has_adapter_or_says_so() {
        return;
    }
    // The UVs lie in the left half of the square.
    let quad = Quad { u_scale: 0.5, ..Quad::default() };
    let laid_out = |view| {
        let pixels = common::drawn(&quad, &alone(view)).pixels;
        [false, true].map(|is_right| half(&pixels, is_right))
    };
    assert_eq!(laid_out(View::Tangent)[1], common::BACKGROUND);
    for (view, color) in [
        (View::Tangent, [255, 128, 128]),
        (View::Bitangent, [128, 255, 128]),
        (View::Normal, [128, 128, 255]),
    ] {
        assert!(is_about(laid_out(view)[0], through(color)), "{view:?}: {:?}", laid_out(view));
    }
    for view in [View::Sign, View::Shaded] {
        assert!(is_about(laid_out(view)[0], through([61, 139, 217])), "{view:?}: {:?}", laid_out(view));
    }
    let corner =
        common::options(View::Normal).with_layout(Some(LayoutPlacement::Corner)).with_size([200, 200]);
    let [with, without] =
        [corner.clone(), corner.with_layout(None)].map(|options| common::drawn(&quad, &options).pixels);
    // The square is 76 pixels wide, 12 pixels from the edges of the picture. UVs lie only in its left half.
    let at = |x: usize, y: usize| [with[200 * y + x], without[200 * y + x]];
    assert!(is_about(at(120, 150)[0], through([128, 128, 255])));
    assert_eq!(at(180, 150)[0], common::BACKGROUND);
    assert!(at(108, 150)[0] == at(108, 150)[1] && at(190, 150)[0] == at(190, 150)[1]);
}

#[test]
fn a_model_without_uvs_has_no_layout_beside_it() {
    if !has_adapter_or_says_so() {
        return;
    }
    let options =
        common::options(View::Normal).with_layout(Some(LayoutPlacement::Corner)).with_size([200, 200]);
    let picture = common::drawn(&Quad { u_scale: f32::NAN, ..Quad::default() }, &options);
    assert_eq!(picture.warnings, ["has no finite UVs, so its UV layout is not drawn"]);
    assert!(is_about(picture.pixels[200 * 150 + 150], [128, 128, 255]));
}

#[test]
fn primitives_of_points_and_lines_are_warned_about() {
    if !has_adapter_or_says_so() {
        return;
    }
    for mode in 0..4 {
        let primitive: &str = format!(r#"}},{{"attributes":{{"POSITION":0}},"mode":{mode}"#).leak();
        let quad = Quad { primitive, ..Quad::default() };
        let warnings = common::drawn(&quad, &common::options(View::Normal)).warnings;
        assert_eq!(warnings, ["has 1 primitives of points or lines, which are not drawn"], "mode {mode}");
    }
}

#[test]
fn uvs_of_any_size_show_the_mean_of_the_image() {
    if !has_adapter_or_says_so() {
        return;
    }
    // Columns of black and white texels. Software adapters that filter every repetition below a pixel take
    // minutes for this picture.
    let image = image::RgbImage::from_fn(64, 64, |x, _| image::Rgb([if x % 2 == 0 { 0 } else { 255 }; 3]));
    let file = common::file_of(&image.into(), image::ImageFormat::Png);
    let striped = |u_scale| Quad {
        u_scale,
        base: Some((file.clone(), "image/png")),
        base_sampler: "",
        ..Quad::default()
    };
    let options = common::options(View::Shaded).with_size([256, 256]);
    let [some, many] =
        [400.0, 65_535.0].map(|u_scale| common::drawn(&striped(u_scale), &options).pixels[256 * 128 + 64]);
    assert!(is_about(some, many), "{some:?} {many:?}");
}

#[test]
fn what_cannot_be_drawn_is_an_error() {
    if !has_adapter_or_says_so() {
        return;
    }
    let gpu = common::gpu().expect("an adapter");
    let options = common::options(View::Shaded);
    let error_of = |quad: &Quad, options: &RenderOptions| {
        let document = document(quad);
        let model = &Model::read(&document).expect("a model");
        let side = Side { model, mistakes: Mistakes::default() };
        darboux_render::render(gpu, side, None, options).expect_err("no picture").to_string()
    };
    assert!(
        error_of(&Quad { half_size: f32::NAN, ..Quad::default() }, &options)
            .starts_with("has nothing to draw")
    );
    for size in [[0, 64], [64, 1_000_000], [16_384, 16_384]] {
        let sentence = error_of(&Quad::default(), &options.clone().with_size(size));
        assert!(sentence.contains("pixels") && sentence.contains(&size[1].to_string()), "{sentence}");
    }
}
