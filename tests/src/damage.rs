//! Damages faces and zeros of generated meshes.

use darboux_dice::Dice;

use crate::OwnedMesh;

/// Makes the copies of a vertex differ in the signs of their zeros.
pub(crate) fn negate_zeros(dice: &mut Dice, mesh: &mut OwnedMesh) {
    *mesh = mesh.unindexed();
    let [positions, normals] = [&mut mesh.positions, &mut mesh.normals].map(|list| list.as_flattened_mut());
    let numbers = positions.iter_mut().chain(normals).chain(mesh.uvs.as_flattened_mut());
    for number in numbers.filter(|number| **number == 0.0) {
        *number = dice.pick(&[0.0, -0.0]);
    }
}

/// Damages a face, or the order of all faces.
pub(crate) fn damage_faces(dice: &mut Dice, mesh: &mut OwnedMesh) {
    let mut faces = mesh.face_list();
    let (a, b) = (dice.below(faces.len()), dice.below(faces.len()));
    match dice.below(6) {
        0 => faces[a].reverse(),
        1 => faces.swap(a, b),
        2 => faces[a].rotate_left(1),
        3 => faces.push(faces[a].clone()),
        4 => {
            let (corner, vertex) = (dice.below(faces[a].len()), dice.below(mesh.positions.len()));
            faces[a][corner] = vertex as u32;
        }
        _ => {
            for i in (1..faces.len()).rev() {
                faces.swap(i, dice.below(i + 1));
            }
        }
    }
    *mesh = std::mem::take(mesh).with_face_list(&faces);
}
