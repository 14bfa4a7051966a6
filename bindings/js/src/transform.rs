//! `transformFrames` and `skinFrames`: normals and tangents under matrices.

use darboux::Transform;

use crate::arena::{Arena, with_arena};
use crate::inputs::resized;
use crate::mesh_arrays::{rows, rows_mut};

/// Matrices of 3 by 3 floats each, by columns.
#[unsafe(no_mangle)]
pub extern "C" fn matrices(count: usize) -> *mut f32 {
    with_arena(|arena| resized(&mut arena.extras.matrices, 9 * count))
}

/// The matrices of all vertices, the same number for each.
#[unsafe(no_mangle)]
pub extern "C" fn joints(joints: usize) -> *mut u32 {
    with_arena(|arena| resized(&mut arena.extras.joints, joints))
}

/// The weight of each joint.
#[unsafe(no_mangle)]
pub extern "C" fn weights(joints: usize) -> *mut f32 {
    with_arena(|arena| resized(&mut arena.extras.weights, joints))
}

/// Transforms the arena's normals and given tangents by the first matrix, in place. Returns the orientation
/// of the matrix, 1 or -1.
#[unsafe(no_mangle)]
pub extern "C" fn transform_frames() -> f32 {
    with_arena(|arena| {
        let transform = Transform::new(columns(&arena.extras.matrices, 0));
        move_frames(arena, |_, _| transform);
        transform.orientation()
    })
}

/// Transforms the arena's normals and given tangents in place, each by the weighted sum of `influences`
/// matrices.
#[unsafe(no_mangle)]
pub extern "C" fn skin_frames(influences: usize) {
    with_arena(|arena| {
        move_frames(arena, |extras, vertex| {
            let row = vertex * influences..(vertex + 1) * influences;
            let bones =
                extras.joints[row.clone()].iter().map(|&joint| columns(&extras.matrices, joint as usize));
            Transform::blended(bones.zip(extras.weights[row].iter().copied()))
        });
    });
}

fn move_frames(arena: &mut Arena, transform: impl Fn(&crate::extras::Extras, usize) -> Transform) {
    let mut tangents = std::mem::take(&mut arena.extras.given_tangents);
    let normals = rows_mut::<3>(&mut arena.vertices.normals);
    for (vertex, (normal, tangent)) in normals.iter_mut().zip(rows_mut::<4>(&mut tangents)).enumerate() {
        (*normal, *tangent) = transform(&arena.extras, vertex).frame(*normal, *tangent);
    }
    arena.extras.given_tangents = tangents;
}

/// The columns of a matrix. Zeros for a matrix that does not exist.
fn columns(matrices: &[f32], at: usize) -> [[f32; 3]; 3] {
    let found = matrices.get(9 * at..).and_then(|from| rows::<3>(from).first_chunk());
    found.copied().unwrap_or_default()
}
