//! Runs the rules on a document or on a map.

use std::collections::BTreeMap;

use darboux::{BitangentDirection, MapJudgement, SrgbMistake};
use darboux_io::Error;
use darboux_io::gltf::{Appearance, Document, PrimitiveName, inspect};
use darboux_io::image::RgbaImage;

use crate::cancelling;
use crate::code::{Code, Family};
use crate::facets::FacetVotes;
use crate::finding::{Finding, Place};
use crate::instances::distinct;
use crate::map::{Map, MapDirections, Vote};
use crate::map_users::{MapSurfaces, MapUsers};
use crate::obstacles;
use crate::rule::Measured;
use crate::rules::{BY_FACES, MAP_RULES, MATERIAL_RULES, SURFACE_RULES, directions_by_mesh};
use crate::severity::Severity;
use crate::surface::Surface;

/// What is checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct CheckOptions {
    /// Where the green of normal maps should point. Default: up, as glTF and OpenGL want it.
    pub green: BitangentDirection,
    /// Whether the images of normal maps are decoded and judged. Default: true.
    pub maps: bool,
}

impl Default for CheckOptions {
    fn default() -> Self {
        Self { green: BitangentDirection::Up, maps: true }
    }
}

impl CheckOptions {
    /// These options with another direction of green.
    #[must_use]
    pub fn with_green(self, green: BitangentDirection) -> Self {
        Self { green, ..self }
    }

    /// These options with or without maps.
    #[must_use]
    pub fn with_maps(self, maps: bool) -> Self {
        Self { maps, ..self }
    }
}

/// Checks a document: every primitive with triangles, every material, and every image that is a normal map.
///
/// Primitives with the same data are checked once. A compressed document is decompressed. An image that cannot be read is a finding.
/// Errors: invalid data of the document.
pub fn check_document(document: &mut Document, options: &CheckOptions) -> Result<Vec<Finding>, Error> {
    let mut findings = check_surfaces(document)?;
    let on_materials = check_materials(document, options, &mut findings)?;
    findings.extend(on_materials);
    Ok(findings)
}

/// Checks every primitive with triangles.
pub fn check_surfaces(document: &mut Document) -> Result<Vec<Finding>, Error> {
    let mut findings = Vec::new();
    for_each_surface(document, |surface| findings.extend(check_surface(&surface)))?;
    Ok(findings)
}

/// Reads the surfaces of a document one after the other; those with the same data once.
pub fn for_each_surface(document: &mut Document, mut visit: impl FnMut(Surface)) -> Result<(), Error> {
    let infos = inspect(document)?;
    for (corners, same_as) in distinct(document, document.corners()?) {
        let info = infos.iter().find(|info| info.name == *corners.name());
        let Some(info) = info.filter(|_| !corners.is_empty()) else { continue };
        let Some(mut surface) = Surface::read(document, &corners, Some(info))? else { continue };
        surface.place.same_as = same_as;
        visit(surface);
    }
    Ok(())
}

/// Checks the file of an image that is a normal map.
pub fn check_map(file: &[u8], options: &CheckOptions) -> CheckedMap {
    check_map_with(file, options, None)
}

/// As [`check_map`]; `vote` gives the votes of the meshes that use the map.
fn check_map_with(file: &[u8], options: &CheckOptions, vote: Option<Vote<'_>>) -> CheckedMap {
    let map = Map::read(file, options.green, vote);
    let obstacle = obstacles::of_image(file);
    let findings = MAP_RULES.iter().filter_map(|rule| rule(&map));
    let findings = findings.map(|finding| finding.with_obstacle(obstacle.clone())).collect();
    let (directions, srgb_mistake) = (directions_by_mesh(&map), map.srgb_mistake);
    CheckedMap { directions, srgb_mistake, judgement: map.judgement.ok(), findings }
}

/// A model that normal maps are to be put on, and what is wrong with it: the result of [`check_model_of_maps`].
#[derive(Debug)]
pub struct ModelOfMaps {
    surfaces: Vec<Surface>,
    findings: Vec<Finding>,
}

impl ModelOfMaps {
    /// The findings on its tangents, normals and UVs.
    pub fn findings(&self) -> &[Finding] {
        &self.findings
    }

    /// Marks findings on a map and on this model's surfaces that cancel each other, and returns the codes of those on the map.
    fn mark_cancelling(&self, on_map: &mut [Finding], on_model: &mut [Finding]) -> &'static [Code] {
        let places: Vec<&Place> = self.surfaces.iter().map(|surface| &surface.place).collect();
        let index_of = |finding: &Finding| places.iter().position(|place| **place == finding.place);
        cancelling::mark(on_map, &mut by_surface(on_model, places.len(), index_of))
    }
}

/// Checks the tangents, normals and UVs of a model that normal maps are to be put on, whatever maps it has itself. Errors: invalid data of the
/// document.
pub fn check_model_of_maps(document: &mut Document) -> Result<ModelOfMaps, Error> {
    let mut model = ModelOfMaps { surfaces: Vec::new(), findings: Vec::new() };
    for_each_surface(document, |mut surface| {
        surface.needs_tangents = true;
        model.findings.extend(check_surface(&surface));
        model.surfaces.push(surface);
    })?;
    Ok(model)
}

/// Checks the file of an image as the normal map of a model, whose faces tell inverted red from inverted green where the map was baked for them.
///
/// The findings on the map come first, then those on the model. A finding about green says where the signs of the model's tangents are flipped,
/// too, so that both mistakes cancel.
pub fn check_map_on_model(file: &[u8], model: &ModelOfMaps, options: &CheckOptions) -> CheckedMap {
    let mut checked = check_map_on_surfaces(file, model, options);
    let mut on_model = model.findings.clone();
    model.mark_cancelling(&mut checked.findings, &mut on_model);
    checked.findings.extend(on_model);
    checked
}

/// As [`check_map_on_model`], without the findings on the model.
pub fn check_map_on_surfaces(file: &[u8], model: &ModelOfMaps, options: &CheckOptions) -> CheckedMap {
    let vote = |image: &RgbaImage| {
        let mut votes = FacetVotes::default();
        model.surfaces.iter().for_each(|surface| votes.add(surface, None, image));
        votes
    };
    let mut checked = check_map_with(file, options, Some(&vote));
    let cancelled = model.mark_cancelling(&mut checked.findings, &mut model.findings.clone());
    for finding in checked.findings.iter_mut().filter(|finding| cancelled.contains(&finding.code)) {
        finding.left_because.get_or_insert_with(|| ON_THE_MODEL_TOO.to_owned());
    }
    checked
}

/// Why one half of two mistakes that cancel is left.
const ON_THE_MODEL_TOO: &str =
    "the tangents of the model have to be repaired with it; put the map on the model and repair that";

/// The result of [`check_map`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CheckedMap {
    /// The judgement on the texels; none if the image cannot be decoded.
    pub judgement: Option<MapJudgement>,
    /// The transfer function that was applied once too often.
    pub(crate) srgb_mistake: Option<SrgbMistake>,
    /// Which channels are inverted, where the faces of a model decide that.
    pub directions: Option<MapDirections>,
    /// The findings.
    pub findings: Vec<Finding>,
}

fn check_surface(surface: &Surface) -> Vec<Finding> {
    let measured = Measured::new(surface);
    let rules = SURFACE_RULES.iter().flat_map(|family| family.iter());
    let findings = rules.flat_map(|rule| rule(&measured));
    let placed = |finding: Finding| {
        let severity = finding.severity.min(worst_severity(finding.code, surface));
        let finding = Finding { place: surface.place.clone(), severity, ..finding };
        let obstacle = obstacles::of_surface(&finding, &measured);
        finding.with_obstacle(obstacle)
    };
    findings.map(placed).collect()
}

/// Tangents that nothing reads make no picture wrong.
fn worst_severity(code: Code, surface: &Surface) -> Severity {
    let is_unread = code.family() == Family::Tangents && !surface.needs_tangents;
    if is_unread { Severity::Warning } else { Severity::Error }
}

/// Checks materials and the images of their normal maps, each image once. `on_surfaces`: the other findings, in which those are marked that a mistake in a
/// map cancels.
fn check_materials(
    document: &Document,
    options: &CheckOptions,
    on_surfaces: &mut [Finding],
) -> Result<Vec<Finding>, Error> {
    let (mut findings, mut images) = (Vec::new(), BTreeMap::new());
    let appearances = document.appearances()?;
    for (index, appearance) in appearances.iter().enumerate() {
        let place = Place { material: Some(index), ..Place::default() };
        let found = MATERIAL_RULES.iter().filter_map(|rule| rule(appearance));
        findings.extend(found.map(|finding| Finding { place: place.clone(), ..finding }));
        for image in appearance.normal_maps().filter_map(|texture| texture.image).filter(|_| options.maps) {
            images.entry(image).or_insert(index);
        }
    }
    if images.is_empty() {
        return Ok(findings);
    }
    let users = MapUsers::new(document, &appearances)?;
    let mut on_images = Vec::new();
    for (image, material) in images {
        let place = Place { image: Some(image), material: Some(material), ..Place::default() };
        let mut found = check_image(document, &users, image, options)?;
        if appearances.iter().any(|appearance| inverts(appearance, image)) {
            found.iter_mut().filter(|finding| is_inverted(finding)).for_each(|finding| {
                finding.left_because.get_or_insert_with(|| NEGATIVE_SCALE.to_owned());
            });
        }
        let names: Vec<&PrimitiveName> = users.names(image).collect();
        let index_of = |finding: &Finding| {
            finding.place.primitive.as_ref().and_then(|own| names.iter().position(|name| *name == own))
        };
        cancelling::mark(&mut found, &mut by_surface(on_surfaces, names.len(), index_of));
        on_images.extend(found.into_iter().map(|finding| Finding { place: place.clone(), ..finding }));
    }
    compare_maps(&mut on_images);
    findings.extend(on_images);
    Ok(findings)
}

/// Why channels that seem to be inverted are left.
const NEGATIVE_SCALE: &str = "the scale of its material is negative, which inverts red and green: make it positive first, and check again";

/// Whether a material inverts the red and green of an image, which is its normal map.
fn inverts(appearance: &Appearance, image: usize) -> bool {
    let texture = appearance.normal_texture.as_ref();
    appearance.normal_scale < 0.0 && texture.is_some_and(|texture| texture.image == Some(image))
}

fn is_inverted(finding: &Finding) -> bool {
    matches!(finding.code, Code::MapRedFlipped | Code::MapGreenFlipped)
}

/// The maps of a model are mostly made by one program. Where the faces show that the red of one map is inverted, and not those of another one
/// which of its channels is, inverted red is as likely there as inverted green.
fn compare_maps(on_images: &mut [Finding]) {
    let with_inverted_red = on_images.iter().find(|finding| finding.code == Code::MapRedFlipped);
    let Some(image) = with_inverted_red.and_then(|finding| finding.place.image) else { return };
    let is_undecided = |finding: &&mut Finding| {
        let is_by_faces = finding.evidence.iter().any(|number| number.what == BY_FACES);
        finding.code == Code::MapGreenFlipped && finding.is_fixable() && !is_by_faces
    };
    for finding in on_images.iter_mut().filter(is_undecided) {
        finding.text += &format!("; the red of images[{image}] is inverted, so that this may be likelier");
        let reason = format!("red may be inverted instead of green, as in images[{image}]");
        finding.left_because = Some(reason);
    }
}

/// The findings on each of `count` surfaces; `index_of` gives the index of that of a finding.
fn by_surface(
    findings: &mut [Finding],
    count: usize,
    index_of: impl Fn(&Finding) -> Option<usize>,
) -> Vec<Vec<&mut Finding>> {
    let mut surfaces: Vec<Vec<&mut Finding>> = (0..count).map(|_| Vec::new()).collect();
    for finding in findings {
        if let Some(index) = index_of(finding) {
            surfaces[index].push(finding);
        }
    }
    surfaces
}

/// Checks an image of a document as a normal map. Errors: invalid data of the primitives that use it.
fn check_image(
    document: &Document,
    users: &MapUsers<'_>,
    image: usize,
    options: &CheckOptions,
) -> Result<Vec<Finding>, Error> {
    let bytes = match document.image_bytes(image) {
        Ok(bytes) => bytes,
        Err(error) => {
            let map = Map::unreadable(format!("cannot be read ({error})"), options.green);
            return Ok(MAP_RULES.iter().filter_map(|rule| rule(&map)).collect());
        }
    };
    let checked = check_texels(&bytes, &users.of(image)?, options);
    let obstacle = document.normal_map_obstacle(image).map(|clause| format!("the image {clause}"));
    Ok(checked.findings.into_iter().map(|finding| finding.with_obstacle(obstacle.clone())).collect())
}

/// Checks the file of an image as the normal map of surfaces of a document.
pub fn check_texels(file: &[u8], surfaces: &MapSurfaces, options: &CheckOptions) -> CheckedMap {
    check_map_with(file, options, Some(&|image| surfaces.votes(image)))
}
