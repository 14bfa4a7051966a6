//! Fuzzes splitting: every corner keeps its vertex data and its tangent, with the smallest number of
//! vertices.

#![no_main]

use darboux_tests::{Case, split_and_plan};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let case = Case::from_bytes(bytes);
    if let Err(broken) = split_and_plan(&case) {
        panic!("{broken}\nthresholds {:?}\n{}", case.threshold, case.mesh.to_text());
    }
});
