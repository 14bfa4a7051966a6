//! Moves vertices by morph targets and skins.

use darboux::Transform;
use darboux_io::Error;
use darboux_io::gltf::PrimitiveCorners;

use crate::algebra::{Matrix, direction_columns};

/// The attributes of corners that a pose changes. Normals and tangents are empty if the primitive has none.
pub struct Vertices {
    pub positions: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
    pub tangents: Vec<[f32; 4]>,
}

/// Adds the offsets of each morph target, times its weight. Errors: invalid data.
pub fn morph(corners: &PrimitiveCorners<'_>, weights: &[f64], vertices: &mut Vertices) -> Result<(), Error> {
    let Vertices { positions, normals, tangents } = vertices;
    for (target, &weight) in weights.iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
        let offsets = |semantic| corners.offsets(target, semantic).map(Option::unwrap_or_default);
        add_scaled(positions, &offsets("POSITION")?, weight);
        add_scaled(normals, &offsets("NORMAL")?, weight);
        add_scaled(tangents, &offsets("TANGENT")?, weight);
    }
    Ok(())
}

fn add_scaled<const N: usize>(vectors: &mut [[f32; N]], offsets: &[[f32; 3]], weight: f64) {
    for (vector, offset) in vectors.iter_mut().zip(offsets) {
        vector.iter_mut().zip(offset).for_each(|(x, by)| *x += weight as f32 * by);
    }
}

/// The most influence sets per vertex, of four joints each. Exporters write one or two.
pub const MAX_INFLUENCE_SETS: usize = 4;

/// Moves vertices by a skin. Returns for each vertex whether the skin mirrors it, which reverses the winding
/// of its triangles.
///
/// `joints`: the matrices of the joints. Joints that do not exist are ignored, as are influence sets past
/// [`MAX_INFLUENCE_SETS`].
///
/// Errors: invalid data.
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
        // A vertex without joints keeps its position.
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

/// Four joint indices (as floats) and four weights per corner.
type Influences = (Vec<[f32; 4]>, Vec<[f32; 4]>);

/// The influence sets of the primitive.
fn influences(corners: &PrimitiveCorners<'_>) -> Result<Vec<Influences>, Error> {
    let mut sets = Vec::new();
    for set in 0..MAX_INFLUENCE_SETS {
        let influence = |name: &str| corners.vectors::<4>(&format!("{name}_{set}"));
        let (Some(joints), Some(weights)) = (influence("JOINTS")?, influence("WEIGHTS")?) else { break };
        sets.push((joints, weights));
    }
    Ok(sets)
}

/// The weighted sum of the joint matrices of a corner, and the sum of the weights.
fn sum_at(corner: usize, sets: &[Influences], joints: &[Matrix]) -> (Matrix, f64) {
    let (mut sum, mut total) = (Matrix::default(), 0.0);
    for (indices, weights) in sets {
        for (index, weight) in indices[corner].into_iter().zip(weights[corner].map(f64::from)) {
            let Some(joint) = joints.get(index as usize).filter(|_| weight != 0.0) else { continue };
            let elements = sum.as_flattened_mut().iter_mut().zip(joint.as_flattened());
            elements.for_each(|(sum, element)| *sum += weight * element);
            total += weight;
        }
    }
    (sum, total)
}
