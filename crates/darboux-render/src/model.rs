//! Reads the meshes of a glTF document, in the pose of its scene, as triangles with tangents.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use darboux_io::Error;
use darboux_io::gltf::{
    Document, Material, MeshInstance, MeshInstances, PrimitiveCorners, PrimitiveName, TextureUse,
};

use crate::algebra::Matrix;
use crate::camera::Bounds;
use crate::derivatives;
use crate::heat;
use crate::material_textures::textures_of;
use crate::mistakes::{self, FrameMistake};
use crate::part::{Part, layout_position};
use crate::pose::{self, MAX_INFLUENCE_SETS, Vertices};
use crate::subject::Subject;
use crate::vertex::SurfaceVertex;

/// The meshes of a document, or of several, ready to be drawn.
pub struct Model<'a> {
    /// One, unless models were joined.
    pub(crate) documents: Vec<&'a Document>,
    /// Of all documents, each with the index of its document.
    pub(crate) materials: Vec<(usize, Material)>,
    pub(crate) parts: Vec<Part>,
    /// Whether the tangents are derived from positions and UVs, as some shaders do.
    pub(crate) is_derived: bool,
    /// The number of primitives of points or lines, which are not drawn.
    skipped_primitives: usize,
}

/// A mesh in one pose, with all places where the scene has it.
struct PosedMesh<'a> {
    weights: Arc<[f64]>,
    joints: Option<&'a [Matrix]>,
    matrices: Arc<[Matrix]>,
}

/// The most corners in additional poses, which take several GB: every pose of a mesh has its own copy of the
/// vertices.
const MAX_POSED_CORNERS: usize = 3 << 24;

impl<'a> Model<'a> {
    /// Reads the meshes of the scene in their poses, with the tangents of the document.
    ///
    /// Errors: invalid data; too many poses of large meshes.
    pub fn read(document: &'a Document) -> Result<Self, Error> {
        let materials = document.materials()?;
        let instances = document.mesh_instances()?;
        let posed = posed_meshes(&instances, document.meshes().len());
        let mut parts = Vec::new();
        let mut kept: usize = 0;
        for corners in document.corners()? {
            let poses = posed.get(corners.name().mesh).map_or(&[][..], Vec::as_slice);
            kept = kept.saturating_add(
                element_count(document, &corners).saturating_mul(poses.len().saturating_sub(1)),
            );
            if kept > MAX_POSED_CORNERS {
                let problem = "has too many poses; render a part of the scene";
                return Err(invalid(document, corners.name(), problem));
            }
            check_influences(document, &corners, poses)?;
            for (at, pose) in poses.iter().enumerate() {
                parts.push(read_part(document, &materials, &corners, at, pose)?);
            }
        }
        let skipped_primitives = skipped_primitives(document, &posed);
        let materials = materials.into_iter().map(|material| (0, material)).collect();
        Ok(Self { documents: vec![document], materials, parts, is_derived: false, skipped_primitives })
    }

    /// The meshes of both models in one scene.
    pub fn joined_with(mut self, other: Self) -> Self {
        let (documents, materials) = (self.documents.len(), self.materials.len());
        let meshes: usize = self.documents.iter().map(|document| document.meshes().len()).sum();
        self.parts.extend(other.parts.into_iter().map(|mut part| {
            part.mesh += meshes;
            part.key[0] += meshes;
            part.material = part.material.map(|material| material + materials);
            part
        }));
        let later = other.materials.into_iter().map(|(document, material)| (document + documents, material));
        self.materials.extend(later);
        self.documents.extend(other.documents);
        self.skipped_primitives += other.skipped_primitives;
        self
    }

    /// The model with tangents that are derived from positions and UVs, as some shaders do, instead of its
    /// own.
    pub fn derived(mut self) -> Self {
        self.is_derived = true;
        for part in &mut self.parts {
            part.has_tangents = !part.tangent_uvs.is_empty();
            for (corners, uvs) in
                part.corners.as_chunks_mut::<3>().0.iter_mut().zip(part.tangent_uvs.as_chunks().0)
            {
                let tangents =
                    derivatives::tangents(corners.map(|c| c.position), corners.map(|c| c.normal), *uvs);
                corners.iter_mut().zip(tangents).for_each(|(corner, tangent)| corner.tangent = tangent);
            }
        }
        self
    }

    /// The model with the tangents that code with a mistake computes.
    #[must_use]
    pub fn with_mistake(&self, mistake: FrameMistake) -> Model<'a> {
        let mut parts = self.parts.clone();
        for part in parts.iter_mut().filter(|part| part.has_tangents && !part.tangent_uvs.is_empty()) {
            let wrong = mistakes::tangents(mistake, &part.corners, &part.tangent_uvs);
            part.corners.iter_mut().zip(wrong).for_each(|(corner, tangent)| corner.tangent = tangent);
        }
        let Self { documents, materials, is_derived, skipped_primitives, .. } = self;
        Model {
            documents: documents.clone(),
            materials: materials.clone(),
            parts,
            is_derived: *is_derived,
            skipped_primitives: *skipped_primitives,
        }
    }

    /// The model with the angles to the tangents of another model of the same file, for
    /// [`View::Angle`](crate::View::Angle).
    pub fn compared_with(mut self, other: &Model<'_>) -> Self {
        let others: HashMap<_, _> = other.parts.iter().map(|part| (part.key, part)).collect();
        for part in &mut self.parts {
            let other = others.get(&part.key).filter(|other| part.is_comparable(other));
            let Some(other) = other else { continue };
            let pairs = part.corners.as_chunks_mut::<3>().0.iter_mut().zip(other.corners.as_chunks::<3>().0);
            for (corners, others) in pairs {
                let degrees = heat::degrees(corners.map(|c| c.tangent), others.map(|c| c.tangent));
                corners.iter_mut().zip(degrees).for_each(|(corner, degrees)| corner.degrees = degrees);
            }
        }
        self
    }

    /// The model with only these meshes. `meshes`: their indices.
    pub fn only(mut self, meshes: &[usize]) -> Self {
        self.parts.retain(|part| meshes.contains(&part.mesh));
        self
    }

    /// The number of triangles in the scene. A mesh counts once per place.
    pub fn triangle_count(&self) -> u64 {
        self.parts.iter().map(Part::triangle_count).fold(0, u64::saturating_add)
    }

    /// What a drawing of the subject lacks, one sentence each.
    pub(crate) fn warnings(&self, subject: Subject) -> Vec<String> {
        let triangles: usize = self.parts.iter().map(|part| part.skipped_triangles).sum();
        let mut warnings = Vec::new();
        if triangles > 0 && subject == Subject::Surface {
            warnings.push(format!(
                "has {triangles} triangles with positions that are not finite, which are not drawn"
            ));
        }
        if self.skipped_primitives > 0 {
            let primitives = self.skipped_primitives;
            warnings.push(format!("has {primitives} primitives of points or lines, which are not drawn"));
        }
        warnings
    }

    /// The box around the subject; none if the subject is empty.
    pub(crate) fn bounds(&self, subject: Subject) -> Option<Bounds> {
        let mut all = Box3::EMPTY;
        self.visit_points(subject, &mut |point| all.add(point));
        if subject == Subject::UvLayout && all.min[0] <= all.max[0] {
            for uv in [[0.0, 0.0], [1.0, 1.0]] {
                all.add(layout_position(uv).map(f64::from));
            }
        }
        (all.min[0] <= all.max[0]).then_some([all.min, all.max])
    }

    /// Visits points whose convex hull contains the subject: all vertices, or the boxes of parts that have
    /// very many places. Points may be not finite.
    pub(crate) fn visit_points(&self, subject: Subject, visit: &mut dyn FnMut([f64; 3])) {
        for part in &self.parts {
            if subject == Subject::UvLayout {
                part.tangent_uvs.iter().for_each(|&uv| visit(layout_position(uv).map(f64::from)));
                continue;
            }
            let positions = part.corners.iter().map(|corner| corner.position.map(f64::from));
            let points: Vec<[f64; 3]> = if part.triangle_count() > MAX_VISITED_TRIANGLES {
                let mut own = Box3::EMPTY;
                positions.for_each(|position| own.add(position));
                own.corners().to_vec()
            } else {
                positions.collect()
            };
            for [a, b, c, d] in part.matrices.iter() {
                for [x, y, z] in &points {
                    visit([0, 1, 2].map(|i| a[i] * x + b[i] * y + c[i] * z + d[i]));
                }
            }
        }
    }
}

/// The most triangles of a part whose vertices are all visited.
const MAX_VISITED_TRIANGLES: u64 = 1 << 20;

/// The number of primitives of points or lines in meshes that the scene shows.
fn skipped_primitives(document: &Document, posed: &[Vec<PosedMesh<'_>>]) -> usize {
    /// The first mode of triangles in glTF.
    const TRIANGLES: u32 = 4;
    let shown = document.meshes().iter().zip(posed).filter(|(_, poses)| !poses.is_empty());
    shown.flat_map(|(mesh, _)| &mesh.primitives).filter(|primitive| primitive.mode < TRIANGLES).count()
}

/// The poses of every mesh, each with the matrices of all its instances.
fn posed_meshes(instances: &MeshInstances, mesh_count: usize) -> Vec<Vec<PosedMesh<'_>>> {
    let (mut at, mut ids) = (HashMap::new(), WeightIds::default());
    let mut posed: Vec<Vec<(&MeshInstance, Vec<Matrix>)>> = (0..mesh_count).map(|_| Vec::new()).collect();
    for mesh in &instances.meshes {
        let Some(poses) = posed.get_mut(mesh.mesh) else { continue };
        let pose = *at.entry((mesh.mesh, mesh.skin, ids.of(&mesh.weights))).or_insert(poses.len());
        match poses.get_mut(pose) {
            // A skin determines the place of a mesh, so the same skin has the same place.
            Some(_) if mesh.skin.is_some() => {}
            Some((_, matrices)) => matrices.extend(&mesh.matrices),
            None => poses.push((mesh, mesh.matrices.clone())),
        }
    }
    let pose = |(mesh, matrices): (&MeshInstance, Vec<Matrix>)| PosedMesh {
        weights: mesh.weights.clone(),
        joints: mesh.skin.and_then(|skin| instances.skins.get(skin)).map(Vec::as_slice),
        matrices: matrices.into(),
    };
    posed.into_iter().map(|poses| poses.into_iter().map(pose).collect()).collect()
}

/// A number for equal weights. Most nodes share those of their mesh, which are compared once.
#[derive(Default)]
struct WeightIds {
    of_shared: HashMap<*const f64, usize>,
    of_bits: HashMap<Vec<u64>, usize>,
}

impl WeightIds {
    fn of(&mut self, weights: &Arc<[f64]>) -> usize {
        let Self { of_shared, of_bits } = self;
        *of_shared.entry(weights.as_ptr()).or_insert_with(|| {
            let next = of_bits.len();
            *of_bits.entry(weights.iter().map(|weight| weight.to_bits()).collect()).or_insert(next)
        })
    }
}

/// The number of corners of a primitive, or of its vertices if there are more. Every pose reads all of them.
fn element_count(document: &Document, corners: &PrimitiveCorners<'_>) -> usize {
    let PrimitiveName { mesh, primitive, .. } = corners.name();
    let primitive = &document.meshes()[*mesh].primitives[*primitive];
    let accessors = primitive.targets.iter().chain([&primitive.attributes]).flat_map(BTreeMap::values);
    let counts = accessors.filter_map(|&accessor| Some(document.accessors().get(accessor)?.count));
    counts.fold(corners.len(), usize::max)
}

/// The error about a primitive.
fn invalid(document: &Document, primitive: &PrimitiveName, problem: impl Into<String>) -> Error {
    Error::Invalid { file: document.name().to_owned(), at: primitive.path(), problem: problem.into() }
}

/// Errors: the vertices of a skinned primitive have too many joints.
fn check_influences(
    document: &Document,
    corners: &PrimitiveCorners<'_>,
    poses: &[PosedMesh<'_>],
) -> Result<(), Error> {
    let PrimitiveName { mesh, primitive, .. } = corners.name();
    let attributes = &document.meshes()[*mesh].primitives[*primitive].attributes;
    let is_skinned = poses.iter().any(|pose| pose.joints.is_some());
    if is_skinned && attributes.contains_key(&format!("JOINTS_{MAX_INFLUENCE_SETS}")) {
        let most = 4 * MAX_INFLUENCE_SETS;
        let problem = format!("has vertices with more than {most} joints; limit them where you export it");
        return Err(invalid(document, corners.name(), problem));
    }
    Ok(())
}

/// Reads a primitive in a pose of its mesh, without triangles whose positions are not finite. `at`: the index
/// of the pose.
fn read_part(
    document: &Document,
    materials: &[Material],
    corners: &PrimitiveCorners<'_>,
    at: usize,
    pose: &PosedMesh<'_>,
) -> Result<Part, Error> {
    let none = Material::default();
    let material = match corners.material() {
        None => &none,
        Some(material) => materials.get(material).ok_or_else(|| {
            let problem = format!("its material {material} does not exist; export the file again");
            invalid(document, corners.name(), problem)
        })?,
    };
    let tangent_uvs = corners.vectors::<2>(&set_name(material.tangent_uv_set))?.unwrap_or_default();
    let uvs = |texture: Option<&TextureUse>| -> Result<Vec<[f32; 2]>, Error> {
        let Some(texture) = texture else { return Ok(tangent_uvs.clone()) };
        Ok(corners.vectors::<2>(&set_name(texture.uv_set))?.unwrap_or_default())
    };
    let [base, normal, surface, occlusion, emission] = textures_of(material).map(|(used, _)| uvs(used));
    let uvs = [base?, normal?, surface?, occlusion?, emission?];
    let (Vertices { positions, normals, tangents }, is_mirrored) = posed_vertices(corners, pose)?;
    let colors = vertex_colors(corners)?;
    let corner = |i: usize| SurfaceVertex {
        position: positions[i],
        normal: normals.get(i).copied().unwrap_or_default(),
        tangent: tangents.get(i).copied().unwrap_or_default(),
        uvs: [0, 1, 2, 3, 4].map(|k| uvs[k].get(i).copied().unwrap_or_default()),
        color: colors.get(i).copied().unwrap_or([1.0; 4]),
        degrees: heat::NO_ANGLE,
    };
    let is_finite = |triangle: &[[f32; 3]; 3]| triangle.as_flattened().iter().all(|x| x.is_finite());
    let triangles = positions.as_chunks::<3>().0.iter().enumerate();
    let kept = triangles.filter(|(_, triangle)| is_finite(triangle)).map(|(triangle, _)| 3 * triangle);
    let wound = |first: usize| match is_mirrored.get(first..first + 3) {
        Some([true, true, true]) => [first, first + 2, first + 1],
        _ => [first, first + 1, first + 2],
    };
    let kept: Vec<usize> = kept.flat_map(wound).collect();
    Ok(Part {
        mesh: corners.name().mesh,
        key: [corners.name().mesh, corners.name().primitive, at],
        has_tangents: !tangents.is_empty(),
        material: corners.material(),
        skipped_triangles: positions.len() / 3 - kept.len() / 3,
        corners: kept.iter().map(|&i| corner(i)).collect(),
        tangent_uvs: kept.iter().filter_map(|&i| tangent_uvs.get(i).copied()).collect(),
        matrices: pose.matrices.clone(),
    })
}

/// The colours of a primitive's corners, with or without alpha in the file; empty if it has none.
fn vertex_colors(corners: &PrimitiveCorners<'_>) -> Result<Vec<[f32; 4]>, Error> {
    if let Ok(colors) = corners.vectors::<4>("COLOR_0") {
        return Ok(colors.unwrap_or_default());
    }
    let colors = corners.vectors::<3>("COLOR_0")?.unwrap_or_default();
    Ok(colors.into_iter().map(|[r, g, b]| [r, g, b, 1.0]).collect())
}

/// The vertices of a primitive's corners in a pose. With a skin, also whether the skin mirrors each of them.
fn posed_vertices(
    corners: &PrimitiveCorners<'_>,
    pose: &PosedMesh<'_>,
) -> Result<(Vertices, Vec<bool>), Error> {
    let mut vertices = Vertices {
        positions: corners.vectors("POSITION")?.unwrap_or_default(),
        normals: corners.vectors("NORMAL")?.unwrap_or_default(),
        tangents: corners.vectors("TANGENT")?.unwrap_or_default(),
    };
    pose::morph(corners, &pose.weights, &mut vertices)?;
    let is_mirrored = match pose.joints {
        Some(joints) => pose::skin(corners, joints, &mut vertices)?,
        None => Vec::new(),
    };
    Ok((vertices, is_mirrored))
}

/// The semantic of a UV set in glTF.
fn set_name(set: usize) -> String {
    format!("TEXCOORD_{set}")
}

/// An axis-aligned bounding box.
struct Box3 {
    min: [f64; 3],
    max: [f64; 3],
}

impl Box3 {
    const EMPTY: Self = Self { min: [f64::INFINITY; 3], max: [f64::NEG_INFINITY; 3] };

    /// Ignores points that are not finite.
    fn add(&mut self, point: [f64; 3]) {
        if point.iter().all(|x| x.is_finite()) {
            (0..3).for_each(|i| {
                self.min[i] = self.min[i].min(point[i]);
                self.max[i] = self.max[i].max(point[i]);
            });
        }
    }

    fn corners(&self) -> [[f64; 3]; 8] {
        let ends = [self.min, self.max];
        [0, 1, 2, 3, 4, 5, 6, 7].map(|bits: usize| [0, 1, 2].map(|i| ends[bits >> i & 1][i]))
    }
}
