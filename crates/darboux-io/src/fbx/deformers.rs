//! Skins and blend shapes of meshes.

use ufbx::{BlendShape, Matrix, Mesh, Node, SkinWeight, SkinningMethod, Vec3};

use super::geometry::vector;
use crate::error::shortened;
use crate::source::{CornerValues, SourceMorph, SourceSkin, VertexWeights};
use crate::words::counted;

/// The most influences of a vertex that are kept: readers of glTF take four or eight.
const MAX_INFLUENCES: usize = 8;

/// The skin of a mesh, and the weights of its vertices; none without bones. `lacks` gets a noun phrase for
/// what is left out.
pub fn skin(mesh: &Mesh, lacks: &mut Vec<String>) -> Option<(SourceSkin, Vec<VertexWeights>)> {
    let name = &*shortened(&mesh.element.name);
    let mut skins = mesh.skin_deformers.into_iter();
    let skin = skins.next()?;
    let others = skins.count();
    if others > 0 {
        lacks.push(format!("{others} further skins of {:?}", name));
    }
    let bones: Vec<(&Node, &Matrix)> = skin
        .clusters
        .into_iter()
        .filter_map(|cluster| Some((cluster.bone_node.as_deref()?, &cluster.geometry_to_bone)))
        .collect();
    // Indices of joints have 16 bits in glTF.
    if bones.is_empty() || bones.len() != skin.clusters.count || bones.len() > usize::from(u16::MAX) {
        lacks.push(format!("the skin of {:?}, which lacks bones", name));
        return None;
    }
    let influences = |vertex: usize| -> &[SkinWeight] {
        let Some(range) = skin.vertices.get(vertex) else { return &[] };
        let begin = range.weight_begin as usize;
        &skin.weights.as_ref()[begin..begin + range.num_weights as usize]
    };
    let most = (0..mesh.vertices.count).map(|vertex| influences(vertex).len()).max().unwrap_or(0);
    if most > MAX_INFLUENCES {
        lacks.push(format!(
            "all but the {MAX_INFLUENCES} largest of up to {most} weights of the vertices of {:?}",
            name
        ));
    }
    let unweighted = (0..mesh.vertices.count).filter(|&vertex| influences(vertex).is_empty()).count();
    if unweighted > 0 {
        let vertices = counted(unweighted, "vertex", "vertices");
        lacks.push(format!(
            "the place of {vertices} of {name:?} without weights, which follow the first joint"
        ));
    }
    if matches!(skin.skinning_method, SkinningMethod::DualQuaternion | SkinningMethod::BlendedDqLinear) {
        lacks.push(format!("the dual quaternions of the skin of {name:?}, which is linear in glTF"));
    }
    let mut sets = vec![VertexWeights::default(); most.clamp(1, MAX_INFLUENCES).div_ceil(4)];
    for vertex in 0..mesh.vertices.count {
        add_influences(&mut sets, influences(vertex));
    }
    let skin = SourceSkin {
        name: shortened(&skin.element.name),
        joints: bones.iter().map(|(bone, _)| bone.element.typed_id as usize).collect(),
        inverse_bind_matrices: bones
            .iter()
            .map(|(_, matrix)| columns(matrix).map(|c| c.map(|x| x as f32)))
            .collect(),
    };
    Some((skin, sets))
}

/// Appends the influences of one vertex, the largest first, to all sets. They add up to 1; a vertex without
/// any follows the first joint.
fn add_influences(sets: &mut [VertexWeights], influences: &[SkinWeight]) {
    let kept = &influences[..influences.len().min(4 * sets.len())];
    let sum: f64 = kept.iter().map(|influence| influence.weight).sum();
    for (set, list) in sets.iter_mut().enumerate() {
        let (mut joints, mut weights) = ([0; 4], [0.0; 4]);
        for (place, influence) in kept.iter().skip(4 * set).take(4).enumerate() {
            joints[place] = influence.cluster_index as u16;
            weights[place] = (influence.weight / sum) as f32;
        }
        if kept.is_empty() && set == 0 {
            weights[0] = 1.0;
        }
        list.joints.push(joints);
        list.weights.push(weights);
    }
}

/// The blend shapes of a mesh at their full weight. `lacks` gets a noun phrase for shapes between the rest
/// and a full weight.
pub fn morphs(mesh: &Mesh, lacks: &mut Vec<String>) -> Vec<SourceMorph> {
    let name = &*shortened(&mesh.element.name);
    let channels = || mesh.blend_deformers.into_iter().flat_map(|deformer| &deformer.channels);
    let in_between: usize = channels().map(|channel| channel.keyframes.count.saturating_sub(1)).sum();
    if in_between > 0 {
        lacks.push(format!("{in_between} shapes between other shapes of {:?}", name));
    }
    channels()
        .filter_map(|channel| {
            let shape = channel.target_shape.as_ref()?;
            let (of_channel, of_shape) = (&*channel.element.name, &*shape.element.name);
            // A channel reaches its shape at the shape's full weight, and glTF at 1.
            let full = channel.keyframes.into_iter().last().map_or(1.0, |keyframe| keyframe.target_weight);
            let weight = if full > 0.0 { channel.weight / full } else { channel.weight };
            let has_normals = shape.normal_offsets.iter().any(|offset| vector(offset) != [0.0; 3]);
            let normals = || CornerValues::of_positions(offsets(mesh, shape, &shape.normal_offsets));
            Some(SourceMorph {
                name: shortened(if of_channel.is_empty() { of_shape } else { of_channel }),
                positions: offsets(mesh, shape, &shape.position_offsets),
                normals: has_normals.then(normals),
                weight: weight as f32,
            })
        })
        .collect()
}

/// One offset for each vertex of a mesh.
fn offsets(mesh: &Mesh, shape: &BlendShape, values: &[Vec3]) -> Vec<[f32; 3]> {
    let mut of_vertex = vec![[0.0; 3]; mesh.vertices.count];
    for (at, (&vertex, offset)) in shape.offset_vertices.iter().zip(values).enumerate() {
        let weight = shape.offset_weights.get(at).map_or(1.0, |&weight| weight);
        if let Some(to) = of_vertex.get_mut(vertex as usize) {
            *to = [offset.x, offset.y, offset.z].map(|x| (x * weight) as f32);
        }
    }
    of_vertex
}

/// A matrix in four columns.
pub fn columns(m: &Matrix) -> [[f64; 4]; 4] {
    [
        [m.m00, m.m10, m.m20, 0.0],
        [m.m01, m.m11, m.m21, 0.0],
        [m.m02, m.m12, m.m22, 0.0],
        [m.m03, m.m13, m.m23, 1.0],
    ]
}
