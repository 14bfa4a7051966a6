//! The surfaces on which the images of a document are normal maps.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

use darboux_io::Error;
use darboux_io::gltf::{Document, Material, PrimitiveCorners, PrimitiveName, TextureUse, schema};
use darboux_io::image::RgbaImage;

use crate::defect::Unseen;
use crate::instances::{Key, distinct, key, meshes_without_node};
use crate::measure::mesh_votes::MeshVotes;
use crate::surface::Surface;

/// The primitives that use the images of normal maps, in their own material or in one of their variants.
pub struct MapUsers<'a> {
    document: &'a Document,
    primitives: Vec<PrimitiveCorners<'a>>,
    /// Per image the indices of primitives, each with the textures that use the image.
    users: BTreeMap<usize, BTreeMap<usize, Vec<TextureUse>>>,
    /// The number of images that each primitive uses.
    images_of_primitive: Vec<usize>,
    /// The images that materials of each primitive show: those that are lit, and scale the map by more than
    /// 0.
    shown_on_primitive: Vec<BTreeSet<usize>>,
    /// The images that a mesh of a node has, and those of them that its materials show.
    in_scene: BTreeSet<usize>,
    shown: BTreeSet<usize>,
    /// The primitives on which tangents decide more than images of normal maps: highlights, or a texture
    /// without an image.
    read_otherwise: BTreeSet<usize>,
    /// Why the texels of images cannot be changed.
    obstacles: HashMap<usize, &'static str>,
    read: RefCell<ReadSurfaces>,
}

/// Surfaces that were read, for other images on them, and the number of their corners.
#[derive(Default)]
struct ReadSurfaces {
    by_primitive: HashMap<usize, Arc<Surface>>,
    corners: usize,
}

/// Surfaces with more corners are read again for each image.
const MOST_KEPT_CORNERS: usize = 1 << 20;

/// The images of the normal maps of a primitive's materials. `are_shown`: only of materials that are lit, and
/// not those that a material scales by 0.
fn images_of<'m>(
    primitive: &schema::Primitive,
    materials: &'m [Material],
    are_shown: bool,
) -> impl Iterator<Item = usize> + use<'m> {
    let used: Vec<&Material> =
        primitive.materials().iter().filter_map(|&material| materials.get(material)).collect();
    let of_material = move |material: &'m Material| {
        let is_scaled = !are_shown || material.normal_scale != 0.0;
        let own = material.normal_texture.as_ref().filter(|_| is_scaled);
        own.into_iter().chain(&material.clearcoat_normal_texture).filter_map(|texture| texture.image)
    };
    used.into_iter().filter(move |material| !are_shown || !material.is_unlit).flat_map(of_material)
}

/// The primitives of all meshes that nodes have.
fn primitives_in_scene(document: &Document) -> impl Iterator<Item = &schema::Primitive> {
    let unused = meshes_without_node(document);
    let meshes = document.meshes().iter().enumerate();
    let meshes = meshes.filter(move |(index, _)| !unused.contains(index));
    meshes.flat_map(|(_, mesh)| &mesh.primitives)
}

/// The materials of all meshes that nodes have.
pub fn materials_in_scene(document: &Document) -> BTreeSet<usize> {
    primitives_in_scene(document).flat_map(schema::Primitive::materials).collect()
}

/// The images of the normal maps of all meshes that nodes have. `are_shown`: as of [`images_of`].
fn images_in_scene(document: &Document, materials: &[Material], are_shown: bool) -> BTreeSet<usize> {
    primitives_in_scene(document).flat_map(|primitive| images_of(primitive, materials, are_shown)).collect()
}

impl<'a> MapUsers<'a> {
    /// Finds the users of all images; primitives with the same data once. `materials`: of the document.
    /// Errors: invalid data of primitives.
    pub fn new(document: &'a Document, materials: &[Material]) -> Result<Self, Error> {
        let mut users: BTreeMap<usize, BTreeMap<usize, Vec<TextureUse>>> = BTreeMap::new();
        let (mut primitives, mut read_otherwise) = (Vec::new(), BTreeSet::new());
        for (corners, _) in distinct(document, document.corners()?) {
            let name = corners.name();
            let of_primitive = document.meshes()[name.mesh].primitives[name.primitive].materials();
            let used = of_primitive.iter().filter_map(|&material| materials.get(material));
            if used.clone().any(|material| material.is_anisotropic) {
                read_otherwise.insert(primitives.len());
            }
            for texture in used.flat_map(Material::normal_maps) {
                let Some(image) = texture.image else {
                    read_otherwise.insert(primitives.len());
                    continue;
                };
                let textures = users.entry(image).or_default().entry(primitives.len()).or_default();
                if !textures.contains(texture) {
                    textures.push(texture.clone());
                }
            }
            primitives.push(corners);
        }
        let mut images_of_primitive = vec![0; primitives.len()];
        users.values().flat_map(BTreeMap::keys).for_each(|&primitive| images_of_primitive[primitive] += 1);
        let shown = |corners: &PrimitiveCorners<'_>| {
            let name = corners.name();
            images_of(&document.meshes()[name.mesh].primitives[name.primitive], materials, true).collect()
        };
        let shown_on_primitive = primitives.iter().map(shown).collect();
        let [in_scene, shown] =
            [false, true].map(|are_shown| images_in_scene(document, materials, are_shown));
        let obstacles = document.normal_map_obstacles();
        let read = RefCell::default();
        Ok(Self {
            document,
            primitives,
            users,
            images_of_primitive,
            shown_on_primitive,
            in_scene,
            shown,
            read_otherwise,
            obstacles,
            read,
        })
    }

    /// Why nothing shows an image as a normal map; none where something does.
    pub fn why_unseen(&self, image: usize) -> Option<Unseen> {
        if self.shown.contains(&image) {
            None
        } else if self.in_scene.contains(&image) {
            Some(Unseen::NoMaterial)
        } else {
            Some(Unseen::NotInScene)
        }
    }

    /// Why the texels of an image cannot be changed, as a clause; none if they can.
    pub fn obstacle(&self, image: usize) -> Option<&'static str> {
        self.obstacles.get(&image).copied()
    }

    /// The names of the primitives that use an image.
    pub fn names(&self, image: usize) -> impl Iterator<Item = &PrimitiveName> {
        let users = self.users.get(&image).into_iter().flat_map(BTreeMap::keys);
        users.map(|&primitive| self.primitives[primitive].name())
    }

    /// The primitives with normal maps whose tangents nothing shows: all their maps are flat, or no material
    /// shows one. `flat`: the images that are flat.
    pub fn unseen_surfaces(&self, flat: &BTreeSet<usize>) -> BTreeMap<Key, Unseen> {
        let with_maps: BTreeSet<usize> = self.users.values().flat_map(BTreeMap::keys).copied().collect();
        let why = |primitive: usize| {
            let shown = self.shown_on_primitive.get(primitive)?;
            match shown.first() {
                None => Some(Unseen::NoMaterial),
                Some(&image) if shown.is_subset(flat) => Some(Unseen::FlatMap { image }),
                Some(_) => None,
            }
        };
        let unread = with_maps.difference(&self.read_otherwise);
        unread
            .filter_map(|&primitive| Some((key(self.primitives[primitive].name()), why(primitive)?)))
            .collect()
    }

    /// Whether two images are used on the same surfaces in the same way.
    pub fn are_same(&self, a: usize, b: usize) -> bool {
        let (of_a, of_b) = match (self.users.get(&a), self.users.get(&b)) {
            (Some(of_a), Some(of_b)) => (of_a, of_b),
            (None, None) => return true,
            _ => return false,
        };
        let is_same = |(a, b): (&TextureUse, &TextureUse)| {
            let mut b = b.clone();
            b.image = a.image;
            *a == b
        };
        let are_same =
            |a: &[TextureUse], b: &[TextureUse]| a.len() == b.len() && a.iter().zip(b).all(is_same);
        let mut pairs = of_a.iter().zip(of_b);
        of_a.len() == of_b.len() && pairs.all(|((a, of_a), (b, of_b))| a == b && are_same(of_a, of_b))
    }

    /// A hash of the surfaces on which an image is used and of the ways in which it is: equal for images that
    /// [are the same](Self::are_same).
    pub fn hash_of_uses(&self, image: usize) -> u64 {
        let mut hasher = DefaultHasher::new();
        for (primitive, textures) in self.users.get(&image).into_iter().flatten() {
            primitive.hash(&mut hasher);
            for texture in textures {
                let mut texture = texture.clone();
                texture.image = None;
                // The numbers of its transform have no hash.
                format!("{texture:?}").hash(&mut hasher);
            }
        }
        hasher.finish()
    }

    /// The number of triangles on which an image is used.
    pub fn triangle_count(&self, image: usize) -> usize {
        let users = self.users.get(&image).into_iter().flatten();
        users.map(|(&primitive, textures)| self.primitives[primitive].len() / 3 * textures.len()).sum()
    }

    /// The number of triangles of all primitives.
    pub fn all_triangles(&self) -> usize {
        self.primitives.iter().map(|primitive| primitive.len() / 3).sum()
    }

    /// Reads the surfaces that use an image. Errors: invalid data of primitives.
    pub fn of(&self, image: usize) -> Result<MapSurfaces, Error> {
        let mut surfaces = Vec::new();
        for (&primitive, textures) in self.users.get(&image).into_iter().flatten() {
            if let Some(surface) = self.surface(primitive)? {
                surfaces.push((surface, textures.clone()));
            }
        }
        Ok(MapSurfaces(surfaces))
    }

    /// The surface of a primitive; none without positions.
    fn surface(&self, primitive: usize) -> Result<Option<Arc<Surface>>, Error> {
        if let Some(known) = self.read.borrow().by_primitive.get(&primitive) {
            return Ok(Some(Arc::clone(known)));
        }
        let corners = &self.primitives[primitive];
        let Some(mut surface) = Surface::read(self.document, corners, None)? else { return Ok(None) };
        surface.keeps_tilts = self.images_of_primitive[primitive] > 1;
        let surface = Arc::new(surface);
        let mut read = self.read.borrow_mut();
        // Each further UV set takes as much as the first one.
        let corners = corners.len().saturating_mul(surface.uv_sets.len().max(1));
        if read.corners.saturating_add(corners) <= MOST_KEPT_CORNERS {
            read.corners += corners;
            read.by_primitive.insert(primitive, Arc::clone(&surface));
        }
        Ok(Some(surface))
    }
}

/// The surfaces that use one image.
pub struct MapSurfaces(Vec<(Arc<Surface>, Vec<TextureUse>)>);

impl MapSurfaces {
    /// What their facets say about the image.
    pub fn votes(&self, image: &RgbaImage) -> MeshVotes {
        let mut uses = Vec::new();
        for (surface, textures) in &self.0 {
            uses.extend(textures.iter().map(|texture| (&**surface, Some(texture))));
        }
        MeshVotes::of(&uses, image)
    }
}
