//! Damaged files under every operation give an error or a readable result, never a panic.

mod support;

use darboux::{Convention, Method, NormalOptions, Shading, SmoothingSeams, TangentOptions};
use darboux_io::LoadOptions;
use darboux_io::gltf::{
    AddNormalsOptions, AddTangentsOptions, Document, TangentEncoding, add_normals, add_tangents,
    convert_vertices, pair_tangents,
};
use serde_json::json;
use support::{BOTH, Builder, butterfly, run};

/// A strip, an indexed and an unindexed list over shared vertices, with tangents and morph targets.
fn good() -> Vec<u8> {
    let mut builder = Builder::new();
    let (attributes, indices) = (butterfly().attributes(&mut builder), builder.indices(&BOTH));
    let offsets = builder.vectors(&[[0.0f32, 0.5, 0.25]; 6]);
    let targets = json!([{"POSITION": offsets}, {"NORMAL": offsets}]);
    builder.mesh(&[
        json!({"attributes": attributes, "indices": indices, "targets": targets}),
        json!({"attributes": attributes, "indices": indices, "mode": 5}),
        json!({"attributes": attributes}),
    ]);
    let mut document = builder.build();
    run(&mut document);
    document.to_glb().expect("a GLB")
}

fn parse(bytes: &[u8]) -> Option<Document> {
    Document::from_bytes("damaged.glb", bytes.to_vec(), None, &LoadOptions::default()).ok()
}

/// What became of damaged files, each under every operation.
#[derive(Default)]
struct Counts {
    all: usize,
    read: usize,
    written: usize,
}

/// Runs an operation on a document of its own; what it leaves must be a document.
fn check(counts: &mut Counts, bytes: &[u8], operation: impl FnOnce(&mut Document) -> bool) {
    counts.all += 1;
    let Some(mut document) = parse(bytes) else { return };
    counts.read += 1;
    if operation(&mut document)
        && let Ok(written) = document.to_glb()
    {
        assert!(parse(&written).is_some(), "what was written does not read again");
        counts.written += 1;
    }
}

fn check_all(counts: &mut Counts, bytes: &[u8], good: &[u8]) {
    let flat = NormalOptions::new().with_shading(Shading::Flat);
    let creased = NormalOptions::new().with_crease(20.0).with_seams(SmoothingSeams::Respected);
    for normals in [flat, creased] {
        let options = AddNormalsOptions::default().with_normals(normals).with_overwrite(true);
        check(counts, bytes, |document| add_normals(document, &options, &mut |_| {}).is_ok());
    }
    check(counts, bytes, |document| {
        convert_vertices(document, Convention::GLTF, Convention::UNITY, &mut |_| {}).is_ok()
    });
    let tangents = TangentOptions::from(Method::AngleArea);
    let encoding = TangentEncoding::Snorm8x4;
    let options =
        AddTangentsOptions::default().with_tangents(tangents).with_encoding(encoding).with_overwrite(true);
    check(counts, bytes, |document| add_tangents(document, &options, &mut |_| {}).is_ok());
    check(counts, bytes, |document| {
        let other = parse(good).expect("the good one");
        pair_tangents(document, &other).is_ok() || pair_tangents(&other, document).is_ok()
    });
}

fn damage(step: usize) {
    let good = good();
    let mut counts = Counts::default();
    check_all(&mut counts, &good, &good);
    assert_eq!(counts.written, counts.all, "every operation takes the undamaged model");
    let mut damaged = good.clone();
    for at in (0..good.len()).step_by(step) {
        for damage in [b'9', 0xff] {
            damaged[at] = damage;
            check_all(&mut counts, &damaged, &good);
        }
        damaged[at] = good[at];
    }
    // A test of files that are all refused would show nothing. Half of the bytes are JSON, where most damage
    // is an error.
    let Counts { all, read, written } = counts;
    assert!(4 * read >= all && 5 * written >= all, "of {all} files {read} were read and {written} written");
}

#[test]
fn damage_to_some_bytes_is_no_panic() {
    damage(17);
}

#[test]
#[ignore = "takes a minute"]
fn damage_to_any_byte_is_no_panic() {
    damage(1);
}
