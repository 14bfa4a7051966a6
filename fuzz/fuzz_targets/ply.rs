//! Fuzzes PLY: any bytes give an error or a document that can be written and read again, with tangents.

#![no_main]

use darboux_io::LoadOptions;
use darboux_io::gltf::{AddTangentsOptions, Document, add_tangents};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let read = |bytes: &[u8]| Document::from_bytes("input", bytes.to_vec(), None, &LoadOptions::default());
    let Ok(mut document) = read(bytes) else { return };
    let written = document.to_glb().expect("what was read can be written");
    read(&written).expect("and reads again");
    _ = add_tangents(&mut document, &AddTangentsOptions::default(), &mut |_| {});
});
