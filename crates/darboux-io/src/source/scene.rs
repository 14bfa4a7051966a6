//! What the reader of a format returns: a scene as the file has it, before faces are cut and vertices are
//! made.

use darboux::{Convention, UvOrigin};

use super::format::SourceFormat;

/// A model in the terms of its file. Indices refer to the lists of the scene; the builder checks all of them.
#[derive(Clone, Debug)]
pub struct SourceScene {
    pub format: SourceFormat,
    /// The program that wrote the file, where the file says so.
    pub generator: Option<String>,
    /// The axes of positions, normals and nodes. A root node turns them to those of glTF, so that vertices
    /// keep their bits.
    pub axes: darboux::Axes,
    /// The length of a unit; none where the format does not say.
    pub meters_per_unit: Option<f64>,
    pub uv_origin: UvOrigin,
    /// Parents before children or after, in any order. A scene without nodes gets one per mesh.
    pub nodes: Vec<SourceNode>,
    pub meshes: Vec<SourceMesh>,
    pub materials: Vec<SourceMaterial>,
    pub images: Vec<SourceImage>,
    pub skins: Vec<SourceSkin>,
    /// What is wrong with the file, one sentence each.
    pub warnings: Vec<String>,
    /// What the file has and glTF, or this reader, does not carry over: a noun phrase each, such as `2
    /// cameras`.
    pub not_carried: Vec<String>,
}

impl SourceScene {
    /// A scene without content, in glTF's axes, with `v` pointing up.
    pub fn new(format: SourceFormat) -> Self {
        Self {
            format,
            generator: None,
            axes: Convention::GLTF.axes,
            meters_per_unit: None,
            uv_origin: UvOrigin::BottomLeft,
            nodes: Vec::new(),
            meshes: Vec::new(),
            materials: Vec::new(),
            images: Vec::new(),
            skins: Vec::new(),
            warnings: Vec::new(),
            not_carried: Vec::new(),
        }
    }
}

/// A node of the hierarchy.
#[derive(Clone, Debug, Default)]
pub struct SourceNode {
    pub name: String,
    pub parent: Option<usize>,
    /// The transform to the parent: four columns; none is the identity.
    pub matrix: Option<[[f64; 4]; 4]>,
    pub mesh: Option<usize>,
    pub skin: Option<usize>,
}

/// A mesh of polygons.
#[derive(Clone, Debug, Default)]
pub struct SourceMesh {
    pub name: String,
    /// Where the mesh is in its file, as the program that wrote it would say: the path of its node, `o
    /// Body`.
    pub path: String,
    pub positions: Vec<[f32; 3]>,
    /// The position of each corner, face after face.
    pub corners: Vec<u32>,
    pub faces: FaceSizes,
    pub normals: Option<CornerValues<3>>,
    pub uv_sets: Vec<SourceUvSet>,
    /// Linear RGBA.
    pub colors: Vec<CornerValues<4>>,
    /// Tangents with the sign w: w * cross(normal, tangent) points along increasing v, where v points up.
    pub tangents: Option<CornerValues<4>>,
    /// The material of each face; empty if all faces have [`SourceMesh::material`].
    pub material_of_face: Vec<Option<u32>>,
    /// The material of all faces.
    pub material: Option<u32>,
    /// The smoothing group of each face, 0 for none; empty if the file has no such groups. Meshes without
    /// normals get theirs by these.
    pub smoothing_of_face: Vec<u32>,
    /// Four influences of each position per set; joints are indices into [`SourceSkin::joints`].
    pub weights: Vec<VertexWeights>,
    pub morphs: Vec<SourceMorph>,
}

/// The number of corners of each face.
#[derive(Clone, Debug, Default)]
pub enum FaceSizes {
    #[default]
    Triangles,
    Sizes(Vec<u32>),
}

/// Values of corners, such as normals.
#[derive(Clone, Debug)]
pub struct CornerValues<const N: usize> {
    pub values: Vec<[f32; N]>,
    pub index: CornerIndex,
}

/// Which value each corner has.
#[derive(Clone, Debug)]
pub enum CornerIndex {
    /// The value of the corner's position: as many values as positions.
    Position,
    /// Each corner has its own, in order.
    Corner,
    /// The value with this index; `u32::MAX`, or any index out of range, for none.
    Indexed(Vec<u32>),
}

impl<const N: usize> CornerValues<N> {
    pub fn of_positions(values: Vec<[f32; N]>) -> Self {
        Self { values, index: CornerIndex::Position }
    }

    pub fn of_corners(values: Vec<[f32; N]>) -> Self {
        Self { values, index: CornerIndex::Corner }
    }

    pub fn indexed(values: Vec<[f32; N]>, indices: Vec<u32>) -> Self {
        Self { values, index: CornerIndex::Indexed(indices) }
    }

    /// The value of a corner, whose position is `position`; none if it has none.
    #[inline]
    pub fn get(&self, corner: usize, position: u32) -> Option<[f32; N]> {
        let index = match &self.index {
            CornerIndex::Position => position as usize,
            CornerIndex::Corner => corner,
            CornerIndex::Indexed(indices) => *indices.get(corner)? as usize,
        };
        self.values.get(index).copied()
    }

    pub fn is_by_position(&self) -> bool {
        matches!(self.index, CornerIndex::Position)
    }
}

/// A UV set and its name, which may be empty.
#[derive(Clone, Debug)]
pub struct SourceUvSet {
    pub name: String,
    pub uvs: CornerValues<2>,
}

/// Four joints and their weights for each position.
#[derive(Clone, Debug, Default)]
pub struct VertexWeights {
    pub joints: Vec<[u16; 4]>,
    pub weights: Vec<[f32; 4]>,
}

/// A morph target: what is added at weight 1.
#[derive(Clone, Debug, Default)]
pub struct SourceMorph {
    pub name: String,
    /// One offset per position.
    pub positions: Vec<[f32; 3]>,
    pub normals: Option<CornerValues<3>>,
    /// The weight that the file sets.
    pub weight: f32,
}

/// A skin.
#[derive(Clone, Debug, Default)]
pub struct SourceSkin {
    pub name: String,
    /// Indices of nodes.
    pub joints: Vec<usize>,
    /// Four columns for each joint.
    pub inverse_bind_matrices: Vec<[[f32; 4]; 4]>,
}

/// A material with metallic-roughness shading. What is not set stays at glTF's default.
#[derive(Clone, Debug, Default)]
pub struct SourceMaterial {
    pub name: String,
    /// Linear RGBA.
    pub base_color: Option<[f32; 4]>,
    pub base_color_texture: Option<SourceTexture>,
    pub metallic: Option<f32>,
    pub roughness: Option<f32>,
    /// Roughness in green and metalness in blue.
    pub metallic_roughness_texture: Option<SourceTexture>,
    pub normal_map: Option<NormalMap>,
    /// The normal map that the file names, where its image cannot be read.
    pub missing_normal_map: Option<MissingNormalMap>,
    pub occlusion_texture: Option<SourceTexture>,
    /// Linear RGB.
    pub emissive: Option<[f32; 3]>,
    pub emissive_texture: Option<SourceTexture>,
    pub is_double_sided: bool,
    /// Whether alpha blends.
    pub is_transparent: bool,
}

/// A normal map.
#[derive(Clone, Debug, Default)]
pub struct NormalMap {
    pub texture: SourceTexture,
    /// How strong it is; none is 1.
    pub scale: Option<f32>,
}

/// A normal map without an image.
#[derive(Clone, Debug)]
pub struct MissingNormalMap {
    pub image: MissingImage,
    /// The place of the UV set in [`SourceMesh::uv_sets`].
    pub uv_set: usize,
}

/// A use of an image.
#[derive(Clone, Debug, Default)]
pub struct SourceTexture {
    pub image: usize,
    /// The place of the UV set in [`SourceMesh::uv_sets`].
    pub uv_set: usize,
    /// `KHR_texture_transform`: offset, rotation, scale, in glTF's UVs.
    pub transform: Option<([f32; 2], f32, [f32; 2])>,
    /// Whether the texture is clamped to its edges along u and v; it repeats where not.
    pub clamps: [bool; 2],
}

/// An image file.
#[derive(Clone, Debug)]
pub struct SourceImage {
    pub name: String,
    pub bytes: Vec<u8>,
}

/// An image file that could not be read.
#[derive(Clone, Debug)]
pub struct MissingImage {
    pub name: String,
    /// What is wrong: a clause whose subject is the file.
    pub problem: String,
    /// Whether the file was looked for and is not there, or the system refuses it.
    pub is_absent: bool,
}
