//! Normal maps in PNG files: conversion, and chunks that are kept.

use darboux::Convention;
use darboux_io::LoadOptions;
use darboux_io::image::{Channels, PngImage, convert_normal_map, count_invalid_normals};
use png::{BitDepth, ColorType, Encoder};

const SIZE: [u32; 2] = [64, 32];

/// A PNG of every byte value in some order, with chunks before and after the texels.
fn png(color: ColorType, depth: BitDepth) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, SIZE[0], SIZE[1]);
    encoder.set_color(color);
    encoder.set_depth(depth);
    encoder.set_source_gamma(png::ScaledFloat::new(1.0));
    encoder.set_pixel_dims(Some(png::PixelDimensions { xppu: 2835, yppu: 2835, unit: png::Unit::Meter }));
    encoder.add_text_chunk("Author".into(), "someone".into()).expect("a text");
    let mut writer = encoder.write_header().expect("a header");
    writer.write_image_data(&raw(color, depth)).expect("texels");
    writer.write_chunk(png::chunk::ChunkType(*b"teSt"), b"private").expect("a chunk");
    writer.finish().expect("an end");
    file
}

fn raw(color: ColorType, depth: BitDepth) -> Vec<u8> {
    let length = SIZE[0] as usize * SIZE[1] as usize * color.samples() * (depth as usize / 8);
    (0..length).map(|i| (i as u32).wrapping_mul(0x9E37_79B9).to_be_bytes()[0]).collect()
}

/// The kind, size and raw texels of a PNG, by another reader than ours.
fn decoded(file: &[u8]) -> (ColorType, BitDepth, Vec<u8>) {
    let mut decoder = png::Decoder::new(std::io::Cursor::new(file));
    decoder.set_transformations(png::Transformations::IDENTITY);
    let mut reader = decoder.read_info().expect("a PNG");
    let mut texels = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut texels).expect("texels");
    (info.color_type, info.bit_depth, texels)
}

fn converted(file: &[u8], from: Convention, to: Convention, channels: &str, target: &str) -> Vec<u8> {
    let mut image = PngImage::from_bytes("test.png", file.to_vec(), &LoadOptions::default()).expect("a PNG");
    let [channels, target] = [channels, target].map(|letters| letters.parse::<Channels>().expect("letters"));
    convert_normal_map(&mut image, &from.to(to), channels, target).expect("a conversion");
    image.to_bytes().expect("a file")
}

/// All kinds, with the channels of x, y and z in each.
const KINDS: [(ColorType, &str); 3] =
    [(ColorType::Rgb, "rgb"), (ColorType::Rgba, "rgb"), (ColorType::GrayscaleAlpha, "la")];
const DEPTHS: [BitDepth; 2] = [BitDepth::Eight, BitDepth::Sixteen];

#[test]
fn every_pair_of_presets_comes_back_to_the_bit() {
    for (color, channels) in KINDS {
        for depth in DEPTHS {
            let file = png(color, depth);
            let before = decoded(&file);
            for (_, from) in Convention::PRESETS {
                for (_, to) in Convention::PRESETS {
                    let there = converted(&file, from, to, channels, channels);
                    assert_eq!(decoded(&there).2 != before.2, from.bitangent != to.bitangent);
                    assert!(decoded(&converted(&there, to, from, channels, channels)) == before);
                }
            }
        }
    }
}

/// Each component in each order of channels: what is inverted is the component, wherever it lies.
#[test]
fn presets_and_layouts_go_together_and_come_back() {
    for depth in DEPTHS {
        let file = png(ColorType::Rgba, depth);
        for layout in ["rgb", "ag", "bgr", "gra"] {
            for (name, to) in Convention::PRESETS {
                let from = Convention::GLTF;
                let there = converted(&file, from, to, layout, layout);
                let size = if depth == BitDepth::Eight { 1 } else { 2 };
                let green = "rgba".find(&layout[1..2]).expect("a channel");
                let inverts = from.bitangent != to.bitangent;
                let (before, after) = (decoded(&file).2, decoded(&there).2);
                let is_right = before.iter().zip(&after).enumerate().all(|(i, (before, after))| {
                    *after == if inverts && i / size % 4 == green { 255 - before } else { *before }
                });
                assert!(is_right, "{name} {layout}");
                assert!(
                    decoded(&converted(&there, to, from, layout, layout)) == decoded(&file),
                    "{name} {layout}"
                );
            }
        }
    }
}

#[test]
fn only_green_changes() {
    for depth in DEPTHS {
        let file = png(ColorType::Rgba, depth);
        let there = converted(&file, Convention::OPENGL, Convention::DIRECTX, "rgb", "rgb");
        let size = if depth == BitDepth::Eight { 1 } else { 2 };
        let (before, after) = (decoded(&file).2, decoded(&there).2);
        for (i, (before, after)) in before.iter().zip(&after).enumerate() {
            let is_green = i / size % 4 == 1;
            assert_eq!(*after, if is_green { 255 - before } else { *before }, "byte {i}");
        }
    }
}

#[test]
fn other_chunks_are_kept() {
    let file = png(ColorType::Rgb, BitDepth::Eight);
    let there = converted(&file, Convention::GLTF, Convention::UNREAL, "rgb", "rgb");
    let [before, after] = [&file, &there].map(|file| {
        let mut chunks = Vec::new();
        let mut rest = &file[8..];
        while rest.len() >= 12 {
            let length = u32::from_be_bytes(rest[..4].try_into().expect("four bytes")) as usize + 12;
            chunks.extend((&rest[4..8] != b"IDAT").then(|| rest[..length].to_vec()));
            rest = &rest[length..];
        }
        chunks
    });
    assert!(before.len() >= 6, "header, gamma, size, text, private, end");
    assert_eq!(before, after);
}

/// A palette becomes the colours that it stands for, also with fewer than 8 bits; without a change, the file
/// keeps it.
#[test]
fn palettes_are_expanded() {
    let palette = [[255, 0, 128], [10, 200, 250]];
    for (alpha, color) in [(None, ColorType::Rgb), (Some([255, 7]), ColorType::Rgba)] {
        for depth in [BitDepth::One, BitDepth::Eight] {
            let mut file = Vec::new();
            let mut encoder = Encoder::new(&mut file, 8, 2);
            encoder.set_color(ColorType::Indexed);
            encoder.set_depth(depth);
            encoder.set_palette(palette.concat());
            if let Some(alpha) = alpha {
                encoder.set_trns(alpha.to_vec());
            }
            let indices = [0, 1, 1, 0, 1, 0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 1];
            let packed = match depth {
                BitDepth::One => vec![0b0110_1000, 0b1111_0001],
                _ => indices.map(|index| index as u8).to_vec(),
            };
            encoder.write_header().and_then(|mut writer| writer.write_image_data(&packed)).expect("a PNG");
            assert_eq!(PngImage::obstacle(&file), None);
            let same = PngImage::from_bytes("palette", file.clone(), &LoadOptions::default()).expect("a PNG");
            assert_eq!(same.to_bytes().expect("a file"), file);
            let flipped = converted(&file, Convention::UNREAL, Convention::GLTF, "rgb", "rgb");
            let texel = |index: &usize| {
                let [r, g, b] = palette[*index];
                [r, 255 - g, b].into_iter().chain(alpha.map(|alpha| alpha[*index]))
            };
            let expected: Vec<u8> = indices.iter().flat_map(texel).collect();
            assert_eq!(decoded(&flipped), (color, BitDepth::Eight, expected));
            assert!(!flipped.windows(4).any(|kind| kind == b"PLTE" || kind == b"tRNS"));
        }
    }
}

#[test]
fn palettes_and_profiles_of_colours_do_not_go_into_greys() {
    let with = |color: ColorType, kinds: &[&[u8; 4]]| {
        let mut file = png(color, BitDepth::Eight);
        let texels = file.windows(4).position(|kind| kind == b"IDAT").expect("texels") - 4;
        let chunk = |kind: &&[u8; 4]| {
            let body = [&kind[..], b"abcabc"].concat();
            [&6u32.to_be_bytes()[..], &body, &crc32(&body).to_be_bytes()].concat()
        };
        file.splice(texels..texels, kinds.iter().flat_map(chunk));
        file
    };
    let same = Convention::GLTF;
    let kept = |file: &[u8], from: &str, to: &str, kind: &[u8; 4]| {
        converted(file, same, same, from, to).windows(4).any(|chunk| chunk == kind)
    };
    let colour = with(ColorType::Rgb, &[b"PLTE", b"sPLT"]);
    for kind in [b"PLTE", b"sPLT"] {
        assert!(kept(&colour, "rgb", "ag", kind) && !kept(&colour, "rgb", "la", kind));
    }
    let grey = with(ColorType::GrayscaleAlpha, &[b"iCCP"]);
    assert!(kept(&grey, "la", "la", b"iCCP") && !kept(&grey, "la", "rgb", b"iCCP"));
    assert_eq!(decoded(&converted(&colour, same, same, "rgb", "la")).0, ColorType::GrayscaleAlpha);
}

#[test]
fn photographs_are_told_from_normal_maps() {
    let plane = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/TwoSidedPlane/TwoSidedPlane_");
    let share = |name: &str, letters: &str| {
        let image =
            PngImage::open(format!("{plane}{name}.png").as_ref(), &LoadOptions::default()).expect("a PNG");
        let count = count_invalid_normals(&image, letters.parse().expect("letters"));
        count as f64 / f64::from(image.size()[0] * image.size()[1])
    };
    assert!(share("Normal", "rgb") < 0.01 && share("Normal", "rg") < 0.01);
    assert!(share("BaseColor", "rgb") > 0.5, "{}", share("BaseColor", "rgb"));
    assert_eq!(share("Normal", "la"), 1.0);
}

#[test]
fn vectors_move_to_other_channels_and_back() {
    let same = Convention::GLTF;
    let file = png(ColorType::Rgb, BitDepth::Eight);
    let packed = converted(&file, same, same, "rgb", "ag");
    let (color, _, texels) = decoded(&packed);
    assert_eq!(color, ColorType::Rgba);
    for (before, after) in decoded(&file).2.as_chunks::<3>().0.iter().zip(texels.as_chunks::<4>().0) {
        assert_eq!([after[3], after[1]], [before[0], before[1]]);
    }
    let back = decoded(&converted(&packed, same, same, "ag", "rgb")).2;
    for (before, after) in decoded(&file).2.as_chunks::<3>().0.iter().zip(back.as_chunks::<4>().0) {
        assert_eq!(after[..2], before[..2]);
        assert_eq!(after[3], 255);
    }
    let grey = png(ColorType::GrayscaleAlpha, BitDepth::Sixteen);
    assert_eq!(decoded(&converted(&grey, same, same, "la", "rgb")).0, ColorType::Rgb);
}

#[test]
fn unsupported_images_are_errors() {
    let pointer = b"version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 1\n";
    let cases: [(Vec<u8>, &str); 7] = [
        (png(ColorType::Grayscale, BitDepth::Eight), "one channel"),
        (b"GIF89a".to_vec(), "not a PNG"),
        (pointer.to_vec(), "a pointer of Git LFS, not the image; run: git lfs pull"),
        (png(ColorType::Rgb, BitDepth::Eight)[..100].to_vec(), "ends within a chunk"),
        (claiming(u32::MAX >> 1), "too short for"),
        (claiming(65), "not a complete PNG"),
        (claiming(0), "not a complete PNG"),
    ];
    for (file, part) in cases {
        let error = PngImage::from_bytes("test.png", file, &LoadOptions::default())
            .expect_err("an error")
            .to_string();
        assert!(error.starts_with("test.png: ") && error.contains(part), "{error}");
    }
    let mut image =
        PngImage::from_bytes("test.png", png(ColorType::Rgb, BitDepth::Eight), &LoadOptions::default())
            .expect("a PNG");
    let conversion = Convention::GLTF.to(Convention::GLTF);
    let error = convert_normal_map(&mut image, &conversion, "ag".parse().expect("letters"), Channels::RGB);
    assert!(error.expect_err("an error").to_string().contains("has the channels rgb, not ag"));
}

/// A PNG whose header claims another height, with a right checksum.
fn claiming(height: u32) -> Vec<u8> {
    let mut file = png(ColorType::Rgb, BitDepth::Eight);
    file[20..24].copy_from_slice(&height.to_be_bytes());
    let checksum = crc32(&file[12..29]).to_be_bytes();
    file[29..33].copy_from_slice(&checksum);
    file
}

/// The checksum of the PNG specification, annex D.
fn crc32(bytes: &[u8]) -> u32 {
    let step = |crc: u32| if crc & 1 == 1 { 0xEDB8_8320 ^ (crc >> 1) } else { crc >> 1 };
    let byte = |crc: u32, &byte: &u8| (0..8).fold(crc ^ u32::from(byte), |crc, _| step(crc));
    !bytes.iter().fold(u32::MAX, byte)
}

#[test]
fn cut_and_damaged_files_are_errors_or_images_and_never_a_panic() {
    let file = png(ColorType::Rgba, BitDepth::Sixteen);
    for at in 0..file.len().min(400) {
        let mut damaged = file.clone();
        damaged[at] ^= 0x5A;
        let _ = PngImage::from_bytes("test.png", damaged, &LoadOptions::default())
            .and_then(|image| image.to_bytes());
        assert!(PngImage::from_bytes("test.png", file[..at].to_vec(), &LoadOptions::default()).is_err());
    }
}

#[test]
fn letters_name_two_or_three_different_channels() {
    for letters in ["rgb", "rg", "ag", "ga", "la", "bgr", "abg"] {
        assert_eq!(letters.parse::<Channels>().expect("channels").to_string(), letters);
    }
    for letters in ["", "r", "rr", "rgr", "rgba", "lg", "xy", "RGB"] {
        assert!(letters.parse::<Channels>().is_err(), "{letters}");
    }
}
