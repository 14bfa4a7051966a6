//! The parts of glTF's JSON that are read as values. What is not here is never parsed, only kept as text.
//!
//! Indices are plain numbers: whether they name anything is checked where they are used.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde_json::value::RawValue;

use super::objects_only::read_from_objects;

read_from_objects! {
    Root, Asset, Probe, Mesh, Primitive, PrimitiveExtensions, Variants, VariantMapping, Draco, Material,
    MaterialExtensions, Clearcoat, Anisotropy, TextureInfo, TextureInfoExtensions, TextureTransform, Accessor,
    Sparse, SparseIndices, SparseValues, BufferView, BufferViewExtensions, Meshopt, Buffer, Image,
}

/// The top level.
#[derive(Clone, Debug, Deserialize)]
#[serde(remote = "Self", rename_all = "camelCase")]
pub(super) struct Root {
    pub asset: Asset,
    #[serde(default)]
    pub meshes: Vec<Mesh>,
    #[serde(default)]
    pub materials: Vec<Material>,
    #[serde(default)]
    pub accessors: Vec<Accessor>,
    #[serde(default)]
    pub buffer_views: Vec<BufferView>,
    #[serde(default)]
    pub buffers: Vec<Buffer>,
    #[serde(default)]
    pub images: Vec<Image>,
}

/// What the file says about itself.
#[derive(Clone, Debug, Deserialize)]
#[serde(remote = "Self")]
pub(super) struct Asset {
    pub version: String,
}

/// Just the version, for files whose other contents make no sense.
#[derive(Debug, Deserialize)]
#[serde(remote = "Self")]
pub(super) struct Probe {
    pub asset: Asset,
}

/// A mesh: its primitives.
#[derive(Clone, Debug, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self")]
pub struct Mesh {
    /// Its name, where it has one.
    pub name: Option<String>,
    /// The parts, each with a material of its own.
    pub primitives: Vec<Primitive>,
}

/// Semantics such as `POSITION` or `TEXCOORD_1`, with the accessor of each.
pub type Attributes = BTreeMap<String, usize>;

/// A part of a mesh that is drawn at once.
#[derive(Clone, Debug, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self")]
pub struct Primitive {
    /// Vertex attributes.
    pub attributes: Attributes,
    /// The accessor of the indices; without, corner i is vertex i.
    pub indices: Option<usize>,
    /// The material.
    pub material: Option<usize>,
    /// The topology: 4 triangles, 5 strip, 6 fan; below, points and lines.
    #[serde(default = "triangles")]
    pub mode: u32,
    /// Morph targets: offsets of attributes.
    #[serde(default)]
    pub targets: Vec<Attributes>,
    /// Extensions that change how the primitive is stored.
    #[serde(default)]
    pub extensions: PrimitiveExtensions,
}

fn triangles() -> u32 {
    4
}

/// The extensions of a primitive that are understood.
#[derive(Clone, Debug, Default, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self")]
pub struct PrimitiveExtensions {
    /// Draco compression.
    #[serde(rename = "KHR_draco_mesh_compression")]
    pub draco: Option<Draco>,
    /// Materials that may take the place of the primitive's own.
    #[serde(rename = "KHR_materials_variants")]
    pub variants: Option<Variants>,
}

/// `KHR_materials_variants` of a primitive.
#[derive(Clone, Debug, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self")]
pub struct Variants {
    /// Which material in which variants.
    #[serde(default)]
    pub mappings: Vec<VariantMapping>,
}

/// A material for some variants.
#[derive(Clone, Debug, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self")]
pub struct VariantMapping {
    /// The material.
    pub material: usize,
}

/// `KHR_draco_mesh_compression` of a primitive.
#[derive(Clone, Debug, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self", rename_all = "camelCase")]
pub struct Draco {
    /// The buffer view with the compressed bytes.
    pub buffer_view: usize,
    /// The compressed attributes: semantic and Draco's unique id.
    pub attributes: BTreeMap<String, u32>,
}

/// A material, as far as it says which UVs tangents must follow.
#[derive(Clone, Debug, Default, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self", rename_all = "camelCase")]
pub struct Material {
    /// The normal map.
    pub normal_texture: Option<Box<TextureInfo>>,
    /// Extensions with normal maps or anisotropy.
    #[serde(default)]
    pub extensions: Option<Box<MaterialExtensions>>,
}

/// The extensions of a material that use tangents.
#[derive(Clone, Debug, Default, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self")]
pub struct MaterialExtensions {
    /// A clear coat, which may have a normal map.
    #[serde(rename = "KHR_materials_clearcoat")]
    pub clearcoat: Option<Clearcoat>,
    /// Anisotropy.
    #[serde(rename = "KHR_materials_anisotropy")]
    pub anisotropy: Option<Anisotropy>,
}

/// `KHR_materials_clearcoat`.
#[derive(Clone, Debug, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self", rename_all = "camelCase")]
pub struct Clearcoat {
    /// The normal map of the coat.
    pub clearcoat_normal_texture: Option<TextureInfo>,
}

/// `KHR_materials_anisotropy`.
#[derive(Clone, Debug, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self", rename_all = "camelCase")]
pub struct Anisotropy {
    /// The map of directions and strength.
    pub anisotropy_texture: Option<TextureInfo>,
}

/// A use of a texture.
#[derive(Clone, Debug, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self", rename_all = "camelCase")]
pub struct TextureInfo {
    /// The UV set: n of `TEXCOORD_n`, unless the transform overrides it.
    #[serde(default)]
    pub tex_coord: usize,
    /// Extensions of the use.
    #[serde(default)]
    pub extensions: TextureInfoExtensions,
}

/// The extensions of a use of a texture that are understood.
#[derive(Clone, Debug, Default, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self")]
pub struct TextureInfoExtensions {
    /// A transform of the UVs.
    #[serde(rename = "KHR_texture_transform")]
    pub transform: Option<TextureTransform>,
}

/// `KHR_texture_transform`: uv' = offset + rotation * scale * uv.
#[derive(Clone, Debug, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self", rename_all = "camelCase")]
pub struct TextureTransform {
    /// Offset in units of the texture.
    #[serde(default)]
    pub offset: [f32; 2],
    /// Rotation in radians, counter-clockwise around the UV origin.
    #[serde(default)]
    pub rotation: f32,
    /// Scale per axis.
    #[serde(default = "ones")]
    pub scale: [f32; 2],
    /// The UV set that overrides [`TextureInfo::tex_coord`].
    pub tex_coord: Option<usize>,
}

fn ones() -> [f32; 2] {
    [1.0; 2]
}

/// A typed view of bytes.
#[derive(Clone, Debug, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self", rename_all = "camelCase")]
pub struct Accessor {
    /// The buffer view; without, all values are zero.
    pub buffer_view: Option<usize>,
    /// The first byte within the view.
    #[serde(default)]
    pub byte_offset: usize,
    /// The type of each component.
    pub component_type: ComponentType,
    /// Whether integers stand for [0, 1] or [-1, 1].
    #[serde(default)]
    pub normalized: bool,
    /// The number of elements.
    pub count: usize,
    /// The components of each element.
    #[serde(rename = "type")]
    pub element_type: ElementType,
    /// Elements that replace others.
    pub sparse: Option<Box<Sparse>>,
    /// Its name, as JSON text.
    pub(super) name: Option<Box<RawValue>>,
    /// Its extras, as JSON text.
    pub(super) extras: Option<Box<RawValue>>,
    /// Its extensions, as JSON text.
    pub(super) extensions: Option<Box<RawValue>>,
}

impl Accessor {
    /// The members that describe the accessor to people and programs, as key and JSON text.
    pub(super) fn descriptions(&self) -> impl Iterator<Item = (&'static str, &str)> {
        [("name", &self.name), ("extras", &self.extras), ("extensions", &self.extensions)]
            .into_iter()
            .filter_map(|(key, value)| Some((key, value.as_ref()?.get())))
    }
}

/// The elements of an accessor that differ from its buffer view.
#[derive(Clone, Debug, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self")]
pub struct Sparse {
    /// How many.
    pub count: usize,
    /// Which.
    pub indices: SparseIndices,
    /// Their values.
    pub values: SparseValues,
}

/// Where the indices of a sparse accessor are.
#[derive(Clone, Debug, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self", rename_all = "camelCase")]
pub struct SparseIndices {
    /// The buffer view.
    pub buffer_view: usize,
    /// The first byte within the view.
    #[serde(default)]
    pub byte_offset: usize,
    /// An unsigned integer type.
    pub component_type: ComponentType,
}

/// Where the values of a sparse accessor are.
#[derive(Clone, Debug, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self", rename_all = "camelCase")]
pub struct SparseValues {
    /// The buffer view.
    pub buffer_view: usize,
    /// The first byte within the view.
    #[serde(default)]
    pub byte_offset: usize,
}

/// A range of a buffer.
#[derive(Clone, Debug, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self", rename_all = "camelCase")]
pub struct BufferView {
    /// The buffer.
    pub buffer: usize,
    /// The first byte.
    #[serde(default)]
    pub byte_offset: usize,
    /// The number of bytes.
    pub byte_length: usize,
    /// Bytes from one element to the next, for interleaved vertex attributes.
    pub byte_stride: Option<usize>,
    /// Compression of the range.
    #[serde(default)]
    pub extensions: BufferViewExtensions,
}

/// The extensions of a buffer view that are understood.
#[derive(Clone, Debug, Default, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self")]
pub struct BufferViewExtensions {
    /// meshoptimizer's compression, under either of its names.
    #[serde(rename = "EXT_meshopt_compression", alias = "KHR_meshopt_compression")]
    pub meshopt: Option<Box<Meshopt>>,
}

/// `EXT_meshopt_compression` or `KHR_meshopt_compression` of a buffer view.
#[derive(Clone, Debug, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self", rename_all = "camelCase")]
pub struct Meshopt {
    /// The buffer with the compressed bytes.
    pub buffer: usize,
    /// The first of them.
    #[serde(default)]
    pub byte_offset: usize,
    /// Their number.
    pub byte_length: usize,
    /// Bytes per decoded element.
    pub byte_stride: usize,
    /// Decoded elements.
    pub count: usize,
    /// `ATTRIBUTES`, `TRIANGLES` or `INDICES`.
    pub mode: String,
    /// `NONE`, `OCTAHEDRAL`, `QUATERNION`, `EXPONENTIAL` or `COLOR`.
    #[serde(default)]
    pub filter: Option<String>,
}

/// Bytes: the GLB's own chunk, a `data:` URI or a file.
#[derive(Clone, Debug, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self", rename_all = "camelCase")]
pub struct Buffer {
    /// Where the bytes are; without, the GLB's chunk.
    pub uri: Option<String>,
    /// The number of bytes.
    pub byte_length: usize,
    /// Its name, as JSON text.
    pub(super) name: Option<Box<RawValue>>,
}

impl Buffer {
    /// What buffers are named that are made for new data of a `.gltf`, so that later runs know them.
    pub(super) const OUR_NAME: &str = "\"darboux\"";

    /// Whether the buffer was made for new data.
    pub(super) fn is_ours(&self) -> bool {
        self.name.as_ref().is_some_and(|name| name.get() == Self::OUR_NAME)
    }
}

/// An image.
#[derive(Clone, Debug, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self", rename_all = "camelCase")]
pub struct Image {
    /// Where the image is; without, in a buffer view.
    pub uri: Option<String>,
    /// That buffer view.
    pub buffer_view: Option<usize>,
    /// What it is.
    pub mime_type: Option<String>,
}

/// The type of a component, by glTF's number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "u32")]
pub enum ComponentType {
    /// 5120.
    I8,
    /// 5121.
    U8,
    /// 5122.
    I16,
    /// 5123.
    U16,
    /// 5125.
    U32,
    /// 5126.
    F32,
}

impl ComponentType {
    /// Bytes per component.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// glTF's number.
    pub fn code(self) -> u32 {
        match self {
            Self::I8 => 5120,
            Self::U8 => 5121,
            Self::I16 => 5122,
            Self::U16 => 5123,
            Self::U32 => 5125,
            Self::F32 => 5126,
        }
    }
}

impl TryFrom<u32> for ComponentType {
    type Error = String;

    fn try_from(code: u32) -> Result<Self, String> {
        [Self::I8, Self::U8, Self::I16, Self::U16, Self::U32, Self::F32]
            .into_iter()
            .find(|kind| kind.code() == code)
            .ok_or_else(|| format!("{code} is not a component type: use 5120 to 5123, 5125 or 5126"))
    }
}

/// The components of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum ElementType {
    /// One.
    Scalar,
    /// Two.
    Vec2,
    /// Three.
    Vec3,
    /// Four.
    Vec4,
    /// Two columns of two.
    Mat2,
    /// Three columns of three.
    Mat3,
    /// Four columns of four.
    Mat4,
}

impl ElementType {
    /// glTF's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scalar => "SCALAR",
            Self::Vec2 => "VEC2",
            Self::Vec3 => "VEC3",
            Self::Vec4 => "VEC4",
            Self::Mat2 => "MAT2",
            Self::Mat3 => "MAT3",
            Self::Mat4 => "MAT4",
        }
    }

    /// Columns, and components per column.
    pub(super) fn shape(self) -> (usize, usize) {
        match self {
            Self::Scalar => (1, 1),
            Self::Vec2 => (1, 2),
            Self::Vec3 => (1, 3),
            Self::Vec4 => (1, 4),
            Self::Mat2 => (2, 2),
            Self::Mat3 => (3, 3),
            Self::Mat4 => (4, 4),
        }
    }

    /// The number of components.
    pub fn components(self) -> usize {
        let (columns, rows) = self.shape();
        columns * rows
    }

    /// Bytes per element. The columns of matrices start at multiples of four bytes.
    pub fn size(self, component: ComponentType) -> usize {
        let (columns, rows) = self.shape();
        let column = rows * component.size();
        if columns == 1 { column } else { columns * column.next_multiple_of(4) }
    }
}
