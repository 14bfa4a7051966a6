//! What a map that nobody can judge means for the tangents: a repair of one half of what may be a pair could make a right picture wrong.

mod support;

use darboux_check::{CheckOptions, Code, Finding, FixOptions, Severity, check_document, fix_document};
use support::models::{Model, healthy_models};

const KTX2: &[u8] = b"\xABKTX 20\xBB\r\n\x1A\n and more";

fn check(model: &Model) -> Vec<Finding> {
    check_document(&model.document(), &CheckOptions::default()).expect("a valid document")
}

/// Flipped signs on a flat field of noise, an image in a format that is not read, and a broken one.
#[test]
fn flipped_signs_under_a_map_of_unknown_convention_are_left() {
    let mut model = healthy_models().remove(3);
    model.negate_signs();
    let noise = |i: usize| {
        let hash = (i as u32).wrapping_mul(2_654_435_769).wrapping_mul(0x85EB_CA6B) ^ (i as u32 >> 3);
        [120 + (hash >> 20 & 15) as u8, 120 + (hash >> 26 & 15) as u8, 254]
    };
    let noise = model.map.with_texels((0..model.map.texels.len()).map(noise).collect());
    for file in [noise.file, KTX2.to_vec(), b"no image".to_vec()] {
        model.map.file = file;
        let findings = check(&model);
        let flipped =
            findings.iter().find(|finding| finding.code == Code::TangentSignFlipped).expect("the finding");
        assert_eq!((flipped.severity, flipped.is_fixable()), (Severity::Warning, false), "{flipped:?}");
        let reason = flipped.left_because.as_deref().unwrap_or_default();
        assert!(reason.contains("images[0]") && reason.contains("--no-maps"), "{reason}");
        let mut document = model.document();
        let fixed = fix_document(&mut document, findings, &FixOptions::default()).expect("a repair");
        assert!(!fixed.is_changed && !document.is_changed(), "{fixed:?}");
        // Without a check of maps they are taken to be right.
        let options = FixOptions::default().with_check(CheckOptions::default().with_maps(false));
        let findings = check_document(&document, &options.check).expect("a valid document");
        let fixed = fix_document(&mut document, findings, &options).expect("a repair");
        let flipped = fixed.findings.iter().find(|fixed| fixed.finding.code == Code::TangentSignFlipped);
        assert!(flipped.is_some_and(|flipped| flipped.repaired), "{fixed:?}");
    }
}

#[test]
fn a_map_in_a_format_that_is_not_read_is_not_checked_and_no_error() {
    let mut model = healthy_models().remove(0);
    model.map.file = KTX2.to_vec();
    let findings = check(&model);
    let map = findings.iter().find(|finding| finding.code == Code::MapUnreadable).expect("the finding");
    assert_eq!(map.severity, Severity::NotChecked, "{}", map.text);
    assert!(map.severity < Severity::Info && map.text.contains("not checked"), "{}", map.text);
    assert!(findings.iter().all(|finding| finding.severity <= Severity::Info), "{findings:#?}");
    model.map.file = b"no image".to_vec();
    let broken = check(&model).into_iter().find(|finding| finding.code == Code::MapUnreadable);
    assert_eq!(broken.map(|finding| finding.severity), Some(Severity::Error));
}

/// Two mistakes that cancel on the whole model make no picture wrong: one warning says so.
#[test]
fn mistakes_that_cancel_are_one_warning() {
    let mut model = healthy_models().remove(9);
    model.map = model.map.through(|[r, g, b]| [r, 1.0 - g, b]);
    model.negate_signs();
    let findings = check(&model);
    let severe: Vec<&Finding> = findings.iter().filter(|finding| finding.severity > Severity::Info).collect();
    let codes: Vec<(Code, Severity)> =
        severe.iter().map(|finding| (finding.code, finding.severity)).collect();
    assert_eq!(codes, [(Code::MapGreenFlipped, Severity::Warning)], "{findings:#?}");
    assert!(severe[0].text.contains("both or none") && severe[0].is_fixable(), "{}", severe[0].text);
}
