//! KTX 2 files are decoded to the texels that they were made from, and damaged ones give one sentence.
//!
//! `ktx2/*.ktx2` hold the bumps of [`texel`], encoded by npm's ktx2-encoder 0.6.0 (Basis Universal).

#![cfg(feature = "ktx2")]

use darboux::{MapVerdict, TexelLayout, judge_normal_map};
use darboux_io::image::{DecodeError, DecodeLimits, RgbaImage};

const SIDE: usize = 64;

const ETC1S: &[u8] = include_bytes!("ktx2/bumps-etc1s.ktx2");
const UASTC: &[u8] = include_bytes!("ktx2/bumps-uastc.ktx2");
const UASTC_ZSTD: &[u8] = include_bytes!("ktx2/bumps-uastc-zstd.ktx2");

/// The bumps sin(x) sin(y) / 2, in OpenGL's convention.
fn texel(i: usize) -> [u8; 4] {
    let (x, y) = ((i % SIDE) as f64 / 4.0, (i / SIDE) as f64 / 4.0);
    let vector = [-0.5 * x.cos() * y.sin(), 0.5 * x.sin() * y.cos(), 1.0];
    let length = vector.iter().map(|c| c * c).sum::<f64>().sqrt();
    let [red, green, blue] = vector.map(|c| ((c / length + 1.0) * 127.5).round() as u8);
    [red, green, blue, 255]
}

fn decode(file: &[u8]) -> Result<RgbaImage, DecodeError> {
    RgbaImage::decode(file, &DecodeLimits::default())
}

/// A file of uncompressed texels: its format as a number of Vulkan, and the bytes of the texels.
fn plain(format: u32, texels: &[u8]) -> Vec<u8> {
    let mut file = b"\xABKTX 20\xBB\r\n\x1A\n".to_vec();
    let header = [format, 1, SIDE as u32, SIDE as u32, 0, 0, 1, 1, 0];
    // No data format descriptor, no keys and no global data.
    let index = [104, 4, 0, 0, 0, 0, 0, 0];
    header.iter().chain(&index).for_each(|word| file.extend(word.to_le_bytes()));
    let length = texels.len() as u64;
    [108, length, length].iter().for_each(|word| file.extend(word.to_le_bytes()));
    file.extend(4u32.to_le_bytes());
    file.extend(texels);
    file
}

#[test]
fn basis_universal_is_decoded() {
    // The largest mean difference of a channel, in codes.
    for (name, file, tolerance) in
        [("ETC1S", ETC1S, 12.0), ("UASTC", UASTC, 2.5), ("Zstandard", UASTC_ZSTD, 3.0)]
    {
        let image = decode(file).unwrap_or_else(|error| panic!("{name}: it {error}"));
        assert_eq!([image.width, image.height], [SIDE as u32; 2], "{name}");
        let difference = |(i, found): (usize, &[u8; 4])| {
            (0..3).map(|c| f64::from(found[c].abs_diff(texel(i)[c]))).sum::<f64>() / 3.0
        };
        let mean = image.texels.iter().enumerate().map(difference).sum::<f64>() / (SIDE * SIDE) as f64;
        assert!(mean < tolerance, "{name}: {mean} codes");
        let judgement = judge_normal_map(&image.texels, [SIDE; 2], TexelLayout::RGBA).expect("a whole image");
        assert_eq!(judgement.verdict, MapVerdict::OpenGl, "{name}: {judgement:?}");
    }
}

#[test]
fn uncompressed_texels_are_decoded() {
    let texels: Vec<[u8; 4]> = (0..SIDE * SIDE).map(texel).collect();
    let rgba = texels.concat();
    let rgb: Vec<u8> = texels.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect();
    let bgra: Vec<u8> = texels.iter().flat_map(|[r, g, b, a]| [*b, *g, *r, *a]).collect();
    let words: Vec<u8> = texels.iter().flatten().flat_map(|code| [*code, *code]).collect();
    for (format, bytes) in [(37, &rgba), (43, &rgba), (23, &rgb), (44, &bgra), (91, &words)] {
        let image = decode(&plain(format, bytes)).unwrap_or_else(|error| panic!("{format}: it {error}"));
        assert_eq!(image.texels, texels, "{format}");
    }
    let rg: Vec<u8> = texels.iter().flat_map(|[r, g, ..]| [*r, *g]).collect();
    let image = decode(&plain(16, &rg)).expect("two channels");
    assert!(image.texels.iter().zip(&texels).all(|(found, texel)| found[..2] == texel[..2] && found[2] == 0));
}

#[test]
fn other_formats_and_damaged_files_are_refused() {
    // BC7.
    assert!(matches!(decode(&plain(145, &[0; 4096])), Err(DecodeError::NoDecoder(_))));
    let whole = plain(37, &(0..SIDE * SIDE).flat_map(texel).collect::<Vec<u8>>());
    for file in [ETC1S, UASTC, UASTC_ZSTD, &whole] {
        for length in (12..file.len()).step_by(1 + file.len() / 97) {
            assert!(decode(&file[..length]).is_err(), "{length} of {}", file.len());
        }
        let mut small = DecodeLimits::default();
        small = small.with_max_side(32);
        assert!(matches!(RgbaImage::decode(file, &small), Err(DecodeError::TooLarge { .. })));
        // Extremes in the header and in the descriptor of the data format, at which the crate ktx2 panics.
        for (at, value) in (12..200).flat_map(|at| [0, 4, 255].map(|value| (at, value))) {
            let mut damaged = file.to_vec();
            damaged[at] = value;
            _ = decode(&damaged);
        }
        // Any byte may be damaged: there is an image or a sentence, and no panic.
        for at in (12..file.len()).step_by(1 + file.len() / 400) {
            let mut damaged = file.to_vec();
            damaged[at] ^= 0x55;
            if let Ok(image) = decode(&damaged) {
                assert_eq!(image.texels.len(), image.width as usize * image.height as usize);
            }
        }
    }
}
