//! Fuzzes files: any bytes give an error or tangents, never a panic, and every written file can be read
//! again.

#![no_main]

use darboux_io::LoadOptions;
use darboux_io::gltf::{AddTangentsOptions, Document, add_tangents, inspect};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let read = |bytes: &[u8]| Document::from_bytes("input", bytes.to_vec(), None, &LoadOptions::default());
    if let Ok(document) = read(bytes) {
        let _may_be_refused = inspect(&document);
    }
    let Ok(mut document) = read(bytes) else { return };
    let options = AddTangentsOptions::default().with_overwrite(true);
    if add_tangents(&mut document, &options, &mut |_| {}).is_err() {
        return;
    }
    if let Ok(written) = document.to_glb() {
        read(&written).expect("what was written reads again");
    }
});
