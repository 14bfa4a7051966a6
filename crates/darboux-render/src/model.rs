//! What is drawn of a document.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use darboux_io::Error;
use darboux_io::gltf::{
    Appearance, Document, PlacedMesh, PlacedMeshes, PrimitiveCorners, PrimitiveName, TextureUse,
};

use crate::algebra::Matrix;
use crate::camera::Bounds;
use crate::painter::Shape;
use crate::pose::{self, MOST_SETS, Vertices};
use crate::{derivatives, heat};

/// A corner as the shader takes it.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct Corner {
    pub position: [f32; 3],
    pub normal: [f32; 3],
    /// Zero where there is none.
    pub tangent: [f32; 4],
    /// Of the base colour, then of the normal map, as stored.
    pub uvs: [[f32; 2]; 2],
    /// The angle, [`heat::FLIP`] or [`heat::NONE`].
    pub degrees: f32,
}

/// The triangles of a primitive in a pose.
pub struct Part {
    pub mesh: usize,
    /// What tells it from all other parts: its mesh, primitive and pose.
    name: [usize; 3],
    /// The index of its material.
    pub material: Option<usize>,
    pub corners: Vec<Corner>,
    has_tangents: bool,
    /// Triangles without a place.
    left_out: usize,
    /// The UVs that its tangents follow, at every corner; empty where there are none.
    pub layout: Vec<[f32; 2]>,
    /// From the mesh to the scene, wherever it is.
    pub places: Arc<[Matrix]>,
}

/// What is drawn of a document.
pub struct Model<'a> {
    pub(crate) document: &'a Document,
    pub(crate) appearances: Vec<Appearance>,
    pub(crate) parts: Vec<Part>,
    /// Whether tangents are what shaders derive.
    pub(crate) is_derived: bool,
}

/// A mesh in one pose, wherever it has that.
struct Posed<'a> {
    weights: Vec<f64>,
    joints: Option<&'a [Matrix]>,
    places: Arc<[Matrix]>,
}

/// Corners of meshes whose nodes pose them differently are kept, and their vertices read, for each: so many are some GB.
const MOST_CORNERS: usize = 3 << 24;

impl<'a> Model<'a> {
    /// Reads the meshes of the scene in its pose, with the tangents that the document has. Compressed documents are decompressed.
    ///
    /// Errors: broken data; more poses of large meshes than can be kept.
    pub fn read(document: &'a mut Document) -> Result<Self, Error> {
        document.decompress()?;
        let document: &'a Document = document;
        let appearances = document.appearances()?;
        let placed = document.placed_meshes()?;
        let posed = posed_meshes(&placed, document.meshes().len());
        let mut parts = Vec::new();
        let mut kept: usize = 0;
        for corners in document.corners()? {
            let poses = posed.get(corners.name().mesh).map_or(&[][..], Vec::as_slice);
            kept = kept
                .saturating_add(elements(document, &corners).saturating_mul(poses.len().saturating_sub(1)));
            if kept > MOST_CORNERS {
                let problem = "is posed in more ways than are drawn; render a part of the scene";
                return Err(document.invalid(corners.name().path(), problem));
            }
            check_influences(document, &corners, poses)?;
            for (at, pose) in poses.iter().enumerate() {
                parts.push(read_part(document, &appearances, &corners, at, pose)?);
            }
        }
        Ok(Self { document, appearances, parts, is_derived: false })
    }

    /// The model with the tangents that shaders derive from positions and UVs, in place of its own.
    pub fn derived(mut self) -> Self {
        self.is_derived = true;
        for part in &mut self.parts {
            part.has_tangents = !part.layout.is_empty();
            for (corners, uvs) in
                part.corners.as_chunks_mut::<3>().0.iter_mut().zip(part.layout.as_chunks().0)
            {
                let tangents =
                    derivatives::tangents(corners.map(|c| c.position), corners.map(|c| c.normal), *uvs);
                corners.iter_mut().zip(tangents).for_each(|(corner, tangent)| corner.tangent = tangent);
            }
        }
        self
    }

    /// The model with the angles to the tangents of another one of the same file, for [`View::Angle`](crate::View::Angle).
    pub fn compared_with(mut self, other: &Model<'_>) -> Self {
        let others: HashMap<_, _> = other.parts.iter().map(|part| (part.name, part)).collect();
        for part in &mut self.parts {
            let other = others.get(&part.name).filter(|other| part.is_comparable(other));
            let Some(other) = other else { continue };
            let pairs = part.corners.as_chunks_mut::<3>().0.iter_mut().zip(other.corners.as_chunks::<3>().0);
            for (corners, others) in pairs {
                let degrees = heat::degrees(corners.map(|c| c.tangent), others.map(|c| c.tangent));
                corners.iter_mut().zip(degrees).for_each(|(corner, degrees)| corner.degrees = degrees);
            }
        }
        self
    }

    /// The model without all other meshes. `meshes`: indices.
    pub fn only(mut self, meshes: &[usize]) -> Self {
        self.parts.retain(|part| meshes.contains(&part.mesh));
        self
    }

    /// Triangles that views of the surface show, counted as often as nodes place them.
    pub fn triangle_count(&self) -> u64 {
        let placed = |part: &Part| (part.corners.len() / 3) as u64 * part.places.len() as u64;
        self.parts.iter().map(placed).fold(0, u64::saturating_add)
    }

    /// What is not drawn of a shape, and should be.
    pub(crate) fn warnings(&self, shape: Shape) -> Vec<String> {
        let left_out: usize = self.parts.iter().map(|part| part.left_out).sum();
        let left_out = (left_out > 0 && shape == Shape::Model)
            .then(|| format!("{left_out} triangles have positions that are not finite, and are left out"));
        left_out.into_iter().collect()
    }

    /// The box that holds all that is drawn; none without triangles.
    pub(crate) fn bounds(&self, shape: Shape) -> Option<Bounds> {
        let mut all = Box3::EMPTY;
        for part in &self.parts {
            if shape == Shape::Layout {
                part.layout.iter().for_each(|&uv| all.add(on_layout(uv).map(f64::from)));
                continue;
            }
            let mut own = Box3::EMPTY;
            part.corners.iter().for_each(|corner| own.add(corner.position.map(f64::from)));
            for (matrix, corner) in part.places.iter().flat_map(|m| own.corners().map(move |c| (m, c))) {
                let [a, b, c, d] = matrix;
                all.add([0, 1, 2].map(|i| a[i] * corner[0] + b[i] * corner[1] + c[i] * corner[2] + d[i]));
            }
        }
        if shape == Shape::Layout && all.least[0] <= all.most[0] {
            for uv in [[0.0, 0.0], [1.0, 1.0]] {
                all.add(on_layout(uv).map(f64::from));
            }
        }
        (all.least[0] <= all.most[0]).then_some([all.least, all.most])
    }
}

impl Part {
    /// Corners at places, with nothing else.
    #[cfg(test)]
    pub fn of(corners: Vec<Corner>, places: &[Matrix]) -> Self {
        Self {
            mesh: 0,
            name: [0; 3],
            material: None,
            corners,
            has_tangents: true,
            left_out: 0,
            layout: Vec::new(),
            places: places.into(),
        }
    }

    /// Whether there are tangents on both sides, of the same corners.
    fn is_comparable(&self, other: &Part) -> bool {
        self.has_tangents && other.has_tangents && self.corners.len() == other.corners.len()
    }
}

/// The poses of every mesh, each with all its places.
fn posed_meshes(placed: &PlacedMeshes, mesh_count: usize) -> Vec<Vec<Posed<'_>>> {
    let mut at = HashMap::new();
    let mut posed: Vec<Vec<(&PlacedMesh, Vec<Matrix>)>> = (0..mesh_count).map(|_| Vec::new()).collect();
    for mesh in &placed.meshes {
        let Some(poses) = posed.get_mut(mesh.mesh) else { continue };
        let weights: Vec<u64> = mesh.weights.iter().map(|weight| weight.to_bits()).collect();
        let pose = *at.entry((mesh.mesh, mesh.skin, weights)).or_insert(poses.len());
        match poses.get_mut(pose) {
            // Skins place meshes: the same skin again is at the same place.
            Some(_) if mesh.skin.is_some() => {}
            Some((_, places)) => places.extend(&mesh.matrices),
            None => poses.push((mesh, mesh.matrices.clone())),
        }
    }
    let pose = |(mesh, places): (&PlacedMesh, Vec<Matrix>)| Posed {
        weights: mesh.weights.clone(),
        joints: mesh.skin.and_then(|skin| placed.skins.get(skin)).map(Vec::as_slice),
        places: places.into(),
    };
    posed.into_iter().map(|poses| poses.into_iter().map(pose).collect()).collect()
}

/// The corners of a primitive, or its vertices where these are more: each pose reads all of them.
fn elements(document: &Document, corners: &PrimitiveCorners<'_>) -> usize {
    let PrimitiveName { mesh, primitive, .. } = corners.name();
    let primitive = &document.meshes()[*mesh].primitives[*primitive];
    let accessors = primitive.targets.iter().chain([&primitive.attributes]).flat_map(BTreeMap::values);
    let counts = accessors.filter_map(|&accessor| Some(document.accessors().get(accessor)?.count));
    counts.fold(corners.len(), usize::max)
}

/// Errors: a skin whose vertices have more influences than are kept.
fn check_influences(
    document: &Document,
    corners: &PrimitiveCorners<'_>,
    poses: &[Posed<'_>],
) -> Result<(), Error> {
    let PrimitiveName { mesh, primitive, .. } = corners.name();
    let attributes = &document.meshes()[*mesh].primitives[*primitive].attributes;
    let is_skinned = poses.iter().any(|pose| pose.joints.is_some());
    if is_skinned && attributes.contains_key(&format!("JOINTS_{MOST_SETS}")) {
        let most = 4 * MOST_SETS;
        let problem = format!("has vertices with more than {most} joints; limit them where you export it");
        return Err(document.invalid(corners.name().path(), problem));
    }
    Ok(())
}

/// Where a UV lies in the layout, whose v goes down.
pub fn on_layout([u, v]: [f32; 2]) -> [f32; 3] {
    [u, -v, 0.0]
}

/// Reads a primitive in the pose `at` of its mesh, leaving out triangles that have no place.
fn read_part(
    document: &Document,
    appearances: &[Appearance],
    corners: &PrimitiveCorners<'_>,
    at: usize,
    pose: &Posed<'_>,
) -> Result<Part, Error> {
    let none = Appearance::default();
    let appearance = match corners.material() {
        None => &none,
        Some(material) => appearances.get(material).ok_or_else(|| {
            let problem = format!("its material {material} does not exist; export the file again");
            document.invalid(corners.name().path(), problem)
        })?,
    };
    let layout = corners.vectors::<2>(&set_name(appearance.tangent_uv_set))?.unwrap_or_default();
    let uvs = |texture: &Option<TextureUse>| -> Result<Vec<[f32; 2]>, Error> {
        let Some(texture) = texture else { return Ok(layout.clone()) };
        Ok(corners.vectors::<2>(&set_name(texture.uv_set))?.unwrap_or_default())
    };
    let uvs = [uvs(&appearance.base_texture)?, uvs(&appearance.normal_texture)?];
    let (Vertices { positions, normals, tangents }, is_mirrored) = posed_vertices(corners, pose)?;
    let corner = |i: usize| Corner {
        position: positions[i],
        normal: normals.get(i).copied().unwrap_or_default(),
        tangent: tangents.get(i).copied().unwrap_or_default(),
        uvs: [0, 1].map(|k| uvs[k].get(i).copied().unwrap_or_default()),
        degrees: heat::NONE,
    };
    let is_finite = |triangle: &[[f32; 3]; 3]| triangle.as_flattened().iter().all(|x| x.is_finite());
    let triangles = positions.as_chunks::<3>().0.iter().enumerate();
    let kept = triangles.filter(|(_, triangle)| is_finite(triangle)).map(|(triangle, _)| 3 * triangle);
    let turned = |first: usize| match is_mirrored.get(first..first + 3) {
        Some([true, true, true]) => [first, first + 2, first + 1],
        _ => [first, first + 1, first + 2],
    };
    let kept: Vec<usize> = kept.flat_map(turned).collect();
    Ok(Part {
        mesh: corners.name().mesh,
        name: [corners.name().mesh, corners.name().primitive, at],
        has_tangents: !tangents.is_empty(),
        material: corners.material(),
        left_out: positions.len() / 3 - kept.len() / 3,
        corners: kept.iter().map(|&i| corner(i)).collect(),
        layout: kept.iter().filter_map(|&i| layout.get(i).copied()).collect(),
        places: pose.places.clone(),
    })
}

/// The vertices of a primitive's corners in a pose; with a skin, which of them it mirrors.
fn posed_vertices(corners: &PrimitiveCorners<'_>, pose: &Posed<'_>) -> Result<(Vertices, Vec<bool>), Error> {
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

/// glTF's name of a UV set.
fn set_name(set: usize) -> String {
    format!("TEXCOORD_{set}")
}

/// A box that grows.
struct Box3 {
    least: [f64; 3],
    most: [f64; 3],
}

impl Box3 {
    const EMPTY: Self = Self { least: [f64::INFINITY; 3], most: [f64::NEG_INFINITY; 3] };

    /// Points that are not finite have no place.
    fn add(&mut self, point: [f64; 3]) {
        if point.iter().all(|x| x.is_finite()) {
            (0..3).for_each(|i| {
                self.least[i] = self.least[i].min(point[i]);
                self.most[i] = self.most[i].max(point[i]);
            });
        }
    }

    fn corners(&self) -> [[f64; 3]; 8] {
        let ends = [self.least, self.most];
        [0, 1, 2, 3, 4, 5, 6, 7].map(|bits: usize| [0, 1, 2].map(|i| ends[bits >> i & 1][i]))
    }
}
