//! Fuzzes repairs: any model gives an error or a repaired model that can be written and read again, and a
//! second repair changes nothing.

#![no_main]

use darboux_check::{CheckOptions, FixOptions, FixedDocument, check_document, fix_document, plan_repair};
use darboux_io::gltf::Document;
use darboux_io::{Error, LoadOptions};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(mut document) = read(bytes) else { return };
    if !fix(&mut document).is_ok_and(|fixed| fixed.is_changed) {
        return;
    }
    let Ok(written) = document.to_glb() else { return };
    let mut repaired = read(&written).expect("what was written reads again");
    let again = fix(&mut repaired).expect("what was repaired can be checked");
    assert!(!again.is_changed, "a second repair changes the model: {:?}", again.findings);
});

fn read(bytes: &[u8]) -> Result<Document, Error> {
    Document::from_bytes("input", bytes.to_vec(), None, &LoadOptions::default())
}

fn fix(document: &mut Document) -> Result<FixedDocument, Error> {
    let options = FixOptions::default();
    let findings = check_document(document, &CheckOptions::default())?;
    plan_repair(document, &findings, &options)?;
    fix_document(document, findings, &options)
}
