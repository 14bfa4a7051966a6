//! Checks the surfaces of a document.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use darboux_io::Error;
use darboux_io::gltf::{Document, PrimitiveInfo, PrimitiveName, inspect};

use crate::code::{Code, Family};
use crate::damage::damaged_area;
use crate::defect::{Defect, Fault, TangentFault};
use crate::facts::SurfaceFacts;
use crate::instances::{Key, distinct, key};
use crate::measure::texture_axes::followed;
use crate::model_area::ModelArea;
use crate::obstacles;
use crate::rules::SURFACE_RULES;
use crate::severity::{MIN_DAMAGED, Severity};
use crate::surface::Surface;

/// The defects of the primitives with triangles that are wanted.
pub fn defects_of_surfaces(
    document: &Document,
    area: &ModelArea,
    is_wanted: &dyn Fn(&PrimitiveName) -> bool,
) -> Result<Vec<Defect>, Error> {
    let mut defects = Vec::new();
    for_each_surface(document, is_wanted, |surface| defects.extend(defects_of_surface(&surface, area)))?;
    weigh(&mut defects);
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
    let materials = document.materials()?;
    for (corners, same_as) in distinct(document, document.corners()?) {
        if corners.is_empty() || !is_wanted(corners.name()) {
            continue;
        }
        let Some(info) = infos.get(&key(corners.name())) else { continue };
        let Some(mut surface) = Surface::read(document, &corners, Some(info))? else { continue };
        surface.place.same_as = same_as;
        let texture = corners.material().and_then(|index| materials.get(index)?.normal_texture.as_ref());
        if let Some(uvs) = texture.and_then(|texture| followed(&surface, texture)) {
            surface.uv_sets.insert(surface.uv_set, Arc::new(uvs));
        }
        visit(surface);
    }
    Ok(())
}

/// The least part of the damage of all defects of one kind that is an error: the smallest ones, which are
/// less together, are not seen beside the others.
const MIN_PART: f64 = 0.1;

/// In percent of the model's area: what defects of one kind damage together at least to be seen at all, 20
/// pixels of a screen of 1920 x 1080 that the model fills. Less is worth knowing only.
const MIN_SEEN: f64 = 0.001;

/// Lowers the severity of defects that damage too small a part of the model, all of one code together: what
/// is cut into many primitives looks as it would in one.
pub fn weigh(defects: &mut [Defect]) {
    let mut of_code: BTreeMap<Code, Vec<(usize, f64)>> = BTreeMap::new();
    for (index, defect) in defects.iter().enumerate() {
        if let Some(percent) = defect.damaged_percent {
            of_code.entry(defect.code()).or_default().push((index, percent));
        }
    }
    for mut found in of_code.into_values() {
        let all: f64 = found.iter().map(|(_, percent)| percent).sum();
        found.sort_by(|(_, a), (_, b)| a.total_cmp(b));
        let mut below = 0.0;
        for (index, percent) in found {
            below += percent;
            let most = if below < MIN_SEEN && is_by_area(&defects[index]) {
                Severity::Info
            } else if all < MIN_DAMAGED || below < MIN_PART * all {
                Severity::Warning
            } else {
                Severity::Error
            };
            defects[index].severity = defects[index].severity.min(most);
        }
    }
}

/// Whether the damaged area of a defect is the area of its faces. The damaged area of tangents that lean or
/// are of another method counts large angles only, and smaller angles are worth a warning.
fn is_by_area(defect: &Defect) -> bool {
    !matches!(defect.fault, Fault::Tangent(TangentFault::Leaning { .. } | TangentFault::OtherRecipe { .. }))
}

/// The defects of one surface, with severities that [`weigh`] may lower.
pub fn defects_of_surface(surface: &Surface, area: &ModelArea) -> Vec<Defect> {
    let facts = SurfaceFacts::new(surface);
    let rules = SURFACE_RULES.iter().flat_map(|family| family.iter());
    let placed = |defect: Defect| {
        let damaged_percent = damaged_area(&defect.fault, &facts)
            .and_then(|own| area.percent(&surface.place, own, defect.family()));
        let obstacle = obstacles::of_surface(&defect, &facts);
        let fault = match &surface.vertices_in_file {
            Some(in_file) => defect.fault.with_vertices(in_file),
            None => defect.fault,
        };
        Defect { place: surface.place.clone(), damaged_percent, fault, ..defect }.with_obstacle(obstacle)
    };
    let defects = rules.flat_map(|rule| rule(&facts)).map(placed).collect();
    if surface.needs_tangents { defects } else { without_unread(defects) }
}

/// Tangents that nothing reads make no picture wrong: one remark says all about them.
fn without_unread(defects: Vec<Defect>) -> Vec<Defect> {
    let is_remark = |defect: &Defect| matches!(defect.fault, Fault::Tangent(TangentFault::Unused { .. }));
    let is_unread = |defect: &&Defect| defect.family() == Family::Tangents && !is_remark(defect);
    let mut codes: Vec<Code> = defects.iter().filter(is_unread).map(Defect::code).collect();
    codes.dedup();
    let mut kept: Vec<Defect> = defects.into_iter().filter(|defect| !is_unread(&defect)).collect();
    for defect in &mut kept {
        if let Fault::Tangent(TangentFault::Unused { also, .. }) = &mut defect.fault {
            also.clone_from(&codes);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::indices::Part;

    /// Faults of two kinds in six primitives.
    #[test]
    fn the_damage_of_primitives_adds_up() {
        let part = || Part::new(&[1], 100).expect("one triangle");
        let defect =
            |fault: TangentFault, percent| Defect { damaged_percent: Some(percent), ..Defect::new(fault) };
        let severities = |percent: f64| {
            let mut defects: Vec<Defect> =
                (0..5).map(|_| defect(TangentFault::SharedAcrossMirror(part()), percent)).collect();
            defects.push(defect(TangentFault::SignNotOne(part()), percent));
            weigh(&mut defects);
            defects.iter().map(|defect| defect.severity).collect::<Vec<Severity>>()
        };
        let all_of = |count: usize, severity: Severity| vec![severity; count];
        let shared = |severity| [all_of(5, severity), all_of(1, Severity::Warning)].concat();
        assert_eq!(severities(0.2), shared(Severity::Error));
        assert_eq!(severities(0.05), shared(Severity::Warning));
    }

    /// One triangle of a model beside a thousand others.
    #[test]
    fn what_is_not_seen_beside_others_is_no_error() {
        let part = || Part::new(&[1], 100).expect("one triangle");
        let defect = |percent| {
            let fault = TangentFault::SharedAcrossMirror(part());
            Defect { damaged_percent: Some(percent), ..Defect::new(fault) }
        };
        let mut defects = [0.001, 5.0, 0.0, 0.8].map(defect);
        weigh(&mut defects);
        let severities = defects.map(|defect| defect.severity);
        let [error, warning, info] = [Severity::Error, Severity::Warning, Severity::Info];
        assert_eq!(severities, [warning, error, info, error]);
    }
}
