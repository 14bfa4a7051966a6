//! Checks the surfaces of a document.

use std::collections::HashMap;

use darboux_io::Error;
use darboux_io::gltf::{Document, PrimitiveInfo, PrimitiveName, inspect};

use crate::code::{Code, Family};
use crate::defect::{Defect, Fault};
use crate::facts::SurfaceFacts;
use crate::instances::{Key, distinct, key};
use crate::model_area::ModelArea;
use crate::obstacles;
use crate::rules::SURFACE_RULES;
use crate::severity::Severity;
use crate::spoiled::spoiled;
use crate::surface::Surface;

/// The defects of the primitives with triangles that are wanted.
pub fn defects_of_surfaces(
    document: &Document,
    area: &ModelArea,
    is_wanted: &dyn Fn(&PrimitiveName) -> bool,
) -> Result<Vec<Defect>, Error> {
    let mut defects = Vec::new();
    for_each_surface(document, is_wanted, |surface| defects.extend(defects_of_surface(&surface, area)))?;
    Ok(defects)
}

/// Reads the wanted surfaces of a document one after the other; those with the same data once.
pub fn for_each_surface(
    document: &Document,
    is_wanted: &dyn Fn(&PrimitiveName) -> bool,
    mut visit: impl FnMut(Surface),
) -> Result<(), Error> {
    let infos: HashMap<Key, PrimitiveInfo> =
        inspect(document)?.into_iter().map(|info| (key(&info.name), info)).collect();
    for (corners, same_as) in distinct(document, document.corners()?) {
        if corners.is_empty() || !is_wanted(corners.name()) {
            continue;
        }
        let Some(info) = infos.get(&key(corners.name())) else { continue };
        let Some(mut surface) = Surface::read(document, &corners, Some(info))? else { continue };
        surface.place.same_as = same_as;
        visit(surface);
    }
    Ok(())
}

/// In percent of the model's area: what a defect spoils at least to be an error. Half a percent of a model that fills a screen of 1920 x 1080 is a square of a
/// hundred pixels.
const MIN_SPOILED: f64 = 0.5;

/// The defects of one surface.
pub fn defects_of_surface(surface: &Surface, area: &ModelArea) -> Vec<Defect> {
    let facts = SurfaceFacts::new(surface);
    let rules = SURFACE_RULES.iter().flat_map(|family| family.iter());
    let placed = |defect: Defect| {
        let spoiled = spoiled(&defect.fault, &facts).and_then(|own| area.percent(&surface.place, own));
        let is_small = spoiled.is_some_and(|percent| percent < MIN_SPOILED);
        let severity = if is_small { defect.severity.min(Severity::Warning) } else { defect.severity };
        let obstacle = obstacles::of_surface(&defect, &facts);
        Defect { place: surface.place.clone(), severity, spoiled, ..defect }.with_obstacle(obstacle)
    };
    let defects = rules.flat_map(|rule| rule(&facts)).map(placed).collect();
    if surface.needs_tangents { defects } else { without_unread(defects) }
}

/// Tangents that nothing reads make no picture wrong: one remark says all about them.
fn without_unread(defects: Vec<Defect>) -> Vec<Defect> {
    let is_remark = |defect: &Defect| matches!(defect.fault, Fault::TangentUnused { .. });
    let is_unread = |defect: &&Defect| defect.family() == Family::Tangents && !is_remark(defect);
    let mut codes: Vec<Code> = defects.iter().filter(is_unread).map(Defect::code).collect();
    codes.dedup();
    let mut kept: Vec<Defect> = defects.into_iter().filter(|defect| !is_unread(&defect)).collect();
    for defect in &mut kept {
        if let Fault::TangentUnused { also, .. } = &mut defect.fault {
            also.clone_from(&codes);
        }
    }
    kept
}
