//! Fuzzes KTX 2 files: any bytes give an image of the size that they state, within the limits, or one
//! sentence.

#![no_main]

use darboux_io::image::{DecodeLimits, RgbaImage};
use libfuzzer_sys::fuzz_target;

const SIGNATURE: &[u8] = b"\xABKTX 20\xBB\r\n\x1A\n";

fuzz_target!(|bytes: &[u8]| {
    let limits = DecodeLimits::default().with_max_side(512);
    let with_signature = [SIGNATURE, bytes].concat();
    for file in [bytes, &with_signature] {
        match RgbaImage::decode(file, &limits) {
            Ok(image) => {
                assert!(image.width.max(image.height) <= 512);
                assert_eq!(image.texels.len(), image.width as usize * image.height as usize);
            }
            Err(error) => assert!(!error.to_string().contains('\n')),
        }
    }
});
