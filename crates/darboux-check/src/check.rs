//! Runs the rules on the facts of a document or of a map.

mod maps;
mod surfaces;

use darboux_io::Error;
use darboux_io::gltf::Document;

use crate::check_options::CheckOptions;
use crate::defect::Defect;
use crate::finding::Finding;
use crate::model_area::ModelArea;
use crate::words;

pub use maps::{
    CheckedMap, MapDefects, ModelOfMaps, check_map, check_map_on_model, check_model_of_maps,
    identified_defects, map_defects, map_defects_on_model,
};
pub use surfaces::{defects_of_surfaces, for_each_surface};

/// Checks a document: every primitive with triangles, every material, and every image that is a normal map.
///
/// Primitives with the same data are checked once. An image that cannot be read is a finding.
/// Errors: invalid data of the document.
pub fn check_document(document: &Document, options: &CheckOptions) -> Result<Vec<Finding>, Error> {
    Ok(words::findings(defects_of(document, options)?))
}

/// The defects of a document.
pub fn defects_of(document: &Document, options: &CheckOptions) -> Result<Vec<Defect>, Error> {
    let area = ModelArea::of(document)?;
    let mut defects = defects_of_surfaces(document, &area, &|_| true)?;
    let of_materials = maps::defects_of_materials(document, options, &area, &mut defects)?;
    defects.extend(of_materials);
    Ok(defects)
}
