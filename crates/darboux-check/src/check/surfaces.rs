//! Checks the surfaces of a document.

use darboux_io::Error;
use darboux_io::gltf::{Document, PrimitiveName, inspect};

use crate::code::Family;
use crate::defect::Defect;
use crate::facts::SurfaceFacts;
use crate::instances::distinct;
use crate::obstacles;
use crate::rules::SURFACE_RULES;
use crate::severity::Severity;
use crate::surface::Surface;

/// The defects of the primitives with triangles that are wanted.
pub fn defects_of_surfaces(
    document: &Document,
    is_wanted: &dyn Fn(&PrimitiveName) -> bool,
) -> Result<Vec<Defect>, Error> {
    let mut defects = Vec::new();
    for_each_surface(document, is_wanted, |surface| defects.extend(defects_of_surface(&surface)))?;
    Ok(defects)
}

/// Reads the wanted surfaces of a document one after the other; those with the same data once.
pub fn for_each_surface(
    document: &Document,
    is_wanted: &dyn Fn(&PrimitiveName) -> bool,
    mut visit: impl FnMut(Surface),
) -> Result<(), Error> {
    let infos = inspect(document)?;
    for (corners, same_as) in distinct(document, document.corners()?) {
        if corners.is_empty() || !is_wanted(corners.name()) {
            continue;
        }
        let Some(info) = infos.iter().find(|info| info.name == *corners.name()) else { continue };
        let Some(mut surface) = Surface::read(document, &corners, Some(info))? else { continue };
        surface.place.same_as = same_as;
        visit(surface);
    }
    Ok(())
}

/// The defects of one surface.
pub fn defects_of_surface(surface: &Surface) -> Vec<Defect> {
    let facts = SurfaceFacts::new(surface);
    let rules = SURFACE_RULES.iter().flat_map(|family| family.iter());
    let placed = |defect: Defect| {
        let severity = defect.severity.min(worst_severity(&defect, surface));
        let obstacle = obstacles::of_surface(&defect, &facts);
        Defect { place: surface.place.clone(), severity, ..defect }.with_obstacle(obstacle)
    };
    rules.flat_map(|rule| rule(&facts)).map(placed).collect()
}

/// Tangents that nothing reads make no picture wrong.
fn worst_severity(defect: &Defect, surface: &Surface) -> Severity {
    let is_unread = defect.family() == Family::Tangents && !surface.needs_tangents;
    if is_unread { Severity::Info } else { Severity::Error }
}
