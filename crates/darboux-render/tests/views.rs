//! Tests pictures with lines, mirrored edges, derived tangents, mistakes and two sides, and the framing of
//! the camera.

mod common;

use common::{BACKGROUND, Quad, document, has_adapter_or_says_so};
use darboux_render::{Camera, LINE_COLORS, Lines, Mistakes, Model, RenderOptions, SEAM_COLOR, Side, View};

/// The width and height of the pictures.
const SIZE: usize = 64;

/// The pixels in the middle of the left and the right half.
fn halves(pixels: &[[u8; 3]]) -> [[u8; 3]; 2] {
    [SIZE / 4, 3 * SIZE / 4].map(|column| pixels[SIZE / 2 * SIZE + column])
}

fn light([r, g, b]: [u8; 3]) -> u32 {
    u32::from(r) + u32::from(g) + u32::from(b)
}

fn is_about(pixel: [u8; 3], color: [u8; 3]) -> bool {
    pixel.iter().zip(color).all(|(a, b)| a.abs_diff(b) <= 3)
}

/// The first and last column, and the first and last row, with pixels of about this colour. Lines are narrow,
/// so their pixels blend with the background.
fn extent(pixels: &[[u8; 3]], color: [u8; 3]) -> Option<[[usize; 2]; 2]> {
    let is_like = |pixel: &[u8; 3]| pixel.iter().zip(color).all(|(a, b)| a.abs_diff(b) <= 100);
    let found = pixels.iter().enumerate().filter(|(_, pixel)| is_like(pixel));
    let found: Vec<[usize; 2]> = found.map(|(at, _)| [at % SIZE, at / SIZE]).collect();
    let ends = |i: usize| Some([found.iter().map(|p| p[i]).min()?, found.iter().map(|p| p[i]).max()?]);
    Some([ends(0)?, ends(1)?])
}

/// Options that draw the quad in one colour, which no line has.
fn plain() -> RenderOptions {
    common::options(View::Normal)
}

#[test]
fn lines_lead_from_vertices_along_their_vectors() {
    if !has_adapter_or_says_so() {
        return;
    }
    let none = Lines::default().with_length(0.25);
    let quad = Quad { w: [-1.0; 2], ..Quad::default() };
    let seen = |lines: Lines, color| extent(&common::drawn(&quad, &plain().with_lines(lines)).pixels, color);
    let tangents = none.with_tangent(true);
    let bitangents = none.with_bitangent(true);
    // The vertices are in the columns 1, 32 and 63 and in the rows 1 and 63. The lines are 11 pixels long.
    let [columns, rows] = seen(tangents, LINE_COLORS[0]).expect("tangents");
    assert!(columns[0] >= 1 && rows == [1, 62], "{columns:?} {rows:?}");
    assert_eq!(seen(tangents, LINE_COLORS[1]), None);
    // With w = -1 bitangents point down.
    let crosses = |quad: &Quad, row: usize| {
        let pixels = common::drawn(quad, &plain().with_lines(bitangents)).pixels;
        extent(&pixels[row * SIZE..][..SIZE], LINE_COLORS[1]).is_some()
    };
    assert!(crosses(&quad, 6) && !crosses(&quad, 58));
    let up = Quad::default();
    assert!(crosses(&up, 58) && !crosses(&up, 6) && !crosses(&up, 40));
    // From the side the surface is a line in the middle, and normals point left.
    let mut side = common::options(View::Tangent).with_lines(none.with_normal(true));
    side.camera.yaw = 90.0;
    let [columns, _] = extent(&common::drawn(&quad, &side).pixels, LINE_COLORS[2]).expect("normals");
    assert!(columns[1] <= 33 && columns[1] - columns[0] > 4, "{columns:?}");
    assert_eq!(seen(none, LINE_COLORS[0]), None);
}

#[test]
fn bitangents_follow_a_wrong_w() {
    if !has_adapter_or_says_so() {
        return;
    }
    let options = plain().with_lines(Lines::default().with_bitangent(true).with_length(0.25));
    let has_lines = |w, row: usize| {
        let pixels = common::drawn_wrong(&Quad::default(), Mistakes::default().with_w(w), &options).pixels;
        extent(&pixels[row * SIZE..][..SIZE], LINE_COLORS[1]).is_some()
    };
    // Bitangents lead from the lower vertices up, or from the upper vertices down.
    assert!(has_lines(false, 58) && !has_lines(false, 6));
    assert!(has_lines(true, 6) && !has_lines(true, 58));
}

#[test]
fn seams_are_where_the_sign_changes() {
    if !has_adapter_or_says_so() {
        return;
    }
    let options = plain().with_seams(true);
    let [columns, rows] =
        extent(&common::drawn(&Quad::mirrored(), &options).pixels, SEAM_COLOR).expect("a seam");
    assert!(columns[0] >= 31 && columns[1] <= 33, "{columns:?}");
    assert!(rows[0] <= 4 && rows[1] >= 60, "{rows:?}");
    assert_eq!(extent(&common::drawn(&Quad::default(), &options).pixels, SEAM_COLOR), None);
    // From behind the edge is visible too.
    let mut behind = options;
    behind.camera.yaw = 180.0;
    assert!(extent(&common::drawn(&Quad::mirrored(), &behind).pixels, SEAM_COLOR).is_some());
}

#[test]
fn derivatives_are_along_the_uvs_of_every_triangle() {
    if !has_adapter_or_says_so() {
        return;
    }
    let derived = |quad: &Quad, view| {
        let document = document(quad);
        let model = Model::read(&document).expect("a model").derived();
        halves(&common::shown(&model, Mistakes::default(), &common::options(view)).pixels)
    };
    // The file has wrong tangents, or none.
    for has_tangents in [false, true] {
        let quad = Quad { has_tangents, tangent: [0.0, 0.0, 1.0], ..Quad::mirrored() };
        let [left, right] = derived(&quad, View::Tangent);
        assert!(is_about(left, [0, 128, 128]) && is_about(right, [255, 128, 128]), "{left:?} {right:?}");
        for pixel in derived(&quad, View::Bitangent) {
            assert!(is_about(pixel, [128, 255, 128]), "{pixel:?}");
        }
    }
    // Shading derives frames at every pixel. Along u it is as with correct tangents, along v both halves lean
    // to the same side.
    let along_u = Quad { texel: [220, 128, 200], ..Quad::mirrored() };
    let right = halves(&common::drawn(&along_u, &common::options(View::Shaded)).pixels);
    let seen = |quad| derived(&Quad { tangent: [0.0, 0.0, 1.0], ..quad }, View::Shaded);
    for (a, b) in seen(along_u).into_iter().zip(right) {
        assert!(is_about(a, b), "{a:?} {b:?}");
    }
    let [up, flat] = [[128, 220, 200], [128, 128, 255]].map(|texel| seen(Quad { texel, ..Quad::mirrored() }));
    assert!((0..2).all(|half| light(up[half]) > light(flat[half]) + 15), "{up:?} {flat:?}");
}

#[test]
fn the_angle_to_derived_tangents_is_drawn() {
    if !has_adapter_or_says_so() {
        return;
    }
    let [first, second] = [(); 2].map(|()| document(&Quad { tangent: [0.0, 1.0, 0.0], ..Quad::default() }));
    let derived = Model::read(&second).expect("a model").derived();
    let model = Model::read(&first).expect("a model").compared_with(&derived);
    let [left, _] = halves(&common::shown(&model, Mistakes::default(), &common::options(View::Angle)).pixels);
    // 90 degrees are at 0.93 of the scale.
    let [below, last] = [7, 8].map(|step| common::heat().ramp[step]);
    assert!(left[0] > below[0] && left[0] < last[0], "{left:?}");
}

#[test]
fn mistakes_change_the_shading() {
    if !has_adapter_or_says_so() {
        return;
    }
    let up = Quad { texel: [128, 220, 200], ..Quad::default() };
    let options = common::options(View::Shaded);
    let seen = |mistakes| halves(&common::drawn_wrong(&up, mistakes, &options).pixels)[0];
    let (none, right) = (Mistakes::default(), seen(Mistakes::default()));
    for wrong in [none.with_green(true), none.with_w(true)] {
        assert!(light(seen(wrong)) + 60 < light(right), "{wrong:?}");
    }
    // Two mistakes cancel out.
    assert!(is_about(seen(Mistakes::default().with_green(true).with_w(true).with_v(false)), right));
    let sign = |mistakes| halves(&common::drawn_wrong(&up, mistakes, &common::options(View::Sign)).pixels)[0];
    assert!(sign(none)[2] > 190 && sign(none.with_w(true))[0] > 200);
}

#[test]
fn images_are_upside_down_if_v_is_flipped() {
    if !has_adapter_or_says_so() {
        return;
    }
    let texels = image::RgbImage::from_fn(32, 32, |_, y| {
        image::Rgb(if y < 16 { [220, 30, 30] } else { [30, 30, 220] })
    });
    let base = common::file_of(&texels.into(), image::ImageFormat::Png);
    let quad = Quad { base: Some((base, "image/png")), ..Quad::default() };
    let upper = |v| {
        let pixels =
            common::drawn_wrong(&quad, Mistakes::default().with_v(v), &common::options(View::Shaded)).pixels;
        pixels[SIZE / 4 * SIZE + SIZE / 2]
    };
    let [right, wrong] = [upper(false), upper(true)];
    assert!(right[0] > right[2] + 60 && wrong[2] > wrong[0] + 60, "{right:?} {wrong:?}");
}

#[test]
fn a_picture_has_two_sides() {
    if !has_adapter_or_says_so() {
        return;
    }
    let [mut left, mut right] =
        [Quad::default(), Quad { tangent: [0.0, 1.0, 0.0], ..Quad::default() }].map(|quad| document(&quad));
    let [left, right] = [&mut left, &mut right].map(|document| Model::read(document).expect("a model"));
    let side = |model| Side { model, mistakes: Mistakes::default() };
    let split = |at| {
        let gpu = common::gpu().expect("an adapter");
        let right = Some((side(&right), at));
        darboux_render::render(gpu, side(&left), right, &common::options(View::Tangent))
            .expect("a picture")
            .pixels
    };
    let [along_x, along_y] = [[255, 128, 128], [128, 255, 128]];
    for (at, colors) in [(0.5, [along_x, along_y]), (0.0, [along_y; 2]), (1.0, [along_x; 2])] {
        let seen = halves(&split(at));
        assert!(is_about(seen[0], colors[0]) && is_about(seen[1], colors[1]), "{at}: {seen:?}");
    }
    // The sides meet at exactly this column.
    let row = &split(0.5)[SIZE / 2 * SIZE..][..SIZE];
    assert!(is_about(row[31], along_x) && is_about(row[32], along_y) && row[0] == BACKGROUND);
}

#[test]
fn models_are_centred_whatever_the_direction_of_the_camera() {
    if !has_adapter_or_says_so() {
        return;
    }
    for [yaw, pitch] in [[0.0, 0.0], [30.0, 20.0], [-60.0, 45.0], [150.0, -30.0]] {
        let camera = darboux_render::Camera { yaw, pitch, zoom: 1.0 };
        let options = plain().with_camera(camera).with_size([96, 64]);
        // Only one triangle, so the centre of its bounding box is not its own.
        let document = &mut document(&Quad { triangle_count: 1, ..Quad::default() });
        let model = Model::read(document).expect("a model");
        let pixels = common::shown(&model, Mistakes::default(), &options).pixels;
        let covered =
            (0..).zip(&pixels).filter(|(_, pixel)| **pixel != BACKGROUND).map(|(at, _)| [at % 96, at / 96]);
        let covered: Vec<[i32; 2]> = covered.collect();
        for (axis, size) in [96, 64].into_iter().enumerate() {
            let first = covered.iter().map(|at| at[axis]).min().expect("a triangle");
            let last = covered.iter().map(|at| at[axis]).max().expect("a triangle");
            let (before, after) = (first, size - 1 - last);
            assert!((before - after).abs() <= 2, "{yaw}, {pitch}, axis {axis}: margins {before} and {after}");
        }
    }
}

/// Whether a pixel and its neighbours pass a test. Pixels at the edge of the picture have too few.
fn all_around(at: usize, test: impl Fn(usize) -> bool) -> bool {
    let [column, row] = [at % SIZE, at / SIZE];
    (1..SIZE - 1).contains(&column)
        && (1..SIZE - 1).contains(&row)
        && [-1, 0, 1].iter().all(|dy: &isize| {
            [-1, 0, 1].iter().all(|dx: &isize| test((at as isize + dy * SIZE as isize + dx) as usize))
        })
}

#[test]
fn the_ground_darkens_what_is_behind_the_model_and_nothing_else() {
    if !has_adapter_or_says_so() {
        return;
    }
    let seen = |view, pitch, ground| {
        let camera = Camera { yaw: 30.0, pitch, zoom: 0.7 };
        let options = common::options(view).with_camera(camera).with_background([200; 3]);
        common::drawn(&Quad::default(), &options.with_ground(ground)).pixels
    };
    for view in [View::Shaded, View::TestBumps] {
        let [with, without] = [true, false].map(|ground| seen(view, 25.0, ground));
        let is_model = |at: usize| without[at] != [200; 3];
        let changed = (0..SIZE * SIZE).filter(|&at| with[at] != without[at]);
        let changed: Vec<usize> = changed.collect();
        assert!(changed.len() > SIZE * SIZE / 60, "{} pixels are darker", changed.len());
        for at in changed {
            assert!(light(with[at]) < light(without[at]), "a pixel is brighter");
            assert!(!all_around(at, is_model), "a pixel inside the model changed");
        }
        assert_eq!(with[0], [200; 3], "the ground fades to nothing");
        assert!(seen(view, -25.0, true) == seen(view, -25.0, false), "it is not seen from below");
    }
    for view in [View::Tangent, View::Bitangent, View::Normal, View::Sign, View::Angle] {
        assert!(seen(view, 25.0, true) == seen(view, 25.0, false), "{view:?} has no ground");
    }
}
