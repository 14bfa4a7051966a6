//! The parts of glTF's JSON that are read as types.
//!
//! [`Mesh`], [`Primitive`] and [`Accessor`] are what [`Document`](super::Document) shows of the file.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use serde::{Deserialize, Deserializer};

use super::element_type::{ComponentType, ElementType};
use super::objects_only::read_from_objects;

read_from_objects! {
    Root, Asset, Mesh, Primitive, PrimitiveExtensions, Variants, VariantMapping, Draco, Material,
    MaterialExtensions, Clearcoat, Anisotropy, TextureInfo, TextureInfoExtensions, TextureTransform, Accessor,
    Sparse, SparseIndices, SparseValues, BufferView, BufferViewExtensions, Meshopt, Buffer, Image, AnyObject,
}

/// The root object.
#[derive(Clone, Debug, PartialEq, Deserialize)]
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

/// The metadata of a file.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(remote = "Self")]
pub(super) struct Asset {
    pub version: String,
}

/// A mesh: a list of primitives.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self")]
pub struct Mesh {
    /// The name, if there is one. All reports on its primitives share it.
    #[serde(default, deserialize_with = "shared_text")]
    pub name: Option<Arc<str>>,
    /// The primitives, each with its own material.
    pub primitives: Vec<Primitive>,
}

fn shared_text<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Arc<str>>, D::Error> {
    Ok(Option::<String>::deserialize(deserializer)?.map(Arc::from))
}

/// The accessor of each semantic, such as `POSITION` or `TEXCOORD_1`.
pub type Attributes = BTreeMap<String, usize>;

/// A part of a mesh that is drawn with one material.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self")]
pub struct Primitive {
    /// Vertex attributes.
    pub attributes: Attributes,
    /// The accessor of the indices. Without one, corner i is vertex i.
    pub indices: Option<usize>,
    /// The material.
    pub material: Option<usize>,
    /// The topology: 0 to 3 for points and lines, 4 for triangles, 5 for strips, 6 for fans.
    #[serde(default = "triangles")]
    pub mode: u32,
    /// The morph targets: accessors of attribute offsets.
    #[serde(default)]
    pub targets: Vec<Attributes>,
    /// Extensions that change how the primitive is stored.
    #[serde(default)]
    pub(super) extensions: PrimitiveExtensions,
}

impl Primitive {
    /// The materials that the primitive is drawn with: its own first, then its variants'
    /// (`KHR_materials_variants`), each once.
    pub fn materials(&self) -> Vec<usize> {
        let variants = self.extensions.variants.iter().flat_map(|variants| &variants.mappings);
        let others: BTreeSet<usize> = variants.map(|mapping| mapping.material).collect();
        let others = others.into_iter().filter(|&other| Some(other) != self.material);
        self.material.into_iter().chain(others).collect()
    }
}

fn triangles() -> u32 {
    4
}

/// The supported extensions of a primitive.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(remote = "Self")]
pub(super) struct PrimitiveExtensions {
    /// Draco compression.
    #[serde(rename = "KHR_draco_mesh_compression")]
    pub draco: Option<Draco>,
    /// Materials that can replace the primitive's own.
    #[serde(rename = "KHR_materials_variants")]
    pub variants: Option<Variants>,
}

/// `KHR_materials_variants` of a primitive.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(remote = "Self")]
pub(super) struct Variants {
    /// The materials of the variants.
    #[serde(default)]
    pub mappings: Vec<VariantMapping>,
}

/// The material of some variants.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(remote = "Self")]
pub(super) struct VariantMapping {
    /// The material.
    pub material: usize,
}

/// `KHR_draco_mesh_compression` of a primitive.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(remote = "Self", rename_all = "camelCase")]
pub(super) struct Draco {
    /// The buffer view with the compressed bytes.
    pub buffer_view: usize,
    /// Draco's identifier of each compressed attribute, by semantic.
    pub attributes: BTreeMap<String, u32>,
}

/// The parts of a material that decide which UVs its tangents follow.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(remote = "Self", rename_all = "camelCase")]
pub(super) struct Material {
    /// The normal map.
    pub normal_texture: Option<Box<TextureInfo>>,
    /// Colours and textures, whose members edits alone look at.
    pub pbr_metallic_roughness: Option<AnyObject>,
    /// The extensions that use tangents.
    #[serde(default)]
    pub extensions: Option<Box<MaterialExtensions>>,
}

/// An object whose members are not read.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(remote = "Self")]
pub(super) struct AnyObject {}

/// The extensions of a material that use tangents.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(remote = "Self")]
pub(super) struct MaterialExtensions {
    /// A clear coat.
    #[serde(rename = "KHR_materials_clearcoat")]
    pub clearcoat: Option<Clearcoat>,
    /// Anisotropy.
    #[serde(rename = "KHR_materials_anisotropy")]
    pub anisotropy: Option<Anisotropy>,
}

/// `KHR_materials_clearcoat`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(remote = "Self", rename_all = "camelCase")]
pub(super) struct Clearcoat {
    /// The normal map of the coat.
    pub clearcoat_normal_texture: Option<TextureInfo>,
}

/// `KHR_materials_anisotropy`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(remote = "Self", rename_all = "camelCase")]
pub(super) struct Anisotropy {
    /// The map of anisotropy directions and strengths.
    pub anisotropy_texture: Option<TextureInfo>,
}

/// A texture of a material.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(remote = "Self", rename_all = "camelCase")]
pub(super) struct TextureInfo {
    /// The UV set n of `TEXCOORD_n`, unless the transform overrides it.
    #[serde(default)]
    pub tex_coord: usize,
    /// The supported extensions.
    #[serde(default)]
    pub extensions: TextureInfoExtensions,
}

/// The supported extensions of a material's texture.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(remote = "Self")]
pub(super) struct TextureInfoExtensions {
    /// A transform of the UVs.
    #[serde(rename = "KHR_texture_transform")]
    pub transform: Option<TextureTransform>,
}

/// `KHR_texture_transform`: uv' = offset + rotation * scale * uv.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(remote = "Self", rename_all = "camelCase")]
pub(super) struct TextureTransform {
    /// The offset in units of the texture.
    #[serde(default)]
    pub offset: [f32; 2],
    /// The rotation in radians, counter-clockwise around the UV origin.
    #[serde(default)]
    pub rotation: f32,
    /// The scale per axis.
    #[serde(default = "ones")]
    pub scale: [f32; 2],
    /// The UV set that overrides [`TextureInfo::tex_coord`].
    pub tex_coord: Option<usize>,
}

fn ones() -> [f32; 2] {
    [1.0; 2]
}

/// A typed view of a buffer view's bytes.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[non_exhaustive]
#[serde(remote = "Self", rename_all = "camelCase")]
pub struct Accessor {
    /// The buffer view. Without one, all values are zero.
    pub buffer_view: Option<usize>,
    /// The first byte within the view.
    #[serde(default)]
    pub byte_offset: usize,
    /// The type of each component.
    pub component_type: ComponentType,
    /// Whether integers encode [0, 1] or [-1, 1].
    #[serde(default)]
    pub normalized: bool,
    /// The number of elements.
    pub count: usize,
    /// The components of each element.
    #[serde(rename = "type")]
    pub element_type: ElementType,
    /// The elements that replace those of the buffer view.
    pub(super) sparse: Option<Box<Sparse>>,
}

impl Accessor {
    /// Whether some elements are stored apart from the buffer view, by their indices.
    pub fn is_sparse(&self) -> bool {
        self.sparse.is_some()
    }
}

/// The elements of an accessor that differ from its buffer view.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(remote = "Self")]
pub(super) struct Sparse {
    /// The number of elements.
    pub count: usize,
    /// The indices of the elements.
    pub indices: SparseIndices,
    /// The values of the elements.
    pub values: SparseValues,
}

/// The location of a sparse accessor's indices.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(remote = "Self", rename_all = "camelCase")]
pub(super) struct SparseIndices {
    /// The buffer view.
    pub buffer_view: usize,
    /// The first byte within the view.
    #[serde(default)]
    pub byte_offset: usize,
    /// An unsigned integer type.
    pub component_type: ComponentType,
}

/// The location of a sparse accessor's values.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(remote = "Self", rename_all = "camelCase")]
pub(super) struct SparseValues {
    /// The buffer view.
    pub buffer_view: usize,
    /// The first byte within the view.
    #[serde(default)]
    pub byte_offset: usize,
}

/// A range of a buffer.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(remote = "Self", rename_all = "camelCase")]
pub(super) struct BufferView {
    /// The buffer.
    pub buffer: usize,
    /// The first byte.
    #[serde(default)]
    pub byte_offset: usize,
    /// The number of bytes.
    pub byte_length: usize,
    /// Bytes from one element to the next, for interleaved vertex attributes.
    pub byte_stride: Option<usize>,
    /// The supported extensions.
    #[serde(default)]
    pub extensions: BufferViewExtensions,
}

/// The supported extensions of a buffer view.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(remote = "Self")]
pub(super) struct BufferViewExtensions {
    /// Compression by meshoptimizer, under either name of the extension.
    #[serde(rename = "EXT_meshopt_compression", alias = "KHR_meshopt_compression")]
    pub meshopt: Option<Box<Meshopt>>,
}

/// `EXT_meshopt_compression` or `KHR_meshopt_compression` of a buffer view.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(remote = "Self", rename_all = "camelCase")]
pub(super) struct Meshopt {
    /// The buffer with the compressed bytes.
    pub buffer: usize,
    /// The first compressed byte within the buffer.
    #[serde(default)]
    pub byte_offset: usize,
    /// The number of compressed bytes.
    pub byte_length: usize,
    /// Bytes per decoded element.
    pub byte_stride: usize,
    /// The number of decoded elements.
    pub count: usize,
    /// `ATTRIBUTES`, `TRIANGLES` or `INDICES`.
    pub mode: String,
    /// `NONE`, `OCTAHEDRAL`, `QUATERNION`, `EXPONENTIAL` or `COLOR`.
    #[serde(default)]
    pub filter: Option<String>,
}

/// A buffer: the GLB's binary chunk, a `data:` URI or a file.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(remote = "Self", rename_all = "camelCase")]
pub(super) struct Buffer {
    /// The URI of the bytes. Without one, they are in the GLB's binary chunk.
    pub uri: Option<String>,
    /// The number of bytes.
    pub byte_length: usize,
}

impl Buffer {
    /// The name of buffers made for new data of a `.gltf`, by which later runs recognise them.
    pub(super) const NAME_FOR_NEW_DATA: &str = "darboux";
}

/// An image.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(remote = "Self", rename_all = "camelCase")]
pub(super) struct Image {
    /// The URI of the image. Without one, it is in a buffer view.
    pub uri: Option<String>,
    /// The buffer view of the image.
    pub buffer_view: Option<usize>,
    /// The media type.
    pub mime_type: Option<String>,
}
