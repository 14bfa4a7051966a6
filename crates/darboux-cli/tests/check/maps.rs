//! Images: what is found in them, and their repair.

use std::fs;
use std::path::Path;

use crate::codes;
use crate::common::{asset, darboux, darboux_reading, text};

#[test]
fn maps_are_judged_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let side = 128u32;
    let bump = |i: u32, up: f32| {
        let (x, y) = ((i % side) as f32 / 5.0, (i / side) as f32 / 5.0);
        let normal = [-x.cos() * y.sin() / 5.0, up * x.sin() * y.cos() / 5.0, 1.0];
        let length = normal.iter().map(|x| x * x).sum::<f32>().sqrt();
        normal.map(|x| (127.5 + 127.5 * x / length).round() as u8)
    };
    let map = |name: &str, up: f32| {
        let path = folder.path().join(name);
        let mut encoder = png::Encoder::new(fs::File::create(&path).expect("a file"), side, side);
        encoder.set_color(png::ColorType::Rgb);
        let texels: Vec<u8> = (0..side * side).flat_map(|i| bump(i, up)).collect();
        encoder.write_header().and_then(|mut writer| writer.write_image_data(&texels)).expect("a PNG");
        path
    };
    let (up, down) = (map("up.png", 1.0), map("down.png", -1.0));
    let verdict = |path, arguments: &[&str], code| {
        let report = darboux(&[&["check", text(path), "--json"], arguments].concat()).exits(code).json();
        report["files"][0]["map"]["verdict"].as_str().map(str::to_owned)
    };
    assert_eq!(verdict(&up, &[], 0).as_deref(), Some("opengl"));
    assert_eq!(verdict(&down, &[], 1).as_deref(), Some("directx"));
    assert_eq!(verdict(&down, &["--convention", "directx"], 0).as_deref(), Some("directx"));
    assert_eq!(verdict(&up, &["--convention", "directx"], 1).as_deref(), Some("opengl"));
    let printed = darboux(&["check", text(&down)]).exits(1);
    let printed = String::from_utf8_lossy(&printed.stdout).into_owned();
    assert!(printed.contains("DirectX") && printed.contains("map-green-flipped"), "{printed}");

    // Without its model, the map may as well have inverted red.
    let before = fs::read(&down).expect("a file");
    let left = darboux(&["check", text(&down), "--fix", "--in-place"]).exits(1);
    assert!(
        left.stderr.contains("--model") && left.stderr.contains("--assume map=directx"),
        "{}",
        left.stderr
    );
    assert_eq!(fs::read(&down).expect("a file"), before);
    let box_model = asset("made/strips-fans-lines-points.gltf");
    // Its faces do not decide that, and the user does.
    let left = darboux(&["check", text(&down), "--model", text(&box_model), "--fix", "--in-place"]).exits(1);
    assert!(left.stderr.contains("--assume map=directx"), "{}", left.stderr);
    let model = ["--model", text(&box_model), "--assume", "map=directx"];
    let fixed = folder.path().join("fixed.png");
    let arguments = ["check", text(&down), "--fix", "-o", text(&fixed), "--json"];
    let repair = darboux(&[&arguments[..], &model].concat()).exits(0).json();
    assert_eq!(codes(&repair, |finding| finding["repaired"] == true), ["map-green-flipped"]);
    assert_eq!(verdict(&fixed, &[], 0).as_deref(), Some("opengl"));
    darboux(&[&["check", text(&down), "--fix", "--in-place"], &model[..]].concat()).exits(0);
    assert_eq!(fs::read(&down).expect("a file"), fs::read(&fixed).expect("a file"));

    // The plane's signs w are flipped, so that a map with green down looks right on it. That green of the
    // other map is up is 98.8 % sure, too little to repair the signs alone.
    let plane = asset("TwoSidedPlane/TwoSidedPlane.gltf");
    let arguments = ["check", text(&up), "--model", text(&plane), "--json"];
    let on_model = darboux(&arguments).exits(0).json();
    assert_eq!(codes(&on_model, |finding| finding["severity"] == "warning"), ["tangent-sign-flipped"]);
    let assumed = [&arguments[..], &["--assume", "map=opengl"]].concat();
    let on_model = darboux(&assumed).exits(1).json();
    assert_eq!(codes(&on_model, |finding| finding["severity"] == "error"), ["tangent-sign-flipped"]);
    let down_again = map("down.png", -1.0);
    let arguments = ["check", text(&down_again), "--model", text(&plane)];
    let printed = darboux(&arguments).exits(0);
    assert!(String::from_utf8_lossy(&printed.stdout).contains("two conventions cancel"));
    darboux(&["check", text(&up), "--model", "nothing.glb"]).exits(1);

    let broken = folder.path().join("broken.png");
    fs::write(&broken, &fs::read(&up).expect("a file")[..200]).expect("a file");
    let report = darboux(&["check", text(&broken), "--json"]).exits(1).json();
    assert_eq!(report["files"][0]["findings"][0]["code"], "map-unreadable");
}

/// A palette is expanded where the map is repaired.
#[test]
fn maps_with_a_palette_are_repaired() {
    let folder = tempfile::tempdir().expect("a folder");
    let image = bumps(-1.0);
    let mut palette: Vec<[u8; 3]> = image.pixels().map(|pixel| pixel.0).collect();
    palette.sort_unstable();
    palette.dedup();
    // The nearest of 256 colours.
    let step = palette.len().div_ceil(256);
    let palette: Vec<[u8; 3]> = palette.into_iter().step_by(step).collect();
    let distance =
        |a: [u8; 3], b: [u8; 3]| (0..3).map(|i| u32::from(a[i].abs_diff(b[i])).pow(2)).sum::<u32>();
    let nearest = |colour: [u8; 3]| {
        (0..palette.len()).min_by_key(|&index| distance(palette[index], colour)).unwrap_or_default() as u8
    };
    let indices: Vec<u8> = image.pixels().map(|pixel| nearest(pixel.0)).collect();
    let path = folder.path().join("down.png");
    let mut encoder =
        png::Encoder::new(fs::File::create(&path).expect("a file"), image.width(), image.height());
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_palette(palette.concat());
    encoder.write_header().and_then(|mut writer| writer.write_image_data(&indices)).expect("a PNG");
    let report =
        darboux(&["check", text(&path), "--assume", "map=directx", "--fix", "--json", "--fail-on", "never"])
            .exits(0)
            .json();
    let repaired = codes(&report, |finding| finding["repaired"] == true);
    assert!(repaired.contains(&"map-green-flipped".to_owned()), "{report}");
    let fixed = image::open(folder.path().join("down.fixed.png")).expect("the repaired map").to_rgb8();
    let expected = indices.iter().map(|&index| palette[usize::from(index)]).map(|[r, g, b]| [r, 255 - g, b]);
    assert!(fixed.pixels().map(|pixel| pixel.0).eq(expected));
}

/// A normal map of bumps; `up` is 1 for OpenGL and -1 for DirectX.
pub fn bumps(up: f32) -> image::RgbImage {
    image::RgbImage::from_fn(128, 128, |x, y| {
        let (x, y) = (x as f32 / 5.0, y as f32 / 5.0);
        let normal = [-x.cos() * y.sin() / 5.0, up * x.sin() * y.cos() / 5.0, 1.0];
        let length = normal.iter().map(|x| x * x).sum::<f32>().sqrt();
        image::Rgb(normal.map(|x| (127.5 + 127.5 * x / length).round() as u8))
    })
}

/// Writes a TGA: rows from top to bottom, blue first.
fn save_tga(path: &Path, image: &image::RgbImage) {
    let [width, height] = [image.width(), image.height()].map(|side| (side as u16).to_le_bytes());
    let header = [&[0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0][..], &width, &height, &[24, 0x20]].concat();
    let texels = image.pixels().flat_map(|&image::Rgb([r, g, b])| [b, g, r]);
    fs::write(path, header.into_iter().chain(texels).collect::<Vec<u8>>()).expect("a file");
}

/// A JPEG and a TGA are repaired into a PNG, a WebP is left, and a healthy image is not written.
#[test]
fn images_that_are_no_png() {
    let folder = tempfile::tempdir().expect("a folder");
    let save = |name: &str, up: f32| {
        let path = folder.path().join(name);
        bumps(up).save(&path).expect("an image");
        path
    };
    let [jpeg, webp] = ["down.jpg", "flipped.webp"].map(|name| save(name, -1.0));
    let tga = folder.path().join("truevision.TGA");
    save_tga(&tga, &bumps(-1.0));
    let strip = asset("made/strips-fans-lines-points.gltf");
    for (path, fixable, code) in [(&jpeg, true, 0), (&webp, false, 1), (&tga, true, 0)] {
        let on_model = ["check", text(path), "--model", text(&strip), "--assume", "map=directx", "--json"];
        let report = darboux(&on_model).exits(1).json();
        let named = |finding: &serde_json::Value| {
            finding["fixable"] == fixable && finding["code"] == "map-green-flipped"
        };
        assert_eq!(codes(&report, named), ["map-green-flipped"], "{report}");
        let report = darboux(&[&on_model[..], &["--fix"]].concat()).exits(code).json();
        assert_eq!(
            codes(&report, |finding| finding["repaired"] == fixable),
            ["map-green-flipped"],
            "{report}"
        );
    }
    for name in ["down.fixed.png", "truevision.fixed.png"] {
        darboux(&["check", text(&folder.path().join(name))]).exits(0);
    }
    let repaired = image::open(folder.path().join("truevision.fixed.png")).expect("a PNG").into_rgb8();
    let inverted = bumps(-1.0).pixels().map(|texel| 255 - texel[1]).collect::<Vec<_>>();
    assert_eq!(repaired.pixels().map(|texel| texel[1]).collect::<Vec<_>>(), inverted);
    let before = fs::read(&jpeg).expect("a file");
    let refused = darboux(&["check", text(&jpeg), "--assume", "map=directx", "--fix", "--in-place"]).exits(1);
    assert!(refused.stderr.contains("use -o FILE.png"), "{}", refused.stderr);
    assert_eq!(fs::read(&jpeg).expect("a file"), before);

    let count = || fs::read_dir(&folder).expect("a folder").count();
    for name in ["up.jpg", "up.webp"] {
        let path = save(name, 1.0);
        let files = count();
        for arguments in [&[][..], &["--in-place"]] {
            let report =
                darboux(&[&["check", text(&path), "--fix", "--json"], arguments].concat()).exits(0).json();
            assert_eq!(report["files"][0]["status"], "untouched", "{name}");
        }
        assert_eq!(count(), files, "{name}");
    }
    fs::write(folder.path().join("up.fixed.png"), "older").expect("a file");
    let warned = darboux(&["check", text(&folder.path().join("up.jpg")), "--fix"]).exits(0);
    assert!(warned.stderr.contains("up.fixed.png exists and was not written"), "{}", warned.stderr);
    let broken = folder.path().join("broken.png");
    fs::write(&broken, "no image").expect("a file");
    let found = |arguments: &[&str]| {
        let report = darboux(&[&["check", text(&broken), "--json"], arguments].concat()).exits(1).json();
        report["files"][0]["findings"][0]["text"].clone()
    };
    assert_eq!(found(&[]), found(&["--fix"]));
}

/// An image that was cut off is not judged, whether a row or only the end is missing.
#[test]
fn truncated_images_are_unreadable() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["whole.jpg", "whole.png", "whole.webp"] {
        let whole = folder.path().join(name);
        bumps(1.0).save(&whole).expect("an image");
        darboux(&["check", text(&whole)]).exits(0);
        let bytes = fs::read(&whole).expect("a file");
        let cut = folder.path().join(format!("cut-{name}"));
        for length in [bytes.len() / 4, bytes.len() / 2, bytes.len() * 9 / 10, bytes.len() - 2] {
            fs::write(&cut, &bytes[..length]).expect("a file");
            let report = darboux(&["check", text(&cut), "--json"]).json();
            // The last bytes of a PNG and of a WebP hold no texels.
            if name == "whole.jpg" || length < bytes.len() - 2 {
                assert_eq!(codes(&report, |_| true), ["map-unreadable"], "{name}, {length}: {report}");
            }
        }
    }
    // What follows the end of an image is not part of it.
    let jpeg = folder.path().join("whole.jpg");
    let longer = [fs::read(&jpeg).expect("a file"), b"more".to_vec()].concat();
    fs::write(&jpeg, longer).expect("a file");
    darboux(&["check", text(&jpeg)]).exits(0);
}

/// Images are recognised on standard input, too.
#[test]
fn images_are_read_from_standard_input() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["up.png", "up.jpg", "up.webp"] {
        let path = folder.path().join(name);
        bumps(1.0).save(&path).expect("an image");
        let file = fs::read(&path).expect("a file");
        let report = darboux_reading(&["check", "-", "--json"], &file).exits(0).json();
        assert_eq!(report["files"][0]["map"]["verdict"], "opengl", "{name}");
    }
    let path = folder.path().join("down.png");
    bumps(-1.0).save(&path).expect("an image");
    let file = fs::read(&path).expect("a file");
    let fixed = darboux_reading(&["check", "-", "--assume", "map=directx", "--fix"], &file).exits(0);
    let report = darboux_reading(&["check", "-", "--json"], &fixed.stdout).exits(0).json();
    assert_eq!(report["files"][0]["map"]["verdict"], "opengl");
}

/// Why there is no verdict on a small map.
#[test]
fn small_maps_are_told_why_they_stay_undecided() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("small.png");
    image::imageops::crop_imm(&bumps(1.0), 0, 0, 4, 4).to_image().save(&path).expect("an image");
    let printed = darboux(&["check", text(&path)]).exits(0);
    let printed = String::from_utf8(printed.stdout).expect("text");
    assert!(printed.contains("too few of them"), "{printed}");
}

/// A folder of textures says what to call, and formats without a decoder say what to do.
#[test]
fn folders_of_images_and_other_formats_say_what_to_do() {
    let folder = tempfile::tempdir().expect("a folder");
    let map = folder.path().join("brick_normal.png");
    fs::write(folder.path().join("brick_color.jpg"), b"a picture").expect("a file");
    fs::write(&map, b"a map").expect("a file");
    let run = darboux(&["check", text(folder.path())]).exits(1);
    let advice = format!(
        "it has 2 images (.png, .jpg, .webp, .tga): name those that are normal maps, as in `darboux check {}`",
        text(&map)
    );
    assert!(run.stderr.contains(&advice), "{}", run.stderr);
    for extension in ["BMP", "dds", "exr", "tif"] {
        let image = folder.path().join(format!("map.{extension}"));
        fs::write(&image, b"an image").expect("a file");
        let run = darboux(&["check", text(&image)]).exits(1);
        assert!(run.stderr.contains("save it as .png"), "{}", run.stderr);
    }
}
