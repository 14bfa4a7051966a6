//! TGA files decode to the texels of their PNG beside them, which another program made, and damaged ones are
//! refused.

use std::fs;
use std::path::{Path, PathBuf};

use darboux_io::gltf::Document;
use darboux_io::image::{DecodeLimits, RgbaImage};
use darboux_io::{LoadOptions, SaveOptions};

fn raster(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/rasters").join(name)
}

fn bytes(name: &str) -> Vec<u8> {
    fs::read(raster(name)).expect("a file")
}

fn decode(file: &[u8]) -> Result<RgbaImage, String> {
    RgbaImage::decode(file, &DecodeLimits::default()).map_err(|error| error.to_string())
}

#[test]
fn all_kinds_decode() {
    for (tga, png) in [
        ("rgb.tga", "rgb.png"),
        ("rgb-top.tga", "rgb.png"),
        ("rgb-right.tga", "rgb.png"),
        ("rgb-rle.tga", "rgb.png"),
        ("rgb16.tga", "rgb16.png"),
        ("rgba-rle.tga", "rgba.png"),
        ("grey.tga", "grey.png"),
        ("grey-rle.tga", "grey.png"),
        ("palette.tga", "palette.png"),
    ] {
        assert!(RgbaImage::is_tga(&bytes(tga)), "{tga}");
        assert_eq!(decode(&bytes(tga)), decode(&bytes(png)), "{tga}");
        assert!(!RgbaImage::is_tga(&bytes(png)), "{png}");
    }
}

/// A TGA of 15 bits is as long as one of 16, without the bit of alpha.
#[test]
fn texels_of_15_bits_are_read() {
    let mut file = bytes("rgb16.tga");
    assert_eq!(file[16], 16);
    file[16] = 15;
    assert!(RgbaImage::is_tga(&file));
    assert_eq!(decode(&file), decode(&bytes("rgb16.png")));
}

/// The extension area says what alpha holds (TGA 2.0, field 24): 3 and 4 are alpha, with 0 there is none, 1
/// and 2 stand for bytes without a meaning.
#[test]
fn alpha_counts_where_the_file_says_so() {
    let whole = bytes("rgba-rle.tga");
    let image = whole.strip_suffix(b"TRUEVISION-XFILE.\0").map_or(&*whole, |rest| &rest[..rest.len() - 8]);
    let has_alpha_with = |length: u16, kind: u8| {
        let mut area = vec![0; 495];
        area[0..2].copy_from_slice(&length.to_le_bytes());
        area[494] = kind;
        let offsets = [image.len() as u32, 0].map(u32::to_le_bytes).concat();
        let file = [image, &area, &offsets, b"TRUEVISION-XFILE.\0"].concat();
        let decoded = decode(&file).expect("an image");
        let original = decode(&whole).expect("an image");
        let colors =
            |image: &RgbaImage| image.texels.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect::<Vec<_>>();
        assert_eq!(colors(&decoded), colors(&original));
        decoded == original
    };
    assert!(has_alpha_with(494, 0), "not the area of version 2.0");
    let has_alpha = |kind: u8| has_alpha_with(495, kind);
    assert_eq!([0, 1, 2, 3, 4].map(has_alpha), [false, false, false, true, true]);
}

/// Two offsets behind the image lead to metadata. Wrong ones, in one footer or several, change no texel.
#[test]
fn damaged_files_are_refused() {
    for name in ["rgb.tga", "rgb-rle.tga", "palette.tga"] {
        let whole = bytes(name);
        let end = whole.len() - 26;
        for length in 0..end {
            let error = decode(&whole[..length]).expect_err("a part of a file");
            assert!(!error.contains('\n'), "{error}");
        }
        let mut damaged = whole.clone();
        damaged[end..end + 8].fill(0xFF);
        assert_eq!(decode(&damaged), decode(&whole), "{name}");
        let footers = [&damaged[..], &damaged[end..]].concat();
        assert_eq!(decode(&footers), decode(&whole), "{name}");
        assert!(decode(&footers[footers.len() - 52..]).is_err());
    }
    assert!(decode(&bytes("rgb.tga")[..100]).expect_err("cut off").contains("it was cut off"));
    let mut small_palette = bytes("palette.tga");
    let last = small_palette.len() - 27;
    small_palette[last] = 255;
    assert!(decode(&small_palette).expect_err("no such colour").contains("its colour map is too short"));
}

/// A run of one byte stands for up to 128 texels: the size in the header is compared with the limit before.
#[test]
fn large_images_need_a_limit() {
    let mut large = bytes("rgb-rle.tga");
    large[12..16].fill(0xFF);
    assert!(decode(&large).expect_err("65,535 x 65,535").contains("more than the limit"));
}

/// A folder with an OBJ whose normal map and colours are TGA files.
fn model() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, content: &[u8]| fs::write(folder.path().join(name), content).expect("a file");
    write(
        "m.obj",
        b"mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n",
    );
    write("m.mtl", b"newmtl m\nmap_Kd rgba-rle.tga\nnorm rgb.tga\n");
    for name in ["rgb.tga", "rgba-rle.tga"] {
        write(name, &bytes(name));
    }
    folder
}

#[test]
fn documents_have_them_as_png() {
    let folder = model();
    let document = Document::open(&folder.path().join("m.obj"), &LoadOptions::default()).expect("a model");
    let warnings = document.warnings().join("\n");
    let tga =
        "rgba-rle.tga and 1 other texture are TGA, which glTF cannot hold; in the document they are PNG";
    assert!(warnings.contains(tga), "{warnings}");
    for (index, png) in ["rgba.png", "rgb.png"].into_iter().enumerate() {
        let image = document.image_bytes(index).expect("an image");
        assert!(image.starts_with(b"\x89PNG"));
        assert_eq!(decode(&image), decode(&bytes(png)), "{png}");
    }
    let out = folder.path().join("out");
    fs::create_dir(&out).expect("a folder");
    document.save(&out.join("m.obj"), &SaveOptions::default()).expect("a copy");
    for name in ["rgb.png", "rgba-rle.png"] {
        assert!(fs::read(out.join(name)).expect("an image").starts_with(b"\x89PNG"), "{name}");
    }
}
