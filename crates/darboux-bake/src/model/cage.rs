//! [`cage_of`]: a cage that was made by hand, as a model.

use darboux_io::Error;
use darboux_io::gltf::Document;

use super::{HighModel, HighModelOptions};
use crate::LowSurface;

/// The positions of a cage for each low surface: one per vertex.
///
/// The document has the primitives of the low model in the same order, with the same vertices and triangles;
/// only positions may differ. Errors: invalid data; other primitives, vertices or triangles.
pub fn cage_of(document: &Document, low: &[LowSurface<'_>]) -> Result<Vec<Vec<[f32; 3]>>, Error> {
    let corners = document.corners()?;
    let options = HighModelOptions::default().with_normal_maps(false);
    let cage = HighModel::read(document, &corners, &options)?;
    let surfaces = cage.surfaces()?;
    let other = |problem: String| Error::Unsupported {
        file: document.name().to_owned(),
        at: String::new(),
        problem: format!("{problem}; make the cage by moving the vertices of the low model only"),
    };
    if surfaces.len() != low.len() {
        return Err(other(format!(
            "the cage has {} primitives but the low model has {}",
            surfaces.len(),
            low.len()
        )));
    }
    let pairs = surfaces.iter().zip(low).enumerate();
    pairs
        .map(|(index, (cage, low))| {
            let [found, expected] = [cage.mesh(), low.mesh()].map(|mesh| mesh.vertex_count());
            let [cage_corners, low_corners] = [cage.mesh(), low.mesh()].map(|mesh| mesh.corner_count());
            if found != expected || cage_corners != low_corners {
                return Err(other(format!(
                    "primitive {index} of the cage has {found} vertices and {} triangles but that of the low \
                     model has {expected} and {}",
                    cage_corners / 3,
                    low_corners / 3
                )));
            }
            Ok((0..found).map(|vertex| cage.mesh().positions().get(vertex)).collect())
        })
        .collect()
}
