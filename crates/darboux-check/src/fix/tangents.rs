//! Makes tangents again.

use std::collections::BTreeSet;

use darboux::Context;
use darboux_io::Error;
use darboux_io::gltf::{AddTangentsOptions, Document, Generate, PrimitiveName, add_tangents_to};

use super::attributes::{replace, users_of};
use super::options::FixOptions;
use crate::finding::Finding;
use crate::instances::primitives_of;

/// Makes the tangents of all primitives with a finding about them again.
pub fn fix(document: &mut Document, findings: &[&Finding], options: &FixOptions) -> Result<(), Error> {
    let names: Vec<PrimitiveName> =
        findings.iter().flat_map(|finding| primitives_of(document, finding)).collect();
    make(document, &names, options)
}

/// Negates the signs w of the primitives of findings; the directions of the tangents, whatever method they come from, stay.
pub fn negate_signs(document: &mut Document, findings: &[&Finding]) -> Result<(), Error> {
    let names: Vec<PrimitiveName> =
        findings.iter().flat_map(|finding| primitives_of(document, finding)).collect();
    for (accessor, users) in users_of(document, "TANGENT", &names) {
        let tangents = document.vectors::<4>(accessor)?;
        let negated: Vec<[f32; 4]> = tangents.iter().map(|&[x, y, z, w]| [x, y, z, -w]).collect();
        replace(document, ("TANGENT", accessor), &users, &negated)?;
    }
    Ok(())
}

/// Makes the tangents of primitives again. Vertices whose corners need different tangents are split.
pub fn make(document: &mut Document, names: &[PrimitiveName], options: &FixOptions) -> Result<(), Error> {
    if names.is_empty() {
        return Ok(());
    }
    let places: BTreeSet<(usize, usize)> = names.iter().map(|name| (name.mesh, name.primitive)).collect();
    let is_wanted = |name: &PrimitiveName| places.contains(&(name.mesh, name.primitive));
    let adding = AddTangentsOptions::default().with_tangents(options.tangents).with_overwrite(true);
    let context = &mut Context::new();
    add_tangents_to(document, &adding, &is_wanted, context, Generate::OnCpu, &mut |_| {}).map(drop)
}
