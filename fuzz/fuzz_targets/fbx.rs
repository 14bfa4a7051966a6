//! Fuzzes FBX, whose parser is C: any bytes give an error or a document that can be written and read again.
//!
//! cargo-fuzz checks the addresses of Rust's code only. `CFLAGS=-fsanitize=address,fuzzer-no-link CC=clang`
//! does so in ufbx, too.

#![no_main]

use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(document) = Document::from_bytes("input", bytes.to_vec(), None, &LoadOptions::default()) else {
        return;
    };
    let written = document.to_glb().expect("what was read can be written");
    Document::from_bytes("written", written, None, &LoadOptions::default()).expect("and reads again");
});
