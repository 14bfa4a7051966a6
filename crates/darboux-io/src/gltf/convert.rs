//! The vertex data of a document in another convention.
//!
//! A glTF file is in glTF's convention, so one that is right needs no conversion. There are two uses: a file whose writer copied the
//! numbers of another convention is put right, and numbers are prepared for a program that copies them out of the file as they are.
//! In between, and after the second, the file says one thing and means another; `asset.extras.darboux_convention` says what.

mod attributes;
mod faces;
mod scene;
mod surroundings;
mod turn;

use darboux::Convention;
use serde::Serialize;

use super::Document;
use super::tangents::share::Canonical;
use super::tangents::{Progress, excess};
use crate::Error;
use attributes::Attributes;
use faces::Faces;
use scene::Scene;
use turn::Turn;

/// What [`convert_vertices`] did to a document: only what it did, not what other documents would have had changed.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct ConversionSummary {
    /// Primitives that changed.
    pub primitives: usize,
    /// Whether vectors, or nodes, got other axes.
    pub axes_changed: bool,
    /// Whether v runs the other way.
    pub uvs_flipped: bool,
    /// Whether fronts are wound the other way.
    pub faces_reversed: bool,
    /// Whether tangents point the other way, or their signs changed.
    pub tangents_changed: bool,
    /// What a user should look at, one sentence each. Reports have them beside this.
    #[serde(skip)]
    pub warnings: Vec<String>,
}

impl ConversionSummary {
    /// Whether anything changed.
    pub fn has_changes(&self) -> bool {
        self.primitives > 0 || self.axes_changed
    }
}

/// Converts the vertex data of every primitive: positions, normals, tangents, UVs, morph targets, the winding of triangles; and where
/// the axes differ, the transforms of nodes, skins, instances and animations, in documents without meshes too.
///
/// Images, cameras and lights stay as they are; warnings name them. Accessors that change become floats. Errors: a document that says
/// that it is in another convention than `from`; animations of what cannot stand in other axes; broken data. After an error the document may be half done: drop it.
pub fn convert_vertices(
    document: &mut Document,
    from: Convention,
    to: Convention,
    progress: &mut dyn FnMut(Progress),
) -> Result<ConversionSummary, Error> {
    document.check_convention(from)?;
    let mut summary = ConversionSummary::default();
    if from != to {
        summary.warnings = surroundings::warnings(document, from, to);
        if document.is_compressed() {
            document.decompress()?;
        }
        let accessors = Canonical::new(document);
        convert_primitives(document, &accessors, (from, to), &mut summary, progress)?;
        if from.axes != to.axes {
            summary.axes_changed |= Scene::new(&accessors, Turn::new(from, to)).convert(document)?;
        }
    }
    // What nothing changes in is as well in the other convention; where it never said so, there is nothing to say now.
    if summary.has_changes() || document.has_note() {
        document.set_convention(to)?;
    }
    summary.warnings.extend(document.waste_warning());
    Ok(summary)
}

fn convert_primitives(
    document: &mut Document,
    accessors: &Canonical,
    (from, to): (Convention, Convention),
    summary: &mut ConversionSummary,
    progress: &mut dyn FnMut(Progress),
) -> Result<(), Error> {
    let mut attributes = Attributes::new(accessors, from, to);
    let mut faces = Faces::new(accessors, from, to);
    let counts = document.meshes().iter().map(|mesh| mesh.primitives.len());
    let places = counts.enumerate().flat_map(|(mesh, count)| (0..count).map(move |place| (mesh, place)));
    let places: Vec<(usize, usize)> = places.collect();
    for (done, &(mesh, place)) in places.iter().enumerate() {
        let attributes_changed = attributes.convert(document, mesh, place)?;
        let faces_changed = faces.convert(document, mesh, place)?;
        summary.faces_reversed |= faces_changed;
        summary.primitives += usize::from(attributes_changed || faces_changed);
        excess::check_output(document)?;
        progress(Progress { done: done + 1, total: places.len() });
    }
    attributes.sum_up(summary);
    Ok(())
}
