//! Runs the rules on a document or on a map.

use std::collections::BTreeMap;

use darboux::{BitangentDirection, MapJudgement};
use darboux_io::Error;
use darboux_io::gltf::{Document, PrimitiveCorners, inspect};

use crate::code::Code;
use crate::finding::{Finding, Place};
use crate::fit;
use crate::map::Map;
use crate::rule::Measured;
use crate::rules::{MAP_RULES, SURFACE_RULES, TEXTURE_RULES};
use crate::severity::Severity;
use crate::surface::Surface;

/// What is checked.
#[derive(Clone, Copy, Debug)]
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
    let infos = inspect(document)?;
    let mut findings = Vec::new();
    for (corners, same_as) in distinct(document, document.corners()?) {
        let info = infos.iter().find(|info| info.name == *corners.name());
        let Some(info) = info.filter(|_| !corners.is_empty()) else { continue };
        let Some(mut surface) = Surface::read(document, &corners, info)? else { continue };
        surface.place.same_as = same_as;
        findings.extend(check_surface(&surface));
    }
    findings.extend(check_materials(document, options)?);
    Ok(findings)
}

/// Checks the file of an image that is a normal map.
pub fn check_map(file: &[u8], options: &CheckOptions) -> CheckedMap {
    let map = Map::read(file, options.green);
    let findings = MAP_RULES.iter().filter_map(|rule| rule(&map)).collect();
    CheckedMap { judgement: map.judgement.ok(), findings }
}

/// The result of [`check_map`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CheckedMap {
    /// The judgement on the texels; none if the image cannot be decoded.
    pub judgement: Option<MapJudgement>,
    /// The findings.
    pub findings: Vec<Finding>,
}

fn check_surface(surface: &Surface) -> Vec<Finding> {
    let measured = Measured { surface, fit: fit::measure(surface) };
    let rules = SURFACE_RULES.iter().flat_map(|family| family.iter());
    let findings = rules.flat_map(|rule| rule(&measured));
    let placed = |finding: Finding| {
        let severity = finding.severity.min(worst_severity(finding.code, surface));
        Finding { place: surface.place.clone(), severity, ..finding }
    };
    findings.map(placed).collect()
}

/// Tangents that nothing reads make no picture wrong.
fn worst_severity(code: Code, surface: &Surface) -> Severity {
    let is_unread = code.name().starts_with("tangent-") && !surface.needs_tangents;
    if is_unread { Severity::Warning } else { Severity::Error }
}

/// The primitives that differ in data or material, each with the number of later ones that do not.
fn distinct<'a>(
    document: &Document,
    primitives: Vec<PrimitiveCorners<'a>>,
) -> Vec<(PrimitiveCorners<'a>, usize)> {
    let mut places = BTreeMap::new();
    let mut found: Vec<(PrimitiveCorners<'a>, usize)> = Vec::new();
    for corners in primitives {
        let name = corners.name();
        let primitive = &document.meshes()[name.mesh].primitives[name.primitive];
        let attributes: Vec<_> = primitive.attributes.iter().map(|(name, at)| (name.clone(), *at)).collect();
        let key = (attributes, primitive.indices, primitive.mode, primitive.material);
        match places.get(&key) {
            Some(&place) => {
                let (_, same_as): &mut (_, usize) = &mut found[place];
                *same_as += 1;
            }
            None => {
                places.insert(key, found.len());
                found.push((corners, 0));
            }
        }
    }
    found
}

/// Checks materials and the images of their normal maps, each image once.
fn check_materials(document: &Document, options: &CheckOptions) -> Result<Vec<Finding>, Error> {
    let (mut findings, mut images) = (Vec::new(), BTreeMap::new());
    for (index, appearance) in document.appearances()?.iter().enumerate() {
        let Some(texture) = &appearance.normal_texture else { continue };
        let place = Place { material: Some(index), ..Place::default() };
        let found = TEXTURE_RULES.iter().filter_map(|rule| rule(texture));
        findings.extend(found.map(|finding| Finding { place: place.clone(), ..finding }));
        if let Some(image) = texture.image.filter(|_| options.maps) {
            images.entry(image).or_insert(index);
        }
    }
    for (image, material) in images {
        let map = match document.image_bytes(image) {
            Ok(bytes) => Map::read(&bytes, options.green),
            Err(error) => Map { judgement: Err(format!("cannot be read ({error})")), wanted: options.green },
        };
        let place = Place { image: Some(image), material: Some(material), ..Place::default() };
        let found = MAP_RULES.iter().filter_map(|rule| rule(&map));
        findings.extend(found.map(|finding| Finding { place: place.clone(), ..finding }));
    }
    Ok(findings)
}
