//! Repairs normals: missing ones are made, others get unit length, normals in other axes are turned, and
//! normals or faces that are reversed are flipped.

use std::collections::{BTreeMap, HashSet};

use darboux::{Context, Faces, NormalOptions, generate_normals};
use darboux_io::Error;
use darboux_io::gltf::{AddNormalsOptions, Document, NormalsOutcome, PrimitiveName, add_normals_to};

use super::attributes::{check_rewritten, users_of};
use crate::instances::{Groups, Key, key};
use crate::measure::other_axes::OtherAxes;
use crate::measure::reversed::front;
use crate::measure::values::is_unit;
use crate::repair::options::FixOptions;
use crate::repair::plan::{Action, Edit, Flip};
use crate::surface::{dot, has_direction, length};

/// The attribute.
const NORMAL: &str = "NORMAL";

/// Applies the edits of normals. Returns the primitives that lost their tangents, because their normals are
/// other ones now.
pub fn repair(
    document: &mut Document,
    edits: &[Edit],
    options: &FixOptions,
) -> Result<Vec<PrimitiveName>, Error> {
    let (mut turned, mut reversed, mut wrong, mut missing) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let groups = Groups::of(document, edits.iter().map(|edit| &edit.place));
    for edit in edits {
        let Action::RepairNormals { turn, flip, make_unit, make } = edit.action else { continue };
        let names = groups.at(document, &edit.place);
        if make_unit {
            wrong.extend(names.iter().cloned());
        }
        if make {
            missing.extend(names.iter().cloned());
        }
        turned.extend(turn.map(|axes| (axes, names.clone())));
        reversed.extend(flip.map(|flip| (flip, names)));
    }
    turn(document, &turned)?;
    // The faces are flipped first: normals that are made follow them.
    flip(document, &reversed)?;
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
    let keys: HashSet<Key> = names.iter().map(key).collect();
    let is_wanted = |name: &PrimitiveName| keys.contains(&key(name));
    let adding = AddNormalsOptions::default().with_normals(options.normals);
    let made = add_normals_to(document, &adding, &is_wanted, &mut Context::new(), &mut |_| {})?;
    let lost_tangents = |outcome: &NormalsOutcome| matches!(outcome, NormalsOutcome::Written(written) if written.tangents_removed);
    let without = made.primitives.into_iter().filter(|primitive| lost_tangents(&primitive.outcome));
    Ok(without.map(|primitive| primitive.name).collect())
}

/// Gives normals unit length, and vertices whose normal has no direction a smooth one. Other normals keep
/// their bits.
fn make_unit(document: &mut Document, names: &[PrimitiveName]) -> Result<(), Error> {
    let users = users_of(document, NORMAL, names);
    check_rewritten::<3>(document, users.keys().copied())?;
    for (accessor, users) in users {
        let mut normals = document.vectors::<3>(accessor)?.into_owned();
        for normal in normals.iter_mut().filter(|normal| has_direction(**normal)) {
            if !is_unit(*normal) {
                let length = length(*normal);
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
        document.set_normals(&users, &normals)?;
    }
    Ok(())
}

/// A smooth normal of every vertex of primitives that share their vertices; the normal of the vertex's own
/// faces where other faces at the same position turn the smooth normal to their back. Vertices without faces
/// get (0, 0, 1).
fn smooth_normals(
    document: &Document,
    users: &[PrimitiveName],
    vertex_count: usize,
) -> Result<Vec<[f32; 3]>, Error> {
    let mut normals = vec![[0.0, 0.0, 1.0]; vertex_count];
    let mut fronts = vec![[0.0; 3]; vertex_count];
    let mut is_known = vec![false; vertex_count];
    let mut users = users.to_vec();
    users.sort_by_key(key);
    for name in &users {
        let Some(corners) = document.corners_of(name)? else { continue };
        let Some(positions) = corners.vectors::<3>("POSITION")? else { continue };
        let numbers: Vec<u32> = (0..positions.len() as u32).collect();
        let made = generate_normals(&positions, &numbers, Faces::Triangles, &NormalOptions::default());
        let made = made.map(|made| made.corners.into_per_corner()).unwrap_or_default();
        for (corner, (&vertex, normal)) in corners.vertices().iter().zip(made).enumerate() {
            let vertex = vertex as usize;
            if vertex >= vertex_count {
                continue;
            }
            if !std::mem::replace(&mut is_known[vertex], true) {
                normals[vertex] = normal;
            }
            if let Some(front) = front([0, 1, 2].map(|i| positions[corner / 3 * 3 + i])) {
                let length = length(front);
                fronts[vertex] = [0, 1, 2].map(|i| fronts[vertex][i] + (f64::from(front[i]) / length) as f32);
            }
        }
    }
    let on_front = |(smooth, front): ([f32; 3], [f32; 3])| {
        let length = length(front);
        let is_behind = length.is_finite() && dot(smooth, front) < 0.0;
        if is_behind { front.map(|x| (f64::from(x) / length) as f32) } else { smooth }
    };
    Ok(normals.into_iter().zip(fronts).map(on_front).collect())
}

/// Turns the normals of primitives to the axes of their positions, each list with the same data.
fn turn(document: &mut Document, turned: &[(OtherAxes, Vec<PrimitiveName>)]) -> Result<(), Error> {
    let mut of_axes: Vec<(OtherAxes, Vec<PrimitiveName>)> = Vec::new();
    for (axes, names) in turned {
        match of_axes.iter_mut().find(|(known, _)| known == axes) {
            Some((_, all)) => all.extend(names.iter().cloned()),
            None => of_axes.push((*axes, names.clone())),
        }
    }
    for (axes, names) in &of_axes {
        let users = users_of(document, NORMAL, names);
        check_rewritten::<3>(document, users.keys().copied())?;
        for (accessor, users) in users {
            let normals = document.vectors::<3>(accessor)?;
            let read: Vec<[f32; 3]> = normals.iter().map(|normal| axes.read(*normal)).collect();
            document.set_normals(&users, &read)?;
        }
    }
    Ok(())
}

/// Flips the faces or the normals of primitives, each list with the same data.
fn flip(document: &mut Document, reversed: &[(Flip, Vec<PrimitiveName>)]) -> Result<(), Error> {
    let mut flipped = FlippedIndices::new();
    let mut with_reversed_normals = Vec::new();
    for (flip, names) in reversed {
        match flip {
            Flip::Normals => with_reversed_normals.extend(names.iter().cloned()),
            Flip::Faces => {
                let Some(first) = names.first() else { continue };
                let Some(mut corners) = corners_of(document, first)? else { continue };
                corners.as_chunks_mut::<3>().0.iter_mut().for_each(|[_, b, c]| std::mem::swap(b, c));
                set_faces(document, names, &corners, &mut flipped)?;
            }
        }
    }
    let users = users_of(document, NORMAL, &with_reversed_normals);
    check_rewritten::<3>(document, users.keys().copied())?;
    for (accessor, users) in users {
        let normals = document.vectors::<3>(accessor)?;
        let reversed: Vec<[f32; 3]> = normals.iter().map(|normal| normal.map(|x| -x)).collect();
        document.set_normals(&users, &reversed)?;
    }
    Ok(())
}

/// The vertices of the corners of a primitive.
fn corners_of(document: &Document, name: &PrimitiveName) -> Result<Option<Vec<u32>>, Error> {
    Ok(document.corners_of(name)?.map(|corners| corners.vertices().to_vec()))
}

/// The new accessor of indices, by what decides them: the old accessor, the mode and the number of corners.
type FlippedIndices = BTreeMap<(Option<usize>, u32, usize), usize>;

/// Gives primitives the triangles `corners`. Primitives that shared their indices share the new ones.
fn set_faces(
    document: &mut Document,
    names: &[PrimitiveName],
    corners: &[u32],
    flipped: &mut FlippedIndices,
) -> Result<(), Error> {
    for name in names {
        let stored = |document: &Document| {
            let primitive = &document.meshes()[name.mesh].primitives[name.primitive];
            (primitive.indices, primitive.mode)
        };
        let (old, mode) = stored(document);
        let key = (old, mode, corners.len());
        match flipped.get(&key) {
            Some(&indices) => document.edit_primitive(name.mesh, name.primitive, |json| {
                json.insert("indices", indices.into());
                if json.contains_key("mode") {
                    json.insert("mode", TRIANGLES.into());
                }
            })?,
            None => {
                document.set_triangles(name.mesh, name.primitive, corners.to_vec())?;
                flipped.extend(stored(document).0.map(|indices| (key, indices)));
            }
        }
    }
    Ok(())
}

/// The mode of triangle lists (glTF 2.0, 5.24.4).
const TRIANGLES: u32 = 4;
