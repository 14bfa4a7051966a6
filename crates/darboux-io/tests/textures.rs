//! Texture files decode to the texels that were encoded.
#![cfg(feature = "textures")]

use darboux_io::image::{DecodeError, DecodeLimits, PngImage, RgbaCodes, RgbaImage};
use darboux_io::{LoadOptions, MemoryLimit};

/// A PNG of 8 or 16 bits per channel.
fn png(color: png::ColorType, depth: png::BitDepth, [width, height]: [u32; 2], data: &[u8]) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    if color == png::ColorType::Indexed {
        encoder.set_palette(vec![1, 2, 3, 4, 5, 6]);
        encoder.set_trns(vec![255, 7]);
    }
    encoder.write_header().unwrap().write_image_data(data).unwrap();
    file
}

fn decoded(file: &[u8]) -> RgbaImage {
    RgbaImage::decode(file, &DecodeLimits::default()).unwrap()
}

#[test]
fn every_kind_of_png_becomes_rgba() {
    use png::BitDepth::{Eight, One, Sixteen};
    use png::ColorType::{Grayscale, GrayscaleAlpha, Indexed, Rgb, Rgba};

    let cases: [(_, _, &[u8], [[u8; 4]; 2]); 6] = [
        (Grayscale, Eight, &[9, 200], [[9, 9, 9, 255], [200, 200, 200, 255]]),
        (Grayscale, One, &[0b0100_0000], [[0, 0, 0, 255], [255; 4]]),
        (GrayscaleAlpha, Eight, &[9, 8, 200, 0], [[9, 9, 9, 8], [200, 200, 200, 0]]),
        (Rgb, Sixteen, &[0, 127, 0, 129, 255, 255, 0, 0, 1, 0, 1, 128], [[0, 1, 255, 255], [0, 1, 1, 255]]),
        (Rgba, Eight, &[1, 2, 3, 4, 5, 6, 7, 8], [[1, 2, 3, 4], [5, 6, 7, 8]]),
        (Indexed, One, &[0b0100_0000], [[1, 2, 3, 255], [4, 5, 6, 7]]),
    ];
    for (color, depth, data, texels) in cases {
        let image = decoded(&png(color, depth, [2, 1], data));
        assert_eq!((image.width, image.height), (2, 1));
        assert_eq!(image.texels, texels, "{color:?} {depth:?}");
    }
}

#[test]
fn pngs_of_16_bits_keep_them() {
    use png::BitDepth::{Eight, Sixteen};
    use png::ColorType::{Grayscale, GrayscaleAlpha, Rgb, Rgba};

    let decoded = |file: &[u8]| RgbaCodes::decode(file, &DecodeLimits::default());
    let words = [0x0102u16, 0xfffe, 0x8000, 7, 0, 0x00ff, 0xff00, 0x1234];
    let data: Vec<u8> = words.iter().flat_map(|word| word.to_be_bytes()).collect();
    let [a, b, c, d, e, f, g, h] = words;
    let cases = [
        (Grayscale, 2, [[a, a, a, 0xffff], [b, b, b, 0xffff]]),
        (GrayscaleAlpha, 4, [[a, a, a, b], [c, c, c, d]]),
        (Rgb, 6, [[a, b, c, 0xffff], [d, e, f, 0xffff]]),
        (Rgba, 8, [[a, b, c, d], [e, f, g, h]]),
    ];
    for (color, count, texels) in cases {
        let file = png(color, Sixteen, [2, 1], &data[..2 * count]);
        assert_eq!(decoded(&file), Ok(([2, 1], RgbaCodes::Words(texels.to_vec()))), "{color:?}");
        assert!(RgbaCodes::decode(&file, &DecodeLimits::default().with_max_texels(1)).is_err());
    }
    let file = png(Rgba, Eight, [2, 1], &data[..8]);
    let texels = vec![[1, 2, 0xff, 0xfe], [0x80, 0, 0, 7]];
    assert_eq!(decoded(&file), Ok(([2, 1], RgbaCodes::Bytes(texels))));
    let cut = png(Rgb, Sixteen, [2, 1], &data[..12]);
    assert!(decoded(&cut[..cut.len() - 20]).is_err());
}

#[test]
fn images_above_the_limits_are_refused() {
    let file = png(png::ColorType::Grayscale, png::BitDepth::Eight, [3, 2], &[0; 6]);
    let decode = |side, texels| {
        RgbaImage::decode(&file, &DecodeLimits::default().with_max_side(side).with_max_texels(texels))
    };
    assert!(decode(3, 6).is_ok());
    let too_large = Err(DecodeError::TooLarge { width: 3, height: 2 });
    assert_eq!((decode(2, 6), decode(3, 5)), (too_large.clone(), too_large));
}

#[test]
fn other_formats_are_named() {
    let error = |file: &[u8]| RgbaImage::decode(file, &DecodeLimits::default()).unwrap_err();
    #[cfg(not(feature = "ktx2"))]
    assert_eq!(error(b"\xABKTX 20\xBB\r\n\x1A\n"), DecodeError::NoDecoder("KTX 2"));
    assert_eq!(error(b"\0\0\0\x20ftypavif"), DecodeError::NoDecoder("AVIF"));
    assert_eq!(error(b"DDS |\0\0\0"), DecodeError::NoDecoder("DDS"));
    assert_eq!(error(b"II*\0\x08\0\0\0"), DecodeError::NoDecoder("TIFF"));
    assert_eq!(error(b"8BPS\0\x01"), DecodeError::NoDecoder("PSD"));
    assert_eq!(error(b"BM6\0"), DecodeError::NoDecoder("BMP"));
    assert_eq!(error(b"junk"), DecodeError::UnknownFormat);
    assert!(matches!(error(b"\x89PNG\r\n\x1a\nabc"), DecodeError::Broken(_)));
    assert!(matches!(error(b"\xFF\xD8\xFF"), DecodeError::Broken(_)));
    assert!(matches!(error(b"RIFF\0\0\0\0WEBPVP8 "), DecodeError::Broken(_)));
}

#[test]
fn grey_images_are_not_coloured() {
    let of = |texel: [u8; 3], size: [u32; 2]| {
        let data = texel.repeat((size[0] * size[1]) as usize);
        decoded(&png(png::ColorType::Rgb, png::BitDepth::Eight, size, &data)).is_colored()
    };
    assert!(of([128, 128, 255], [4, 4]) && of([128, 128, 255], [70, 33]));
    assert!(!of([99, 99, 99], [4, 4]) && !of([90, 100, 110], [70, 33]));
}

/// Palettes that break the specification are refused by a sentence, for pictures and for normal maps that are
/// converted.
#[test]
fn broken_palettes_are_refused() {
    for (bytes, alphas, part) in [
        (235, 0, "its palette has 235 bytes"),
        (236, 0, "its palette has 236 bytes"),
        (6, 3, "its palette has 2 colours but 3 alphas"),
    ] {
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, 2, 1);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_palette(vec![7; bytes]);
        if alphas > 0 {
            encoder.set_trns(vec![255; alphas]);
        }
        encoder.write_header().unwrap().write_image_data(&[0, 0]).unwrap();
        let broken = RgbaImage::decode(&file, &DecodeLimits::default()).unwrap_err().to_string();
        let map = PngImage::from_bytes("map.png", file, &LoadOptions::default()).unwrap_err().to_string();
        assert!(broken.contains(part) && map.contains(part), "{broken} {map}");
    }
}

/// Four channels of 16 bits take twelve bytes per texel until they have 8 bits.
#[test]
fn wide_channels_count_against_the_memory_limit() {
    let texels = vec![[0u16; 4]; 64 * 64];
    let image = PngImage::from_rgba("map", [64, 64], &texels).expect("an image");
    let file = image.to_bytes().expect("a file");
    let decoded =
        |bytes| RgbaImage::decode(&file, &DecodeLimits::of_file(file.len(), MemoryLimit::bytes(bytes)));
    assert!(matches!(decoded(8 * 64 * 64), Err(DecodeError::TooLarge { width: 64, height: 64 })));
    assert!(decoded(12 * 64 * 64).is_ok());
}
