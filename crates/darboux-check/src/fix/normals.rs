//! Repairs normals: missing ones are made, others get unit length, and normals or faces that are reversed are turned over.

use std::collections::BTreeMap;

use darboux::{Context, Faces, NormalOptions, generate_normals};
use darboux_io::Error;
use darboux_io::gltf::{AddNormalsOptions, Document, NormalsOutcome, PrimitiveName, add_normals_to};

use super::attributes::{replace, users_of};
use super::options::FixOptions;
use crate::check::for_each_surface;
use crate::code::Code;
use crate::finding::Finding;
use crate::instances::primitives_of;
use crate::orientation::Reversal;
use crate::rules::UNIT_NORMAL;
use crate::surface::length;

/// The attribute.
const NORMAL: &str = "NORMAL";

/// Repairs what the findings name. Returns the primitives that lost their tangents, because their normals are other ones now.
pub fn fix(
    document: &mut Document,
    findings: &[&Finding],
    options: &FixOptions,
) -> Result<Vec<PrimitiveName>, Error> {
    if document.is_compressed() {
        document.decompress()?;
    }
    let of = |codes: &[Code]| -> Vec<&Finding> {
        findings.iter().copied().filter(|finding| codes.contains(&finding.code)).collect()
    };
    let names = |document: &Document, findings: Vec<&Finding>| -> Vec<PrimitiveName> {
        findings.into_iter().flat_map(|finding| primitives_of(document, finding)).collect()
    };
    let missing = names(document, of(&[Code::NormalMissing]));
    let wrong = names(document, of(&[Code::NormalNotFinite, Code::NormalNotUnit]));
    // The faces are turned over first: normals that are made follow them.
    turn_over(document, &of(&[Code::NormalAgainstWinding]))?;
    make_unit(document, &wrong)?;
    make(document, &missing, options)
}

/// Makes missing normals.
fn make(
    document: &mut Document,
    names: &[PrimitiveName],
    options: &FixOptions,
) -> Result<Vec<PrimitiveName>, Error> {
    if names.is_empty() {
        return Ok(Vec::new());
    }
    let is_wanted = |name: &PrimitiveName| names.contains(name);
    let adding = AddNormalsOptions::default().with_normals(options.normals);
    let made = add_normals_to(document, &adding, &is_wanted, &mut Context::new(), &mut |_| {})?;
    let lost_tangents = |outcome: &NormalsOutcome| matches!(outcome, NormalsOutcome::Written(written) if written.tangents_removed);
    let without = made.primitives.into_iter().filter(|primitive| lost_tangents(&primitive.outcome));
    Ok(without.map(|primitive| primitive.name).collect())
}

/// Gives normals unit length, and vertices whose normal has no direction a smooth one. Other normals keep their bits.
fn make_unit(document: &mut Document, names: &[PrimitiveName]) -> Result<(), Error> {
    for (accessor, users) in users_of(document, NORMAL, names) {
        let mut normals = document.vectors::<3>(accessor)?.into_owned();
        let has_direction = |normal: [f32; 3]| length(normal).is_finite() && length(normal) > 1e-9;
        for normal in normals.iter_mut().filter(|normal| has_direction(**normal)) {
            let length = length(*normal);
            if (length - 1.0).abs() > UNIT_NORMAL {
                *normal = normal.map(|x| (f64::from(x) / length) as f32);
            }
        }
        if !normals.iter().all(|normal| has_direction(*normal)) {
            let smooth = smooth_normals(document, &users, normals.len())?;
            for (normal, smooth) in
                normals.iter_mut().zip(smooth).filter(|(normal, _)| !has_direction(**normal))
            {
                *normal = smooth;
            }
        }
        replace(document, (NORMAL, accessor), &users, &normals)?;
    }
    Ok(())
}

/// A smooth normal of every vertex of primitives that share their vertices. Vertices without faces get (0, 0, 1).
fn smooth_normals(
    document: &Document,
    users: &[&PrimitiveName],
    vertex_count: usize,
) -> Result<Vec<[f32; 3]>, Error> {
    let mut normals = vec![[0.0, 0.0, 1.0]; vertex_count];
    let mut is_known = vec![false; vertex_count];
    for corners in document.corners()?.iter().filter(|corners| users.contains(&corners.name())) {
        let Some(positions) = corners.vectors::<3>("POSITION")? else { continue };
        let numbers: Vec<u32> = (0..positions.len() as u32).collect();
        let made = generate_normals(&positions, &numbers, Faces::Triangles, &NormalOptions::default());
        let made = made.map(|made| made.corners.into_per_corner()).unwrap_or_default();
        for (&vertex, normal) in corners.vertices().iter().zip(made) {
            if let Some(known) = is_known.get_mut(vertex as usize).filter(|known| !**known) {
                (*known, normals[vertex as usize]) = (true, normal);
            }
        }
    }
    Ok(normals)
}

/// Turns over the faces or the normals of primitives, whichever are reversed.
fn turn_over(document: &mut Document, findings: &[&Finding]) -> Result<(), Error> {
    if findings.is_empty() {
        return Ok(());
    }
    let mut verdicts = Vec::new();
    for_each_surface(document, |surface| {
        if let Some(finding) =
            findings.iter().find(|finding| finding.place.primitive == surface.place.primitive)
        {
            verdicts.push((*finding, Reversal::of(&surface), surface.vertex_of_corner));
        }
    })?;
    let mut with_reversed_normals = Vec::new();
    let mut turned = TurnedIndices::new();
    for (finding, verdict, mut corners) in verdicts {
        let names = primitives_of(document, finding);
        match verdict {
            Some(Reversal::Faces) => {
                corners.as_chunks_mut::<3>().0.iter_mut().for_each(|[_, b, c]| std::mem::swap(b, c));
                turn_faces(document, &names, &corners, &mut turned)?;
            }
            Some(Reversal::Normals | Reversal::NormalsByTangents) => with_reversed_normals.extend(names),
            Some(Reversal::Unknown(_)) | None => {}
        }
    }
    for (accessor, users) in users_of(document, NORMAL, &with_reversed_normals) {
        let normals = document.vectors::<3>(accessor)?;
        let reversed: Vec<[f32; 3]> = normals.iter().map(|normal| normal.map(|x| -x)).collect();
        replace(document, (NORMAL, accessor), &users, &reversed)?;
    }
    Ok(())
}

/// The new accessor of indices, by what decides them: the old accessor, the mode and the number of corners.
type TurnedIndices = BTreeMap<(Option<usize>, u32, usize), usize>;

/// Gives primitives the triangles `corners`. Primitives that shared their indices share the new ones.
fn turn_faces(
    document: &mut Document,
    names: &[PrimitiveName],
    corners: &[u32],
    turned: &mut TurnedIndices,
) -> Result<(), Error> {
    for name in names {
        let stored = |document: &Document| {
            let primitive = &document.meshes()[name.mesh].primitives[name.primitive];
            (primitive.indices, primitive.mode)
        };
        let (old, mode) = stored(document);
        let key = (old, mode, corners.len());
        match turned.get(&key) {
            Some(&indices) => document.edit_primitive(name.mesh, name.primitive, |json| {
                json.insert("indices".to_owned(), indices.into());
                if json.contains_key("mode") {
                    json.insert("mode".to_owned(), TRIANGLES.into());
                }
            })?,
            None => {
                document.set_triangles(name.mesh, name.primitive, corners.to_vec())?;
                turned.extend(stored(document).0.map(|indices| (key, indices)));
            }
        }
    }
    Ok(())
}

/// The mode of triangle lists (glTF 2.0, 5.24.4).
const TRIANGLES: u32 = 4;
