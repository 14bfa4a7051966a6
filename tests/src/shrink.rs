//! Shrinks a failing mesh: removes and simplifies parts as long as it still fails.

use crate::{Case, OwnedMesh};

/// The smallest case found that still `fails`, with only the vertices it uses.
///
/// Repeats until nothing changes: remove a face, merge a vertex into an earlier one, replace a number by a
/// simpler one.
pub fn shrink(case: &Case, fails: impl Fn(&Case) -> bool) -> Case {
    let mut best = case.clone();
    loop {
        let smaller = candidates(&best).find(|candidate| fails(candidate));
        match smaller {
            Some(candidate) => best = candidate,
            None => return best,
        }
    }
}

fn candidates(case: &Case) -> impl Iterator<Item = Case> + '_ {
    let faces = case.mesh.face_list();
    let (face_count, vertex_count) = (faces.len(), case.mesh.positions.len());
    let with = |mesh: OwnedMesh| Case { mesh, threshold: case.threshold };
    let fewer_faces = (0..face_count).map({
        let faces = faces.clone();
        move |face| {
            let mut fewer = faces.clone();
            fewer.remove(face);
            with(used_only(case.mesh.clone().with_face_list(&fewer)))
        }
    });
    let fewer_vertices =
        (0..vertex_count).flat_map(move |b| (0..b).map(move |a| (a, b))).map(move |(a, b)| {
            let merge =
                |face: &Vec<u32>| face.iter().map(|&v| if v == b as u32 { a as u32 } else { v }).collect();
            let merged: Vec<Vec<u32>> = faces.iter().map(merge).collect();
            with(used_only(case.mesh.clone().with_face_list(&merged)))
        });
    let simpler = (0..vertex_count * 8).flat_map(move |slot| simpler_numbers(case, slot));
    fewer_faces.chain(fewer_vertices).chain(simpler)
}

/// The case with the number at `slot` (vertex by 8) replaced by each simpler one.
fn simpler_numbers(case: &Case, slot: usize) -> Vec<Case> {
    const SIMPLE: [f32; 6] = [0.0, 1.0, 2.0, 3.0, 0.5, -1.0];
    let old = *number_at(&mut case.mesh.clone(), slot);
    let rank = SIMPLE.iter().position(|simple| simple.to_bits() == old.to_bits()).unwrap_or(SIMPLE.len());
    let replaced = |&number: &f32| {
        let mut simpler = case.clone();
        *number_at(&mut simpler.mesh, slot) = number;
        simpler
    };
    SIMPLE[..rank].iter().map(replaced).collect()
}

fn number_at(mesh: &mut OwnedMesh, slot: usize) -> &mut f32 {
    let (vertex, component) = (slot / 8, slot % 8);
    match component {
        0..3 => &mut mesh.positions[vertex][component],
        3..6 => &mut mesh.normals[vertex][component - 3],
        _ => &mut mesh.uvs[vertex][component - 6],
    }
}

/// The mesh without vertices that no face uses, indexed.
fn used_only(mesh: OwnedMesh) -> OwnedMesh {
    let mut kept = OwnedMesh::default();
    let mut new_of_old = vec![None; mesh.positions.len()];
    let mut faces = mesh.face_list();
    for vertex in faces.iter_mut().flatten() {
        let old = *vertex as usize;
        *vertex = *new_of_old[old].get_or_insert_with(|| kept.push(mesh.vertex(old)));
    }
    kept.with_face_list(&faces)
}
