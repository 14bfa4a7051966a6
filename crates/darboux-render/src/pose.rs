//! Vertices where morph targets and skins move them.

use darboux::Transform;
use darboux_io::Error;
use darboux_io::gltf::PrimitiveCorners;

use crate::algebra::{Matrix, direction_columns};

/// What of a corner moves with a pose. Normals and tangents are empty where the primitive has none.
pub struct Vertices {
    pub positions: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
    pub tangents: Vec<[f32; 4]>,
}

/// Moves vertices by morph targets: each by its offset times the target's weight. Errors: broken data.
pub fn morph(corners: &PrimitiveCorners<'_>, weights: &[f64], vertices: &mut Vertices) -> Result<(), Error> {
    let Vertices { positions, normals, tangents } = vertices;
    for (target, &weight) in weights.iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
        let offsets = |semantic| corners.offsets(target, semantic).map(Option::unwrap_or_default);
        move_by(positions, &offsets("POSITION")?, weight);
        move_by(normals, &offsets("NORMAL")?, weight);
        move_by(tangents, &offsets("TANGENT")?, weight);
    }
    Ok(())
}

fn move_by<const N: usize>(vectors: &mut [[f32; N]], offsets: &[[f32; 3]], weight: f64) {
    for (vector, offset) in vectors.iter_mut().zip(offsets) {
        vector.iter_mut().zip(offset).for_each(|(x, by)| *x += weight as f32 * by);
    }
}

/// Four influences each; programs write one or two sets. All are kept while vertices are moved.
pub const MOST_SETS: usize = 4;

/// Moves vertices by a skin; says of each whether it is mirrored, which turns the winding of faces.
///
/// `joints`: the matrices of the joints. Joints that do not exist move nothing, as do sets past [`MOST_SETS`]. Errors: broken data.
pub fn skin(
    corners: &PrimitiveCorners<'_>,
    joints: &[Matrix],
    vertices: &mut Vertices,
) -> Result<Vec<bool>, Error> {
    let sets = influences(corners)?;
    let Vertices { positions, normals, tangents } = vertices;
    let mut is_mirrored = vec![false; positions.len()];
    for at in 0..positions.len() {
        let (sum, weight) = sum_at(at, &sets, joints);
        // What nothing moves stays where it was bound.
        if weight == 0.0 {
            continue;
        }
        let [a, b, c, d] = sum.map(|column| column.map(|x| x / weight));
        let moved = |[x, y, z]: [f32; 3], along: f64| {
            let [x, y, z] = [x, y, z].map(f64::from);
            [0, 1, 2].map(|i| (a[i] * x + b[i] * y + c[i] * z + d[i] * along) as f32)
        };
        positions[at] = moved(positions[at], 1.0);
        let transform = Transform::new(direction_columns(&[a, b, c, d]));
        is_mirrored[at] = transform.orientation() < 0.0;
        if let Some(normal) = normals.get_mut(at) {
            *normal = transform.normal(*normal);
        }
        if let Some(tangent) = tangents.get_mut(at) {
            let [x, y, z, w] = *tangent;
            let [x, y, z] = moved([x, y, z], 0.0);
            *tangent = [x, y, z, transform.orientation() * w];
        }
    }
    Ok(is_mirrored)
}

/// The joints of every corner, as floats, and their weights: four of each.
type Influences = (Vec<[f32; 4]>, Vec<[f32; 4]>);

/// The sets of influences that the primitive has.
fn influences(corners: &PrimitiveCorners<'_>) -> Result<Vec<Influences>, Error> {
    let mut sets = Vec::new();
    for set in 0..MOST_SETS {
        let influence = |name: &str| corners.vectors::<4>(&format!("{name}_{set}"));
        let (Some(places), Some(weights)) = (influence("JOINTS")?, influence("WEIGHTS")?) else { break };
        sets.push((places, weights));
    }
    Ok(sets)
}

/// The sum of the matrices that move a corner, by weight, and that of the weights.
fn sum_at(corner: usize, sets: &[Influences], joints: &[Matrix]) -> (Matrix, f64) {
    let (mut sum, mut total) = (Matrix::default(), 0.0);
    for (places, weights) in sets {
        for (place, weight) in places[corner].into_iter().zip(weights[corner].map(f64::from)) {
            let Some(joint) = joints.get(place as usize).filter(|_| weight != 0.0) else { continue };
            let parts = sum.as_flattened_mut().iter_mut().zip(joint.as_flattened());
            parts.for_each(|(sum, part)| *sum += weight * part);
            total += weight;
        }
    }
    (sum, total)
}
