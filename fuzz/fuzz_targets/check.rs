//! Fuzzes the check: any model gives an error or findings, each with a sentence.

#![no_main]

use darboux_check::{CheckOptions, check_document};
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let read = Document::from_bytes("input", bytes.to_vec(), None, &LoadOptions::default());
    let Ok(document) = read else { return };
    let Ok(findings) = check_document(&document, &CheckOptions::default()) else { return };
    assert!(findings.iter().all(|finding| !finding.text.is_empty()), "{findings:?}");
});
