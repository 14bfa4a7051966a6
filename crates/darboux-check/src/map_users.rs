//! The surfaces on which the images of a document are normal maps.

use std::collections::BTreeMap;

use darboux_io::Error;
use darboux_io::gltf::{Document, Material, PrimitiveCorners, PrimitiveName, TextureUse};
use darboux_io::image::RgbaImage;

use crate::instances::distinct;
use crate::measure::mesh_votes::MeshVotes;
use crate::surface::Surface;

/// The primitives that use the images of normal maps, in their own material or in one of their variants.
pub struct MapUsers<'a> {
    document: &'a Document,
    primitives: Vec<PrimitiveCorners<'a>>,
    /// Per image the indices of primitives, each with the textures that use the image.
    users: BTreeMap<usize, BTreeMap<usize, Vec<TextureUse>>>,
}

impl<'a> MapUsers<'a> {
    /// Finds the users of all images; primitives with the same data once. `materials`: of the document.
    /// Errors: invalid data of primitives.
    pub fn new(document: &'a Document, materials: &[Material]) -> Result<Self, Error> {
        let mut users: BTreeMap<usize, BTreeMap<usize, Vec<TextureUse>>> = BTreeMap::new();
        let mut primitives = Vec::new();
        for (corners, _) in distinct(document, document.corners()?) {
            let name = corners.name();
            let of_primitive = document.meshes()[name.mesh].primitives[name.primitive].materials();
            let used = of_primitive.iter().filter_map(|&material| materials.get(material));
            for texture in used.flat_map(Material::normal_maps) {
                let Some(image) = texture.image else { continue };
                let textures = users.entry(image).or_default().entry(primitives.len()).or_default();
                if !textures.contains(texture) {
                    textures.push(texture.clone());
                }
            }
            primitives.push(corners);
        }
        Ok(Self { document, primitives, users })
    }

    /// The names of the primitives that use an image.
    pub fn names(&self, image: usize) -> impl Iterator<Item = &PrimitiveName> {
        let users = self.users.get(&image).into_iter().flat_map(BTreeMap::keys);
        users.map(|&primitive| self.primitives[primitive].name())
    }

    /// Reads the surfaces that use an image. Errors: invalid data of primitives.
    pub fn of(&self, image: usize) -> Result<MapSurfaces, Error> {
        let mut surfaces = Vec::new();
        for (&primitive, textures) in self.users.get(&image).into_iter().flatten() {
            if let Some(surface) = Surface::read(self.document, &self.primitives[primitive], None)? {
                surfaces.push((surface, textures.clone()));
            }
        }
        Ok(MapSurfaces(surfaces))
    }
}

/// The surfaces that use one image.
pub struct MapSurfaces(Vec<(Surface, Vec<TextureUse>)>);

impl MapSurfaces {
    /// What their facets say about the image.
    pub fn votes(&self, image: &RgbaImage) -> MeshVotes {
        let mut uses = Vec::new();
        for (surface, textures) in &self.0 {
            uses.extend(textures.iter().map(|texture| (surface, Some(texture))));
        }
        MeshVotes::of(&uses, image)
    }
}
