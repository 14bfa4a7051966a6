//! Repairs defects: normals first, then tangents, which depend on them, and maps.
//!
//! ```text
//! plan       defects and options -> edits; a pure function
//! apply      edits change the document
//! surfaces   what was edited is measured again; an edit that does not shrink the defects of its primitive is taken back
//! outcome    the report: the difference between the defects before and after
//! ```
//!
//! A repair is final: it goes on until a round changes nothing, so that a second repair would change nothing
//! either.

mod apply;
mod maps;
mod options;
mod outcome;
mod pairs;
pub mod plan;
mod surfaces;

pub use maps::{FixedMap, fix_map, fix_map_on_model};
pub use options::FixOptions;
pub use outcome::{Change, FixedDocument, FixedFinding};

use std::collections::{BTreeMap, HashSet};

use darboux_io::Error;
use darboux_io::gltf::Document;

use crate::check::defects_of;
use crate::defect::{Defect, Obstacle, Sameness};
use crate::finding::Finding;
use crate::hypotheses::is_about_channels;
use crate::place::Place;
use crate::words::edits;
use pairs::LeftPairs;
use surfaces::fix_surfaces;

/// An edit that a repair begins with.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PlannedEdit {
    /// What is changed.
    pub place: Place,
    /// What is done, as a clause.
    pub action: String,
}

/// What [`fix_document`] begins with: the first edit of each primitive, and what is done to images. What it
/// finds after that decides how it goes on.
///
/// `findings`: what [`check_document`](crate::check_document) found with the same options in the same
/// document. Errors: invalid data of the materials.
pub fn plan_repair(
    document: &Document,
    findings: &[Finding],
    options: &FixOptions,
) -> Result<Vec<PlannedEdit>, Error> {
    let defects: Vec<Defect> = findings.iter().flat_map(|finding| finding.defects.clone()).collect();
    let (of_images, of_surfaces): (Vec<Defect>, Vec<Defect>) =
        defects.into_iter().partition(|defect| defect.place.image.is_some());
    let left = LeftPairs::new(document, &of_images, &of_surfaces, options)?;
    let edits = plan::plan(&left.mark(of_surfaces), options, &BTreeMap::new());
    let edits =
        edits.into_iter().map(|edit| PlannedEdit { action: edits::clause(&edit.action), place: edit.place });
    let of_images = left.mark(of_images).into_iter().filter(|defect| options.repairs(defect));
    let texels = of_images.map(|defect| PlannedEdit {
        action: format!("repair {}: {}", defect.code(), defect.code().repair().unwrap_or_default()),
        place: defect.place,
    });
    Ok(edits.chain(texels).collect())
}

/// Repairs a document.
///
/// `findings`: what [`check_document`](crate::check_document) found with the same options in the same
/// document. Data that no finding names is kept, byte for byte; a compressed document is written without
/// compression if anything is repaired. Errors: invalid data; more memory than the limit permits. After an
/// error the document is unspecified: drop it.
pub fn fix_document(
    document: &mut Document,
    findings: Vec<Finding>,
    options: &FixOptions,
) -> Result<FixedDocument, Error> {
    let before = findings.into_iter().flat_map(|finding| finding.defects).collect();
    let mut fixed = fix_defects(document, before, options)?;
    if fixed.findings.iter().any(|left| waits_for_repaired_map(left, &fixed.findings)) {
        // What is assumed of a map was applied by the first repair.
        let later = options.clone().with_check(options.check.with_assumed_map(None));
        let again = fix_defects(document, defects_of(document, &later.check)?, &later)?;
        fixed.is_changed |= again.is_changed;
        let is_hidden = |defect: &Defect| options.check.assumed_map.is_some() && is_about_channels(defect);
        fixed.findings = outcome::of_both(fixed.findings, again.findings, is_hidden);
    }
    fixed.findings = outcome::joined(fixed.findings);
    Ok(fixed)
}

/// Repairs defects of a document once.
fn fix_defects(
    document: &mut Document,
    before: Vec<Defect>,
    options: &FixOptions,
) -> Result<FixedDocument, Error> {
    let promised: HashSet<Sameness> =
        before.iter().filter(|defect| is_promised(defect, options)).map(Defect::sameness).collect();
    let (of_images, of_surfaces): (Vec<Defect>, Vec<Defect>) =
        before.into_iter().partition(|defect| defect.place.image.is_some());
    let left = LeftPairs::new(document, &of_images, &of_surfaces, options)?;
    let mut fixed = fix_surfaces(document, left.mark(of_surfaces), &left, options)?;
    let of_images = maps::fix_images(document, left.mark(of_images), options)?;
    fixed.is_changed |= of_images.iter().any(|image| image.repaired);
    fixed.findings.extend(of_images);
    for fixed in &mut fixed.findings {
        let was_promised = |defect: &Defect| promised.contains(&defect.sameness());
        fixed.was_fixable |= fixed.finding.defects.iter().any(was_promised);
    }
    Ok(fixed)
}

/// Whether the check said that a repair removes a defect, or the chosen codes have it removed.
fn is_promised(defect: &Defect, options: &FixOptions) -> bool {
    defect.is_fixable() || options.repairs(defect)
}

/// Whether a finding was left because a map might cancel it, and that map was repaired: only now its texels
/// show whether it does.
fn waits_for_repaired_map(left: &FixedFinding, all: &[FixedFinding]) -> bool {
    let is_repaired = |image: usize| {
        let mut of_image = all.iter().filter(|fixed| fixed.finding.place.image == Some(image));
        of_image.any(|fixed| fixed.repaired)
    };
    let waits = |defect: &Defect| matches!(defect.obstacle, Some(Obstacle::MapMayCancel { image: Some(image), .. }) if is_repaired(image));
    !left.repaired && left.finding.defects.iter().any(waits)
}
