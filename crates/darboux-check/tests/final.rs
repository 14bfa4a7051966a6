//! A repair is final: a second one repairs nothing and changes nothing, nothing is found that was not there
//! before, and nothing that is left is called fixable.

mod support;

use darboux::{Method, NormalOptions, Shading, TangentOptions};
use darboux_check::{
    CheckOptions, Code, Finding, FixOptions, FixedDocument, Severity, check_document, fix_document,
};
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use support::damaged::{Sources, corpus, damaged, sources, sources_of_other_methods};

/// The findings on a model, what a repair said of them, and the model after it; none where the model cannot
/// be read.
fn repaired(glb: &[u8], options: &FixOptions) -> Option<(Vec<Finding>, FixedDocument, Vec<u8>)> {
    let mut document = Document::from_bytes("damaged", glb.to_vec(), None, &LoadOptions::default()).ok()?;
    let findings = check_document(&document, &options.check).ok()?;
    let fixed = fix_document(&mut document, findings.clone(), options).ok()?;
    let after = if fixed.is_changed { document.to_glb().expect("a GLB") } else { glb.to_vec() };
    Some((findings, fixed, after))
}

fn is_same(a: &Finding, b: &Finding) -> bool {
    (a.code, &a.place.primitive, a.place.image) == (b.code, &b.place.primitive, b.place.image)
}

/// Whether a repair changed a model, and what is not final about it, one sentence each; none where the model
/// cannot be read.
fn problems(glb: &[u8], options: &FixOptions) -> Option<(bool, Vec<String>)> {
    let (before, first, once) = repaired(glb, options)?;
    let (left, second, twice) = repaired(&once, options).expect("a repaired model can be read");
    let is_known = |finding: &Finding| before.iter().any(|known| is_same(known, finding));
    // The check does not know of another method that was asked for.
    let is_default = options.tangents == TangentOptions::default();
    let is_wanted = |finding: &Finding| !is_default && finding.code == Code::TangentOtherRecipe;
    let mut problems = Vec::new();
    for fixed in second.findings.iter().filter(|fixed| fixed.repaired) {
        problems.push(format!("a second repair repairs {}", fixed.finding.code));
    }
    if second.is_changed || twice != once {
        problems.push("a second repair changes the file".to_owned());
    }
    for fixed in first.findings.iter().filter(|fixed| !is_known(&fixed.finding)) {
        problems.push(format!("{} is reported, and was not found before", fixed.finding.code));
    }
    for finding in left.iter().filter(|finding| !is_wanted(finding)) {
        if finding.severity > Severity::Info && !is_known(finding) {
            problems.push(format!("{} is new at {}: {}", finding.code, finding.place, finding.text));
        }
        if is_default && finding.is_fixable() {
            let outcome = first.findings.iter().find(|fixed| is_same(&fixed.finding, finding));
            let reason = outcome.and_then(|fixed| fixed.finding.left_because.clone()).unwrap_or_default();
            problems.push(format!("{} is left and called fixable: {}; {reason}", finding.code, finding.text));
        }
    }
    Some((first.is_changed, problems))
}

fn options(seed: u64) -> FixOptions {
    let options = FixOptions::default().with_check(CheckOptions::default().with_maps(false));
    match seed % 8 {
        0 => options.with_normals(NormalOptions::default().with_shading(Shading::Flat)),
        1 => options.with_tangents(TangentOptions::from(Method::Lengyel)),
        _ => options,
    }
}

/// Repairs damaged models twice.
fn verify(sources: &Sources, seeds: impl Iterator<Item = u64>) {
    let (mut all, mut read, mut changed, mut bad) = (0, 0, 0, Vec::new());
    for seed in seeds {
        all += 1;
        let model = damaged(sources, seed);
        let Some((is_changed, found)) = problems(&model.glb(), &options(seed)) else { continue };
        read += 1;
        changed += usize::from(is_changed);
        if !found.is_empty() {
            bad.push(format!("seed {seed} ({}): {found:#?}", model.name));
        }
    }
    assert!(bad.is_empty(), "{} of {read} repairs are not final: {}", bad.len(), bad.join("\n"));
    // A test of models that are all refused, or never repaired, would show nothing.
    assert!(
        10 * read >= 9 * all && 2 * changed >= all,
        "of {all} models {read} were read and {changed} repaired"
    );
}

/// The surface of the last one has no area.
#[test]
fn repairs_of_damaged_models_are_final() {
    verify(&sources(), (0..300).chain([993]));
}

#[test]
#[ignore = "repairs 10,000 models: cargo xtask ci --full runs it"]
fn repairs_of_many_damaged_models_are_final() {
    verify(&sources(), 300..10_300);
}

/// Tangents of a known method stay, and what is wrong beside it is repaired.
#[test]
fn repairs_of_models_of_other_methods_are_final() {
    verify(&sources_of_other_methods(), 0..300);
}

#[test]
#[ignore = "repairs 5,000 models: cargo xtask ci --full runs it"]
fn repairs_of_many_models_of_other_methods_are_final() {
    verify(&sources_of_other_methods(), 300..5_300);
}

#[test]
fn repairs_of_the_corpus_are_final() {
    for (name, glb) in corpus() {
        for seed in 0..3 {
            let (_, found) = problems(&glb, &options(seed)).expect("a model of the corpus can be read");
            assert!(found.is_empty(), "{name}: {found:#?}");
        }
    }
}
