//! Fuzzes images, KTX 2 and TGA above all: any bytes give an image of the size that they state, within the
//! limits, or one sentence. An image becomes a PNG with the same texels.

#![no_main]

use darboux_io::image::{DecodeLimits, RgbaImage};
use libfuzzer_sys::fuzz_target;

const KTX2: &[u8] = b"\xABKTX 20\xBB\r\n\x1A\n";
/// A TGA of 9 x 7 texels of 24 bits, in runs.
const TGA: &[u8] = &[0, 0, 10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 9, 0, 7, 0, 24, 0];

fuzz_target!(|bytes: &[u8]| {
    let limits = DecodeLimits::default().with_max_side(512);
    for start in [&[], KTX2, TGA] {
        match RgbaImage::decode(&[start, bytes].concat(), &limits) {
            Ok(image) => {
                assert!(image.width.max(image.height) <= 512);
                assert_eq!(image.texels.len(), image.width as usize * image.height as usize);
                let png = image.to_png("image").expect("a PNG");
                assert_eq!(RgbaImage::decode(&png, &limits).as_ref(), Ok(&image));
            }
            Err(error) => assert!(!error.to_string().contains('\n')),
        }
    }
});
