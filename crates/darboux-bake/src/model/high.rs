//! [`HighModel`]: the surfaces of a document that have the detail.

use std::sync::Arc;

use darboux_io::Error;
use darboux_io::gltf::{Document, PrimitiveCorners, PrimitiveName};

use super::content::{ColorTextures, PartContent};
use super::decoded_bytes::DecodedBytes;
use super::instance::{PrimitiveInstance, instances_of_meshes};
use super::maps::{MapOnPart, Textures};
use super::stored_material::warnings_of_materials;
use crate::{AlphaMode, BakeError, HighSurface, IdSource, MapKind, MapSet, SurfaceLabels};

/// How a high model is read.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct HighModelOptions {
    /// Whether surfaces have the normals that their materials' normal maps show. Default: yes.
    pub normal_maps: bool,
    /// The maps whose colours and textures are read. Default: none.
    pub maps: MapSet,
    /// The texture of [`MapKind::Texture`]: its place in the JSON of the material,
    /// such as `occlusionTexture` or `extensions.KHR_materials_clearcoat.clearcoatTexture`. Default:
    /// none.
    pub texture: Option<String>,
}

impl Default for HighModelOptions {
    fn default() -> Self {
        Self { normal_maps: true, maps: MapSet::default(), texture: None }
    }
}

impl HighModelOptions {
    /// These options with the normal maps of materials, or without.
    #[must_use]
    pub fn with_normal_maps(self, normal_maps: bool) -> Self {
        Self { normal_maps, ..self }
    }

    /// These options with the colours and textures that some maps need.
    #[must_use]
    pub fn with_maps(self, maps: MapSet) -> Self {
        Self { maps, ..self }
    }

    /// These options with the texture of [`MapKind::Texture`].
    #[must_use]
    pub fn with_texture(self, texture: Option<String>) -> Self {
        Self { texture, ..self }
    }

    /// Refuses [`MapKind::Texture`] without the place of its texture, and a place without this map.
    ///
    /// # Errors
    ///
    /// [`BakeError::Texture`].
    pub fn check(&self) -> Result<(), BakeError> {
        let is_chosen = self.maps.has(MapKind::Texture);
        if is_chosen == self.texture.is_some() { Ok(()) } else { Err(BakeError::Texture { is_chosen }) }
    }
}

/// The triangles of a document's scene in all their instances, without animation and in the pose in which
/// skinned meshes are stored.
#[derive(Debug)]
pub struct HighModel<'a> {
    file: String,
    parts: Vec<HighPart<'a>>,
    textures: Textures,
    color_textures: ColorTextures,
    warnings: Vec<String>,
    /// The names of the document's materials, with one for primitives without a material.
    material_names: Vec<Arc<str>>,
    mesh_names: Vec<Arc<str>>,
    /// By the numbers of instances.
    part_names: Vec<Arc<str>>,
}

#[derive(Debug)]
struct HighPart<'a> {
    name: PrimitiveName,
    primitive: PrimitiveInstance<'a>,
    map: Option<MapOnPart<'a>>,
    content: Arc<PartContent<'a>>,
    labels: SurfaceLabels,
}

impl<'a> HighModel<'a> {
    /// Reads the model. `corners`: [`Document::corners`] of the same document. Errors: invalid data; factors
    /// of materials that are not finite.
    ///
    /// A normal map that cannot be used is left out; [`HighModel::warnings`] says why.
    pub fn read(
        document: &'a Document,
        corners: &'a [PrimitiveCorners<'a>],
        options: &HighModelOptions,
    ) -> Result<Self, Error> {
        let instances = instances_of_meshes(document)?;
        let instance_count =
            |corners: &PrimitiveCorners<'_>| instances.get(corners.name().mesh).map_or(0, Vec::len);
        let triangles =
            corners.iter().map(|corners| (corners.len() / 3).saturating_mul(instance_count(corners)));
        document.check_triangle_count(triangles.fold(0, usize::saturating_add))?;
        let (mut textures, mut color_textures) = (Textures::default(), ColorTextures::default());
        let mut decoded = DecodedBytes::default();
        let needed = (options.maps, options.texture.as_deref());
        let material_names = material_names(document);
        let mut part_names: Vec<Arc<str>> = vec![Arc::default(); instances.iter().map(Vec::len).sum()];
        let mut parts = Vec::new();
        for corners in corners {
            let content = PartContent::read(document, corners, needed, &mut color_textures, &mut decoded)?;
            let content = Arc::new(content);
            let texture = match options.normal_maps {
                true => textures.of_primitive(document, corners, &mut decoded)?,
                false => None,
            };
            for instance in instances.get(corners.name().mesh).into_iter().flatten() {
                let Some(primitive) = PrimitiveInstance::read(corners, instance)? else { continue };
                let map = texture.map(|texture| textures.on_part(document, corners, texture, &primitive));
                let map = map.transpose()?.flatten();
                part_names[instance.number].clone_from(&primitive.part_name);
                let labels = SurfaceLabels {
                    material: corners.material().unwrap_or(material_names.len() - 1) as u32,
                    mesh: corners.name().mesh as u32,
                    part: instance.number as u32,
                };
                let (name, content) = (corners.name().clone(), content.clone());
                parts.push(HighPart { name, primitive, map, content, labels });
            }
        }
        let mut warnings = std::mem::take(&mut textures.warnings);
        warnings.append(&mut color_textures.warnings);
        let placed = corners.iter().filter(|corners| instance_count(corners) > 0 && !corners.is_empty());
        warnings.extend(warnings_of_materials(document, placed, options.maps));
        warnings.extend(warnings_of_content(document, &parts, options));
        let mesh_names = document.meshes().iter().map(|mesh| mesh.name.clone().unwrap_or_default()).collect();
        let file = document.name().to_owned();
        Ok(Self { file, parts, textures, color_textures, warnings, material_names, mesh_names, part_names })
    }

    /// Reads several models. `corners`: [`Document::corners`] of each document. Errors: as of
    /// [`HighModel::read`].
    pub fn read_all(
        documents: &'a [Document],
        corners: &'a [Vec<PrimitiveCorners<'a>>],
        options: &HighModelOptions,
    ) -> Result<Vec<Self>, Error> {
        documents
            .iter()
            .zip(corners)
            .map(|(document, corners)| Self::read(document, corners, options))
            .collect()
    }

    /// The surfaces of several models, one model after the other, with the numbers of
    /// [`HighModel::names_of_all`]. Errors: an index out of range.
    pub fn surfaces_of_all(models: &[Self]) -> Result<Vec<HighSurface<'_>>, Error> {
        let mut surfaces = Vec::new();
        let mut first = SurfaceLabels::default();
        for model in models {
            surfaces.extend(model.surfaces()?.into_iter().map(|surface| {
                let SurfaceLabels { material, mesh, part } = surface.labels();
                surface.with_labels(SurfaceLabels {
                    material: first.material + material,
                    mesh: first.mesh + mesh,
                    part: first.part + part,
                })
            }));
            first.material += model.material_names.len() as u32;
            first.mesh += model.mesh_names.len() as u32;
            first.part += model.part_names.len() as u32;
        }
        Ok(surfaces)
    }

    /// The names that the numbers of materials, meshes or parts stand for, of several models; empty where
    /// there is none.
    pub fn names_of_all(models: &[Self], source: IdSource) -> Vec<&str> {
        models.iter().flat_map(|model| model.names_of(source)).map(|name| &**name).collect()
    }

    fn names_of(&self, source: IdSource) -> &[Arc<str>] {
        match source {
            IdSource::Material => &self.material_names,
            IdSource::Mesh => &self.mesh_names,
            IdSource::Part => &self.part_names,
            IdSource::VertexColor => &[],
        }
    }

    /// The surfaces. Errors: an index out of range.
    pub fn surfaces(&self) -> Result<Vec<HighSurface<'_>>, Error> {
        let mut surfaces = Vec::new();
        for HighPart { name, primitive, map, content, labels } in &self.parts {
            let normals = primitive.normals.as_deref().map(Into::into);
            let surface = HighSurface::new(&*primitive.positions, normals, &*primitive.indices);
            let surface = surface.and_then(|surface| match map {
                Some(map) => {
                    surface.with_normal_map(self.textures.get(map.texture), &*map.uvs, &map.tangents)
                }
                None => Ok(surface),
            });
            let surface = surface.and_then(|surface| content.on(surface, &self.color_textures));
            let surface = surface.map(|surface| surface.with_labels(*labels));
            surfaces.push(surface.map_err(|error| self.mesh_error(name, error))?);
        }
        Ok(surfaces)
    }

    /// The number of primitives whose normal maps count.
    pub fn mapped_count(&self) -> usize {
        self.parts.iter().filter(|part| part.map.is_some()).count()
    }

    /// Why normal maps and textures were left out, and what maps do not show of the materials, one sentence
    /// each.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// The last of the modes of alpha that materials in the scene have: what a material needs that shows
    /// all of them. Primitives without a material are opaque.
    pub fn alpha_mode(&self) -> AlphaMode {
        self.parts.iter().map(|part| part.content.alpha.0).max().unwrap_or_default()
    }

    fn mesh_error(&self, name: &PrimitiveName, error: BakeError) -> Error {
        let (file, at) = (self.file.clone(), name.path());
        match error {
            BakeError::Mesh(source) => Error::Mesh { file, at, source },
            other => Error::Unsupported { file, at, problem: other.to_string() },
        }
    }

    /// The name of each surface: that of its node, or else of its mesh; empty if neither has one.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.parts.iter().map(|part| &*part.primitive.part_name)
    }

    pub(super) fn positions(&self) -> impl Iterator<Item = [f32; 3]> {
        self.parts.iter().flat_map(|part| part.primitive.positions.iter().copied())
    }

    /// The number of primitives without normals, whose triangles are flat.
    pub fn flat_count(&self) -> usize {
        self.parts.iter().filter(|part| part.primitive.normals.is_none()).count()
    }
}

/// Warnings of chosen maps for which the high models have no content.
fn warnings_of_content(
    document: &Document,
    parts: &[HighPart<'_>],
    options: &HighModelOptions,
) -> Vec<String> {
    let file = document.name();
    let mut warnings = Vec::new();
    if options.maps.has(MapKind::VertexColor) && !parts.iter().any(|part| part.content.has_colors()) {
        warnings.push(format!("{file}: has no vertex colours, so that vertex-color is white there"));
    }
    if let Some(place) = &options.texture
        && !parts.iter().any(|part| part.content.has_chosen_texture())
    {
        warnings.push(format!(
            "{file}: no material has a texture at {place}, so that the map texture is empty there; name the \
             place as in the file's JSON, such as occlusionTexture"
        ));
    }
    warnings
}

/// The names of a document's materials, and one for primitives without a material.
fn material_names(document: &Document) -> Vec<Arc<str>> {
    let materials = document.json()["materials"].as_array().map_or(&[][..], Vec::as_slice);
    let name = |index: usize| materials[index]["name"].as_str().unwrap_or_default().into();
    (0..materials.len()).map(name).chain(["without a material".into()]).collect()
}
