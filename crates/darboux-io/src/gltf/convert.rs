//! Converts the vertex data of a document to another convention.
//!
//! A valid glTF file is in glTF's convention. There are two uses of conversion: to repair a file whose writer
//! stored numbers of another convention, and to prepare numbers for a program that reads them without
//! conversion. Files that are not in glTF's convention are marked by `asset.extras.darboux_convention`.

mod attributes;
mod axes;
mod convention_note;
mod faces;
mod scene;
mod summary;

pub use summary::ConversionSummary;

use darboux::Convention;

use super::Document;
use super::Progress;
use super::primitives::canonical::CanonicalAccessors;
use super::primitives::index_range::IndexRanges;
use super::primitives::limits;
use crate::Error;
use attributes::AttributeConverter;
use axes::AxisChange;
use faces::FaceReverser;
use scene::SceneConverter;

/// Converts the vertex data of every primitive: positions, normals, tangents, UVs, morph targets and the
/// winding of triangles. If the axes differ, the transforms of nodes, skins, instances and animations are
/// converted too.
///
/// Images, cameras and lights are not converted; warnings name them. Accessors that change become floats.
/// Errors: a document that is marked with a convention other than `from`; animations that cannot be
/// converted; invalid data. After an error the document is unspecified: drop it.
pub fn convert_vertices(
    document: &mut Document,
    from: Convention,
    to: Convention,
    progress: &mut dyn FnMut(Progress),
) -> Result<ConversionSummary, Error> {
    document.check_convention(from)?;
    let mut summary = ConversionSummary::default();
    if from != to {
        summary.warnings = convention_note::warnings(document, from, to);
        let accessors = CanonicalAccessors::new(document);
        convert_primitives(document, &accessors, (from, to), &mut summary, progress)?;
        if from.axes != to.axes {
            summary.axes_changed |=
                SceneConverter::new(&accessors, AxisChange::new(from, to)).convert(document)?;
        }
    }
    // A document without changes is in both conventions, and needs no mark unless it has one.
    if summary.has_changes() || document.has_note() {
        document.set_convention(to)?;
    }
    summary.warnings.extend(document.unused_data_warning());
    Ok(summary)
}

fn convert_primitives(
    document: &mut Document,
    accessors: &CanonicalAccessors,
    (from, to): (Convention, Convention),
    summary: &mut ConversionSummary,
    progress: &mut dyn FnMut(Progress),
) -> Result<(), Error> {
    let mut attributes = AttributeConverter::new(accessors, from, to);
    let mut faces = FaceReverser::new(accessors, from, to);
    let mut ranges = IndexRanges::default();
    let counts = document.meshes().iter().map(|mesh| mesh.primitives.len());
    let places = counts.enumerate().flat_map(|(mesh, count)| (0..count).map(move |place| (mesh, place)));
    let places: Vec<(usize, usize)> = places.collect();
    for (done, &(mesh, place)) in places.iter().enumerate() {
        ranges.check(document, mesh, place)?;
        let attributes_changed = attributes.convert(document, mesh, place)?;
        let faces_changed = faces.convert(document, mesh, place)?;
        summary.faces_reversed |= faces_changed;
        summary.primitives += usize::from(attributes_changed || faces_changed);
        limits::check_output(document)?;
        progress(Progress { done: done + 1, total: places.len() });
    }
    attributes.sum_up(summary);
    Ok(())
}
