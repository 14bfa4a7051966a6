//! Repairs what the findings name: normals first, then tangents, which depend on them, and maps.
//!
//! A repair changes what a finding names and nothing else. What it did is checked again: no finding counts as cured that is still there.

mod maps;
mod normals;
mod options;
mod outcome;
mod pairs;
mod tangents;

pub use maps::{FixedMap, fix_map};
pub use options::FixOptions;
pub use outcome::FixedFinding;

use darboux_io::Error;
use darboux_io::gltf::Document;

use crate::check::check_surfaces;
use crate::finding::Finding;
use outcome::{is_same, outcome};
use pairs::LeftPairs;

/// Repairs a document.
///
/// `findings`: those of [`check_document`](crate::check_document) with the same options on the same document. Returns these findings, and
/// those that the first repairs revealed. Data that no finding names is kept, byte for byte; a compressed document is decompressed if its
/// geometry is repaired. Errors: invalid data; more memory than the limit permits. After an error the document is unspecified: drop it.
pub fn fix_document(
    document: &mut Document,
    findings: Vec<Finding>,
    options: &FixOptions,
) -> Result<Vec<FixedFinding>, Error> {
    let (on_images, on_surfaces): (Vec<Finding>, Vec<Finding>) =
        findings.into_iter().partition(|finding| finding.place.image.is_some());
    let left = LeftPairs::new(document, &on_images, &on_surfaces, options)?;
    let mut fixed = fix_surfaces(document, left.mark(on_surfaces), &left, options)?;
    fixed.extend(maps::fix_images(document, left.mark(on_images), options)?);
    Ok(fixed)
}

/// Repairs normals and tangents, but those in `left`.
fn fix_surfaces(
    document: &mut Document,
    mut findings: Vec<Finding>,
    left: &LeftPairs,
    options: &FixOptions,
) -> Result<Vec<FixedFinding>, Error> {
    let is_about_normals = |finding: &&Finding| finding.code.name().starts_with("normal-");
    let is_wanted = |finding: &&Finding| options.repairs(finding);
    let of_normals: Vec<&Finding> = findings.iter().filter(is_about_normals).filter(is_wanted).collect();
    let mut current = findings.clone();
    if !of_normals.is_empty() {
        let without_tangents = normals::fix(document, &of_normals, options)?;
        tangents::make(document, &without_tangents, options)?;
        current = left.mark(check_surfaces(document)?);
    }
    let of_tangents: Vec<&Finding> =
        current.iter().filter(|finding| !is_about_normals(finding)).filter(is_wanted).collect();
    if !of_tangents.is_empty() {
        tangents::fix(document, &of_tangents, options)?;
    }
    let remaining = match of_normals.is_empty() && of_tangents.is_empty() {
        true => Vec::new(),
        false => check_surfaces(document)?,
    };
    let revealed = current.iter().filter(|new| !findings.iter().any(|known| is_same(known, new)));
    let revealed: Vec<Finding> = revealed.cloned().collect();
    findings.extend(revealed);
    Ok(findings.into_iter().map(|finding| outcome(finding, &remaining, options)).collect())
}
