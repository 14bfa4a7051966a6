//! From a scene of ufbx to a scene of polygons: nodes with their paths, meshes with the materials that their
//! nodes give them, skins, shapes.

use std::collections::{HashMap, HashSet};

use darboux::{Axes, Axis};
use ufbx::{CoordinateAxis, Mesh, Node, PropFlags, Scene};

use super::deformers;
use super::geometry::{self, Losses};
use super::materials::{self, MaterialReader};
use crate::error::{ContentError, shortened};
use crate::memory_limit::Budget;
use crate::source::{
    MadeNormals, ModelFiles, SourceFormat, SourceMesh, SourceNode, SourceScene, VertexWeights,
};
use crate::words::counted_if_any;

/// A mesh and the materials that a node gives it. Nodes with the same share one mesh.
type MeshUse = (u32, Vec<u32>);

/// Reads the scene.
///
/// Errors: meshes that need more than a third of the memory limit, the other two thirds being ufbx's.
pub fn scene(scene: &Scene, files: &ModelFiles, budget: &Budget) -> Result<SourceScene, ContentError> {
    let uses = mesh_uses(scene);
    check_memory(scene, &uses, budget)?;
    let mut made = SourceScene::new(SourceFormat::Fbx);
    made.generator = Some(shortened(&scene.metadata.creator)).filter(|creator| !creator.is_empty());
    made.axes = axes(scene).unwrap_or(made.axes);
    made.meters_per_unit = Some(scene.settings.unit_meters).filter(|unit| unit.is_finite() && *unit > 0.0);
    let skin_of_mesh = add_meshes(scene, &uses, &mut made);
    add_materials(scene, files, &mut made);
    made.nodes = scene.nodes.into_iter().map(|found| node(found, &uses, &skin_of_mesh)).collect();
    made.not_carried.extend(left_out(scene));
    if made.meshes.iter().all(|mesh| mesh.corners.is_empty()) {
        let problem = "there are no meshes in the file; if there should be, export it again with its meshes";
        made.warnings.push(problem.to_owned());
    }
    Ok(made)
}

/// The different pairs of mesh and materials, in the order of the nodes, with the first node of each.
fn mesh_uses(scene: &Scene) -> HashMap<MeshUse, (usize, &Node)> {
    let mut uses = HashMap::new();
    for node in &scene.nodes {
        if let Some(found) = mesh_use(node) {
            let place = uses.len();
            uses.entry(found).or_insert((place, node));
        }
    }
    uses
}

fn mesh_use(node: &Node) -> Option<MeshUse> {
    let mesh = node.mesh.as_deref()?;
    let materials = if node.materials.count > 0 { &node.materials } else { &mesh.materials };
    Some((mesh.element.typed_id, materials.into_iter().map(|material| material.element.typed_id).collect()))
}

fn check_memory(
    scene: &Scene,
    uses: &HashMap<MeshUse, (usize, &Node)>,
    budget: &Budget,
) -> Result<(), ContentError> {
    // Nodes and materials become JSON text and its parsed form. A node's path repeats the names of its
    // parents.
    const PER_ELEMENT: usize = 4096;
    let elements = scene.nodes.count.saturating_add(scene.materials.count).saturating_mul(PER_ELEMENT);
    let meshes = uses.keys().map(|(mesh, _)| geometry::estimate(&scene.meshes[*mesh as usize]));
    if meshes.fold(elements, usize::saturating_add) > budget.bytes / 3 {
        return Err(ContentError::unsupported("", budget.exceeded("the meshes need")));
    }
    Ok(())
}

/// The axes of the file; none if it does not say.
fn axes(scene: &Scene) -> Option<Axes> {
    let axis = |axis: CoordinateAxis, is_opposite: bool| {
        let (along, against) = match axis {
            CoordinateAxis::PositiveX => (Axis::X, Axis::MinusX),
            CoordinateAxis::NegativeX => (Axis::MinusX, Axis::X),
            CoordinateAxis::PositiveY => (Axis::Y, Axis::MinusY),
            CoordinateAxis::NegativeY => (Axis::MinusY, Axis::Y),
            CoordinateAxis::PositiveZ => (Axis::Z, Axis::MinusZ),
            CoordinateAxis::NegativeZ => (Axis::MinusZ, Axis::Z),
            CoordinateAxis::Unknown => return None,
        };
        Some(if is_opposite { against } else { along })
    };
    let found = &scene.settings.axes;
    // ufbx's right is the right of a viewer in front of the model; ours is the model's right.
    Axes::new(axis(found.right, true)?, axis(found.up, false)?, axis(found.front, false)?)
}

/// Adds the meshes of all uses. Returns the skin of each mesh that has one, by the mesh's place in the FBX.
fn add_meshes(
    scene: &Scene,
    uses: &HashMap<MeshUse, (usize, &Node)>,
    made: &mut SourceScene,
) -> HashMap<u32, usize> {
    let mut in_order: Vec<(&MeshUse, &(usize, &Node))> = uses.iter().collect();
    in_order.sort_unstable_by_key(|(_, (place, _))| *place);
    let mut skins: HashMap<u32, Option<(usize, Vec<VertexWeights>)>> = HashMap::new();
    let mut losses: Vec<Losses> = Vec::new();
    for ((mesh_id, materials), (_, node)) in in_order {
        let mesh = &scene.meshes[*mesh_id as usize];
        let is_first = !skins.contains_key(mesh_id);
        let mut lacks = Vec::new();
        let mut built = SourceMesh {
            name: mesh_name(mesh, node),
            path: path(node),
            morphs: deformers::morphs(mesh, &mut lacks),
            ..SourceMesh::default()
        };
        let lost = geometry::fill(mesh, &mut built);
        let skin = skins.entry(*mesh_id).or_insert_with(|| {
            let (skin, weights) = deformers::skin(mesh, &mut lacks)?;
            made.skins.push(skin);
            Some((made.skins.len() - 1, weights))
        });
        if let Some((_, weights)) = skin {
            built.weights.clone_from(weights);
        }
        let slots = geometry::material_slots(mesh);
        built.material_of_face = slots.iter().map(|&slot| materials.get(slot as usize).copied()).collect();
        built.material = materials.first().copied();
        made.meshes.push(built);
        if is_first {
            losses.push(lost);
            made.not_carried.append(&mut lacks);
        }
    }
    add_losses(&losses, made);
    skins.into_iter().filter_map(|(mesh, skin)| Some((mesh, skin?.0))).collect()
}

fn add_losses(losses: &[Losses], made: &mut SourceScene) {
    let count = |is_lost: fn(&Losses) -> bool| losses.iter().filter(|lost| is_lost(lost)).count();
    let flat: usize = losses.iter().map(|lost| lost.lines_and_points).sum();
    made.not_carried.extend(counted_if_any(
        flat,
        "face of one or two corners",
        "faces of one or two corners",
    ));
    let unsigned = count(|lost| lost.has_tangents_without_sign);
    made.not_carried.extend(counted_if_any(
        unsigned,
        "mesh's tangents, which have no bitangents and so no sign",
        "meshes' tangents, which have no bitangents and so no sign",
    ));
    made.not_carried.extend(counted_if_any(
        count(|lost| lost.has_further_tangents),
        "mesh's tangents of UV sets after the first",
        "meshes' tangents of UV sets after the first",
    ));
    made.not_carried.extend(counted_if_any(
        count(|lost| lost.is_subdivided),
        "subdivision surface, which is read as its cage",
        "subdivision surfaces, which are read as their cages",
    ));
    let normals = MadeNormals { all: count(|lost| lost.has_made_normals), some: 0 };
    made.warnings.extend(normals.warnings());
}

fn add_materials(scene: &Scene, files: &ModelFiles, made: &mut SourceScene) {
    let mut reader = MaterialReader::new(scene, files);
    let sets_of_materials = uv_sets_of_materials(scene, &mut made.meshes);
    for (material, uv_sets) in &sets_of_materials {
        made.materials.push(reader.material(&scene.materials[*material as usize], uv_sets));
    }
    made.images = reader.images;
    // A material of meshes with other UV sets was read more than once.
    let mut known = HashSet::new();
    let mut is_new = |line: &String| known.insert(line.clone());
    made.warnings.extend(reader.warnings.into_iter().filter(&mut is_new));
    made.not_carried.extend(reader.not_carried.into_iter().filter(&mut is_new));
}

/// The materials of the file, each with the names of its meshes' UV sets, by which textures choose a set. A
/// material whose meshes have the chosen set at different places is there once for each place: copies follow
/// the materials of the file, and meshes are changed to them.
fn uv_sets_of_materials(scene: &Scene, meshes: &mut [SourceMesh]) -> Vec<(u32, Vec<String>)> {
    let mut sets: Vec<(u32, Vec<String>)> =
        (0..scene.materials.count as u32).map(|material| (material, Vec::new())).collect();
    let mut made: HashMap<(u32, Vec<usize>), u32> = HashMap::new();
    let mut is_used = vec![false; sets.len()];
    for mesh in meshes {
        let names: Vec<String> = mesh.uv_sets.iter().map(|set| set.name.clone()).collect();
        let mut with_sets = |material: &mut u32| {
            let Some(found) = scene.materials.get(*material as usize) else { return };
            let key = (*material, materials::places_of_uv_sets(found, &names));
            *material = *made.entry(key).or_insert_with(|| {
                if !std::mem::replace(&mut is_used[*material as usize], true) {
                    sets[*material as usize].1.clone_from(&names);
                    return *material;
                }
                sets.push((*material, names.clone()));
                sets.len() as u32 - 1
            });
        };
        mesh.material_of_face.iter_mut().flatten().for_each(&mut with_sets);
        mesh.material.iter_mut().for_each(&mut with_sets);
    }
    sets
}

fn node(
    node: &Node,
    uses: &HashMap<MeshUse, (usize, &Node)>,
    skin_of_mesh: &HashMap<u32, usize>,
) -> SourceNode {
    let matrix = deformers::columns(&node.node_to_parent);
    SourceNode {
        name: if node.is_root { "FBX root".to_owned() } else { shortened(&node.element.name) },
        parent: node.parent.as_ref().map(|parent| parent.element.typed_id as usize),
        matrix: matrix.as_flattened().iter().all(|x| x.is_finite()).then_some(matrix),
        mesh: mesh_use(node).and_then(|found| Some(uses.get(&found)?.0)),
        skin: node.mesh.as_ref().and_then(|mesh| skin_of_mesh.get(&mesh.element.typed_id).copied()),
    }
}

/// The names of a node's parents and its own, from the root on.
fn path(node: &Node) -> String {
    let is_named = |node: &&Node| !is_helper(node);
    let above = std::iter::successors(Some(node), |node| node.parent.as_deref());
    let mut names: Vec<String> = above.filter(is_named).map(|node| shortened(&node.element.name)).collect();
    names.reverse();
    shortened(&names.join("/"))
}

/// Whether ufbx made the node.
fn is_helper(node: &Node) -> bool {
    node.is_root || node.is_geometry_transform_helper || node.is_scale_helper
}

/// The name of a mesh: its own, or that of its node where exporters leave it empty.
fn mesh_name(mesh: &Mesh, node: &Node) -> String {
    shortened(if mesh.element.name.is_empty() { &node.element.name } else { &mesh.element.name })
}

/// Noun phrases for what the scene has and is not read.
fn left_out(scene: &Scene) -> impl Iterator<Item = String> {
    let curves = scene.line_curves.count + scene.nurbs_curves.count + scene.nurbs_surfaces.count;
    let nodes =
        |is: fn(&Node) -> bool| scene.nodes.into_iter().filter(|node| !is_helper(node) && is(node)).count();
    let hidden = nodes(|node| !node.visible);
    let is_custom =
        |node: &Node| node.element.props.props.iter().any(|p| p.flags.has_any(PropFlags::USER_DEFINED));
    let with_properties = nodes(is_custom);
    [
        (scene.anim_stacks.count, "animation", "animations"),
        (scene.cameras.count, "camera", "cameras"),
        (scene.lights.count, "light", "lights"),
        (curves, "curve or NURBS surface", "curves and NURBS surfaces"),
        (scene.cache_deformers.count, "geometry cache", "geometry caches"),
        (scene.constraints.count, "constraint", "constraints"),
        (
            scene.lod_groups.count,
            "choice of a level of detail: all levels are shown",
            "choices of levels of detail: all levels are shown",
        ),
        (hidden, "hidden node, which is shown", "hidden nodes, which are shown"),
        (with_properties, "node's custom properties", "nodes' custom properties"),
    ]
    .into_iter()
    .filter_map(|(count, one, several)| counted_if_any(count, one, several))
}
