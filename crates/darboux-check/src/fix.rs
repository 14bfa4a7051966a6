//! Repairs what the findings name: normals first, then tangents, which depend on them, and maps.
//!
//! A repair changes what a finding names and nothing else. What it did is checked again: no finding counts as repaired that is still there, and a
//! repair that removes no finding, or ends in a new error, is taken back.

mod attempt;
mod attributes;
mod correction;
mod maps;
mod normals;
mod options;
mod outcome;
mod pairs;
mod tangents;

pub use maps::{FixedMap, fix_map, fix_map_on_model};
pub use options::FixOptions;
pub use outcome::{Change, FixedDocument, FixedFinding};

use darboux_io::Error;
use darboux_io::gltf::Document;

use crate::finding::Finding;
use attempt::fix_surfaces;
use outcome::is_same;
use pairs::LeftPairs;

/// Repairs a document.
///
/// `findings`: those of [`check_document`](crate::check_document) with the same options on the same document. Data that no finding names is
/// kept, byte for byte; a compressed document is decompressed if its geometry is repaired. Errors: invalid data; more memory than the limit
/// permits. After an error the document is unspecified: drop it.
pub fn fix_document(
    document: &mut Document,
    findings: Vec<Finding>,
    options: &FixOptions,
) -> Result<FixedDocument, Error> {
    let promised: Vec<Finding> = findings.iter().filter(|finding| finding.is_fixable()).cloned().collect();
    let (on_images, on_surfaces): (Vec<Finding>, Vec<Finding>) =
        findings.into_iter().partition(|finding| finding.place.image.is_some());
    let copy = if on_images.is_empty() { None } else { decompressed_copy(document)? };
    let readable = copy.as_ref().unwrap_or(document);
    let left = LeftPairs::new(readable, &on_images, &on_surfaces, options)?;
    let mut fixed = fix_surfaces(document, left.mark(on_surfaces), &left, options)?;
    let copy = copy.filter(|_| document.is_compressed());
    let on_images = maps::fix_images(document, copy.as_ref(), left.mark(on_images), options)?;
    fixed.is_changed |= on_images.iter().any(|image| image.repaired);
    fixed.findings.extend(on_images);
    for fixed in &mut fixed.findings {
        fixed.was_fixable |= promised.iter().any(|promised| is_same(promised, &fixed.finding));
    }
    Ok(fixed)
}

/// A decompressed copy of a compressed document, whose surfaces can be read: the repair of a map keeps the compression of the meshes.
fn decompressed_copy(document: &Document) -> Result<Option<Document>, Error> {
    if !document.is_compressed() {
        return Ok(None);
    }
    let glb = document.to_glb()?;
    let mut copy = Document::from_bytes(document.name(), glb, None, document.load_options())?;
    copy.decompress()?;
    Ok(Some(copy))
}
