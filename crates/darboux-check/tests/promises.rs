//! A finding that a repair is promised for is gone after it, or the result says why it is not.

mod support;

use std::path::{Path, PathBuf};

use darboux_check::{CheckOptions, Finding, FixOptions, FixedFinding, check_document, fix_document};
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use darboux_tests::models::{further_models, models};
use support::mistakes::MISTAKES;
use support::models::healthy_models;
use support::table::without_maps;

fn is_same(a: &Finding, b: &Finding) -> bool {
    a.code == b.code && a.place.primitive == b.place.primitive && a.place.image == b.place.image
}

/// What is wrong with the outcome of a repair, one sentence per finding.
fn broken_promises(open: impl Fn() -> Document, check: CheckOptions) -> Vec<String> {
    let findings = check_document(&open(), &check).expect("a valid document");
    let mut document = open();
    let options = FixOptions::default().with_check(check);
    let fixed = fix_document(&mut document, findings.clone(), &options).expect("a valid document").findings;
    let remaining = check_document(&document, &check).expect("a valid document");
    let problem = |promised: &Finding| {
        let remains = remaining.iter().any(|left| is_same(left, promised));
        match fixed.iter().find(|fixed| is_same(&fixed.finding, promised)) {
            None => Some("is not among the outcomes".to_owned()),
            Some(fixed) if !fixed.was_fixable() => Some("is no longer called fixable".to_owned()),
            Some(FixedFinding { repaired: true, .. }) => {
                remains.then(|| "is called repaired, and remains".to_owned())
            }
            Some(FixedFinding { finding, .. }) if finding.left_because.is_none() => {
                Some("is left without a reason".to_owned())
            }
            Some(FixedFinding { finding, .. }) if !remains => {
                Some(format!("is gone, and is called left: {:?}", finding.left_because))
            }
            Some(_) => None,
        }
    };
    let promised = findings.iter().filter(|finding| finding.is_fixable());
    promised.filter_map(|finding| Some(format!("{}: {}", finding.code, problem(finding)?))).collect()
}

#[test]
fn promises_are_kept_for_every_mistake() {
    for healthy in healthy_models().iter().step_by(4) {
        for mistake in MISTAKES {
            let mut model = healthy.clone();
            if (mistake.make)(&mut model) {
                let broken = broken_promises(|| model.document(), without_maps());
                assert!(broken.is_empty(), "{} on {}: {broken:#?}", mistake.how, healthy.name);
            }
        }
    }
}

/// Every model below a folder that opens.
fn verify(folder: &Path) {
    for path in models(folder) {
        let open = || Document::open(&path, &LoadOptions::default());
        let opens = open().is_ok_and(|document| check_document(&document, &without_maps()).is_ok());
        if opens {
            let broken = broken_promises(|| open().expect("a valid file"), without_maps());
            assert!(broken.is_empty(), "{}: {broken:#?}", path.display());
        }
    }
}

#[test]
fn promises_are_kept_for_the_models_of_the_repository() {
    verify(&PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../assets"));
}

#[test]
#[ignore = "repairs large models: cargo xtask ci --full runs it"]
fn promises_are_kept_for_further_models() {
    if let Some(folder) = further_models() {
        verify(&folder);
    }
}
