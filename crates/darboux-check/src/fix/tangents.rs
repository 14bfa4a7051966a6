//! Makes tangents again, or corrects those that are wrong.

use std::collections::{BTreeMap, BTreeSet};

use darboux::{Context, Convention, CornerTangents, Mesh, TangentOptions, Tangents};
use darboux_io::Error;
use darboux_io::gltf::{AddTangentsOptions, Document, Generate, PrimitiveName, add_tangents_to};

use super::attributes::{replace, users_of};
use super::correction::Correction;
use super::options::FixOptions;
use crate::check::for_each_surface;
use crate::code::Code;
use crate::finding::Finding;
use crate::instances::{primitives_at, primitives_of};

/// The attribute.
const TANGENT: &str = "TANGENT";

/// Makes the tangents of all primitives with a finding about them again.
pub fn fix(document: &mut Document, findings: &[Finding], options: &FixOptions) -> Result<(), Error> {
    let names: Vec<PrimitiveName> =
        findings.iter().flat_map(|finding| primitives_of(document, finding)).collect();
    make(document, &names, options)
}

/// Corrects the tangents that findings name, and keeps the bits of the others. Vertices are split where their corners need different tangents; on
/// primitives with morph targets, all tangents are made again then, with those of the targets. Codes: [`CORRECTED`].
pub fn correct(document: &mut Document, findings: &[Finding], options: &FixOptions) -> Result<(), Error> {
    let mut codes: BTreeMap<(usize, usize), BTreeSet<Code>> = BTreeMap::new();
    for finding in findings {
        for name in primitives_of(document, finding) {
            codes.entry((name.mesh, name.primitive)).or_default().insert(finding.code);
        }
    }
    let mut corrections = Vec::new();
    for_each_surface(document, |surface| {
        let named = surface.place.primitive.as_ref().and_then(|name| codes.get(&(name.mesh, name.primitive)));
        corrections.extend(named.and_then(|codes| Correction::new(surface, codes, options)));
    })?;
    let (mut split, mut remade) = (Vec::new(), Vec::new());
    let mut of_accessors = BTreeMap::new();
    for correction in corrections {
        let surface = &correction.surface;
        let names = primitives_at(document, &surface.place);
        match correction.of_vertices() {
            Some(changed) => {
                for (accessor, users) in users_of(document, TANGENT, &names) {
                    let (all, changes): &mut (Vec<PrimitiveName>, Vec<_>) =
                        of_accessors.entry(accessor).or_default();
                    all.extend(users.into_iter().cloned());
                    changes.extend(changed.iter().copied());
                }
            }
            None if has_targets(document, &names) => remade.extend(names),
            None => split.push((names, correction)),
        }
    }
    for (accessor, (users, changes)) in of_accessors {
        let mut tangents = document.vectors::<4>(accessor)?.into_owned();
        changes.into_iter().for_each(|(vertex, tangent)| tangents[vertex] = tangent);
        replace(document, (TANGENT, accessor), &users.iter().collect::<Vec<_>>(), &tangents)?;
    }
    split_vertices(document, split)?;
    make(document, &remade, options)
}

fn has_targets(document: &Document, names: &[PrimitiveName]) -> bool {
    names.iter().any(|name| !document.meshes()[name.mesh].primitives[name.primitive].targets.is_empty())
}

/// Writes corrections that need more vertices.
fn split_vertices(
    document: &mut Document,
    corrections: Vec<(Vec<PrimitiveName>, Correction)>,
) -> Result<(), Error> {
    if corrections.is_empty() {
        return Ok(());
    }
    let places: BTreeSet<(usize, usize)> =
        corrections.iter().flat_map(|(names, _)| names).map(|name| (name.mesh, name.primitive)).collect();
    let is_wanted = |name: &PrimitiveName| places.contains(&(name.mesh, name.primitive));
    let mut generate = |mesh: &Mesh<'_>, _: &TangentOptions, _: &mut Context| {
        let corrected = corrections.iter().find(|(_, correction)| correction.surface.has_mesh(mesh));
        let (_, correction) = corrected.ok_or("its corners are other ones than those that were checked")?;
        let corners = CornerTangents::from_per_corner(correction.tangent_of_corner.clone());
        let corners = corners.converted(Convention::GLTF, Convention::GLTF.generated());
        Ok(Tangents { corners, ..Tangents::default() })
    };
    let adding = AddTangentsOptions::default().with_overwrite(true);
    let (context, generate) = (&mut Context::new(), Generate::With(&mut generate));
    add_tangents_to(document, &adding, &is_wanted, context, generate, &mut |_| {}).map(drop)
}

/// Negates the signs w of the primitives of findings; the directions of the tangents, whatever method they come from, stay.
pub fn negate_signs(document: &mut Document, findings: &[Finding]) -> Result<(), Error> {
    let names: Vec<PrimitiveName> =
        findings.iter().flat_map(|finding| primitives_of(document, finding)).collect();
    for (accessor, users) in users_of(document, TANGENT, &names) {
        let tangents = document.vectors::<4>(accessor)?;
        let negated: Vec<[f32; 4]> = tangents.iter().map(|&[x, y, z, w]| [x, y, z, -w]).collect();
        replace(document, (TANGENT, accessor), &users, &negated)?;
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
