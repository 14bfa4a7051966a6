//! Checks materials and the images of their normal maps, and maps without a document.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

use darboux::{MapJudgement, SrgbMistake};
use darboux_io::Error;
use darboux_io::gltf::{Document, ImageSource, Material};
use darboux_io::image::RgbaImage;
use darboux_io::words::Count;

use super::surfaces::{defects_of_surface, for_each_surface, weigh};
use crate::cancelling;
use crate::check_options::CheckOptions;
use crate::defect::{Defect, Fault, MapFault, Obstacle, Unread, Unseen, UvFault};
use crate::finding::Finding;
use crate::hypotheses::{self, MapContext, MapWitness, inverted, is_about_channels};
use crate::instances::{Key, first_with_same_data, key};
use crate::inverted::Inverted;
use crate::map_users::{MapSurfaces, MapUsers, materials_in_scene};
use crate::measure::directions::{directions_by_mesh, witness};
use crate::measure::facet::MapUse;
use crate::measure::map::{Map, MapDirections, Vote};
use crate::measure::mesh_votes::MeshVotes;
use crate::measure::texture_axes::{axes, turns_channels};
use crate::model_area::ModelArea;
use crate::obstacles;
use crate::place::Place;
use crate::rules::{MAP_RULES, MATERIAL_RULES, unreadable};
use crate::severity::Severity;
use crate::surface::Surface;
use crate::words;

/// The result of [`check_map`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CheckedMap {
    /// The judgement on the texels; none if the image cannot be decoded.
    pub judgement: Option<MapJudgement>,
    /// Which channels are inverted, where the faces of a model decide that.
    pub directions: Option<MapDirections>,
    /// The findings.
    pub findings: Vec<Finding>,
}

/// A judged map and its defects.
pub struct MapDefects {
    pub judgement: Option<MapJudgement>,
    /// The transfer function that was applied once too often.
    pub srgb_mistake: Option<SrgbMistake>,
    pub directions: Option<MapDirections>,
    /// What the texels and the faces tell of the directions of the channels.
    pub witness: MapWitness,
    pub defects: Vec<Defect>,
}

impl From<MapDefects> for CheckedMap {
    fn from(MapDefects { judgement, directions, defects, .. }: MapDefects) -> Self {
        Self { judgement, directions, findings: words::findings(defects) }
    }
}

/// Checks the file of an image that is a normal map.
pub fn check_map(file: &[u8], options: &CheckOptions) -> CheckedMap {
    map_defects(file, options, None).into()
}

/// The defects of the file of an image; `vote` gives the votes of the meshes that use the map.
pub fn map_defects(file: &[u8], options: &CheckOptions, vote: Option<Vote<'_>>) -> MapDefects {
    let map = Map { assumed: options.assumed_map, ..Map::read(file, options, vote) };
    let obstacle = obstacles::of_image(file);
    let defects = MAP_RULES.iter().filter_map(|rule| rule(&map));
    MapDefects {
        defects: defects.map(|defect| defect.in_image(obstacle.as_ref())).collect(),
        directions: directions_by_mesh(&map),
        witness: witness(&map),
        srgb_mistake: map.srgb_mistake,
        judgement: map.judgement.ok(),
    }
}

/// As [`map_defects`], for the surfaces of a document that use the map.
pub fn map_defects_on_surfaces(file: &[u8], surfaces: &MapSurfaces, options: &CheckOptions) -> MapDefects {
    map_defects(file, options, Some(&|image| surfaces.votes(image)))
}

/// As [`map_defects_on_surfaces`], without what is not identified by the map and the faces alone: for a map
/// of which repairs revealed more.
pub fn identified_defects(file: &[u8], surfaces: &MapSurfaces, options: &CheckOptions) -> MapDefects {
    let mut checked = map_defects_on_surfaces(file, surfaces, options);
    hypotheses::leave_unidentified(
        &mut checked.defects,
        &checked.witness,
        &mut [],
        &|_| 0.0,
        &MapContext::alone(options),
    );
    checked
}

/// A model that normal maps are to be put on, and what is wrong with it: the result of
/// [`check_model_of_maps`].
#[derive(Debug)]
pub struct ModelOfMaps {
    surfaces: Vec<Surface>,
    area: ModelArea,
    defects: Vec<Defect>,
    findings: Vec<Finding>,
    is_from_sketchfab: bool,
}

impl ModelOfMaps {
    /// The findings on its tangents, normals and UVs.
    pub fn findings(&self) -> &[Finding] {
        &self.findings
    }

    /// The defects of the map, and the defects of this model: what is not identified is left, and what
    /// cancels is marked.
    fn with_map(&self, file: &[u8], options: &CheckOptions) -> (MapDefects, Vec<Defect>) {
        let uses: Vec<MapUse<'_>> = self.surfaces.iter().map(|surface| (surface, None)).collect();
        let vote = |image: &RgbaImage| MeshVotes::of(&uses, image);
        let mut on_map = map_defects(file, options, Some(&vote));
        let mut on_model = self.defects.clone();
        let keys: Vec<Key> =
            self.surfaces.iter().filter_map(|surface| surface.place.primitive.as_ref().map(key)).collect();
        let found = &mut on_map.defects;
        let cancelled = BySurface::new(&mut on_model).visit(&keys, |surfaces| {
            let is_from_sketchfab = self.is_from_sketchfab;
            let context = MapContext { is_from_sketchfab, ..MapContext::alone(options) };
            let area = |index: usize| self.area.percent_of_all(keys[index]);
            hypotheses::leave_unidentified(found, &on_map.witness, surfaces, &area, &context);
            cancelling::mark(found, surfaces, |_| true, None)
        });
        // Signs of a part, or of some surfaces, cancel green there.
        let are_flipped = on_model.iter().any(hypotheses::is_about_signs);
        let cancels = |defect: &Defect| {
            cancelled.contains(&defect.code()) || are_flipped && hypotheses::is_about_green(defect)
        };
        for defect in found.iter_mut().filter(|defect| cancels(defect)) {
            defect.leave(Obstacle::OnTheModelToo);
        }
        (on_map, on_model)
    }
}

/// Checks the tangents, normals and UVs of a model that normal maps are to be put on, whatever maps it has
/// itself. Errors: invalid data of the document.
pub fn check_model_of_maps(document: &Document) -> Result<ModelOfMaps, Error> {
    let (mut surfaces, mut defects) = (Vec::new(), Vec::new());
    let area = ModelArea::of(document)?.with_maps_on_all();
    for_each_surface(document, &|_| true, |mut surface| {
        surface.needs_tangents = true;
        defects.extend(defects_of_surface(&surface, &area));
        surfaces.push(surface);
    })?;
    weigh(&mut defects);
    let is_from_sketchfab = is_from_sketchfab(document);
    let findings = words::findings(defects.clone());
    Ok(ModelOfMaps { surfaces, area, findings, defects, is_from_sketchfab })
}

/// Checks the file of an image as the normal map of a model, whose faces tell inverted red from inverted
/// green where the map was baked for them.
///
/// The findings on the map come first, then those on the model. A finding about green says where the signs of
/// the model's tangents are flipped, too, so that both mistakes cancel.
pub fn check_map_on_model(file: &[u8], model: &ModelOfMaps, options: &CheckOptions) -> CheckedMap {
    let (mut checked, on_model) = model.with_map(file, options);
    let in_model = |mut defect: Defect| {
        defect.leave(Obstacle::InTheModel);
        defect
    };
    checked.defects.extend(on_model.into_iter().map(in_model));
    checked.into()
}

/// The defects of the map alone, on a model.
pub fn map_defects_on_model(file: &[u8], model: &ModelOfMaps, options: &CheckOptions) -> MapDefects {
    model.with_map(file, options).0
}

/// The defects of materials and of the images of their normal maps, each image once. `on_surfaces`: the other
/// defects, in which those are marked that a mistake in a map cancels.
pub fn defects_of_materials(
    document: &Document,
    options: &CheckOptions,
    area: &ModelArea,
    on_surfaces: &mut [Defect],
) -> Result<Vec<Defect>, Error> {
    let options = &options.in_document(document);
    let (mut defects, mut images) = (Vec::new(), BTreeMap::new());
    let (materials, in_scene) = (document.materials()?, materials_in_scene(document));
    for (index, material) in materials.iter().enumerate() {
        let place = Place { material: Some(index), ..Place::default() };
        let found = MATERIAL_RULES.iter().filter_map(|rule| rule(material));
        defects.extend(found.map(|defect| Defect { place: place.clone(), ..defect }));
        if options.maps {
            let unread = unread_maps(document, index, material);
            let unread = unread.map(|defect| Defect { place: place.clone(), ..defect });
            defects.extend(unread.map(|defect| match in_scene.contains(&index) {
                true => defect,
                false => defect.that_is_unseen(Unseen::NotInScene),
            }));
        }
        for image in material.normal_maps().filter_map(|texture| texture.image).filter(|_| options.maps) {
            images.entry(image).or_insert(index);
        }
    }
    if options.maps {
        leave_under_unread_maps(document, &materials, options, area, on_surfaces);
    }
    if images.is_empty() {
        return Ok(defects);
    }
    let users = MapUsers::new(document, &materials)?;
    let inverted_images: HashSet<usize> = materials.iter().filter_map(image_inverted_by).collect();
    let turned_images: HashSet<usize> = materials.iter().flat_map(images_turned_by).collect();
    let mut judged = Vec::new();
    let mut decoded =
        DecodedMaps { most_triangles: DecodedMaps::most_triangles(&users), ..Default::default() };
    for (image, material) in images {
        let place = Place { image: Some(image), material: Some(material), ..Place::default() };
        let (mut found, witness) = defects_of_image(document, &users, image, options, &mut decoded)?;
        for defect in &mut found {
            defect.place = place.clone();
            if let Fault::Map(MapFault::Unreadable { name, .. }) = &mut defect.fault {
                *name = name_of_image(document, image);
            }
            if !is_about_channels(defect) {
                continue;
            }
            if inverted_images.contains(&image) {
                defect.leave(Obstacle::NegativeScale);
            }
            if turned_images.contains(&image) {
                defect.leave(Obstacle::TransformTurns);
                defect.severity = defect.severity.min(Severity::Warning);
            }
        }
        judged.push((image, found, witness));
    }
    let without_uv_area: HashSet<Key> = on_surfaces.iter().filter_map(primitive_without_uv_area).collect();
    let mut by_surface = BySurface::new(on_surfaces);
    let shown: Vec<(usize, Inverted)> = judged.iter().filter_map(shown_by_faces).take(2).collect();
    let keys_of = |image: usize| -> Vec<Key> {
        users.names(image).map(key).filter(|own| !without_uv_area.contains(own)).collect()
    };
    let mut not_cancelled: HashSet<Key> = HashSet::new();
    for (image, found, _) in &judged {
        let keys = keys_of(*image);
        let cancels = by_surface.visit(&keys, |surfaces| cancelling::pairs_of(found, surfaces));
        let others = keys.iter().zip(cancels).filter(|(_, pair)| pair.is_none());
        not_cancelled.extend(others.map(|(key, _)| *key));
    }
    let is_from_sketchfab = is_from_sketchfab(document);
    for (image, found, witness) in &mut judged {
        let sibling = shown.iter().find(|(other, _)| *other != *image).copied();
        let keys = keys_of(*image);
        by_surface.visit(&keys, |surfaces| {
            let context =
                MapContext { image: Some(*image), sibling, is_from_sketchfab, wanted: options.green };
            let area = |index: usize| area.percent_of_all(keys[index]);
            hypotheses::leave_unidentified(found, witness, surfaces, &area, &context);
            cancelling::mark(found, surfaces, |index| !not_cancelled.contains(&keys[index]), Some(*image));
        });
    }
    let is_flat =
        |found: &[Defect]| found.iter().any(|defect| matches!(defect.fault, Fault::Map(MapFault::Flat(_))));
    let flat = judged.iter().filter(|(_, found, _)| is_flat(found)).map(|(image, ..)| *image).collect();
    let unseen = users.unseen_surfaces(&flat);
    for defect in on_surfaces {
        let why = defect.place.primitive.as_ref().and_then(|name| unseen.get(&key(name)));
        if let Some(&why) = why {
            *defect = defect.clone().that_is_unseen(why);
        }
    }
    for (image, found, _) in judged {
        let why = users.why_unseen(image);
        defects.extend(found.into_iter().map(|defect| match why {
            Some(why) => defect.that_is_unseen(why),
            None => defect,
        }));
    }
    Ok(defects)
}

/// The normal maps of a material that have no image here: the reader of another format than glTF left them
/// out or did not find them, or no format of their textures is known.
fn unread_maps(document: &Document, index: usize, material: &Material) -> impl Iterator<Item = Defect> {
    let unread = document.provenance().into_iter().flat_map(move |source| source.unread_maps_of(index));
    let unread = unread.map(|map| {
        let why = if map.is_absent { Unread::Absent } else { Unread::NotCarried };
        (map.file.clone(), why(map.problem.clone()))
    });
    let without_image = material.normal_maps().filter(|texture| texture.image.is_none());
    let without_image = without_image.map(|_| {
        let problem = "has no image, only extensions that are not known here";
        (String::new(), Unread::NotCarried(problem.to_owned()))
    });
    unread.chain(without_image).map(|(name, why)| unreadable(name, why, 0))
}

/// A normal map without an image: its texture, or its file, which a reader of another format left out.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
enum UnreadTexture<'a> {
    Index(u64),
    File(&'a str),
}

/// Leaves flipped signs that a normal map without an image may cancel, for all surfaces with that map
/// together.
fn leave_under_unread_maps(
    document: &Document,
    materials: &[Material],
    options: &CheckOptions,
    area: &ModelArea,
    on_surfaces: &mut [Defect],
) {
    let mut of_material: HashMap<usize, Vec<UnreadTexture<'_>>> = HashMap::new();
    for map in document.provenance().into_iter().flat_map(|source| &source.unread_maps) {
        of_material.entry(map.material).or_default().push(UnreadTexture::File(&map.file));
    }
    for (index, material) in materials.iter().enumerate() {
        let stored = &document.json()["materials"][index];
        let clearcoat = &stored["extensions"]["KHR_materials_clearcoat"]["clearcoatNormalTexture"];
        let maps = [&material.normal_texture, &material.clearcoat_normal_texture];
        for (map, stored) in maps.into_iter().zip([&stored["normalTexture"], clearcoat]) {
            if map.as_ref().is_some_and(|texture| texture.image.is_none()) {
                let texture = stored["index"].as_u64().unwrap_or_default();
                of_material.entry(index).or_default().push(UnreadTexture::Index(texture));
            }
        }
    }
    if of_material.is_empty() {
        return;
    }
    let mut by_surface = BySurface::new(on_surfaces);
    let mut users: BTreeMap<&UnreadTexture<'_>, BTreeSet<Key>> = BTreeMap::new();
    for first in first_with_same_data(document).into_values() {
        let materials = document.meshes()[first.0].primitives[first.1].materials();
        for texture in materials.iter().filter_map(|material| of_material.get(material)).flatten() {
            users.entry(texture).or_default().insert(first);
        }
    }
    let witness = MapWitness::of_unread(options);
    let is_from_sketchfab = is_from_sketchfab(document);
    let context = MapContext { is_from_sketchfab, ..MapContext::alone(options) };
    for keys in users.into_values() {
        let keys: Vec<Key> = keys.into_iter().collect();
        by_surface.visit(&keys, |surfaces| {
            let area = |index: usize| area.percent_of_all(keys[index]);
            hypotheses::leave_unidentified(&mut [], &witness, surfaces, &area, &context);
        });
    }
}

/// The most characters of a name that are shown.
const LONGEST_NAME: usize = 200;

/// The name of the file of an image, or that of the image.
fn name_of_image(document: &Document, image: usize) -> String {
    let json = &document.json()["images"][image];
    let is_file = |uri: &&str| !uri.starts_with("data:");
    let name = json["uri"].as_str().filter(is_file).or(json["name"].as_str()).unwrap_or_default();
    name.chars().take(LONGEST_NAME).collect()
}

/// Whether the program that wrote a document, or the source that it names, is Sketchfab. All 26 models from
/// there that have tangents and were looked at have flipped signs, and most of their maps cancel them
/// (docs/notes/check.md): this is told, and decides nothing, because it is no rule.
fn is_from_sketchfab(document: &Document) -> bool {
    let asset = &document.json()["asset"];
    let texts = [&asset["generator"], &asset["extras"]["source"]];
    texts.into_iter().filter_map(|text| text.as_str()).any(|text| text.to_lowercase().contains("sketchfab"))
}

/// The primitive of a defect that says that all triangles of the primitive are UV-degenerate: they show one
/// texel each and no bumps.
fn primitive_without_uv_area(defect: &Defect) -> Option<Key> {
    match &defect.fault {
        Fault::Uv(UvFault::Degenerate { triangles, .. }) if triangles.len() == triangles.of => {
            defect.place.primitive.as_ref().map(key)
        }
        _ => None,
    }
}

/// An image of which the faces show that channels are inverted, and which: for the other maps of the model,
/// which are mostly made by one program.
fn shown_by_faces((image, found, witness): &(usize, Vec<Defect>, MapWitness)) -> Option<(usize, Inverted)> {
    let inverted = inverted(found);
    (witness.faces != 0.0 && inverted != Inverted::None).then_some((*image, inverted))
}

/// The normal map whose red and green a material inverts.
fn image_inverted_by(material: &Material) -> Option<usize> {
    material.normal_texture.as_ref().filter(|_| material.normal_scale < 0.0)?.image
}

/// The normal maps that a material shows mirrored or turned by a right angle or more, so that what red and
/// green mean depends on whether the renderer's tangents follow the UVs before the transform or after it.
fn images_turned_by(material: &Material) -> impl Iterator<Item = usize> {
    let turned = material.normal_maps().filter(|texture| turns_channels(axes(texture)));
    turned.filter_map(|texture| texture.image)
}

/// The maps of a document that were decoded. Images over the same bytes can ask for any amount of work.
#[derive(Default)]
struct DecodedMaps {
    texels: usize,
    bytes: usize,
    /// The triangles that they were compared with, and the most of them.
    triangles: usize,
    most_triangles: usize,
    /// By the source of their bytes and how they are used, the last image and what was found.
    judged: HashMap<(ImageSource, u64), (usize, Vec<Defect>, MapWitness)>,
}

impl DecodedMaps {
    /// The texels of 16 maps of 4096 x 4096 texels, which compress to nothing where they have one colour.
    const MOST_TEXELS: usize = 1 << 28;
    /// Further texels for each byte of the images.
    const TEXELS_PER_BYTE: usize = 64;

    fn add(&mut self, texels: usize, bytes: usize) {
        (self.texels, self.bytes) = (self.texels.saturating_add(texels), self.bytes.saturating_add(bytes));
    }

    /// Adds a map that could not be decoded to its end, whose texels are not known: what its bytes hold at
    /// most, and not more than 2048 x 2048.
    fn add_broken(&mut self, bytes: &[u8]) {
        /// The most bytes that DEFLATE makes of one.
        const DEFLATE: usize = 1032;
        if RgbaImage::is_format_known(bytes) {
            self.add((bytes.len().saturating_mul(DEFLATE)).min(1 << 22), bytes.len());
        }
    }

    /// The largest number of triangles: four times the model's, and two million. A model has few maps per
    /// primitive, but its materials may have thousands of variants.
    fn most_triangles(users: &MapUsers<'_>) -> usize {
        users.all_triangles().saturating_mul(4).saturating_add(1 << 21)
    }

    fn are_many(&self) -> bool {
        self.texels > Self::MOST_TEXELS.saturating_add(self.bytes.saturating_mul(Self::TEXELS_PER_BYTE))
    }
}

/// The defects of surfaces, by their primitives.
struct BySurface<'a>(HashMap<Key, Vec<&'a mut Defect>>);

impl<'a> BySurface<'a> {
    fn new(defects: &'a mut [Defect]) -> Self {
        let mut surfaces: HashMap<Key, Vec<&mut Defect>> = HashMap::new();
        for defect in defects {
            if let Some(key) = defect.place.primitive.as_ref().map(key) {
                surfaces.entry(key).or_default().push(defect);
            }
        }
        Self(surfaces)
    }

    /// Visits the defects of each of some primitives.
    fn visit<R>(&mut self, keys: &[Key], visit: impl FnOnce(&mut [Vec<&'a mut Defect>]) -> R) -> R {
        let mut surfaces: Vec<_> = keys.iter().map(|key| self.0.remove(key).unwrap_or_default()).collect();
        let result = visit(&mut surfaces);
        self.0.extend(keys.iter().copied().zip(surfaces));
        result
    }
}

/// The defects of an image of a document as a normal map, and the arrangement of its channels. Errors:
/// invalid data of the primitives that use it.
fn defects_of_image(
    document: &Document,
    users: &MapUsers<'_>,
    image: usize,
    options: &CheckOptions,
    decoded: &mut DecodedMaps,
) -> Result<(Vec<Defect>, MapWitness), Error> {
    let unread = |why: Unread| {
        let map = Map::unread(why, options.green);
        let defects = MAP_RULES.iter().filter_map(|rule| rule(&map)).collect();
        Ok((defects, MapWitness::of_unread(options)))
    };
    let bytes = match document.image_bytes(image) {
        Ok(bytes) => bytes,
        Err(_) if document.is_remote_image(image) => {
            return unread(Unread::LeftOut("is on another machine".to_owned()));
        }
        Err(error @ Error::Resource { .. }) => {
            return unread(Unread::Absent(format!("cannot be read ({error})")));
        }
        Err(error @ Error::Unsupported { .. }) => {
            return unread(Unread::LeftOut(format!("cannot be read ({error})")));
        }
        Err(error) => return unread(Unread::Damaged(format!("cannot be read ({error})"))),
    };
    let key = document.image_source(image).map(|source| (source, users.hash_of_uses(image)));
    let same = key.as_ref().and_then(|key| decoded.judged.get(key));
    let obstacle = users.obstacle(image).map(str::to_owned).map(Obstacle::NotRewritable);
    let with_obstacle =
        |found: &[Defect]| found.iter().map(|defect| defect.clone().in_image(obstacle.as_ref())).collect();
    if let Some((_, found, witness)) = same.filter(|(other, ..)| users.are_same(*other, image)) {
        return Ok((with_obstacle(found), *witness));
    }
    if decoded.are_many() {
        let texels = Count(decoded.texels);
        return unread(Unread::LeftOut(format!(
            "comes after maps of {texels} texels, the most that one check decodes"
        )));
    }
    if decoded.triangles > decoded.most_triangles {
        let triangles = Count(decoded.triangles);
        let problem =
            format!("comes after maps that were compared with {triangles} triangles, the most of one check");
        return unread(Unread::LeftOut(problem));
    }
    decoded.triangles = decoded.triangles.saturating_add(users.triangle_count(image));
    let checked = map_defects_on_surfaces(&bytes, &users.of(image)?, options);
    match &checked.judgement {
        Some(judgement) => decoded.add(judgement.texels, bytes.len()),
        None => decoded.add_broken(&bytes),
    }
    let (found, witness) = (with_obstacle(&checked.defects), checked.witness);
    decoded.judged.extend(key.map(|key| (key, (image, checked.defects, witness))));
    Ok((found, witness))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A PNG that is cut at its end costs the time of a whole one.
    #[test]
    fn broken_maps_count_against_the_limit() {
        let cut = [&b"\x89PNG\r\n\x1a\n"[..], &[0; 5000]].concat();
        let mut decoded = DecodedMaps::default();
        let broken = (0..1000).take_while(|_| {
            decoded.add_broken(&cut);
            !decoded.are_many()
        });
        assert!((50..100).contains(&broken.count()));
        let mut decoded = DecodedMaps::default();
        decoded.add_broken(b"no image");
        assert_eq!(decoded.texels, 0);
    }
}
